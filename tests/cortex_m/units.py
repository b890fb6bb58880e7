"""The C tests of src/ on an emulated Cortex-M, from one image of them for each target (units.c), as ctest calls it.

    python3 tests/cortex_m/units.py m4f build          builds the image
    python3 tests/cortex_m/units.py m4f test_matrix    runs a test of it

Exit code 0: good; 77: skipped, and why; else what is wrong is said.
"""

import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/cortex_m"))
import counts  # noqa: E402

IMAGES = {"m4f": ("cortex-m4f", "units_f32"), "m7": ("cortex-m7", "units_f64")}
SECONDS = 100  # ctest's own limit, which says less, is longer
SKIPPED, FAULT = 77, 70  # the latter as in hal/cortex_m/semihosting.h
SUMMARY = re.compile(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", re.MULTILINE)


def verdict(code, printed):
    """What is wrong with a run, or None."""
    summary = SUMMARY.search(printed)
    if summary is None:
        why = "the processor stopped at a fault" if code == FAULT else f"exit code {code}"
        return f"{why}; the test did not come to its end"
    if code or not int(summary[1]) or int(summary[2]) or int(summary[3]):
        return f"exit code {code}, {summary[0]}"
    return None


def run(kind, test):
    image = counts.ROOT / f"build/cortex-{kind}" / f"{IMAGES[kind][1]}.elf"
    command = [counts.ROOT / "hal/cortex_m/run", "--uncounted", kind, image, test]
    try:
        done = subprocess.run(command, cwd=counts.ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=SECONDS)  # fmt: skip
    except subprocess.TimeoutExpired as late:
        print((late.stdout or b"").decode(errors="replace"))
        return f"no end within {SECONDS} s"
    printed = done.stdout.decode(errors="replace")
    print(printed, end="")
    return verdict(done.returncode, printed)


def main():
    kind, what = sys.argv[1:]
    why = counts.missing()
    if os.environ.get("MCTAU_SANITIZE"):
        why = "the images would be those of the preset host"
    elif not why and not (counts.ROOT / "build/unity/unity.c").exists():
        why = "Unity's source is not in build/unity"
    if why:
        print(f"skipped: {why}")
        return SKIPPED
    wrong = None
    try:
        if what == "build":
            counts.build_target(*IMAGES[kind])
        else:
            wrong = run(kind, what)
    except counts.Unavailable as unavailable:
        wrong = unavailable
    if wrong:
        print(f"{what} on the {kind}: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
