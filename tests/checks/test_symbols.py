"""The libraries' symbols keep the house rules: own namespace, no heap, no libm, no stdio, no mutable data.

tests/determinism asks the same of what other compilers and other options make of core and sim HAL.
"""

import os

import pytest
from checks import symbols


@pytest.fixture(autouse=True)
def plain_build():
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("sanitizers and coverage add symbols of their own")


def objects(build, room):
    """Object files of `room` (core, hal), by precision tag. The build leaves the lists in check/."""
    lists = {path.stem.rsplit("_", 1)[1]: path.read_text().split()
             for path in build.glob(f"check/mctau_{room}_*.txt")}
    assert lists, f"the build left no list of the objects of {room}"
    return lists


@pytest.mark.parametrize("room", ["core", "hal"])
def test_every_global_name_starts_with_mct(build, room):
    for files in objects(build, room).values():
        assert not [name for name in symbols.defined(files) if not name.startswith("mct_")]


def test_core_asks_for_nothing_but_memcpy_and_its_kin(build):
    for files in objects(build, "core").values():
        assert not symbols.strangers(files, symbols.FROM_THE_COMPILER)


def test_hal_asks_for_no_heap(build):
    for files in objects(build, "hal").values():
        assert not symbols.asked_for(files, symbols.HEAP)


@pytest.mark.parametrize("room", ["core", "hal"])
def test_no_file_scope_data_is_mutable(build, room):
    for files in objects(build, room).values():
        assert not symbols.mutable(files)


def test_both_precisions_offer_the_same_names(build):
    names = [symbols.defined(files) for files in objects(build, "core").values()]
    assert all(each == names[0] for each in names)
