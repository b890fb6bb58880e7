"""What is wrong at the start of a run over a bus is said in a sentence that helps, and nothing is driven."""

import ctypes
import dataclasses
import platform
import socket
import struct

import pytest
from lab import bus, machine

SHORT = "--set can.startup=0.3"
FAULTY = "--fault error --fault-time 0 --fault-duration 100"
ODRIVE = "--set can.protocol=odrive"


@dataclasses.dataclass(frozen=True)
class Case:
    """interface, options: of the run; words: of its sentence; drives: the options of each drive on vcan0;
    error: an error frame that comes again and again."""

    interface: str
    words: list
    options: str = SHORT
    drives: tuple = ()
    before: str = ""
    after: str = ""
    error: str = ""


CASES = {
    "no_such_interface": Case("can7", ['"can7"', "can0, can1, vcan0"]),
    "virtual_down": Case(
        "vcan1",
        ['"vcan1" is down', "'sudo ip link set vcan1 up'"],
        before="ip link add vcan1 type vcan",
        after="ip link del vcan1",
    ),
    "controller_down": Case(
        "can0",
        ['"can0" is down', "'sudo ip link set can0 up type can bitrate 1000000 restart-ms 100'"],
        before="ip link set can0 down",
        after="ip link set can0 up",
    ),
    "no_can": Case("lo", ['"lo" is not a CAN interface', "vcan0"]),
    "name_too_long": Case("canthatistoolong0", ["name", "allowed 1 to 15 bytes"]),
    "nobody": Case(
        "vcan0",
        ["Drive_Fb has not come within 0.3 s", "nor has any other", "supply", "node number", "bit rate"],
    ),
    "no_acknowledge": Case(
        "can0",
        ["nor has any other", "nobody on the bus acknowledges", "supply", "wiring", "bit rate"],
        before="hold can0",
        after="release can0",
    ),
    "bit_errors": Case(
        "vcan0",
        ["the bus carries errors", "bit rate", "wiring or termination"],
        error="20000088#0000080000000000",
    ),
    "error_passive": Case(
        "vcan0", ["the bus carries errors", "bit rate"], error="20000004#0010000000000000"
    ),
    "bus_off": Case(
        "vcan0",
        ["has left the bus", "wiring, termination and bit rate", "restart"],
        error="20000040#0000000000000000",
    ),
    "other_node": Case(
        "vcan0", ["node 1: Drive_Fb has not come", "node number"], drives=("--set can.node=2",)
    ),
    "other_arm_node": Case(
        "vcan0",
        ["node 2: Get_Encoder_Estimates has not come", "other messages have", "switch this one on"],
        f"{SHORT} {ODRIVE}",
        (f"{ODRIVE} --set can.arm_node=5",),
    ),
    "other_protocol": Case("vcan0", ["Drive_Fb has not come", "nor has any other"], drives=(ODRIVE,)),
    "slow": Case(
        "vcan0",
        ["Drive_Fb comes every 10", "allowed up to 3 ms", "rate"],
        "",
        ("--set scene.dt=0.01",),
    ),
    "two_natives": Case(
        "vcan0", ["node 1: found two drives with this number", "its own"], "", ("", "")
    ),
    "two_odrives": Case("vcan0", ["node 1", "another drive"], ODRIVE, (ODRIVE, ODRIVE)),
    "native_error": Case(
        "vcan0",
        ["node 1: the drive does not get ready", "it reports error 255", "look at"],
        "",
        (FAULTY,),
    ),
    "odrive_error": Case(
        "vcan0",
        ["node 1: the drive does not get ready", "it reports error 32", "look at"],
        ODRIVE,
        (f"{ODRIVE} {FAULTY}",),
    ),
    "no_watchdog": Case(
        "vcan0",
        ["node 1: its watchdog did not act", "set the drive's own watchdog to 0.1 s", "can.watchdog"],
        ODRIVE,
        (f"{ODRIVE} --set can.watchdog=0",),
    ),
}


def refused(name):
    case = CASES[name]
    drives = [f"{name}_{i}" for i in range(len(case.drives))]
    before, after = case.before, case.after
    if case.error:
        before = f"start {name}_bus sh -c 'while :; do cansend vcan0 {case.error}; sleep 0.05; done'"
        after = f"stop {name}_bus"
    return bus.step(
        name,
        f"""
        {before}
        {"".join(bus.drive(drive, "vcan0", given) for drive, given in zip(drives, case.drives))}
        code=0
        mctau run {bus.SCENE} --hal socketcan:{case.interface} --duration 0.1 {case.options} || code=$?
        {"; ".join(f"stop {drive}" for drive in drives)}
        {after}
        exit $code""",
        controllers=case.interface.startswith("can"),
        clock=True,
    )


BATTERY = [
    *(refused(name) for name in CASES),
    bus.step("drive_no_such", f"mctau drive {bus.SCENE} --can can7", controllers=True),
]


@pytest.fixture(scope="module")
def result(command, source):
    return machine.run(BATTERY, files=bus.files(command, source), timeout=200)


@pytest.mark.parametrize("name", list(CASES))
def test_the_start_says_what_is_wrong_and_drives_nothing(result, name):
    done, case = result[name], CASES[name]
    assert (done.code, done.out) == (3, ""), done.err
    assert done.err.startswith("mctau: scene.hal: ") and len(done.err.splitlines()) == 1
    for word in case.words:
        assert word in done.err
    for i in range(len(case.drives)):
        truth = bus.drive_of(result, f"{name}_{i}")
        assert truth["counters"]["driven_ticks"] == 0 and truth["highest_volts"] == 0


def test_a_virtual_drive_without_its_interface_names_those_that_exist(result):
    done = result["drive_no_such"]
    assert (done.code, done.out) == (3, "")
    assert done.err == 'mctau: --can: there is no interface "can7"; CAN interfaces here: can0, can1, vcan0\n'


def forbid_can():
    """From here on the kernel refuses this process, and what it starts, sockets of CAN: as a sandbox does."""
    load, equal, give, errno = 0x20, 0x15, 0x06, 0x00050000
    number = {"x86_64": 41, "aarch64": 198}[platform.machine()]
    program = b"".join(struct.pack("HBBI", *line) for line in [
        (load, 0, 0, 0), (equal, 0, 3, number),
        (load, 0, 0, 16), (equal, 0, 1, socket.AF_CAN),
        (give, 0, 0, errno | 1), (give, 0, 0, 0x7FFF0000)])  # fmt: skip
    code = ctypes.create_string_buffer(program, len(program))
    libc = ctypes.CDLL(None, use_errno=True)
    filters = struct.pack("HxxxxxxP", len(program) // 8, ctypes.addressof(code))
    if libc.prctl(38, 1, 0, 0, 0) != 0 or libc.prctl(22, 2, filters, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "no seccomp")


@pytest.mark.parametrize("verb", [["run", "--hal", "socketcan:can0"], ["drive", "--can", "can0"]])
def test_who_may_not_open_a_can_socket_is_told_so(mctau, source, verb):
    if platform.machine() not in ("x86_64", "aarch64"):
        pytest.skip(f"no system call numbers for {platform.machine()}")
    try:
        done = mctau(verb[0], source / "scenes" / "reaction_wheel.toml", *verb[1:], preexec_fn=forbid_can)
    except Exception as reason:  # subprocess tells no more than that it failed
        pytest.skip(f"this kernel has no seccomp: {reason}")
    assert (done.returncode, done.stdout) == (3, "")
    assert "not allowed to open a CAN socket" in done.stderr and "sandbox" in done.stderr
    assert len(done.stderr.splitlines()) == 1
