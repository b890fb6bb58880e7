"""mctau drive: what is refused, and how, where there is no CAN. What it does on a bus: tests/hal/test_can_drive.c, tests/lab."""

import os
import shutil

import pytest

NOWHERE = "nosuchcan0"  # an interface that no machine has


@pytest.fixture
def scene(scenes, tmp_path):
    return shutil.copy(scenes / "reaction_wheel.toml", tmp_path / "scene.toml")


def refused(done, exit_code, *words):
    assert done.returncode == exit_code, done.stderr
    assert done.stdout == ""
    assert done.stderr.startswith("mctau: ")
    assert len(done.stderr.splitlines()) == 1
    for word in words:
        assert word in done.stderr, done.stderr


@pytest.mark.parametrize("arguments, words", [
    ([], ["--can", "nothing", "vcan0"]),
    (["--can", ""], ["--can", "empty"]),
    (["--can", NOWHERE, "--protocol", "morse"], ["--protocol", "morse", "native, vesc, odrive"]),
    (["--can", NOWHERE, "--fault", "fire"], ["--fault", "fire", "reboot"]),
    (["--can", NOWHERE, "--fault-duration", "-1"], ["--fault-duration", "-1"]),
    (["--can", NOWHERE, "--duration", "0.0005"], ["--duration", "0.0005"]),
    (["--can", NOWHERE, "--csv", ""], ["--csv", "empty"]),
    (["--can", NOWHERE, "--csv", "-"], ["--csv", "--json"]),
    (["--can", NOWHERE, "--csv", "scene.toml"], ["--csv", "scene.toml", "another file"]),
    (["--can", NOWHERE, "--set", "effects.motor=off", "--set", "effects.saturation=off", "--set", "controller.kind=none"], ["effects.motor", "volts"]),
    (["--can", NOWHERE, "--protocol", "native", "--set", "can.mode=foc"], ["can.mode", "foc", "vesc"]),
])  # fmt: skip
def test_a_wrong_command_line_is_refused_by_its_name(mctau, scene, tmp_path, arguments, words):
    before = (tmp_path / "scene.toml").read_text()
    refused(mctau("drive", scene, "--json", *arguments, cwd=tmp_path), 2, *words)
    assert os.listdir(tmp_path) == ["scene.toml"]
    assert (tmp_path / "scene.toml").read_text() == before


@pytest.mark.parametrize("options", [[], ["--json"], ["--precision", "float"], ["--lockstep", "--protocol", "odrive"]])
def test_without_the_interface_a_sentence_says_what_to_do_and_nothing_is_left(mctau, scene, tmp_path, options, precisions):
    if "float" in options and "float" not in precisions:
        pytest.skip("this build has one precision")
    done = mctau("drive", scene, "--can", NOWHERE, "--csv", tmp_path / "truth.csv", *options)
    refused(done, 3, "--can: ", "CAN")
    assert NOWHERE in done.stderr or "kernel has no CAN" in done.stderr or "not allowed" in done.stderr
    assert os.listdir(tmp_path) == ["scene.toml"]


def test_a_missing_scene_is_an_error_of_input(mctau, tmp_path):
    refused(mctau("drive", tmp_path / "none.toml", "--can", NOWHERE), 3, "none.toml", "No such file")


def test_help_tells_how_a_host_meets_it(mctau):
    done = mctau("drive", "--help")
    assert done.returncode == 0
    for word in ("--can IFACE", "--lockstep", "--fault KIND", "mctau run", "socketcan:vcan0", "Exit codes"):
        assert word in done.stdout
    assert "drive " in mctau("--help").stdout
