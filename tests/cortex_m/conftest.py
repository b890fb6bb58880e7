"""What the tests on the emulated processors share: where one cannot run, it is skipped with the reason."""

import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/cortex_m"))
import counts  # noqa: E402


@pytest.fixture(scope="session")
def emulator():
    """Compiler and emulator are there."""
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("the host's part would be another program here; run it in the preset host")
    why = counts.missing()
    if why:
        pytest.skip(why)
