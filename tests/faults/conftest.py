"""What the tests of bad days share: a run of the command of which one system call fails, or that is killed there."""

import errno
import os
import pathlib
import platform
import subprocess

import pytest

TIMEOUT = 20  # [s]; a run takes 0.05
NOT_TRACED = 99


@pytest.fixture(scope="session")
def fail_call(tmp_path_factory):
    """The compiled fail_call.c."""
    if platform.machine() != "x86_64" or platform.system() != "Linux":
        pytest.skip("fail_call.c knows the calls of x86-64 Linux alone")
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("a sanitizer's runtime makes calls of its own and cannot go without them")
    program = tmp_path_factory.mktemp("faults") / "fail_call"
    source = pathlib.Path(__file__).parent / "fail_call.c"
    subprocess.run([os.environ.get("CC", "cc"), "-O1", source, "-o", program], check=True)
    return program


@pytest.fixture
def run(fail_call, build, source, tmp_path):
    """run(scene, options, n, number, manner): the process, its calls as [name, failed, file], what files it left."""
    command = pathlib.Path(os.environ.get("MCTAU", build / "mctau"))

    def run(scene, options, n=0, number=errno.EIO, manner="once"):
        path = source / "scenes" / f"{scene}.toml"
        for file in tmp_path.iterdir():
            file.unlink()
        report = tmp_path / "calls"
        words = [fail_call, path, n, number, manner, report, command, "run", path, *options]
        done = subprocess.run([str(word) for word in words], cwd=tmp_path, capture_output=True, text=True,
                              errors="replace", timeout=TIMEOUT, stdin=subprocess.DEVNULL)  # fmt: skip
        if done.returncode == NOT_TRACED:
            pytest.skip("this system lets nobody trace a process")
        calls = [line.rstrip("\n").split(" ", 2) for line in open(report)]
        report.unlink()
        return done, calls, {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    return run
