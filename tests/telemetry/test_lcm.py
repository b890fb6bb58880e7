"""The event log as others read it, with LCM's Python bindings and the generated types; and a full disk."""

import json
import math

import pytest

lcm = pytest.importorskip("lcm")
if not hasattr(lcm, "EventLog"):
    pytest.skip("no Python package lcm", allow_module_level=True)
pytest.importorskip("mctau.tick_t", reason="the build made no telemetry types for Python")
from mctau import health_t, scene_t, tick_t


@pytest.fixture(scope="module")
def recorded(mctau, source, tmp_path_factory):
    """(JSON of a run of 3 s, its log's path)."""
    log = tmp_path_factory.mktemp("log") / "run.lcm"
    scene = source / "scenes" / "reaction_wheel.toml"
    run = mctau("run", scene, "--duration", "3", "--set", "sensors.noise=0.5", "--log", log, "--json")
    assert run.returncode in (0, 1), run.stderr
    return json.loads(run.stdout), log


def messages(log, channel, kind):
    return [(event.timestamp, kind.decode(event.data)) for event in lcm.EventLog(str(log))
            if event.channel == channel]


def test_every_tick_is_in_the_log_at_its_simulated_time(recorded):
    run, log = recorded
    ticks = messages(log, "MCTAU_TICK", tick_t)
    assert [message.tick for _, message in ticks] == list(range(run["ticks"]))
    assert [message.sequence for _, message in ticks] == list(range(run["ticks"]))
    assert all(time == message.utime == message.tick * 1000 for time, message in ticks)
    assert all(message.dropped == 0 and message.late_us == 0 for _, message in ticks)


def test_the_scene_comes_first_and_names_everything(recorded, source):
    run, log = recorded
    first = next(iter(lcm.EventLog(str(log))))
    assert first.channel == "MCTAU_SCENE" and first.timestamp == 0
    scene = scene_t.decode(first.data)
    assert scene.text == (source / "scenes" / "reaction_wheel.toml").read_text()
    assert "sensors.noise=0.5" in scene.overrides
    assert [scene.precision, scene.system, scene.stepper] == [run["precision"], run["system"], run["stepper"]]
    assert list(scene.state_names) == list(run["state"])
    assert scene.state_units[0] == "rad" and scene.dt == run["dt"] and scene.input_unit == "V"
    assert "balance" in scene.mode_names and "sensor_stale" in scene.fault_names


def test_values_are_those_of_the_run(recorded):
    """The state after the last tick follows from its record by one step of 1 ms: near, names in order."""
    run, log = recorded
    scene = scene_t.decode(next(iter(lcm.EventLog(str(log)))).data)
    _, last = messages(log, "MCTAU_TICK", tick_t)[-1]
    values = dict(zip(scene.state_names, last.x))
    for i, name in enumerate(scene.state_names[:scene.coordinates]):
        value = values[name] + last.turns[i] * 2 * math.pi
        rate = last.x[scene.coordinates + i]
        assert value == pytest.approx(run["state"][name], abs=abs(rate) * 0.001 + 0.01)
        assert last.estimate[i] == pytest.approx(math.remainder(values[name], 2 * math.pi), abs=0.01)


def test_health_tells_how_it_went_and_ends_the_log(recorded):
    run, log = recorded
    healths = [message for _, message in messages(log, "MCTAU_HEALTH", health_t)]
    assert [health.sequence for health in healths] == list(range(len(healths)))
    assert len(healths) == run["ticks"] // 100 + 1
    last = healths[-1]
    assert last.finished and not any(health.finished for health in healths[:-1])
    assert last.records == run["ticks"] == sum(last.mode_ticks) == sum(last.lateness)
    assert last.dropped == last.log_errors == last.missed_ticks == 0


def test_the_same_run_leaves_the_same_log(mctau, source, tmp_path):
    """The same command, that is: the options are part of the log, and the path is one of them."""
    logs = []
    for folder in (tmp_path / "first", tmp_path / "second"):
        folder.mkdir()
        scene = source / "scenes" / "reaction_wheel.toml"
        mctau("run", scene, "--duration", "3", "--log", "run.lcm", cwd=folder)
        logs.append((folder / "run.lcm").read_bytes())
    assert len(logs[0]) > 3000 * 200 and logs[0] == logs[1]


def test_a_full_disk_is_said_once_and_the_run_goes_on(mctau, source):
    scene = source / "scenes" / "reaction_wheel.toml"
    plain = mctau("run", scene, "--duration", "3", "--json")
    full = mctau("run", scene, "--duration", "3", "--json", "--log", "/dev/full")
    assert full.returncode == 3
    assert full.stderr.count("No space left") == 1
    assert json.loads(full.stdout)["state_hex"] == json.loads(plain.stdout)["state_hex"]


def test_a_log_that_cannot_be_made_stops_the_run(mctau, source, tmp_path):
    scene = source / "scenes" / "reaction_wheel.toml"
    path = tmp_path / "none" / "run.lcm"
    done = mctau("run", scene, "--duration", "1", "--log", path)
    assert done.returncode == 3 and str(path) in done.stderr and not path.exists()
    path = tmp_path / "run.lcm"
    done = mctau("run", scene, "--duration", "1", "--log", path, "--lcm", "tcpq://127.0.0.1:1")
    assert done.returncode == 2 and "udpm://" in done.stderr and not path.exists()


def test_a_double_keeps_its_bits_on_the_way(recorded):
    """Encoded by C and decoded by Python: the bytes of a message are the same again."""
    _, log = recorded
    for event in list(lcm.EventLog(str(log)))[:50]:
        kind = {"MCTAU_TICK": tick_t, "MCTAU_SCENE": scene_t, "MCTAU_HEALTH": health_t}[event.channel]
        assert kind.decode(event.data).encode() == event.data
