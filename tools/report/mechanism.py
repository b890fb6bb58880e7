"""Draws the mechanisms: arm and wheel, cart and pole. Metres, y up; the caller's viewBox does the rest."""

import math


class Mechanism:
    """`pose(row, kind)` is an SVG group; `box` is (left, top, width, height) in metres, y down."""

    def __init__(self, run):
        self.run = run
        self.table = run.table


class ReactionWheel(Mechanism):
    frame_width = 80  # [px] least width of a frame of the film
    frames = 24

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


def of(run):
    return {"reaction_wheel": ReactionWheel, "cart_pole": CartPole}[run.name](run)


def drawing(mechanism, body, label):
    left, top, width, height = mechanism.box
    return (
        f'<svg class="mechanism" role="img" aria-label="{label}" viewBox="{left:.4f} {top:.4f} '
        f'{width:.4f} {height:.4f}">{mechanism.still()}{body}</svg>'
    )


def path_of_tip(mechanism, begin, end):
    first, last = mechanism.run.at(begin), mechanism.run.at(end)
    step = max(1, (last - first) // 200)
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
