"""docs/errata.md names tests that are there and run, and each error of class A has one."""

import re

import pytest

ROW = re.compile(r"^\| (.+) \| ([ABC]) \| .* \| (.*) \|$", re.MULTILINE)  # equation, class, shown by
TEST = re.compile(r"`(test_\w+)`")


@pytest.fixture(scope="module")
def page(source):
    return (source / "docs" / "errata.md").read_text()


@pytest.fixture(scope="module")
def rows(page):
    """(equation, class, shown by) of each row of the page's tables of errata."""
    found = ROW.findall(page)
    assert len(found) == len(re.findall(r"^\| [^|]+ \| \w \|", page, re.MULTILINE))
    return found


def run_tests(folder):
    sources = "".join(file.read_text() for file in folder.rglob("test_*.c"))
    return set(re.findall(r"RUN_TEST\((test_\w+)\)", sources))


def test_every_test_that_the_page_names_is_run(page, source):
    named = set(TEST.findall(page))
    assert named and not named - run_tests(source / "tests")


def test_every_test_of_the_errata_is_named_on_the_page(page, source):
    tests = run_tests(source / "tests" / "errata")
    assert tests and not tests - set(TEST.findall(page))


def test_every_error_of_class_a_is_shown_by_a_test(rows):
    errors = [equation for equation, kind, _ in rows if kind == "A"]
    assert len(errors) == 44
    assert not [equation for equation, kind, shown in rows if kind == "A" and not TEST.search(shown)]


def test_every_error_is_shown_by_tests_or_by_reading(rows):
    allowed = re.compile(r"reading|`test_\w+`(, `test_\w+`)*")
    assert not [row for row in rows if not allowed.fullmatch(row[2])]


def test_every_system_with_errata_of_its_own_is_linked(page, source):
    for system in (source / "docs" / "systems").glob("*.md"):
        if "## What the source gets wrong" in system.read_text():
            assert f"](systems/{system.name})" in page, system.name
