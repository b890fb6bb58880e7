"""Instructions of pieces of work, counted by callgrind: the same number in every run of one build."""

import pathlib
import re
import subprocess
import tempfile

UNITS = 256  # MEASURE_COUNT of measure.h


def count(program):
    """Instructions per unit of work, by the name of the piece.

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
                f"--callgrind-out-file={file}",
                program,
                "--count",
            ],
            capture_output=True,
            text=True,
        )
        if done.returncode:
            raise RuntimeError(f"{program}: {done.stderr}")
        parts = [int(total) for total in re.findall(r"^totals: (\d+)$", file.read_text(), re.MULTILINE)]
    names = [line.removeprefix("count ") for line in done.stdout.splitlines() if line.startswith("count ")]
    if len(parts) not in (4 * len(names), 4 * len(names) + 1):  # and perhaps the program's end
        raise RuntimeError(f"{program}: {len(names)} pieces of work in {len(parts)} parts")
    return {name: (parts[4 * i + 3] - parts[4 * i + 1]) / UNITS for i, name in enumerate(names)}
