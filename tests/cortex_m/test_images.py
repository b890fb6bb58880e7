"""tools/flash: the same scene on an emulated microcontroller, bit for bit, in little memory."""

import json
import os
import re
import subprocess
import sys

import counts
import images
import pytest

CENTRAL = ("cart_pole", "reaction_wheel")
SECONDS_30 = 30000  # ticks
DOUBLE = re.compile(r"__aeabi_(c?d(?!iv)|\w+2d|d2\w+)|__\w*df\d")
# A twin's limits on a Cortex-M4F, in float.
MOST_FLASH, MOST_RAM, MOST_STACK = 24 * 1024, 4 * 1024, 1024


@pytest.fixture
def flash(emulator, source, build, mctau):
    def run(*arguments, **environment):
        return subprocess.run([sys.executable, source / "tools/flash", *map(str, arguments)], text=True, capture_output=True,
                              env=os.environ | {"MCTAU_BUILD": str(build)} | environment, cwd=source)

    return run


@pytest.fixture
def flashed(flash):
    def run(*arguments):
        done = flash(*arguments, "--json")
        assert done.returncode == 0, done.stderr + done.stdout
        return json.loads(done.stdout)

    return run


# --- the same bits ---


@pytest.mark.parametrize("target", images.CORES)
@pytest.mark.parametrize("scene", CENTRAL)
def test_a_swing_up_has_the_bits_of_the_host_in_every_tick_and_replays(flashed, mctau, tmp_path, scene, target):
    log, records = tmp_path / "run.lcm", tmp_path / "run.records"
    found = flashed(f"scenes/{scene}.toml", "--target", target, "--log", log, "--records", records)
    assert found["equal_bits"] and found["run"]["ticks"] == SECONDS_30 and found["run"]["mode"] == "balance"
    assert found["precision"] == images.STANDARD[target]
    replayed = mctau("replay", log)
    if "no LCM" not in replayed.stderr:
        assert replayed.returncode == 0 and f"{SECONDS_30} ticks, the same bits" in replayed.stdout


@pytest.mark.parametrize("scene", CENTRAL)
def test_the_controller_alone_answers_with_the_twins_voltages(flashed, scene):
    found = flashed(f"scenes/{scene}.toml", "--target", "qemu-m4f", "--image", "controller")
    assert found["equal_bits"] and found["run"]["differing"] == 0 and found["run"]["ticks"] == SECONDS_30


def test_no_float_image_of_a_ready_scene_has_arithmetic_in_double(emulator, source):
    for path in sorted((source / "scenes").glob("*.toml")):
        with images.compiled(path, "float") as scene:
            names = set().union(*counts.Code(images.build(scene, "twin", "qemu-m4f")).names.values())
        assert not [name for name in names if DOUBLE.match(name)], path.stem


def test_records_that_differ_are_seen(emulator, source, tmp_path):
    """Another controller, fed with the records of the scene."""
    records = tmp_path / "records"
    path = source / "scenes/cart_pole.toml"
    with images.compiled(path, "float") as scene:
        images.run(images.build(scene, "twin", "sil"), "sil", records, 2000)
    with images.compiled(path, "float", ["controller.energy_band=3"]) as scene:
        run = images.run(images.build(scene, "controller", "qemu-m4f"), "qemu-m4f", records)
    assert run["ticks"] == 2000 and run["differing"] > 0


# --- what it takes ---


@pytest.fixture(scope="module")
def twins(emulator):
    """Of each central scene on an M4F in float: (image's memory, run, names in it)."""
    found = {}
    for name in CENTRAL:
        with images.compiled(counts.ROOT / f"scenes/{name}.toml", "float") as scene:
            image = images.build(scene, "twin", "qemu-m4f")
            code = counts.Code(image)
            names = set().union(*code.names.values())
            reached = code.names_from(code.address_of(scene.kernel))
            found[name] = images.memory(image), images.run(image, "qemu-m4f", "-"), names, scene.kernel, reached
    return found


@pytest.mark.parametrize("scene", CENTRAL)
def test_a_twin_fits_into_a_small_part(twins, scene):
    memory, run, *_ = twins[scene]
    assert memory["flash"] <= MOST_FLASH
    assert memory["ram"] <= MOST_RAM
    assert run["stack_used"] <= memory["stack"] <= MOST_STACK


@pytest.mark.parametrize("scene", CENTRAL)
def test_an_image_has_one_kernel_no_double_no_heap_and_no_stdio(twins, scene):
    _, _, names, kernel, reached = twins[scene]
    kernels = {name for name in names if re.fullmatch(rf"mct_{scene}_[a-z0-9]+_[s0-9][0-9_]*", name)}
    assert kernels <= reached and kernel in kernels # and those that the compiler found to be the same code
    assert not [name for name in names if DOUBLE.match(name)]
    assert not names & {"malloc", "free", "_malloc_r", "_sbrk", "printf", "vfprintf", "_vfprintf_r", "fopen", "puts"}
    assert not names & {"mct_scene_read", "mct_plant_init", "mct_loop_init", f"mct_{scene}"}


# On, off; all else as the scene has it, by rk4. (By `leap` and `expo`, viscous friction stands in matrices and takes no code.)
EFFECTS = [
    ("effects.viscous=true", "effects.viscous=false"),
    ("effects.drag=true", "effects.drag=false"),
    ("effects.coulomb=moreau", "effects.coulomb=off"),
    ("effects.motor=inductive", "effects.motor=quasi_static"),
    ("effects.saturation=current", "effects.saturation=voltage"),
    ("effects.saturation=voltage", "effects.saturation=off"),
]


@pytest.mark.parametrize("scene", CENTRAL)
def test_an_effect_that_is_off_takes_less_flash(emulator, source, scene):
    def size(assignment):
        slow_motor = ["scene.stepper=rk4", "parameters.inductance=0.01"]  # which rk4 follows
        with images.compiled(source / "scenes" / f"{scene}.toml", "float", [*slow_motor, assignment]) as one:
            return images.memory(images.build(one, "twin", "qemu-m4f"))["flash"]

    for on, off in EFFECTS:
        assert size(off) < size(on), off


# --- what is wrong ---


@pytest.mark.parametrize(("arguments", "code", "words"), [
    (["no.toml", "--target", "qemu-m4f"], 3, ["no.toml"]),
    (["scenes/cart_pole.toml", "--target", "z80"], 2, ["found z80", "allowed sil", "qemu-m7"]),
    (["scenes/cart_pole.toml", "--target", "sil", "--image", "controller"], 2, ["controller", "takes twin"]),
    (["scenes/cart_pole.toml", "--target", "qemu-m4f", "--set", "scene.stepper=split3"], 2, ["scene.stepper", "found split3"]),
    (["scenes/cart_pole.toml", "--target", "sil", "--log", "no/such/folder/x.lcm"], 3, ["no/such/folder"]),
    (["scenes/cart_pole.toml", "--target", "vcan97"], 3, ["CAN"]),
])  # fmt: skip
def test_what_is_wrong_is_said(flash, arguments, code, words):
    done = flash(*arguments)
    assert done.returncode == code
    assert all(word in done.stderr for word in words), done.stderr


def test_a_scene_that_is_too_large_is_said_with_the_bytes(flash, tmp_path):
    samples = tmp_path / "long.csv"
    samples.write_text("volts\n" + "1.5\n" * 1_200_000)
    done = flash("scenes/cart_pole.toml", "--target", "qemu-m4f", "--set", "controller.kind=none", "--set", "input.kind=csv",
                 "--set", f"input.file={samples}", "--set", "input.column=volts")
    assert done.returncode == 2
    assert re.search(r"too large for qemu-m4f: flash by \d+ bytes", done.stderr), done.stderr


def test_what_is_not_installed_is_named(flash, source, tmp_path):
    (tmp_path / "python3").symlink_to(sys.executable)
    done = flash("scenes/cart_pole.toml", "--target", "qemu-m4f", PATH=str(tmp_path))
    assert done.returncode == 3
    for word in ("arm-none-eabi-gcc", "qemu-system-arm", "tools/setup --cortex-m", "apt-get install"):
        assert word in done.stderr


def test_a_fault_ends_with_exit_code_1_and_its_name(flash):
    done = flash("scenes/cart_pole.toml", "--target", "qemu-m4f", "--set", "sensors.fault=silent", "--set",
                 "sensors.fault_time=1", "--set", "sensors.fault_duration=1")
    assert done.returncode == 1 and "sensor_stale" in done.stdout and "as on this machine" in done.stdout
