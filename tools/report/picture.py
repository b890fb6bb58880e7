#!/usr/bin/env python3
"""Draws one SVG of a run, for the documentation: the swing that was caught, and angle and input over time.

tools/report/picture.py --csv run.csv --json run.json --scene scenes/cart_pole.toml -o cart_pole.svg
"""

import argparse
import math
import pathlib
import sys

import mechanism
import run_data
from run_data import ROOT, decimated

COLUMNS = 500
STYLE = """
svg { font: 13px "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif; }
.paper { fill: #fcfcfa; } text { fill: #62676e; } .title { fill: #1b1d20; font-weight: 600; }
.orbit, .grid { fill: none; stroke: #dcdcd6; } .frame { fill: none; stroke: #c9c9c2; }
.pivot { fill: #1b1d20; }
.rail { stroke: #62676e; } .stop { stroke: #a3262a; stroke-width: 2.5; }
.rod { stroke: #1b1d20; stroke-width: 2.2; fill: none; }
.wheel, .cart { fill: #fcfcfa; stroke: #0b4a83; stroke-width: 2; } .spoke { stroke: #0b4a83; }
.bob { fill: #0b4a83; }
.trail { fill: none; stroke: #d9730d; stroke-width: 1.4; opacity: .75; }
.line { fill: none; stroke: #0b4a83; stroke-width: 1.3; }
.limit { fill: none; stroke: #a3262a; stroke-dasharray: 6 4; } .swing_up { fill: #fbf0d3; }
.balance { fill: #e2f0e0; }
.mechanism * { vector-effect: non-scaling-stroke; }
@media (prefers-color-scheme: dark) {
  .paper, .wheel, .cart { fill: #15171a; } .title { fill: #e8e6e1; } text { fill: #9aa0a8; }
  .orbit, .grid { stroke: #33373d; }
  .frame { stroke: #4a4f57; } .pivot { fill: #e8e6e1; } .rod { stroke: #e8e6e1; }
  .wheel, .cart, .spoke, .line { stroke: #74b6f2; }
  .bob { fill: #74b6f2; } .limit, .stop { stroke: #ff7b72; } .trail { stroke: #f0a04b; }
  .swing_up { fill: #2e2818; } .balance { fill: #18291c; }
}"""


def ticks(low, high, wanted):
    """Round numbers from low to high, some `wanted` of them."""
    raw = (high - low) / wanted
    power = 10 ** math.floor(math.log10(raw))
    step = next(power * m for m in (1, 2, 2.5, 5, 10) if power * m >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [i * step for i in range(first, last + 1)]


def number(value):
    text = f"{value:.10g}"
    return "0" if text == "-0" else text.replace("-", "\u2212")


def panel(run, title, times, values, box, low, high, marks, limits=(), wraps=None, shows_time=False):
    left, top, width, height = box
    end = marks["end"]
    x = lambda t: left + width * t / end
    y = lambda v: top + height * (high - v) / (high - low)
    parts = []
    for span in run.modes:
        if span.begin < end and span.mode in ("swing_up", "balance"):
            parts.append(
                f'<rect class="{span.mode}" x="{x(span.begin):.1f}" y="{top}" '
                f'width="{x(min(span.end, end)) - x(span.begin):.1f}" height="{height}"/>'
            )
    for value in marks["y"]:
        parts.append(
            f'<path class="grid" d="M{left} {y(value):.1f}h{width}"/><text x="{left - 8}" '
            f'y="{y(value) + 4:.1f}" '
            f'text-anchor="end">{number(value)}</text>'
        )
    for value in limits:
        parts.append(f'<path class="limit" d="M{left} {y(value):.1f}h{width}"/>')
    pieces, piece = [], []
    for point in zip(times, values):
        if piece and wraps is not None and abs(point[1] - piece[-1][1]) > wraps:
            pieces.append(piece)
            piece = []
        if point[0] <= end:
            piece.append(point)
    for piece in pieces + [piece]:
        if len(piece) > 1:
            share = max(2, round(COLUMNS * len(piece) * run.result["dt"] / end))
            points = decimated(*zip(*piece), piece[0][0], piece[-1][0] + 1e-9, share)
            parts.append(
                '<path class="line" d="M' + "L".join(f"{x(t):.1f} {y(v):.1f}" for t, v in points) + '"/>'
            )
    parts.append(f'<rect class="frame" x="{left}" y="{top}" width="{width}" height="{height}"/>')
    parts.append(f'<text class="title" x="{left}" y="{top - 8}">{title}</text>')
    if shows_time:
        for value in ticks(0, end, 6):
            parts.append(
                f'<text x="{x(value):.1f}" y="{top + height + 18}" text-anchor="middle">{number(value)} '
                's</text>'
            )
    return "".join(parts)


def picture(run):
    drawn = mechanism.of(run)
    begin, end = mechanism.interesting(run)
    strobe = mechanism.stroboscope(drawn, begin, end, 16)
    strobe = strobe.replace("<svg ", '<svg x="15" y="45" width="320" height="310" ', 1)
    last = run.duration if run.caught_at is None else min(run.duration, 1.7 * run.caught_at)
    parts = [
        f'<text class="title" x="20" y="28">the swing that was caught, {begin:.1f} s to {end:.1f} s</text>',
        strobe,
    ]
    angle = run.angle_name.replace("_", " ")
    parts.append(
        panel(
            run,
            f"{angle} [deg from upright]",
            run.time,
            run.degrees,
            (400, 36, 480, 145),
            -190,
            190,
            {"end": last, "y": range(-180, 181, 90)},
            wraps=180,
        )
    )
    unit = "V" if run.scene.has_motor else run.system["input_without_motor"]["unit"]
    supply = float(run.scene("parameters", "supply_voltage"))
    parts.append(
        panel(
            run,
            f"voltage [{unit}] and its limit",
            run.time,
            run.table["applied"],
            (400, 216, 480, 120),
            -1.15 * supply,
            1.15 * supply,
            {"end": last, "y": (-supply, 0, supply)},
            (-supply, supply),
            shows_time=True,
        )
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 900 372" width="900" height="372">'
        f"<style>{STYLE}</style>"
        f'<rect class="paper" width="900" height="372"/>{"".join(parts)}</svg>\n'
    )


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog="tools/report/picture.py", description="Draws one SVG of a controlled run."
    )
    for name in ("csv", "json", "scene"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--mctau", default=str(ROOT / "build" / "host" / "mctau"))
    parser.add_argument("-o", "--output", required=True)
    given = parser.parse_args(argv)
    try:
        run = run_data.Run(given.csv, given.json, given.scene, [], run_data.Command(given.mctau))
        pathlib.Path(given.output).write_text(picture(run), encoding="utf-8")
    except run_data.Complaint as complaint:
        print(f"picture: {complaint}", file=sys.stderr)
        return complaint.code
    return 0


if __name__ == "__main__":
    sys.exit(main())
