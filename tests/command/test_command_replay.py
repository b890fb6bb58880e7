"""mctau replay: the same bits from a log, by the command alone."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("logs")


@pytest.fixture
def log(mctau, scenes, tmp_path):
    def record(*arguments, scene="cart_pole.toml"):
        path = tmp_path / "run.lcm"
        done = mctau("run", scenes / scene, "--duration", "2", "--log", path, "--json", *arguments)
        assert done.returncode in (0, 1), done.stderr
        return path

    return record


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("scene", ["cart_pole.toml", "reaction_wheel.toml"])
def test_a_log_replays_to_the_same_bits(result, log, scene, precision, both_precisions):
    found = result("replay", log("--precision", precision, "--set", "sensors.noise=0.5", scene=scene))
    assert found["equal"] is True
    assert found["ticks"] == 2000
    assert found["truncated"] is False


def test_overrides_are_part_of_the_log(result, log):
    found = result("replay", log("--set", "parameters.pole_mass=0.3", "--dt", "0.002"))
    assert found["equal"] is True
    assert found["ticks"] == 1000


def test_a_truncated_log_is_replayed_up_to_its_last_tick_and_exits_with_3(mctau, log):
    path = log()
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    done = mctau("replay", path, "--json")
    found = json.loads(done.stdout)
    assert done.returncode == 3
    assert "run.lcm: the log was cut" in done.stderr
    assert found["truncated"] is True
    assert 0 < found["ticks"] < 2000


@pytest.mark.parametrize("data", [b"", b"[scene]\n", bytes(1000)])
def test_what_is_no_log_is_refused(mctau, tmp_path, data):
    path = tmp_path / "x.lcm"
    path.write_bytes(data)
    done = mctau("replay", path)
    assert done.returncode in (2, 3)
    assert done.stdout == ""
    assert "x.lcm" in done.stderr


def test_a_missing_log_is_an_error_of_input(mctau, tmp_path):
    done = mctau("replay", tmp_path / "none.lcm")
    assert done.returncode == 3
    assert "No such file" in done.stderr
