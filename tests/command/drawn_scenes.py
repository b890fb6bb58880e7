"""Scenes drawn at random from what mctau list tells, and how far two runs are from each other."""

import csv
import math

SPAN = {"rad": 2.5, "rad/s": 4.0, "m": 0.3, "m/s": 1.5}  # of what a start is drawn from, about its default


def drawn(random_, system):
    """Overrides of a scene: effects, parameters, start, tick, perhaps an input."""
    sets = {}
    for effect in system["effects"]:
        if isinstance(effect["default"], bool) and random_.random() < 0.3:
            sets[f"effects.{effect['name']}"] = str(random_.random() < 0.5).lower()
    for field in system["parameters"]:
        default = field["default"]
        if isinstance(default, float | int) and not isinstance(default, bool) and default and random_.random() < 0.5:
            value = default * random_.uniform(0.6, 1.6)
            sets[f"parameters.{field['name']}"] = repr(min(max(value, field["minimum"]), field["maximum"]))
    for coordinate in system["coordinates"]:
        for field in (coordinate, coordinate["rate"]):
            if field["name"].startswith("rotation_"):  # a quaternion, which is given a length of 1
                sets |= {f"initial.attitude_{c}": repr(random_.uniform(-1, 1)) for c in "wxyz"}
                continue
            span = SPAN.get(field["unit"])
            if span and "default" in field:
                value = field["default"] + random_.uniform(-span, span)
                sets[f"initial.{field['name']}"] = repr(min(max(value, field["minimum"]), field["maximum"]))
    sets["scene.dt"] = random_.choice(["0.0005", "0.001", "0.002"])
    sets["scene.duration"] = random_.choice(["1.0", "2.0", "3.0"])
    if random_.random() < 0.5:
        sets |= {"input.kind": "sine", "input.amplitude": "1.0", "input.frequency": repr(random_.uniform(1, 8))}
    return sets


def words(sets):
    return [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]


def run_of(mctau, scene, sets, tmp_path):
    """States by tick, {name: [values]}; None when it did not run to its end."""
    path = tmp_path / "run.csv"
    path.unlink(missing_ok=True)
    done = mctau("run", scene, *words(sets), "--csv", path)
    if done.returncode not in (0, 1) or "iverged" in done.stdout:
        return None
    with open(path, encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    columns = list(zip(*rows))
    return {name: [float(cell) for cell in columns[i]] for i, name in enumerate(names[: names.index("mode")])}


def turned_away(a, b):
    """Angle between two attitudes."""
    w, v = sum(x * y for x, y in zip(a, b)), (
        a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
        a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3],
        a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1])  # fmt: skip
    return 2 * math.atan2(math.hypot(*v), abs(w))


def worst(exact, other, states, stride=1):
    """The error of mctau cost, by its definition and without its code, over the states that both runs have."""
    both = [name for name in states if name in exact and name in other]
    plain = [name for name in both if not name.startswith(("attitude", "base_angle_", "force_"))]
    turned = [f"attitude_{c}" for c in "wxyz"] if "attitude_w" in both else []
    largest = 0
    for name in plain:
        scale = max(1, *map(abs, exact[name]))
        largest = max(largest, *(abs(a - b) / scale for a, b in zip(exact[name][::stride], other[name])))
    if turned:
        pairs = zip(zip(*(exact[name][::stride] for name in turned)), zip(*(other[name] for name in turned)))
        largest = max(largest, *(turned_away(a, b) for a, b in pairs))
    return largest
