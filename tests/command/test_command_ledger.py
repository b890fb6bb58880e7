"""`mctau run --ledger`: the works of the effects, and what the stepper adds, are all that the energy gains.

What is unexplained is rounding: some ten roundings of the energies there at each of some thousand ticks, which mostly cancel; a
test allows 1e-12 of `size`, the sum of all works and the largest energy.
"""

import itertools
import json
import random

import pytest

TOLERANCE = 1e-12
ENERGIES = ["kinetic", "potential", "magnetic"]
POTENTIAL = ["gravity", "spring", "buoyancy"]

# What is 0 by default, or would do nothing; and resolved steps.
COEFFICIENTS = {
    "cart_pole": {"cart_coulomb": 0.5, "pole_coulomb": 0.003, "cart_drag": 0.3, "pole_drag": 1e-3, "static_ratio": 1.3,
                  "back_emf_constant": 0.006},
    "reaction_wheel": {"arm_coulomb": 0.004, "wheel_coulomb": 0.0005, "arm_drag": 1e-4, "wheel_drag": 1e-7,
                       "back_emf_constant": 0.02},
    "pendulum": {"drag": 0.01, "coulomb": 0.01},
    "particle_pendulum": {"coulomb": 0.01},
    "fixed_axis": {"coulomb": 0.5},
    "solid_pendulum": {"coulomb": 0.3},
    "moving_base": {"base_amplitude_1": 0.005},
    "rotating_frame": {"angular_velocity_1": 0.4, "angular_acceleration_2": 0.7, "force_1": 0.3},
    "block": {"belt_speed": 0.1, "force_amplitude": 3, "slope": 0.1},
}  # fmt: skip
# Dry friction within a step is one of a series' kinks, and so is drag.
SMOOTH = {"coulomb": "off", "drag": False}


def check(ledger):
    """Every account closes, and the size is that of something."""
    assert ledger["lost_ticks"] == 0
    works = ledger["works"]
    has_motor = "motor" in works
    gains = {
        "kinetic": sum(works.get(name, 0) for name in works if name not in ("resistance", "conversion", "input"))
        + (0 if has_motor else works.get("input", 0)),
        "potential": -sum(works.get(name, 0) for name in POTENTIAL),
        "magnetic": works["input"] + works["resistance"] + works["conversion"] - works["motor"] if has_motor else 0,
    }
    assert ledger["size"] > 0
    for energy in ENERGIES:
        assert abs(ledger["unexplained"][energy]) <= TOLERANCE * ledger["size"], energy
        entries = gains[energy] + ledger["stepper"][energy] + ledger["unexplained"][energy]
        assert ledger["gain"][energy] == pytest.approx(entries, abs=1e-13 * ledger["size"])
    return works


@pytest.fixture
def run(mctau):
    """run(text, ...): the ledger of a scene's run; None where its stepper does not suit it, or cannot follow it."""

    def follow(text, *arguments):
        done = mctau("run", "-", "--ledger", "--json", *arguments, input=text)
        if done.returncode == 2:
            assert "stepper" in done.stderr or "do not follow the motion" in done.stderr
            return None
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["ledger"]

    return follow


SCENES = ["ball_joint", "block", "cart_pole", "cart_pole_free", "falling_sphere", "fixed_axis", "linked_particles",
          "moving_base", "particle_pendulum", "pendulum", "reaction_wheel", "reaction_wheel_free", "rigid_body",
          "rotating_frame", "solid_pendulum", "spring_pendulum"]  # fmt: skip


def test_all_ready_scenes_but_the_process_are_here(scenes):
    assert {path.stem for path in scenes.glob("*.toml")} == {*SCENES, "chain"}


@pytest.mark.parametrize("scene", SCENES)
def test_the_ledger_of_a_ready_scene_closes(run, scenes, scene):
    check(run((scenes / f"{scene}.toml").read_text()))


def scene_of(system, effects, stepper, random_):
    lines = ["[scene]", f'system = "{system["name"]}"', f'stepper = "{stepper}"', "duration = 0.5", "[effects]"]
    lines += [f"{name} = {json.dumps(value)}" for name, value in effects.items()]
    lines += ["[parameters]"]
    if effects.get("forces") and "forces" in {rows["name"] for rows in system["lists"]}:
        lines.append('forces = [["body", 0.1, 0, 0.2, 0.3, 1, -0.5]]')
    coulomb = effects.get("coulomb", "off") != "off"
    for name, value in COEFFICIENTS.get(system["name"], {}).items():
        needs = {"coulomb": coulomb, "static_ratio": coulomb, "belt_speed": coulomb, "drag": effects.get("drag", False)}
        if all(on for key, on in needs.items() if key in name):
            lines.append(f"{name} = {value}")
    lines += ["[initial]"]
    for coordinate in system["coordinates"]:
        rate = coordinate["rate"]
        if not coordinate["name"].startswith("rotation"):
            lines.append(f"{coordinate['name']} = {coordinate['default'] + random_.uniform(0, 1)}")
        lines.append(f"{rate['name']} = {rate['default'] + random_.uniform(-1, 1)}")
    if "input_without_motor" in system:
        amplitude = 5 if effects.get("motor", "off") != "off" else 0.3
        lines += ["[input]", 'kind = "sine"', f"amplitude = {amplitude}", "frequency = 1.3"]
    return "\n".join(lines)


@pytest.fixture(scope="session")
def systems(mctau):
    return {system["name"]: system for system in json.loads(mctau("list", "--json").stdout)["systems"]}


NAMES = ["cart_pole", "reaction_wheel", "pendulum", "spring_pendulum", "linked_particles", "particle_pendulum", "moving_base",
         "rotating_frame", "ball_joint", "fixed_axis", "solid_pendulum", "rigid_body", "block", "falling_sphere"]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_the_ledger_closes_with_all_effects_and_any_stepper(run, systems, name):
    system = systems[name]
    random_ = random.Random(name)
    names = [effect["name"] for effect in system["effects"]]
    worked = set()
    motors = ["off", "quasi_static", "inductive"] if "motor" in names else [None]
    for motor, stepper in itertools.product(motors, system["steppers"]):
        everything = dict.fromkeys(names, True)
        everything.update({"motor": motor} if motor else {})
        everything.pop("saturation", None)
        smooth = {**everything, **{key: value for key, value in SMOOTH.items() if key in names}}
        kinds = [{**everything, "coulomb": kind} for kind in ("moreau", "exact")] if "coulomb" in names else [everything]
        for effects in [*kinds, smooth]:
            ledger = run(scene_of(system, effects, stepper, random_))
            if ledger is not None:
                worked |= {effect for effect, work in check(ledger).items() if work != 0}
    assert worked >= {name for name in names if name not in ("saturation", "coriolis")}


def test_the_ledger_of_a_run_in_float_is_kept_in_double(run, systems, both_precisions):
    text = scene_of(systems["cart_pole"], {"coulomb": "moreau"}, "leap", random.Random(1))
    check(run(text, "--precision", "float"))


PENDULUM = """
[scene]
system = "pendulum"
stepper = "{stepper}"
dt = {dt}
duration = 2
[parameters]
friction = 0.002
[initial]
angle = 1.2
angle_rate = 1
"""


def stepper_error(run, stepper, dt):
    return sum(run(PENDULUM.format(stepper=stepper, dt=dt))["stepper"].values())


def test_what_rk4_adds_is_small_and_falls_with_the_fourth_power_of_the_step(run):
    errors = [abs(stepper_error(run, "rk4", dt)) for dt in (4e-3, 2e-3, 1e-3)]
    assert errors[2] < 1e-9  # J, of 0.5
    for coarse, fine in itertools.pairwise(errors):
        assert 12 < coarse / fine < 40  # 2^4, or 2^5 where the leading terms of a swing cancel


def test_seed_makes_energy_on_an_oscillator(run):
    assert stepper_error(run, "seed", 1e-3) > 1e-5


BELT = """
[scene]
system = "block"
stepper = "{stepper}"
duration = 5
[parameters]
belt_speed = 0.1
static_coefficient = 0.6
dynamic_coefficient = 0.4
[effects]
coulomb = "{coulomb}"
spring = true
[initial]
velocity = 0.1
"""


def test_an_exact_stepper_adds_nothing_to_sticking_and_sliding_and_the_clamp_does(run):
    exact, clamp = (run(BELT.format(stepper=stepper, coulomb=coulomb))
                    for stepper, coulomb in (("expo", "exact"), ("rk4", "moreau")))  # fmt: skip
    check(exact), check(clamp)
    assert abs(exact["stepper"]["kinetic"]) < 1e-13 * exact["size"]
    assert abs(clamp["stepper"]["kinetic"]) > 1e-9 * clamp["size"]


def test_a_ledger_of_what_has_no_energy_is_refused(mctau, scenes):
    done = mctau("run", scenes / "chain.toml", "--ledger")
    assert done.returncode == 2
    assert "--ledger: found chain" in done.stderr


def test_the_ledger_is_a_table_for_people(mctau, scenes):
    lines = mctau("run", scenes / "cart_pole.toml", "--ledger", "--duration", "0.1").stdout.splitlines()
    begin = lines.index("Ledger [J]: work of each effect")
    rows = [line.split()[0] for line in lines[begin + 2 : begin + 11]]
    assert rows == ["gravity", "viscous", "motor", "input", "resistance", "conversion", "stepper", "unexplained",
                    "gain"]  # fmt: skip
