#!/usr/bin/env python3
"""Runs the benchmarks of a build folder in turns, pinned to one core, and prints the table of tools/bench.

usage: report.py BUILD [--quick] [--json] [--core N]
"""

import argparse
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys

GOAL_STEP = 80
GOAL_TICK = 400
GOAL_BUS = 1000  # more than the tick itself: receive, decode, encode, send
SYSTEMS = {"double": ["benchmark_systems_f64"], "float": ["benchmark_systems_f32"]}
PROGRAMS = {"double": ["benchmark_systems_f64", "benchmark_ticks_f64"],
            "float": ["benchmark_systems_f32", "benchmark_ticks_f32"],
            "mujoco": ["benchmark_mujoco"]}
PEERS = {"mujoco": "MuJoCo (PyPI's mujoco, installed by tools/setup)"}
# Each integrator of MuJoCo, and what stands beside it here.
COUNTERPARTS = {"RK4": ["rk4"], "Euler": ["euler", "seed"], "implicitfast": ["euler", "leap"]}
SAME_MOTION = 1e-6


class Sample:
    """All times of one piece of work [ns]."""

    def __init__(self):
        self.times = []

    def summary(self):
        quartiles = statistics.quantiles(self.times, n=4)
        return {"median": statistics.median(self.times), "quartile_1": quartiles[0],
                "quartile_3": quartiles[2], "least": min(self.times), "samples": len(self.times)}


def path(folder, program):
    return folder / "tools" / "benchmark" / program


def run_all(folder, effort, rounds, programs):
    """Times by (program, name), what else was printed, and which programs are missing.

    Programs take turns, so that a slow minute hits all.
    """
    samples, said = {}, {}
    there = [(name, path(folder, file)) for name, files in programs.items() for file in files]
    there = [(name, file) for name, file in there if file.exists()]
    for turn in range(rounds):
        if sys.stderr.isatty():
            print(f"\rround {turn + 1} of {rounds}", end="", file=sys.stderr, flush=True)
        for name, file in there:
            done = subprocess.run([file, *effort], capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"\n{file.name}: {done.stderr}")
            for line in done.stdout.splitlines():
                words = line.split()
                if words[0] != "ns":
                    said[words[0]] = words[1]
                    continue
                numbers = [i for i in range(len(words)) if words[i].replace(".", "", 1).isdigit()]
                key = (name, " ".join(words[1:numbers[0]]))
                samples.setdefault(key, Sample()).times += [float(words[i]) for i in numbers]
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    missing = sorted(set(programs) - {name for name, _ in there})
    return {key: sample.summary() for key, sample in samples.items()}, said, missing


def machine(folder):
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    cpu = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")),
               platform.processor())
    cache = (folder / "CMakeCache.txt").read_text().splitlines()
    setting = dict(line.split("=", 1) for line in cache
                   if "=" in line and not line.startswith(("#", "//")))
    compiler = next((value for key, value in setting.items() if key.startswith("CMAKE_C_COMPILER:")), "cc")
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    flags = " ".join(value for key, value in setting.items()
                     if key.startswith(("CMAKE_C_FLAGS:", "CMAKE_C_FLAGS_RELEASE:")) and value)
    return {"cpu": cpu, "cores": os.cpu_count(), "system": f"{platform.system()} {platform.machine()}",
            "compiler": version, "flags": flags, "load": os.getloadavg()[0]}


def cell(results, program, name):
    found = results.get((program, name))
    if found is None:
        return f"{'-':>20}"
    spread = (found["quartile_3"] - found["quartile_1"]) / 2
    return f"{found['median']:9.1f} +-{spread:7.1f}"


def print_table(results, said, missing, about, core):
    print(f"On {about['cpu']}, core {core} of {about['cores']} (load before: {about['load']:.1f}),"
          f" {about['compiler']}, {about['flags']}")
    print("Nanoseconds: median +- half the distance of the quartiles. Steps one after another, of 1 ms.\n")

    names = [name for program, name in results if program == "double"] or \
            [name for program, name in results if program == "float"]

    def rows(title, group, goal_of):
        print(f"{title:<42}{'double [ns]':>20}{'float [ns]':>20}   goal")
        for name in [each for each in names if each.startswith(group)]:
            goal = goal_of(name)
            text = ""
            if goal:
                worst = max(results[key]["median"] for key in results if key[1] == name)
                text = f"at most {goal}: {'met' if worst <= goal else 'NOT met in this run'}"
            print(f"  {name.removeprefix(group):<40}{cell(results, 'double', name):>20}"
                  f"{cell(results, 'float', name):>20}   {text}".rstrip())
        print()

    rows("A step of a kernel alone", "kernel ",
         lambda name: GOAL_STEP if name == "kernel cart_pole rk4" else None)
    rows("A plant step: bounds and checks as well", "plant ",
         lambda name: GOAL_STEP if name == "plant cart_pole rk4" else None)
    rows("M, C, tau and all that follows", "evaluate ", lambda name: None)
    rows("A whole tick in lockstep, ring included", "tick ", lambda name: GOAL_TICK)
    rows("The same over a bus, both ends of it", "bus ",
         lambda name: GOAL_BUS)

    for program in missing:
        print(f"missing: {PEERS.get(program, program + ' precision, not built')}")
    if ("mujoco", "peer RK4") not in results:
        return
    print(f"MuJoCo {said['version']} beside the plant step, same cart-pole under a held force, double [ns]")
    for integrator, ours in COUNTERPARTS.items():
        theirs = results["mujoco", f"peer {integrator}"]
        medians = {each: results["mujoco", f"forced {each}"]["median"] for each in ours}
        ratios = ", ".join(f"{theirs['median'] / median:.0f} x {each} ({median:.1f})"
                           for each, median in medians.items())
        print(f"  mj_step {integrator:<32}{cell(results, 'mujoco', f'peer {integrator}'):>20}   = {ratios}")
    print(f"  greatest difference of the two motions, RK4 on both, 10 s: {said['difference']}"
          f" (must be below {SAME_MOTION:g})\n")
    print("How to read it: MuJoCo runs any tree of bodies, with contacts, from a model read at run time;\n"
          "its cost is its generality. Here contacts, constraints, actuators, sensors and energy are off in\n"
          "it. Ours is one closed form, compiled. The point mass has 1e-14 kg m^2 in MuJoCo, which wants an\n"
          "inertia. Both run in this same run, on the same core. Compare ratios between machines, not times.")


def pin(core):
    """Pins this process to a core, the last one by default; gives its number, None where that cannot be done."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    allowed = sorted(os.sched_getaffinity(0))
    core = allowed[-1] if core is None else core
    if core not in allowed:
        print(f"tools/bench: --core: found {core}; allowed {', '.join(map(str, allowed))}", file=sys.stderr)
        sys.exit(2)
    os.sched_setaffinity(0, {core})
    return core


def effort_of(quick):
    """Options of a program that measures, and how many rounds of it."""
    return (["--samples", "5", "--sample-us", "500"], 3) if quick else (["--samples", "9", "--sample-us", "2000"], 7)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--core", type=int)
    given = parser.parse_args()
    about = machine(given.build)
    core = pin(given.core)
    results, said, missing = run_all(given.build, *effort_of(given.quick), PROGRAMS)
    difference = float(said.get("difference", 0))
    if given.json:
        json.dump({"schema": "mctau.bench/1", "unit": "ns", "machine": about, "core": core,
                   "goals": {"plant cart_pole rk4": GOAL_STEP, "tick": GOAL_TICK, "bus": GOAL_BUS},
                   "results": [{"program": program, "name": name, **summary}
                               for (program, name), summary in results.items()],
                   "mujoco": said, "missing": missing}, sys.stdout, indent=1)
        print()
    else:
        print_table(results, said, missing, about, core)
    if not difference < SAME_MOTION:
        print("tools/bench: the two programs do not compute the same motion", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
