"""The same run gives the same bits with every compiler and optimisation, and those are the committed ones."""

import os
import re
import subprocess

import pytest
from checks import symbols
from determinism import builds

# gcc makes such a call of a loop over a text; the library's own build tells it not to (CMakeLists.txt).
LIBRARY_OPTIONS_PREVENT = {"strlen"}


@pytest.fixture(scope="session")
def built(source, build):
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("has builds of its own, which do not differ between presets; run it in the preset host")
    made = builds.Builds(source, build / "determinism", builds.CONFIGURATIONS)
    made.log = made.build()
    return made


def need(configuration):
    why = builds.missing(configuration)
    if why:
        assert os.environ.get("CI") != "true", why
        pytest.skip(why)


def by_case(lines):
    """Hash by case; a case is all of a line but its last word."""
    return dict(line.rsplit(" ", 1) for line in lines if line and not line.startswith("#"))


@pytest.mark.parametrize("configuration", builds.CONFIGURATIONS, ids=builds.name_of)
def test_every_build_gives_the_golden_bits(built, configuration):
    need(configuration)
    try:
        found = by_case(built.lines(configuration))
    except FileNotFoundError:
        pytest.fail(f"{builds.name_of(configuration)} does not build or run:\n{built.log[-4000:]}")
    golden = by_case(builds.GOLDEN.read_text().splitlines())
    assert found.keys() == golden.keys(), "the golden file has other cases; tests/golden/refresh"
    different = [case for case in golden if found[case] != golden[case]]
    assert not different, f"{len(different)} of {len(golden)} cases differ"


@pytest.mark.parametrize("configuration", builds.CONFIGURATIONS, ids=builds.name_of)
def test_every_build_of_the_core_asks_for_nothing_but_memcpy_and_its_kin(built, configuration):
    need(configuration)
    for precision in builds.PRECISIONS:
        files = built.objects(configuration, precision, "src")
        assert files
        assert not symbols.strangers(files, symbols.FROM_THE_COMPILER | LIBRARY_OPTIONS_PREVENT)


@pytest.mark.parametrize("configuration", builds.CONFIGURATIONS, ids=builds.name_of)
def test_no_build_of_core_and_hal_has_mutable_data_or_asks_for_heap(built, configuration):
    need(configuration)
    for precision in builds.PRECISIONS:
        files = [file for room in ("src", "hal") for file in built.objects(configuration, precision, room)]
        assert not symbols.mutable(files)
        assert not symbols.asked_for(files, symbols.HEAP)


@pytest.mark.parametrize("configuration", builds.CONFIGURATIONS, ids=builds.name_of)
def test_no_build_fuses_a_product_into_a_sum(built, configuration):
    """-ffp-contract=off forbids it, but gcc's vectoriser of straight code does not always listen."""
    need(configuration)
    for precision in builds.PRECISIONS:
        files = [file for room in ("src", "hal") for file in built.objects(configuration, precision, room)]
        code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", *files], capture_output=True, text=True,
                              check=True).stdout
        assert not set(re.findall(r"\bv?f[n]?m(?:add|sub)\w*", code))
