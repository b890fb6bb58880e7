"""The committed table of flash is what the compiler gives, and an effect less takes less of it."""

import ctypes
import json
import subprocess

import flash
import pytest

WITHIN = 0.05  # of another version of the compiler
# Bytes that an effect less may take more: other registers, other alignment; of the largest, series with exact friction,
# another place where the compiler calls or writes out.
SPARE, SPARE_PART = 48, 0.05
# Where an effect less takes more, and why: systems, steppers (None: any), effect by its bit.
EXCEPT = [
    # A force in space pushes as weight does. Without weight a kernel asks whether there is one, since most have none.
    ("rotating_frame", None, 1 << 0),
    # The series of a body with forces on it is longer, and so a loop; the other one is written out.
    ("rigid_body", ("taylor4", "taylor6", "taylor8", "taylor12"), 1 << 15),
]


@pytest.fixture(scope="module")
def measured(emulator):
    return flash.measure()


@pytest.fixture(scope="module")
def kernel_bytes(source, build, tmp_path_factory):
    library = tmp_path_factory.mktemp("flash") / "kernel_bytes.so"
    subprocess.run(["cc", "-shared", "-fPIC", f"-I{build / 'include/double'}", f"-I{source / 'include'}",
                    source / "tools/mctau/kernel_bytes.c", "-o", library], check=True)
    function = ctypes.CDLL(str(library)).mct_kernel_bytes
    function.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_uint32]
    return function


def is_excepted(system, stepper, bit):
    return any(system == one and bit == effect and (which is None or stepper in which) for one, which, effect in EXCEPT)


def test_the_table_is_what_the_compiler_gives(measured, kernel_bytes, mctau):
    catalogue = json.loads(mctau("list", "--json").stdout)
    names = [system["name"] for system in catalogue["systems"]]
    steppers = [stepper["name"] for stepper in catalogue["steppers"]]
    assert list(measured) == names
    for system, found in measured.items():
        for stepper in steppers:
            for effects in flash.subsets(found.effects):
                bytes_ = found.bytes.get(stepper, {}).get(effects, -1)
                told = kernel_bytes(names.index(system), steppers.index(stepper), effects)
                assert abs(told - bytes_) <= WITHIN * abs(bytes_), f"{system} {stepper} {effects:#x}: tools/effects --flash"


def test_what_acts_outside_kernels_takes_no_flash_there(kernel_bytes):
    voltage, current = 1 << 5, 1 << 17
    assert kernel_bytes(0, 3, 0x0B) == kernel_bytes(0, 3, 0x0B | voltage | current) > 0


def test_a_kernel_that_was_not_measured_is_none(kernel_bytes):
    motors, unknown = 0x18, 1 << 27
    assert kernel_bytes(0, 3, motors) == kernel_bytes(0, 3, unknown) == kernel_bytes(0, 12, 0) == -1


def test_an_effect_less_takes_no_more_flash(measured):
    compared, less = 0, 0
    for system, found in measured.items():
        for stepper, sizes in found.bytes.items():
            for effects, size in sizes.items():
                for bit in (1 << i for i in range(32) if effects >> i & 1):
                    without = sizes.get(effects & ~bit)
                    if without is None or is_excepted(system, stepper, bit):
                        continue
                    compared += 1
                    less += without < size
                    assert without <= size + max(SPARE, SPARE_PART * size), f"{system} {stepper} {effects:#x} {bit:#x}"
    # The others are those whose coefficients stand in matrices (expo), or in a function that all sets share.
    assert compared > 1000 and less > 0.9 * compared
