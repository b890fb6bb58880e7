"""tools/bench --peers: its tables and pictures and, where it has been built, a run of two scenes. No speed is judged."""

import json
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools/benchmark"
sys.path.insert(0, str(TOOLS))

import central  # noqa: E402
import diagrams  # noqa: E402
import peers  # noqa: E402

SCENES = [{"name": "cart_pole held", "doc": "under a force", "held": True}]


def point(program, method, error, cost, **setting):
    return {"scene": "cart_pole held", "program": program, "method": method, "error": error, "ns_per_ms": cost} | setting


POINTS = [
    point("mctau", "rk4", 1e-8, 40, step=1e-3),
    point("mctau", "leap", 1e-3, 25, step=1e-3),
    point("GSL", "rk8pd", 1e-9, 120, tolerance=1e-6),
    point("GSL", "rk4", 1e-3, 10, step=1e-3),
]


def test_the_cheapest_of_those_that_keep_the_tolerance_is_found():
    assert peers.cheapest(POINTS, "cart_pole held", ["mctau"], 1e-2)["method"] == "leap"
    assert peers.cheapest(POINTS, "cart_pole held", ["mctau"], 1e-4)["method"] == "rk4"
    assert peers.cheapest(POINTS, "cart_pole held", ["mctau"], 1e-12) is None


def test_a_table_has_the_ratio_of_the_best_peer_to_ours(capsys):
    peers.tables(SCENES, POINTS, ["mctau", "GSL"], False)
    rows = {cells[2]: cells for cells in ([cell.strip() for cell in line.split("|")]
                                          for line in capsys.readouterr().out.splitlines() if line.startswith("|"))}
    assert rows["1e-02"][3:-1] == ["25", "`leap`, 1 ms", "10", "GSL rk4", "0.4"]
    assert rows["1e-06"][3:-1] == ["40", "`rk4`, 1 ms", "120", "GSL rk8pd", "3"]
    assert rows["1e-12"][3:-1] == ["-", "", "-", "", ""]


def test_mujocos_rk4_stands_beside_our_cheapest_at_its_own_error(capsys):
    theirs = [point("MuJoCo", "RK4", 1e-6, 2000, step=1e-3), point("MuJoCo", "RK4", 1e-9, 9000, step=2e-4),
              point("MuJoCo", "Euler", 1e-2, 500, step=1e-3)]  # fmt: skip
    rows = peers.beside_mujoco(SCENES, POINTS + theirs)
    assert [(row["mujoco"]["step"], row["mctau"] and row["mctau"]["method"], row["ratio"]) for row in rows] == [
        (1e-3, "rk4", 50), (2e-4, None, None)]  # fmt: skip
    peers.mujoco_table(rows, True)
    assert "| cart_pole | 1 ms | 1.0e-06 | 2000 | 40 | `rk4`, 1 ms | 1.0e-08 | 50 |" in capsys.readouterr().out
    assert peers.beside_mujoco(SCENES, POINTS) == [{"scene": "cart_pole held", "mujoco": None, "mctau": None, "ratio": None}]


def test_the_goals_of_the_central_systems_are_judged_by_their_figures(capsys):
    errors = {("double", scene, stepper): error for scene in central.MOTORS for stepper, error in (("rk4", 1e-6), ("expo", 1e-9))}
    times = {key: 60 if key[2] == "rk4" else 70 for key in errors}
    errors["double", "wheel_10_us_held", "rk4"] = float("inf")
    del times["double", "wheel_10_us_held", "rk4"]
    central.motors(errors, times, "double")
    said = capsys.readouterr().out
    assert "| 10 us | refused | 1e-09, 1.17 |" in said and "1.0e-09 at 1.17 times" in said and said.rstrip().endswith("met.")
    central.motors(errors, times | {("double", "wheel_0_held", "expo"): 90}, "double")
    assert "NOT met" in capsys.readouterr().out


def test_compensation_is_judged_by_one_stepper_of_each_system(capsys):
    errors = {(name, scene, stepper): error for name in ("float", "plain") for scene in central.FLOATS
              for stepper, error in (("leap", 1e-4), ("rk4", 1e-7), ("expo", 2e-7))}  # fmt: skip
    central.floats(errors, {key: 55 if key[0] == "float" else 50 for key in errors})
    said = capsys.readouterr().out
    assert "`rk4` within 1.0e-07 at 1.10 times" in said and "`expo` within 2.0e-07 at 1.10 times" in said


def test_programs_that_compute_different_motions_are_told():
    assert peers.same(SCENES, POINTS)
    assert not peers.same(SCENES, [each for each in POINTS if each["method"] != "rk8pd"])


def test_a_front_rises_with_accuracy():
    worse = point("GSL", "rkf45", 1e-4, 500, tolerance=1e-3)
    assert [each["method"] for each in diagrams.front([*POINTS[2:], worse])] == ["rk8pd", "rk4"]


def built():
    for build in [os.environ.get("MCTAU_BUILD", ""), ROOT / "build/bench"]:
        if pathlib.Path(build, "tools/benchmark/references.txt").exists():
            return build
    return None


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    return tmp_path_factory.mktemp("pictures")


@pytest.fixture(scope="module")
def measured(pictures):
    if built() is None:
        pytest.skip("tools/bench --peers has not been built here: tools/bench --peers --quick does it")
    done = subprocess.run(
        [sys.executable, TOOLS / "peers.py", built(), "--quick", "--json", "--pictures", pictures,
         "--scene", "wheel 1 ms held", "--scene", "body free"],
        capture_output=True, text=True, timeout=250)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_quick_run_has_points_of_every_program_that_is_there(measured):
    assert measured["schema"] == "mctau.peers/1"
    for scene in ["wheel 1 ms held", "body free"]:
        found = {each["program"] for each in measured["points"] if each["scene"] == scene}
        assert found == set(measured["versions"]), (scene, measured["missing"])
    assert set(peers.PEERS) <= set(measured["versions"]) | set(measured["missing"])


def test_all_points_are_motions(measured):
    for each in measured["points"]:
        assert 0 < each["error"] < 1 and each["ns_per_ms"] > 0 and ("step" in each) != ("tolerance" in each)


def test_a_picture_is_drawn_of_every_scene(measured, pictures):
    names = sorted(path.name for path in pictures.glob("*.svg"))
    assert names == ["peers-body-free.svg", "peers-wheel-1-ms-held.svg"]
    for name in names:
        text = (pictures / name).read_text(encoding="utf-8")
        assert "worst error over 10 s" in text and "mctau rk4" in text


def test_an_unknown_scene_is_refused():
    if built() is None:
        pytest.skip("tools/bench --peers has not been built here: tools/bench --peers --quick does it")
    command = [sys.executable, TOOLS / "peers.py", built(), "--scene", "cart"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and "allowed pendulum free" in done.stderr
