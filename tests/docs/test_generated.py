"""What the documents take from the program is what the program says."""

import json
import re
import shutil
import subprocess
import sys


def generate(source, build, *options):
    return subprocess.run(
        [sys.executable, source / "docs" / "generate", "--mctau", build / "mctau", *options],
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_every_generated_table_is_as_committed(source, build, mctau):
    done = generate(source, build, "--check")
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_generated_part_has_been_filled(source):
    for document in [source / "README.md", *(source / "docs").rglob("*.md")]:
        text = document.read_text()
        assert text.count("<!-- generated:") == text.count("<!-- end -->"), document.name
        assert not re.search(r"<!-- generated: [^>]+ -->\n<!-- end -->", text), document.name


def test_every_fault_is_explained(source):
    names = re.findall(r"\[MCT_FAULT_\w+\] =\s*\{\"(\w+)\"", (source / "src/control/supervisor.c").read_text())
    text = (source / "docs/control.md").read_text()
    assert len(names) > 5
    assert re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE) == names


def test_every_system_has_its_page_and_picture(source, mctau):
    for system in json.loads(mctau("list", "--json").stdout)["systems"]:
        page = source / "docs" / "systems" / f"{system['name']}.md"
        assert f"generated: parameters {system['name']}" in page.read_text()
        assert (source / "docs" / "images" / f"{system['name']}.svg").stat().st_size < 100_000


def test_the_program_that_is_missing_is_said(source, tmp_path):
    done = generate(source, tmp_path, "--check")
    assert done.returncode == 1 and "build it first" in done.stderr


def test_the_environment_that_is_missing_is_said(source, build, mctau, tmp_path):
    (tmp_path / "docs").mkdir()
    shutil.copy(source / "docs" / "generate", tmp_path / "docs")  # a root without build/venv
    done = generate(tmp_path, build)
    assert done.returncode == 1 and "build/venv" in done.stderr and "tools/setup" in done.stderr
    assert len(done.stderr.splitlines()) == 1
