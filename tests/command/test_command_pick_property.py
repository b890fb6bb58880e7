"""mctau pick on drawn scenes of all systems: what it calls verified holds in runs of the chosen stepper.

MCTAU_PICK_SCENES scenes (7 by default) times MCTAU_PICK_TOLERANCES tolerances (2; at most 5) are drawn from a fixed seed;
MCTAU_PICK_REPORT names a file for a line on each.
"""

import csv
import json
import math
import os
import random

import pytest

SCENES = int(os.environ.get("MCTAU_PICK_SCENES", 7))
TOLERANCES = ["1e-4", "1e-8", "1e-2", "1e-6", "1e-10"][: int(os.environ.get("MCTAU_PICK_TOLERANCES", 2))]
SPAN = {"rad": 2.5, "rad/s": 4.0, "m": 0.3, "m/s": 1.5}  # of what a start is drawn from, about its default


def drawn(random_, system):
    """Overrides of a scene: effects, parameters, start, tick, perhaps an input."""
    sets = {}
    for effect in system["effects"]:
        if isinstance(effect["default"], bool) and random_.random() < 0.3:
            sets[f"effects.{effect['name']}"] = str(random_.random() < 0.5).lower()
    for field in system["parameters"]:
        default = field["default"]
        if isinstance(default, float | int) and not isinstance(default, bool) and default and random_.random() < 0.5:
            value = default * random_.uniform(0.6, 1.6)
            sets[f"parameters.{field['name']}"] = repr(min(max(value, field["minimum"]), field["maximum"]))
    for coordinate in system["coordinates"]:
        for field in (coordinate, coordinate["rate"]):
            if field["name"].startswith("rotation_"):  # a quaternion, which is given a length of 1
                sets |= {f"initial.attitude_{c}": repr(random_.uniform(-1, 1)) for c in "wxyz"}
                continue
            span = SPAN.get(field["unit"])
            if span and "default" in field:
                value = field["default"] + random_.uniform(-span, span)
                sets[f"initial.{field['name']}"] = repr(min(max(value, field["minimum"]), field["maximum"]))
    sets["scene.dt"] = random_.choice(["0.0005", "0.001", "0.002"])
    sets["scene.duration"] = random_.choice(["1.0", "2.0", "3.0"])
    if random_.random() < 0.5:
        sets |= {"input.kind": "sine", "input.amplitude": "1.0", "input.frequency": repr(random_.uniform(1, 8))}
    return sets


def words(sets):
    return [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]


def rows_of(mctau, scene, sets, tmp_path):
    """States by tick, in the columns of the CSV; None when it did not run to its end."""
    path = tmp_path / "run.csv"
    path.unlink(missing_ok=True)
    done = mctau("run", scene, *words(sets), "--csv", path)
    if done.returncode not in (0, 1) or "iverged" in done.stdout:
        return None
    with open(path, encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    numbers = names.index("mode")
    return names, [[float(cell) for cell in row[:numbers]] for row in rows]


def turned_away(a, b):
    """Angle between two attitudes."""
    w, v = sum(x * y for x, y in zip(a, b)), (
        a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
        a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3],
        a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1])  # fmt: skip
    return 2 * math.atan2(math.hypot(*v), abs(w))


def worst(names, exact, other, states, stride):
    """The error of mctau cost, by its definition and without its code."""
    columns = [names.index(name) for name in states if not name.startswith(("attitude", "base_angle_", "force_"))]
    turned = [names.index(f"attitude_{c}") for c in "wxyz"] if "attitude_w" in names else []
    scale = {i: max(1, *(abs(row[i]) for row in exact)) for i in columns}
    largest = 0
    for row, mine in zip(exact[::stride], other):
        errors = [abs(row[i] - mine[i]) / scale[i] for i in columns]
        if turned:
            errors.append(turned_away([row[i] for i in turned], [mine[i] for i in turned]))
        largest = max(largest, *errors)
    return largest


def report(text):
    if path := os.environ.get("MCTAU_PICK_REPORT"):
        with open(path, "a", encoding="utf-8") as file:
            print(text, file=file)


@pytest.mark.parametrize("number", range(SCENES))
def test_what_is_picked_meets_the_tolerance_in_a_run_or_nothing_does(mctau, result, tmp_path, number):
    systems = [system for system in result("list")["systems"] if "discrete" not in system["steppers"]]
    system = systems[number % len(systems)]
    random_ = random.Random(number)
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[scene]\nsystem = "{system["name"]}"\n')
    for _ in range(20):
        sets = drawn(random_, system)
        checked = mctau("mct", scene, *words(sets))
        if checked.returncode == 2:  # parameters that do not go together, an input that the system has not
            sets = {key: value for key, value in sets.items() if not key.startswith("input")}
            checked = mctau("mct", scene, *words(sets))
        if checked.returncode == 0:
            break
    assert checked.returncode == 0, checked.stderr

    exact = {}
    for tolerance in TOLERANCES:
        done = mctau("pick", scene, *words(sets), "--tolerance", tolerance, "--horizon", "--json")
        assert done.returncode in (0, 1), done.stderr
        found = json.loads(done.stdout) if done.stdout else {"met": False, "reference": {"uncertainty": None}}
        if done.returncode == 1:
            assert not found["met"]
            report(f"{number} {system['name']} {tolerance} none {found['reference']['uncertainty']}")
            continue
        assert found["verified_error"] <= float(tolerance)
        # The same in runs, which know nothing of references and horizons.
        longest = {"scene.duration": repr(found["horizon"])}
        if not exact:
            for substeps in ("32", "64"):
                exact[substeps] = rows_of(mctau, scene, sets | longest | {"scene.stepper": "rk4", "scene.substeps": substeps},
                                          tmp_path)  # fmt: skip
        chosen = {"scene.stepper": found["stepper"], "scene.precision": found["precision"], "scene.dt": repr(found["dt"]),
                  "scene.substeps": str(found["substeps"])}  # fmt: skip
        mine = rows_of(mctau, scene, sets | longest | chosen, tmp_path)
        assert mine is not None
        states = list(json.loads(mctau("mct", scene, *words(sets), "--json").stdout)["state"])
        if exact["64"] is None:
            report(f"{number} {system['name']} {tolerance} unchecked {found['verified_error']:.2e}")
            continue
        names, fine = exact["64"]
        doubt = worst(names, fine, exact["32"][1], states, 1)
        seen = worst(names, fine, mine[1], states, round(found["dt"] / found["tick"]))
        report(f"{number} {system['name']} {tolerance} {found['stepper']} {found['precision']} {found['step']} "
               f"{found['predicted_error']:.2e} {found['verified_error']:.2e} {seen:.2e} {doubt:.1e} "
               f"{found['refused_by_verification']} {found['horizon']}/{found['duration']}")  # fmt: skip
        assert seen <= float(tolerance) + 2 * doubt
