"""The benchmark of recruits: its short run finds answers, which it checks itself."""

from __future__ import annotations

import pytest

from benchmarks.recruiting.services import FAMILIES
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_finds_answers() -> None:
    assert "| decoys | 40 | 1 |" in short_run("benchmarks.recruiting")


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("number", [300, 604])
def test_the_planted_services_are_enough_and_fewer_are_not_said_to_be(family: str, number: int) -> None:
    given = FAMILIES[family](number, 3)
    assert len(given.services) == number
    # Where several services offer one step, the first of them is enough.
    planted = ["given", *(name for name in given.services if name.startswith("planted"))]
    if family == "contest":
        planted = [name for name in planted if name.endswith(".0") or name == "given"]
    assert len(planted) == given.planted
    assert given.enough(planted)
    assert not given.enough([name for name in planted if name != "given"])
