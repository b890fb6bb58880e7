"""What the Python tests share: the command, and how a skipped test reaches ctest."""

import os
import pathlib
import subprocess

import pytest

SKIPPED_FOR_CTEST = 77  # tests/CMakeLists.txt names it as SKIP_RETURN_CODE


def pytest_sessionfinish(session, exitstatus):
    """A file of which a part was skipped counts as skipped: ctest knows one verdict for a file."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if exitstatus == 0 and reporter is not None and reporter.stats.get("skipped"):
        session.exitstatus = SKIPPED_FOR_CTEST


@pytest.fixture(scope="session")
def source():
    """The repository's root."""
    return pathlib.Path(os.environ.get("MCTAU_SOURCE", pathlib.Path(__file__).parent.parent))


@pytest.fixture(scope="session")
def build(source):
    """The build folder under test; build/host when pytest is called by hand."""
    return pathlib.Path(os.environ.get("MCTAU_BUILD", source / "build" / "host"))


@pytest.fixture(scope="session")
def mctau(build):
    """mctau("run", scene, "--json", ...) runs the command; gives subprocess.CompletedProcess with text."""
    command = pathlib.Path(os.environ.get("MCTAU", build / "mctau"))
    if not command.exists():
        pytest.skip("the command is not built: cmake --build --preset host")

    def run(*arguments, timeout=60, **options):
        return subprocess.run([command, *map(str, arguments)], capture_output=True, text=True,
                              timeout=timeout, **options)

    return run
