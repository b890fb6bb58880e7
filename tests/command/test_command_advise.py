"""mctau advise: which effects a scene calls for at a tolerance, verified by a run."""

import json
import math
import os

import pytest
from command.drawn_scenes import run_of, words, worst

CART_POLE = {
    "scene.system": "cart_pole", "scene.duration": "5.0", "scene.substeps": "8", "initial.pole_angle": "2.0",
    "parameters.cart_friction": "0.5", "parameters.inductance": "0.003", "parameters.current_limit": "2.5",
    "input.kind": "sine", "input.amplitude": "11", "input.frequency": "5"}  # fmt: skip
DRY = {"cart_coulomb": 0.02, "pole_coulomb": 5e-5, "cart_drag": 0.01, "pole_drag": 1e-5}  # where the default is 0


@pytest.fixture(scope="session")
def cart_pole(mctau):
    """Overrides of a cart-pole that has each effect of its system on, as it is listed."""
    known = json.loads(mctau("list", "--json").stdout)
    choices = {effect["name"]: effect["choices"] for effect in known["effects"]}
    system = next(system for system in known["systems"] if system["name"] == "cart_pole")
    sets = dict(CART_POLE)
    for field in system["parameters"]:
        if field["name"] in DRY:
            sets[f"parameters.{field['name']}"] = repr(DRY[field["name"]])
    for effect in system["effects"]:
        best = {"coulomb": "moreau"}.get(effect["name"], choices[effect["name"]][-1])
        sets[f"effects.{effect['name']}"] = str(best).lower()
    return sets


@pytest.fixture
def scene(tmp_path):
    """An empty scene: its values are all given by --set."""
    path = tmp_path / "scene.toml"
    path.write_text('[scene]\nsystem = "cart_pole"\n')
    return path


def advise(mctau, scene, *arguments, exit_code=0):
    done = mctau("advise", scene, *arguments, "--instructions", "none", "--json")
    assert done.returncode == exit_code, done.stderr
    return json.loads(done.stdout)


def states_of(found):
    """Names of what is compared: coordinates and rates."""
    assert found["system"] == "cart_pole"
    return ["cart_position", "pole_angle", "cart_velocity", "pole_rate"]


@pytest.mark.parametrize("tolerance", ["1e-1", "1e-2", "1e-3", "1e-4"])
def test_what_is_certified_of_a_cart_pole_with_all_effects_holds_in_runs(mctau, scene, cart_pole, tmp_path, tolerance):
    found = advise(mctau, scene, *words(cart_pole), "--tolerance", tolerance)
    assert found["schema"] == "mctau.advise/1" and found["certified"]
    assert found["bound"] <= float(tolerance)
    assert found["verified_error"] + found["uncertainty"] <= float(tolerance)
    pruned = dict(assignment.split("=") for assignment in found["set"])
    method = {"scene.stepper": found["stepper"], "scene.substeps": str(found["substeps"])}
    full, lean = (run_of(mctau, scene, cart_pole | more | method, tmp_path) for more in ({}, pruned))
    seen = worst(full, lean, states_of(found))
    assert seen <= float(tolerance)
    assert seen == pytest.approx(found["verified_error"], rel=0.1, abs=1e-12)  # a CSV lacks the last state


def test_a_smaller_tolerance_keeps_more_effects(mctau, scene, cart_pole):
    counts = [len(advise(mctau, scene, *words(cart_pole), "--tolerance", e)["set"]) for e in ("1e-1", "3e-3", "1e-4")]
    assert counts[0] > counts[1] > counts[2]


def test_estimates_agree_with_runs_without_the_effect_within_a_factor_of_two(mctau, scene, cart_pole, tmp_path):
    found = advise(mctau, scene, *words(cart_pole), "--tolerance", "1e-3")
    method = {"scene.stepper": found["stepper"], "scene.substeps": str(found["substeps"])}
    full = run_of(mctau, scene, cart_pole | method, tmp_path)
    compared = []
    for effect in found["effects"]:
        name, value = effect["set"].split("=")
        seen = worst(full, run_of(mctau, scene, cart_pole | method | {name: value}, tmp_path), states_of(found))
        if 1e-12 < seen < 1e-2 or 1e-12 < effect["estimate"] < 1e-2:
            assert seen / 2 <= effect["estimate"] <= 2 * seen, effect["name"]
            compared.append(effect["estimate_by"])
    assert "first_order" in compared


@pytest.mark.parametrize("size", ["1e-3", "1e-5"])
def test_an_estimate_of_first_order_is_right_to_a_percent(mctau, tmp_path, size):
    """Of the smooth effects that a pendulum may lose; the second order is some `size` of it."""
    scene = tmp_path / "pendulum.toml"
    scene.write_text('[scene]\nsystem = "pendulum"\nduration = 5.0\n[effects]\ndrag = true\n[initial]\nangle = 2.0\n')
    small = {"parameters.friction": f"{0.003 * float(size)}", "parameters.drag": f"{0.003 * float(size)}"}
    found = advise(mctau, scene, *words(small), "--tolerance", "1e-6")
    full = run_of(mctau, scene, small, tmp_path)
    for effect in found["effects"]:
        if effect["name"] in ("viscous", "drag"):
            lean = run_of(mctau, scene, small | dict([effect["set"].split("=")]), tmp_path)
            assert effect["estimate_by"] == "first_order"
            assert effect["estimate"] == pytest.approx(worst(full, lean, ["angle", "angle_rate"]), rel=0.01)


def test_time_scales_are_those_of_the_textbook(mctau, tmp_path):
    def scales(system, *sets):
        scene = tmp_path / "one.toml"
        scene.write_text(f'[scene]\nsystem = "{system}"\nduration = 1.0\n')
        found = advise(mctau, scene, "--tolerance", "1e-3", *sets)
        return {effect["name"]: effect["time_scale_s"] for effect in found["effects"]}

    small = "--set", "initial.angle=3.14", "--set", "parameters.length=0.5", "--set", "parameters.mass=0.2"
    pendulum = scales("pendulum", *small)
    assert pendulum["gravity"] == pytest.approx((0.5 / 9.81) ** 0.5, rel=1e-3)  # sqrt(l/g)
    assert pendulum["viscous"] == pytest.approx(0.2 * 0.5**2 / 0.0005, rel=1e-3)  # m l^2 / nu
    spring = scales("spring_pendulum", "--set", "effects.gravity=false")
    assert spring["spring"] == pytest.approx((0.5 / 40) ** 0.5, rel=0.05)  # sqrt(m/k)
    assert scales("reaction_wheel")["motor"] == pytest.approx(0.006 / 12.1)  # L/R
    assert scales("moving_base")["base_motion"] == pytest.approx(1 / 300)  # 1 / its angular frequency


def test_costs_are_the_full_scene_less_the_one_without(mctau, scene, cart_pole):
    done = mctau("advise", scene, *words(cart_pole), "--tolerance", "1e-2", "--json")
    found = json.loads(done.stdout)
    if found["instructions_counted_by"] is None:
        pytest.skip(found["instructions_not_counted"])
    costs = {effect["set"]: effect for effect in found["effects"]}
    assert all(effect["ns"] is not None for effect in costs.values())
    for name in ("effects.coulomb=off", "effects.motor=quasi_static", "effects.viscous=false"):
        assert costs[name]["instructions"] > 0
    assert found["saves"]["instructions"] > 0


def test_of_a_motor_only_the_inductance_goes_and_encoders_stay(mctau, scenes):
    found = advise(mctau, scenes / "cart_pole.toml", "--tolerance", "10", "--duration", "2",
                   "--set", "sensors.noise=0.5", "--set", "sensors.latency=1", "--set", "effects.motor=inductive",
                   "--set", "scene.substeps=8")  # fmt: skip
    by_name = {effect["name"]: effect for effect in found["effects"]}
    assert found["input"] == "controlled"
    assert {effect["estimate_by"] for effect in found["effects"] if effect["estimate"] is not None} == {"run"}
    assert by_name["motor"]["without"] == "quasi_static"
    for name in ("cart_counts_per_metre", "pole_counts_per_turn"):
        assert by_name[name]["decision"] == "keep" and float(by_name[name]["kind"]) > 1
    assert "sensors.noise=0" in found["set"] and "sensors.latency=0" in found["set"]
    held = advise(mctau, scenes / "cart_pole.toml", "--tolerance", "10", "--duration", "1", "--set",
                  "controller.kind=none")  # fmt: skip
    motor = next(effect for effect in held["effects"] if effect["name"] == "motor")
    assert motor["decision"] == "keep" and "force" in motor["reason"]


def test_an_effect_that_is_left_out_with_a_coefficient_is_pointed_out(mctau, tmp_path):
    scene = tmp_path / "wheel.toml"
    scene.write_text('[scene]\nsystem = "reaction_wheel"\nduration = 2.0\n[effects]\nmotor = "quasi_static"\n'
                     '[parameters]\narm_coulomb = 0.001\n[input]\nkind = "constant"\nvalue = 5\n')  # fmt: skip
    left_out = {one["name"]: one for one in advise(mctau, scene, "--tolerance", "1e-3")["left_out"]}
    motor = left_out["motor"]
    assert motor["set"] == "effects.motor=inductive" and motor["near_tick"] and motor["time_scale_s"] < 1e-3
    assert [(one["name"], one["given"]) for one in motor["coefficients"]] == [("inductance", False)]
    assert motor["estimate"] > 1e-3 and motor["matters"]
    dry = left_out["coulomb"]
    assert [(one["name"], one["given"]) for one in dry["coefficients"]] == [("arm_coulomb", True), ("static_ratio", False)]
    assert dry["matters"] and dry["changes_most"]["state"] in ("arm_angle", "wheel_angle", "arm_rate", "wheel_rate")
    none = advise(mctau, scene, "--tolerance", "1e-3", "--set", "parameters.arm_coulomb=0", "--set",
                  "parameters.inductance=0")  # fmt: skip
    assert {one["name"] for one in none["left_out"]} <= {"saturation"}


def test_what_friction_holds_is_known_to_slide_without_it(mctau, tmp_path):
    """On a slope, at rest: no deviation outlives a tick there, so nothing can be told to first order."""
    scene = tmp_path / "block.toml"
    scene.write_text('[scene]\nsystem = "block"\nduration = 1.0\n[parameters]\nslope = 0.3\n'
                     '[effects]\ncoulomb = "moreau"\nspring = false\nforcing = false\n')  # fmt: skip
    rows = {effect["set"]: effect for effect in advise(mctau, scene, "--tolerance", "1e-3")["effects"]}
    assert set(rows) == {"effects.gravity=false", "effects.coulomb=off"}
    assert rows["effects.coulomb=off"]["estimate"] == pytest.approx(9.81 * math.sin(0.3), rel=1e-3)  # its speed after 1 s
    assert rows["effects.coulomb=off"]["decision"] == "keep" and rows["effects.gravity=false"]["estimate"] == 0


def test_what_verification_refuses_is_taken_back(mctau, tmp_path):
    """Without either of two drags a sphere falls a little faster; without both it falls freely."""
    scene = tmp_path / "sphere.toml"
    scene.write_text('[scene]\nsystem = "falling_sphere"\nduration = 3.0\n'
                     "[effects]\nstokes = true\ndrag = true\nbuoyancy = false\n"
                     "[parameters]\nfluid_viscosity = 5e-4\nfluid_density = 1.2\n")  # fmt: skip
    found = advise(mctau, scene, "--tolerance", "0.9")
    by_name = {effect["name"]: effect for effect in found["effects"]}
    assert by_name["stokes"]["estimate"] + by_name["drag"]["estimate"] <= 0.9 and found["taken_back"] == 1
    assert found["certified"] and found["dropped"] == ["stokes"] and "verification" in by_name["drag"]["reason"]
    assert found["bound"] == by_name["stokes"]["estimate"]


# --- --write ---


def test_a_written_scene_runs_and_gives_what_was_promised(mctau, scene, cart_pole, tmp_path):
    lean = tmp_path / "lean.toml"
    found = advise(mctau, scene, *words(cart_pole), "--tolerance", "1e-2", "--write", lean)
    text = lean.read_text()
    assert found["certificate"] in text and "dropped: " in found["certificate"]
    for key in ("cart_velocity = 0 ", "gravity = 9.81 ", "stepper = ", "# current_limit = 2.5 "):
        assert key in text  # whatever the defaults will be
    done = mctau("run", lean, "--json")
    assert done.returncode == 0 and done.stderr == ""  # no note of an idle coefficient either
    pruned = cart_pole | dict(assignment.split("=") for assignment in found["set"])
    here, there = run_of(mctau, lean, {}, tmp_path), run_of(mctau, scene, pruned, tmp_path)
    assert here == there  # bit for bit
    full = run_of(mctau, scene, cart_pole, tmp_path)
    assert worst(full, here, states_of(found)) <= 1e-2


SCENES = ["block", "cart_pole", "falling_sphere", "moving_base", "particle_pendulum", "reaction_wheel", "rigid_body",
          "rotating_frame", "linked_particles"]  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_a_written_scene_is_the_one_that_was_read(mctau, scenes, tmp_path, name):
    lean = tmp_path / "lean.toml"
    found = advise(mctau, scenes / f"{name}.toml", "--tolerance", "1", "--duration", "1", "--write", lean)
    sets = {"scene.duration": "1"} | dict(assignment.split("=") for assignment in found["set"])
    assert run_of(mctau, lean, {}, tmp_path) == run_of(mctau, scenes / f"{name}.toml", sets, tmp_path)


def test_a_written_scene_finds_its_input_again(mctau, tmp_path):
    (tmp_path / "volts.csv").write_text("volts\n" + "3\n" * 100 + "-2\n" * 100)
    scene, there = tmp_path / "scene.toml", tmp_path / "there"
    there.mkdir()
    scene.write_text('[scene]\nsystem = "cart_pole"\nduration = 0.2\n[input]\nkind = "csv"\nfile = "volts.csv"\ncolumn = "volts"\n')
    advise(mctau, scene, "--tolerance", "1e-9", "--write", there / "lean.toml")
    assert run_of(mctau, there / "lean.toml", {}, tmp_path) == run_of(mctau, scene, {}, tmp_path)


@pytest.mark.parametrize("where", ["none/lean.toml", ".", "", "-"])
def test_a_place_that_cannot_be_written_leaves_files_as_they_were(mctau, scenes, tmp_path, where):
    path = tmp_path / where if where not in ("", "-") else where
    done = mctau("advise", scenes / "pendulum.toml", "--tolerance", "1e-3", "--write", path, "--json")
    assert done.returncode in (2, 3) and done.stdout == "" and done.stderr != ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_a_file_that_does_not_take_the_scene_is_an_error(mctau, scenes):
    done = mctau("advise", scenes / "pendulum.toml", "--tolerance", "1e-3", "--write", "/dev/full", "--json")
    assert done.returncode == 3 and done.stdout == "" and "/dev/full" in done.stderr


def test_the_scene_that_is_read_is_not_written_over(mctau, scenes, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text((scenes / "pendulum.toml").read_text())
    done = mctau("advise", scene, "--tolerance", "1e-3", "--write", scene)
    assert done.returncode == 2 and "which the scene is read from" in done.stderr
    assert scene.read_text() == (scenes / "pendulum.toml").read_text()


# --- what makes no sense ---


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "one", "", "1e-6x", "1e-13"])
def test_a_tolerance_that_is_none_is_refused(mctau, scenes, text):
    done = mctau("advise", scenes / "pendulum.toml", "--tolerance", text)
    assert done.returncode == 2 and done.stdout == ""
    assert f"--tolerance: found {text or 'nothing'}; allowed 1e-12 to 1e6" in done.stderr


BAD = {
    "no tolerance": ([], "--tolerance"),
    "an unknown option": (["--tolerance", "1e-3", "--tolerence", "1"], "--tolerence"),
    "a counter": (["--tolerance", "1e-3", "--instructions", "abacus"], "--instructions: found abacus"),
    "a process": (["--tolerance", "1e-3", "--set", "scene.system=chain"], "chain, a process"),
    "no time": (["--tolerance", "1e-3", "--duration", "0"], "scene.duration"),
    "a value": (["--tolerance", "1e-3", "--set", "parameters.mass=0"], "parameters.mass: found 0"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_request_that_makes_no_sense_is_refused(mctau, tmp_path, case):
    arguments, expected = BAD[case]
    scene = tmp_path / "scene.toml"
    scene.write_text("[scene]\nsystem = 'pendulum'\n")
    done = mctau("advise", scene, *arguments)
    assert done.returncode == 2 and done.stdout == "" and expected in done.stderr


def test_a_scene_that_is_no_file_is_an_error_of_files(mctau, tmp_path):
    assert mctau("advise", tmp_path / "none.toml", "--tolerance", "1e-3").returncode == 3


def test_a_scene_without_effects_has_nothing_to_leave_out(mctau, scenes):
    off = "--set", "effects.gravity=false", "--set", "effects.viscous=false", "--set", "initial.angle_rate=1"
    found = advise(mctau, scenes / "pendulum.toml", "--tolerance", "1e-3", *off)
    assert found["certified"] and found["effects"] == found["dropped"] == found["kept"] == []
    assert {one["name"] for one in found["left_out"]} == {"gravity", "viscous"}
    said = mctau("advise", scenes / "pendulum.toml", "--tolerance", "1e-3", *off).stdout
    assert "No effect is on" in said and "dropped: nothing" in said


def test_nothing_is_certified_of_a_scene_whose_errors_grow_beyond_the_tolerance(mctau, scenes, tmp_path):
    """A pendulum on a spring, of high energy: an error grows by some e every six seconds, and with it any rounding."""
    chaotic = ["--set", "initial.angle=0.3", "--set", "initial.length=1.5", "--set", "parameters.length_friction=1e-13",
               "--set", "parameters.angle_friction=1e-14", "--set", "scene.dt=0.02", "--duration", "600"]  # fmt: skip
    lean = tmp_path / "lean.toml"
    found = advise(mctau, scenes / "spring_pendulum.toml", "--tolerance", "1e-4", *chaotic, "--write", lean, exit_code=1)
    assert not found["certified"] and found["verified_error"] is None and found["dropped"] == []
    assert found["uncertainty"] > 1e-4 and not lean.exists()
    said = mctau("advise", scenes / "spring_pendulum.toml", "--tolerance", "1e-4", *chaotic)
    assert said.returncode == 1 and "Nothing is certified" in said.stdout


def test_the_table_fits_a_terminal_and_names_units(mctau, scene, cart_pole):
    said = mctau("advise", scene, *words(cart_pole), "--tolerance", "1e-2", "--instructions", "none").stdout
    table = said.split("\n\n")[1].splitlines()
    assert len(table) >= 6 and max(map(len, table)) <= 100
    for word in ("time scale", "ns", "instr", "flash", "change", "Cortex-M4F", "dropped: ", "bound", "verified", "saves: "):
        assert word in said


def test_help_teaches(mctau):
    said = mctau("advise", "--help").stdout
    for word in ("--tolerance", "--write", "first order", "Examples", "Exit codes"):
        assert word in said
