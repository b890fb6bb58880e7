"""The libraries' symbols keep the house rules: own namespace, no heap, no libm, no stdio, no mutable data."""

import os
import re
import subprocess

import pytest

# A compiler may call these on its own.
FROM_THE_COMPILER = {"memcpy", "memset", "memmove", "memcmp", "__stack_chk_fail", "_GLOBAL_OFFSET_TABLE_"}
HEAP = {"malloc", "calloc", "realloc", "reallocarray", "free", "aligned_alloc", "posix_memalign", "memalign",
        "valloc", "strdup", "strndup", "asprintf", "vasprintf", "getline", "getdelim", "open_memstream"}
# Written once by the loader, then read-only.
CONSTANT_SECTIONS = re.compile(r"^\.(rodata|data\.rel\.ro|text)")


@pytest.fixture(autouse=True)
def plain_build():
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("sanitizers and coverage add symbols of their own")


def objects(build, room):
    """Object files of `room` (core, hal), by precision tag. The build leaves the lists in check/."""
    lists = {path.stem.rsplit("_", 1)[1]: path.read_text().split()
             for path in build.glob(f"check/mctau_{room}_*.txt")}
    if room == "core":
        assert lists, "the build left no list of the core's objects"
    return lists


def symbols(files, *options):
    """(file, type, name) of each symbol that nm shows."""
    found = []
    for line in subprocess.run(["nm", "-A", "-P", *options, *files], capture_output=True, text=True,
                               check=True).stdout.splitlines():
        file, name, kind = line.rsplit(":", 1)[0], *line.rsplit(": ", 1)[1].split()[:2]
        found.append((file, kind, name))
    return found


def wanted(files):
    """Names that these object files need from outside."""
    defined = {name for _, _, name in symbols(files, "-g", "--defined-only")}
    return {(name, file) for file, _, name in symbols(files, "-u") if name not in defined}


@pytest.mark.parametrize("room", ["core", "hal"])
def test_every_global_name_starts_with_mct(build, room):
    for files in objects(build, room).values():
        strangers = [(name, file) for file, _, name in symbols(files, "-g", "--defined-only")
                     if not name.startswith("mct_")]
        assert not strangers


def test_core_asks_for_nothing_but_memcpy_and_its_kin(build):
    for files in objects(build, "core").values():
        assert not {(name, file) for name, file in wanted(files) if name not in FROM_THE_COMPILER}


def test_hal_asks_for_no_heap(build):
    for files in objects(build, "hal").values():
        assert not {(name, file) for name, file in wanted(files) if name in HEAP}


@pytest.mark.parametrize("room", ["core", "hal"])
def test_no_file_scope_data_is_mutable(build, room):
    for files in objects(build, room).values():
        mutable = []
        file = ""
        table = subprocess.run(["objdump", "-t", *files], capture_output=True, text=True, check=True).stdout
        for line in table.splitlines():
            if ":     file format" in line:
                file = line.split(":")[0]
            match = re.match(r"^[0-9a-f]+ (.{7}) (\S+)\s+([0-9a-f]+) (?:\.hidden )?(\S+)$", line)
            if match and ("O" in match[1] or match[2] == "*COM*") and not CONSTANT_SECTIONS.match(match[2]):
                mutable.append((match[4], match[2], file))
        assert not mutable


def test_both_precisions_offer_the_same_names(build):
    names = [{name for _, _, name in symbols(files, "-g", "--defined-only")}
             for files in objects(build, "core").values()]
    assert all(each == names[0] for each in names)
