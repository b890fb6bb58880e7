"""The controller's gains against scipy: matrix exponential and discrete Riccati equation by other means."""

import json
import os
import pathlib
import random
import shlex
import shutil
import subprocess

import numpy
import pytest
import scipy.linalg

SEED = 20240301
CHANGED = {
    "cart_pole": ["cart_mass", "pole_mass", "pole_length", "cart_friction", "torque_constant", "resistance"],
    "reaction_wheel": ["wheel_mass", "wheel_inertia", "arm_inertia", "arm_moment", "torque_constant",
                       "resistance"],
}
DEFAULTS = {"cart_mass": 0.758, "pole_mass": 0.175, "pole_length": 0.434, "cart_friction": 4.3,
            "wheel_mass": 0.085, "wheel_inertia": 2.495e-5, "arm_inertia": 3.201e-3, "arm_moment": 0.025384}
MOTOR = {"cart_pole": {"torque_constant": 0.00767, "resistance": 2.6},
         "reaction_wheel": {"torque_constant": 0.0274, "resistance": 12.1}}


@pytest.fixture(scope="module")
def dump(source, build, tmp_path_factory):
    """dump(lines) gives the model, weights and gains of each scene; linked with the library under test."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    library = build / "libmctau.a"
    if shutil.which(compiler[0]) is None or not library.exists():
        pytest.skip("no C compiler, or no library in double precision")
    program = tmp_path_factory.mktemp("lqr") / "lqr_dump"
    includes = [f"-I{folder}" for folder in (source / "include", source, build / "include" / "double")]
    sanitize = os.environ.get("MCTAU_SANITIZE", "")
    flags = ["-std=gnu99", "-O1"]
    flags += ["--coverage"] if sanitize == "coverage" else [f"-fsanitize={sanitize}"] if sanitize else []
    file = pathlib.Path(__file__).parent / "lqr_dump.c"
    subprocess.run([*compiler, *flags, *includes, file, library, "-o", program], check=True)

    def run(lines):
        feed = "\n".join(lines) + "\n"
        result = subprocess.run([program], input=feed, capture_output=True, text=True, check=True)
        return [json.loads(line) for line in result.stdout.splitlines()]

    return run


def gains_by_scipy(scene):
    A = numpy.array(scene["A"]).reshape(4, 4)
    B = numpy.array(scene["B"]).reshape(4, 1)
    generator = numpy.zeros((5, 5))
    generator[:4, :4] = A * scene["dt"]
    generator[:4, 4:] = B * scene["dt"]
    flow = scipy.linalg.expm(generator)
    A, B = flow[:4, :4], flow[:4, 4:]
    Q = numpy.diag(1 / numpy.array(scene["weights"]) ** 2)
    R = numpy.array([[scene["input_weight"] / scene["limit"] ** 2]])
    P = scipy.linalg.solve_discrete_are(A, B, Q, R)
    K = numpy.linalg.solve(R + B.T @ P @ B, B.T @ P @ A)
    assert max(abs(numpy.linalg.eigvals(A - B @ K))) < 1
    return K[0]


def scenes():
    """Both defaults, then changed parameters, ticks and weights."""
    lines = ["cart_pole", "reaction_wheel"]
    numbers = random.Random(SEED)
    for trial in range(100):
        system = ("cart_pole", "reaction_wheel")[trial % 2]
        words = [system, "effects.motor=quasi_static",
                 f"scene.dt={numbers.choice([0.0005, 0.001, 0.002, 0.004])}",
                 f"controller.input_weight={numbers.uniform(0.2, 5):.6g}"]
        for name in CHANGED[system]:
            value = MOTOR[system].get(name, DEFAULTS.get(name))
            words.append(f"parameters.{name}={value * numbers.uniform(0.6, 1.6):.9g}")
        lines.append(" ".join(words))
    return lines


def test_gains_are_those_of_scipy_also_for_changed_parameters(dump):
    results = dump(scenes())
    assert len(results) == 102
    worst = 0
    for scene in results:
        expected = gains_by_scipy(scene)
        # scipy's own error: the equation is conditioned by some 1e6 where a position costs little
        error = max(abs(numpy.array(scene["K"]) - expected) / max(abs(expected)))
        entries = max(abs(numpy.array(scene["K"]) / expected - 1))
        worst = max(worst, error, entries)
        assert error < 1e-7
        assert entries < 1e-5
    print(f"largest relative difference {worst:.1e}")
