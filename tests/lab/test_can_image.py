"""An image of a compiled scene drives a virtual drive over the kernel's CAN as the simulation does, bit for bit."""

import os
import pathlib
import struct
import sys

import pytest
from lab import machine
from lab.machine import Step

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/cortex_m"))
import images  # noqa: E402

TICKS = 3000
SCENE = "cart_pole.toml"
LOCKSTEP = ["can.lockstep=true"]
# mct_record in double: what of it a loop decides, behind tick, plant and reading.
RECORD = struct.Struct("<Q 256x64x 2i II 6d iI 4xI Q")


def decided(records):
    """Wanted and applied voltage, mode and faults of each tick in which the motor was armed."""
    rows = [RECORD.unpack_from(records, 16 + i * RECORD.size) for i in range((len(records) - 16) // RECORD.size)]
    return [row[9:13] for row in rows]


@pytest.fixture(scope="module")
def ran(command, source):
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("the image would be another program here; run it in the preset host")
    path = source / "scenes" / SCENE
    with images.compiled(path, "double", LOCKSTEP) as scene:
        robot = images.build(scene, "robot", "vcan0")
        images.run(images.build(scene, "twin", "sil"), "sil", scene.folder / "sil", TICKS)
        battery = [Step("image", f"""
            start drive mctau drive $IN/{SCENE} --can vcan0 --lockstep
            await 5 more_listeners vcan0 0
            IMAGE_ARGUMENTS="vcan0 records {TICKS}" robot
            stop drive""", limit=40)]
        files = {"mctau": command, "robot": robot, SCENE: path}
        yield machine.run(battery, files=files), (scene.folder / "sil").read_bytes()


def test_an_image_on_a_bus_decides_as_in_simulation_in_every_tick(ran):
    result, simulated = ran
    said = result.out("image")
    assert "mode swing_up" in said and "fault" not in said, said
    records = result.files["records"]
    assert len(decided(simulated)) == len(decided(records)) == TICKS
    assert decided(records) == decided(simulated)
