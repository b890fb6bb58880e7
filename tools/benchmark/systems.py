#!/usr/bin/env python3
"""Tables of tools/bench --systems and --drift, in Markdown: what each system costs, and what each stepper keeps.

usage: systems.py BUILD [--quick] [--core N]
       systems.py BUILD --drift STEPS [--scene SYSTEM or STEPPER]...
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

import instructions
import report

DRIFT = {"double": "benchmark_drift_f64", "float": "benchmark_drift_f32"}


def print_table(head, rows):
    for row in [head, ["---"] * len(head), *rows]:
        print("| " + " | ".join(row) + " |")


def whole(value):
    return "" if value is None else f"{value:.0f}"


def costs(folder, quick, core):
    about = report.machine(folder)
    print(f"Made on {about['cpu']}, {about['system']}, by {about['compiler']}, {about['flags']}.\n")
    report.pin(core)
    times, _, missing = report.run_all(folder, *report.effort_of(quick), report.SYSTEMS)
    precisions = [name for name in report.SYSTEMS if name not in missing]
    if shutil.which("valgrind") is None:
        sys.exit("tools/bench: --systems counts instructions by valgrind, which is not there; run tools/setup")
    counts = {name: instructions.count(report.path(folder, report.SYSTEMS[name][0])) for name in precisions}
    names = list(counts[precisions[0]])

    head = ["system", "stepper"] + [f"{name}, {unit}" for name in precisions for unit in ("ns", "instructions")]
    rows = []
    for name in names:
        group, system, *words = name.split()
        if group not in ("plant", "evaluate"):
            continue
        row = [f"`{system}`", f"`{words[0]}`" if words else "(evaluate)"]
        for precision in precisions:
            time = times.get((precision, name))
            row += ["" if time is None else f"{time['median']:.0f}", whole(counts[precision].get(name))]
        rows.append(row)
    print_table(head, rows)

    listed = {}
    for name in names:
        if len(name.split()) == 4:
            group, system, what, number = name.split()
            listed.setdefault((system, group, what), {})[int(number)] = counts[precisions[0]][name]
    numbers = sorted({number for cells in listed.values() for number in cells})
    print(f"\nInstructions by how many particles or coordinates are listed, in {precisions[0]}:\n")
    print_table(
        ["system", "listed", "", *map(str, numbers)],
        [
            [f"`{system}`", group, what, *[whole(cells.get(number)) for number in numbers]]
            for (system, group, what), cells in listed.items()
        ],
    )


def drifts(folder, steps, systems):
    found = {}  # (system and what, stepper): {precision: drift}
    runs = {name: report.path(folder, file) for name, file in DRIFT.items() if report.path(folder, file).exists()}
    for precision, file in runs.items():
        done = subprocess.run([file, str(steps), *systems], stdout=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(done.returncode)
        for line in done.stdout.splitlines():
            _, stepper, drift, what = line.split(maxsplit=3)
            found.setdefault((what, stepper), {})[precision] = float(drift)
    steppers = list(dict.fromkeys(stepper for _, stepper in found))

    def cell(drifts):
        return " / ".join("lost" if each > 0.5 else f"{each:.0e}" if each else "0" for each in drifts)

    def worst(kind, stepper):
        fitting = [drifts for (what, by), drifts in found.items() if by == stepper and what.endswith(f", {kind}")]
        return [max(drifts[precision] for drifts in fitting) for precision in runs if fitting]

    print(f"Largest relative drift over {steps:.0e} steps of 1 ms, {' / '.join(runs)}; "
          f"{'the worst of all systems' if not systems else 'of ' + ', '.join(systems)}:\n")  # fmt: skip
    kinds = list(dict.fromkeys(what.split(", ")[1] for what, _ in found))
    print_table(
        ["stepper", *kinds], [[f"`{stepper}`", *[cell(worst(kind, stepper)) for kind in kinds]] for stepper in steppers]
    )
    print("\nOf each system, without what all of its steppers keep exactly:\n")
    rows = {}
    for (what, stepper), drifts in found.items():
        if any(any(of.values()) for (other, _), of in found.items() if other == what):
            rows.setdefault(what, {})[stepper] = cell(drifts.values())
    print_table(
        ["system", "", *[f"`{stepper}`" for stepper in steppers]],
        [[f"`{what.split(', ')[0]}`", what.split(", ")[1], *[cells.get(each, "") for each in steppers]]
         for what, cells in rows.items()],
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--core", type=int)
    parser.add_argument("--drift", type=int)
    parser.add_argument("--scene", action="append", default=[])
    given = parser.parse_args()
    if given.drift:
        drifts(given.build, given.drift, given.scene)
    else:
        costs(given.build, given.quick, given.core)


if __name__ == "__main__":
    main()
