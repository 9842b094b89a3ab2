"""The inside of a composite has the rank of the tasks outside."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.configurator import Phase
from tests.composites.eye import EYE, eye, looking
from tests.lab import Lab


def rank_inside(lab: Lab) -> tuple[int, float]:
    """The rank of the task inside of the composite, as the component inside knows it."""
    (hold,) = lab.runtimes["lens"].activation.holds
    return hold.claim.priority, hold.claim.beginning


@pytest.mark.parametrize("priorities", [(0, 3), (3, 0)])
def test_the_inside_of_a_composite_has_the_rank_of_the_first_of_those_that_share_it(
    tmp_path: Path, priorities: tuple[int, int]
) -> None:
    lab = eye(tmp_path)
    first, second = (looking(lab, sink, of) for sink, of in zip(("Low", "High"), priorities, strict=True))
    low, high = sorted((first, second), key=lambda one: one.identity.priority)
    assert rank_inside(lab) == (3, high.identity.beginning)
    (inside,) = lab.composites["home"].living.values()
    assert inside.runner is not None
    assert inside.runner.status().priority == 3
    middle = looking(lab, "Middle", 1, "Lens")
    assert (low.state.phase, high.state.phase) == (Phase.RUNNING, Phase.RUNNING)
    assert middle.state.phase is Phase.REFUSED
    assert lab.components["lens"].said == [("started",)]
    high.stop()
    lab.let_pass(3.0)
    assert rank_inside(lab) == (0, low.identity.beginning)
    assert lab.components["lens"].said == [("started",)]
    middle = looking(lab, "Middle", 1, "Lens")
    assert middle.state.phase is Phase.RUNNING
    assert low.state.phase is Phase.REFUSED


def test_the_rank_of_what_is_inside_of_composites_that_nest_follows_the_tasks_outside(tmp_path: Path) -> None:
    outer = EYE["eye"].replace("lens", "part").replace("Lens", "Eye").replace("seeing", "wrapping")
    outer = outer.replace(":eye a sc:Component, :Eye", ":outer a sc:Component, :Outer")
    lab = eye(tmp_path, EYE | {"outer": outer})
    low, high = looking(lab, "Low", 0, "Outer"), looking(lab, "High", 3, "Outer")
    assert rank_inside(lab) == (3, high.identity.beginning)
    middle = looking(lab, "Middle", 1, "Eye")
    assert rank_inside(lab) == (3, high.identity.beginning)
    for ended, first in ((high, middle), (middle, low)):
        ended.stop()
        lab.let_pass(3.0)
        assert rank_inside(lab) == (first.identity.priority, first.identity.beginning)
    assert lab.components["lens"].said == [("started",)]


def test_a_task_that_is_refused_as_another_holds_what_is_inside_says_which_one(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    looking(lab, "Middle", 1, "Lens")
    low = looking(lab, "Low", 0)
    assert low.state.phase is Phase.REFUSED
    (lost,) = low.losses.values()
    assert "; lens-1: the task look (priority 1, configurator " in lost
