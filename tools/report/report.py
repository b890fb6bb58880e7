#!/usr/bin/env python3
"""Makes one HTML page of a run: what happened, the mechanism drawn, plots, the scene, how to run it again.

The page stands alone: no script, no download. To make it takes matplotlib: tools/setup, build/venv.
"""

import argparse
import html
import math
import os
import pathlib
import shlex
import sys

import mechanism
import plot
import run_data
from run_data import ROOT, words

HERE = pathlib.Path(__file__).resolve().parent
VERDICTS = {
    "balanced": ("Balanced", "good"),
    "not_balanced": ("Not balanced", "bad"),
    "faulted": ("Faulted", "bad"),
    "diverged": ("Diverged", "bad"),
    "stopped": ("Stopped", "bad"),
    "finished": ("Finished", ""),
}


def lead(run):
    """What happened, in plain sentences."""
    result, said = run.result, []
    if run.controlled and run.caught_at is not None:
        if run.degrees and abs(run.degrees[0]) > 90:
            said.append(f"From hanging, the {words(run.name)} swung itself up in {run.caught_at:.2f} s.")
        else:
            said.append(f"Balancing began at {run.caught_at:.2f} s.")
        if result["upright_at"] is not None:
            said.append(
                f"Since {result['upright_at']:.2f} s it has stood within {run_data.UPRIGHT:g} degrees "
                "of upright, "
                f"and in the last half of that time within {run.worst_degrees(settled(run)):.2f} degrees."
            )
    elif run.controlled and run.last_balance is not None:
        said.append(
            f"The {words(run.name)} balanced from {run.last_balance.begin:.2f} s to "
            f"{run.last_balance.end:.2f} s, "
            "and not at the end."
        )
    elif run.controlled:
        nearest = min(abs(d) for d in run.degrees)
        said.append(
            f"In {run.duration:g} s the {words(run.name)} came to within {nearest:.1f} degrees of upright, "
            "but was not balancing at the end."
        )
    elif run.is_process:
        way = mechanism.of(run).distances()
        said.append(f"The tip of the {words(run.name)} went from {way[0]:.3g} m to {way[-1]:.3g} m from its target.")
    else:
        kind = run.scene("input", "kind")
        moved = "free motion" if kind in (None, "none") else f"open-loop motion under the input {kind}"
        said.append(f"{run.duration:g} s of {moved} of the {words(run.name)}, without a controller.")
    if run.faults:
        time, name = run.faults[0]
        said.append(f"At {time:.3f} s the supervisor latched {name}: zero volts from there on.")
    if result["verdict"] == "diverged":
        said.append("The simulation left all bounds; the last sane state was kept.")
    return " ".join(said)


def spoken(run):
    """The same for a terminal, with the speed."""
    verdict, _ = VERDICTS.get(run.result["verdict"], (run.result["verdict"], ""))
    sentences = [f"{verdict}.", *lead(run).split(". ")]
    sentences = [sentence if sentence.endswith(".") else sentence + "." for sentence in sentences]
    ns = run.result["ns_per_tick"]
    if not run.scene("scene", "realtime") and ns > 0:
        fast = "" if run.is_process else f", which is {1e9 * run.result['dt'] / ns:.0f} times real time"
        sentences.append(f"A tick took {ns:.0f} ns{fast}.")
    return "\n".join(f"  {sentence}" for sentence in sentences)


def settled(run):
    begin = run.result["upright_at"]
    return begin + 0.5 * (run.duration - begin)


def figures(run):
    """(what, value, unit) of the tiles."""
    result, found = run.result, []
    if run.caught_at is not None:
        found.append(("swing-up took", f"{run.caught_at:.2f}", "s"))
    if result["upright_at"] is not None and run.controlled:
        found.append(("upright since", f"{result['upright_at']:.2f}", "s"))
        found.append(("deviation, settled, rms", f"{run.rms_degrees(settled(run)):.3f}", "deg"))
    if run.name == "cart_pole":
        found.append(("cart went as far as", f"{max(map(abs, run.table['cart_position'])):.3f}", "m"))
    elif run.name == "reaction_wheel":
        found.append(("fastest wheel", f"{max(map(abs, run.table['wheel_rate'])):.0f}", "rad/s"))
    elif run.is_process:
        found.append(("from the tip to the target", f"{mechanism.of(run).distances()[-1]:.3g}", "m"))
    else:
        rate = run.system["coordinates"][0]["rate"]
        largest = max(map(abs, run.table[rate["name"]]))
        found.append((f"largest {words(rate['name'])}", f"{largest:.3g}", rate["unit"]))
    if run.scene.has_motor:
        found.append(("largest voltage", f"{max(map(abs, run.table['applied'])):.2f}", "V"))
    elif not run.is_process:
        change = result["energy"] - result["energy_start"]
        found.append(("energy, from beginning to end", f"{change:+.3g}".replace("-", "\u2212"), "J"))
    if not run.is_process and not run.scene("scene", "realtime") and result["ns_per_tick"] > 0:
        found.append(("speed", f"{1e9 * result['dt'] / result['ns_per_tick']:.0f}", "\u00d7 real time"))
    found.append(("faults", str(len(run.faults)) if run.faults else "none", ""))
    return found


def pictures(run):
    drawn = mechanism.of(run)
    if drawn is None:
        return ""
    begin, end = drawn.shown()
    poses = drawn.poses
    every = (end - begin) / (poses - 1)
    film_end = run.duration if run.caught_at is None else min(run.duration, run.caught_at * 1.12 + 0.2)
    frames = mechanism.film(drawn, 0.0, film_end - run.result["dt"], drawn.frames)
    strip = "".join(f'<figure class="{mode}">{svg}{time:.2f} s</figure>' for time, mode, svg in frames)
    return (
        f'<h2>Motion</h2><div class="pictures"><figure>{mechanism.stroboscope(drawn, begin, end, poses)}'
        f'<figcaption class="note">{drawn.title()[0].upper()}{drawn.title()[1:]}: from {begin:.2f} s, '
        f'one pose every {1e3 * every:.0f} ms, '
        'the later '
        f'the darker.</figcaption></figure><div><div class="film" '
        f'style="--frame:{drawn.frame_width}px">{strip}</div>'
        f'<p class="note">{len(frames)} moments at equal times, each with the path of the half second '
        'before it.</p>'
        "</div></div>"
    )


def plots(run):
    """All panels, in the order in which they are read."""
    time, table = run.time, run.table
    upright = run.result["upright_at"] if run.controlled else None
    if run.is_process:
        return [plot.distance(run, mechanism.of(run).distances()), plot.angles(run)]
    made = [plot.angle(run)] if run.angle else []

    def panel(title, unit, **options):
        made.append(plot.Plot(title, unit, run, **options))
        return made[-1]

    def estimated(panel, name):
        if run.controlled:
            panel.line(time, table[f"{name}_estimate"], "estimate", "estimated")
        panel.line(time, table[name], "true", "true" if run.controlled else "")

    if upright is not None and run.duration - upright > 0.5:
        limit = 1.25 * run_data.UPRIGHT
        near = panel(f"{words(run.angle_name)}, near upright", "deg", ylim=(-limit, limit))
        near.band(-run_data.UPRIGHT, run_data.UPRIGHT, "upright", f"within {run_data.UPRIGHT:g} deg")
        estimate = [run_data.folded(math.degrees(angle)) for angle in table[f"{run.angle_name}_estimate"]]
        near.line(time, estimate, "estimate", "estimated", wraps=180)
        near.line(time, run.degrees, "true", "true", wraps=180)
    if any(table["applied"]):
        made.append(plot.input_(run))
    for coordinate in run.system["coordinates"]:
        name, rate = coordinate["name"], coordinate["rate"]["name"]
        if not coordinate["is_angle"] and name in table:  # of a rotation there is a quaternion
            position = panel(words(name), coordinate["unit"])
            estimated(position, name)
            if run.controlled:
                track = float(run.scene("controller", "track_half_length"))
                position.levels((-track, track), "limit", "end of the track")
        estimated(panel(words(rate), coordinate["rate"]["unit"]), rate)
    if "current" in table:
        panel("current", "A").line(time, table["current"], "true", "")
    if run.energy:
        energy = panel("energy of the model" if run.is_varied else "energy", "J")
        energy.line(time, run.energy, "true", "kinetic + potential")
        energy.levels((run.upright_energy,), "target", "at rest upright")
    return made


def mode_key(run):
    names = dict.fromkeys(span.mode for span in run.modes if span.mode != "open_loop")
    return "".join(
        f'<span class="key"><i class="swatch {name}"></i>{words(name)}</span> ' for name in names
    )


def command_lines(run):
    sets = "".join(f" --set {shlex.quote(override)}" for override in run.scene.overrides)
    scene = shlex.quote(run.scene.path)
    ledger = " --ledger" if "ledger" in run.result else ""
    return (
        f"mctau run {scene}{sets}{ledger} --csv run.csv --json > run.json\n"
        "build/venv/bin/python tools/report/report.py --csv run.csv --json run.json "
        f"--scene {scene}{sets} -o report.html"
    )


def fault_table(run):
    if not run.faults:
        return ""
    rows = "".join(
        f'<tr><td>{html.escape(name)}<td class="n">{time:.3f} s<td class="n">'
        f'{run.result["fault_ticks"].get(name, 0)}'
        for time, name in run.faults
    )
    return (
        '<h2>Faults</h2><p class="note">What each one means and what to do: docs/control.md.</p><div '
        'class="scroll"><table>'
        f"<tr><th>fault<th>first latched<th>seen on ticks{rows}</table></div>"
    )


def ledger_table(run):
    """Of a run with --ledger."""
    if "ledger" not in run.result:
        return ""
    ledger = run.result["ledger"]
    entries = {words(name): work for name, work in ledger["works"].items()}
    entries |= {name: sum(ledger[name].values()) for name in ("stepper", "unexplained")}
    rows = "".join(f'<tr><td>{name}<td class="n">{value:.6g}' for name, value in entries.items())
    return (
        '<h2>Where the energy came from</h2><p class="note">The work of each effect, and what the stepper added; what '
        'each means: docs/ledger.md.</p><div class="scroll"><table>'
        f"<tr><th>entry<th>work [J]{rows}</table></div>"
    )


def final_state(run):
    rows = "".join(
        f'<tr><td>{name}<td class="n">{run.result["state"][name]!r}<td class="n">'
        f'{run.result["state_hex"][name]}'
        for name in run.result["state"]
    )
    return (
        '<h2>State at the end</h2><p class="note">The same scene gives the same bits again.</p><div '
        'class="scroll"><table>'
        f"<tr><th>state<th>SI units<th>bits{rows}</table></div>"
    )


def page(run):
    result = run.result
    verdict, tone = VERDICTS.get(result["verdict"], (words(result["verdict"]), ""))
    tiles = "".join(
        f"<div><dt>{html.escape(what)}</dt><dd>{html.escape(value)} <small>{html.escape(unit)}</small>"
        "</dd></div>"
        for what, value, unit in figures(run)
    )
    panels = "".join(panel.html() for panel in plots(run))
    sets = "".join(f"\n# from the command line: {override}" for override in run.scene.overrides)
    version = run.command.text("--version")
    varied = (
        '<p class="note">The plant was varied; energies are those of the scene\'s own parameters.</p>'
        if run.is_varied
        else ""
    )
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{words(run.name)}: {verdict.lower()}</title>
<style>{(HERE / "page.css").read_text(encoding="utf-8")}</style></head><body>
<header><div class="kind"><span>mctau run</span><span>{html.escape(run.scene.path)}</span></div>
<h1 class="{tone}">{verdict}</h1><p class="lead">{html.escape(lead(run))}</p></header>
<dl class="figures">{tiles}</dl>
{fault_table(run)}
{pictures(run)}
<h2>Over time</h2><p class="note">{mode_key(run)}</p>{varied}{panels}
{ledger_table(run)}
{final_state(run)}
<h2>Scene</h2><pre>{html.escape(run.scene.text.rstrip() + sets)}</pre>
<h2>How to run it again</h2><pre>{html.escape(command_lines(run))}</pre>
<p class="note">{html.escape(version)}; {run.name}, stepper {result["stepper"]},
precision {result["precision"]}, tick {result["dt"]:g} s,
{result["ticks"]} ticks. Each curve shows the smallest and the largest value within a pixel's width.</p>
</body></html>
"""


def arguments(argv):
    parser = argparse.ArgumentParser(
        prog="tools/report/report.py",
        description="Makes one HTML page of a run.",
        epilog="exit codes: 0 well, 2 wrong input, 3 a file could not be read or written",
    )
    parser.add_argument("--csv", required=True, help="what mctau run --csv wrote")
    parser.add_argument("--json", required=True, help="what mctau run --json printed")
    parser.add_argument("--scene", required=True, help="the scene's file")
    parser.add_argument(
        "--set", action="append", default=[], metavar="TABLE.KEY=VALUE", help="as given to mctau run"
    )
    parser.add_argument(
        "--mctau", default=os.environ.get("MCTAU", str(ROOT / "build" / "host" / "mctau")), help="the command"
    )
    parser.add_argument("-o", "--output", required=True, help="the page to write")
    parser.add_argument("--say", action="store_true", help="say on stdout what happened, too")
    return parser.parse_args(argv)


def main(argv=None):
    given = arguments(argv)
    try:
        run = run_data.Run(given.csv, given.json, given.scene, given.set, run_data.Command(given.mctau))
        text = page(run)
        try:
            pathlib.Path(given.output).write_text(text, encoding="utf-8")
        except OSError as error:
            raise run_data.Complaint(
                f"{given.output}: the page cannot be written: {error.strerror}", run_data.INPUT_OUTPUT
            ) from None
        if given.say:
            print(spoken(run))
    except run_data.Complaint as complaint:
        print(f"report: {complaint}", file=sys.stderr)
        return complaint.code
    return 0


if __name__ == "__main__":
    sys.exit(main())
