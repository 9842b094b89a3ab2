"""A run in a living ecology of real processes: its events, its end, and what it says of itself."""

from __future__ import annotations

import threading

import pytest

import selfconf as sc
from selfconf.errors import NetworkError, ProgrammerError
from selfconf.model.run_event import (
    ComponentLost,
    ComponentReleased,
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

pytestmark = pytest.mark.process


def test_events_are_values_in_the_order_in_which_things_happen(served: Home, clock: sc.TaskSpecification) -> None:
    seen: list[RunEvent] = []
    with sc.join(served.ecology) as living, living.run(clock) as run:
        for event in run.events():
            seen.append(event)
            if isinstance(event, TaskRunning):
                assert run.configuration == event.configuration
                assert event.configuration.components == living.configure(clock)["source"] + (
                    sc.IRI("https://example.org/my-home#display"),
                )
                run.stop()
    milestones = (EcologyAsked, EcologyDiscovered, SearchEnded, TaskRunning, TaskStopped)
    assert [type(event) for event in seen if isinstance(event, milestones)] == list(milestones)
    assert sum(isinstance(event, ComponentReleased) for event in seen) == 2
    assert [event.time for event in seen] == sorted(event.time for event in seen)
    assert all(event.act for event in seen)
    assert run.refusal is None


def test_another_thread_sees_the_task_and_may_stop_it(served: Home, clock: sc.TaskSpecification) -> None:
    seen: list[tuple[str, ...]] = []

    def watch(run: sc.Run) -> None:
        with sc.join(served.ecology) as other:
            seen.append(tuple(f"{status.configurator} {status.phase}" for status in other.tasks))
            assert other.query("ASK { ?c a sc:Configuration }") is True
            assert other.stop(run.name) == (run.name,)

    with sc.join(served.ecology) as living, living.run(clock) as run:
        watcher = threading.Thread(target=watch, args=(run,))
        last = None
        for last in run.events():
            if isinstance(last, TaskRunning):
                watcher.start()
        watcher.join(20)
        assert isinstance(last, TaskStopped)
        assert seen == [(f"{run.name} running",)]


def test_leaving_the_block_by_an_error_takes_everything_down(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living:
        with pytest.raises(ZeroDivisionError):
            fail_when_it_runs(living, clock)
        assert living.tasks == ()
        with living.run(clock) as again:  # the components are free for another one
            assert any(isinstance(event, TaskRunning) for event in until(again, TaskRunning))


def fail_when_it_runs(living: sc.LivingEcology, task: sc.TaskSpecification) -> None:
    """Run a task, and leave the block by an error."""
    with living.run(task) as run:
        until(run, TaskRunning)
        raise ZeroDivisionError


def until(run: sc.Run, kind: type[RunEvent]) -> list[RunEvent]:
    """The events up to the first of a kind."""
    seen: list[RunEvent] = []
    for event in run.events():
        seen.append(event)
        if isinstance(event, kind):
            break
    return seen


def test_what_cannot_be_configured_ends_with_a_refusal_that_is_explained(
    served: Home, clock: sc.TaskSpecification
) -> None:
    with sc.join(served.ecology) as living, living.run(clock.bind(room=":cellar")) as run:
        seen = list(run.events())
    assert isinstance(seen[-1], TaskRefused)
    explained = run.explained()
    assert isinstance(explained, sc.Refusal)
    assert [str(miss) for miss in explained.near_misses] == ["its place is kitchen, not cellar"]
    assert repr(explained).startswith("<no configuration for :tell-the-time")


def test_a_patient_run_waits_for_the_ecology_to_change(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living, living.run(clock.bind(room=":cellar"), wait=True) as run:
        waiting = until(run, TaskWaiting)[-1]
        assert isinstance(waiting, TaskWaiting)
        assert isinstance(waiting.refusal, sc.Refusal)
        ads = served.folder / "cellar"
        ads.mkdir()
        (ads / "display.ttl").write_text(DISPLAY_IN_THE_CELLAR)
        served.site("cellar", str(ads), connect=(served.endpoint(),))
        after = until(run, ComponentLost)
        assert any(isinstance(event, SearchEnded) and isinstance(event.outcome, sc.Configuration) for event in after)


DISPLAY_IN_THE_CELLAR = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix : <https://example.org/my-home#> .
:cellar-display a sc:Component, rob:Display ; rob:place :cellar ;
    sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ] .
"""


def test_a_policy_that_there_is_not_and_an_ecology_that_is_not_there_are_refused(
    served: Home, clock: sc.TaskSpecification
) -> None:
    with sc.join(served.ecology) as living, pytest.raises(ProgrammerError, match="'repair', 'dismantle'"):
        living.run(clock, policy="forget")
    with pytest.raises(NetworkError):
        sc.join("no-such-ecology")
