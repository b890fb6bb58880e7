"""Controller and virtual drive as two processes over can0 and can1: two CAN controllers, one bus, 1 Mbit/s.

They pace each other (lockstep): every run is the same, and each tick's frames stand in one order.
"""

import json
import re
import struct

import pytest
from lab import bus, machine

cantools = pytest.importorskip("cantools")

OPTIONS = f"--set can.lockstep=true --set parameters.supply_voltage={bus.SUPPLY}"
# VESC and ODrive have half the ticks, to save time: 500 Hz.
EXTRA = {"native": "", "vesc": "--set scene.dt=0.002", "odrive": "--set scene.dt=0.002"}
TICKS = {"native": int(bus.SECONDS * 1000), "vesc": int(bus.SECONDS * 500), "odrive": int(bus.SECONDS * 500)}
COUNTS_PER_TURN = 4096  # of both encoders, as the scene has it
DUTY_STEP = 1e-5
VESC_STEPS = 18000  # a turn


def options(protocol):
    return f"{OPTIONS} --set can.protocol={protocol} {EXTRA[protocol]}"


def balancing(protocol):
    return bus.step(protocol, f"""
        record {protocol}_bus can0
        {bus.drive(f"{protocol}_drive", "can1", options(protocol))}
        {bus.run(protocol, "can0", f"{options(protocol)} --duration {bus.SECONDS} --log {protocol}.lcm")}
        code=0; finish {protocol} 60 || code=$?
        stop {protocol}_drive; stop {protocol}_bus
        exit $code""", limit=90, controllers=True)  # fmt: skip


# While nothing comes, a run in lockstep waits 50 ms a tick.
BATTERY = [
    *(balancing(protocol) for protocol in bus.PROTOCOLS),
    # A frame waits in the controller, the queue is filled up by somebody else. 7FE is sent just before the
    # controller goes on, from the other side.
    bus.step("full", f"""
        record full_bus can1
        {bus.drive("full_drive", "can1", OPTIONS)}
        {bus.run("full", "can0", f"{OPTIONS} --duration 0.8")}
        sleep 0.1
        hold can0
        cangen can0 -g 0 -n 30 -I 7FF -L 0 && exit 9
        sleep 0.6
        cansend can1 7FE#
        release can0
        code=0; finish full 60 || code=$?
        stop full_drive; stop full_bus
        exit $code""", limit=60, controllers=True),  # fmt: skip
    # Nobody else sends: what waits is the run's own.
    bus.step("held", f"""
        record held_bus can1
        {bus.drive("held_drive", "can1", OPTIONS)}
        {bus.run("held", "can0", f"{OPTIONS} --duration 0.8")}
        sleep 0.1
        hold can0
        sleep 0.6
        cansend can1 7FE#
        release can0
        code=0; finish held 60 || code=$?
        stop held_drive; stop held_bus
        exit $code""", limit=60, controllers=True),  # fmt: skip
    bus.step("unplugged", f"""
        {bus.drive("unplugged_drive", "can1", OPTIONS)}
        {bus.run("unplugged", "can0", f"{OPTIONS} --duration 1.5 --csv unplugged.csv")}
        sleep 0.1
        echo 1 >"$(readlink -f /sys/class/net/can0/device)/remove"
        await 5 test ! -e /sys/class/net/can0
        sleep 0.2
        echo 1 >/sys/bus/pci/rescan
        await 5 test -e /sys/class/net/can0
        ip link set can0 type can bitrate 1000000 restart-ms 100
        ip link set can0 txqueuelen 10 up
        sleep 0.1
        signal unplugged USR1
        code=0; finish unplugged 60 || code=$?
        stop unplugged_drive
        keep unplugged.csv
        exit $code""", limit=60, controllers=True),  # fmt: skip
]


@pytest.fixture(scope="module")
def result(command, source):
    return machine.run(BATTERY, files=bus.files(command, source), timeout=200)


@pytest.mark.parametrize("protocol", bus.PROTOCOLS)
def test_the_wheel_swings_up_and_balances_over_two_controllers(result, protocol):
    result.out(protocol)
    run = bus.run_of(result, protocol)
    assert "Balanced" in run.text and run.faults == []
    truth = bus.drive_of(result, f"{protocol}_drive")
    assert truth["released"] and truth["deviation"] < 0.01 and truth["upright_at"] is not None
    assert truth["counters"]["driven_ticks"] > 0.9 * TICKS[protocol]
    assert truth["bus"]["link_lost"] == truth["bus"]["queue_full"] == truth["bus"]["held_back"] == 0


# --- what was on the bus and what telemetry says of it ---


@pytest.fixture(scope="module")
def databases(source):
    folder = source / "hal" / "socketcan"
    return {name: cantools.database.load_file(folder / f"{name}.dbc") for name in bus.PROTOCOLS}


@pytest.fixture(scope="module")
def ticks(result, tmp_path_factory):
    """ticks(protocol): the messages of each tick in the run's event log."""
    lcm = pytest.importorskip("lcm")
    pytest.importorskip("mctau.tick_t", reason="the build made no telemetry types for Python")
    from mctau import tick_t

    folder = tmp_path_factory.mktemp("logs")

    def read(protocol):
        result.out(protocol)
        path = folder / f"{protocol}.lcm"
        path.write_bytes(result.files[f"{protocol}.lcm"])
        events = lcm.EventLog(str(path))
        return [tick_t.decode(event.data) for event in events if event.channel == "MCTAU_TICK"]

    return read


def node_of(protocol, number):
    """(node, the same identifier of node 1): the DBC files describe node 1, as they say."""
    if protocol == "vesc":
        return number & 0xFF, number & ~0xFF | 1
    if protocol == "odrive":
        return number >> 5, number & 0x1F | 1 << 5
    return 1, number


def decoded(result, database, protocol):
    """[(message's name, node, signals)] of the bus, in order."""
    seen = []
    for _, _, identifier, data in result.frames(f"{protocol}_bus"):
        node, base = node_of(protocol, int(identifier, 16))
        extended, data = len(identifier) == 8, bytes.fromhex(data)
        message = database.get_message_by_frame_id(base, force_extended_id=extended)
        assert len(data) == message.length
        seen.append((message.name, node, message.decode(data, decode_choices=False)))
    return seen


def aligned(seen, command, count, after):
    """[(index in seen, signals)] of the last `count` commands but those that ended the run."""
    commands = [(i, signals) for i, (name, _, signals) in enumerate(seen) if name == command]
    return commands[len(commands) - after - count : len(commands) - after]


def newest(seen, name, node):
    """For each index in seen: the signals of the newest such message before it."""
    last, all_of_them = None, []
    for what, which, signals in seen:
        all_of_them.append(last)
        if (what, which) == (name, node):
            last = signals
    return all_of_them


def test_native_frames_hold_what_telemetry_holds(result, databases, ticks):
    seen, log = decoded(result, databases["native"], "native"), ticks("native")
    commands = aligned(seen, "Drive_Cmd", len(log), after=1)
    wheel, arm = newest(seen, "Drive_Fb", 1), newest(seen, "Drive_Fb2", 1)
    assert len(log) == len(commands) == TICKS["native"]
    sequence = commands[0][1]["sequence"]
    for k, (tick, (i, command)) in enumerate(zip(log, commands)):
        assert (command["mode"], command["enable"]) == (1, 1) and command["sequence"] == (sequence + k) % 256
        # To the nearest millivolt.
        assert abs(command["voltage"] - tick.applied) <= 0.0005 + 1e-9, k
        assert list(tick.counts) == [arm[i]["counts"], wheel[i]["counts"]], k


def test_vesc_frames_hold_what_telemetry_holds(result, databases, ticks):
    seen, log = decoded(result, databases["vesc"], "vesc"), ticks("vesc")
    commands = aligned(seen, "SET_DUTY", len(log), after=0)
    supply = newest(seen, "STATUS_5", 1)
    # A position is that within the turn: the shorter way round from one message to the next.
    turned = {1: None, 2: None}
    for index, (name, node, signals) in enumerate(seen):
        if name == "STATUS_4":
            steps, before, half = round(signals["position"] / 0.02), turned[node], VESC_STEPS // 2
            turned[node] = steps
            if before is not None:
                turned[node] = before + (steps - before + half - 1) % VESC_STEPS - half + 1
            seen[index] = (name, node, {"steps": turned[node]})
    wheel, arm = newest(seen, "STATUS_4", 1), newest(seen, "STATUS_4", 2)
    assert len(commands) == len(log) == TICKS["vesc"]
    for k, (tick, (i, command)) in enumerate(zip(log, commands)):
        volts = supply[i]["voltage_in"]
        assert abs(command["duty"] * volts - tick.applied) <= 0.5 * DUTY_STEP * volts + 1e-9, k
        steps = [arm[i]["steps"], wheel[i]["steps"]]
        assert list(tick.counts) == [step * COUNTS_PER_TURN // VESC_STEPS for step in steps], k


def test_odrive_frames_hold_what_telemetry_holds(result, databases, ticks):
    seen, log = decoded(result, databases["odrive"], "odrive"), ticks("odrive")
    commands = aligned(seen, "Set_Input_Torque", len(log), after=1)
    wheel, arm = newest(seen, "Get_Encoder_Estimates", 1), newest(seen, "Get_Encoder_Estimates", 2)
    assert len(commands) == len(log) == TICKS["odrive"]
    for k, (tick, (i, command)) in enumerate(zip(log, commands)):
        assert command["Input_Torque"] == as_float(tick.applied), k
        for counts, place in zip(tick.counts, (arm, wheel)):
            turns = place[i]["Pos_Estimate"]
            # What a float of that size leaves open, and a count for rounding.
            spacing = abs(turns) * 2**-23
            assert abs(counts - turns * COUNTS_PER_TURN) <= 1 + 0.5 * spacing * COUNTS_PER_TURN, k


def as_float(value):
    return struct.unpack("f", struct.pack("f", value))[0]


def test_a_recorded_bus_leads_to_the_same_commands(result, mctau, source, tmp_path):
    result.out("native")
    path = tmp_path / "bus.log"
    path.write_bytes(result.files["native_bus.out"])
    done = mctau("run", source / "scenes" / "reaction_wheel.toml", "--hal", f"candump:{path}", "--duration",
                 bus.SECONDS, *options("native").replace("--set can.lockstep=true", "").split())  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    found = re.search(r"commands against the recorded ones: (\d+) found, (\d+) of them differ", done.stdout)
    assert found, done.stdout
    assert int(found[1]) >= TICKS["native"] and int(found[2]) == 0


# --- faults ---


def commands_around(result, name, mark):
    """[(sequence, volts)] of the commands on the bus before the mark, and after it."""
    before, after = [], []
    there = before
    for _, _, identifier, data in result.frames(name):
        if identifier == mark:
            there = after
        elif identifier == "101":
            millivolts, sequence = struct.unpack("<iB", bytes.fromhex(data)[:5])
            there.append((sequence, millivolts / 1000))
    return before, after


def no_burst(result, name):
    """One command may have waited in the queue; the next one is of that moment, and all are of zero volts."""
    before, after = commands_around(result, f"{name}_bus", "7FE")
    assert any(volts != 0 for _, volts in before) and len(after) > 100
    gaps = [i for i in range(1, len(after)) if (after[i][0] - after[i - 1][0]) % 256 != 1]
    assert len(gaps) <= 1 and all(i == 1 for i in gaps), after[:20]
    assert all(volts == 0 for _, volts in after)


def test_a_full_queue_leads_to_no_burst_of_old_commands(result):
    """While nothing goes out every command is given up and counted."""
    assert result["full"].code == 1, result["full"].err
    run = bus.run_of(result, "full")
    assert run.counters["queue_full"] + run.counters.get("held_back", 0) > 10
    assert run.counters["queue_full"] > 0 and "sensor_stale" in run.faults
    no_burst(result, "full")


def test_commands_that_were_held_back_never_reach_the_bus(result):
    assert result["held"].code == 1, result["held"].err
    run = bus.run_of(result, "held")
    assert run.counters["held_back"] > 5 and "link_down" in run.faults
    no_burst(result, "held")


def test_an_adapter_that_was_unplugged_is_taken_up_again(result):
    assert result["unplugged"].code == 1, result["unplugged"].err  # it has had no time to balance
    run = bus.run_of(result, "unplugged")
    assert "link_down" in run.faults
    assert (run.counters["link_lost"], run.counters["link_back"], run.counters["armings"]) == (1, 1, 1)
    rows = bus.table(result, "unplugged.csv")
    assert all(float(row["applied"]) == 0 for row in rows if row["faults"])
    assert bus.changes(rows, "faults")[0] == bus.changes(rows, "faults")[-1] == ""
    driven = [i for i, row in enumerate(rows) if float(row["applied"]) != 0]
    faulty = [i for i, row in enumerate(rows) if "link_down" in row["faults"]]
    assert driven[0] < faulty[0] and faulty[-1] < driven[-1]
    truth = bus.drive_of(result, "unplugged_drive")
    assert truth["counters"]["watchdog_trips"] == 2  # the start's trial, and while nothing came
    assert truth["last_driven"] > truth["time"] - 0.5
