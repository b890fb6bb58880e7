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


DRAWN = {
    "cart_pole": CartPole,
    "reaction_wheel": ReactionWheel,
    "pendulum": Pendulum,
    "spring_pendulum": SpringPendulum,
    "moving_base": MovingBase,
    "solid_pendulum": SolidPendulum,
    "rotating_frame": RotatingFrame,
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
