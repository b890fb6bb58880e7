"""Telemetry over multicast, in a network of its own (user and network namespace, loopback only):

- 10 s at 1 kHz: a subscriber with a queue of 1000 receives every message;
- a subscriber that has been stopped changes no tick;
- without a route the run goes on, with a warning;
- lcm-logplayer plays a log to subscribers.

Called as a program, this file is the subscriber.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

URL = "udpm://239.255.76.67:7667?ttl=0"
LISTENER = (sys.executable, pathlib.Path(__file__).resolve())
NETWORK = "ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec \"$@\""


def subscribe(seconds):
    """Prints "ready"; then, when the run's last message has come or time is up, what has come."""
    import time

    import lcm
    from mctau import health_t, scene_t, tick_t

    seen = {"ticks": [], "sequences": [], "scenes": 0, "healths": 0, "dropped": 0, "finished": False}

    def on_tick(_, data):
        message = tick_t.decode(data)
        seen["ticks"].append(message.tick)
        seen["sequences"].append(message.sequence)

    def on_scene(_, data):
        seen["scenes"] += len(scene_t.decode(data).text) > 0

    def on_health(_, data):
        message = health_t.decode(data)
        seen["healths"] += 1
        seen["dropped"] = message.dropped
        seen["finished"] = bool(message.finished)

    network = lcm.LCM(URL)
    for channel, handler in (("MCTAU_TICK", on_tick), ("MCTAU_SCENE", on_scene), ("MCTAU_HEALTH", on_health)):
        network.subscribe(channel, handler).set_queue_capacity(1000)
    print("ready", flush=True)
    end = time.monotonic() + seconds
    while not seen["finished"] and time.monotonic() < end:
        network.handle_timeout(100)
    while network.handle_timeout(100):
        pass
    print(json.dumps(seen), flush=True)


if __name__ == "__main__":
    subscribe(float(sys.argv[1]))
    sys.exit()

if not hasattr(pytest.importorskip("lcm"), "LCM"):
    pytest.skip("no Python package lcm", allow_module_level=True)
pytest.importorskip("mctau.tick_t", reason="the build made no telemetry types for Python")


def in_network(script, *arguments, setup=NETWORK, **options):
    user = "-n" if os.geteuid() == 0 else "-rn"  # root needs no user namespace, which a chroot has not got
    command = ["unshare", user, "sh", "-c", setup, "sh", "sh", "-c", script, "sh", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


@pytest.fixture(scope="module", autouse=True)
def network():
    if shutil.which("unshare") is None or shutil.which("ip") is None:
        pytest.skip("no unshare or no ip: multicast cannot be kept on this machine")
    with in_network("true") as tried:
        _, errors = tried.communicate(timeout=20)
        if tried.returncode != 0:
            pytest.skip(f"no network namespace for an ordinary user here: {errors.strip()}")


@pytest.fixture
def command(mctau, build):
    """Path of the command; the fixture mctau skips when there is none."""
    return os.environ.get("MCTAU", str(build / "mctau"))


@pytest.fixture
def scene(source):
    return source / "scenes" / "reaction_wheel.toml"


def finish(process, seconds):
    """(stdout, stderr) of a process that must end by itself."""
    try:
        return process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        raise


# One script, so that subscriber and run share the namespace. Python, this file, seconds, then what publishes.
LISTENED = """
python=$1; listener=$2; seconds=$3; shift 3
"$python" "$listener" "$seconds" > "$TMP/heard" & pid=$!
until grep -q ready "$TMP/heard"; do kill -0 $pid || exit 9; sleep 0.05; done
"$@"; code=$?
wait $pid
sed 1d "$TMP/heard" >&2
exit $code
"""


def listened(tmp_path, seconds, *publisher):
    """(exit code, stdout of the publisher, what the subscriber heard)."""
    with in_network(LISTENED, *LISTENER, seconds, *publisher,
                    env={**os.environ, "TMP": str(tmp_path)}) as process:
        output, heard = finish(process, seconds + 30)
    return process.returncode, output, json.loads(heard.splitlines()[-1])


def test_ten_seconds_at_one_kilohertz_lose_nothing(command, scene, tmp_path):
    code, output, heard = listened(tmp_path, 30, command, "run", scene, "--duration", "10", "--realtime",
                                   "--lcm", URL, "--json")
    assert code in (0, 1)
    assert json.loads(output)["ticks"] == 10000
    assert heard["ticks"] == list(range(10000))
    assert heard["sequences"] == list(range(10000))
    assert heard["dropped"] == 0 and heard["finished"]
    assert heard["scenes"] >= 10 and heard["healths"] == 101


# The subscriber is stopped before the run begins, and goes on after it.
STOPPED = """
python=$1; listener=$2; shift 2
"$python" "$listener" 20 > "$TMP/heard" & pid=$!
until grep -q ready "$TMP/heard"; do kill -0 $pid || exit 9; sleep 0.05; done
kill -STOP $pid
"$@"; code=$?
kill -CONT $pid; kill $pid; wait $pid
exit $code
"""


@pytest.mark.parametrize("realtime", [False, True])
def test_a_stopped_subscriber_changes_no_tick(mctau, command, scene, tmp_path, realtime):
    options = ["--duration", "3", "--json"]
    alone = mctau("run", scene, *options)
    run = [command, "run", scene, *options, "--lcm", URL, *(["--realtime"] if realtime else [])]
    with in_network(STOPPED, *LISTENER, *run, env={**os.environ, "TMP": str(tmp_path)}) as process:
        output, errors = finish(process, 60)
    assert process.returncode == alone.returncode, errors
    result, expected = json.loads(output), json.loads(alone.stdout)
    assert result["ticks"] == expected["ticks"] == 3000
    assert result["state_hex"] == expected["state_hex"]
    assert result["faults"] == expected["faults"]


def test_without_a_route_the_run_goes_on_with_a_warning(command, scene, tmp_path):
    log = tmp_path / "run.lcm"
    run = [command, "run", scene, "--duration", "1", "--lcm", URL, "--log", log, "--json"]
    with in_network('exec "$@"', *run, setup='exec "$@"') as process:
        output, errors = finish(process, 30)
    assert process.returncode in (0, 1), errors
    assert json.loads(output)["ticks"] == 1000
    assert errors.count("no telemetry over the network") == 1 and "239.255.76.67" in errors
    assert log.stat().st_size > 200000


def test_logplayer_plays_a_log(mctau, scene, tmp_path):
    if shutil.which("lcm-logplayer") is None:
        pytest.skip("no lcm-logplayer (Debian: liblcm-bin)")
    log = tmp_path / "run.lcm"
    assert mctau("run", scene, "--duration", "2", "--log", log).returncode in (0, 1)
    code, _, heard = listened(tmp_path, 20, "lcm-logplayer", "--speed=1", f"--lcm-url={URL}", log)
    assert code == 0
    assert heard["ticks"] == list(range(2000)) and heard["finished"]


def test_a_subscriber_that_dies_is_no_loss(command, scene, tmp_path):
    """SIGKILL in the middle of a run in real time: the run ends as it would have."""
    script = """
    python=$1; listener=$2; shift 2
    "$python" "$listener" 20 > "$TMP/heard" & pid=$!
    until grep -q ready "$TMP/heard"; do kill -0 $pid || exit 9; sleep 0.05; done
    (sleep 0.5; kill -KILL $pid) &
    exec "$@"
    """
    run = [command, "run", scene, "--duration", "1", "--realtime", "--lcm", URL, "--json"]
    with in_network(script, *LISTENER, *run, env={**os.environ, "TMP": str(tmp_path)}) as process:
        output, errors = finish(process, 30)
    assert process.returncode in (0, 1), errors
    assert json.loads(output)["ticks"] == 1000
