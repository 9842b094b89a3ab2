"""A run in a living ecology of real processes: its events, its end, and what it says of itself."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import selfconf as sc
from selfconf import read, template
from selfconf.api.membership import Membership
from selfconf.api.method import Method
from selfconf.api.tasks import work_queue
from selfconf.api.tasks.run import Run, WorkQueue
from selfconf.bus.zenoh import ZenohBus
from selfconf.composition import Composer
from selfconf.errors import BindingError, NetworkError, ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.protocol.keys import Keys
from selfconf.values import (
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
from tests.lab import NAVIGATE, iri

pytestmark = pytest.mark.process


def test_events_are_values_in_the_order_in_which_things_happen(served: Home, clock: sc.TaskSpecification) -> None:
    seen: list[RunEvent] = []
    with sc.join(served.ecology) as living:
        would_be = living.configure(clock)
        assert isinstance(would_be, sc.Configuration)
        with living.run(clock) as run:
            for event in run.events():
                seen.append(event)
                if isinstance(event, TaskRunning):
                    assert repr(run) == "<run of tell-the-time: running>"
                    assert run.configuration == event.configuration
                    assert event.configuration == would_be
                    assert run.configuration is not None
                    assert run.configuration["screen"] == would_be["screen"]
                    assert not living.configure(clock)  # what this task holds counts for no other
                    run.stop()
    milestones = (EcologyAsked, EcologyDiscovered, SearchEnded, TaskRunning, TaskStopped)
    assert [type(event) for event in seen if isinstance(event, milestones)] == list(milestones)
    assert sum(isinstance(event, ComponentReleased) for event in seen) == 2
    assert [event.time for event in seen] == sorted(event.time for event in seen)
    assert all(event.act for event in seen)
    assert run.refusal is None


@pytest.mark.parametrize("name", ["", "told"])
def test_a_run_asks_the_other_tasks_once_for_their_names_and_for_what_they_hold(
    served: Home, clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    asked, ask = list[str](), ZenohBus.ask

    def noted(bus: ZenohBus, key: str, *rest: Any, **more: Any) -> None:
        asked.append(key)
        ask(bus, key, *rest, **more)

    monkeypatch.setattr(ZenohBus, "ask", noted)
    with sc.join(served.ecology) as living, living.run(clock, name=name) as run:
        until(run, TaskRunning)
    assert asked.count(Keys(served.ecology).configurator_call("*", "status")) == 1


def test_a_run_has_events_in_a_with_statement_alone_and_is_entered_once(
    served: Home, clock: sc.TaskSpecification
) -> None:
    with sc.join(served.ecology) as living:
        run = living.run(clock)
        for ask in (lambda: list(run.events()), run.stop, run.stop_on_signals, lambda: run.name):
            with pytest.raises(ProgrammerError, match="the run of tell-the-time has not begun; use it in a `with` sta"):
                ask()
        with run:
            until(run, TaskRunning)
        left = list(run.events())  # those that the end has not come to, and then no more
        assert not any(isinstance(event, TaskRunning) for event in left)
        with pytest.raises(ProgrammerError, match="was entered already"), run:
            pytest.fail("it was entered twice")


def test_once_it_is_left_signals_do_again_what_they_did_before(served: Home, clock: sc.TaskSpecification) -> None:
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.getsignal(number) for number in numbers]
    with sc.join(served.ecology) as living, living.run(clock) as run:
        run.stop_on_signals()
        run.stop_on_signals()
        until(run, TaskRunning)
        signal.raise_signal(signal.SIGTERM)
        until(run, TaskStopped)
    assert [signal.getsignal(number) for number in numbers] == before


def test_a_run_that_is_not_entered_holds_nothing(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living:
        threads, files = threading.active_count(), open_files()
        forgotten = [living.run(clock, name="forgotten") for _ in range(3)]
        assert (threading.active_count(), open_files()) == (threads, files)
        assert living.all_tasks() == living.tasks == living.silent == living.suspended == living.complaints == ()
        with living.run(clock, name="forgotten") as run:  # the name is free
            until(run, TaskRunning)
            with pytest.raises(NetworkError, match="a task 'forgotten' lives already"), forgotten[0]:
                pytest.fail("it was entered, though its name is taken")
        with forgotten[0]:  # now it is free
            until(forgotten[0], TaskRunning)
        unused = forgotten[1]
        assert (unused.configuration, unused.refusal, unused.explained(), unused.lost) == (None, None, None, {})
        assert unused.losses == {}
        assert repr(unused) == "<run of forgotten: not begun>"


def open_files() -> int:
    """How many files and sockets this process has open."""
    return len(list(Path("/proc/self/fd").iterdir()))


def test_another_thread_sees_the_task_and_may_stop_it(served: Home, clock: sc.TaskSpecification) -> None:
    seen: list[tuple[str, ...]] = []

    def watch(run: sc.Run) -> None:
        with sc.join(served.ecology) as other:
            seen.append(tuple(f"{status.name} {status.configurator} {status.phase}" for status in other.tasks))
            assert other.query("ASK { ?c a sc:Configuration }") is True
            assert other.stop(run.name) == ("tell-the-time",)

    with sc.join(served.ecology) as living, living.run(clock) as run:
        watcher = threading.Thread(target=watch, args=(run,))
        last = None
        for last in run.events():
            if isinstance(last, TaskRunning):
                watcher.start()
        watcher.join(20)
        assert isinstance(last, TaskStopped)
        assert seen == [(f"tell-the-time {run.name} running",)]


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
    assert seen[-1].refusal is explained
    assert explained.repairs
    assert [str(miss) for miss in explained.near_misses] == ["its place is kitchen, not cellar"]
    assert repr(explained).startswith("<no configuration for :tell-the-time")


def test_a_refusal_is_explained_by_the_ecology_in_which_it_was_found(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living:
        run, home = living.run(clock.bind(room=":cellar")), living.advertisements()
        refused = run._request.compose(home, frozenset(), None)
        run._request.compose({}, frozenset(), None)
        assert isinstance(refused, sc.Refusal)
        explained = run._explanations.in_full(refused)
    assert [str(miss) for miss in explained.near_misses] == ["its place is kitchen, not cellar"]


def test_a_patient_run_waits_for_the_ecology_to_change(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join(served.ecology) as living, living.run(clock.bind(room=":cellar"), wait=True) as run:
        waiting = until(run, TaskWaiting)[-1]
        assert isinstance(waiting, TaskWaiting)
        assert isinstance(waiting.refusal, sc.Refusal)
        assert [str(miss) for miss in waiting.refusal.near_misses] == ["its place is kitchen, not cellar"]
        assert waiting.refusal.repairs
        assert repr(run) == "<run of tell-the-time: waiting>"
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
    membership = Membership(house.ecology, (house.endpoint(),), house.credentials())
    return Run(task, method or Method(), membership, **more)  # type: ignore[arg-type]  # by name


def kinds(events: list[RunEvent]) -> list[type[RunEvent]]:
    """The classes of events, in order."""
    return [type(event) for event in events]


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
        Run(TASK, Method(), Membership(house.ecology, ("here",))).__enter__()


# The run's own threads: the bus listens, whatever the thread does that reads the events.


def test_a_run_answers_while_no_event_is_read(house: Home) -> None:
    """The configurator answers while the thread that reads the events does something else."""
    with run(house) as running:
        events = running.events()
        next(event for event in events if isinstance(event, TaskRunning))
        bus, _, runner = running._in_ecology()
        answered: list[object] = []
        bus.ask(runner.keys.configurator_call(running.name, "status"), b"", 5.0, answered.append)
        pause = threading.Event()
        deadline = time.monotonic() + 5.0
        while not answered and time.monotonic() < deadline:
            pause.wait(0.01)
        assert answered


def test_searches_are_done_by_the_thread_that_reads_the_events_and_keep_the_run_from_nothing(
    house: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    searching, go_on = threading.Event(), threading.Event()
    searched_by: list[threading.Thread] = []

    answers = Composer.answers

    def held(*arguments: Any) -> Any:
        searched_by.append(threading.current_thread())
        searching.set()
        go_on.wait(10.0)
        return answers(*arguments)

    monkeypatch.setattr(Composer, "answers", held)
    moments: list[float] = []

    def look() -> None:
        """While the search goes on, the configurator answers `status` and obeys `stop`, each within 50 ms."""
        searching.wait(10.0)
        answered = threading.Event()
        began = time.monotonic()
        bus, _, runner = running._in_ecology()
        bus.ask(runner.keys.configurator_call(running.name, "stop"), b"", 5.0, lambda _: answered.set())
        answered.wait(5.0)
        moments.append(time.monotonic() - began)
        go_on.set()

    with run(house) as running:
        watcher = threading.Thread(target=look)
        watcher.start()
        *_, last = running.events()
        watcher.join(10.0)
    assert isinstance(last, TaskStopped)
    assert searched_by == [threading.current_thread()]
    assert moments[0] < 0.5  # it takes a few milliseconds; the processors of a test are shared
    assert house.active(*EVERYBODY) == set()


def test_what_has_led_to_a_search_is_read_before_that_begins(house: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_queue, "HELD_UP", 10.0)  # else a search begins where other programs keep this from reading
    heard, before, answers = list[str](), list[list[str]](), Composer.answers

    def answered(*arguments: Any) -> Any:
        before.append([*heard])
        return answers(*arguments)

    monkeypatch.setattr(Composer, "answers", answered)
    with run(house) as running:
        for event in running.events():
            heard.append(event.act)
            if isinstance(event, TaskRunning):
                running.stop()
    assert before[0][-1] == "discovered"


def test_work_that_makes_an_event_is_followed_by_it() -> None:
    queue, event = WorkQueue(), EcologyAsked()
    queue.add(lambda: queue.report(event))
    assert queue.next(0.0) is event


@pytest.mark.parametrize("act", ["work", "report", "wake up"])
def test_the_queue_wakes_the_thread_that_waits(act: str) -> None:
    queue = WorkQueue()
    acts = {"work": lambda: queue.add(lambda: None), "report": lambda: queue.report(EcologyAsked())}
    began = time.monotonic()
    timer = threading.Timer(0.05, acts.get(act, queue.wake_up))
    timer.start()
    queue.next(10.0)
    assert time.monotonic() - began < 5.0
    timer.join()
