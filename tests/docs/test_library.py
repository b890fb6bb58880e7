"""The examples of docs/library.md compile without a warning and run, in both precisions."""

import os
import re
import shlex
import shutil
import subprocess

import pytest

BLOCK = re.compile(r"```c\n(.*?)```", re.DOTALL)
INCLUDE = re.compile(r"^#include .*\n", re.MULTILINE)
FUNCTION = re.compile(r"^static void .*?^}\n", re.MULTILINE | re.DOTALL)  # at the margin; what remains is statements
# Examples may compute what they do not use.
FLAGS = ["-std=c99", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow",
         "-Wdouble-promotion", "-Werror", "-Wno-unused-but-set-variable", "-Wno-unused-variable"]


@pytest.mark.parametrize("is_float", [0, 1])
def test_every_example_compiles_and_runs(source, tmp_path, is_float):
    compiler = shlex.split(os.environ.get("CC", "cc"))
    if shutil.which(compiler[0]) is None:
        pytest.skip("no C compiler")
    (tmp_path / "mctau").mkdir()
    (tmp_path / "mctau" / "config.h").write_text(f"#define MCT_REAL_IS_FLOAT {is_float}\n")
    blocks = BLOCK.findall((source / "docs" / "library.md").read_text())
    assert len(blocks) >= 8
    includes = "".join(sorted({line for block in blocks for line in INCLUDE.findall(block)}))
    functions = "".join(function for block in blocks for function in FUNCTION.findall(block))
    bodies = [FUNCTION.sub("", INCLUDE.sub("", block)) for block in blocks]
    examples = "".join(f"static int example_{i}(void)\n{{\n{body}return 0;\n}}\n" for i, body in enumerate(bodies))
    calls = "".join(f"if (example_{i}()) return {i + 1};\n" for i in range(len(bodies)))
    program = tmp_path / "examples.c"
    program.write_text(f"{includes}{functions}{examples}int main(void)\n{{\n{calls}return 0;\n}}\n")
    sources = [*(source / "src" / "math").glob("*.c"), *(source / "src" / "gauss").glob("*.c")]
    folders = [f"-I{folder}" for folder in (source / "include", source / "src", tmp_path)]
    subprocess.run([*compiler, *FLAGS, *folders, program, *sources, "-o", tmp_path / "examples"], check=True)
    subprocess.run([tmp_path / "examples"], check=True, timeout=60)
