"""`mctau run` when any one of its system calls fails: it says what is lost, or what failed; never less.

fail_call.c fails the n-th call of a run. Each n is tried, in each manner, with each errno: all of it with
MCTAU_FAULTS=all in the environment, else a sample drawn with a seed.
"""

import collections
import errno
import os
import random
import subprocess

import pytest

SAMPLE = 20  # runs of each case, unless all are asked for
NUMBERS = [errno.EIO, errno.EINTR, errno.ENOSPC, errno.EAGAIN, errno.ENOMEM, errno.EBADF]
MANNERS = ["once", "ever", "part"]
CASES = {
    "log": ("reaction_wheel", ["--duration", "0.3", "--log", "run.lcm"]),
    "csv": ("cart_pole_free", ["--duration", "0.3", "--csv", "run.csv"]),
    "json": ("pendulum", ["--duration", "0.1", "--json"]),
    "bus": ("cart_pole", ["--duration", "0.3", "--hal", "ring", "--log", "run.lcm", "--csv", "run.csv"]),
    "network": ("reaction_wheel", ["--duration", "0.03", "--lcm", "udpm://239.255.76.67:7667?ttl=0"]),
    "realtime": ("reaction_wheel", ["--duration", "0.02", "--realtime", "--log", "run.lcm"]),
}


def lasting(case, files):
    """What a run must leave again; where its log holds lateness, or a bus's counters of the moment, as much of it."""
    return {name: len(data) for name, data in files.items()} if case in ("bus", "realtime") else files


def check(case, plain, faulty, number, name, mctau, tmp_path):
    """What holds whatever has failed; gives what became of the run."""
    (done, calls, files), (plain_done, _, plain_files) = faulty, plain
    said = [line for line in done.stderr.splitlines() if line.startswith("mctau: ")]
    # With stdout or stderr itself, the exit code has to do.
    speechless = any(name == "write" and failed == "1" and "run." not in file for name, failed, file in calls)
    assert done.returncode in (plain_done.returncode, 3), done
    # A write that was interrupted is made again; what a file has not taken otherwise, or may not have, is said.
    if any(name != "write" or number != errno.EINTR for name, failed, file in calls if failed == "1" and "run." in file):
        assert done.returncode == 3, done
    assert set(files) <= set(plain_files), done  # nothing half made
    if "run.csv" in files:
        assert files["run.csv"] == plain_files["run.csv"], done
    if done.returncode == 3:
        assert said or speechless, done
        if "run.lcm" in files:
            replay = mctau("replay", tmp_path / "run.lcm")
            assert replay.returncode in (0, 3), (done, replay)  # whole events, of the same bits
        return "told"
    assert speechless or lasting(case, files) == lasting(case, plain_files), done
    if name in ("sendmsg", "sendto"):
        assert "records published, 0 errors" not in done.stdout, done
        return "counted"
    if case == "network" and "0 errors" not in done.stdout:
        assert said, done
    return "went without" if said else "unharmed"


def places(case, count):
    """(n, errno, manner) of each run, or of a sample."""
    every = [(n, number, manner) for n in range(1, count + 1) for number in NUMBERS for manner in MANNERS]
    return every if os.environ.get("MCTAU_FAULTS") == "all" else random.Random(case).sample(every, SAMPLE)


@pytest.mark.parametrize("case", CASES)
def test_a_call_that_fails_is_told_or_harmless(run, mctau, tmp_path, case):
    plain = run(*CASES[case])
    calls = plain[1]
    assert len(calls) > 10 and plain[0].returncode in (0, 1), plain
    became = collections.Counter()
    for n, number, manner in places(case, len(calls)):
        try:
            faulty = run(*CASES[case], n, number, manner)
        except subprocess.TimeoutExpired:
            pytest.fail(f"hangs: call {n}, {errno.errorcode[number]}, {manner}: {calls[n - 1]}")
        reached = faulty[1]
        if len(reached) < n:  # two threads: their calls come in another order and number
            became["not reached"] += 1
            continue
        try:
            outcome = check(case, plain, faulty, number, reached[n - 1][0], mctau, tmp_path)
        except AssertionError as error:
            raise AssertionError(f"call {n}, {errno.errorcode[number]}, {manner}: {reached[n - 1]}: {error}") from None
        became[outcome] += 1
    print(f"{case}: {len(calls)} calls; {dict(became)}")
    assert became["told"] > 0
