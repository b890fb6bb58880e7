#!/usr/bin/env python3
"""Table of tools/bench --effects, in Markdown: what each effect adds to a step of each system, and to its kernel.

usage: effects.py BUILD [--quick] [--core N]
"""

import argparse
import pathlib
import shutil
import sys

import instructions
import report

PROGRAM = {"double": ["benchmark_effects_f64"]}


def added(amounts, digits=".0f"):
    """What the first is more than the second."""
    if None in amounts:
        return "-"
    text = f"{amounts[0] - amounts[1]:+{digits}}"
    return "0" if float(text) == 0 else text


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--core", type=int)
    given = parser.parse_args()
    if shutil.which("valgrind") is None:
        sys.exit("tools/bench: --effects counts instructions by valgrind, which is not there; run tools/setup")
    about = report.machine(given.build)
    print(f"Made on {about['cpu']}, {about['system']}, by {about['compiler']}, {about['flags']}.\n")
    report.pin(given.core)
    times, said, _ = report.run_all(given.build, *report.effort_of(given.quick), PROGRAM)
    counts = instructions.count(report.path(given.build, PROGRAM["double"][0]))

    def row_of(*names):
        flash = [int(said.get("/".join(["flash", *name.split()]), -1)) for name in names]
        return ([counts.get(name) for name in names],
                [times["double", name]["median"] if ("double", name) in times else None for name in names],
                [None if each < 0 else each for each in flash])  # fmt: skip

    print("| system, stepper | effect | instructions | ns | flash, bytes |\n" + "| --- " * 5 + "|")
    for name in counts:
        system, stepper, effect, which = name.split()
        first = f"| `{system}`, `{stepper}` | "
        if effect == "defaults":
            (count,), (time,), (flash,) = row_of(name)
            print(f"{first}(all defaults) | {count:.0f} | {time:.0f} | {'-' if flash is None else flash} |")
        elif which == "with":
            other = name.removesuffix("with") + "without"
            if other not in counts:  # a stepper that needs the effect
                continue
            count, time, flash = row_of(name, other)
            label = effect.removesuffix("=on").replace("=", " = ")
            print(f"{first}{label} | {added(count)} | {added(time)} | {added(flash)} |")


if __name__ == "__main__":
    main()
