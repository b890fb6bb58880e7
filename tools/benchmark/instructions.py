"""Instructions of pieces of work, counted by callgrind: the same number in every run of one build."""

import collections
import pathlib
import subprocess
import tempfile

UNITS = 256  # MEASURE_COUNT of measure.h


def count(program):
    """Instructions per unit of work, by the name of the piece."""
    return {name: sum(each.values()) for name, each in count_each(program).items()}


def count_each(program):
    """Instructions per unit of work by the name of the piece, and by address in the program; all of libraries at 0.

    Each piece was done UNITS times, then twice as often, each between two marks: four parts of callgrind's file.
    What starting costs is in both and drops out.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "counts")
        done = subprocess.run(
            [
                "valgrind",
                "--tool=callgrind",
                "--dump-after=measure_mark",
                "--combine-dumps=yes",
                "--dump-line=no",
                "--dump-instr=yes",
                "--compress-pos=no",
                "--compress-strings=no",
                f"--callgrind-out-file={file}",
                program,
                "--count",
            ],
            capture_output=True,
            text=True,
        )
        if done.returncode:
            raise RuntimeError(f"{program}: {done.stderr}")
        parts = list(parts_of(file.read_text().splitlines(), f"ob={pathlib.Path(program).resolve()}"))
    names = [line.removeprefix("count ") for line in done.stdout.splitlines() if line.startswith("count ")]
    if len(parts) not in (4 * len(names), 4 * len(names) + 1):  # and perhaps the program's end
        raise RuntimeError(f"{program}: {len(names)} pieces of work in {len(parts)} parts")
    found = {}
    for i, name in enumerate(names):
        once, twice = parts[4 * i + 1], parts[4 * i + 3]
        found[name] = {at: (twice[at] - once[at]) / UNITS for at in twice | once if twice[at] != once[at]}
    return found


def parts_of(lines, program):
    """Instructions by address, of each part of callgrind's file."""
    part, is_own, is_inclusive = None, False, False
    for line in lines:
        if line.startswith("part:"):
            if part is not None:
                yield part
            part = collections.Counter()
        elif line.startswith("ob="):
            is_own = line == program
        elif line.startswith("calls="):
            is_inclusive = True  # the next line has what was called
        elif line.startswith("0x"):
            at, cost = line.split()
            if not is_inclusive:
                part[int(at, 16) if is_own else 0] += int(cost)
            is_inclusive = False
    yield part
