"""What the tests of runs over a bus share: pieces of steps, and how what came of them is read."""

import csv
import dataclasses
import io
import json
import re

from lab.machine import Step

PROTOCOLS = ("native", "vesc", "odrive")

# A strong supply shortens the swing-up: all protocols are upright by 1.9 s. Given to both sides.
SUPPLY = 50
SECONDS = 3.0

SCENE = "$IN/scene.toml"


def files(command, source):
    """What a machine is given."""
    return {"mctau": command, "scene.toml": source / "scenes" / "reaction_wheel.toml"}


def drive(name, interface, options=""):
    """Starts a virtual drive; $OUT/NAME.out is its JSON once it has been stopped."""
    return f"start {name} mctau drive {SCENE} --can {interface} --json {options}\n"


def run(name, interface, options=""):
    """Starts a run; it controls the motor when this returns."""
    return f"""start {name} mctau run {SCENE} --hal socketcan:{interface} {options}
        await 20 started {name}
    """


HELPERS = r"""
started() {
    grep -q "^Bus load" "$OUT/$1.err" || [ -e "$OUT/$1.code" ]
}
# keep FILE: the columns of a CSV file that are looked at; the others would take long to bring back.
keep() {
    awk -F, -v OFS=, '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^(applied|faults|volts|current)$/) kept[++n] = i }
        { line = $kept[1]; for (j = 2; j <= n; j++) line = line OFS $kept[j]; print line }' "$1" >"$1.kept"
    mv "$1.kept" "$1"
}
"""


def step(name, script, **options):
    """A step whose script may use drive, run and keep."""
    return Step(name, HELPERS + script, **options)


@dataclasses.dataclass
class Run:
    """What a run said. code: exit code; faults: names of those that were seen; counters: {name: count}."""

    code: int
    text: str
    error: str
    faults: list
    counters: dict


def run_of(result, name):
    text = result.text(f"{name}.out")
    bus = re.search(r"^On the bus\n((?:  .*\n)*)", text, re.M)
    counters = re.findall(r"^  (\w+) +(\d+)  ", bus[1], re.M) if bus else []
    return Run(
        code=int(result.text(f"{name}.code")),
        text=text,
        error=result.text(f"{name}.err"),
        faults=re.findall(r"^  (\w+), seen on \d+ ticks", text, re.M),
        counters={name: int(count) for name, count in counters},
    )


def drive_of(result, name):
    """What a drive said in JSON, once it is certain that it was stopped and all is well with it."""
    assert result.text(f"{name}.code") == "0\n", result.text(f"{name}.err")
    return json.loads(result.text(f"{name}.out"))


def table(result, file):
    """[{column: text}] of a CSV file."""
    return list(csv.DictReader(io.StringIO(result.text(file))))


def changes(rows, column):
    """The values of a column, each once as long as it lasts."""
    values = [row[column] for row in rows]
    return [value for i, value in enumerate(values) if i == 0 or value != values[i - 1]]
