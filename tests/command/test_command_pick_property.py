"""mctau pick on drawn scenes of all systems: what it calls verified holds in runs of the chosen stepper.

MCTAU_PICK_SCENES scenes (7 by default) times MCTAU_PICK_TOLERANCES tolerances (2; at most 5) are drawn from a fixed seed;
MCTAU_PICK_REPORT names a file for a line on each.
"""

import json
import os
import random

import pytest
from command.drawn_scenes import drawn, run_of, words, worst

SCENES = int(os.environ.get("MCTAU_PICK_SCENES", 7))
TOLERANCES = ["1e-4", "1e-8", "1e-2", "1e-6", "1e-10"][: int(os.environ.get("MCTAU_PICK_TOLERANCES", 2))]


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
                exact[substeps] = run_of(mctau, scene, sets | longest | {"scene.stepper": "rk4", "scene.substeps": substeps},
                                          tmp_path)  # fmt: skip
        chosen = {"scene.stepper": found["stepper"], "scene.precision": found["precision"], "scene.dt": repr(found["dt"]),
                  "scene.substeps": str(found["substeps"])}  # fmt: skip
        mine = run_of(mctau, scene, sets | longest | chosen, tmp_path)
        assert mine is not None
        states = list(json.loads(mctau("mct", scene, *words(sets), "--json").stdout)["state"])
        if exact["64"] is None:
            report(f"{number} {system['name']} {tolerance} unchecked {found['verified_error']:.2e}")
            continue
        doubt = worst(exact["64"], exact["32"], states)
        seen = worst(exact["64"], mine, states, round(found["dt"] / found["tick"]))
        report(f"{number} {system['name']} {tolerance} {found['stepper']} {found['precision']} {found['step']} "
               f"{found['predicted_error']:.2e} {found['verified_error']:.2e} {seen:.2e} {doubt:.1e} "
               f"{found['refused_by_verification']} {found['horizon']}/{found['duration']}")  # fmt: skip
        assert seen <= float(tolerance) + 2 * doubt
