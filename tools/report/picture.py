#!/usr/bin/env python3
"""Draws one SVG of a run, for the documentation: the mechanism in motion, and two plots over time.

To make it takes matplotlib: tools/setup, build/venv.

build/venv/bin/python tools/report/picture.py --csv run.csv --json run.json --scene scenes/cart_pole.toml \\
    -o cart_pole.svg
"""

import argparse
import pathlib
import sys

import mechanism
import plot
import run_data
from run_data import ROOT

WIDTH, HEIGHT = 900, 384  # [px]
SCALE = 1.2  # of the plots, for their texts to be read
PLOT_WIDTH = 440  # [px] before that
ALONE = 720  # [px] of the plots of a system that is not drawn
PLOT_HEIGHT = plot.LINE + plot.HEIGHT + plot.BOTTOM
STYLE = """
.paper { fill: var(--paper); } .title { fill: var(--ink); font-size: 12.6px; font-weight: 600; }
"""


def style():
    """The colours and lines of the page, and the picture's own."""
    page = run_data.read_text(pathlib.Path(__file__).with_name("page.css"))
    return page.partition("/* Of the page alone")[0] + STYLE


def placed(svg, left, top, width, height):
    return svg.replace("<svg", f'<svg x="{left}" y="{top}" width="{width}" height="{height}"', 1)


def panels(run, **options):
    """What moves, and what moves it; in a free motion the next coordinate, or the rate."""
    if run.is_process:
        return [plot.distance(run, mechanism.of(run).distances(), **options), plot.angles(run, **options)]
    made = [plot.angle(run, **options)] if run.angle else []
    if any(run.table["applied"]):
        made.append(plot.input_(run, **options))
    left = [c for c in run.system["coordinates"] if not c["is_angle"]]
    turning = [c["rate"] for c in run.system["coordinates"] if not run.is_process and c["name"] not in run.table]
    fields = turning or left + [c["rate"] for c in run.system["coordinates"]]
    return (made + [plot.state(run, field, **options) for field in fields[: 2 - len(made)]])[:2]


def picture(run):
    drawn = mechanism.of(run)
    last = run.duration if run.caught_at is None else min(run.duration, 1.7 * run.caught_at)
    parts = []
    if drawn is not None:
        begin, end = drawn.shown()
        parts = [
            f'<text class="title" x="20" y="18">{drawn.title()}, {begin:.1f} s to {end:.1f} s</text>',
            placed(mechanism.stroboscope(drawn, begin, end, drawn.poses), 15, 45, 320, 320),
        ]
    plot_width = PLOT_WIDTH if drawn is not None else ALONE
    width, height = round(SCALE * plot_width), round(SCALE * PLOT_HEIGHT)
    for i, panel in enumerate(panels(run, widths={"wide": plot_width}, xlim=(0, last))):
        svg = panel.svg("wide")
        parts.append(f'<g class="plot">{placed(svg, WIDTH - width, 4 + i * (height + 4), width, height)}</g>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}"><style>{style()}</style>'
        f'<rect class="paper" width="{WIDTH}" height="{HEIGHT}"/>{"".join(parts)}</svg>\n'
    )


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog="tools/report/picture.py", description="Draws one SVG of a run."
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
