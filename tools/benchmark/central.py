#!/usr/bin/env python3
"""Tables of tools/bench --central, in Markdown: the two central systems under a motor of any L/R, and in float.

usage: central.py BUILD [--quick] [--core N]
"""

import argparse
import math
import pathlib
import subprocess
import sys

import report
from systems import print_table

PROGRAMS = {"double": "benchmark_central_f64", "float": "benchmark_central_f32", "plain": "benchmark_central_plain"}
# Of central.c, in the order of the tables.
MOTORS = {"wheel_5_ms_held": "5 ms", "wheel_1_ms_held": "1 ms", "wheel_0.1_ms_held": "100 us", "wheel_10_us_held": "10 us",
          "wheel_0_held": "0"}  # fmt: skip
BESIDE = ("wheel_5_ms_held", "rk4")  # where it can follow: its kernel takes the same time for any L/R
FLOATS = {"cart_pole_free": ("cart-pole, free", "rk4"), "wheel_1_ms_held": ("reaction wheel, L/R 1 ms, held", "expo")}


def measure(folder, effort, rounds):
    """Errors, and least times, by (precision, scene, stepper). Programs take turns, so that a slow minute hits all."""
    errors, times = {}, {}
    there = {name: report.path(folder, file) for name, file in PROGRAMS.items() if report.path(folder, file).exists()}
    for turn in range(rounds):
        for name, file in there.items():
            if sys.stderr.isatty():
                print(f"\r\033[Kround {turn + 1} of {rounds}: {name}", end="", file=sys.stderr, flush=True)
            done = subprocess.run([file, report.path(folder, "references.txt"), *effort], capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"\n{file.name}: {done.stderr}")
            for line in done.stdout.splitlines():
                what, scene, stepper, *values = line.split()
                if what == "error":
                    errors[name, scene, stepper] = math.inf if values[0] == "refused" else float(values[0])
                else:
                    sample = times.setdefault((name, scene, stepper), report.Sample())
                    sample.times += [float(value) for value in values]
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    return errors, {key: sample.summary()["least"] for key, sample in times.items()}


def error_text(error):
    return "" if error is None else "refused" if math.isinf(error) else "lost" if math.isnan(error) else f"{error:.0e}"


def steppers_of(errors, precision, scenes):
    return list(dict.fromkeys(stepper for name, scene, stepper in errors if name == precision and scene in scenes))


def verdict(is_met):
    return "met" if is_met else "NOT met in this run"


def motors(errors, times, precision):
    """Error, and time beside rk4's, by stepper and L/R."""
    unit = times[(precision, *BESIDE)]
    print(f"\n### Held voltage, any L/R, {precision}\n")
    print("Reaction wheel, a new voltage of up to 5 V at every tick of 1 ms, one step a tick: largest error over 10 s, and "
          f"time beside that\nof `rk4` at L/R 5 ms in the same run ({unit:.0f} ns).\n")  # fmt: skip
    steppers = steppers_of(errors, precision, MOTORS)
    rows = []
    for scene, text in MOTORS.items():
        cells = []
        for stepper in steppers:
            key = (precision, scene, stepper)
            cells.append(error_text(errors.get(key)) + (f", {times[key] / unit:.2f}" if key in times else ""))
        rows.append([text, *cells])
    print_table(["L/R", *[f"`{stepper}`" for stepper in steppers]], rows)
    if precision == "double":
        error = max(errors[precision, scene, "expo"] for scene in MOTORS)
        ratio = max(times.get((precision, scene, "expo"), math.inf) / unit for scene in MOTORS)
        print(f"\n`expo`: at most {error:.1e} at {ratio:.2f} times `rk4`'s time. "
              f"Goal: within 1e-8 at no more than 1.3 times: {verdict(error <= 1e-8 and ratio <= 1.3)}.")  # fmt: skip


def floats(errors, times):
    """Both systems in float: with and without compensation."""
    print("\n### Float, with compensation and without\n")
    print("At 1 kHz, one step a tick: largest error over 10 s, nanoseconds a step, and time beside the same kernel that adds "
          "its increments without\ncompensation, built for this table alone.\n")  # fmt: skip
    rows, judged = [], []
    for scene, (text, choice) in FLOATS.items():
        for stepper in steppers_of(errors, "float", [scene]):
            keys = [(precision, scene, stepper) for precision in ("float", "plain")]
            if keys[0] not in times:
                continue
            error, ratio = errors[keys[0]], times[keys[0]] / times[keys[1]]
            if stepper == choice:
                judged.append((text, stepper, error, ratio))
            rows.append([text, f"`{stepper}`", *[error_text(errors[key]) for key in keys],
                         *[f"{times[key]:.1f}" for key in keys], f"{ratio:.2f}"])  # fmt: skip
    print_table(["scene", "stepper", "error", "error, not compensated", "ns", "ns, not compensated", "ratio"], rows)
    print()
    for text, stepper, error, ratio in judged:
        print(f"{text[0].upper()}{text[1:]}: `{stepper}` within {error:.1e} at {ratio:.2f} times the time. "
              f"Goal: within 5e-6 at no more than 1.1 times: {verdict(error <= 5e-6 and ratio <= 1.1)}.\n")  # fmt: skip


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--core", type=int)
    given = parser.parse_args()
    about = report.machine(given.build)
    core = report.pin(given.core)
    errors, times = measure(given.build, *report.effort_of(given.quick))
    print(f"Made on {about['cpu']}, {about['system']}, core {core}, load before {about['load']:.1f}, by {about['compiler']}, "
          f"{about['flags']}.\nTimes are the least of all samples: what else the machine does only adds. `lost`: an error of 1 or more.")  # fmt: skip
    precisions = list(dict.fromkeys(precision for precision, _, _ in errors))
    for precision in precisions:
        if precision != "plain":
            motors(errors, times, precision)
    if "plain" in precisions:
        floats(errors, times)
    return 0


if __name__ == "__main__":
    sys.exit(main())
