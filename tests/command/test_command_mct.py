"""mctau mct: the equation of motion at one state."""

import math

import pytest

KEYS = ["M", "Cv", "C", "tau", "acceleration", "constraint_force", "energy"]
NAMES = {
    "cart_pole": (["cart_position", "pole_angle", "cart_velocity", "pole_rate"], ["cart", "pole"]),
    "reaction_wheel": (
        ["arm_angle", "wheel_angle", "arm_rate", "wheel_rate", "current"],
        ["arm_outer", "arm_inner", "wheel_1", "wheel_2"],
    ),
}


def at(result, scenes, system, *arguments, **state):
    sets = [word for name, value in state.items() for word in ("--set", f"initial.{name}={value!r}")]
    return result("mct", scenes / f"{system}.toml", *sets, *arguments)


@pytest.mark.parametrize("system", NAMES)
def test_json_has_all_keys_in_the_shapes_of_the_system(result, scenes, system):
    found = at(result, scenes, system)
    states, particles = NAMES[system]
    assert [key for key in KEYS if key not in found] == []
    assert found["schema"] == "mctau.mct/1"
    assert list(found["state"]) == states
    assert [len(row) for row in found["M"]] == [2, 2]
    assert [len(row) for row in found["C"]] == [2, 2]
    assert [len(found[key]) for key in ("Cv", "tau", "acceleration")] == [2, 2, 2]
    assert list(found["constraint_force"]) == particles
    assert all(len(force) == 3 for force in found["constraint_force"].values())


def test_the_numbers_are_those_of_the_textbook_cart_pole(result, scenes):
    m1, m2, length, gravity = 0.758, 0.175, 0.434, 9.81
    angle, rate, force = 0.5, 2.0, 3.0
    found = at(result, scenes, "cart_pole", "--set", "effects.motor=off", "--set", "effects.saturation=off", "--set", "effects.viscous=false",
               "--set", "controller.kind=none", "--input", force, pole_angle=angle, pole_rate=rate)  # fmt: skip
    s, c = math.sin(angle), math.cos(angle)
    mass = [[m1 + m2, m2 * length * c], [m2 * length * c, m2 * length**2]]
    # some ten roundings of numbers of order 1
    assert found["M"] == [pytest.approx(row, rel=1e-14) for row in mass]
    assert found["Cv"] == pytest.approx([-m2 * length * s * rate**2, 0], rel=1e-14)
    assert found["tau"] == pytest.approx([force, m2 * gravity * length * s], rel=1e-14)
    kinetic = 0.5 * m2 * (length * rate) ** 2
    assert found["energy"] == pytest.approx(kinetic + m2 * gravity * length * c, rel=1e-14)


@pytest.mark.parametrize("system", NAMES)
def test_M_a_plus_C_v_is_tau(result, scenes, system):
    states, _ = NAMES[system]
    rates = {states[0]: 0.3, states[1]: -0.7, states[2]: 2.0, states[3]: -3.0}
    found = at(result, scenes, system, "--input", "5", **rates)
    v = [2.0, -3.0]
    for i in range(2):
        inertia = sum(found["M"][i][j] * found["acceleration"][j] for j in range(2))
        coupled = sum(found["C"][i][j] * v[j] for j in range(2))
        # of sums of numbers of order 1, the wheel's acceleration being some 1e4 times as large
        assert inertia + found["Cv"][i] == pytest.approx(found["tau"][i], rel=1e-12, abs=1e-13)
        assert coupled == pytest.approx(found["Cv"][i], rel=1e-14, abs=1e-15)


@pytest.mark.parametrize("system", NAMES)
def test_the_power_is_the_rate_of_the_energy_and_each_account_closes(result, scenes, system):
    found = at(result, scenes, system, "--input", "5", **{NAMES[system][0][2]: 1.0, NAMES[system][0][3]: 2.0})
    powers = found["powers"]
    rates = found["rates"]
    assert found["power"] == pytest.approx(sum(rates.values()), rel=1e-14, abs=1e-15)
    assert rates["kinetic"] == pytest.approx(
        powers["gravity"] + powers["viscous"] + powers["motor"], rel=1e-14, abs=1e-15
    )
    assert rates["potential"] == -powers["gravity"]
    inside = powers["input"] + powers["resistance"] + powers["conversion"] - powers["motor"]
    assert rates["magnetic"] == pytest.approx(inside, rel=1e-13, abs=1e-13)  # 0 without an inductance
    assert powers["viscous"] < 0


def test_without_an_input_the_scenes_own_at_the_start_counts(result, scenes):
    arguments = ["--set", "controller.kind=none", "--set", "input.kind=constant", "--set", "input.value=4"]
    assert at(result, scenes, "cart_pole")["input"] == 0
    assert at(result, scenes, "cart_pole", *arguments)["input"] == 4
    assert at(result, scenes, "cart_pole", "--input", "-3")["input"] == -3


def test_an_input_beyond_the_supply_is_cut_as_in_a_run(result, scenes):
    assert at(result, scenes, "cart_pole", "--input", "99")["input"] == 10


def test_an_input_that_is_no_number_is_refused(mctau, scenes):
    for text in ("nan", "inf", "1e10", "ten", ""):
        done = mctau("mct", scenes / "cart_pole.toml", "--input", text)
        assert done.returncode == 2
        assert "--input" in done.stderr
        assert done.stdout == ""


def test_the_text_for_people_has_units_and_explains_e(mctau, scenes):
    done = mctau("mct", scenes / "cart_pole.toml")
    assert done.returncode == 0
    for word in ("kg m^2", "N m", "Gauss", "kinetic", "viscous", "rad/s^2"):
        assert word in done.stdout


@pytest.mark.parametrize("system", NAMES)
def test_a_negative_zero_is_0_for_people_and_keeps_its_bits_in_json(mctau, scenes, system):
    scene = scenes / f"{system}.toml"
    at_rest = [word for name in NAMES[system][0][:2] for word in ("--set", f"initial.{name}=0")]
    assert "-0" not in mctau("mct", scene, *at_rest).stdout.split()
    assert "-0" in mctau("mct", scene, *at_rest, "--json").stdout.replace(",", " ").split()
