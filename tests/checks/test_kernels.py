"""An effect that is off leaves no instruction behind: read from the library's own object files, and as kernels run."""

import os
import shlex
import subprocess

import pytest
from checks import gone, kernels

GRAVITY, VISCOUS, COULOMB = 1, 2, 4
MOTORS = {"off": 0, "quasi_static": 8, "inductive": 16}
CASES = [("cart_pole", "rk4"), ("cart_pole", "leap"), ("reaction_wheel", "expo")]
# All effects but one, for each; without drag, and with it.
LESS_ONE, WITH_DRAG = (0x7, 0xF, 0x13, 0x15, 0x16), (0x17, 0x47, 0x4F, 0x53, 0x55, 0x56)
# As plain_kernels.c has them by hand: system, stepper, effects.
BY_HAND = [("cart_pole", "rk4", each) for each in (0x0, 0x3, *LESS_ONE, *WITH_DRAG)] + [
    ("cart_pole", "leap", 0x0)] + [("reaction_wheel", "rk4", each) for each in (*LESS_ONE, *WITH_DRAG)] + [
    ("reaction_wheel", "expo", each) for each in (0x0, 0x17, *LESS_ONE)]  # fmt: skip
# On average over the steps that are counted, with dry friction: rounding decides in which of them a coordinate comes to rest.
ROUNDED = 0.5
WITHIN = 0.05  # of instructions, moves with them: registers fall otherwise
# With dry friction: the library's kernels call its clamp, which by hand stands in its place.
WITHIN_BY_CALL = 0.07
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
    library = build / "libmctau.a"
    if not library.exists():
        pytest.skip("no library in double precision")
    program = plain("f64").with_name("plain")
    compiler = shlex.split(os.environ.get("CC", "cc"))
    measure = source / "tools/benchmark/measure.c"
    subprocess.run([*compiler, "-std=gnu99", "-O2", measure, plain("f64"), library, "-o", program], check=True)
    return kernels.executed(source, program)


@pytest.mark.parametrize("system, stepper", CASES)
@pytest.mark.parametrize("motor", MOTORS)
def test_an_effect_more_never_makes_a_kernel_smaller(build, library, system, stepper, motor):
    for tag in tags(build):
        functions = library(system, tag)
        size = [kernels.arithmetic(functions[f"mct_{system}_{stepper}_{MOTORS[motor]}_{others}"])
                for others in range(8)]
        for more in range(8):
            for less in (more & ~GRAVITY, more & ~VISCOUS, more & ~COULOMB):
                assert size[less] <= size[more], f"{tag}: {size}"


@pytest.mark.parametrize("system, stepper", CASES)
def test_a_motor_more_never_makes_a_kernel_smaller(build, library, system, stepper):
    for tag in tags(build):
        functions = library(system, tag)
        for others in range(8):
            size = [kernels.arithmetic(functions[f"mct_{system}_{stepper}_{motor}_{others}"])
                    for motor in MOTORS.values()]
            assert size == sorted(size), f"{tag}, others {others}: {size}"


def test_an_effect_more_never_makes_a_series_smaller(build, library):
    for tag in tags(build):
        functions = library("cart_pole", tag)
        size = [[kernels.arithmetic(functions[f"mct_cart_pole_taylor4_{motor}_{others}"]) for others in range(4)]
                for motor in MOTORS.values()]
        for each in size:
            assert each[0] <= min(each[1], each[2]) and max(each[1], each[2]) <= each[3], f"{tag}: {size}"
        for others in range(4):
            assert size[0][others] <= size[1][others] <= size[2][others], f"{tag}: {size}"


@pytest.fixture(scope="module")
def symbols(build, source, tmp_path_factory):
    """Names of the library's kernels in its object files: by system, stepper and effects."""
    if not (build / "libmctau.a").exists():
        pytest.skip("no library in double precision")
    every = gone.all_kernels(build, source, tmp_path_factory.mktemp("symbols"))
    return {(one.system, one.stepper, one.effects): one.symbol for one in every}


def spare(stepper, effects):
    """Without gravity, each stage of rk4 takes friction from 0, where one changes its sign by hand, which is no sum."""
    return 4 if stepper == "rk4" and effects and not effects & GRAVITY else 0


@pytest.mark.parametrize("system, stepper, effects", BY_HAND)
def test_a_kernel_equals_one_written_for_its_effects_alone(build, library, plain, symbols, system, stepper, effects):
    for tag in tags(build):
        masked, name = library(system, tag), symbols[system, stepper, effects]
        by_hand, plain_name = kernels.functions(plain(tag)), f"plain_{system}_{stepper}_{effects:x}"
        surplus, missing = kernels.operations(masked, name), kernels.operations(by_hand, plain_name)
        more = sum(surplus.values()) - sum(missing.values())
        assert abs(more) <= spare(stepper, effects), f"{tag}: {more} more"


@pytest.mark.parametrize("system, stepper, effects", BY_HAND)
def test_a_step_does_what_one_written_for_its_effects_alone_does(executed, system, stepper, effects):
    masked, by_hand = (executed[f"{whose}_{system}_{stepper}_{effects:x}"] for whose in ("library", "plain"))
    print(f"{masked.all:.0f} instructions, {masked.work:.0f} without moves; by hand {by_hand.all:.0f}, {by_hand.work:.0f}")
    assert abs(masked.work - by_hand.work) <= (ROUNDED if effects & COULOMB else 0)
    within = WITHIN_BY_CALL if effects & COULOMB else WITHIN
    assert abs(masked.all - by_hand.all) <= within * by_hand.all
