"""mctau cost: what accuracy costs."""

import json
import math
import re

import pytest

STILL = {"cart_pole_free": "free", "linked_particles": "held", "reaction_wheel": "replayed"}
KEYS = {"stepper", "precision", "dt", "substeps", "step", "diverged", "error_end", "error_worst", "ns_per_tick",
        "ns_per_tick_low", "ns_per_tick_high", "ns_per_ms", "instructions_per_tick", "pareto"}  # fmt: skip


@pytest.fixture(scope="module")
def costs(mctau, scenes):
    """costs("pendulum", ...): what --json prints, each asked for once."""
    known = {}

    def of(name, *arguments):
        if (name, arguments) not in known:
            done = mctau("cost", scenes / f"{name}.toml", *arguments, "--json")
            assert done.returncode == 0 and done.stderr == "", done.stderr
            known[name, arguments] = json.loads(done.stdout)
        return known[name, arguments]

    return of


def line(costs, stepper, precision="double"):
    return [one for one in costs["candidates"] if (one["stepper"], one["precision"]) == (stepper, precision)]


@pytest.mark.parametrize("scene", STILL)
def test_every_suiting_stepper_has_all_keys_at_several_steps_in_each_precision(costs, result, precisions, scene):
    found = costs(scene)
    assert found["schema"] == "mctau.cost/1"
    assert found["input"] == STILL[scene]
    suiting = result("list", found["system"])["systems"][0]["steppers"]
    assert {(one["stepper"], one["precision"]) for one in found["candidates"]} == {
        (stepper, precision) for stepper in suiting for precision in precisions
    }
    for one in found["candidates"]:
        assert set(one) == KEYS
        assert one["step"] == pytest.approx(one["dt"] / one["substeps"], rel=1e-15)  # the same quotient
        assert one["diverged"] or one["ns_per_tick_low"] <= one["ns_per_tick"] <= one["ns_per_tick_high"]
    assert all(len(line(found, stepper)) >= 4 for stepper in suiting)


def test_the_tick_is_kept_where_the_input_changes_and_not_where_there_is_none(costs):
    assert {one["dt"] for one in costs("linked_particles")["candidates"]} == {0.001}
    free = costs("cart_pole_free")
    steps = [one["step"] for one in line(free, "rk4")]
    assert max(steps) >= 0.016 and min(steps) <= 0.001 / 8
    for one in free["candidates"]:
        ticks = free["horizon"] / one["dt"]
        assert ticks == pytest.approx(round(ticks), abs=1e-6)  # the duration is a whole number of them


@pytest.mark.parametrize("stepper, order", [("euler", 1), ("leap", 2), ("rk4", 4)])
def test_errors_fall_by_the_order_of_the_stepper(costs, stepper, order):
    found = costs("cart_pole_free", "--precision", "double")
    # Where the leading term alone counts: short steps, and nothing near rounding.
    exact = [one for one in line(found, stepper) if one["step"] <= 0.0041 and one["error_worst"] > 1e-13]
    assert len(exact) >= 4
    for coarse, fine in zip(exact, exact[1:]):
        seen = math.log(coarse["error_worst"] / fine["error_worst"]) / math.log(coarse["step"] / fine["step"])
        assert seen == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("scene", STILL)
def test_the_front_is_what_nothing_beats_in_both_cost_and_error(costs, scene):
    found = costs(scene)
    known = found["reference"]["uncertainty"]
    points = [(one["ns_per_tick"], max(one["error_worst"], known), one["pareto"])
              for one in found["candidates"] if not one["diverged"]]  # fmt: skip
    for ns, error, front in points:
        beaten = any(n <= ns and e <= error and (n < ns or e < error) for n, e, _ in points)
        assert front == (not beaten)
    assert not any(one["pareto"] for one in found["candidates"] if one["diverged"])
    assert any(front for _, _, front in points)


@pytest.mark.parametrize("scene", ["pendulum", "cart_pole_free", "rigid_body", "ball_joint", "rotating_frame", "spring_pendulum",
                                   "linked_particles", "falling_sphere", "moving_base"])  # fmt: skip
def test_two_families_of_methods_agree_on_the_reference_to_1e_13(costs, scene):
    reference = costs(scene, "--precision", "double")["reference"]
    assert reference["verified"]
    assert reference["stepper"].rstrip("0123456789") != reference["other_stepper"].rstrip("0123456789")
    assert reference["agreement"] <= reference["uncertainty"] <= 1e-13


def test_what_two_methods_do_not_agree_on_is_told_and_counts_as_uncertain(costs, mctau, scenes):
    # Where it sticks and slips, methods that do not look for the moment agree to their step at best.
    moreau = "--precision", "double", "--set", "effects.coulomb=moreau"
    reference = costs("block", *moreau)["reference"]
    assert 1e-10 < reference["agreement"] <= reference["uncertainty"]
    said = mctau("cost", scenes / "block.toml", *moreau).stdout
    assert f"Known to {reference['uncertainty']:.1e}" in said


def test_a_chaotic_scene_is_called_so_and_gets_a_horizon(costs, mctau, scenes):
    wild = ["--set", "initial.angle=0.3", "--set", "initial.length=1.5", "--set", "parameters.length_friction=0",
            "--set", "parameters.angle_friction=0", "--duration", "40", "--precision", "double"]  # fmt: skip
    found = costs("spring_pendulum", *wild)
    assert found["sensitive"] and found["growth"] > 1e4
    assert 1 < found["horizon"] < found["duration"] == 40
    assert found["reference"]["uncertainty"] < 1e-10  # a start known to 1e-16 has grown to 1e-12
    said = mctau("cost", scenes / "spring_pendulum.toml", *wild).stdout
    assert f"--duration {found['horizon']:g} of 40 s" in said and "chaotic" in said


def test_a_quiet_scene_is_not_called_chaotic(costs):
    found = costs("pendulum", "--precision", "double")
    assert not found["sensitive"] and found["horizon"] == found["duration"]


def test_the_error_of_an_attitude_is_the_angle_to_the_references(costs, mctau, scenes):
    def end(*arguments):
        done = mctau("run", scenes / "ball_joint.toml", *arguments, "--json")
        state = json.loads(done.stdout)["state"]
        return [state[f"attitude_{c}"] for c in "wxyz"], [state[f"angular_velocity_{i}"] for i in "123"]

    one = next(one for one in line(costs("ball_joint"), "euler") if one["step"] == 0.001)
    (q, rates), (exact, exact_rates) = end("--stepper", "euler"), end("--set", "scene.substeps=8")
    angle = 2 * math.acos(min(1, abs(sum(a * b for a, b in zip(q, exact)))))
    rate = max(abs(a - b) for a, b in zip(rates, exact_rates))  # of rates of order 1, whose scale may be a little more
    assert angle > 1e-6  # something to see
    assert angle * (1 - 1e-3) <= one["error_end"] <= max(angle, rate) * (1 + 1e-3)


@pytest.mark.parametrize("scene, stepper", [("linked_particles", "euler"), ("cart_pole", "rk4"), ("reaction_wheel", "expo"),
                                            ("cart_pole_free", "leap")])  # fmt: skip
def test_a_run_ends_as_far_from_the_reference_as_the_table_says(costs, mctau, scenes, scene, stepper):
    # The scene's own run, whose controller acts: so the inputs that were replayed are those of the loop.
    found = costs(scene)
    one = next(one for one in line(found, stepper) if one["step"] == found["tick"])
    done = mctau("run", scenes / f"{scene}.toml", "--stepper", stepper, "--duration", repr(found["horizon"]), "--json")
    state, exact = json.loads(done.stdout)["state"], found["reference"]["state"]
    distances = [abs(state[name] - exact[name]) for name in exact]
    assert max(distances) > 0
    # What divides is the largest value of the whole run, not less than this one's.
    assert max(d / max(1, abs(exact[name])) for d, name in zip(distances, exact)) >= 0.999 * one["error_end"]
    assert min(d for d in distances if d > 0) <= 1.001 * one["error_end"]
    assert max(distances) <= 2000 * one["error_end"]  # the fastest wheel


def test_a_longer_step_is_counted_in_parts_of_a_tick(costs):
    steps = {one["step"]: one for one in line(costs("cart_pole_free"), "rk4")}
    assert steps[0.016]["ns_per_tick"] < 0.5 * steps[0.001]["ns_per_tick"]
    one = steps[0.001]
    assert one["ns_per_ms"] == pytest.approx(one["ns_per_tick"], rel=1e-12)  # at a tick of 1 ms


def test_neighbouring_steps_are_less_than_an_octave_apart_where_they_can_be(costs):
    for scene in ("cart_pole_free", "linked_particles"):
        steps = [one["step"] for one in line(costs(scene), "rk4")]
        assert all(fine < coarse <= 2.001 * fine for coarse, fine in zip(steps, steps[1:]))
        assert sum(coarse < 1.7 * fine for coarse, fine in zip(steps, steps[1:])) >= len(steps) // 2


def test_who_counted_instructions_is_told_in_json_table_and_page(costs, mctau, scenes, source, tmp_path):
    found = costs("pendulum")
    counted = any(one["instructions_per_tick"] is not None for one in found["candidates"])
    assert counted == (found["instructions_counted_by"] is not None) == (found["instructions_not_counted"] is None)
    page = tmp_path / "cost.html"
    has_python = (source / "build/venv/bin/python").exists()
    said = mctau("cost", scenes / "pendulum.toml", "--instructions", "none", *(["--html", page] if has_python else [])).stdout
    assert "Instructions: not counted: not asked for." in said
    assert not has_python or "not counted: not asked for" in page.read_text()


def test_valgrind_counts_the_same_instructions_as_the_processor(costs):
    found = costs("linked_particles", "--instructions", "valgrind")
    if found["instructions_counted_by"] is None:
        pytest.skip(f"not counted: {found['instructions_not_counted']}")
    assert found["instructions_counted_by"] == "valgrind"
    processor = costs("linked_particles")
    assert all(one["instructions_per_tick"] > 10 for one in found["candidates"])
    if processor["instructions_counted_by"] != "processor":
        pytest.skip("the kernel does not let a program count its instructions")
    for one, other in zip(found["candidates"], processor["candidates"]):
        assert (one["stepper"], one["step"]) == (other["stepper"], other["step"])
        # The processor's counter may be off by some instructions when it is interrupted.
        assert one["instructions_per_tick"] == pytest.approx(other["instructions_per_tick"], rel=0.02, abs=4)


def test_without_valgrind_the_reason_is_told(mctau, scenes):
    done = mctau("cost", scenes / "linked_particles.toml", "--instructions", "valgrind", "--json", env={"PATH": "/nowhere"})
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert found["instructions_counted_by"] is None
    assert found["instructions_not_counted"] == "valgrind is not installed"


def test_instructions_are_whole_work_per_step_or_not_told(costs):
    steps = {one["substeps"]: one["instructions_per_tick"] for one in line(costs("linked_particles"), "rk4")}
    if steps[1] is None:
        pytest.skip("the kernel does not let a program count its instructions")
    first, second = steps[2] - steps[1], steps[4] - steps[2]
    assert first > 10 and second == pytest.approx(2 * first, rel=0.05)  # loops are unrolled differently at the ends


def test_the_table_for_people_has_units_and_marks_the_front(mctau, scenes):
    said = mctau("cost", scenes / "cart_pole_free.toml").stdout
    assert "step [ms]" in said and "ns/tick" in said and "Reference: " in said
    assert re.search(r"^\* rk4 +double", said, re.MULTILINE)


def test_a_plot_and_a_page_are_drawn(mctau, scenes, source, tmp_path):
    if not (source / "build/venv/bin/python").exists():
        pytest.skip("no Python environment in build/venv")
    svg, page = tmp_path / "cost.svg", tmp_path / "cost.html"
    done = mctau("cost", scenes / "pendulum.toml", "--plot", svg, "--html", page)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert svg.read_text().startswith("<svg") and "rk4" in svg.read_text()
    assert "<table>" in page.read_text() and "<svg" in page.read_text() and "http" not in page.read_text().replace(
        "http://www.w3.org", "")  # fmt: skip


def test_a_file_that_cannot_be_written_is_an_error_of_files(mctau, scenes, source, tmp_path):
    if not (source / "build/venv/bin/python").exists():
        pytest.skip("no Python environment in build/venv")
    done = mctau("cost", scenes / "pendulum.toml", "--plot", tmp_path / "nowhere" / "cost.svg")
    assert done.returncode == 3 and "nowhere" in done.stderr


BAD = {
    "process": (["chain.toml"], "process"),
    "no time": (["pendulum.toml", "--duration", "0"], "scene.duration"),
    "precision": (["pendulum.toml", "--precision", "half"], "--precision: found half; allowed double"),
    "seconds": (["pendulum.toml", "--reference-seconds", "0"], "--reference-seconds: found 0; allowed"),
    "counter": (["pendulum.toml", "--instructions", "me"], "--instructions: found me; allowed processor, valgrind, none"),
    "part of a tick": (["pendulum.toml", "--duration", "0.0005"], "whole number of ticks"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_measured_is_refused(mctau, scenes, case):
    (scene, *rest), words = BAD[case]
    done = mctau("cost", scenes / scene, *rest, "--json")
    assert done.returncode == 2 and done.stdout == ""
    assert words in done.stderr


# A mass shot through the pivot on a stiff spring.
# A sphere that nothing holds, at 1000 km/s: after a quarter of an hour it is beyond what a state may be.
DIVERGING = ["--set", "initial.velocity=1e6", "--set", "scene.dt=0.1", "--duration", "1100",
             *(word for effect in ("gravity", "buoyancy", "drag") for word in ("--set", f"effects.{effect}=false"))]  # fmt: skip


def test_a_scene_that_diverges_has_no_reference_and_says_so(mctau, scenes):
    for verb, *request in (("cost",), ("pick", "--tolerance", "1e-3")):
        done = mctau(verb, scenes / "falling_sphere.toml", *request, *DIVERGING, "--json")
        assert done.returncode == 1 and done.stdout == ""
        assert "diverges with every stepper" in done.stderr and "--duration" in done.stderr


def test_a_missing_scene_is_an_error_of_files(mctau, tmp_path):
    assert mctau("cost", tmp_path / "none.toml").returncode == 3
