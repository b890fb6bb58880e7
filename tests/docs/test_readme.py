"""What the README shows, works: its commands, its program, its scene, the files that it names."""

import json
import os
import re
import shlex
import subprocess

import pytest

NOT_RUN = re.compile(r"<!-- test: not run here: (.+?) -->\s*\Z")
BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)


@pytest.fixture(scope="module")
def readme(source):
    return (source / "README.md").read_text()


@pytest.fixture
def clone(source, build, tmp_path):
    """A folder that looks like a clone that was built, where commands may leave their files."""
    for entry in source.iterdir():
        if entry.name not in ("build", ".git"):
            (tmp_path / entry.name).symlink_to(entry)
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "host").symlink_to(build)
    return tmp_path


def blocks(readme, language):
    """(text, why it is not run or None) of each code block in a language."""
    found = []
    for match in BLOCK.finditer(readme):
        if match[1] == language:
            reason = NOT_RUN.search(readme[: match.start()])
            found.append((match[2], reason and reason[1]))
    assert found, f"the README has no block of {language}"
    return found


@pytest.mark.skipif(
    bool(os.environ.get("MCTAU_SANITIZE")), reason="the README's command line links no sanitizer"
)
def test_every_shell_command_of_the_readme_works(readme, clone, mctau):
    ran = 0
    for text, reason in blocks(readme, "sh"):
        if reason:
            continue
        for line in text.splitlines():
            done = subprocess.run(shlex.split(line), cwd=clone, capture_output=True, text=True, timeout=120)
            assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
            ran += 1
            if line.startswith("./minimal"):
                assert f"It prints:\n\n```text\n{done.stdout}```" in readme
    assert ran > 0


def test_commands_that_are_not_run_exist(readme, source):
    for text, reason in blocks(readme, "sh"):
        for line in text.splitlines() if reason else ():
            if line.startswith("./"):
                assert os.access(source / line.split()[0], os.X_OK), line


def test_the_programs_of_the_readme_are_the_committed_ones(readme, source):
    examples = [source / "docs/examples" / name for name in ("minimal.c", "firmware.c")]
    assert [text for text, _ in blocks(readme, "c")] == [example.read_text() for example in examples]


def test_the_scene_of_the_readme_balances(readme, mctau, tmp_path):
    scene = tmp_path / "scene.toml"
    ((text, _),) = blocks(readme, "toml")
    scene.write_text(text)
    done = mctau("run", scene, "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["verdict"] == "balanced", done.stderr


def documents(source):
    return [
        source / "README.md",
        source / "CHANGELOG.md",
        source / "CONTRIBUTING.md",
        *sorted((source / "docs").rglob("*.md")),
    ]


def test_every_file_that_a_document_links_to_exists(source):
    missing = []
    for document in documents(source):
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", document.read_text()):
            if "://" not in target and not (document.parent / target).exists():
                missing.append(f"{document.name}: {target}")
    assert not missing


def test_every_file_that_a_document_names_exists(source):
    """`folder/file` in a document is a path from the root, or what a command of it writes."""
    folders = "|".join(("src", "include", "hal", "tools", "tests", "scenes", "docs", "cmake", r"\.ci"))
    missing = []
    for document in documents(source):
        for name in re.findall(rf"(?<![\w/.-])((?:\./)?(?:{folders})/[\w./-]*[\w/])", document.read_text()):
            if not (source / name).exists():
                missing.append(f"{document.name}: {name}")
    assert not missing


def test_no_document_names_a_place_of_one_machine(source):
    for document in documents(source):
        assert not re.search(r"/(home|root|work|tmp)/", document.read_text()), document.name
