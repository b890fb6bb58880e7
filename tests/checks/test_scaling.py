"""Work grows with what is listed as it must: with particles at most linearly, with a chain's links at most as their
square. Instructions are counted, which are the same in every run; nobody looks at a clock.
"""

import os
import shlex
import shutil
import subprocess
import sys

import pytest

# Growth by twice the rows, over that by the rows before: 2 where it is linear, 4 where it is quadratic, and a tenth for
# branches that fall otherwise. What does not depend on the rows drops out of both.
LINEAR, QUADRATIC = 2.2, 4.4
NO_GROWTH = 32  # [instructions] sines of other angles differ by as much


@pytest.fixture(scope="module")
def rows(source, build, tmp_path_factory):
    """Instructions of each piece of work by its number of rows: {(listed, system, what): {rows: count}}."""
    if os.environ.get("MCTAU_SANITIZE"):
        pytest.skip("sanitizers and coverage add instructions of their own")
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind, which counts instructions, is not installed; run tools/setup")
    library = build / "libmctau.a"
    if not library.exists():
        pytest.skip("no library in double precision")
    sys.path.insert(0, str(source / "tools" / "benchmark"))
    import instructions

    program = tmp_path_factory.mktemp("scaling") / "systems"
    includes = [f"-I{folder}" for folder in (source / "include", source, build / "include" / "double")]
    sources = [source / "tools" / "benchmark" / name for name in ("systems.c", "measure.c")]
    compiler = shlex.split(os.environ.get("CC", "cc"))
    subprocess.run([*compiler, "-std=gnu99", "-O2", *includes, *sources, library, "-o", program], check=True)
    found = {}
    for name, count in instructions.count(program).items():
        words = name.split()
        if len(words) == 4:
            found.setdefault(tuple(words[:3]), {})[int(words[3])] = count
    return found


def growths(counts):
    """What each doubling of the rows adds."""
    return [counts[2 * number] - counts[number] for number in counts if 2 * number in counts]


def assert_growth(counts, factor):
    steps = growths(counts)
    for before, after in zip(steps, steps[1:]):
        assert after <= factor * max(before, NO_GROWTH), counts


def counts_of(pieces, listed, *whats):
    """What `rows` holds of systems that list particles or coordinates."""
    found = [counts for (group, _, what), counts in pieces.items() if group == listed and what in whats]
    assert found and all(len(growths(counts)) >= 2 for counts in found)
    return found


def test_a_step_and_an_evaluation_grow_at_most_linearly_with_the_particles(rows):
    for counts in counts_of(rows, "particles", "step", "evaluate"):
        assert_growth(counts, LINEAR)


def test_an_update_of_a_chain_grows_at_most_with_the_square_of_its_links(rows):
    for counts in counts_of(rows, "coordinates", "step"):
        assert_growth(counts, QUADRATIC)
