"""The skeleton for a board with a CAN peripheral: it fits, and holds nothing that it must not. It was run on no board.

Its clock runs in the emulator; its transport runs on the host against a model of the chip: tests/hal/test_bxcan_f64.c.
"""

import re
import struct
import subprocess

import counts
import pytest

CENTRAL = ("cart_pole", "reaction_wheel")
FLASH, RAM = (0x08000000, 1 << 20), (0x20000000, 128 << 10)  # STM32F407VG: RM0090, 2.3
STACK = 4 << 10  # bytes that docs/porting.md says are more than enough
DOUBLE = re.compile(r"__aeabi_(c?d|\w+2d)")  # add, compare, to and from
# What the loop calls by way of pointers, in each tick and between two: HAL, protocol, transport, interrupts, board.
BY_POINTER = [*(f"can_{name}" for name in ("read", "write", "wait_tick", "stop", "arm", "plant", "timing")),
              "hear", "command", "arm", "stop", "identifier",
              *(f"bxcan_{name}" for name in ("send", "receive", "now_us", "tend")),
              "SysTick_Handler", "can1_interrupt", "mct_board_show_tick", "mct_board_show_well",
              "mct_board_watchdog_feed"]  # fmt: skip
OUTSIDE = {"malloc", "free", "_malloc_r", "_sbrk", "printf", "vfprintf", "_vfprintf_r", "fopen", "exit",
           "mct_semihosting_write", "mct_semihosting_exit", "mct_can_axes_init", "mct_scene_read"}


@pytest.fixture(scope="module", params=CENTRAL)
def image(request, emulator, mctau, source):
    system = request.param
    name = f"stm32f407_{system}"
    scene = counts.build_folder("cortex-m4f") / f"{name}.c"
    done = mctau("compile", source / "scenes" / f"{system}.toml", "--precision", "float", "-o", scene)
    assert done.returncode == 0, done.stderr
    return counts.build_target("cortex-m4f", f"{name}_f32")


def sections(image):
    """(name, address, size) of what lies in memory."""
    lines = counts.output(["arm-none-eabi-readelf", "-SW", image]).splitlines()
    rows = [line.split("]", 1)[1].split() for line in lines if re.match(r" +\[ *\d+\] \S", line)]
    return [(row[0], int(row[2], 16), int(row[4], 16)) for row in rows if "A" in row[6]]


def test_it_lies_in_the_memory_of_the_part_with_room_for_the_stack(image):
    used = {FLASH: 0, RAM: 0}
    for name, address, size in sections(image):
        region = next(region for region in used if region[0] <= address < sum(region))
        assert address + size <= sum(region), name
        used[region] += size
    assert 10_000 < used[FLASH] < FLASH[1] and 1_000 < used[RAM] < RAM[1] - STACK


def test_the_vectors_begin_the_flash_and_those_of_can_stand_in_their_places(image, tmp_path):
    binary = tmp_path / "image.bin"
    subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", image, binary], check=True)
    words = struct.unpack("<37I", binary.read_bytes()[:148])
    code = counts.Code(image)
    assert words[0] == sum(RAM)
    at = {1: "Reset_Handler", 3: "HardFault_Handler", 15: "SysTick_Handler", 16 + 19: "can1_interrupt",
          16 + 20: "can1_interrupt"}  # fmt: skip
    for place, name in at.items():
        assert words[place] & 1 and name in code.names[words[place] & ~1], name


def test_what_a_tick_reaches_has_no_arithmetic_in_double(image):
    code = counts.Code(image)
    starts = [start for name in BY_POINTER for start in code.names if name in code.names[start]]
    assert {name for start in starts for name in code.names[start]} >= set(BY_POINTER)
    swing_up = next(start for start, names in code.names.items() if any(name.endswith("_swing_up") for name in names))
    for start in [code.address_of("mct_loop_tick"), swing_up, *starts]:
        assert not {name for name in code.names_from(start) if DOUBLE.match(name)}, code.names[start]
    opens = code.names_from(code.address_of("can_open"))
    assert any(DOUBLE.match(name) for name in opens), "there it is, and must be seen"


def test_it_has_neither_heap_nor_stdio_nor_a_debugger_nor_a_scene_reader_nor_a_kernel(image):
    names = set().union(*counts.Code(image).names.values())
    assert not names & OUTSIDE
    assert not {name for name in names if re.search(r"_(leap|rk4|expo)_\d", name)}
    assert {"main", "mct_loop_tick", "can_read"} <= names


# --- SysTick, in the emulator ---


@pytest.fixture(scope="module")
def systick(emulator):
    image = counts.build_target("cortex-m4f", "systick_f32")
    printed = counts.output([counts.ROOT / "hal/cortex_m/run", "m4f", image])
    figures = {}
    for line in printed.splitlines():
        name, number = line.split()
        figures.setdefault(name, []).append(int(number))
    return figures


# An instruction takes 1.024 us of the emulated time. Between an interrupt and a reading there are fewer than a hundred, in
# what mct_clock_wait does for its histograms fewer than three hundred.
BETWEEN_US, BESIDE_US = 100, 300


def test_a_tick_comes_every_millisecond(systick):
    assert systick["ticks_us"][0] == pytest.approx(1000 * 1000, abs=20)  # some instructions, once; a cycle a tick were 40
    assert systick["longest_tick_us"][0] == pytest.approx(1000, abs=BETWEEN_US)
    assert systick["missed_at_rest"] == [0]
    assert systick["worst_lateness_us"][0] <= BETWEEN_US


def test_ticks_that_are_missed_are_counted_and_skipped(systick):
    assert systick["missed"] == [0, 3, 0]  # after work of 300, 3500 and 300 us
    assert max(systick["lateness_us"]) <= BETWEEN_US


def test_work_is_measured(systick):
    for told, done in zip(systick["work_us"], (300, 3500, 300), strict=True):
        assert done < told < done + BESIDE_US


def test_time_goes_forward_at_the_rate_of_another_timer(systick):
    assert systick["times_back"] == [0]
    assert systick["systick_us"][0] == pytest.approx(systick["timer_us"][0], rel=0.002)  # what one look takes of a period


def test_time_goes_on_while_the_interrupt_is_held_back(systick):
    assert 1500 < systick["held_us"][0] < 1500 + BESIDE_US


def test_a_tick_that_the_timer_cannot_count_is_refused(systick):
    refused = -6  # MCT_ERROR_RANGE
    for name in ("too_long", "too_short", "no_number", "no_frequency"):
        assert systick[name] == [refused]
    assert systick["right"] == [0]
