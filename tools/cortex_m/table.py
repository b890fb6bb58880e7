#!/usr/bin/env python3
"""Each stepper on this machine and on a Cortex-M4F, in float, as tables in Markdown.

usage: table.py [SCENE]...     from the repository's root; default: the scenes of the two central systems

For docs/generate: table.text(program, rest), where `program` runs the command and `rest` names scenes without .toml.
"""

import json
import os
import pathlib
import subprocess
import sys

import counts

SCENES = ("cart_pole", "reaction_wheel")
BUDGET = 168e3  # instructions of a millisecond at 168 MHz, were each of them a cycle
HEAD = ["stepper", "laptop, ns a tick", "instructions a tick", "Cortex-M4F, a step", "beside", "a tick", "most",
        "of 168 MHz at 1 kHz", "kernel, bytes"]  # fmt: skip


def on_this_machine(run, scene):
    """Of each stepper at one step a tick: nanoseconds and, where the system lets a program read them, instructions."""
    done = run("cost", scene, "--precision", "float", "--json")
    if not done.stdout:
        raise counts.Unavailable(f"mctau cost {scene}: {done.stderr.strip()}")
    costs = json.loads(done.stdout)
    return {
        one["stepper"]: (one["ns_per_tick"], one["instructions_per_tick"])
        for one in costs["candidates"]
        if one["substeps"] == 1 and one["dt"] == costs["tick"]
    }


def cell(value, digits=".0f"):
    return "-" if value is None else f"{value:{digits}}"


def table_of(run, name):
    scene = f"scenes/{name}.toml"
    here = on_this_machine(run, scene)
    measured = counts.measure(counts.ROOT / scene, "cortex-m4f", ["float"])
    lines = [f"`{name}`, {measured['ticks']} ticks:", "", "| " + " | ".join(HEAD) + " |", "|" + "---|" * len(HEAD)]
    for row in measured["steppers"]:
        ns, instructions = here.get(row["stepper"], (None, None))
        tick = row["tick"]["mean"]
        cells = [f"`{row['stepper']}`", cell(ns), cell(instructions), cell(row["step"]["mean"]), cell(row["beside"]),
                 cell(tick), cell(row["tick"]["most"]), f"{100 * tick / BUDGET:.2f} %", str(row["flash"])]  # fmt: skip
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n", measured["compiler"]


def text(program, rest=""):
    """Tables for docs/generate; program.run(*arguments) runs the command from the repository's root."""
    tables, compilers = zip(*(table_of(program.run, name) for name in rest.split() or SCENES))
    return f"\nCounted with {compilers[0]}.\n\n" + "\n".join(tables) + "\n"


class Command:
    def run(self, *arguments):
        command = os.environ.get("MCTAU", counts.host_build() / "mctau")
        return subprocess.run([command, *arguments], capture_output=True, text=True, cwd=counts.ROOT, check=False)


def main():
    try:
        print(text(Command(), " ".join(pathlib.Path(scene).stem for scene in sys.argv[1:])))
    except counts.BadScene as why:
        print(f"table.py: {why}", file=sys.stderr)
        return 2
    except (counts.Unavailable, OSError) as why:
        print(f"table.py: {why}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
