"""What goes wrong during a run: sensors and disks."""

import csv
import json
import os

import pytest

TICK = 0.001


@pytest.fixture
def rows(mctau, scenes, tmp_path):
    """rows(fault, ...): the CSV rows and the result of a run whose sensors fail at 0.5 s, well within the swing-up."""

    def run(fault, *arguments):
        path = tmp_path / "run.csv"
        done = mctau("run", scenes / "cart_pole.toml", "--duration", "1", "--set", f"sensors.fault={fault}",
                     "--set", "sensors.fault_time=0.5", *arguments, "--csv", path, "--json")  # fmt: skip
        with open(path, newline="") as file:
            return list(csv.DictReader(file)), json.loads(done.stdout), done.returncode

    return run


def test_a_nan_from_a_sensor_means_zero_volts_from_that_tick_on(rows):
    ticks, found, exit_code = rows("nan")
    assert exit_code == 1
    assert found["verdict"] == "faulted"
    assert found["faults"] == ["sensor_invalid"]
    assert found["fault_ticks"] == {"sensor_invalid": 100}
    assert found["fault_at"] == pytest.approx(0.5)
    assert all(float(row["applied"]) != 0 for row in ticks[1:500])
    assert all(float(row["applied"]) == 0 for row in ticks[500:])
    assert all(row["faults"] == "sensor_invalid" for row in ticks[500:])
    assert ticks[499]["faults"] == ""


def test_a_nan_from_a_sensor_never_reaches_an_estimate(rows):
    ticks, _, _ = rows("nan")
    for name in ("cart_position", "pole_angle", "cart_velocity", "pole_rate"):
        estimates = [float(row[f"{name}_estimate"]) for row in ticks]
        assert all(abs(value) < 100 for value in estimates)


def test_a_silent_sensor_is_derated_and_then_zero_within_6_ticks(rows):
    ticks, found, exit_code = rows("silent")
    assert exit_code == 1
    assert found["verdict"] == "faulted"
    assert found["faults"] == ["sensor_stale"]
    assert found["counters"]["derated_ticks"] > 0
    shares = [round(float(row["applied"]) / float(row["wanted"]), 3) for row in ticks[499:507]]
    assert shares[0] == 1  # but for whole millivolts
    assert any(0 < share < 1 for share in shares)
    assert shares == sorted(shares, reverse=True)
    assert shares[6:] == [0, 0]
    assert all(float(row["applied"]) == 0 for row in ticks[506:])


def test_a_fault_stays_latched_when_the_sensor_comes_back(rows):
    ticks, found, _ = rows("silent", "--set", "sensors.fault_duration=0.02")
    assert float(ticks[-1]["applied"]) == 0
    assert ticks[-1]["faults"] == "sensor_stale"
    assert found["fault_at"] < 0.507


def test_the_text_for_people_explains_a_fault(mctau, scenes):
    done = mctau("run", scenes / "cart_pole.toml", "--duration", "1", "--set", "sensors.fault=nan",
                 "--set", "sensors.fault_time=0.5")  # fmt: skip
    assert done.returncode == 1
    assert "Faulted at 0.500 s" in done.stdout
    assert "sensor_invalid" in done.stdout
    assert "wiring" in done.stdout


# --- a full disk ---


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
@pytest.mark.parametrize("option", ["--csv", "--log"])
def test_a_full_disk_is_said_once_and_the_run_goes_on(mctau, scenes, option, logs):
    plain = json.loads(mctau("run", scenes / "cart_pole.toml", "--duration", "8", "--json").stdout)
    done = mctau("run", scenes / "cart_pole.toml", "--duration", "8", "--json", option, "/dev/full")
    assert done.returncode == 3
    assert done.stderr.count("No space left on device") == 1
    assert len(done.stderr.splitlines()) == 1
    assert json.loads(done.stdout)["state_hex"] == plain["state_hex"]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_a_csv_that_is_cut_by_a_full_disk_counts_its_rows(mctau, scenes):
    done = mctau("run", scenes / "cart_pole_free.toml", "--duration", "2", "--csv", "/dev/full")
    assert "2000 rows are lost" in done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_a_result_that_cannot_be_printed_is_an_error_of_output(mctau, build, scenes):
    import subprocess

    command = os.environ.get("MCTAU", build / "mctau")
    with open("/dev/full", "w") as full:
        done = subprocess.run([command, "list", "--json"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=20)
    assert done.returncode == 3
    assert "could not be printed" in done.stderr
