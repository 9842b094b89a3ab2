"""A name means tasks by what tells of them: configurators, sites, components, and the programs of this machine."""

from __future__ import annotations

import pytest

from selfconf.api.tasks.living_task import RunningTasks, SilentHolder
from selfconf.api.tasks.meant_tasks import MeantTasks
from selfconf.errors import NetworkError
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Status, TaskRecord
from tests.api.tasks.simulated_tasks import DRIVE, PATROL, TEMPLATE, TIDY


def status(configurator: str, task: str, outside: IRI | None = None) -> Status:
    """What a configurator says of a task that it runs."""
    return Status(configurator, "running", TEMPLATE, 3, 1.5, task=task, outside=outside)


HOLDER = SilentHolder("c9", PATROL.task, (DRIVE,))
INSIDE = status("c3", "patrol~3", outside=IRI("urn:lab"))


@pytest.mark.parametrize(
    ("name", "found", "records", "running", "kept", "silent"),
    [
        (None, RunningTasks((status("c1", PATROL.task),), ("c5",)), [PATROL, TIDY], ["c1"], [PATROL, TIDY], ["c5"]),
        ("c1", RunningTasks((status("c1", PATROL.task),), ("c5",)), [PATROL, TIDY], ["c1"], [PATROL], []),
        ("patrol", RunningTasks((status("c2", TIDY.task),), ("c5",)), [PATROL, TIDY], [], [PATROL], ["c5"]),
        ("patrol", RunningTasks((status("c1", "patrol~1"), INSIDE)), [], ["c1"], [], []),
        ("patrol", RunningTasks((INSIDE,)), [], ["c3"], [], []),
        ("patrol", RunningTasks((INSIDE,), ("c9",), (HOLDER,)), [PATROL, TIDY], [], [PATROL], []),
        ("c3", RunningTasks((INSIDE,)), [PATROL], ["c3"], [], []),
    ],
    ids=["all", "configurator", "kept", "task before inside", "inside", "holder", "inside by configurator"],
)
def test_a_name_means_what_has_it(
    name: str | None,
    found: RunningTasks,
    records: list[TaskRecord],
    running: list[str],
    kept: list[TaskRecord],
    silent: list[str],
) -> None:
    meant = MeantTasks.of(name, found, records)
    assert [one.configurator for one in meant.running] == running
    assert list(meant.kept) == kept
    assert sorted(meant.silent) == silent


@pytest.mark.parametrize(
    ("name", "found", "why"),
    [
        ("tidy", RunningTasks((status("c1", PATROL.task),)), "no task or configurator 'tidy' answers"),
        ("c5", RunningTasks(silent=("c5",)), "the configurator 'c5' lives, but does not answer"),
        (
            "patrol",
            RunningTasks((INSIDE, replace(INSIDE, configurator="c4"))),
            "several composites are called 'patrol'",
        ),
    ],
    ids=["none", "silent", "insides"],
)
def test_a_name_that_means_nothing_that_can_be_stopped_is_refused(name: str, found: RunningTasks, why: str) -> None:
    with pytest.raises(NetworkError, match=why):
        MeantTasks.of(name, found, [])


def test_what_is_held_is_no_complaint_any_more_once_that_has_come_to_rest() -> None:
    found = RunningTasks(silent=("c9",), holding=(HOLDER,), complaints=(str(HOLDER), "two sites are called home"))
    meant = MeantTasks.of("patrol", found, [PATROL])
    assert meant.names == ("patrol",)
    assert meant.found_beside_holders.complaints == ("two sites are called home",)
