"""Components that were turned off are asked until they are at rest, or have had their time."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.api.tasks.released_components import COMING_TO_REST, ReleasedComponents
from selfconf.model.term import IRI
from tests.api.tasks.simulated_tasks import AT_REST, DRIVE, KEYS, PATROL, Tasks


@pytest.fixture
def released(tasks: Tasks) -> ReleasedComponents:
    """The components of the network, as a program asks them."""
    return ReleasedComponents(SynchronousBus(tasks.network.node()), KEYS)


def test_what_does_not_come_to_rest_is_out_of_control_also_without_a_task(
    tasks: Tasks, released: ReleasedComponents
) -> None:
    lamp, stopping = IRI("urn:c#lamp"), replace(AT_REST, stopping=True)
    tasks.component(DRIVE, stopping)
    tasks.component(lamp, replace(stopping, component=lamp), replace(AT_REST, component=lamp))
    tasks.component(IRI("urn:c#cap"), replace(AT_REST, component=IRI("urn:c#cap"), active=True, task="tidy~2"))
    assert released.out_of_control() == {DRIVE: "its code has not come to rest (process 7 on lab)"}


def test_nothing_is_waited_for_where_nothing_is_stopping(tasks: Tasks, released: ReleasedComponents) -> None:
    tasks.component(DRIVE, AT_REST)
    began = tasks.network.time
    assert released.out_of_control() == {}
    assert tasks.network.time - began < 1.0


def test_a_component_acts_still_for_the_task_that_has_released_it_and_not_for_another(
    tasks: Tasks, released: ReleasedComponents
) -> None:
    tasks.component(DRIVE, replace(AT_REST, active=True, task=PATROL.task))
    began = tasks.network.time
    assert released.still_acting([(DRIVE, "another~1")]) == {}
    assert tasks.network.time - began < 1.0
    assert released.still_acting([(DRIVE, PATROL.task)]) == {(DRIVE, PATROL.task): "it acts on (process 7 on lab)"}
    assert tasks.network.time - began > COMING_TO_REST
