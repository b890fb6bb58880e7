"""mctau advise on drawn scenes of all systems: what it certifies holds in runs.

MCTAU_ADVISE_SCENES scenes (50 by default) are drawn from a fixed seed; MCTAU_ADVISE_REPORT names a file for a line on
each.
"""

import json
import os
import random

import pytest
from command.drawn_scenes import drawn, run_of, words, worst

SCENES = int(os.environ.get("MCTAU_ADVISE_SCENES", 50))
TOLERANCES = ["1e-1", "1e-2", "1e-3", "1e-4"]
SMALL = ("friction", "coulomb", "drag", "inductance", "viscosity", "fluid", "amplitude", "acceleration", "force")
USUAL = {"N": 0.3, "N m": 0.003, "N m s^2": 1e-4, "N s^2/m^2": 0.05, "rad/s^2": 1, "m": 0.01}  # where the default is 0


def drawn_with_effects(random_, system, choices):
    sets = drawn(random_, system)
    for effect in system["effects"]:
        sets[f"effects.{effect['name']}"] = str(random_.choice(choices[effect["name"]])).lower()
    if sets.get("effects.motor") == "off":
        sets["effects.saturation"] = "off"
    for field in system["parameters"]:  # those of effects that a scene may well do without: of any size
        usual = field["default"] or USUAL.get(field["unit"], 0)
        if any(word in field["name"] for word in SMALL) and usual and isinstance(usual, float | int):
            value = usual * 10 ** random_.uniform(-4, 0.3)
            sets[f"parameters.{field['name']}"] = repr(max(value, field["minimum"]))
    if "input.kind" in sets and sets.get("effects.motor", "off") != "off":
        sets["input.amplitude"] = repr(random_.uniform(2, 15))
    if "effects.motor" in sets and random_.random() < 0.3:  # let a controller have it
        sets = {key: value for key, value in sets.items() if not key.startswith("input")}
        sets |= {"controller.kind": "swing_up_balance", "effects.motor": random_.choice(["quasi_static", "inductive"]),
                 "effects.saturation": "voltage", "effects.gravity": "true", "sensors.noise": random_.choice(["0", "0.3"]),
                 "sensors.latency": random_.choice(["0", "1"])}  # fmt: skip
    return sets


def report(text):
    if path := os.environ.get("MCTAU_ADVISE_REPORT"):
        with open(path, "a", encoding="utf-8") as file:
            print(text, file=file)


@pytest.mark.parametrize("number", range(SCENES))
def test_what_is_certified_holds_in_runs(mctau, result, tmp_path, number):
    known = result("list")
    choices = {effect["name"]: effect.get("choices") for effect in known["effects"]}
    systems = [system for system in known["systems"] if "discrete" not in system["steppers"]]
    system = systems[number % len(systems)]
    random_ = random.Random(1000 + number)
    tolerance = random_.choice(TOLERANCES)
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[scene]\nsystem = "{system["name"]}"\n')
    for _ in range(40):
        sets = drawn_with_effects(random_, system, choices)
        checked = mctau("mct", scene, *words(sets))
        if checked.returncode == 2:  # an input that the system has not
            sets = {key: value for key, value in sets.items() if not key.startswith("input")}
            checked = mctau("mct", scene, *words(sets))
        if checked.returncode == 0:
            break
    assert checked.returncode == 0, checked.stderr

    done = mctau("advise", scene, *words(sets), "--tolerance", tolerance, "--instructions", "none", "--json")
    assert done.returncode in (0, 1), done.stderr
    found = json.loads(done.stdout) if done.stdout else {"certified": False, "refusal": "diverges"}
    assert found["certified"] == (done.returncode == 0)
    if not found["certified"]:
        report(f"{number} {system['name']} {tolerance} refused {found['refusal']}")
        return
    assert found["bound"] <= float(tolerance) and found["verified_error"] + found["uncertainty"] <= float(tolerance)
    # The same in runs, at steps half as long. They may change it by so much; a CSV lacks the state after the last tick.
    method = {"scene.stepper": found["stepper"], "scene.stride": "1",
              "scene.substeps": str(1 if found["stride"] > 1 else 2 * found["substeps"])}  # fmt: skip
    pruned = dict(assignment.split("=") for assignment in found["set"])
    full, lean = (run_of(mctau, scene, sets | more | method, tmp_path) for more in ({}, pruned))
    states = [name for name in json.loads(mctau("mct", scene, *words(sets), "--json").stdout)["state"] if name != "current"]
    seen = worst(full, lean, states)
    dropped = ",".join(found["dropped"]) or "nothing"
    report(f"{number} {system['name']} {found['input']} {tolerance} bound {found['bound']:.2e} verified "
           f"{found['verified_error']:.2e} seen {seen:.2e} own {found['uncertainty']:.1e} {found['stepper']} "
           f"{found['substeps']} took back {found['taken_back']}, of {len(found['effects'])} dropped {dropped}")  # fmt: skip
    assert seen <= float(tolerance)
    spread = 2 * found["uncertainty"] + 1e-12
    assert 0.9 * found["verified_error"] - spread <= seen <= 1.1 * found["verified_error"] + spread
