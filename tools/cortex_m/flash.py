"""Bytes of every kernel on a Cortex-M4F, in float, and the table of them that the command holds.

    measured = flash.measure()
    measured["cart_pole"].bytes["rk4"][9]    # of the kernel for the effects 9, with all that it calls
"""

import dataclasses

import counts

FILE = counts.ROOT / "tools/mctau/kernel_bytes_table.h"
MOST = 0xFFFF  # an entry has 16 bits


@dataclasses.dataclass
class System:
    effects: int  # every bit that has kernels
    bytes: dict  # by stepper, by set of effects


def measure():
    """Every system by its name, in the library's order; raises counts.Unavailable."""
    why = counts.missing()
    if why:
        raise counts.Unavailable(why)
    image = counts.build_target("cortex-m4f", "kernels_f32")
    code = counts.Code(image)
    systems = {}
    for line in counts.output([counts.ROOT / "hal/cortex_m/run", "m4f", image]).splitlines():
        name, stepper, effects, address, _ = line.split()
        system = systems.setdefault(name, System(0, {}))
        effects, address = int(effects, 16), int(address, 16) & ~1  # the lowest bit says Thumb
        system.effects |= effects
        size = system.bytes.setdefault(stepper, {})[effects] = code.size_from(address)
        if not 0 < size <= MOST:
            raise counts.Unavailable(f"{name} {stepper} {effects:#x}: found {size} bytes; allowed 1 to {MOST}")
    return systems


def subsets(effects):
    """All sets of the bits, ordered as mct_kernel_bytes counts them."""
    bits = [1 << bit for bit in range(32) if effects >> bit & 1]
    return [sum(bit for i, bit in enumerate(bits) if index >> i & 1) for index in range(1 << len(bits))]


def wrapped(numbers):
    lines = [""]
    for number in numbers:
        word = f"{number},"
        if len(lines[-1]) + len(word) > 105:
            lines.append("")
        lines[-1] += word
    return "\n".join("    " + line for line in lines)


def text(systems):
    """The table's file."""
    parts = ["/* Written by tools/effects --flash: bytes of the kernels on a Cortex-M4F, in float. */\n"
             "/* clang-format off */\n"]
    for name, system in systems.items():
        for stepper, sizes in system.bytes.items():
            rows = wrapped(sizes.get(effects, 0) for effects in subsets(system.effects))
            parts.append(f"static const uint16_t {name}_{stepper}[{len(subsets(system.effects))}] = {{\n{rows}\n}};\n")
    parts.append("static const measured_system measured_systems[MCT_SYSTEM_COUNT] = {\n")
    for name, system in systems.items():
        rows = "".join(f"        [MCT_STEPPER_{stepper.upper()}] = {name}_{stepper},\n" for stepper in system.bytes)
        parts.append(f"    {{{system.effects:#x}, {{\n{rows}    }}}},\n")
    return "".join([*parts, "};\n"])
