#!/usr/bin/env python3
"""heyoka (PyPI) beside mctau: adaptive Taylor steps of any order, compiled at run time, driven from Python.

usage: peer_heyoka.py REFERENCES SCENE SCENES [--quick]

As peers.c: the same lines on standard output. SCENES: what `benchmark_peer_mctau_f64 --scenes` prints, so that nothing
is written twice but the closed form. A free motion is one call, timed without the samples, which dense output reads in
a second one; under a held input there is one call a tick, and Python's part in it is counted.
"""

import json
import math
import pathlib
import statistics
import sys
import time

import heyoka
import numpy

TOLERANCES = [10.0**-n for n in range(2, 17)]


def closed_form(scene, p, u):
    names = ["x", "y", "z", "a", "b", "c", "d"][: scene["states"]]
    x = heyoka.make_vars(*names)
    x = x if isinstance(x, (list, tuple)) else [x]
    sin, cos = heyoka.sin, heyoka.cos
    if scene["form"] == "pendulum":
        m, l, g = p[:3]
        rates = [x[1], g / l * sin(x[0]) + u / (m * l * l)]
    elif scene["form"] == "spring":
        m, k, rest, g = p[:4]
        square = x[0] * x[0] + x[1] * x[1]
        pull = k * rest / m / heyoka.sqrt(square) - k / m
        turning = u / m / square
        rates = [x[2], x[3], pull * x[0] - turning * x[1], pull * x[1] + turning * x[0] - g]
    elif scene["form"] == "cart_pole":
        m1, m2, l, k1, k2, g = p[:6]
        s, c = sin(x[1]), cos(x[1])
        f1 = u + m2 * l * s * x[3] * x[3] - k1 * x[2]
        f2 = m2 * g * l * s - k2 * x[3]
        inverse = 1.0 / (m1 + m2 * s * s)
        rates = [x[2], x[3], inverse * (f1 - c / l * f2), inverse * ((m1 + m2) / (m2 * l * l) * f2 - c / l * f1)]
    elif scene["form"] == "wheel":
        mass, wheel, l, arm, moment, g, nu1, nu2, kt, kb, resistance, inductance = p[:12]
        torque = kt * x[4] - nu2 * x[3]
        a = ((moment + mass * l) * g * sin(x[0]) - nu1 * x[2] - torque) / (mass * l * l + arm)
        rates = [x[2], x[3], a, torque / wheel - a, (u - kb * x[3] - resistance * x[4]) / inductance]
    else:
        w = [each / 2.0 for each in x[4:]]
        rates = [
            -x[1] * w[0] - x[2] * w[1] - x[3] * w[2],
            x[0] * w[0] + x[2] * w[2] - x[3] * w[1],
            x[0] * w[1] + x[3] * w[0] - x[1] * w[2],
            x[0] * w[2] + x[1] * w[1] - x[2] * w[0],
            *[(p[(i + 1) % 3] - p[(i + 2) % 3]) / p[i] * x[4 + (i + 1) % 3] * x[4 + (i + 2) % 3] for i in range(3)],
        ]
    return list(zip(x, rates))


def main():
    quick = "--quick" in sys.argv
    references, name, scenes = sys.argv[1:4]
    table = json.loads(pathlib.Path(scenes).read_text(encoding="utf-8"))
    scene = next(each for each in table["scenes"] if each["name"] == name)
    rows = [line.split(":")[1].split() for line in pathlib.Path(references).read_text().splitlines()
            if line.startswith(name + ":")]
    states = scene["states"]
    reference = numpy.array([[float(value) for value in row[:states]] for row in rows])
    scale = numpy.maximum(1, abs(reference).max(axis=0))
    tick, per_sample = table["tick"], table["ticks_per_sample"]
    inputs = scene["inputs"]
    samples = numpy.empty_like(reference)
    grid = tick * per_sample * numpy.arange(len(rows) + 1)
    print(f"peer\theyoka\t{heyoka.__version__}")

    def run_free(solver):
        solver.propagate_until(grid[-1])

    def read_free(solver):
        samples[:] = solver.propagate_grid(grid)[-1][1:]

    def run_held(solver):
        propagate, pars, state = solver.propagate_for, solver.pars, solver.state
        for row in range(len(rows)):
            for k in range(row * per_sample, (row + 1) * per_sample):
                pars[0] = inputs[k]
                propagate(tick)
            samples[row] = state

    least = math.inf
    run, settings = (run_held, TOLERANCES[::4]) if scene["held"] else (run_free, TOLERANCES)
    for tolerance in TOLERANCES[2::6] if quick else settings:
        u = heyoka.par[0] if scene["held"] else 0.0
        solver = heyoka.taylor_adaptive(closed_form(scene, scene["parameters"], u), scene["start"], tol=tolerance,
                                        pars=[0.0] if scene["held"] else [])

        def start():
            solver.time = 0.0
            solver.state[:] = scene["start"]

        times = []
        for _ in range(3 if quick else 9):
            start()
            begin = time.thread_time_ns()
            run(solver)
            times.append(time.thread_time_ns() - begin)
        if not scene["held"]:
            start()
            read_free(solver)
        error = (abs(samples - reference) / scale).max()
        if not error < 1:
            continue
        cost = statistics.median(times) / table["ticks"]
        print(f"point\t{name}\ttaylor\ttolerance\t{tolerance:.6g}\t{error:.4g}\t{cost:.5g}", flush=True)
        if not error < 0.7 * least and least < 1e-9:
            break
        least = min(least, error)


if __name__ == "__main__":
    main()
