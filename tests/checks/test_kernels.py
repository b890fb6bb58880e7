"""An effect that is off leaves no instruction behind: read from the library's own object files, and as kernels run."""

import os
import shlex
import shutil
import subprocess
import sys

import pytest
from checks import kernels

GRAVITY, VISCOUS, COULOMB = 1, 2, 4
MOTORS = {"off": 0, "quasi_static": 8, "inductive": 16}
CASES = [("cart_pole", "rk4"), ("cart_pole", "leap"), ("reaction_wheel", "expo")]
# Those without effects, and those with the effects that people run, as plain_kernels.c has them.
BY_HAND = [("cart_pole", "rk4_0_0"), ("cart_pole", "leap_0_0"), ("reaction_wheel", "expo_0_0"),
           ("cart_pole", "rk4_0_3"), ("cart_pole", "rk4_16_3"), ("reaction_wheel", "expo_16_3")]
# Operations by which the arithmetic may differ: the library multiplies out the sine's share of acceleration and jerk,
# which then need not wait for the sine.
SPARE = {"expo_16_3": 5}
WITHIN = 0.05  # of instructions: registers and branches fall otherwise
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
    return kernels.compile_command(build, f"src/systems/{system}.c", tag)


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
    """plain(tag): object file of plain_kernels.c, compiled as the library was."""
    made = {}

    def file(tag):
        if tag not in made:
            command = compile_command(build, "cart_pole", tag)
            made[tag] = tmp_path_factory.mktemp("plain") / f"{tag}.o"
            command[command.index("-o") + 1] = str(made[tag])
            command[command.index("-c") + 1] = str(source / "tests" / "checks" / "plain_kernels.c")
            subprocess.run(command, check=True, cwd=build)
        return made[tag]

    return file


@pytest.fixture(scope="module")
def executed(build, source, plain):
    """Instructions of a step as it runs, in double, by the name: library_rk4_0_3, plain_rk4_0_3, ..."""
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind, which counts instructions, is not installed; run tools/setup")
    library = build / "libmctau.a"
    if not library.exists():
        pytest.skip("no library in double precision")
    measuring = source / "tools" / "benchmark"
    sys.path.insert(0, str(measuring))
    import instructions

    program = plain("f64").with_name("plain")
    compiler = shlex.split(os.environ.get("CC", "cc"))
    subprocess.run([*compiler, "-std=gnu99", "-O2", measuring / "measure.c", plain("f64"), library, "-o", program],
                   check=True)
    return instructions.count(program)


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


@pytest.mark.parametrize("system, kernel", BY_HAND)
def test_a_kernel_equals_one_written_for_its_effects_alone(build, library, plain, system, kernel):
    for tag in tags(build):
        masked = library(system, tag)[kernel]
        by_hand = kernels.functions(plain(tag))[f"plain_{kernel}"]
        more = kernels.arithmetic(masked) - kernels.arithmetic(by_hand)
        assert abs(more) <= SPARE.get(kernel, 0), f"{tag}: {more} more"
        assert abs(len(masked) - len(by_hand)) <= WITHIN * len(by_hand), tag


@pytest.mark.parametrize("system, kernel", BY_HAND)
def test_a_step_runs_as_many_instructions_as_one_written_for_its_effects_alone(executed, system, kernel):
    by_hand = executed[f"plain_{kernel}"]
    assert abs(executed[f"library_{kernel}"] - by_hand) <= WITHIN * by_hand
