"""A task says what goes on with it, and a silent holder which components it holds for which task."""

from __future__ import annotations

import pytest

from selfconf.api.tasks.living_task import LivingTask, SilentHolder
from selfconf.model.term import IRI
from selfconf.protocol.messages import Status

DRIVE, LAB = IRI("urn:drive"), IRI("urn:lab")


def status(outside: IRI | None = None) -> Status:
    """What a configurator says of a task that it runs."""
    return Status("c1", "running", IRI("urn:t"), 3, 1.5, components=(DRIVE,), task="patrol~1", outside=outside)


@pytest.mark.parametrize(
    ("outside", "detached", "where"),
    [(None, True, "sites"), (None, False, "command"), (LAB, True, f"composite {LAB.short}")],
)
def test_a_task_lives_in_what_goes_on_with_it(outside: IRI | None, detached: bool, where: str) -> None:
    task = LivingTask.of(status(outside), detached)
    assert task.lives_in == where
    assert task.body()["inside_of"] == outside
    assert task.body()["components"] == [DRIVE]


def test_a_silent_holder_is_named_by_its_configurator_and_its_task() -> None:
    holder = SilentHolder("c1", "patrol~1", (DRIVE,))
    assert [holder.is_named(name) for name in (None, "c1", "patrol", "patrol~1")] == [True, True, True, False]
    assert str(holder) == f"the configurator 'c1' of 'patrol' holds {DRIVE.short}, but does not answer"
