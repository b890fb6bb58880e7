"""The codecs of hal/socketcan against cantools: what one packs the other unpacks, by the files users load.

Values are random, with the edges of every field, numbers beyond them, infinities and NaN among them.
"""

import json
import math
import os
import pathlib
import random
import shlex
import shutil
import struct
import subprocess

import pytest

cantools = pytest.importorskip("cantools", reason="no cantools in build/venv; run tools/setup")
can = pytest.importorskip("can", reason="no python-can in build/venv; run tools/setup")

SEED = 20240607
COUNT = 10_000  # of each message
PROTOCOLS = {"native": 0, "vesc": 1, "odrive": 2}
VOLTAGE, FOC, TORQUE = range(3)
FIRMWARE_0_6, FIRMWARE_0_5 = range(2)
FEEDBACK, STATE, STOP, COMMAND, REQUEST = range(5)
REPEATED, OLDER, BAD_LENGTH, BAD_FORMAT, REMOTE, NOT_FINITE, BAD_CHECKSUM = range(6, 13)
UNKNOWN, IDLE, READY, FAULTY = range(4)
RELEASE, VOLTS, DUTY, CURRENT, WISH_TORQUE = range(5)
NODE = 1  # of the identifiers in the DBC files
HAL = pathlib.Path("hal") / "socketcan"
SOURCES = ["protocol.c", "native.c", "vesc.c", "odrive.c"]


@pytest.fixture(scope="module", params=["double", "float"])
def dump(request, source, build, tmp_path_factory):
    """dump(lines) gives the answers of can_codec_dump.c, compiled with the codecs alone, by precision."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    if shutil.which(compiler[0]) is None:
        pytest.skip("no C compiler")
    place = tmp_path_factory.mktemp("can")
    (place / "mctau").mkdir()
    is_float = int(request.param == "float")
    (place / "mctau" / "config.h").write_text(f"#define MCT_REAL_IS_FLOAT {is_float}\n")
    folder = source / HAL
    sources = [pathlib.Path(__file__).parent / "can_codec_dump.c", *(folder / name for name in SOURCES),
               *sorted((folder / "generated").glob("*.c"))]
    includes = [f"-I{path}" for path in (source / "include", source, place)]
    sanitize = os.environ.get("MCTAU_SANITIZE", "")
    flags = ["-std=gnu99", "-O1", "-ffp-contract=off"]
    flags += [f"-fsanitize={sanitize}"] if sanitize and sanitize != "coverage" else []
    program = place / "can_codec_dump"
    subprocess.run([*compiler, *flags, *includes, *sources, "-o", program], check=True)

    def run(lines):
        feed = "".join(line + "\n" for line in lines)
        result = subprocess.run([program], input=feed, capture_output=True, text=True, check=True)
        answers = [json.loads(line.replace("inf", "Infinity")) for line in result.stdout.splitlines()]
        assert len(answers) == len(lines)
        return answers

    run.is_float = bool(is_float)
    return run


@pytest.fixture(scope="module")
def databases(source):
    """The DBC files by their names, loaded strictly."""
    files = {path.stem: path for path in (source / HAL).glob("*.dbc")}
    assert files.keys() == {"native", "vesc", "odrive", "odrive_0_5"}
    return {name: cantools.database.load_file(str(path), strict=True) for name, path in files.items()}


def number(value):
    return value.hex() if math.isfinite(value) else str(value)


def settings(protocol, mode=VOLTAGE, firmware=FIRMWARE_0_6, inverted=0):
    return f"{PROTOCOLS[protocol]} {mode} {firmware} {NODE} {inverted}"


def file_of(protocol, firmware=FIRMWARE_0_6):
    """Name of the DBC file that a drive's messages are in."""
    return "odrive_0_5" if protocol == "odrive" and firmware == FIRMWARE_0_5 else protocol


def frame_words(message, data):
    return f"{message.frame_id} {int(message.is_extended_frame)} 0 {len(data)} {data.hex() or '-'}"


def narrow(value, is_float):
    """A number as the codecs' scalar holds it."""
    return struct.unpack("f", struct.pack("f", value))[0] if is_float and math.isfinite(value) else value


def as_float(value):
    """The nearest float; beyond them the largest."""
    largest = struct.unpack("<f", b"\xff\xff\x7f\x7f")[0]
    return narrow(min(max(value, -largest), largest), True)


def nearest(value, low, high):
    """The nearest integer, halves away from zero, clamped; NaN is 0."""
    if math.isnan(value):
        return 0
    if math.isinf(value):
        return high if value > 0 else low
    return max(low, min(high, int(math.copysign(math.floor(abs(value) + 0.5), value))))


def volts(pick):
    """Mostly plausible, some at a field's edge, some beyond sense."""
    kind = pick.randrange(10)
    if kind < 5:
        return pick.uniform(-30, 30)
    if kind < 7:
        return pick.randint(-40_000, 40_000) / 1000
    return pick.choice([0.0, math.nan, math.inf, -math.inf, 2147483.647, -2147483.648, 1e-30, -1e-30,
                        pick.uniform(-1e7, 1e7), 10 ** pick.uniform(-30, 30), -10 ** pick.uniform(-30, 30)])


def decode(database, answer):
    """A frame of the codec through python-can to cantools: (message, values)."""
    message = can.Message(arbitration_id=answer["id"], is_extended_id=bool(answer["extended"]),
                          is_remote_frame=bool(answer["remote"]), data=bytes.fromhex(answer["data"]),
                          check=True)
    found = database.get_message_by_frame_id(message.arbitration_id, message.is_extended_id)
    assert found.is_extended_frame == message.is_extended_id
    return found, found.decode(bytes(message.data), decode_choices=False)


def random_payload(pick, message):
    """Any bits at all, and edges of the fields."""
    return bytes(pick.choice([pick.randrange(256), 0, 255, 128, 127]) for _ in range(message.length))


# --- the files ---


def test_generated_code_is_what_the_dbc_files_say(source):
    result = subprocess.run([source / HAL / "regenerate", "--check"], capture_output=True, text=True)
    if result.returncode == 2:
        pytest.skip(result.stderr.strip())
    assert result.returncode == 0, result.stdout + result.stderr


def test_regenerate_notices_a_change(source, tmp_path):
    place = tmp_path / "hal" / "socketcan"
    shutil.copytree(source / HAL, place)
    if not (source / "build" / "venv").exists():
        pytest.skip("no build/venv")
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "venv").symlink_to(source / "build" / "venv")
    text = (place / "native.dbc").read_text()
    (place / "native.dbc").write_text(text.replace("counts : 0|32@1-", "counts : 0|32@1+"))
    result = subprocess.run([place / "regenerate", "--check"], capture_output=True, text=True)
    assert result.returncode == 1 and "int32_t counts" in result.stdout
    subprocess.run([place / "regenerate"], check=True)
    assert subprocess.run([place / "regenerate", "--check"], capture_output=True).returncode == 0


def test_every_message_is_explained(databases):
    for name, database in databases.items():
        assert not [message.name for message in database.messages if not message.comment], name


def test_tables_of_the_codecs_are_those_of_the_dbc_files(dump, databases):
    seen = {name: set() for name in databases}
    for row in dump(["messages"])[0]:
        message = databases[row["file"]].get_message_by_name(row["name"])
        where = (row["file"], row["name"])
        assert message.frame_id == row["id"], where
        assert message.is_extended_frame == bool(row["extended"]), where
        assert message.length == row["length"], where
        # each tick: 1 ms in the file
        cycle = 1 if row["period"] == 0 else round(row["period"] * 1000) if row["period"] > 0 else 0
        assert (message.cycle_time or 0) == cycle, where
        drive = {"native": "Drive", "vesc": "Vesc"}.get(row["file"], "ODrive")
        if "Estop" not in row["name"]:  # which anybody may send
            assert message.senders == [drive if row["from_drive"] else "Host"], where
        seen[row["file"]].add(row["name"])
    # What a file has beyond the table serves who reads a recorded log.
    assert seen["native"] == {message.name for message in databases["native"].messages}
    assert seen["vesc"] == {message.name for message in databases["vesc"].messages}
    assert {message.name for message in databases["odrive"].messages} - seen["odrive"] == {
        "Get_Error", "Get_Iq", "Set_Limits"}
    assert {message.name for message in databases["odrive_0_5"].messages} - seen["odrive_0_5"] == {
        "Get_Motor_Error", "Get_Iq", "Set_Limits"}


def test_firmware_0_5_differs_in_what_it_is_said_to_differ(databases):
    old, new = databases["odrive_0_5"], databases["odrive"]

    def shape(message):
        return (message.frame_id, message.length, message.senders,
                [(s.name, s.start, s.length, s.byte_order, s.is_signed, s.is_float, s.scale)
                 for s in message.signals])

    differing = {message.name for message in old.messages
                 if message.name not in {other.name for other in new.messages}
                 or shape(message) != shape(new.get_message_by_name(message.name))}
    assert differing == {"Heartbeat", "Clear_Errors", "Get_Motor_Error", "Get_Encoder_Count"}


# --- what the host says ---


def test_native_commands_mean_the_volts_asked_for(dump, databases):
    pick = random.Random(SEED)
    cases = [(pick.randrange(256), volts(pick), pick.randrange(4) > 0, pick.randrange(2))
             for _ in range(COUNT)]
    lines = [f"command {settings('native', inverted=inverted)} {sequence} 0 0 {number(wanted)} {int(enable)}"
             for sequence, wanted, enable, inverted in cases]
    obeyed = []
    for (sequence, wanted, enable, inverted), answer in zip(cases, dump(lines)):
        message, values = decode(databases["native"], answer)
        held = narrow(as_float(wanted) if dump.is_float and math.isfinite(wanted) else wanted, dump.is_float)
        drives = enable and math.isfinite(held)
        product = 0.0 if not drives else narrow(held * 1000, dump.is_float) if abs(held) < 1e35 else held
        millivolts = nearest(product, -2**31 + 1, 2**31 - 1) * (-1 if inverted else 1)
        assert message.name == "Drive_Cmd"
        assert round(values["voltage"] * 1000) == millivolts, (wanted, values)
        assert values["enable"] == values["mode"] == int(drives)
        assert values["sequence"] == (sequence + 1) % 256
        assert values["timeout"] == 100
        obeyed.append((f"obey {settings('native')} {frame_words(message, bytes.fromhex(answer['data']))}",
                       millivolts, values))
    for (line, millivolts, values), answer in zip(obeyed, dump([line for line, _, _ in obeyed])):
        assert answer["verdict"] == COMMAND and answer["wish"] == VOLTS
        assert narrow(answer["value"], dump.is_float) == narrow(
            narrow(float(millivolts), dump.is_float) / 1000, dump.is_float)
        assert answer["sequence"] == values["sequence"] and answer["watchdog_ms"] == 100


@pytest.mark.parametrize("mode", [VOLTAGE, FOC])
def test_vesc_duties_mean_the_volts_asked_for(dump, databases, mode):
    pick = random.Random(SEED + mode)
    cases = [(pick.choice([0.0, 0.9, 24.3, 55.0]), volts(pick), pick.randrange(4) > 0, pick.randrange(2))
             for _ in range(COUNT)]
    lines = [f"command {settings('vesc', mode, inverted=inverted)} 0 {number(bus)} 0 {number(wanted)} "
             f"{int(enable)}" for bus, wanted, enable, inverted in cases]
    obeyed = []
    for (bus, wanted, enable, inverted), answer in zip(cases, dump(lines)):
        message, values = decode(databases["vesc"], answer)
        assert len(answer["data"]) == 8
        held = as_float(wanted) if dump.is_float and math.isfinite(wanted) else wanted
        if not enable or not math.isfinite(held):
            assert message.name == "SET_CURRENT" and values["current"] == 0  # the motor runs free
            continue
        full = (bus if bus > 1 else 12.0) / (math.sqrt(3) if mode == FOC else 1)
        steps = max(-1e5, min(1e5, held / full * 1e5)) * (-1 if inverted else 1)
        assert message.name == "SET_DUTY"
        assert abs(values["duty"] * 1e5 - steps) <= 0.5 + 1e-6
        words = frame_words(message, bytes.fromhex(answer["data"]))
        obeyed.append((f"obey {settings('vesc', mode)} {words}", values))
    assert len(obeyed) > COUNT / 2
    for (line, values), answer in zip(obeyed, dump([line for line, _ in obeyed])):
        assert answer["verdict"] == COMMAND and answer["wish"] == DUTY
        assert answer["value"] == pytest.approx(max(-0.95, min(0.95, values["duty"])), abs=1e-12)


@pytest.mark.parametrize("mode", [VOLTAGE, TORQUE])
@pytest.mark.parametrize("firmware", [FIRMWARE_0_6, FIRMWARE_0_5])
def test_odrive_torques_mean_the_volts_asked_for(dump, databases, mode, firmware):
    pick = random.Random(SEED + mode)
    cases = [(pick.uniform(-20, 20), volts(pick), pick.randrange(4) > 0, pick.randrange(2))
             for _ in range(COUNT)]
    lines = [f"command {settings('odrive', mode, firmware, inverted)} 0 0 {number(rate)} {number(wanted)} "
             f"{int(enable)}" for rate, wanted, enable, inverted in cases]
    obeyed = []
    for (rate, wanted, enable, inverted), answer in zip(cases, dump(lines)):
        message, values = decode(databases[file_of("odrive", firmware)], answer)
        held = as_float(wanted) if dump.is_float and math.isfinite(wanted) else wanted
        asked = -held if inverted else held
        if not enable or not math.isfinite(held):
            expected = 0.0
        elif mode == TORQUE:
            expected = 0.05 * (max(-12, min(12, asked)) - 0.25 * rate) / 2
        else:
            expected = asked
        assert message.name == "Set_Input_Torque" and len(answer["data"]) == 16
        assert values["Input_Torque"] == pytest.approx(as_float(expected), rel=1e-7, abs=1e-45)
        obeyed.append((f"obey {settings('odrive', mode, firmware)} "
                       f"{frame_words(message, bytes.fromhex(answer['data']))}", values))
    for (line, values), answer in zip(obeyed, dump([line for line, _ in obeyed])):
        assert answer["verdict"] == COMMAND and answer["wish"] == (WISH_TORQUE if mode == TORQUE else VOLTS)
        assert answer["value"] == values["Input_Torque"]


# --- what cantools says, heard by the host and obeyed by the drive ---


def heard(dump, databases, protocol, name, firmware=FIRMWARE_0_6):
    """(values by cantools, answer) of random payloads of a message."""
    database = databases[file_of(protocol, firmware)]
    message = database.get_message_by_name(name)
    pick = random.Random(SEED)
    payloads = [random_payload(pick, message) for _ in range(COUNT)]
    for payload in payloads[:100]:  # cantools packs what it unpacks; a spare bit it does not keep
        values = message.decode(payload, decode_choices=False)
        if all(math.isfinite(value) for value in values.values()):
            assert message.decode(message.encode(values, strict=False), decode_choices=False) == values
    answers = dump([f"hear {settings(protocol, firmware=firmware)} {frame_words(message, payload)}"
                    for payload in payloads])
    return [(message.decode(payload, decode_choices=False), answer)
            for payload, answer in zip(payloads, answers)]


@pytest.mark.parametrize("name, place", [("Drive_Fb", 0), ("Drive_Fb2", 1)])
def test_native_feedback_is_heard_as_cantools_reads_it(dump, databases, name, place):
    for values, answer in heard(dump, databases, "native", name):
        if values["encoder_invalid"]:
            assert answer["verdict"] == NOT_FINITE
            assert answer["counts"] == [0, 0] and answer["state"] == UNKNOWN
            continue
        assert answer["verdict"] == FEEDBACK
        assert answer["counts"][place] == values["counts"]
        assert answer["capture"][place] == values["capture_time"]
        assert answer["echo"][place] == values["echo"]
        if place == 0:  # the state is that of the drive, told with its own encoder
            assert answer["watchdog_expired"] == values["watchdog_expired"]
            assert answer["estopped"] == values["estopped"]
            assert answer["state"] == (FAULTY if values["fault"] else READY if values["ready"] else IDLE)


def test_native_status_is_heard_as_cantools_reads_it(dump, databases):
    for values, answer in heard(dump, databases, "native", "Drive_Status"):
        assert answer["verdict"] == STATE
        assert answer["bus_voltage"] == pytest.approx(values["bus_voltage"], abs=1e-9)
        assert answer["error"] == values["fault"] and answer["serial"] == values["serial"]


def test_vesc_messages_are_heard_as_cantools_reads_them(dump, databases):
    for values, answer in heard(dump, databases, "vesc", "STATUS"):
        assert answer["verdict"] == STATE
        assert answer["rate"] == pytest.approx(values["electrical_speed"] / 60 / 7, rel=1e-12)
    for values, answer in heard(dump, databases, "vesc", "STATUS_4"):
        assert answer["verdict"] == FEEDBACK
        assert answer["steps"] == round(values["position"] / 0.02) % 18000
        assert answer["counts"][0] == answer["steps"] * 4096 // 18000
    for values, answer in heard(dump, databases, "vesc", "STATUS_5"):
        assert answer["verdict"] == STATE
        assert answer["bus_voltage"] == pytest.approx(values["voltage_in"], abs=1e-9)


def test_odrive_messages_are_heard_as_cantools_reads_them(dump, databases):
    refused = 0
    for values, answer in heard(dump, databases, "odrive", "Get_Encoder_Estimates"):
        turns, rate = values["Pos_Estimate"], values["Vel_Estimate"]
        if math.isfinite(turns) and math.isfinite(rate):
            assert answer["verdict"] == FEEDBACK
            assert answer["turns"] == turns and answer["rate"] == rate
            counts = math.floor(turns * 4096 + 0.5)
            assert answer["counts"][0] == (counts + 2**31) % 2**32 - 2**31
        else:
            assert answer["verdict"] == NOT_FINITE and answer["turns"] == answer["rate"] == 0
            refused += 1
    assert refused > 100
    for values, answer in heard(dump, databases, "odrive", "Get_Bus_Voltage_Current"):
        if math.isfinite(values["Bus_Voltage"]):
            assert answer["verdict"] == STATE and answer["bus_voltage"] == values["Bus_Voltage"]
        else:
            assert answer["verdict"] == NOT_FINITE and answer["bus_voltage"] == 0


def test_odrive_0_5_counts_are_heard_as_cantools_reads_them(dump, databases):
    for values, answer in heard(dump, databases, "odrive", "Get_Encoder_Count", FIRMWARE_0_5):
        assert answer["verdict"] == FEEDBACK
        assert answer["counts"][0] == values["Shadow_Count"]
        assert answer["turns"] == answer["rate"] == 0
    for values, answer in heard(dump, databases, "odrive", "Get_Encoder_Estimates", FIRMWARE_0_5):
        finite = math.isfinite(values["Pos_Estimate"]) and math.isfinite(values["Vel_Estimate"])
        assert answer["verdict"] == (STATE if finite else NOT_FINITE)
        assert answer["rate"] == (values["Vel_Estimate"] if finite else 0)
        assert answer["turns"] == answer["counts"][0] == 0


def test_odrive_heartbeats_are_heard_as_cantools_reads_them(dump, databases):
    flags = {"Motor_Error_Flag": "MOTOR_FAILED", "Encoder_Error_Flag": "ENCODER_FAILED",
             "Controller_Error_Flag": "CONTROLLER_FAILED"}
    for firmware in (FIRMWARE_0_6, FIRMWARE_0_5):
        message = databases[file_of("odrive", firmware)].get_message_by_name("Heartbeat")
        choices = message.get_signal_by_name("Axis_Error").choices
        bit = {str(choice): value for value, choice in choices.items()}
        for values, answer in heard(dump, databases, "odrive", "Heartbeat", firmware):
            error = values["Axis_Error"]
            for flag, name in flags.items():
                error |= bit[name] if values.get(flag) else 0
            assert answer["verdict"] == STATE and answer["error"] == error
            assert answer["watchdog_expired"] == bool(error & bit["WATCHDOG_TIMER_EXPIRED"])
            assert answer["estopped"] == bool(error & bit["ESTOP_REQUESTED"])
            ready = values["Axis_State"] == 8 and error == 0
            faulty = error & ~bit["ESTOP_REQUESTED"]
            assert answer["state"] == (FAULTY if faulty else READY if ready else IDLE)


def test_odrive_requests_of_cantools_are_obeyed(dump, databases):
    for name in ("odrive", "odrive_0_5"):
        database = databases[name]

        def obey(message_name, **values):
            message = database.get_message_by_name(message_name)
            words = frame_words(message, message.encode(values))
            return dump([f"obey {settings('odrive', firmware=int(name != 'odrive'))} {words}"])[0]

        assert obey("Set_Axis_State", Axis_Requested_State="CLOSED_LOOP_CONTROL")["wants"] == [1, 0, 0]
        assert obey("Set_Axis_State", Axis_Requested_State="IDLE")["wants"] == [0, 0, 0]
        clear = {"Identify": 0} if name == "odrive" else {}
        assert obey("Clear_Errors", **clear)["wants"] == [0, 1, 0]
        stop = obey("Estop")
        assert stop["verdict"] == STOP and stop["wants"] == [0, 0, 1] and stop["wish"] == RELEASE
        mode = obey("Set_Controller_Mode", Control_Mode="TORQUE_CONTROL", Input_Mode="PASSTHROUGH")
        assert mode["verdict"] == REQUEST
        assert obey("Set_Input_Torque", Input_Torque=math.nan)["verdict"] == NOT_FINITE


# --- what the drive says ---


def drive_value(pick, span):
    """A quantity of a drive: plausible, beyond its field, or not a number."""
    return pick.choice([pick.uniform(-span, span), pick.uniform(-span, span), pick.uniform(-span, span),
                        pick.uniform(-1e6, 1e6), 10 ** pick.uniform(-30, 30), math.nan, math.inf, -math.inf])


def reports(dump, databases, protocol, name, firmware=FIRMWARE_0_6):
    """(device, values by cantools) of random devices."""
    message, = (row["number"] for row in dump(["messages"])[0]
                if row["file"] == file_of(protocol, firmware) and row["name"] == name and row["from_drive"])
    pick = random.Random(SEED + message)
    quantities = ("turns", "rate", "volts", "amperes", "supply", "temperature")
    devices = [{"state": pick.randrange(4), "error": pick.choice([0, 0, 1, 3, 255, 256, 2**32 - 1]),
                "flags": pick.randrange(8) + 16 * pick.randrange(2), "counts": [pick.randint(-2**31, 2**31 - 1) for _ in range(2)],
                "sequence": pick.randrange(256), "serial": pick.randrange(2**16),
                "time": pick.getrandbits(40), **{name: drive_value(pick, 100) for name in quantities}}
               for _ in range(COUNT)]
    lines = [f"report {settings(protocol, firmware=firmware)} {message} {d['state']} {d['error']} "
             f"{d['flags']} {d['counts'][0]} {d['counts'][1]} {d['sequence']} {d['serial']} {d['time']} "
             + " ".join(number(d[name]) for name in quantities)
             for d in devices]
    result = []
    for device, answer in zip(devices, dump(lines)):
        assert answer["has"]
        found, values = decode(databases[file_of(protocol, firmware)], answer)
        assert found.name == name
        result.append((device, values))
    return result


def test_native_reports_are_read_by_cantools(dump, databases):
    for name, place in (("Drive_Fb", 0), ("Drive_Fb2", 1)):
        for device, values in reports(dump, databases, "native", name):
            assert values["counts"] == device["counts"][place]
            assert values["capture_time"] == device["time"] % 65536
            assert values["echo"] == device["sequence"]
            assert values["ready"] == (device["state"] == READY)
            assert values["fault"] == (device["state"] == FAULTY)
            flags = values["watchdog_expired"] + 2 * values["estopped"] + 4 * values["restarted"]
            assert flags == device["flags"] % 8
    for device, values in reports(dump, databases, "native", "Drive_Status"):
        assert round(values["bus_voltage"] * 100) == nearest(device["supply"] * 100, 0, 65535)
        assert round(values["current"] * 100) == nearest(device["amperes"] * 100, -32768, 32767)
        assert values["temperature"] == nearest(device["temperature"], -128, 127)
        assert values["fault"] == min(device["error"], 255) and values["serial"] == device["serial"]


def test_vesc_reports_are_read_by_cantools(dump, databases):
    for device, values in reports(dump, databases, "vesc", "STATUS_4"):
        assert 0 <= round(values["position"] / 0.02) < 18000
        assert round(values["temperature_fet"] * 10) == nearest(device["temperature"] * 10, -32768, 32767)
        if abs(device["turns"]) < 1000:
            within = (device["turns"] - values["position"] / 360) % 1
            assert min(within, 1 - within) <= 1 / 18000 + 1e-9
    for device, values in reports(dump, databases, "vesc", "STATUS"):
        speed = device["rate"] * 60 * 7
        assert values["electrical_speed"] == nearest(speed, -2**31, 2**31 - 1)
        assert round(values["current"] * 10) == nearest(device["amperes"] * 10, -32768, 32767)
        if device["supply"] > 0 and math.isfinite(device["volts"]):
            duty = nearest(device["volts"] / device["supply"] * 1000, -32768, 32767)
            assert abs(round(values["duty"] * 1000) - duty) <= 1
    for device, values in reports(dump, databases, "vesc", "STATUS_5"):
        assert round(values["voltage_in"] * 10) == nearest(device["supply"] * 10, -32768, 32767)
        if abs(device["turns"]) < 1e6:
            assert values["tachometer"] == math.floor(device["turns"] * 42)


@pytest.mark.parametrize("firmware", [FIRMWARE_0_6, FIRMWARE_0_5])
def test_odrive_reports_are_read_by_cantools(dump, databases, firmware):
    def same(value, asked):
        return math.isnan(value) if math.isnan(asked) else value == as_float(asked)

    for device, values in reports(dump, databases, "odrive", "Get_Encoder_Estimates", firmware):
        if firmware and not device["flags"] & 16:  # it has not been in closed loop
            assert values["Pos_Estimate"] == values["Vel_Estimate"] == 0
            continue
        assert same(values["Pos_Estimate"], device["turns"]) and same(values["Vel_Estimate"], device["rate"])
    for device, values in reports(dump, databases, "odrive", "Heartbeat", firmware):
        watchdog, estop = (0x800, 0x4000) if firmware else (0x01000000, 0x02000000)
        named = device["error"] | watchdog * (device["flags"] & 1) | estop * (device["flags"] >> 1 & 1)
        assert values["Axis_State"] == {UNKNOWN: 0, READY: 8}.get(device["state"], 1)
        if named:
            assert values["Axis_Error"] == named
        else:
            assert (values["Axis_Error"] != 0) == (device["state"] == FAULTY)
        if firmware:
            assert values["Motor_Error_Flag"] == bool(values["Axis_Error"] & 0x40)
        assert values["Trajectory_Done_Flag"] == 1
    for device, values in reports(dump, databases, "odrive", "Get_Bus_Voltage_Current", firmware):
        assert same(values["Bus_Voltage"], device["supply"])
    if firmware:
        for device, values in reports(dump, databases, "odrive", "Get_Encoder_Count", firmware):
            assert values["Shadow_Count"] == device["counts"][0]
            assert values["Count_in_CPR"] == device["counts"][0] % 4096
