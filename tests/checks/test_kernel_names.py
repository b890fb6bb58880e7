"""A kernel is an external function, and its entry in a table knows by which name it is found."""

import collections
import json
import re

import pytest
from checks import gone, symbols

SHARED = {"particle_pendulum": "hinged_particles", "fixed_axis": "hinged_particles"}  # whose kernels a system has

Row = collections.namedtuple("Row", "system stepper effects address name")


@pytest.fixture(scope="module")
def library(build):
    """Times that each external function is in the library, by its name."""
    if not (build / "libmctau.a").exists():
        pytest.skip("no library in double precision")
    found = symbols.symbols([build / "libmctau.a"], "-g", "--defined-only")
    return collections.Counter(name for _, kind, name in found if kind == "T")


@pytest.fixture(scope="module")
def program(build, source, library, tmp_path_factory):
    return gone.kernels_program(build, source, tmp_path_factory.mktemp("names"))


@pytest.fixture(scope="module")
def rows(program):
    rows = [Row(*line.split()) for line in gone.printed(program)]
    assert len(rows) > 1000
    return rows


def test_the_name_in_an_entry_is_the_symbol_at_its_address(program, rows):
    words = [line.split() for line in gone.printed("nm", "-g", "--defined-only", program)]
    symbols_at = collections.defaultdict(set)
    for address, _, name in words:
        symbols_at[int(address, 16)].add(name)
    assert not [row for row in rows if row.name not in symbols_at[int(row.address, 16)]]


def test_every_entry_has_a_name_of_its_own(rows):
    of_tables = {(SHARED.get(row.system, row.system), row.stepper, row.effects): row.name for row in rows}
    assert len(set(of_tables.values())) == len(of_tables)


def test_every_name_is_in_the_library_once(rows, library):
    assert {library[row.name] for row in rows} == {1}


def test_a_name_tells_the_system_and_the_stepper(rows):
    for row in rows:
        assert re.fullmatch(f"mct_{SHARED.get(row.system, row.system)}_{row.stepper}(_[a-z]*[0-9_]*)?", row.name), row


def test_a_function_that_is_called_like_a_kernel_is_in_a_table(rows, library, mctau):
    steppers = [stepper["name"] for stepper in json.loads(mctau("list", "--json").stdout)["steppers"]]
    systems = {SHARED.get(row.system, row.system) for row in rows}
    kernel = re.compile(f"mct_({'|'.join(systems)})_({'|'.join(steppers)})(_.*)?")
    assert {name for name in library if kernel.fullmatch(name)} == {row.name for row in rows}
