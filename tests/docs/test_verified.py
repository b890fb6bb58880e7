"""docs/verified.md names tests that there are."""

import os
import pathlib
import re

SOURCE = pathlib.Path(os.environ["MCTAU_SOURCE"])


def test_every_test_that_the_page_of_claims_names_is_there():
    files = [path for end in ("c", "py") for path in (SOURCE / "tests").rglob(f"test_*.{end}")]
    known = {path.stem for path in files} | {re.sub(r"_f\d\d$", "", path.stem) for path in files}
    for path in files:
        known |= set(re.findall(r"\b(?:void|def) (test_\w+)\(", path.read_text()))
    named = set(re.findall(r"`(test_\w+)`", (SOURCE / "docs/verified.md").read_text()))
    assert named, "the page names no test"
    assert named <= known, f"no such test: {sorted(named - known)}"
