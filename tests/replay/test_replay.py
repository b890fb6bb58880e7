"""`mctau replay`: equality proved, the first difference named, cut and foreign logs told apart."""

import json
import struct

import pytest

SCENES = ["reaction_wheel", "cart_pole", "reaction_wheel_free", "cart_pole_free"]
HEADER = 28  # bytes of an event before its channel


def record(mctau, log, scene, *options):
    run = mctau("run", scene, "--duration", "2", "--log", log, "--json", *options)
    assert run.returncode in (0, 1), run.stderr  # 1: not upright yet
    return json.loads(run.stdout)


def replayed(mctau, log):
    """(exit code, JSON or None, messages)."""
    done = mctau("replay", log, "--json")
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("scene", SCENES)
def test_a_run_replays_to_the_same_bits(mctau, source, tmp_path, scene, precision):
    log = tmp_path / "run.lcm"
    run = record(mctau, log, source / "scenes" / f"{scene}.toml", "--precision", precision)
    code, result, _ = replayed(mctau, log)
    assert code == 0
    assert result["equal"] and not result["truncated"]
    assert result["ticks"] == run["ticks"] == 2000


def test_overrides_and_a_csv_input_are_in_the_log(mctau, tmp_path):
    scene = tmp_path / "scene.toml"
    (tmp_path / "input.csv").write_text("volts\n" + "\n".join(str(5 - i % 11) for i in range(1500)) + "\n")
    scene.write_text('[scene]\nsystem = "cart_pole"\n'
                     '[input]\nkind = "csv"\nfile = "input.csv"\ncolumn = "volts"\n')
    log = tmp_path / "run.lcm"
    record(mctau, log, scene, "--set", "initial.pole_angle=3.0", "--set", "parameters.pole_mass=0.2",
           "--dt", "0.002")
    scene.unlink()
    (tmp_path / "input.csv").unlink()
    code, result, _ = replayed(mctau, log)
    assert code == 0 and result["ticks"] == 1000


def test_a_run_in_real_time_replays(mctau, source, tmp_path):
    log = tmp_path / "run.lcm"
    mctau("run", source / "scenes" / "cart_pole.toml", "--duration", "0.5", "--realtime", "--log", log)
    code, result, _ = replayed(mctau, log)
    assert code == 0 and result["ticks"] == 500


@pytest.fixture
def log(mctau, source, tmp_path):
    path = tmp_path / "run.lcm"
    record(mctau, path, source / "scenes" / "reaction_wheel.toml")
    return path


def events(data):
    """(offset, offset of the data, end, channel) of each event."""
    at = 0
    while at < len(data):
        sync, _, _, channel, length = struct.unpack_from(">Iqqii", data, at)
        assert sync == 0xEDA1DA01
        start = at + HEADER + channel
        yield at, start, start + length, data[at + HEADER:start].decode()
        at = start + length


def test_a_flipped_bit_is_named_by_tick_and_field(mctau, log):
    tick_t = pytest.importorskip("mctau.tick_t").tick_t
    data = bytearray(log.read_bytes())
    number = 1234
    start, end = [(start, end) for _, start, end, channel in events(data) if channel == "MCTAU_TICK"][number]
    message = tick_t.decode(bytes(data[start:end]))
    assert message.tick == number
    changed = list(message.x)
    bits = struct.unpack(">Q", struct.pack(">d", changed[3]))[0] ^ 1
    changed[3] = struct.unpack(">d", struct.pack(">Q", bits))[0]
    message.x = changed
    data[start:end] = message.encode()
    log.write_bytes(data)
    code, result, _ = replayed(mctau, log)
    assert code == 1
    assert (result["equal"], result["first_tick"], result["field"]) == (False, number, "state.wheel_rate")
    text = mctau("replay", log).stdout
    assert str(number) in text and "state.wheel_rate" in text


def test_a_cut_log_is_replayed_as_far_as_it_goes(mctau, log):
    data = log.read_bytes()
    ends = [end for _, _, end, channel in events(data) if channel == "MCTAU_TICK"]
    for cut in (ends[-1], ends[-1] - 1, ends[-2] + 5, ends[1000]):
        log.write_bytes(data[:cut])
        code, result, message = replayed(mctau, log)
        assert code == 3 and message
        assert result["equal"] and result["truncated"]
        assert result["ticks"] == sum(end <= cut for end in ends)


def test_what_is_no_log_of_ours_is_refused(mctau, log, source, tmp_path):
    foreign = tmp_path / "foreign.lcm"
    foreign.write_bytes(struct.pack(">Iqqii", 0xEDA1DA01, 0, 0, 9, 4) + b"SOMETHING" + b"1234")
    cut = tmp_path / "cut.lcm"
    cut.write_bytes(log.read_bytes()[:100])
    empty = tmp_path / "empty.lcm"
    empty.write_bytes(b"")
    for path in (foreign, cut, empty, tmp_path / "none.lcm", tmp_path, source / "CONTRIBUTING.md"):
        done = mctau("replay", path)
        assert done.returncode in (2, 3), path
        assert str(path) in done.stderr and done.stderr.count("\n") == 1
        assert done.stdout == ""
