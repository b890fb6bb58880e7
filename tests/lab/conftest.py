"""What the tests of the lab share: a test for which there is no machine is skipped with the reason."""

import os
import pathlib

import pytest
from lab import machine


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    return (yield from skipping())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    return (yield from skipping())


def skipping():
    try:
        return (yield)
    except machine.Unavailable as reason:
        pytest.skip(str(reason))


@pytest.fixture(scope="session")
def command(mctau, build):
    """Path of the command; the fixture mctau skips when there is none."""
    return pathlib.Path(os.environ.get("MCTAU", build / "mctau"))
