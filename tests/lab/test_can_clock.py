"""Controller and virtual drive as two processes over vcan0, each by its own clock at 1 kHz; and faults."""

import pytest
from lab import bus, machine

SUPPLY = f"--set parameters.supply_voltage={bus.SUPPLY}"
WATCHDOG = 0.1  # [s] the default of can.watchdog
NEAR = f"{SUPPLY} --set initial.arm_angle=0.05"  # upright at once
ESTOP = {"native": "011#02", "odrive": "022#"}


def options(protocol):
    return f"{SUPPLY} --set can.protocol={protocol}"


def balancing(protocol):
    return bus.step(f"balances_{protocol}", f"""
        {bus.drive(f"{protocol}_drive", "vcan0", options(protocol))}
        {bus.run(protocol, "vcan0", f"{options(protocol)} --duration {bus.SECONDS}")}
        code=0; finish {protocol} 20 || code=$?
        stop {protocol}_drive
        exit $code""", limit=60, clock=True)  # fmt: skip


def host_killed(protocol):
    name = f"killed_{protocol}"
    return bus.step(name, f"""
        record {name}_bus vcan0
        {bus.drive(f"{name}_drive", "vcan0", f"{options(protocol)} --csv {name}.csv")}
        {bus.run(name, "vcan0", options(protocol))}
        sleep 0.2
        signal {name} KILL
        sleep 0.3
        stop {name}_drive
        stop {name}_bus
        keep {name}.csv""", clock=True)  # fmt: skip


BATTERY = [
    *(balancing(protocol) for protocol in bus.PROTOCOLS),
    *(host_killed(protocol) for protocol in bus.PROTOCOLS),
    bus.step("drive_killed", f"""
        record drive_killed_bus vcan0
        {bus.drive("drive_killed_drive", "vcan0", options("native"))}
        {bus.run("drive_killed", "vcan0", f"{options('native')} --duration 0.4 --csv drive_killed.csv")}
        sleep 0.2
        signal drive_killed_drive KILL
        code=0; finish drive_killed 20 || code=$?
        stop drive_killed_bus
        keep drive_killed.csv
        exit $code""", clock=True),  # fmt: skip
    # Three faults and three signals, in one process; then it swings up.
    bus.step("rearmed", f"""
        record rearmed_bus vcan0
        {bus.drive("rearmed_drive", "vcan0", NEAR)}
        {bus.run("rearmed", "vcan0", f"{NEAR} --duration 4.5 --csv rearmed.csv")}
        sleep 0.2
        cansend vcan0 {ESTOP["native"]}
        sleep 0.1
        signal rearmed USR1
        sleep 0.2
        cansend vcan0 20000040#0000000000000000 # an error frame: bus-off
        sleep 0.1
        cansend vcan0 20000100#0000000000000000 # and one that says: restarted
        signal rearmed USR1
        sleep 0.2
        stop rearmed_bus
        ip link set vcan0 down
        sleep 0.15
        ip link set vcan0 up
        sleep 0.15
        signal rearmed USR1
        code=0; finish rearmed 20 || code=$?
        stop rearmed_drive
        keep rearmed.csv
        exit $code""", limit=60, clock=True),  # fmt: skip
    bus.step("stopped_odrive", f"""
        {bus.drive("stopped_odrive_drive", "vcan0", options("odrive"))}
        {bus.run("stopped_odrive", "vcan0", f"{options('odrive')} --duration 0.8 --csv stopped_odrive.csv")}
        sleep 0.2
        cansend vcan0 {ESTOP["odrive"]}
        sleep 0.1
        signal stopped_odrive USR1
        code=0; finish stopped_odrive 20 || code=$?
        stop stopped_odrive_drive
        keep stopped_odrive.csv
        exit $code""", clock=True),  # fmt: skip
]


@pytest.fixture(scope="module")
def result(command, source):
    return machine.run(BATTERY, files=bus.files(command, source), timeout=200)


@pytest.mark.parametrize("protocol", bus.PROTOCOLS)
def test_the_wheel_swings_up_and_balances_by_the_clock(result, protocol):
    result.out(f"balances_{protocol}")
    run = bus.run_of(result, protocol)
    assert "Balanced" in run.text and run.faults == []
    truth = bus.drive_of(result, f"{protocol}_drive")
    assert truth["released"] and truth["deviation"] < 0.01 and truth["upright_at"] is not None
    assert truth["counters"]["driven_ticks"] > 900 * bus.SECONDS
    if f"balances_{protocol}" in result.emulated:  # whose clock waits for a program
        assert "0 ticks missed" in run.text


def of_protocol(protocol, identifier):
    """Whether a frame is from the host, and whether it is the motor's drive's feedback of each tick."""
    number = int(identifier, 16)
    if protocol == "native":
        return number in (0x101, 0x011), number == 0x181
    if protocol == "vesc":
        return number >> 8 in (0, 1, 2), number == 0x1001
    return number & 0x1F in (0x02, 0x07, 0x0B, 0x0E, 0x18), number == 0x029


@pytest.mark.parametrize("protocol", bus.PROTOCOLS)
def test_a_drive_whose_host_was_killed_stops_within_its_watchdog(result, protocol):
    """Each tick of the drive is a row of its CSV file and one feedback: counted from the end, they match."""
    name = f"killed_{protocol}"
    result.out(name)
    assert result.text(f"{name}.code") == "137\n"
    kinds = [of_protocol(protocol, identifier) for _, _, identifier, _ in result.frames(f"{name}_bus")]
    last = max(i for i, (from_host, _) in enumerate(kinds) if from_host)
    silent = sum(feedback for _, feedback in kinds[last:])
    # A native drive puts zero volts on the motor; of the others it runs free, with next to no current.
    column, least = ("volts", 0) if protocol == "native" else ("current", 0.001)
    driven = [abs(float(row[column])) > least for row in bus.table(result, f"{name}.csv")]
    watchdog = round(WATCHDOG * 1000)
    assert silent > 2 * watchdog
    assert any(driven[-silent:]), "it stopped before its watchdog could act"
    # It counts from the tick that takes the command: one tick for that, one for the row it shows in; and the
    # current of a motor that is released takes some more to vanish.
    more = 2 if protocol == "native" else 5
    assert not any(driven[-silent + watchdog + more :])
    truth = bus.drive_of(result, f"{name}_drive")
    trial = 0 if protocol == "vesc" else 1
    assert truth["counters"]["watchdog_trips"] == 1 + trial
    assert truth["powered"] == (protocol == "native")


def test_a_run_whose_drive_was_killed_commands_zero_volts_and_names_the_fault(result):
    assert result["drive_killed"].code == 1, result["drive_killed"].err
    run = bus.run_of(result, "drive_killed")
    assert run.faults == ["sensor_stale"]
    rows = bus.table(result, "drive_killed.csv")
    assert bus.changes(rows, "faults") == ["", "sensor_stale"]
    assert any(float(row["applied"]) for row in rows)
    assert not any(float(row["applied"]) for row in rows if row["faults"])
    frames = result.frames("drive_killed_bus")
    last = max(i for i, (_, _, identifier, _) in enumerate(frames) if identifier == "181")
    silent = [data for _, _, identifier, data in frames[last + 1 :] if identifier == "101"]
    assert len(silent) > 100
    # Feedback is believed for less than 5 ms; the ticks around it are its own and the one under way.
    assert all(data[:8] == "00000000" for data in silent[7:])


def test_every_fault_is_zero_volts_until_it_is_cleared_and_then_it_balances(result):
    run = bus.run_of(result, "rearmed")
    rows = bus.table(result, "rearmed.csv")
    seen = "|".join(bus.changes(rows, "faults"))
    named = [part.split("|") for part in seen.strip("|").split("||")]
    assert seen.startswith("|") and seen.endswith("|") and len(named) == 3, seen
    assert "estop" in named[0][0] and "link_down" in named[1][0] and "link_down" in named[2][0], seen
    assert not any(float(row["applied"]) for row in rows if row["faults"])
    assert "armed again after faults: 3 times" in run.text
    assert (run.counters["emergency_stops"], run.counters["bus_off"]) == (1, 1)
    assert (run.counters["link_lost"], run.counters["link_back"]) == (2, 2)
    assert result["rearmed"].code == 0 and "Balanced" in run.text
    truth = bus.drive_of(result, "rearmed_drive")
    assert truth["deviation"] < 0.01 and truth["upright_at"] is not None
    assert truth["counters"]["stops"] >= 1


def test_an_odrive_is_stopped_and_armed_again(result):
    run = bus.run_of(result, "stopped_odrive")
    rows = bus.table(result, "stopped_odrive.csv")
    assert "estop" in run.faults
    assert bus.changes(rows, "faults")[0] == bus.changes(rows, "faults")[-1] == ""
    assert not any(float(row["applied"]) for row in rows if row["faults"])
    assert float(rows[-1]["applied"]) != 0
    truth = bus.drive_of(result, "stopped_odrive_drive")
    assert truth["last_driven"] > truth["time"] - 0.2
