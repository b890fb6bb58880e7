"""mctau run: what comes out, and with which exit code."""

import csv
import json
import math
import os
import signal
import subprocess

import pytest

KEYS = [
    "schema", "system", "stepper", "precision", "dt", "ticks", "time", "state", "state_hex", "energy", "faults", "verdict",
    "ns_per_tick",
]  # fmt: skip
NAMES = {
    "cart_pole": ["cart_position", "pole_angle", "cart_velocity", "pole_rate"],
    "reaction_wheel": ["arm_angle", "wheel_angle", "arm_rate", "wheel_rate", "current"],
}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("system, duration", [("cart_pole", 10), ("reaction_wheel", 15)])
def test_a_default_scene_is_balanced_and_exits_with_0(result, scenes, system, duration):
    found = result("run", scenes / f"{system}.toml", "--duration", duration)
    assert found["verdict"] == "balanced"
    assert found["mode"] == "balance"
    assert 0 < found["upright_at"] <= duration - 1
    assert found["worst_last_second"] <= found["worst_after_upright"] <= math.radians(2)
    assert found["faults"] == []


@pytest.mark.parametrize("system", NAMES)
def test_json_has_all_keys_and_the_states_by_name(result, scenes, system):
    found = result("run", scenes / f"{system}.toml", "--duration", "1", exit_code=1)
    assert [key for key in KEYS if key not in found] == []
    assert found["schema"] == "mctau.run/1"
    assert found["system"] == system
    assert found["precision"] == "double"
    assert (found["dt"], found["ticks"], found["time"]) == (0.001, 1000, 1)
    assert list(found["state"]) == NAMES[system]
    assert list(found["state_hex"]) == NAMES[system]
    assert found["verdict"] == "not_balanced"
    assert found["ns_per_tick"] > 0


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("system", NAMES)
def test_17_digits_are_the_same_number_as_the_hexadecimal_one(result, scenes, precision, system, both_precisions):
    scene = scenes / f"{system}_free.toml"
    found = result("run", scene, "--duration", "2", "--precision", precision)
    assert found["precision"] == precision
    assert {name: float.fromhex(text) for name, text in found["state_hex"].items()} == found["state"]


def test_both_precisions_are_in_one_binary_and_differ_by_rounding(result, scenes, both_precisions):
    scene = scenes / "cart_pole_free.toml"
    double = result("run", scene, "--duration", "1")["state"]
    single = result("run", scene, "--duration", "1", "--precision", "float")["state"]
    assert double != single
    # 1000 steps of compensated float arithmetic: some 1e-6 at most
    assert all(abs(double[name] - single[name]) < 1e-5 for name in double)


def test_the_same_run_gives_the_same_bits_and_the_same_text(result, scenes):
    runs = [result("run", scenes / "cart_pole.toml", "--duration", "3", exit_code=1) for _ in range(2)]
    for run in runs:
        del run["ns_per_tick"]
    assert runs[0] == runs[1]


def test_energy_is_the_sum_of_its_parts(result, scenes):
    found = result("run", scenes / "reaction_wheel.toml", "--duration", "2", exit_code=1)
    # one rounding for each sum
    assert found["energy"] == pytest.approx(sum(found["energies"].values()), rel=1e-15, abs=1e-15)


def test_set_changes_a_parameter_and_the_last_one_wins(result, scenes):
    scene = scenes / "cart_pole_free.toml"
    plain = result("run", scene, "--duration", "1")["state"]
    heavy = result("run", scene, "--duration", "1", "--set", "parameters.pole_mass=0.5")["state"]
    twice = result("run", scene, "--duration", "1", "--set", "parameters.pole_mass=9", "--set", "parameters.pole_mass=0.5")
    assert plain != heavy
    assert twice["state"] == heavy


def test_a_short_cut_is_the_key_that_it_stands_for(result, scenes):
    scene = scenes / "cart_pole.toml"
    short = result("run", scene, "--duration", "0.5", "--dt", "0.002", "--stepper", "leap", exit_code=1)
    long = result("run", scene, "--set", "scene.duration=0.5", "--set", "scene.dt=0.002", "--set", "scene.stepper=leap",
                  exit_code=1)  # fmt: skip
    assert short["stepper"] == "leap"
    assert short["ticks"] == 250
    assert short["state"] == long["state"]


def test_a_scene_can_come_from_stdin(mctau, scenes):
    text = (scenes / "cart_pole_free.toml").read_text()
    done = mctau("run", "-", "--duration", "0.1", "--json", input=text)
    assert done.returncode == 0
    assert json.loads(done.stdout)["ticks"] == 100


def test_free_motion_is_finished_and_exits_with_0(result, scenes):
    found = result("run", scenes / "reaction_wheel_free.toml", "--duration", "1")
    assert found["verdict"] == "finished"
    assert found["mode"] == "open_loop"


def test_a_simulation_that_leaves_all_bounds_is_diverged_and_exits_with_1(result, tmp_path):
    scene = tmp_path / "pushed.toml"
    scene.write_text('scene.system = "linked_particles"\n[input]\nkind = "constant"\nvalue = 1e9\n')
    found = result("run", scene, exit_code=1)
    assert found["verdict"] == "diverged"
    assert found["counters"]["diverged_ticks"] > 0
    assert all(math.isfinite(value) for value in found["state"].values())


def test_steps_that_do_not_follow_the_motion_are_refused_with_those_that_do(mctau, scenes):
    done = mctau("run", scenes / "cart_pole_free.toml", "--set", "initial.pole_rate=1e5")
    assert done.returncode == 2
    assert "scene.dt: found steps of 0.001 s by rk4, which do not follow the motion" in done.stderr
    assert "allowed steps up to" in done.stderr


def test_a_simulation_that_gains_energy_from_nowhere_is_faulted_and_replays(result, mctau, tmp_path):
    scene = tmp_path / "anti_damped.toml"
    scene.write_text('scene.system = "pendulum"\nscene.stepper = "seed"\n[parameters]\nlength = 0.02\n'
                     "[effects]\nviscous = false\n[initial]\nangle = 2.6\n")  # fmt: skip
    found = result("run", scene, "--log", tmp_path / "log", exit_code=1)
    assert found["verdict"] == "faulted"
    assert found["faults"] == ["energy"]
    assert mctau("replay", tmp_path / "log").returncode == 0


def test_zero_ticks_are_the_initial_state(result, scenes):
    found = result("run", scenes / "cart_pole_free.toml", "--duration", "0")
    assert found["ticks"] == 0
    assert found["state"]["pole_angle"] == 2.0


def test_a_variation_is_drawn_from_its_seed_alone(result, scenes):
    scene = scenes / "cart_pole_free.toml"
    spread = ["--duration", "1", "--set", "variation.spread=0.1"]
    states = [result("run", scene, *spread, "--set", f"variation.seed={seed}")["state"] for seed in (1, 2, 1)]
    assert states[0] == states[2]
    assert states[0] != states[1]


def test_the_text_for_people_tells_what_happened(mctau, scenes):
    done = mctau("run", scenes / "cart_pole.toml", "--duration", "10")
    assert done.returncode == 0
    assert done.stderr == ""
    assert "Balanced: upright" in done.stdout
    for name in NAMES["cart_pole"]:
        assert name in done.stdout
    assert "Faults: none" in done.stdout


# --- CSV ---


def test_csv_has_one_row_a_tick_with_states_estimates_inputs_mode_and_faults(result, scenes, tmp_path):
    path = tmp_path / "run.csv"
    found = result("run", scenes / "reaction_wheel.toml", "--duration", "2", "--csv", path, exit_code=1)
    rows = read(path)
    names = NAMES["reaction_wheel"]
    estimates = [f"{name}_estimate" for name in names[:4]]
    assert list(rows[0]) == ["time", *names, *estimates, "wanted", "applied", "mode", "faults"]
    assert len(rows) == found["ticks"] == 2000
    assert float(rows[0]["arm_angle"]) == math.pi
    assert [float(row["time"]) for row in rows] == [tick * 0.001 for tick in range(2000)]
    assert rows[1]["mode"] == "swing_up"
    assert all(row["faults"] == "" for row in rows)


def test_every_scene_runs_with_one_row_a_tick(mctau, scenes, tmp_path):
    for scene in sorted(scenes.glob("*.toml")):
        done = mctau("run", scene, "--duration", "0.1", "--csv", tmp_path / "run.csv", "--json")
        assert done.stderr == "", scene
        assert done.returncode in (0, 1), scene  # 1: not upright yet
        assert len(read(tmp_path / "run.csv")) == json.loads(done.stdout)["ticks"] > 0, scene


def test_csv_does_not_change_a_bit_of_the_run(result, scenes, tmp_path):
    scene = scenes / "cart_pole.toml"
    plain = result("run", scene, "--duration", "3", exit_code=1)
    written = result("run", scene, "--duration", "3", "--csv", tmp_path / "run.csv", exit_code=1)
    assert plain["state_hex"] == written["state_hex"]


def test_csv_rows_continue_from_one_run_to_the_next(result, scenes, tmp_path):
    path = tmp_path / "run.csv"
    scene = scenes / "cart_pole_free.toml"
    result("run", scene, "--duration", "2", "--csv", path)
    half = result("run", scene, "--duration", "1")
    row = read(path)[1000]
    assert {name: float(row[name]) for name in half["state"]} == half["state"]


def test_open_loop_csv_has_no_estimates(result, scenes, tmp_path):
    path = tmp_path / "run.csv"
    result("run", scenes / "cart_pole_free.toml", "--duration", "0.01", "--csv", path)
    assert list(read(path)[0]) == ["time", *NAMES["cart_pole"], "wanted", "applied", "mode", "faults"]


def test_csv_on_stdout_leaves_the_report_to_stderr(mctau, scenes):
    done = mctau("run", scenes / "cart_pole_free.toml", "--duration", "0.01", "--csv", "-")
    assert done.returncode == 0
    assert len(done.stdout.splitlines()) == 11
    assert "Finished" in done.stderr


def test_csv_replaces_a_file_in_whole_and_leaves_nothing_beside_it(result, scenes, tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("old\n" * 100000)
    result("run", scenes / "cart_pole_free.toml", "--duration", "0.01", "--csv", path)
    assert len(read(path)) == 10
    assert os.listdir(tmp_path) == ["run.csv"]


# --- open loop from CSV ---


def test_a_csv_input_is_held_over_each_tick_and_its_last_row_to_the_end(result, tmp_path):
    (tmp_path / "in.csv").write_text('"time", volts\n0,1\n0.001, -2.5e0\n"0.002",3\n')
    scene = tmp_path / "open.toml"
    scene.write_text('[scene]\nsystem = "cart_pole"\nduration = 0.005\n[input]\nkind = "csv"\nfile = "in.csv"\n'
                     'column = "volts"\n')  # fmt: skip
    result("run", scene, "--csv", tmp_path / "out.csv")
    assert [float(row["applied"]) for row in read(tmp_path / "out.csv")] == [1, -2.5, 3, 3, 3]


# --- real time, signals ---


def test_real_time_keeps_the_clock_and_counts_how_late_it_was(result, scenes, tmp_path):
    found = result("run", scenes / "cart_pole_free.toml", "--realtime", "--duration", "0.2", "--csv", tmp_path / "run.csv")
    timing = found["timing"]
    assert sum(timing["lateness"]) == found["ticks"] == 200
    assert len(read(tmp_path / "run.csv")) == 200
    # a tick that is missed is skipped, so the whole lasts at least its time
    assert found["ns_per_tick"] > 0.99e6


def test_real_time_gives_the_bits_of_lockstep(result, scenes):
    scene = scenes / "cart_pole.toml"
    lockstep = result("run", scene, "--duration", "0.2", exit_code=1)
    realtime = result("run", scene, "--duration", "0.2", "--realtime", exit_code=1)
    assert lockstep["state_hex"] == realtime["state_hex"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_run_and_the_result_is_printed(build, scenes, number):
    command = os.environ.get("MCTAU", build / "mctau")
    with subprocess.Popen([command, "run", scenes / "cart_pole_free.toml", "--realtime", "--duration", "60", "--csv", "-"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:  # fmt: skip
        try:
            process.wait(0.5)
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(number)
        rows, report = process.communicate(timeout=20)
    assert process.returncode == 128 + number
    assert "Stopped from outside" in report
    assert "stopped" in report
    assert len(rows.splitlines()) > 1
