#!/usr/bin/env python3
"""Draws one SVG of a run, for the documentation: the swing that was caught, and angle and input over time.

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


def picture(run):
    drawn = mechanism.of(run)
    begin, end = mechanism.interesting(run)
    last = run.duration if run.caught_at is None else min(run.duration, 1.7 * run.caught_at)
    parts = [
        f'<text class="title" x="20" y="18">the swing that was caught, {begin:.1f} s to {end:.1f} s</text>',
        placed(mechanism.stroboscope(drawn, begin, end, 16), 15, 45, 320, 320),
    ]
    width, height = round(SCALE * PLOT_WIDTH), round(SCALE * PLOT_HEIGHT)
    for i, panel in enumerate((plot.angle, plot.input_)):
        svg = panel(run, widths={"wide": PLOT_WIDTH}, xlim=(0, last)).svg("wide")
        parts.append(f'<g class="plot">{placed(svg, WIDTH - width, 4 + i * (height + 4), width, height)}</g>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}"><style>{style()}</style>'
        f'<rect class="paper" width="{WIDTH}" height="{HEIGHT}"/>{"".join(parts)}</svg>\n'
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
