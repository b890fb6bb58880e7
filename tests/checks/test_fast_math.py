"""What would change the bits of a run is refused when compiling: -ffast-math, and the parts of it that a compiler tells."""

import shutil
import subprocess

import pytest

ALL_TELL = ["-ffast-math", "-Ofast", "-ffinite-math-only"]
GCC_TELLS = ["-funsafe-math-optimizations", "-freciprocal-math", "-fno-signed-zeros",
             "-fassociative-math -fno-signed-zeros -fno-trapping-math"]
CASES = [(compiler, option) for compiler in ("gcc", "clang") for option in ALL_TELL]
CASES += [("gcc", option) for option in GCC_TELLS]


def compiled(source, build, compiler, *options):
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    return subprocess.run(
        [compiler, "-std=c99", "-fsyntax-only", *options, "-I", source / "include",
         "-I", build / "include" / "double", "-x", "c", "-"],
        input='#include "mctau/real.h"\n', capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize(("compiler", "option"), CASES)
def test_a_build_that_may_change_the_bits_is_refused_by_name(source, build, compiler, option):
    done = compiled(source, build, compiler, *option.split())
    assert done.returncode != 0
    assert "fast-math changes the bits of a run" in done.stderr


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("option", ["-O0", "-O3"])
def test_a_plain_build_is_not_refused(source, build, compiler, option):
    done = compiled(source, build, compiler, option)
    assert done.returncode == 0, done.stderr
