"""A run as the command left it: CSV rows, JSON result, scene. Every complaint is one sentence."""

import csv
import json
import math
import pathlib
import subprocess
import tomllib

USAGE, INPUT_OUTPUT = 2, 3  # exit codes, as those of mctau
ROOT = pathlib.Path(__file__).resolve().parents[2]
UPRIGHT = 2.0  # [deg] as in the command's verdict


class Complaint(Exception):
    """What is wrong with the input, for people; `code` is the exit code."""

    def __init__(self, sentence, code=USAGE):
        super().__init__(sentence)
        self.code = code


def read_text(path):
    try:
        return pathlib.Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise Complaint(f"{path}: the file cannot be read: {error.strerror}", INPUT_OUTPUT) from None
    except UnicodeDecodeError:
        raise Complaint(f"{path}: found bytes that are not UTF-8; allowed text") from None


def read_result(path):
    """The object that `mctau run --json` printed."""
    try:
        result = json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise Complaint(
            f"{path}:{error.lineno}: found what is not JSON; allowed the output of " "mctau run --json"
        ) from None
    schema = result.get("schema", "none") if isinstance(result, dict) else "none"
    if schema != "mctau.run/1":
        raise Complaint(f"{path}: found schema {schema}; allowed mctau.run/1, which mctau run --json prints")
    return result


def read_rows(path):
    """Columns by name: floats, but for the texts of mode and faults."""
    rows = csv.reader(read_text(path).splitlines())
    header = next(rows, [])
    for name in ("time", "applied", "mode", "faults"):
        if name not in header:
            raise Complaint(f"{path}:1: found no column {name}; allowed the CSV file of mctau run --csv")
    columns = [[] for _ in header]
    for line, row in enumerate(rows, start=2):
        if len(row) != len(header):
            raise Complaint(
                f"{path}:{line}: found {len(row)} fields; allowed {len(header)}: the file has been cut"
            )
        for column, text in zip(columns, row):
            column.append(text)
    if not columns[0]:
        raise Complaint(f"{path}: found no row below the headers; allowed one row a tick")
    table = dict(zip(header, columns))
    for name, texts in table.items():
        if name in ("mode", "faults"):
            continue
        try:
            table[name] = [float(text) for text in texts]
        except ValueError as error:
            raise Complaint(f"{path}: {name}: {error}; allowed a number") from None
        for line, value in enumerate(table[name], start=2):
            if not math.isfinite(value):
                raise Complaint(f"{path}:{line}: {name}: found {value}; allowed a finite number")
    return table


class Command:
    """The command, asked for what the core alone knows: defaults and energies."""

    def __init__(self, path):
        self.path = path

    def text(self, *arguments):
        try:
            done = subprocess.run([self.path, *arguments], capture_output=True, text=True, timeout=60)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise Complaint(f"{self.path}: the command cannot be run: {error}", INPUT_OUTPUT) from None
        if done.returncode != 0:
            raise Complaint(done.stderr.strip().removeprefix("mctau: "), done.returncode)
        return done.stdout.strip()

    def json(self, *arguments):
        return json.loads(self.text(*arguments, "--json"))


def value_of(text):
    """A value given from outside, typed as TOML would; a bare word is a text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


class Scene:
    """Values of a scene: the descriptors' defaults, the file's, then those given from outside."""

    def __init__(self, path, overrides, system, catalogue):
        self.path = str(path)
        self.overrides = list(overrides)
        self.text = read_text(path)
        try:
            given = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            raise Complaint(f"{path}: found what is not TOML: {error}") from None
        if given.get("scene", {}).get("system") != system["name"]:
            raise Complaint(
                f"{path}: found another system than that of the result, {system['name']}; "
                "allowed the scene that was run"
            )
        self.values = {
            table["name"]: {key["name"]: key.get("default") for key in table["keys"]}
            for table in catalogue["tables"]
        }
        self.values["parameters"] = {field["name"]: field["default"] for field in system["parameters"]}
        for rows in system.get("lists", []):
            flat = len(rows["columns"]) == 1
            self.values["parameters"][rows["name"]] = [row[0] if flat else row for row in rows["default"]]
        self.values["effects"] = {effect["name"]: effect["default"] for effect in system["effects"]}
        for table, keys in given.items():
            for name, value in keys.items():
                self._give(table, name, value)
        for override in self.overrides:
            key, equals, text = override.partition("=")
            table, dot, name = key.partition(".")
            if not equals or not dot:
                raise Complaint(f"--set: found {override}; allowed table.key=value")
            self._give(table.strip(), name.strip(), value_of(text.strip()))

    def _give(self, table, name, value):
        """A vector and a matrix give their components: target = [1, 2] is target_1 and target_2."""
        values = self.values.setdefault(table, {})
        if isinstance(value, list) and any(key.startswith(f"{name}_1") for key in values):
            for i, component in enumerate(value, start=1):
                self._give(table, f"{name}_{i}", component)
        else:
            values[name] = value

    def __call__(self, table, key):
        return self.values[table][key]

    @property
    def has_motor(self):
        return self.values["effects"].get("motor", "off") != "off"


class Run:
    """One run and what can be said of it."""

    def __init__(self, csv_path, json_path, scene_path, overrides, command):
        self.command = command
        self.result = read_result(json_path)
        catalogue = command.json("list")
        systems = {system["name"]: system for system in catalogue["systems"]}
        name = self.result.get("system")
        if name not in systems:
            raise Complaint(f"{json_path}: found system {name}; allowed {', '.join(systems)}")
        self.system = systems[name]
        self.name = name
        self.table = read_rows(csv_path)
        self.scene = Scene(scene_path, overrides, self.system, catalogue)
        missing = [state for state in self.result["state"] if state not in self.table]
        if missing:
            raise Complaint(f"{csv_path}: found no column {missing[0]}; allowed the CSV file of the same run")
        self.time = self.table["time"]
        if len(self.time) != self.result["ticks"]:
            raise Complaint(
                f"{csv_path}: found {len(self.time)} rows; allowed {self.result['ticks']}, the ticks of "
                f"{json_path}: both must be of the same run"
            )
        self.duration = self.result["time"]
        coordinates = self.system["coordinates"]
        self.angle = next((c for c in coordinates if c["name"] == self.system.get("upright_coordinate")), None)
        if self.angle is None:  # no motor: the first angle, if there is one
            self.angle = next((c for c in coordinates if c["is_angle"]), None)
        self.angle_name = self.angle and self.angle["name"]
        self.rate_names = [coordinate["rate"]["name"] for coordinate in coordinates if "rate" in coordinate]
        self.is_process = not self.rate_names
        self.degrees = [folded(math.degrees(angle)) for angle in self.table.get(self.angle_name, [])]
        self.controlled = f"{self.angle_name}_estimate" in self.table
        self.modes = spans(self.time, self.table["mode"], self.duration)
        self.faults = first_faults(self.time, self.table["faults"])
        self.energy = None  # at each tick: of the systems with a motor
        if "upright_coordinate" in self.system:
            self._energies()

    def _energies(self):
        """Total energy at each tick, from the mass matrix and the potential energy that `mctau mct` shows."""
        sets = [part for override in self.scene.overrides for part in ("--set", override)]
        # Upright, M is all that a kinetic energy needs; aside, its off-diagonal entry tells how it turns.
        at = lambda angle: self.command.json(
            "mct", self.scene.path, *sets, "--set", f"initial.{self.angle_name}={angle}"
        )
        upright, level = at(0), at(math.pi / 2)
        M, aside = upright["M"], level["M"]
        self.upright_energy = upright["energies"]["potential"]
        v1, v2 = (self.table[name] for name in self.rate_names)
        inductance = self.scene("parameters", "inductance")
        current = self.table.get("current", [0.0] * len(self.time))
        self.energy = []
        for angle, a, b, i in zip(self.table[self.angle_name], v1, v2, current):
            c = math.cos(angle)
            m12 = aside[0][1] + (M[0][1] - aside[0][1]) * c
            kinetic = 0.5 * (M[0][0] * a * a + M[1][1] * b * b) + m12 * a * b
            self.energy.append(kinetic + self.upright_energy * c + 0.5 * inductance * i * i)

    @property
    def is_varied(self):
        """A varied plant has other masses than the scene says: then the energy is the model's."""
        return float(self.scene("variation", "spread") or 0) > 0

    @property
    def last_balance(self):
        """The last stretch of balancing; None when there is none."""
        return next((span for span in reversed(self.modes) if span.mode == "balance"), None)

    @property
    def caught_at(self):
        """When the balancing began that lasts to the end; None when it does not."""
        last = self.modes[-1]
        return last.begin if last.mode == "balance" else None

    def worst_degrees(self, begin, end=math.inf):
        return max((abs(d) for t, d in zip(self.time, self.degrees) if begin <= t <= end), default=math.nan)

    def rms_degrees(self, begin):
        squares = [d * d for t, d in zip(self.time, self.degrees) if t >= begin]
        return math.sqrt(sum(squares) / len(squares)) if squares else math.nan

    def turning_points(self, begin, end):
        """Times at which the pendulum changes its direction."""
        rates = self.table[self.angle["rate"]["name"]] if self.angle and "rate" in self.angle else []
        return [
            self.time[i]
            for i in range(1, len(rates))
            if begin <= self.time[i] <= end and (rates[i] > 0) != (rates[i - 1] > 0)
        ]

    def at(self, time):
        """Index of the row at a time."""
        return max(0, min(len(self.time) - 1, round(time / self.result["dt"])))


class Span:
    def __init__(self, mode, begin, end):
        self.mode, self.begin, self.end = mode, begin, end


def spans(times, modes, end):
    """Stretches of one mode."""
    found = [Span(modes[0], times[0], end)]
    for time, mode in zip(times, modes):
        if mode != found[-1].mode:
            found[-1].end = time
            found.append(Span(mode, time, end))
    return found


def first_faults(times, faults):
    """(time, name) of the first tick on which each fault is latched."""
    seen = {}
    for time, names in zip(times, faults):
        for name in names.split("+") if names else ():
            seen.setdefault(name, time)
    return sorted((time, name) for name, time in seen.items())


def words(name):
    return name.replace("_", " ")


def folded(degrees):
    """Within -180 to 180."""
    return (degrees + 180) % 360 - 180


def decimated(times, values, begin, end, columns):
    """Points of a line, the smallest and the largest of a column: what is left out lies between them."""
    if len(times) <= 2 * columns:
        return list(zip(times, values))
    points = []
    scale = columns / (end - begin)
    i = 0
    while i < len(times):
        column = int((times[i] - begin) * scale)
        low = high = i
        j = i
        while j < len(times) and int((times[j] - begin) * scale) == column:
            low = j if values[j] < values[low] else low
            high = j if values[j] > values[high] else high
            j += 1
        points += [(times[k], values[k]) for k in sorted({low, high})]
        i = j
    return points
