"""mctau list: what there is, from the descriptors."""


def test_json_lists_systems_with_parameters_effects_steppers_and_controllers(result):
    found = result("list")
    assert [key for key in ("systems", "effects", "steppers", "controllers") if key not in found] == []
    assert [system["name"] for system in found["systems"]] == [
        "cart_pole", "reaction_wheel", "pendulum", "spring_pendulum", "linked_particles",
        "particle_pendulum", "moving_base", "rotating_frame", "ball_joint", "fixed_axis", "solid_pendulum", "rigid_body",
        "chain", "block", "falling_sphere"]  # fmt: skip
    assert {stepper["name"]: stepper["order"] for stepper in found["steppers"]} == {
        "seed": 1, "euler": 1, "leap": 2, "rk4": 4, "taylor4": 4, "taylor6": 6, "taylor8": 8,
        "taylor12": 12, "expo": 5, "expo8": 8, "rkn6": 6, "split3": 2, "discrete": 1,
    }  # fmt: skip
    assert found["controllers"] == ["none", "swing_up_balance"]
    assert [effect["name"] for effect in found["effects"]] == [
        "gravity", "viscous", "coulomb", "motor", "saturation", "drag", "spring", "base_motion", "centrifugal",
        "coriolis", "euler", "stokes", "buoyancy", "forcing", "forces"]  # fmt: skip


def test_every_parameter_and_coordinate_has_unit_range_and_a_default_within(result):
    for system in result("list")["systems"]:
        rates = [coordinate["rate"] for coordinate in system["coordinates"] if "rate" in coordinate]
        columns = [column for rows in system["lists"] for column in rows["columns"]]
        for field in system["parameters"] + system["coordinates"] + rates + columns:
            if "choices" in field:
                assert field["default"] in field["choices"], field["name"]
                continue
            assert isinstance(field["unit"], str)
            assert field["minimum"] <= field["default"] <= field["maximum"] or field in columns, field["name"]
        assert all(parameter["doc"] for parameter in system["parameters"])


def test_a_system_lists_the_steppers_that_suit_it(result):
    steppers = {system["name"]: system["steppers"] for system in result("list")["systems"]}
    assert "expo" in steppers["reaction_wheel"]
    assert "expo" not in steppers["cart_pole"]
    rare = {system["name"]: system["steppers_without_friction"] for system in result("list")["systems"]}
    assert rare["pendulum"] == ["rkn6"]
    assert rare["cart_pole"] == []


def test_one_system_can_be_asked_for(result, mctau):
    assert [system["name"] for system in result("list", "cart_pole")["systems"]] == ["cart_pole"]
    assert "pole_length" in mctau("list", "cart_pole").stdout
    assert "wheel" not in mctau("list", "cart_pole").stdout


def test_an_unknown_system_is_refused_with_those_that_there_are(mctau):
    done = mctau("list", "acrobot")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "acrobot" in done.stderr
    assert "cart_pole, reaction_wheel" in done.stderr


def test_every_default_of_a_scene_is_accepted_by_the_reader(result, mctau, scenes):
    for table in result("list")["tables"]:
        for key in table["keys"]:
            if "default" not in key or table["name"] in ("input", "controller"):
                continue
            value = key["default"]
            text = str(value).lower() if isinstance(value, bool) else f"{value}"
            done = mctau("run", scenes / "cart_pole_free.toml", "--set", f"{table['name']}.{key['name']}={text}", "--json")
            assert done.returncode == 0, done.stderr
