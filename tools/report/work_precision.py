#!/usr/bin/env python3
"""Draws what accuracy costs: error over time, a line for each stepper and precision; and a page with the table.

`mctau cost SCENE --plot FILE.svg --html FILE` calls it with what --json prints on its standard input:

build/host/mctau cost scenes/pendulum.toml --json | build/venv/bin/python tools/report/work_precision.py \\
    scenes/pendulum.toml pendulum.svg pendulum.html

To draw takes matplotlib: tools/setup, build/venv. An empty name is a file that is not wanted.
"""

import html
import io
import json
import pathlib
import sys

import plot
import run_data
from run_data import INPUT_OUTPUT, words

WIDTH, HEIGHT = 760, 460  # [px]
PALETTE = ("#d9730d", "#8c6bb1", "#2a9d8f", "#2f7fc1", "#c44e52", "#7a8b3c", "#b5838d", "#5f6caf", "#a67c00", "#4d908e")
INPUTS = {
    "free": "Free motion: a step may be longer than the tick.",
    "held": "The input is held over each tick, which is kept.",
    "replayed": "The inputs of one closed-loop run, held over each tick, are replayed without the controller.",
}


def drawn(costs):
    """The candidates with an error and a cost, by stepper and precision."""
    lines = {}
    for one in costs["candidates"]:
        if not one["diverged"] and one["ns_per_ms"]:
            lines.setdefault((one["stepper"], one["precision"]), []).append(one)
    return lines


def diagram(costs):
    """The drawing as SVG, with a viewBox and no size, in the colours of page.css."""
    figure = plot.Figure(figsize=(WIDTH / 72, HEIGHT / 72))
    axes = figure.add_axes((0.075, 0.105, 0.72, 0.83))
    floor = costs["reference"]["uncertainty"] or 1e-17
    colours = {name: PALETTE[i % len(PALETTE)] for i, name in enumerate(dict.fromkeys(s for s, _ in drawn(costs)))}
    for (stepper, precision), line in drawn(costs).items():
        is_double = precision == "double"
        axes.loglog(
            [one["ns_per_ms"] for one in line],
            [max(one["error_worst"], floor) for one in line],
            color=colours[stepper],
            linestyle="-" if is_double else (0, (2, 2)),
            linewidth=1.3,
            marker="o",
            markersize=3,
            label=stepper if is_double else f"{stepper}, float",
        )
    front = sorted((one["ns_per_ms"], max(one["error_worst"], floor)) for one in costs["candidates"] if one["pareto"])
    if front:
        axes.plot(*zip(*front), "o", color="none", markeredgecolor=plot.COLOURS["ink"], markersize=8, label="the front")
    axes.axhline(floor, color=plot.COLOURS["soft"], linewidth=0.8, linestyle=(0, (5, 3.5)), label="reference")
    axes.margins(0.04)
    axes.set_xlabel("nanoseconds per simulated millisecond", color=plot.COLOURS["soft"])
    axes.set_title(f"{words(costs['system'])}: worst error", pad=8)
    axes.minorticks_off()
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1))
    file = io.StringIO()
    with plot.matplotlib.rc_context({"svg.hashsalt": costs["system"]}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    svg = plot.LEFT_OUT.sub("", file.getvalue())
    for name, colour in plot.COLOURS.items():
        svg = svg.replace(colour, f"var(--{name})")
    return svg.replace("<svg", '<svg role="img" aria-label="worst error over cost"', 1)


def picture(costs):
    """The diagram as a file of its own."""
    page = run_data.read_text(pathlib.Path(__file__).with_name("page.css"))
    colours = page.partition("/* Of the page alone")[0]
    style = f"<style>{colours} .paper {{ fill: var(--paper); }}</style>"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">'
        f'{style}<rect class="paper" width="{WIDTH}" height="{HEIGHT}"/>{diagram(costs)}</svg>\n'
    )


def number(value, form):
    return "–" if value is None else format(value, form)


def rows(costs):
    for one in costs["candidates"]:
        cells = (
            "●" if one["pareto"] else "",
            one["stepper"],
            one["precision"],
            number(1e3 * one["step"], ".6g"),
            "diverged" if one["diverged"] else number(one["error_end"], ".1e"),
            number(one["error_worst"], ".1e"),
            number(one["ns_per_tick"], ".1f"),
            f"{number(one['ns_per_tick_low'], '.1f')} … {number(one['ns_per_tick_high'], '.1f')}",
            number(one["ns_per_ms"], ".1f"),
            number(one["instructions_per_tick"], ".0f"),
        )
        yield "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>"


def verification(costs):
    reference = costs["reference"]
    said = [f"The reference is {reference['stepper']} at {reference['substeps']} steps a tick, extrapolated to h = 0;"]
    if reference["verified"]:
        said.append(
            f"{reference['other_stepper']} at {reference['other_substeps']} agrees with it to {reference['agreement']:.1e}."
        )
    else:
        said.append("no second method suits, so it is not verified.")
    if costs["sensitive"]:
        said.append(
            f"The motion is sensitive to its start: measured are the first {costs['horizon']:g} s of {costs['duration']:g} s, in "
            "which a small difference grows at most 1e4 times."
        )
    return " ".join(said)


def instructions(costs):
    counter = {"processor": "by the processor", "valgrind": "by valgrind (callgrind)"}.get(costs["instructions_counted_by"])
    return f"Instructions are counted {counter}." if counter else f"Instructions: not counted: {costs['instructions_not_counted']}."


def page(costs, scene):
    css = run_data.read_text(pathlib.Path(__file__).with_name("page.css"))
    heads = ("front", "stepper", "precision", "step [ms]", "error at the end", "worst error", "ns per tick", "quartiles",
             "ns per ms", "instructions per tick")  # fmt: skip
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{words(costs["system"])}: what accuracy costs</title>
<style>{css} td, th {{ text-align: right; padding: .1rem .6rem; }} .wide-table {{ overflow-x: auto; }}</style></head><body>
<header><div class="kind"><span>mctau cost</span><span>{html.escape(scene)}</span></div>
<h1>What accuracy costs</h1><p class="lead">{html.escape(INPUTS[costs["input"]])} {html.escape(verification(costs))}</p></header>
<figure class="plot">{diagram(costs)}</figure>
<p class="note">An error is that of the worst state at the worst tick, relative to the state's largest value, or to 1 (SI) where
that is less. Circles: nothing is both cheaper and more accurate. {html.escape(instructions(costs))}</p>
<h2>Every candidate</h2><div class="wide-table"><table><thead><tr>{"".join(f"<th>{head}</th>" for head in heads)}</tr></thead>
<tbody>{"".join(rows(costs))}</tbody></table></div>
</body></html>
"""


def main(scene, svg, web):
    costs = json.load(sys.stdin)
    for path, made in ((svg, picture), (web, lambda c: page(c, scene))):
        if path:
            try:
                pathlib.Path(path).write_text(made(costs), encoding="utf-8")
            except OSError as error:
                print(f"mctau: {path}: the file cannot be written: {error.strerror}", file=sys.stderr)
                return INPUT_OUTPUT
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
