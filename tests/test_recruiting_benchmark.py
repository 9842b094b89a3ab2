"""The benchmark of recruits: its short run finds answers, which it checks itself."""

from __future__ import annotations

import pytest

from benchmarks.recruiting.services import made
from tests.benchmark import short_run


@pytest.mark.process
def test_the_short_run_finds_answers() -> None:
    assert "| 80 | 1 |" in short_run("benchmarks.recruiting")


def test_the_planted_services_are_enough_and_fewer_are_not_said_to_be() -> None:
    given = made(100, 3)
    planted = [name for name in given.services if name.startswith(("given", "planted"))]
    assert len(planted) == given.planted
    assert given.enough(planted)
    assert not given.enough([name for name in planted if name != "given"])
