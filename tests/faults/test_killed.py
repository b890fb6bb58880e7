"""A run that is killed leaves a log that is whole up to its last complete event, and that replays to the same bits.

With MCTAU_FAULTS=all in the environment 200 runs are killed and every cut is tried, else a sample.
"""

import json
import os
import random
import struct

import pytest

ALL = os.environ.get("MCTAU_FAULTS") == "all"
KILLS = 200 if ALL else 20
CUTS = None if ALL else 20
KILLED = 128 + 9
HEADER = 28  # bytes of an event before its channel
BATCH = 100  # ticks that are written at once, 0.1 s
OPTIONS = ["--duration", "2", "--log", "run.lcm", "--lcm", "udpm://239.255.76.67:7667?ttl=0"]  # a call a tick


def events(data):
    """The end and channel of each whole event."""
    at, found = 0, []
    while at + HEADER <= len(data):
        sync, _, _, channel, length = struct.unpack_from(">Iqqii", data, at)
        assert sync == 0xEDA1DA01
        end = at + HEADER + channel + length
        if end > len(data):
            break
        found.append((end, data[at + HEADER:at + HEADER + channel].decode()))
        at = end
    return found


def count(found, channel):
    return sum(name == channel for _, name in found)


def check_cut(mctau, path, data):
    """A log that was cut: all of its whole ticks replay, and the command says that it was cut."""
    found = events(data)
    path.write_bytes(data)
    done = mctau("replay", path, "--json")
    assert done.returncode == 3 and str(path) in done.stderr, done
    if count(found, "MCTAU_SCENE") == 1:
        result = json.loads(done.stdout)
        assert result["equal"] and result["truncated"], done
        assert result["ticks"] == count(found, "MCTAU_TICK"), done
    return found


@pytest.fixture
def plain(mctau, run):
    """The log of a run that nobody kills, and the number of calls that it makes."""
    done, calls, files = run("reaction_wheel", OPTIONS)
    if "run.lcm" not in files:
        pytest.skip("this build has no LCM, so there is no event log")
    return files["run.lcm"], len(calls)


def test_a_run_killed_at_any_moment_leaves_what_it_had_written(mctau, run, plain, tmp_path):
    whole, calls = plain
    pick = random.Random(9)
    lost = []
    for _ in range(KILLS):
        done, made, files = run("reaction_wheel", OPTIONS, pick.randint(1, calls), 0, "kill")
        data = files.get("run.lcm", b"")
        assert done.returncode == KILLED, done
        assert whole.startswith(data)
        found = check_cut(mctau, tmp_path / "cut.lcm", data) if data else []
        assert not found or found[-1][0] == len(data)  # what is written ends with an event
        sent = sum(name == "sendmsg" for name, _, _ in made)
        lost.append(sent - len(found))
    assert max(lost) <= BATCH + 5, lost  # with what else was sent in that time: health, scene
    print(f"{KILLS} runs killed; at most {max(lost)} messages that were sent were not in the log")


def test_a_run_killed_within_a_write_leaves_whole_events_and_the_beginning_of_one(mctau, run, plain, tmp_path):
    whole, calls = plain
    torn = 0
    for n in random.Random(10).sample(range(1, calls + 1), KILLS):
        done, _, files = run("reaction_wheel", OPTIONS, n, 0, "torn")
        data = files["run.lcm"]
        assert done.returncode == KILLED and whole.startswith(data)
        if data != whole:  # else what was torn is the result on stdout
            found = check_cut(mctau, tmp_path / "cut.lcm", data)
            torn += not found or found[-1][0] != len(data)
    assert torn > KILLS / 2


def test_a_log_cut_at_any_byte_is_read_to_its_last_whole_event(mctau, plain, tmp_path):
    whole = plain[0]
    last = events(whole)[-4][0]
    places = range(last, len(whole))
    for cut in random.Random(11).sample(places, CUTS or len(places)):
        check_cut(mctau, tmp_path / "cut.lcm", whole[:cut])
    for cut in random.Random(12).sample(range(1, events(whole)[0][0]), CUTS or 200):  # within the scene
        check_cut(mctau, tmp_path / "cut.lcm", whole[:cut])
