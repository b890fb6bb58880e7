"""`mctau compile`: what it writes is what init makes, compiled without a warning, and runs the same."""

import json
import os
import shlex
import subprocess

import pytest

FLAGS = ["-std=c99", "-O1", "-ffp-contract=off", "-ffunction-sections", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion",
         "-Wshadow", "-Wdouble-promotion", "-Werror"]
SANITIZE = os.environ.get("MCTAU_SANITIZE", "")
FLAGS += ["--coverage"] if SANITIZE == "coverage" else [f"-fsanitize={SANITIZE}"] if SANITIZE else []
LIBRARIES = {"float": "libmctau_f32.a", "double": "libmctau.a"}
# What the ready scenes do not use.
OTHERS = [
    ("cart_pole", ["controller.kind=none", "input.kind=steps", "input.times=[0, 0.5, 1]", "input.values=[1, -2.5, 0.1]"]),
    ("cart_pole", ["controller.kind=none", "input.kind=sine", "input.amplitude=3", "input.frequency=7", "scene.substeps=2"]),
    ("cart_pole", ["sensors.noise=0.5", "sensors.latency=3", "sensors.fault=silent", "sensors.fault_time=1",
                   "sensors.fault_duration=0.1", "sensors.counter_bits=16", "controller.rearm_after=0.2"]),
    ("reaction_wheel", ["effects.saturation=current", "effects.coulomb=moreau", "scene.stepper=rk4",
                        "variation.spread=0.1", "initial.arm_angle=9"]),
    ("reaction_wheel_free", ["scene.stride=4", "scene.stepper=taylor12"]),
    ("pendulum", ["initial.angle=20"]),
]  # fmt: skip


@pytest.fixture(scope="module")
def build_against(source, build):
    """build_against(FILE.c, precision): a program of it and against_init.c."""

    def run(file, precision):
        program = file.with_suffix("")
        includes = [f"-I{folder}" for folder in (source / "include", source, build / "include" / precision)]
        subprocess.run([*shlex.split(os.environ.get("CC", "cc")), *FLAGS, *includes, file,
                        source / "tests/compile/against_init.c", build / LIBRARIES[precision], "-lpthread", "-lrt",
                        "-Wl,--gc-sections", "-o", program], check=True)
        return program

    return run


def scenes(source):
    return sorted(path.stem for path in (source / "scenes").glob("*.toml"))


def compare(mctau, build_against, source, folder, scene, precision, assignments):
    text = source / "scenes" / f"{scene}.toml"
    file = folder / f"{scene}_{precision}.c"
    overrides = [word for assignment in assignments for word in ("--set", assignment)]
    done = mctau("compile", text, "--precision", precision, *overrides, "-o", file)
    assert done.returncode == 0 and done.stderr == "" and done.stdout == "", done.stderr
    program = build_against(file, precision)
    done = subprocess.run([program, f'scene.precision="{precision}"', *assignments], stdin=text.open(), capture_output=True,
                          text=True)
    assert done.returncode == 0, f"{scene}, {precision}, {assignments}: {done.stdout}{done.stderr}"


@pytest.mark.parametrize("precision", LIBRARIES)
def test_what_is_compiled_is_what_init_makes(mctau, build, build_against, source, tmp_path, precision):
    if not (build / LIBRARIES[precision]).exists():
        pytest.skip(f"this build has no {precision}")
    for scene in scenes(source):
        compare(mctau, build_against, source, tmp_path, scene, precision, [])


@pytest.mark.parametrize(("scene", "assignments"), OTHERS)
def test_other_tables_of_a_scene_are_compiled_as_well(mctau, build_against, source, tmp_path, scene, assignments):
    compare(mctau, build_against, source, tmp_path, scene, "double", assignments)


def test_a_scene_gives_the_same_text_each_time(mctau, source):
    first, again = (mctau("compile", source / "scenes/cart_pole.toml", "-o", "-").stdout for _ in range(2))
    assert first == again and "mct_compiled_loop" in first


def test_an_effect_more_is_another_kernel_and_no_other_is_named(mctau, source):
    text = mctau("compile", source / "scenes/cart_pole.toml", "--set", "scene.stepper=leap", "-o", "-").stdout
    assert text.count("mct_cart_pole_leap_") == 2  # its prototype, its use
    other = mctau("compile", source / "scenes/cart_pole.toml", "--set", "scene.stepper=leap", "--set",
                  "effects.viscous=false", "-o", "-").stdout
    name = [line for line in text.splitlines() if ".kernel" in line]
    assert name and name != [line for line in other.splitlines() if ".kernel" in line]


@pytest.mark.parametrize(("arguments", "code", "words"), [
    (["no.toml", "-o", "x.c"], 3, ["no.toml"]),
    (["{cart}"], 2, ["-o", "found none", "allowed"]),
    (["{cart}", "-o"], 2, ["-o", "needs an argument"]),
    (["{cart}", "-o", "{cart}"], 2, ["is the scene itself"]),
    (["{cart}", "-o", "no/such/folder/x.c"], 3, ["no/such/folder"]),
    (["{cart}", "--set", "scene.stepper=split3", "-o", "x.c"], 2, ["scene.stepper", "found split3", "allowed"]),
])  # fmt: skip
def test_what_is_wrong_is_said_and_nothing_is_written(mctau, source, tmp_path, arguments, code, words):
    cart = tmp_path / "cart.toml"
    cart.write_text((source / "scenes/cart_pole.toml").read_text())
    done = mctau("compile", *[word.format(cart=cart) for word in arguments], cwd=tmp_path)
    assert done.returncode == code
    assert all(word in done.stderr for word in words), done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["cart.toml"]
    assert cart.read_text() == (source / "scenes/cart_pole.toml").read_text()


# --- the program of the README ---


def test_the_firmware_of_the_readme_ends_where_a_run_does(mctau, source, build, tmp_path):
    if not (build / LIBRARIES["float"]).exists():
        pytest.skip("this build has no float")
    for scene in ("cart_pole", "reaction_wheel"):
        file = tmp_path / f"{scene}.c"
        assert mctau("compile", source / "scenes" / f"{scene}.toml", "--precision", "float", "-o", file).returncode == 0
        includes = [f"-I{folder}" for folder in (source / "include", source, build / "include/float")]
        program = tmp_path / scene
        subprocess.run([*shlex.split(os.environ.get("CC", "cc")), *FLAGS, *includes, source / "docs/examples/firmware.c", file,
                        source / "tests/compile/board_by_sim.c", build / LIBRARIES["float"], "-lpthread", "-lrt", "-o", program],
                       check=True)
        done = subprocess.run([program], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout
        run = json.loads(mctau("run", source / "scenes" / f"{scene}.toml", "--precision", "float", "--json").stdout)
        assert [float.fromhex(word) for word in done.stdout.split()] == list(run["state"].values()), scene
