"""A run of a task: its events in order, what it ends with, and that nothing is left behind."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from selfconf import read, template
from selfconf.api.answer import Method
from selfconf.api.run import Run
from selfconf.errors import BindingError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import (
    ComponentLost,
    EcologyAsked,
    EcologyDiscovered,
    RunEvent,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskStopped,
    TaskWaiting,
)
from tests.cli.processes import Home
from tests.lab import NAVIGATE, iri

pytestmark = pytest.mark.process
TASK = template(NAVIGATE).bind(robot=":Astrid", goal="x")
KARLSSON = template(NAVIGATE).bind(robot=":Karlsson", goal="x")
EVERYBODY = ("sonar", "encoder", "tracker", "odometry", "control", "drive")


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's ecology with all of its components in one process."""
    house = Home(tmp_path_factory.mktemp("house"))
    house.site("home", "ads")
    house.components(*EVERYBODY)
    yield house
    house.close()


def run(house: Home, task: object = TASK, method: Method | None = None, **more: object) -> Run:
    """A run in the house."""
    return Run(task, method or Method(), house.ecology, [house.endpoint()], **more)  # type: ignore[arg-type]  # by name


def kinds(events: list[RunEvent]) -> list[type[RunEvent]]:
    """The classes of events, in order."""
    return [type(event) for event in events]


def test_a_task_is_asked_for_discovered_composed_deployed_and_taken_down(house: Home) -> None:
    events: list[RunEvent] = []
    with run(house) as running:
        for event in running.events():
            events.append(event)
            if isinstance(event, TaskRunning):
                assert running.configuration == event.configuration
                assert house.active(*EVERYBODY) == set(EVERYBODY) - {"odometry"}
                running.stop()
    order = [kinds(events).index(kind) for kind in (EcologyAsked, EcologyDiscovered, SearchEnded, TaskRunning)]
    assert order == sorted(order)
    assert isinstance(events[-1], TaskStopped)
    assert [event.time for event in events] == sorted(event.time for event in events)
    assert (running.refusal, running.lost) == (None, {})
    assert house.active(*EVERYBODY) == set()


def test_a_component_that_fails_is_replaced_and_named(house: Home) -> None:
    with run(house) as running:
        events = running.events()
        for event in events:
            if isinstance(event, TaskRunning):
                break
        (house.folder / "tracker.fail").touch()
        lost = next(event for event in events if isinstance(event, ComponentLost))
        assert (lost.component, lost.cause, lost.detail) == (iri("person-tracker"), "fail", "told to")
        again = next(event for event in events if isinstance(event, TaskRunning))
        assert iri("absolute-odometry") in again.configuration.components
        assert "told to" in running.lost[iri("person-tracker")]
    assert house.active(*EVERYBODY) == set()


def test_a_block_that_fails_takes_everything_down(house: Home) -> None:
    def fail() -> None:
        with run(house) as running:
            for event in running.events():
                if isinstance(event, TaskRunning):
                    raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert house.active(*EVERYBODY) == set()


def test_a_task_that_is_refused_says_why_and_where(house: Home) -> None:
    ads = house.folder / "ads"
    with run(house, KARLSSON, described=lambda: read(ads).advertisements()) as running:
        *_, last = running.events()
    assert isinstance(last, TaskRefused)
    assert isinstance(running.refusal, Refusal)
    explained = running.explained()
    assert isinstance(explained, Refusal)
    assert [reason.role for reason in explained.reasons] == [iri("sonar"), iri("encoder"), iri("drive")]
    places = {miss.component: miss.place for miss in explained.near_misses}
    place = places[iri("astrid-drive")]
    assert place is not None
    assert place.source == str(ads / "drive.ttl")
    assert house.active(*EVERYBODY) == set()


def test_a_task_that_may_wait_is_not_refused(house: Home) -> None:
    with run(house, KARLSSON, wait=True) as running:
        events = running.events()
        waiting = next(event for event in events if isinstance(event, TaskWaiting))
        assert isinstance(waiting.refusal, Refusal)
        running.stop()
        *_, last = events
    assert isinstance(last, TaskStopped)


def test_what_is_not_decided_is_what_the_run_ends_with(house: Home) -> None:
    with run(house, method=Method(steps=1)) as running:
        events = list(running.events())
    assert isinstance(running.refusal, Undecided)
    assert running.explained() == running.refusal
    (ended,) = [event for event in events if isinstance(event, SearchEnded)]
    assert not isinstance(ended.outcome, Configuration)


def test_a_run_ends_with_what_it_rests_on(house: Home) -> None:
    there = [True]
    with run(house, rests_on=lambda: there[0]) as running:
        for event in running.events():
            if isinstance(event, TaskRunning):
                there[0] = False
    assert house.active(*EVERYBODY) == set()


def test_a_run_that_cannot_begin_is_an_error(house: Home) -> None:
    with pytest.raises(BindingError, match="needs a value"):
        run(house, template(NAVIGATE))
    with pytest.raises(SelfconfError, match="no endpoint"):
        Run(TASK, Method(), house.ecology, ["here"])
