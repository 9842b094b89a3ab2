"""A task is tried without a network: it runs, a component crashes, another one takes over."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import pytest

import selfconf as sc
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.sdk import Component, Refused, Signal
from selfconf.testing import Faults, MemoryEcology
from selfconf.values import ComponentLost, TaskRefused, TaskRunning, TaskWaiting

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:test:> .
"""
CLOCK = PREFIXES + ':NAME a sc:Component, :Clock ; sc:hasOutput [ sc:name "time" ; sc:signalType :Time ] .'
SCREEN = PREFIXES + ':screen a sc:Component, :Screen ; sc:hasInput [ sc:name "text" ; sc:signalType :Time ] .'
TASK = (
    PREFIXES
    + """:tell a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class :Clock ; sc:feeds :sink .
:sink a sc:Role ; sh:class :Screen ."""
)


class Clock(Component):
    """Says its name every second."""

    def __init__(self, name: str) -> None:
        self.name = name

    def started(self) -> None:
        self.every(1.0, lambda: self.emit("time", self.name))


class Screen(Component):
    """Notes what it is shown."""

    def __init__(self) -> None:
        self.shown: list[str] = []

    def received(self, port: str, signal: Signal) -> None:
        self.shown.append(signal.value)


def test_a_task_runs_and_goes_on_when_a_component_crashes() -> None:
    ecology = MemoryEcology()
    first = ecology.add(Clock("first"), CLOCK.replace("NAME", "a"))
    ecology.add(Clock("second"), CLOCK.replace("NAME", "b"))
    screen = ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK)).started()
    assert run.configuration is not None
    assert ecology.until(lambda: screen.shown == ["first"])
    ecology.crash(first)
    assert ecology.until(lambda: "second" in screen.shown)
    acts = [type(event) for event in run.events]
    assert acts.count(TaskRunning) == 2
    assert acts.count(ComponentLost) == 1
    run.stop()
    assert run.ended
    assert not screen.active


def test_what_has_happened_is_told_at_once() -> None:
    ecology = MemoryEcology()
    first = ecology.add(Clock("first"), CLOCK.replace("NAME", "a"))
    ecology.add(Clock("second"), CLOCK.replace("NAME", "b"))
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK)).started()
    ecology.crash(first)
    assert ecology.until(lambda: run.running and run.configuration["source"] == ("urn:test:b",))
    assert [event.act for event in run.events if event.act in ("lost", "running")] == ["running", "lost", "running"]


def test_of_two_lives_of_a_component_the_one_that_acts_can_be_ended() -> None:
    ecology = MemoryEcology()
    first, second = (ecology.add(Clock(name), CLOCK.replace("NAME", "a")) for name in ("first", "second"))
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK)).started()
    assert (first.active, second.active) == (True, False)
    ecology.crash(first)
    assert ecology.until(lambda: run.ended)


def test_a_recruit_that_crashes_is_replaced_by_another() -> None:
    ecology = MemoryEcology()
    first = ecology.add(Clock("first"), CLOCK.replace("NAME", "a"))
    ecology.add(Clock("second"), CLOCK.replace("NAME", "b"))
    screen = ecology.add(Screen(), SCREEN)
    template = ":show a sc:Template ; sc:roles ( :sink ) . :sink a sc:Role ; sh:class :Screen ; sc:recruits true ."
    run = ecology.run(sc.template(PREFIXES + template)).started()
    assert run.configuration is not None
    assert [one.short for one in run.configuration.recruits] == ["a"]
    assert ecology.until(lambda: screen.shown == ["first"])
    ecology.crash(first)
    assert ecology.until(lambda: "second" in screen.shown)
    assert [one.short for one in run.configuration.recruits] == ["b"]
    run.stop()
    assert not screen.active


def test_a_component_that_is_cut_off_comes_back() -> None:
    ecology = MemoryEcology(seed=3, faults=Faults(loss=0.05, doubling=0.05))
    clock = ecology.add(Clock("only"), CLOCK.replace("NAME", "a"))
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK), wait=True).started()
    ecology.isolate(clock)
    assert ecology.until(lambda: not run.running)
    ecology.rejoin(clock)
    assert ecology.until(lambda: run.running)


def test_an_isolated_component_is_reached_by_no_program_that_begins_later() -> None:
    ecology = MemoryEcology()
    clock = ecology.add(Clock("only"), CLOCK.replace("NAME", "a"))
    ecology.isolate(clock)
    screen = ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK), wait=True)
    assert not ecology.until(lambda: run.running or clock.active)
    ecology.rejoin(clock)
    assert ecology.until(lambda: screen.shown == ["only"])


def test_a_component_that_comes_back_does_not_reach_another_that_is_isolated() -> None:
    ecology = MemoryEcology()
    clock = ecology.add(Clock("only"), CLOCK.replace("NAME", "a"))
    screen = ecology.add(Screen(), SCREEN)
    _, *nodes = ecology.network.nodes
    ecology.isolate(clock)
    ecology.isolate(screen)
    ecology.rejoin(clock)
    assert not ecology.network.reaches(*nodes)
    ecology.rejoin(screen)
    assert ecology.network.reaches(*nodes)


def test_a_task_that_cannot_run_says_why() -> None:
    ecology = MemoryEcology()
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK))
    why = "the task does not run; it is refused: no configuration for :tell\n  because no component is eligible"
    with pytest.raises(ProgrammerError, match=why):
        run.started()
    assert isinstance(run.events[-1], TaskRefused)
    assert run.events[-1].refusal == run.refusal
    assert repr(run.refusal).startswith("<no configuration for :tell")
    (repair,) = run.refusal.repairs
    assert "source" in str(repair)


def test_a_task_that_cannot_run_says_why_a_component_that_there_is_was_lost() -> None:
    class Stopped(Clock):
        """A clock that declines to act."""

        def started(self) -> None:
            raise Refused("the battery is empty")

    ecology = MemoryEcology()
    ecology.add(Stopped("a"), CLOCK.replace("NAME", "a"))
    ecology.add(Screen(), SCREEN)
    with pytest.raises(ProgrammerError, match="\na was lost: refused, the battery is empty"):
        ecology.run(sc.template(TASK)).started()


def test_a_task_that_waits_says_why_it_does_not_run() -> None:
    ecology = MemoryEcology()
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK), wait=True)
    with pytest.raises(ProgrammerError, match="the task does not run; it is waiting: no configuration for :tell\n"):
        run.started()
    assert not run.ended
    assert repr(run) == "<run of tell: waiting>"
    ecology.add(Clock("clock"), CLOCK.replace("NAME", "clock"))
    assert run.started().phase == "running"


def test_a_task_sees_the_ontologies_of_the_ecology_in_its_own_mode(tmp_path: Path) -> None:
    rdfs = "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"
    (tmp_path / "clocks.ttl").write_text(f"{PREFIXES}{rdfs}:SunClock rdfs:subClassOf :Clock .")
    ecology = MemoryEcology(ontologies=tmp_path / "clocks.ttl")
    ecology.add(Clock("dial"), CLOCK.replace("NAME", "dial").replace(":Clock", ":SunClock"))
    ecology.add(Screen(), SCREEN)
    with pytest.raises(ProgrammerError, match="which lies below it"):
        ecology.run(sc.template(TASK)).started()
    run = ecology.run(sc.template(TASK), reasoning="subclass").started()
    assert run.configuration is not None
    assert run.configuration["source"] == (sc.IRI("urn:test:dial"),)


def test_a_refusal_is_explained_as_that_of_configure() -> None:
    task, files = sc.template("examples/clock/tell-the-time.ttl").bind(room=":cellar"), "examples/clock"
    ecology = MemoryEcology()
    for name in ("clock", "display"):
        ecology.add(Component(), f"{files}/{name}.ttl")
    expected = sc.configure(task, sc.read(files))
    assert isinstance(expected, sc.Refusal)
    refused = ecology.run(task)
    assert ecology.until(lambda: refused.ended)
    waiting = ecology.run(task, wait=True)
    assert ecology.until(lambda: waiting.events[-1:] != [] and isinstance(waiting.events[-1], TaskWaiting))
    for refusal in (refused.refusal, refused.events[-1].refusal, waiting.events[-1].refusal):  # type: ignore[union-attr]  # both have one
        assert refusal == expected
        assert refusal.repairs
        assert refusal.near_misses
        assert str(refusal) == str(expected)


def test_what_runs_is_read_by_role_as_an_answer_of_the_library_is() -> None:
    ecology = MemoryEcology()
    ecology.add(Clock("first"), CLOCK.replace("NAME", "a"))
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK)).started()
    (running,) = (event for event in run.events if isinstance(event, TaskRunning))
    assert run.configuration is not None
    assert run.configuration == running.configuration
    assert run.configuration["source"] == ("urn:test:a",)
    assert repr(run) == "<run of tell: running>"
    assert repr(ecology).startswith("<ecology in memory of 2 components after ")
    assert run.configuration.to_mermaid()


def test_an_advertisement_that_is_none_is_refused(tmp_path: Path) -> None:
    ecology = MemoryEcology()
    with pytest.raises(AuthorError, match="sc:signalType"):
        ecology.add(Screen(), SCREEN.replace("sc:signalType :Time", "sc:signalType 1"))
    with pytest.raises(AuthorError, match="one advertisement is needed"):
        ecology.advertise(PREFIXES)
    with pytest.raises(ProgrammerError, match="add it first"):
        ecology.crash(Screen())


@pytest.mark.parametrize("seconds", [float("nan"), float("inf"), -5, True, "5"])
def test_time_goes_by_numbers_and_forward(seconds: Any) -> None:
    ecology = MemoryEcology()
    for let_pass in (ecology.advance, partial(ecology.until, lambda: False)):
        with pytest.raises(ProgrammerError, match="simulated seconds are a number from 0 to 1,000,000, not "):
            let_pass(seconds)
    assert ecology.time == 0.0


def test_what_is_no_component_and_no_faults_is_refused_in_a_sentence() -> None:
    for component in (None, Screen):
        with pytest.raises(ProgrammerError, match="a component is an object of a class of selfconf"):
            MemoryEcology().add(component, SCREEN)  # type: ignore[type-var]  # that is what is tested
    with pytest.raises(ProgrammerError, match=r"^a source is a path, .*, not None$"):
        MemoryEcology().advertise(None)  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(ProgrammerError, match=r"the faults of a network are Faults\(\.\.\.\), not 1"):
        MemoryEcology(faults=1)  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(ProgrammerError, match="wait is True or False"):
        MemoryEcology().run(sc.template(TASK), wait="no")  # type: ignore[arg-type]  # that is what is tested


def test_what_is_no_task_and_no_policy_is_refused_in_a_sentence() -> None:
    ecology = MemoryEcology()
    with pytest.raises(ProgrammerError, match=r"a task is what selfconf\.template\(\) gives"):
        ecology.run("task.ttl")  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(ProgrammerError, match="there is no policy 'mend'"):
        ecology.run(sc.template(TASK), policy="mend")


@pytest.mark.parametrize("said", ["in the template", "as it is run"])
def test_a_task_of_higher_priority_gets_what_another_holds(said: str) -> None:
    ecology = MemoryEcology()
    ecology.add(Clock("only"), CLOCK.replace("NAME", "a"))
    ecology.add(Screen(), SCREEN)
    patient = ecology.run(sc.template(TASK), wait=True).started()
    urgent = TASK.replace(":tell ", ":warn ")
    if said == "in the template":
        second = ecology.run(sc.template(urgent.replace("sc:roles", "sc:priority 5 ; sc:roles"))).started()
    else:
        second = ecology.run(sc.template(urgent), priority=5).started()
    assert not patient.running
    second.stop()
    assert ecology.until(lambda: patient.running)
    with pytest.raises(ProgrammerError, match="a priority is a whole number"):
        ecology.run(sc.template(TASK), priority=0.5)  # type: ignore[arg-type]  # that is what is tested


def test_a_task_changes_for_the_better_where_it_is_asked_to() -> None:
    ecology = MemoryEcology()
    ecology.add(Clock("b"), CLOCK.replace("NAME", "b"))
    screen = ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK), upgrade=2.0).started()
    ecology.add(Clock("a"), CLOCK.replace("NAME", "a"))
    assert ecology.until(lambda: "a" in screen.shown and run.running)
    assert not any(isinstance(event, ComponentLost) for event in run.events)
    with pytest.raises(ProgrammerError, match="upgrade"):
        ecology.run(sc.template(TASK), upgrade=-1.0)


def test_a_refusal_names_the_line_in_a_text_where_a_role_or_component_is_described() -> None:
    ecology = MemoryEcology()
    ecology.add(Clock("only"), CLOCK.replace("NAME", "a").replace(":Clock", ":Clok"))
    ecology.add(Screen(), SCREEN)
    run = ecology.run(sc.template(TASK))
    assert ecology.until(lambda: run.ended)
    assert isinstance(run.refusal, sc.Refusal)
    assert [str(reason.place) for reason in run.refusal.reasons] == ["<text>:5"]
    assert [str(miss.place) for miss in run.refusal.near_misses] == ["<text>:4"]
