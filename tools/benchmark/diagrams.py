#!/usr/bin/env python3
"""Draws work-precision diagrams from what tools/bench --peers --json has measured: one SVG for each scene.

usage: diagrams.py POINTS.json FOLDER

Each program is one line, its cheapest method and setting for every accuracy; this library's methods are drawn each,
too, in thin ones. Free and held motions of one mechanism are two pictures, peers-NAME-free.svg and peers-NAME-held.svg. Needs
matplotlib: build/venv/bin/python.
"""

import argparse
import json
import os
import pathlib
import sys

os.environ.setdefault("MPLBACKEND", "svg")
import matplotlib  # noqa: E402
from matplotlib import pyplot  # noqa: E402

OURS = "mctau"
COLOURS = {"mctau": "#000000", "mctau float": "#888888", "MuJoCo": "#d62728", "SUNDIALS": "#9467bd",
           "Boost.odeint": "#1f77b4", "GSL": "#2ca02c", "heyoka": "#ff7f0e"}
MARKERS = ["o", "s", "^", "v", "D", "P", "X", "<", ">", "*", "h", "p"]
LEAST, MOST = 1e-15, 1e-1  # errors shown


def front(points):
    """Those that no other of these is both cheaper and more accurate than, by error."""
    kept, least = [], float("inf")
    for point in sorted(points, key=lambda each: each["error"]):
        if point["ns_per_ms"] < least:
            least = point["ns_per_ms"]
            kept.append(point)
    return kept


def line(axes, points, **style):
    shown = sorted((each for each in points if LEAST <= each["error"] <= MOST), key=lambda each: each["ns_per_ms"])
    if shown:
        axes.plot([each["error"] for each in shown], [each["ns_per_ms"] for each in shown], **style)


def draw(scene, points, file):
    figure, axes = pyplot.subplots(figsize=(7.2, 4.8))
    methods = list(dict.fromkeys(each["method"] for each in points if each["program"] == OURS))
    for method, marker in zip(methods, MARKERS):
        line(axes, [each for each in points if each["program"] == OURS and each["method"] == method],
             color=COLOURS[OURS], alpha=0.45, linewidth=0.8, marker=marker, markersize=4, markerfacecolor="none",
             label=f"mctau {method}")
    for program in dict.fromkeys(each["program"] for each in points):
        line(axes, front([each for each in points if each["program"] == program]), color=COLOURS.get(program),
             linewidth=2.2 if program == OURS else 1.4, marker=".",
             linestyle="--" if program.startswith(f"{OURS} ") else "-", label=program)
    axes.set(xscale="log", yscale="log", xlabel="worst error over 10 s", ylabel="ns per simulated ms",
             title=scene["name"].replace("_", "-"))
    axes.invert_xaxis()
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=7, ncol=1, loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("points", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    given = parser.parse_args()
    measured = json.loads(given.points.read_text(encoding="utf-8"))
    if measured.get("schema") != "mctau.peers/1":
        sys.exit(f"diagrams.py: {given.points}: found schema {measured.get('schema')}; allowed mctau.peers/1")
    matplotlib.rcParams.update({"svg.hashsalt": "mctau", "svg.fonttype": "none", "font.size": 9})
    given.folder.mkdir(parents=True, exist_ok=True)
    for scene in measured["scenes"]:
        points = [each for each in measured["points"] if each["scene"] == scene["name"]]
        name = scene["name"].replace(" ", "-").replace(".", "_").replace("_", "-")
        draw(scene, points, given.folder / f"peers-{name}.svg")


if __name__ == "__main__":
    main()
