"""mctau hard: the matrix stepper x case."""

import re

import pytest

VERDICTS = {"pass", "miss", "not finite", "refused", "not judged"}


def test_every_case_is_well_and_every_method_gives_a_figure_or_a_reason(result, source):
    found = result("hard", timeout=300)  # 10 s, five times that with sanitizers
    assert found["schema"] == "mctau.hard/1" and found["precision"] == "double"
    cases = found["cases"]
    assert {one["number"] for one in cases} >= set(range(1, 39))
    assert len({one["number"] for one in cases}) == len({one["rule"] for one in cases}) == len(cases)
    page = (source / "docs" / "hard-cases.md").read_text()
    for one in cases:
        methods = {done["method"]: done for done in one["methods"]}
        assert one["well"] and methods["naive"]["verdict"] in ("miss", "not finite")
        assert len(methods) in (2, 15) and list(methods)[-2:] == ["mctau", "naive"]
        for done in methods.values():
            assert done["verdict"] in VERDICTS
            assert (done["figure"] is None) == (done["verdict"] in ("refused", "not finite"))
            assert (done["verdict"] == "refused") == bool(done["why"])
        assert f"| {one['number']} | {one['rule']} |" in page  # which docs/generate has written


def test_the_table_is_readable_at_110_columns_and_tells_why_something_is_refused(mctau):
    done = mctau("hard", 1, 9, 27)
    assert done.returncode == 0 and done.stderr == ""
    assert max(map(len, done.stdout.splitlines())) <= 110
    assert re.search(r"^ +1 +\S+ +1e-08 +inf  a current", done.stdout, re.MULTILINE)
    assert re.search(r"^ +1 .* \d+e-\d\d\*", done.stdout, re.MULTILINE)  # what the scene gets
    assert re.search(r"^ +1  rk4 taylor4: follows an inductive motor", done.stdout, re.MULTILINE)
    assert "parameters.stiffness: found 100000000 N/m" in done.stdout
    assert done.stdout.endswith("Every case meets its criterion.\n")


def test_one_case_in_float_has_floats_own_criterion(result, both_precisions):
    double, single = (result("hard", 17, "--precision", name)["cases"][0] for name in ("double", "float"))
    assert single["well"] and single["criterion"] > double["criterion"]


@pytest.mark.parametrize("case", ["0", "999", "-1", "1x", "", "9999999999999999999999"])
def test_a_case_that_does_not_exist_is_refused_with_those_that_do(mctau, case):
    done = mctau("hard", "--", case)
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert f"found case {case}; allowed 1, 2, 3" in done.stderr


def test_a_precision_that_does_not_exist_is_refused(mctau):
    done = mctau("hard", "--precision", "half")
    assert done.returncode == 2 and "--precision: found half; allowed double" in done.stderr
