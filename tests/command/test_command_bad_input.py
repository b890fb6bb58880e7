"""What is wrong is refused with a sentence, an exit code, and nothing left behind."""

import os

import pytest

SCENE = """\
[scene]
system = "cart_pole"
duration = 0.01
[parameters]
pole_mass = 0.2
[controller]
kind = "swing_up_balance"
"""

# What is appended to, or replaced in, the scene; what the sentence must contain.
BAD_SCENES = {
    "unknown key": ("pole_mass", "pole_mas", ["scene.toml:5", "pole_mas", "pole_mass"]),
    "unknown table": ("[parameters]", "[parameter]", ["scene.toml:4", "parameter", "parameters"]),
    "wrong type": ("0.2", '"heavy"', ["scene.toml:5", "parameters.pole_mass", "heavy", "number"]),
    "out of range": ("0.2", "-0.2", ["scene.toml:5", "parameters.pole_mass", "-0.2", "kg", "1e-06"]),
    "not a number": ("0.2", "nan", ["scene.toml:5", "parameters.pole_mass", "nan"]),
    "infinite": ("0.2", "inf", ["scene.toml:5", "parameters.pole_mass", "inf"]),
    "unknown system": ("cart_pole", "acrobot", ["scene.toml:2", "scene.system", "acrobot", "cart_pole", "reaction_wheel"]),
    "no system": ('system = "cart_pole"', "", ["scene.toml", "scene.system", "cart_pole"]),
    "unsuited stepper": ("duration", 'stepper = "expo"\nduration', ["scene.toml:3", "scene.stepper", "expo", "rk4"]),
    "syntax": ("= 0.2", "0.2", ["scene.toml:5"]),
    "twice": ("pole_mass = 0.2", "pole_mass = 0.2\npole_mass = 0.3", ["scene.toml:6", "pole_mass"]),
    "part of a tick": ("0.01", "0.0105", ["scene.toml:3", "scene.duration", "0.0105"]),
    "controller and input": ("[controller]", '[input]\nkind = "constant"\n[controller]', ["controller.kind", "[input]"]),
    "unknown hal": ("duration", 'hal = "warp"\nduration', ["scene.hal", "warp", "sim"]),
}


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def refused(done, exit_code, *words):
    assert done.returncode == exit_code, done.stderr
    assert done.stdout == ""
    assert done.stderr.startswith("mctau: ")
    for word in words:
        assert word in done.stderr, done.stderr


@pytest.mark.parametrize("case", BAD_SCENES)
@pytest.mark.parametrize("verb", ["run", "mct"])
def test_a_bad_scene_is_refused_with_line_key_found_and_allowed(mctau, scene, tmp_path, case, verb):
    old, new, words = BAD_SCENES[case]
    if verb == "mct" and case == "unknown hal":
        return  # which nothing opens there
    assert old in SCENE
    scene.write_text(SCENE.replace(old, new, 1))
    outputs = ["--csv", tmp_path / "run.csv", "--log", tmp_path / "run.lcm"] if verb == "run" else []
    done = mctau(verb, scene, "--json", *outputs)
    refused(done, 2, *words)
    assert len(done.stderr.splitlines()) == 1
    assert os.listdir(tmp_path) == ["scene.toml"]


@pytest.mark.parametrize("arguments, words", [
    (["--set", "parameters.pole_mas=1"], ["--set", "pole_mas", "pole_mass"]),
    (["--set", "parameters.pole_mass=-1"], ["--set", "parameters.pole_mass", "-1", "kg"]),
    (["--set", "nonsense"], ["--set", "nonsense"]),
    (["--set", "telemetry.log=a\nb"], ["--set", "line break"]),
    (["--duration", "nan"], ["--duration", "nan"]),
    (["--duration", "-1"], ["--duration", "-1"]),
    (["--dt", "0"], ["--dt", "0 s"]),
    (["--stepper", "rk5"], ["--stepper", "rk5", "rk4"]),
    (["--precision", "half"], ["--precision", "half", "double, float"]),
    (["--hal", "warp"], ["scene.hal", "warp", "sim"]),
    (["--csv", ""], ["--csv", "empty"]),
    (["--csv", "-"], ["--csv", "--json"]),
    (["--bogus"], ["--bogus", "--help"]),
    (["--csv"], ["--csv", "needs an argument"]),
    (["--json=yes"], ["--json=yes", "takes no argument"]),
    (["another.toml"], ["another.toml"]),
])  # fmt: skip
def test_a_bad_option_is_refused_by_its_name(mctau, scene, tmp_path, arguments, words):
    refused(mctau("run", scene, "--json", *arguments, cwd=tmp_path), 2, *words)
    assert os.listdir(tmp_path) == ["scene.toml"]


def test_a_missing_scene_is_an_error_of_input(mctau, tmp_path):
    refused(mctau("run", tmp_path / "none.toml"), 3, "none.toml", "No such file")
    refused(mctau("mct", tmp_path), 3, "directory")


def test_without_a_scene_the_command_tells_how_it_is_used(mctau):
    for verb in ("run", "mct", "replay"):
        done = mctau(verb)
        refused(done, 2, f"usage: mctau {verb}", "--help")


def test_an_unknown_verb_is_refused_with_the_list_of_verbs(mctau):
    refused(mctau("fly"), 2, "fly", "run", "replay")
    done = mctau()
    assert done.returncode == 2
    assert "usage: mctau" in done.stderr


@pytest.mark.parametrize("verb", ["run", "mct", "list", "replay"])
def test_help_teaches_and_exits_with_0(mctau, verb):
    done = mctau(verb, "--help")
    assert done.returncode == 0
    assert done.stderr == ""
    for word in ("usage", "Options", "Examples", "Exit codes", "--json"):
        assert word in done.stdout


@pytest.mark.parametrize("option", ["--csv", "--log"])
def test_an_output_that_cannot_be_written_leaves_nothing_behind(mctau, scene, tmp_path, option, logs):
    other = {"--csv": "--log", "--log": "--csv"}[option]
    done = mctau("run", scene, "--json", option, tmp_path / "none" / "x", other, tmp_path / "other")
    refused(done, 3, "none/x", "No such file")
    assert os.listdir(tmp_path) == ["scene.toml"]


@pytest.mark.parametrize("option", ["--csv", "--log"])
def test_an_output_never_overwrites_the_scene(mctau, scene, option):
    refused(mctau("run", scene, option, scene), 2, "scene.toml")
    assert scene.read_text() == SCENE


def test_csv_and_log_must_be_two_files(mctau, scene, tmp_path):
    refused(mctau("run", scene, "--csv", tmp_path / "x", "--log", tmp_path / "x"), 2, "--csv", "log")
    assert os.listdir(tmp_path) == ["scene.toml"]


def test_a_real_time_run_whose_rows_do_not_fit_is_refused(mctau, scene, tmp_path):
    refused(mctau("run", scene, "--realtime", "--duration", "1e7", "--csv", tmp_path / "x"), 2, "--csv", "--log")
    assert os.listdir(tmp_path) == ["scene.toml"]


# --- the input's CSV file ---

OPEN_LOOP = """\
[scene]
system = "cart_pole"
duration = 0.01
[input]
kind = "csv"
file = "in.csv"
column = "volts"
"""


@pytest.mark.parametrize("text, exit_code, words", [
    ("time,volts\n0,1\n1,nan\n", 2, ["in.csv:3", "volts", "nan", "not finite"]),
    ("time,volts\n0,1\n1,inf\n", 2, ["in.csv:3", "volts", "inf", "not finite"]),
    ("time,volts\n0,1\n1,2e9\n", 2, ["in.csv:3", "volts", "2e9", "1e+09"]),
    ("time,volts\n0,x\n", 2, ["in.csv:2", "volts", "found x", "number"]),
    ("time,volts\n0,\n", 2, ["in.csv:2", "volts", "found nothing"]),
    ("time,volts\n0,1\n1\n", 2, ["in.csv:3", "volts", "1 field", "at least 2"]),
    ("time,voltage\n0,1\n", 2, ["in.csv:1", "volts", "time, voltage"]),
    ("time,volts\n", 2, ["in.csv", "no row"]),
    ("", 2, ["in.csv", "empty"]),
    ('time,volts\n0,"1\n', 2, ["in.csv", "quote"]),
    (None, 3, ["in.csv", "No such file"]),
])  # fmt: skip
def test_a_bad_csv_input_is_refused_with_file_and_line(mctau, tmp_path, text, exit_code, words):
    scene = tmp_path / "scene.toml"
    scene.write_text(OPEN_LOOP)
    if text is not None:
        (tmp_path / "in.csv").write_text(text)
    before = sorted(os.listdir(tmp_path))
    refused(mctau("run", scene, "--csv", tmp_path / "run.csv", cwd="/"), exit_code, *words)
    assert sorted(os.listdir(tmp_path)) == before


def test_a_csv_input_needs_a_file_and_a_column(mctau, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(OPEN_LOOP.replace('column = "volts"\n', ""))
    refused(mctau("run", scene), 2, "input.column")
