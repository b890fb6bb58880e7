"""On an emulated Cortex-M the kernels give the host's bits, and their instructions are counted exactly."""

import json
import os
import re
import shutil
import subprocess
import sys

import counts
import pytest

TICKS = 1000
CENTRAL = ("cart_pole", "reaction_wheel")
DOUBLE = re.compile(r"__aeabi_(c?d|\w+2d)")  # add, compare, to and from
RUNS = [("cortex-m4f", "float", "cart_pole"), ("cortex-m4f", "float", "reaction_wheel"),
        ("cortex-m4f", "double", "reaction_wheel"), ("cortex-m7", "double", "cart_pole")]  # fmt: skip


def rows_of(target, image, job):
    ticks, rows = counts.run_image(target, image, job)
    assert ticks == TICKS
    return rows


@pytest.fixture
def kernels(mctau):
    """Names of the central systems' kernels: mct_cart_pole_leap_0_3, ..."""
    listed = json.loads(mctau("list", "--json").stdout)["steppers"]
    return re.compile(f"mct_({'|'.join(CENTRAL)})_({'|'.join(stepper['name'] for stepper in listed)})_[0-9]+_[0-9]+")


def by_stepper(rows, key):
    return {row["stepper"]: row[key] for row in rows}


@pytest.fixture(params=RUNS, ids="_".join)
def ran(request, emulator, source, build):
    """The image of a run, its job's file and its rows."""
    target, precision, system = request.param
    image = counts.build_image(target, system, precision)
    with counts.job_of(source / "scenes" / f"{system}.toml", TICKS, build=build) as (job, name):
        assert name == system
        yield target, precision, image, job, rows_of(target, image, job)


def test_every_state_of_a_run_has_the_bits_of_the_host(ran, build):
    _, precision, _, job, rows = ran
    _, here = counts.run_here(job, precision, build)
    assert len(here) >= 7
    assert by_stepper(rows, "hash") == by_stepper(here, "hash")
    assert not any(row["diverged_ticks"] for row in rows)


def test_every_run_counts_the_same_instructions(ran):
    target, _, image, job, rows = ran
    assert rows_of(target, image, job) == rows


def test_a_timer_that_counts_something_else_is_refused(emulator, source, build, tmp_path):
    script = tmp_path / "run"
    script.write_text((source / "hal/cortex_m/run").read_text().replace("shift=10", "shift=9"))
    image = counts.build_image("cortex-m4f", "cart_pole", "float")
    with counts.job_of(source / "scenes/cart_pole.toml", TICKS, build=build) as (job, _):
        done = subprocess.run(["bash", script, "m4f", image, job], capture_output=True, text=True)
    assert done.returncode == 1 and "does not count instructions" in done.stdout


def test_a_kernel_in_float_comes_to_no_arithmetic_in_double(emulator, kernels):
    for system in CENTRAL:
        code = counts.Code(counts.build_image("cortex-m4f", system, "float"))
        found = [start for start, names in code.names.items() if any(kernels.fullmatch(name) for name in names)]
        assert len(found) > 100
        for start in [code.address_of("mct_plant_step"), *found]:
            assert not {name for name in code.names_from(start) if DOUBLE.match(name)}, code.names[start]
        init = code.address_of("mct_plant_init")
        assert any(DOUBLE.match(name) for name in code.names_from(init)), "there it is, and must be seen"


def test_an_image_has_neither_heap_nor_stdio(emulator):
    code = counts.Code(counts.build_image("cortex-m4f", "cart_pole", "float"))
    names = set().union(*code.names.values())
    assert not names & {"malloc", "free", "_malloc_r", "_sbrk", "printf", "vfprintf", "_vfprintf_r", "fopen", "exit"}


# --- the command ---


@pytest.fixture
def instructions(emulator, source, build):
    def run(*arguments, **environment):
        return subprocess.run([sys.executable, source / "tools/instructions", *map(str, arguments)], text=True,
                              capture_output=True, env=os.environ | {"MCTAU_BUILD": str(build)} | environment)

    return run


def test_the_costs_written_for_pick_add_up_to_a_tick(instructions, source, tmp_path):
    file = tmp_path / "costs.csv"
    done = instructions(source / "scenes/cart_pole.toml", "--precision", "float", "-o", file, "--json")
    assert done.returncode == 0, done.stderr
    told = {row["stepper"]: row for row in json.loads(done.stdout)["steppers"]}
    lines = [line.split(",") for line in file.read_text().splitlines() if not line.startswith("#")]
    assert {line[0] for line in lines} == told.keys()
    for stepper, precision, step, beside in lines:
        assert precision == "float"
        # ten digits are written
        assert float(step) + float(beside) == pytest.approx(told[stepper]["tick"]["mean"], rel=1e-9)


def test_pick_takes_the_costs_as_written(instructions, mctau, source, tmp_path):
    file = tmp_path / "costs.csv"
    scene = source / "scenes/cart_pole.toml"
    assert instructions(scene, "--precision", "float", "-o", file).returncode == 0
    picked = mctau("pick", scene, "--tolerance", "1e-3", "--target", "cortex-m4f", "--costs", file, "--json")
    assert picked.returncode == 0, picked.stderr
    assert json.loads(picked.stdout)["precision"] == "float"


@pytest.mark.parametrize(("arguments", "code", "words"), [
    (["no.toml"], 3, ["no.toml", "cannot be read"]),
    (["scenes/cart_pole.toml", "--set", "scene.dt=-1"], 2, ["scene.dt", "found -1", "allowed"]),
    (["scenes/cart_pole.toml", "--ticks", "0"], 2, ["--ticks", "found 0", "allowed 1 to 10000"]),
    (["scenes/cart_pole.toml", "--target", "z80"], 2, ["cortex-m4f", "cortex-m7"]),
    (["scenes/cart_pole.toml", "-o", "no/such/folder"], 3, ["no/such/folder"]),
])  # fmt: skip
def test_what_is_wrong_is_said(instructions, source, arguments, code, words):
    scene = source / arguments[0]
    done = instructions(scene, *arguments[1:], "--precision", "float")
    assert done.returncode == code
    assert all(word in done.stderr for word in words), done.stderr


def test_what_is_not_installed_is_named(instructions, source, tmp_path):
    for tool in ("python3", "cmake", "ninja", "cc"):
        (tmp_path / tool).symlink_to(shutil.which(tool))
    done = instructions(source / "scenes/cart_pole.toml", PATH=str(tmp_path))
    assert done.returncode == 3
    for word in ("arm-none-eabi-gcc", "qemu-system-arm", "tools/setup --cortex-m", "apt-get install"):
        assert word in done.stderr
