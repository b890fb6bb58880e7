"""An effect that is off leaves no instruction behind: read from the library's own object files."""

import json
import os
import shlex
import subprocess

import pytest
from checks import kernels

GRAVITY, VISCOUS, COULOMB = 1, 2, 4
MOTORS = {"off": 0, "quasi_static": 8, "inductive": 16}
CASES = [("cart_pole", "rk4"), ("cart_pole", "leap"), ("reaction_wheel", "expo")]
TAGS = {"f64": "double", "f32": "float"}


@pytest.fixture(scope="module", autouse=True)
def plain_build(build):
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("sanitizers and coverage add instructions of their own")
    commands = [compile_command(build, "cart_pole", tag) for tag in tags(build)]
    if not all("-O2" in command or "-O3" in command for command in commands):
        pytest.skip("instructions are counted in an optimised build alone")


def tags(build):
    return [tag for tag, precision in TAGS.items() if (build / "include" / precision).exists()]


def compile_command(build, system, tag):
    """How a system's file was compiled, as a list of words."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if entry["file"].endswith(f"src/systems/{system}.c") and f"mctau_core_{tag}.dir" in entry["command"]:
            return shlex.split(entry["command"])
    raise AssertionError(f"no compile command of {system}.c, {tag}")


@pytest.fixture(scope="module")
def library(build):
    """library(system, tag): functions of a system's object file."""
    read = {}

    def functions(system, tag):
        if (system, tag) not in read:
            command = compile_command(build, system, tag)
            read[system, tag] = kernels.functions(build / command[command.index("-o") + 1])
        return read[system, tag]

    return functions


@pytest.fixture(scope="module")
def plain(build, source, tmp_path_factory):
    """plain(tag): functions of plain_kernels.c, compiled as the library was."""
    made = {}

    def functions(tag):
        if tag not in made:
            command = compile_command(build, "cart_pole", tag)
            target = tmp_path_factory.mktemp("plain") / f"{tag}.o"
            command[command.index("-o") + 1] = str(target)
            command[command.index("-c") + 1] = str(source / "tests" / "checks" / "plain_kernels.c")
            subprocess.run(command, check=True, cwd=build)
            made[tag] = kernels.functions(target)
        return made[tag]

    return functions


@pytest.mark.parametrize("system, stepper", CASES)
@pytest.mark.parametrize("motor", MOTORS)
def test_an_effect_more_never_makes_a_kernel_smaller(build, library, system, stepper, motor):
    for tag in tags(build):
        functions = library(system, tag)
        size = [kernels.arithmetic(functions[f"{stepper}_{MOTORS[motor]}_{others}"]) for others in range(8)]
        for more in range(8):
            for less in (more & ~GRAVITY, more & ~VISCOUS, more & ~COULOMB):
                assert size[less] <= size[more], f"{tag}: {size}"


@pytest.mark.parametrize("system, stepper", CASES)
def test_a_motor_more_never_makes_a_kernel_smaller(build, library, system, stepper):
    for tag in tags(build):
        functions = library(system, tag)
        for others in range(8):
            size = [kernels.arithmetic(functions[f"{stepper}_{motor}_{others}"]) for motor in MOTORS.values()]
            assert size == sorted(size), f"{tag}, others {others}: {size}"


def test_an_effect_more_never_makes_a_series_smaller(build, library):
    for tag in tags(build):
        functions = library("cart_pole", tag)
        size = [[kernels.arithmetic(functions[f"taylor4_{motor}_{others}"]) for others in range(4)]
                for motor in MOTORS.values()]
        for each in size:
            assert each[0] <= min(each[1], each[2]) and max(each[1], each[2]) <= each[3], f"{tag}: {size}"
        for others in range(4):
            assert size[0][others] <= size[1][others] <= size[2][others], f"{tag}: {size}"


@pytest.mark.parametrize("system, stepper", CASES)
def test_a_kernel_without_effects_equals_one_written_without_effects(build, library, plain, system, stepper):
    for tag in tags(build):
        masked = library(system, tag)[f"{stepper}_0_0"]
        by_hand = plain(tag)[f"plain_{stepper}"]
        assert kernels.arithmetic(masked) == kernels.arithmetic(by_hand)
        assert abs(len(masked) - len(by_hand)) <= 0.05 * len(by_hand)
