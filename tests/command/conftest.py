"""What the tests of the command share: scenes, and JSON read back."""

import json

import pytest


@pytest.fixture(scope="session", autouse=True)
def precisions(mctau):
    """The precisions of this build; the scenes ask for double."""
    names = mctau("--version").stdout.split("(")[1].strip(" )\n").split(", ")
    if "double" not in names:
        pytest.skip("the scenes ask for double, which this build has not")
    return names


@pytest.fixture(scope="session")
def both_precisions(precisions):
    if "float" not in precisions:
        pytest.skip("this build has one precision")


@pytest.fixture(scope="session")
def scenes(source):
    return source / "scenes"


@pytest.fixture
def result(mctau):
    """result("run", scene, ...): the object that --json prints, once it is certain that nothing else was said."""

    def run(*arguments, exit_code=0, **options):
        done = mctau(*arguments, "--json", **options)
        assert done.stderr == ""
        assert done.returncode == exit_code
        return json.loads(done.stdout)

    return run


@pytest.fixture(scope="session")
def logs(mctau, scenes, tmp_path_factory):
    """Skips where the build has no event log."""
    log = tmp_path_factory.mktemp("logs") / "probe.lcm"
    done = mctau("run", scenes / "cart_pole_free.toml", "--duration", "0.01", "--log", log)
    if "no LCM" in done.stderr:
        pytest.skip("this build has no LCM, so there is no event log")
    assert done.returncode == 0, done.stderr
