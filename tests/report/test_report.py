"""The report and the demo: one page that stands alone; wrong input is refused in a sentence."""

import html.parser
import json
import os
import re
import shlex
import subprocess
import sys
import types
import xml.etree.ElementTree

import pytest

LIMIT = 1_500_000  # [bytes] of a page
PICTURE_LIMIT = 100_000  # [bytes]
WITHOUT_END = {"meta", "br", "img", "link", "hr", "input"}


class Page(html.parser.HTMLParser):
    """Elements that are open, and everything that would be loaded."""

    def __init__(self, text):
        super().__init__()
        self.open, self.loaded, self.texts, self.wrong = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag not in WITHOUT_END and tag not in ("tr", "td", "th"):
            self.open.append(tag)
        self.loaded += [value for name, value in attributes if name in ("src", "href", "data")]
        if tag in ("script", "link", "iframe", "img"):
            self.loaded.append(tag)

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)

    def handle_data(self, data):
        self.texts.append(data)


@pytest.fixture
def reported(source, build, mctau, tmp_path):
    """reported(scene, sets...) runs a scene and makes its report, or its picture."""

    def make(scene, *overrides, tool="report.py", change=lambda files: None, options=()):
        files = types.SimpleNamespace(
            csv=tmp_path / "run.csv",
            json=tmp_path / "run.json",
            page=tmp_path / "report.html",
            scene=source / "scenes" / scene,
        )
        sets = [part for override in overrides for part in ("--set", override)]
        run = mctau("run", files.scene, *sets, "--csv", files.csv, "--json")
        files.json.write_text(run.stdout)
        change(files)
        done = subprocess.run(
            [
                sys.executable,
                source / "tools/report" / tool,
                "--mctau",
                build / "mctau",
                "--csv",
                files.csv,
                "--json",
                files.json,
                "--scene",
                files.scene,
                *sets,
                *options,
                "-o",
                files.page,
            ],
            capture_output=True,
            text=True,
            timeout=60,
        )
        text = files.page.read_text() if files.page.exists() else ""
        return types.SimpleNamespace(
            done=done, text=text, page=Page(text), run=json.loads(run.stdout) if run.stdout else None
        )

    return make


SCENES = [
    ("reaction_wheel.toml", ()),
    ("cart_pole.toml", ()),
    ("reaction_wheel_free.toml", ()),
    ("cart_pole_free.toml", ()),
    ("cart_pole.toml", ("sensors.fault=nan", "sensors.fault_time=8")),
    ("reaction_wheel.toml", ("scene.duration=1",)),
    ("reaction_wheel.toml", ("scene.duration=0.002",)),
    ("reaction_wheel.toml", ("variation.spread=0.1", "sensors.noise=1")),
    ("cart_pole.toml", ("controller.kind=none", "input.kind=sine", "input.amplitude=5", "scene.duration=5")),
    ("cart_pole_free.toml", ("input.kind=constant", "input.value=1", "scene.duration=2")),
    ("cart_pole.toml", ("initial.pole_angle=0.05", "scene.duration=5", "effects.saturation=false")),
]


@pytest.mark.parametrize("scene,overrides", SCENES)
def test_a_page_stands_alone(reported, scene, overrides):
    made = reported(scene, *overrides)
    assert made.done.returncode == 0, made.done.stderr
    assert not made.page.loaded, "the page asks for something"
    assert not made.page.open and not made.page.wrong, "elements are not closed"
    assert len(made.text.encode()) < LIMIT
    assert not re.search(r"\bnan\b|\binf\b", re.sub(r"sensors\.fault=nan", "", " ".join(made.page.texts)))
    assert all(override in made.text for override in overrides), "the page does not say how to run it again"


def test_the_plots_are_the_same_bytes_again_in_the_colours_of_the_page(reported):
    runs = [reported("reaction_wheel.toml", "scene.duration=2") for _ in range(2)]
    plots = [re.findall(r'<figure class="plot">.*?</figure>', made.text, re.DOTALL) for made in runs]
    assert plots[0] == plots[1] and len(plots[0]) >= 5
    text = "".join(plots[0])
    assert not re.search(r"#[0-9a-f]{6}\b", text), "a colour that does not follow light and dark"
    assert set(re.findall(r"var\(--(\w+)\)", text)) <= set(re.findall(r"--(\w+):", runs[0].text))
    names = re.findall(r' id="([^"]*)"', text)
    assert len(names) == len(set(names)), "two things of one name"
    assert "voltage [V]" in runs[0].page.texts, "text has become curves"


@pytest.mark.parametrize("scene", ["reaction_wheel.toml", "cart_pole.toml"])
def test_a_picture_stands_alone_in_the_colours_of_the_page(reported, scene):
    pictures = [reported(scene, tool="picture.py") for _ in range(2)]
    text = pictures[0].text
    assert pictures[0].done.returncode == 0, pictures[0].done.stderr
    assert text == pictures[1].text and len(text.encode()) < PICTURE_LIMIT
    xml.etree.ElementTree.fromstring(text)
    style, drawn = re.fullmatch(r"<svg[^>]*><style>(.*?)</style>(.*)", text, re.DOTALL).groups()
    assert not re.search(r"#[0-9a-f]{6}\b", drawn), "a colour that does not follow light and dark"
    light, dark = style.split("@media (prefers-color-scheme: dark)")
    used = set(re.findall(r"var\(--(\w+)\)", text))
    for colours in (light, dark):
        assert {"limit", "swing_up", "balance"} <= used <= set(re.findall(r"--(\w+):", colours))
    names = re.findall(r' id="([^"]*)"', drawn)
    assert len(names) == len(set(names)), "two things of one name"
    assert {"voltage [V]", "supply"} <= set(pictures[0].page.texts), "text has become curves"
    assert "body" not in style, "rules of the page alone"


def test_the_works_of_the_effects_are_on_the_page_of_a_run_with_a_ledger(reported, mctau):
    def keep_ledger(files):
        run = mctau("run", files.scene, "--duration", "0.1", "--csv", files.csv, "--ledger", "--json")
        files.json.write_text(run.stdout)

    page = reported("cart_pole.toml", change=keep_ledger).text
    for name in ("Where the energy came from", "viscous", "resistance", "stepper", "unexplained"):
        assert name in page


def test_there_is_a_page_and_a_picture_of_every_system(reported, mctau):
    for system in json.loads(mctau("list", "--json").stdout)["systems"]:
        made = reported(f"{system['name']}.toml", "scene.duration=1.6")
        assert made.done.returncode == 0, made.done.stderr
        assert not made.page.loaded and not made.page.open and not made.page.wrong, system["name"]
        assert not re.search(r"\bnan\b|\binf\b", " ".join(made.page.texts)), system["name"]
        picture = reported(f"{system['name']}.toml", tool="picture.py")
        assert picture.done.returncode == 0, picture.done.stderr
        assert len(picture.text.encode()) < PICTURE_LIMIT
        xml.etree.ElementTree.fromstring(picture.text)


@pytest.mark.parametrize("tool", ["report.py", "picture.py"])
def test_without_matplotlib_a_sentence_says_where_it_is(source, tool):
    # -S: without the packages of the environment
    command = [sys.executable, "-S", source / "tools/report" / tool]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 3 and "matplotlib" in done.stderr and "tools/setup" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_fault_is_named_where_it_happened(reported):
    made = reported("cart_pole.toml", "sensors.fault=nan", "sensors.fault_time=8")
    text = " ".join(made.page.texts)
    assert "Faulted" in text and "sensor_invalid" in text and "8.000 s" in text


def test_the_verdict_and_the_times_are_those_of_the_run(reported):
    made = reported("reaction_wheel.toml", options=["--say"])
    assert "Balanced" in made.text and f"{made.run['upright_at']:.2f} s" in made.done.stdout


def test_the_energy_is_that_of_the_core(reported, source, build, mctau, tmp_path):
    sys.path.insert(0, str(source / "tools" / "report"))
    try:
        import run_data
    finally:
        sys.path.pop(0)
    for scene in ("cart_pole_free.toml", "reaction_wheel_free.toml", "reaction_wheel.toml"):
        made = reported(scene)
        run = run_data.Run(
            tmp_path / "run.csv",
            tmp_path / "run.json",
            source / "scenes" / scene,
            [],
            run_data.Command(str(build / "mctau")),
        )
        # 1e-12 J: rounding of energies below 1 J, in two orders of summation
        assert run.energy[0] == pytest.approx(made.run["energy_start"], abs=1e-12)


def drop_rows(files):
    files.csv.write_text("".join(files.csv.read_text().splitlines(keepends=True)[:100]))


def cut_row(files):
    files.csv.write_text(files.csv.read_text()[:-20])


def drop_header(files):
    files.csv.write_text("".join(files.csv.read_text().splitlines(keepends=True)[1:]))


def spoil_number(files):
    files.csv.write_text(re.sub(r"^0\.001,", "zero,", files.csv.read_text(), flags=re.MULTILINE))


def not_a_number(files):
    files.csv.write_text(re.sub(r"^0\.001,", "nan,", files.csv.read_text(), flags=re.MULTILINE))


@pytest.mark.parametrize(
    "change,code,says",
    [
        (lambda files: files.csv.unlink(), 3, "cannot be read"),
        (lambda files: files.csv.write_text(""), 2, "no column time"),
        (drop_rows, 2, "both must be of the same run"),
        (cut_row, 2, "the file has been cut"),
        (drop_header, 2, "no column time"),
        (spoil_number, 2, "allowed a number"),
        (not_a_number, 2, "allowed a finite number"),
        (lambda files: files.json.write_text("{"), 2, "not JSON"),
        (lambda files: files.json.write_text("[]"), 2, "mctau.run/1"),
        (lambda files: files.json.write_text('{"schema": "other/1"}'), 2, "other/1"),
        (lambda files: setattr(files, "scene", files.scene.with_name("cart_pole.toml")), 2, "another system"),
        (lambda files: setattr(files, "page", files.page / "no" / "folder.html"), 3, "cannot be written"),
    ],
)
def test_wrong_input_is_refused_in_a_sentence(reported, change, code, says):
    made = reported("reaction_wheel_free.toml", change=change)
    assert made.done.returncode == code, made.done.stderr
    assert says in made.done.stderr and "Traceback" not in made.done.stderr
    assert len(made.done.stderr.splitlines()) == 1


@pytest.fixture
def demo(source, build, mctau, tmp_path):
    def run(*arguments):
        return subprocess.run(
            [source / "tools/demo", "--out", tmp_path, *arguments],
            capture_output=True,
            text=True,
            timeout=120,
            env=os.environ | {"MCTAU": str(build / "mctau")},
        )

    return run


def test_the_demo_balances_and_its_advice_works(demo, source, tmp_path):
    done = demo()
    assert done.returncode == 0, done.stderr
    assert "Balanced." in done.stdout and "times real time" in done.stdout
    assert {"run.csv", "run.lcm", "run.json", "report.html"} <= {path.name for path in tmp_path.iterdir()}
    advice = [line.strip() for line in done.stdout.splitlines() if "mctau " in line and line.startswith("  ")]
    assert len(advice) >= 3
    for line in advice:
        tried = subprocess.run(shlex.split(line), cwd=source, capture_output=True, text=True, timeout=60)
        assert tried.returncode == 0, f"{line}\n{tried.stderr}"


def test_the_demo_ends_with_the_verdict_of_the_run(demo, tmp_path, source):
    short = tmp_path / "short.toml"
    short.write_text(
        (source / "scenes/cart_pole.toml").read_text().replace("duration = 30.0", "duration = 1.0")
    )
    assert demo(short).returncode == 1
    assert demo("scenes/cart_pole_free.toml").returncode == 0


def test_the_demo_says_what_it_cannot_do(demo):
    for arguments, code in ((["no.toml"], 3), (["--nonsense"], 2), (["--help"], 0)):
        assert demo(*arguments).returncode == code
