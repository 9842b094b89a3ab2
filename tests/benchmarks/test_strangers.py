"""The benchmark of strangers: its short run finds the same answers with and without them."""

from __future__ import annotations

import pytest

from benchmarks.strangers import Timed
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_finds_the_same_answers() -> None:
    printed = short_run("benchmarks.strangers")
    assert "| seconds | without | beside 10 strangers | more |" in printed
    assert printed.count("| living, ") == 3


def test_a_row_says_how_much_more_it_takes() -> None:
    assert Timed("configure", [1.0, 2.0, 1.5], [2.5, 2.0, 9.0]).row() == ["configure", "1.50", "2.50", "1.00"]
