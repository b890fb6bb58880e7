"""Draws the mechanisms. Metres, y up; the caller's viewBox does the rest."""

import math


class Mechanism:
    """`pose(row, kind)` is an SVG group; `box` is (left, top, width, height) in metres, y down."""

    frame_width = 80  # [px] least width of a frame of the film
    frames = 24
    poses = 16  # of the stroboscope
    path_points = 200

    def __init__(self, run):
        self.run = run
        self.table = run.table

    def parameter(self, name):
        return float(self.run.scene("parameters", name))

    def shown(self):
        """(begin, end) of the stroboscope."""
        return interesting(self.run)

    def title(self):
        return "the swing that was caught" if self.run.last_balance else "the first swing"


class ReactionWheel(Mechanism):
    def __init__(self, run):
        super().__init__(run)
        parameters = run.scene.values["parameters"]
        self.arm = float(parameters["arm_length"])
        hoop = math.sqrt(float(parameters["wheel_inertia"]) / float(parameters["wheel_mass"]))
        self.wheel = min(max(hoop, 0.19 * self.arm), 0.5 * self.arm)  # to be seen, and not to hide the arm
        reach = 1.1 * (self.arm + self.wheel)
        self.box = (-reach, -reach, 2 * reach, 2 * reach)

    def tip(self, row):
        angle = self.table["arm_angle"][row]
        return self.arm * math.sin(angle), -self.arm * math.cos(angle)

    def still(self):
        """What does not move."""
        r = 0.045 * self.arm
        return f'<circle class="orbit" r="{self.arm:.4f}"/><circle class="pivot" r="{r:.4f}"/>'

    def pose(self, row, kind=""):
        x, y = self.tip(row)
        spoke = self.table["arm_angle"][row] + self.table["wheel_angle"][row]
        r = 0.78 * self.wheel
        sx, sy = r * math.sin(spoke), -r * math.cos(spoke)
        return (
            f'<g class="pose {kind}"><path class="rod" d="M0 0L{x:.4f} {y:.4f}"/>'
            f'<circle class="wheel" cx="{x:.4f}" cy="{y:.4f}" r="{self.wheel:.4f}"/>'
            f'<path class="spoke" d="M{x - sx:.4f} {y - sy:.4f}L{x + sx:.4f} {y + sy:.4f}"/></g>'
        )


class CartPole(Mechanism):
    frame_width = 150
    frames = 15

    def __init__(self, run):
        super().__init__(run)
        self.length = float(run.scene("parameters", "pole_length"))
        self.track = float(run.scene("controller", "track_half_length")) if run.controlled else None
        step = max(1, len(run.time) // 2000)
        tips = [self.tip(row) for row in range(0, len(run.time), step)]
        margin = 0.12 * self.length
        reach = (
            max([abs(x) for x, _ in tips] + [abs(p) for p in self.table["cart_position"]] + [self.track or 0])
            + margin
        )
        top = min(min(y for _, y in tips), -margin) - margin
        bottom = max(max(y for _, y in tips), margin) + margin
        self.box = (-reach, top, 2 * reach, bottom - top)

    def tip(self, row):
        angle = self.table["pole_angle"][row]
        return self.table["cart_position"][row] + self.length * math.sin(angle), -self.length * math.cos(
            angle
        )

    def still(self):
        left, _, width, _ = self.box
        rail = f'<path class="rail" d="M{left:.4f} 0H{left + width:.4f}"/>'
        if self.track is None:
            return rail
        stop = 0.1 * self.length
        return rail + "".join(
            f'<path class="stop" d="M{x:.4f} {-stop:.4f}V{stop:.4f}"/>' for x in (-self.track, self.track)
        )

    def pose(self, row, kind=""):
        p = self.table["cart_position"][row]
        x, y = self.tip(row)
        w, h = 0.15 * self.length, 0.08 * self.length
        return (
            f'<g class="pose {kind}"><rect class="cart" x="{p - w:.4f}" y="{-h:.4f}" '
            f'width="{2 * w:.4f}" height="{2 * h:.4f}"/>'
            f'<path class="rod" d="M{p:.4f} 0L{x:.4f} {y:.4f}"/>'
            f'<circle class="bob" cx="{x:.4f}" cy="{y:.4f}" r="{0.065 * self.length:.4f}"/></g>'
        )


class Rods(Mechanism):
    """What is drawn as a line through points, with a ball at its end: `points(row)`, the last is the tip."""

    ball_share = 0.03

    def __init__(self, run):
        super().__init__(run)
        step = max(1, len(run.time) // 2000)
        drawn = [point for row in range(0, len(run.time), step) for point in self.outline(row)] + [(0, 0)]
        sides = [[point[axis] for point in drawn] for axis in (0, 1)]
        self.size = max(max(side) - min(side) for side in sides) or 1.0
        self.ball = self.ball_share * self.size
        left, top = (min(side) - 2 * self.ball for side in sides)
        self.box = (left, top, max(sides[0]) + 2 * self.ball - left, max(sides[1]) + 2 * self.ball - top)

    def outline(self, row):
        """Points that must be within the picture."""
        return self.points(row)

    def tip(self, row):
        return self.points(row)[-1]

    def still(self):
        return f'<circle class="pivot" r="{0.6 * self.ball:.4f}"/>'

    def pose(self, row, kind=""):
        x, y = self.tip(row)
        line = "L".join(f"{x:.4f} {y:.4f}" for x, y in self.points(row))
        return (
            f'<g class="pose {kind}"><path class="rod" d="M{line}"/>'
            f'<circle class="bob" cx="{x:.4f}" cy="{y:.4f}" r="{self.ball:.4f}"/></g>'
        )


class Pendulum(Rods):
    def base(self, row):
        return 0.0, 0.0

    def points(self, row):
        (x, y), length, angle = self.base(row), self.parameter("length"), self.table["angle"][row]
        return [(x, y), (x + length * math.sin(angle), y - length * math.cos(angle))]


class MovingBase(Pendulum):
    path_points = 1000

    def base(self, row):
        place = [
            self.parameter(f"base_amplitude_{axis}")
            * math.cos(self.table.get(f"base_angle_{axis}", [0.0] * (row + 1))[row] + self.parameter(f"base_phase_{axis}"))
            for axis in (1, 2)
        ]
        return place[0], -place[1]

    def shown(self):
        return 0.0, min(self.run.duration, 3.0)

    def title(self):
        return "the path"


class SpringPendulum(Rods):
    poses = 3
    path_points = 1500

    def points(self, row):
        """A spring of eight turns, its ball at the end."""
        length, angle = self.table["length"][row], self.table["angle"][row]
        c, s = math.cos(angle), math.sin(angle)
        across = [0, 0] + [(-1) ** i for i in range(16)] + [0, 0]
        along = [0, 0.15] + [0.15 + 0.7 * (i + 0.5) / 16 for i in range(16)] + [0.85, 1]
        wide = 0.03 * self.parameter("rest_length") or 0.03 * length
        return [
            (a * length * c - b * wide * s, -(a * length * s + b * wide * c)) for a, b in zip(along, across)
        ]

    def shown(self):
        return 0.0, self.run.duration

    def title(self):
        return "the path"


class SolidPendulum(Rods):
    ball_share = 0.012

    def points(self, row):
        """The middle of the free end."""
        return [self.corner(row, self.parameter("size_1") - self.parameter("pivot_offset"), 0)]

    def corner(self, row, along, across):
        c, s = math.cos(self.table["angle"][row]), math.sin(self.table["angle"][row])
        return along * c - across * s, -(along * s + across * c)

    def outline(self, row):
        near, wide = -self.parameter("pivot_offset"), self.parameter("size_2") / 2
        far = near + self.parameter("size_1")
        return [self.corner(row, *place) for place in ((near, -wide), (far, -wide), (far, wide), (near, wide))]

    def pose(self, row, kind=""):
        line = "L".join(f"{x:.4f} {y:.4f}" for x, y in self.outline(row))
        return f'<g class="pose {kind}"><path class="cart" d="M{line}Z"/>{self.still()}</g>'


class FixedAxis(Rods):
    """
    Each particle on an arm across the axis, which is grey; seen from the front, a little from above and from the right.
    """

    ball_share = 0.018
    poses = 5

    @staticmethod
    def seen(place):
        x, y, z = place
        return x - 0.35 * z, -y + 0.25 * z

    def axis(self):
        axis = [self.parameter(f"axis_{i}") for i in (1, 2, 3)]
        return [entry / math.hypot(*axis) for entry in axis]

    def arms(self, row):
        """(foot on the axis, place) of each particle."""
        u, s, c = self.axis(), math.sin(self.table["angle"][row]), math.cos(self.table["angle"][row])
        found = []
        for _, *b in self.run.scene("parameters", "particles"):
            b = [*b, 0.0][:3]
            along = sum(p * q for p, q in zip(u, b))
            foot = [along * entry for entry in u]
            out = [p - q for p, q in zip(b, foot)]
            across = [u[i - 2] * out[i - 1] - u[i - 1] * out[i - 2] for i in range(3)]
            place = [f + c * o + s * a for f, o, a in zip(foot, out, across)]
            found.append((self.seen(foot), self.seen(place), math.hypot(*out)))
        return sorted(found, key=lambda arm: arm[2])

    def points(self, row):
        return [place for _, place, _ in self.arms(row)]

    def outline(self, row):
        return [point for foot, place, _ in self.arms(row) for point in (foot, place)]

    def still(self):
        feet = [foot for foot, _, _ in self.arms(0)] + [(0.0, 0.0)]
        (x, y), (X, Y) = min(feet, key=lambda f: f[::-1]), max(feet, key=lambda f: f[::-1])
        return f'<path class="rail" d="M{x:.4f} {y:.4f}L{X:.4f} {Y:.4f}"/>' + super().still()

    def pose(self, row, kind=""):
        arms = self.arms(row)
        lines = "".join(f"M{a:.4f} {b:.4f}L{x:.4f} {y:.4f}" for (a, b), (x, y), _ in arms)
        balls = "".join(
            f'<circle class="bob" cx="{x:.4f}" cy="{y:.4f}" r="{self.ball:.4f}"/>' for _, (x, y), _ in arms
        )
        return f'<g class="pose {kind}"><path class="rod" d="{lines}"/>{balls}</g>'


class ParticlePendulum(FixedAxis):
    ball_share = 0.022
    poses = 16

    def axis(self):
        return [0.0, 0.0, -1.0]


class BallJoint(Rods):
    """Particles on rods from the pivot, seen from a little above and to the right; the path of the first."""

    ball_share = 0.02
    path_points = 400
    poses = 6

    def origin(self, row):
        return 0.0, 0.0, 0.0

    def particles(self):
        """(mass, place in body axes) of each."""
        return [(row[0], row[1:]) for row in self.run.scene("parameters", "particles")]

    def places(self, row):
        w, x, y, z = (self.table[f"attitude_{axis}"][row] for axis in "wxyz")
        o, v, found = self.origin(row), (x, y, z), []
        for _, b in self.particles():  # b + 2 (w v x b + v x (v x b))
            once = [v[i - 2] * b[i - 1] - v[i - 1] * b[i - 2] for i in range(3)]
            twice = [v[i - 2] * once[i - 1] - v[i - 1] * once[i - 2] for i in range(3)]
            found.append(FixedAxis.seen([o[i] + b[i] + 2 * (w * once[i] + twice[i]) for i in range(3)]))
        return found

    def points(self, row):
        return [FixedAxis.seen(self.origin(row)), *self.places(row)]

    def tip(self, row):
        return self.points(row)[1]

    def pose(self, row, kind=""):
        (a, b), *places = self.points(row)
        lines = "".join(f"M{a:.4f} {b:.4f}L{x:.4f} {y:.4f}" for x, y in places)
        balls = "".join(f'<circle class="bob" cx="{x:.4f}" cy="{y:.4f}" r="{self.ball:.4f}"/>' for x, y in places)
        return f'<g class="pose {kind}"><path class="rod" d="{lines}"/>{balls}</g>'

    def shown(self):
        return 0.0, self.run.duration

    def title(self):
        return "the path"


class RigidBody(BallJoint):
    """The same about the centre of mass, whose path is drawn."""

    poses = 12

    def origin(self, row):
        return [self.table[f"position_{axis}"][row] for axis in (1, 2, 3)]

    def particles(self):
        """Those listed, from their centre; of a body without, its axes at the radius of gyration."""
        listed = super().particles()
        if not listed:
            reach = math.sqrt(max(self.parameter(f"inertia_{i}_{i}") for i in (1, 2, 3)) / self.parameter("mass"))
            return [(1.0, [reach * (i == axis) for i in range(3)]) for axis in range(3)]
        whole = sum(mass for mass, _ in listed)
        centre = [sum(mass * b[i] for mass, b in listed) / whole for i in range(3)]
        return [(mass, [b[i] - centre[i] for i in range(3)]) for mass, b in listed]

    def tip(self, row):
        return self.points(row)[0]

    def still(self):
        return ""


class RotatingFrame(Rods):
    """Seen along axis 3, from the frame; the path in space is that of a frame that turns about this axis."""

    ball_share = 0.018
    path_points = 400

    def points(self, row):
        return [(self.table["position_1"][row], -self.table["position_2"][row])]

    def outline(self, row):
        return [*self.points(row), self.in_space(row)]

    def in_space(self, row):
        time, (x, y) = self.run.time[row], self.points(row)[0]
        angle = time * (self.parameter("angular_velocity_3") + time / 2 * self.parameter("angular_acceleration_3"))
        c, s = math.cos(angle), -math.sin(angle)
        return c * x - s * y, s * x + c * y

    def still(self):
        """The platform, and the straight line in space."""
        x, y = self.points(0)[0]
        line = "L".join(f"{x:.4f} {y:.4f}" for x, y in map(self.in_space, range(0, len(self.run.time), 20)))
        return f'<circle class="orbit" r="{math.hypot(x, y):.4f}"/><path class="rail" fill="none" d="M{line}"/>' + super().still()

    def shown(self):
        return 0.0, self.run.duration

    def title(self):
        return "the path; grey: in space"


class Chain(Rods):
    """Its target is a cross."""

    ball_share = 0.018

    def points(self, row):
        """Base, joints and tip."""
        x, y, direction, found = 0.0, 0.0, 0.0, [(0.0, 0.0)]
        for i, length in enumerate(self.run.scene("parameters", "link_lengths"), start=1):
            direction += self.table[f"angle_{i}"][row]
            x, y = x + length * math.cos(direction), y - length * math.sin(direction)
            found.append((x, y))
        return found

    def target(self):
        return self.parameter("target_1"), -self.parameter("target_2")

    def distance(self, row):
        """From the tip to the target [m]."""
        return math.dist(self.tip(row), self.target())

    def distances(self):
        return [self.distance(row) for row in range(len(self.run.time))]

    def outline(self, row):
        return [*self.points(row), self.target()]

    def still(self):
        x, y, r = *self.target(), 1.5 * self.ball
        cross = f"M{x - r:.4f} {y - r:.4f}l{2 * r:.4f} {2 * r:.4f}m0 {-2 * r:.4f}l{-2 * r:.4f} {2 * r:.4f}"
        return super().still() + f'<path class="stop" d="{cross}"/>'

    def pose(self, row, kind=""):
        joints = "".join(
            f'<circle class="pivot" cx="{x:.4f}" cy="{y:.4f}" r="{0.5 * self.ball:.4f}"/>'
            for x, y in self.points(row)[1:-1]
        )
        return super().pose(row, kind).replace("</g>", f"{joints}</g>")

    def shown(self):
        """To where the tip is as near as can be seen."""
        rows = range(len(self.run.time))
        near = 0.001 * self.size + self.distance(rows[-1])
        there = next(row for row in rows if self.distance(row) <= near)
        return 0.0, max(self.run.time[there], self.run.result["dt"])

    def title(self):
        return "the way to the target"


DRAWN = {
    "chain": Chain,
    "cart_pole": CartPole,
    "reaction_wheel": ReactionWheel,
    "pendulum": Pendulum,
    "spring_pendulum": SpringPendulum,
    "particle_pendulum": ParticlePendulum,
    "moving_base": MovingBase,
    "fixed_axis": FixedAxis,
    "solid_pendulum": SolidPendulum,
    "rotating_frame": RotatingFrame,
    "ball_joint": BallJoint,
    "rigid_body": RigidBody,
}


def of(run):
    """None for a system that is better seen in its plots."""
    return DRAWN[run.name](run) if run.name in DRAWN else None


def drawing(mechanism, body, label):
    left, top, width, height = mechanism.box
    return (
        f'<svg class="mechanism" role="img" aria-label="{label}" viewBox="{left:.4f} {top:.4f} '
        f'{width:.4f} {height:.4f}">{mechanism.still()}{body}</svg>'
    )


def path_of_tip(mechanism, begin, end):
    first, last = mechanism.run.at(begin), mechanism.run.at(end)
    step = max(1, (last - first) // mechanism.path_points)
    points = [mechanism.tip(row) for row in range(first, last + 1, step)]
    return '<path class="trail" d="M' + "L".join(f"{x:.4f} {y:.4f}" for x, y in points) + '"/>'


def stroboscope(mechanism, begin, end, poses):
    """Poses at equal times, the later the darker."""
    parts = [path_of_tip(mechanism, begin, end)]
    for i in range(poses):
        share = i / (poses - 1)
        row = mechanism.run.at(begin + share * (end - begin))
        opacity = 0.10 + 0.90 * share**2
        parts.append(f'<g opacity="{opacity:.2f}">{mechanism.pose(row)}</g>')
    return drawing(mechanism, "".join(parts), "poses at equal times, the later the darker")


def film(mechanism, begin, end, frames):
    """(time, mode, svg) of single pictures at equal times; each with the path of the moment before it."""
    run = mechanism.run
    pictures = []
    for i in range(frames):
        time = begin + i * (end - begin) / (frames - 1)
        row = run.at(time)
        trail = path_of_tip(mechanism, max(begin, time - 0.5), time)
        pictures.append(
            (
                time,
                run.table["mode"][row],
                drawing(mechanism, trail + mechanism.pose(row), f"pose at {time:.2f} s"),
            )
        )
    return pictures


def interesting(run):
    """(begin, end) of the stroboscope: the swing that ended upright, else the first swing."""
    caught = run.last_balance
    if caught is not None and caught.begin > 0:
        turns = run.turning_points(0, caught.begin - 0.3)
        return (turns[-1] if turns else 0.0), min(caught.end, caught.begin + 0.25)
    turns = run.turning_points(0.05, run.duration)
    end = turns[0] if turns else min(run.duration, 2.0)
    return 0.0, max(end, min(run.duration, 0.5))
