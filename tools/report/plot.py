"""Panels over time, drawn by matplotlib.

matplotlib draws in stand-ins for the colours of page.css, and in the SVG they become its variables: one
drawing serves light and dark. Each panel is drawn wide and narrow; page.css shows the one that can be read.
"""

import html
import io
import logging
import math
import re
import sys

from run_data import INPUT_OUTPUT, decimated, words

try:
    import matplotlib
    from matplotlib.figure import Figure
except ModuleNotFoundError as missing:
    print(f"tools/report: {missing}; tools/setup installs it into build/venv", file=sys.stderr)
    sys.exit(INPUT_OUTPUT)

WIDTHS = {"wide": 720, "narrow": 310}  # [px] of the drawing
HEIGHT = 118  # [px] of the axes
LEFT, RIGHT, BOTTOM, LINE = 44, 16, 20, 18  # [px] margins, and a line of text
COLUMNS = 1.2  # of decimation, a pixel

NAMES = ("paper", "ink", "soft", "hair", "true", "estimate", "limit", "target", "upright")
MODES = ("wait", "swing_up", "balance")
COLOURS = {name: f"#5eed{i:02x}" for i, name in enumerate(NAMES + MODES)}
LINES = {
    "true": {"color": COLOURS["true"], "linewidth": 1.1},
    "estimate": {"color": COLOURS["estimate"], "linewidth": 3, "alpha": 0.5},
    "wanted": {"color": COLOURS["soft"], "linewidth": 0.8},
}
LEFT_OUT = re.compile(  # prolog, size, metadata, a style for the whole page, ids without use, the font
    r'^.*?(?=<svg)| (?:width|height)="[\d.]+pt"|<metadata>.*?</metadata>|<style.*?</style>'
    r'| id="[\w.]+_\d+"|font-family: [^;]*; ',
    re.DOTALL,
)

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # not a word about its caches
matplotlib.rcdefaults()
matplotlib.rcParams.update(
    {
        "svg.fonttype": "none",
        "figure.dpi": 72,  # a point is a pixel
        "figure.facecolor": "none",
        "font.size": 10.5,
        "axes.facecolor": "none",
        "axes.edgecolor": COLOURS["hair"],
        "axes.xmargin": 0,
        "axes.ymargin": 0.06,
        "axes.titlelocation": "left",
        "axes.titlesize": "medium",
        "axes.titleweight": "semibold",
        "axes.titlecolor": COLOURS["ink"],
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": COLOURS["hair"],
        "xtick.bottom": False,
        "xtick.major.size": 0,
        "xtick.major.pad": 5,
        "ytick.left": False,
        "ytick.major.size": 0,
        "ytick.major.pad": 6,
        "xtick.labelcolor": COLOURS["soft"],
        "ytick.labelcolor": COLOURS["soft"],
        "legend.frameon": False,
        "legend.labelcolor": COLOURS["soft"],
        "legend.handlelength": 1.5,
        "legend.columnspacing": 1.4,
        "legend.borderpad": 0,
        "legend.borderaxespad": 0.35,
    }
)


class Plot:
    """One panel. Add what is to be seen, then ask for its html() or one svg(). `options` go to Axes.set."""

    def __init__(self, title, unit, run, widths=WIDTHS, **options):
        self.title = f"{title} [{unit}]"
        self.widths = widths
        self.axes = {}
        for layout, width in widths.items():
            axes = self.axes[layout] = Figure().add_axes((0, 0, 1, 1))
            axes.locator_params(steps=(1, 2, 5, 10))
            axes.locator_params(axis="x", nbins=width // 70)
            axes.set(**{"xlim": (0, run.duration)} | options)
            axes.xaxis.set_major_formatter("{x:g} s")
            axes.yaxis.set_major_formatter("{x:g}")
            for span in run.modes:
                if span.mode in MODES:
                    axes.axvspan(span.begin, span.end, color=COLOURS[span.mode], linewidth=0, zorder=0)
            for i, (time, name) in enumerate(run.faults):
                side, away = ("right", -4) if time > run.duration / 2 else ("left", 4)
                axes.axvline(time, color=COLOURS["limit"], linewidth=1.2)
                axes.annotate(
                    name,
                    (time, 0),
                    xycoords=axes.get_xaxis_transform(),
                    xytext=(away, 5 + LINE * i),
                    textcoords="offset points",
                    ha=side,
                    color=COLOURS["limit"],
                    bbox={"facecolor": COLOURS["paper"], "linewidth": 0, "pad": 1.5},
                    zorder=1.5,  # below the curves: it hides none
                )

    def line(self, times, values, kind, label, wraps=None):
        """A curve; `wraps`: a jump of more than this is no motion, and not drawn."""
        for layout, axes in self.axes.items():
            points = []
            columns = round(COLUMNS * self.widths[layout])
            for time, value in decimated(times, values, *axes.get_xlim(), columns):
                if wraps is not None and points and abs(value - points[-1][1]) > wraps:
                    points.append((time, float("nan")))
                points.append((time, value))
            axes.plot(*zip(*points), label=label, **LINES[kind])

    def levels(self, values, kind, label):
        """Dashed lines at limits or a target; not those far from the curves, which they would flatten."""
        for axes in self.axes.values():
            low, high = axes.dataLim.intervaly
            near = 0.5 * (high - low) or max(abs(high), 1e-9)
            seen = [value for value in values if low - near <= value <= high + near]
            if seen:
                style = {"color": COLOURS[kind], "linewidth": 1, "linestyle": (0, (5, 3.5)), "zorder": 1}
                axes.hlines(seen, *axes.get_xlim(), label=label, **style)

    def band(self, low, high, kind, label):
        for axes in self.axes.values():
            axes.axhspan(low, high, color=COLOURS[kind], linewidth=0, zorder=0.1, label=label)

    def html(self):
        return f'<figure class="plot">{"".join(map(self.svg, self.axes))}</figure>'

    def svg(self, layout):
        """One drawing; it has a viewBox and no size."""
        axes, width = self.axes[layout], self.widths[layout]
        low, high = axes.get_ylim()
        if low < 0 < high:
            axes.axhline(0, color=COLOURS["soft"], linewidth=0.6, zorder=0.6)
        inner = width - LEFT - RIGHT
        edge = -LEFT / inner  # of the drawing, as matplotlib counts: the axes go from 0 to 1
        top = LINE
        if keys := len(axes.get_legend_handles_labels()[1]):
            if layout == "wide":
                axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=keys)
            else:  # no room beside the title
                axes.legend(loc="lower left", bbox_to_anchor=(edge, 1), ncols=keys)
                top += LINE
        axes.set_title(self.title, x=edge, pad=top - LINE + 6)
        full = top + HEIGHT + BOTTOM
        axes.figure.set_size_inches(width / 72, full / 72)
        axes.set_position((LEFT / width, BOTTOM / full, inner / width, HEIGHT / full))
        file = io.StringIO()
        with matplotlib.rc_context({"svg.hashsalt": self.title + layout}):  # own ids, each time the same
            axes.figure.savefig(file, format="svg", metadata={"Date": None})
        svg = LEFT_OUT.sub("", file.getvalue())
        for name, colour in COLOURS.items():
            svg = svg.replace(colour, f"var(--{name})")
        label = html.escape(f"{self.title} over time")
        return svg.replace("<svg", f'<svg class="{layout}" role="img" aria-label="{label}"', 1)


def angle(run, **options):
    if "upright_coordinate" not in run.system:  # as it comes, whole turns included
        range_, degrees = {}, [math.degrees(value) for value in run.table[run.angle_name]]
    else:
        range_, degrees = {"ylim": (-200, 200), "yticks": range(-180, 181, 90)}, run.degrees
    origin = next((f" from {name}" for name in ("upright", "horizontal") if name in run.angle["doc"]), "")
    plot = Plot(words(run.angle_name), f"deg{origin}", run, **range_, **options)
    plot.line(run.time, degrees, "true", "", wraps=180)
    return plot


def angles(run, **options):
    """All of a process, whole turns included."""
    plot = Plot("angles", "deg", run, **options)
    for coordinate in run.system["coordinates"]:
        if coordinate["name"] in run.table:
            plot.line(run.time, [math.degrees(value) for value in run.table[coordinate["name"]]], "true", "")
    return plot


def distance(run, distances, **options):
    """What a process makes small; where it is exactly 0, it has no logarithm and is not drawn."""
    plot = Plot("from the tip to the target", "m", run, **{"yscale": "log"} | options)
    plot.line(run.time, [value or math.nan for value in distances], "true", "")
    return plot


def state(run, field, **options):
    """A coordinate or a rate, by its field of the catalogue."""
    plot = Plot(words(field["name"]), field["unit"], run, **options)
    plot.line(run.time, run.table[field["name"]], "true", "")
    return plot


def input_(run, **options):
    """What moves the mechanism, a voltage with its limits or a force."""
    name, unit = (
        ("voltage", "V")
        if run.scene.has_motor
        else (run.system["input_without_motor"]["name"], run.system["input_without_motor"]["unit"])
    )
    plot = Plot(name, unit, run, **options)
    if run.table["wanted"] != run.table["applied"]:
        plot.line(run.time, run.table["wanted"], "wanted", "wanted")
    plot.line(run.time, run.table["applied"], "true", "applied")
    if run.scene.has_motor and run.scene("effects", "saturation") not in (False, "false", "off"):
        supply = float(run.scene("parameters", "supply_voltage"))
        plot.levels((-supply, supply), "limit", "supply")
    return plot
