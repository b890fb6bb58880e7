#!/usr/bin/env python3
"""Tables of tools/bench --peers, in Markdown: this library beside others on the same scenes, cost by accuracy.

usage: peers.py BUILD [--quick] [--json] [--core N] [--scene NAME]... [--pictures FOLDER]
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import report
from systems import print_table

NOTES = """
- Same physics, parameters, initial states and inputs. SUNDIALS, Boost.odeint and GSL integrate one closed form
  (tools/benchmark/closed_form.h: constants worked out beforehand, inlined in odeint, sine and cosine of the C library;
  the spring pendulum in Cartesian coordinates), heyoka the same as symbols. MuJoCo has a model of the mechanism, with
  all off that it does not need: its cost is its generality. The body here carries its centre, too: 13 states beside 7.
- An error is the largest of all states and of 50 samples over 10 s, relative to 1 or to the largest that the state gets,
  against one reference in quadruple precision.
- Under a held input adaptive methods start again at every tick, as a controller makes them: one-step methods keep the
  length of their step, others begin anew. heyoka is driven from Python there, a call a tick, which is counted.
- `mctau` is its kernel, a call a tick or for each 200 ms, in double or float."""
SCHEMA = "mctau.peers/1"
TOLERANCES = [10.0**-n for n in range(2, 13)]
SAME_MOTION = 1e-6  # the same physics: each program's closest must be nearer than this, where it is accurate at all
DEAREST = {True: 2500, False: 40000}  # ns for each ms where sweeps end, by --quick: peers.c
OURS = ["mctau", "mctau float"]
GOAL_MUJOCO = 40
# Name in tables, program, and what installs it.
PEERS = {
    "MuJoCo": ("benchmark_peer_mujoco", "tools/setup"),
    "SUNDIALS": ("benchmark_peer_sundials", "tools/setup --peers (Debian: libsundials-dev)"),
    "Boost.odeint": ("benchmark_peer_odeint", "tools/setup --peers (Debian: libboost-dev, g++)"),
    "GSL": ("benchmark_peer_gsl", "tools/setup --peers (Debian: libgsl-dev)"),
    "heyoka": ("peer_heyoka.py", "tools/setup --peers (PyPI: heyoka)"),
}
# Cannot be driven by this program yet: named so that nobody takes it for tried.
UNTRIED = {
    "Pinocchio with CasADi": "PyPI's pin has no CasADi in it (no pinocchio.casadi); conda-forge's has: "
                             "conda install -c conda-forge pinocchio casadi. There is no driver for it here",
}


HERE = pathlib.Path(__file__).resolve().parent


def python_with(module):
    """An interpreter that has it: this one, or that of tools/setup."""
    for python in [sys.executable, str(HERE.parents[1] / "build/venv/bin/python")]:
        if pathlib.Path(python).exists() and not subprocess.run([python, "-c", f"import {module}"],
                                                                capture_output=True).returncode:
            return python
    return None


def programs(folder):
    """Command of each program that is there, and those that are missing."""
    there, missing = {}, {}
    for name, file in zip(OURS, ["benchmark_peer_mctau_f64", "benchmark_peer_mctau_f32"]):
        if report.path(folder, file).exists():
            there[name] = [report.path(folder, file)]
    for name, (file, how) in PEERS.items():
        if file.endswith(".py"):
            python = python_with(name)
            is_there = python is not None
            command = [python, HERE / file]
        else:
            is_there = report.path(folder, file).exists()
            command = [report.path(folder, file)]
        if is_there:
            there[name] = command
        else:
            missing[name] = how
    return there, missing | UNTRIED


def measure(folder, there, quick, wanted):
    """The scenes; all points; versions. Programs take turns by scene, so that a slow minute hits all."""
    reference = report.path(folder, "references.txt")
    described = report.path(folder, "scenes.json")
    said = subprocess.run([*there["mctau"], "--scenes"], capture_output=True, text=True, check=True).stdout
    described.write_text(said, encoding="utf-8")
    scenes = json.loads(said)["scenes"]
    names = [scene["name"] for scene in scenes]
    for name in wanted or []:
        if name not in names:
            print(f"tools/bench: --scene: found {name}; allowed {', '.join(names)}", file=sys.stderr)
            sys.exit(2)
    scenes = [scene for scene in scenes if not wanted or scene["name"] in wanted]
    points, versions = [], {}
    for number, scene in enumerate(scenes):
        for name, command in there.items():
            if sys.stderr.isatty():
                said = f"{number + 1} of {len(scenes)}: {scene['name']}, {name}"
                print(f"\r\033[K{said}", end="", file=sys.stderr, flush=True)
            extra = [described] if command[-1].suffix == ".py" else []
            options = ["--quick"] if quick else []
            command = [*command, reference, scene["name"], *extra, *options]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"\n{name}: {scene['name']}: exit code {done.returncode}: {done.stderr}")
            for line in done.stdout.splitlines():
                what, *fields = line.split("\t")
                if what == "peer":
                    versions[name] = fields[1]
                    continue
                _, method, kind, setting, error, cost = fields
                points.append({"scene": scene["name"], "program": name, "method": method, kind: float(setting),
                               "error": float(error), "ns_per_ms": float(cost)})
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    return scenes, points, versions


def cheapest(points, scene, names, tolerance):
    """Of the points of these programs that keep the tolerance."""
    fitting = [each for each in points
               if each["scene"] == scene and each["program"] in names and each["error"] <= tolerance]
    return min(fitting, key=lambda each: each["ns_per_ms"], default=None)


def figure(value):
    return f"{value:.2g}" if value < 10 else f"{value:.0f}"


def setting(found):
    if "step" in found:
        step = found["step"]
        return f"{step * 1e3:.3g} ms" if step >= 1e-3 else f"{step * 1e6:.3g} us"
    return f"tol {found['tolerance']:.0e}"


def method_text(found):
    return f"`{found['method']}`{' float' if found['program'] == OURS[1] else ''}, {setting(found)}"


def tables(scenes, points, names, quick):
    peers = [name for name in names if name not in OURS]
    tolerances = TOLERANCES[:: 2 if quick else 1]
    for is_held, title in [(False, "Free motion: a state every 200 ms, steps as long as they like"),
                           (True, "Held input: a new one at every tick of 1 ms")]:
        shown = [scene for scene in scenes if scene["held"] == is_held]
        if not shown:
            continue
        print(f"\n### {title}\n")
        rows = []
        for scene in shown:
            name = scene["name"].rsplit(" ", 1)[0]
            for tolerance in tolerances:
                ours = cheapest(points, scene["name"], OURS, tolerance)
                best = cheapest(points, scene["name"], peers, tolerance)
                cells = [cheapest(points, scene["name"], [peer], tolerance) for peer in peers]
                rows.append([
                    name if tolerance == tolerances[0] else "", f"{tolerance:.0e}",
                    f"{figure(ours['ns_per_ms'])}" if ours else "-",
                    method_text(ours) if ours else "",
                    *[figure(each["ns_per_ms"]) if each else "-" for each in cells],
                    f"{best['program']} {best['method']}" if best else "",
                    f"{best['ns_per_ms'] / ours['ns_per_ms']:.2g}" if ours and best else "",
                ])
        print_table(["scene", "tolerance", "mctau", "by", *peers, "best peer", "best peer / mctau"], rows)


def beside_mujoco(scenes, points):
    """For each held scene and step of MuJoCo's RK4: our cheapest with no more than its error. None: it has no motion."""
    rows = []
    for scene in scenes:
        if not scene["held"]:
            continue
        theirs = [each for each in points if (each["scene"], each["program"], each["method"])
                  == (scene["name"], "MuJoCo", "RK4")]  # fmt: skip
        for each in sorted(theirs, key=lambda one: -one["step"]) or [None]:
            ours = each and cheapest(points, scene["name"], OURS, each["error"])
            rows.append({"scene": scene["name"], "mujoco": each, "mctau": ours,
                         "ratio": each["ns_per_ms"] / ours["ns_per_ms"] if ours else None})  # fmt: skip
    return rows


def mujoco_table(rows, quick):
    if not rows:
        return
    print(f"\n### MuJoCo's RK4, at its own error\n\nUnder a held input, by MuJoCo's timestep: its error, and the cheapest "
          f"here that has no more. Goal: {GOAL_MUJOCO} times faster.\n")  # fmt: skip
    shown = []
    for row in rows:
        theirs, ours = row["mujoco"], row["mctau"]
        shown.append([row["scene"].rsplit(" ", 1)[0],
                      *([setting(theirs), f"{theirs['error']:.1e}", figure(theirs["ns_per_ms"])] if theirs
                        else ["all tried", "lost, or too dear", f"> {DEAREST[quick]}"]),
                      *([figure(ours["ns_per_ms"]), method_text(ours), f"{ours['error']:.1e}"] if ours else ["-", "", ""]),
                      f"{row['ratio']:.0f}" if row["ratio"] else ""])  # fmt: skip
    print_table(["scene", "timestep", "error", "MuJoCo RK4", "mctau", "by", "error", "MuJoCo / mctau"], shown)


def closest(scenes, points, names):
    """Least error of each program in each scene: how well programs with equations of their own agree."""
    print("\n### The same physics\n\nLeast error that each program came to, against the common reference:\n")
    rows = []
    for scene in scenes:
        least = [min((each["error"] for each in points
                      if each["scene"] == scene["name"] and each["program"] == name), default=None) for name in names]
        rows.append([scene["name"], scene["doc"], *["-" if each is None else f"{each:.0e}" for each in least]])
    print_table(["scene", "what", *names], rows)


def same(scenes, points):
    """Whether two programs, ours one of them, come within SAME_MOTION of the reference in every scene."""
    for scene in scenes:
        near = {each["program"] for each in points
                if each["scene"] == scene["name"] and each["error"] < SAME_MOTION}
        if "mctau" not in near or (any(each["program"] in PEERS for each in points) and len(near - set(OURS)) == 0):
            print(f"tools/bench: {scene['name']}: only {', '.join(sorted(near)) or 'no program'} within "
                  f"{SAME_MOTION:g} of the reference", file=sys.stderr)
            return False
    return True


def draw(everything, file, folder):
    python = python_with("matplotlib")
    if python is None:
        sys.exit("tools/bench: --pictures needs matplotlib; run tools/setup")
    file.write_text(json.dumps(everything), encoding="utf-8")
    subprocess.run([python, "-W", "ignore", HERE / "diagrams.py", file, folder], check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--core", type=int)
    parser.add_argument("--scene", action="append")
    parser.add_argument("--pictures", type=pathlib.Path)
    given = parser.parse_args()
    os.environ.update(OMP_NUM_THREADS="1")
    about = report.machine(given.build)
    core = report.pin(given.core)
    there, missing = programs(given.build)
    if "mctau" not in there:
        sys.exit("tools/bench: --peers needs the library in double")
    scenes, points, versions = measure(given.build, there, given.quick, given.scene)
    for scene in scenes:
        scene.pop("inputs")
    everything = {"schema": SCHEMA, "unit": "ns per simulated ms", "machine": about, "core": core,
                  "quick": given.quick, "versions": versions, "missing": missing, "scenes": scenes, "points": points,
                  "mujoco_rk4": beside_mujoco(scenes, points) if "MuJoCo" in there else []}
    if given.pictures:
        draw(everything, report.path(given.build, "points.json"), given.pictures)
    if given.json:
        json.dump(everything, sys.stdout, indent=1)
        print()
    else:
        print(f"Made on {about['cpu']}, {about['system']}, core {core}, load before {about['load']:.1f}, by "
              f"{about['compiler']}{', --quick: every second setting' if given.quick else ''}.")
        beside = [f"{name} {version}" for name, version in versions.items() if name not in OURS]
        print(f"Beside {', '.join(beside) or 'nothing: no peer is installed'}.")
        for name, how in missing.items():
            print(f"\nMissing: {name}; {how}.")
        print("\nNanoseconds (CPU time, median of some runs) for each simulated millisecond, of the cheapest method and "
              "setting whose\nworst error over 10 s keeps the tolerance; - where none did, or only for more than "
              f"{DEAREST[given.quick]} ns.")
        print(NOTES)
        tables(scenes, points, list(there), given.quick)
        mujoco_table(everything["mujoco_rk4"], given.quick)
        closest(scenes, points, list(there))
    return 0 if same(scenes, points) else 1


if __name__ == "__main__":
    sys.exit(main())
