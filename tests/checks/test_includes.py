"""src/ and include/ include what the house allows, and rooms depend one way."""

import re

SYSTEM_HEADERS = {"stdint.h", "stdbool.h", "stddef.h", "float.h", "limits.h",
                  "string.h"}  # for memcpy and memset alone: test_symbols.py
# A room may include from rooms of its own level and below. The scene reader describes them all.
LEVEL = {"math": 0, "gauss": 1, "effects": 1, "systems": 2, "steppers": 3, "control": 4, "loop": 5,
         "scene": 6}
# A system's kernels are made where its right-hand side is: there the steppers' inline templates are included.
INSTANTIATED = ("systems", "steppers")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def includes(root, *folders):
    """(file, system header?, header) of each include in these folders."""
    found = []
    for folder in folders:
        for file in sorted((root / folder).rglob("*.[ch]")):
            for kind, header in INCLUDE.findall(file.read_text()):
                found.append((file.relative_to(root), kind == "<", header))
    assert found, f"no include in {folders}; wrong folder?"
    return found


def test_core_includes_only_the_allowed_system_headers(source):
    strangers = [(str(file), header) for file, is_system, header in includes(source, "src", "include")
                 if is_system and header not in SYSTEM_HEADERS]
    assert not strangers


def test_core_knows_of_the_hal_its_interface_alone(source):
    strangers = [(str(file), header) for file, is_system, header in includes(source, "src", "include")
                 if not is_system and header != "hal/hal.h" and re.search(r"(^|/)(hal|tools|tests)/", header)]
    assert not strangers


def test_the_hals_interface_includes_what_the_core_may(source):
    interface = source / "hal" / "hal.h"
    strangers = [header for kind, header in INCLUDE.findall(interface.read_text()) if kind == "<"
                 and header not in SYSTEM_HEADERS] if interface.exists() else []
    assert not strangers


def test_rooms_depend_one_way(source):
    backwards = []
    for file, is_system, header in includes(source, "src"):
        room = file.parts[1]
        other = header.removeprefix("../").split("/")[0]
        if is_system or room not in LEVEL or other not in LEVEL or (room, other) == INSTANTIATED:
            continue
        if LEVEL[other] > LEVEL[room]:
            backwards.append((str(file), header))
    assert not backwards
