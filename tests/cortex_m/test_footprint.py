"""Flash, RAM, stack and instructions of the images: none grows by more than 5 % without a line in the changelog."""

import footprint
import pytest


@pytest.fixture(scope="module")
def known():
    return footprint.committed()


@pytest.mark.parametrize("row", footprint.rows(), ids=lambda row: f"{row.scene} {row.changes} {row.image} {row.target}")
def test_an_image_takes_no_more_than_the_table_says(emulator, mctau, known, row):
    figures, _ = known
    assert row in figures, "new: tools/footprint --write"
    words = footprint.grown(figures[row], footprint.measure(row))
    assert not words, f"{', '.join(words)}: tools/footprint --write --why SENTENCE, which CHANGELOG.md has to hold"


def test_the_last_growth_stands_in_the_changelog(source, known):
    _, why = known
    assert why and why in (source / "CHANGELOG.md").read_text()
