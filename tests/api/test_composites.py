"""Composites: outside a component, inside a task of their site; repaired inside, and a FAIL only if that is refused."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.api.task import template
from selfconf.model.run_event import ComponentLost, InputConnected
from selfconf.model.term import IRI
from selfconf.sdk import Component, Signal
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import REPORT_LAG, MemoryRun

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:c:> .
"""
LOCALISE = """
:localise a sc:Template ; sc:parameter :robot ; sc:roles ( :eye :tracker ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :tracker ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker ; sh:property [ sh:path :sees ; sh:in ( :robot ) ] .
:tracker a sc:Role ; sh:class :Tracker .
"""
PORTS = """
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;"""
SERVICE = f"""{PREFIXES}
:service a sc:Component, :Positions ; {PORTS}
    sc:grounding [ sc:template :localise ; sc:binding [ sc:parameter :robot ; sc:value :Astrid ] ] .
{LOCALISE}"""
CAMERA = f"""{PREFIXES}
:NAME a sc:Component, :Camera ; :sees :Astrid ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] ."""
TRACKER = f"""{PREFIXES}
:NAME a sc:Component, :Tracker ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasInput [ sc:name "image" ; sc:signalType :Image ] , [ sc:name "hint" ; sc:signalType :Hint ] ."""
HINTER = f'{PREFIXES}:NAME a sc:Component, :Hinter ; sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] .'
NAVIGATOR = f'{PREFIXES}:nav a sc:Component, :Nav ; sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ] .'
TASK = f"""{PREFIXES}
:task a sc:Template ; sc:roles ( :hints :positions :navigator ) .
:hints a sc:Role ; sh:class :Hinter ; sc:feeds :positions .
:positions a sc:Role ; sh:class :Positions ; sc:feeds :navigator .
:navigator a sc:Role ; sh:class :Nav ."""
SERVED = IRI("urn:c:service")


class Source(Component):
    """Issues its name on one output, ten times a second."""

    def __init__(self, name: str, port: str) -> None:
        self.name, self.port = name, port

    def started(self) -> None:
        self.every(0.1, lambda: self.emit(self.port, self.name))


class Tracker(Component):
    """Issues its name, and what it heard last on its inputs."""

    def __init__(self, name: str) -> None:
        self.name, self.heard = name, {"image": "", "hint": ""}

    def received(self, port: str, signal: Signal) -> None:
        self.heard[port] = signal.value
        self.emit("pose", [self.name, self.heard["image"], self.heard["hint"]])


class Navigator(Component):
    """Keeps the last pose, and who issued it."""

    pose: Any = None
    source = ""

    def received(self, port: str, signal: Signal) -> None:
        self.pose, self.source = signal.value, signal.source.short


class House:
    """An ecology in memory with a composite, what may be inside of it, and a task that needs it."""

    def __init__(self, *, cameras: str = "c1 c2", trackers: str = "t1 t2", hinters: str = "h1 h2") -> None:
        self.ecology = MemoryEcology()
        self.by_name: dict[str, Component] = {}
        for names, kind, text in ((cameras, "image", CAMERA), (hinters, "hint", HINTER)):
            for name in names.split():
                self.by_name[name] = self.ecology.add(Source(name, kind), text.replace("NAME", name))
        for name in trackers.split():
            self.by_name[name] = self.ecology.add(Tracker(name), TRACKER.replace("NAME", name))
        self.navigator = self.ecology.add(Navigator(), NAVIGATOR)

    def run(self, *composites: str) -> MemoryRun:
        """Run the task with some composites."""
        for text in composites:
            self.ecology.advertise(text)
        self.ecology.advance(2.0)
        run = self.ecology.run(template(TASK)).started()
        self.ecology.advance(1.0)
        return run

    def crash(self, name: str) -> None:
        """Let a component die, and what follows happen."""
        self.ecology.crash(self.by_name.pop(name))
        self.ecology.advance(3.0)

    def acting(self) -> set[str]:
        """Which components act, of those that have not crashed."""
        return {name for name, component in self.by_name.items() if component.active}


def lost(run: MemoryRun) -> list[IRI]:
    """The components that a task has lost."""
    return [event.component for event in run.events if isinstance(event, ComponentLost)]


def test_signals_flow_straight_from_inside_to_outside_and_from_outside_to_inside() -> None:
    house = House()
    run = house.run(SERVICE)
    assert (house.navigator.pose, house.navigator.source) == (["t1", "c1", "h1"], "t1")
    assert house.acting() == {"c1", "t1", "h1"}
    connected = [e for e in run.events if isinstance(e, InputConnected) and e.sink.short == "nav"]
    assert [(event.source.short, event.output) for event in connected] == [("t1", "pose")]
    assert run.configuration is not None
    assert run.configuration.components == (IRI("urn:c:h1"), SERVED, IRI("urn:c:nav"))


def test_what_fails_inside_is_repaired_inside_and_the_task_outside_hears_nothing_of_it() -> None:
    house = House()
    run = house.run(SERVICE)
    known = len(run.events)
    house.crash("c1")
    assert house.navigator.pose == ["t1", "c2", "h1"]
    assert run.events[known:] == []
    assert house.acting() == {"c2", "t1", "h1"}


def test_who_follows_a_composite_is_told_when_another_component_stands_behind_its_output() -> None:
    house = House()
    run = house.run(SERVICE)
    house.crash("t1")
    assert (house.navigator.pose, house.navigator.source) == (["t2", "c1", "h1"], "t2")
    assert lost(run) == []
    assert house.navigator.active


def test_what_is_inside_follows_another_component_outside_when_the_first_is_lost() -> None:
    house = House()
    run = house.run(SERVICE)
    house.crash("h1")
    assert house.navigator.pose == ["t1", "c1", "h2"]
    assert lost(run) == [IRI("urn:c:h1")]


def test_when_the_inside_is_refused_the_composite_fails_with_the_reason() -> None:
    house = House(cameras="c1")
    run = house.run(SERVICE)
    house.crash("c1")
    house.ecology.advance(REPORT_LAG)
    (event,) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert (event.component, event.cause) == (SERVED, "fail")
    assert event.detail == "its inside is refused: no component is eligible for the role eye"
    assert run.ended
    assert house.acting() == set()


def test_another_component_takes_the_place_of_a_composite_that_has_failed() -> None:
    house = House(cameras="c1")
    house.by_name["plain"] = house.ecology.add(
        Tracker("plain"),
        PREFIXES
        + f":z-plain a sc:Component, :Positions ; {PORTS} rdfs:label 'plain' .".replace("rdfs:label", ":label"),
    )
    run = house.run(SERVICE)
    house.crash("c1")
    assert run.running
    assert house.navigator.source == "z-plain"


def test_a_composite_that_is_released_brings_its_inside_to_rest() -> None:
    house = House()
    run = house.run(SERVICE)
    run.stop()
    house.ecology.advance(1.0)
    assert house.acting() == set()
    again = house.ecology.run(template(TASK)).started()
    assert again.running
    assert house.acting() == {"c1", "t1", "h1"}


OUTER = f"""{PREFIXES}
:whole a sc:Component, :Whole ; {PORTS} sc:grounding [ sc:template :wrap ] .
:wrap a sc:Template ; sc:roles ( :part ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :part ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :part ] .
:part a sc:Role ; sh:class :KIND ."""


def test_composites_nest_and_what_moves_inside_the_inner_one_is_told_outside_the_outer_one() -> None:
    house = House()
    outer = OUTER.replace(":KIND", ":Positions").replace(":Whole", ":Nested")
    for text in (SERVICE, outer):
        house.ecology.advertise(text)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":Positions", ":Nested"))).started()
    house.ecology.advance(1.0)
    assert house.navigator.pose == ["t1", "c1", "h1"]
    house.crash("t1")
    assert house.navigator.pose == ["t2", "c1", "h1"]
    house.crash("h1")
    assert house.navigator.pose == ["t2", "c1", "h2"]
    assert lost(run) == [IRI("urn:c:h1")]
    house.crash("c1")
    house.crash("c2")
    (_, failed) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert failed.detail.startswith("its inside is refused: no component is eligible for the role part")


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        ([OUTER.replace("KIND", "Whole")], "no component is eligible for the role part; it cannot be inside of itself"),
        (
            [
                OUTER.replace("KIND", "Other"),
                OUTER.replace("whole", "other").replace("Whole", "Other").replace("KIND", "Whole"),
            ],
            "it could be inside of itself (",
        ),
        ([SERVICE.replace(":Astrid", ":Pippi")], "its inside cannot be configured now: no component is eligible for"),
        ([SERVICE.replace("sc:parameter :robot ; sc:value", "sc:parameter :hat ; sc:value")], "which is no parameter"),
        ([SERVICE.replace(":localise", ":elsewhere", 1)], "is not in this file"),
        ([SERVICE.replace('"hint" ; sc:signalType :Hint ]', '"help" ; sc:signalType :Hint ]')], "differ: help, hint"),
        (
            [SERVICE.replace("sc:grounding", 'sc:hasParameter [ sc:name "a" ; sc:parameterType :A ] ; sc:grounding')],
            "a composite has no operational parameters",
        ),
        (
            [SERVICE.replace("sc:grounding", 'sc:hasOperation [ sc:name "a" ] ; sc:grounding', 1)],
            "its outputs and those of the template localise differ: a()",
        ),
    ],
)  # fmt: skip
def test_a_composite_that_cannot_act_does_not_live_and_it_is_said_why(texts: list[str], sentence: str) -> None:
    house = House()
    for text in texts:
        house.ecology.advertise(text)
    house.ecology.advance(2.0)
    assert len(house.ecology.complaints) == len(texts)
    assert all(sentence in said for said in house.ecology.complaints)
    run = house.ecology.run(template(TASK.replace(":Positions", ":Whole") if "whole" in texts[0] else TASK))
    assert house.ecology.until(lambda: run.ended)
    assert house.acting() == set()


def test_a_composite_lives_as_soon_as_its_inside_can_be_configured() -> None:
    house = House(cameras="")
    house.ecology.advertise(SERVICE)
    house.ecology.advance(2.0)
    assert "its inside cannot be configured now" in house.ecology.complaints[0]
    run = house.ecology.run(template(TASK), wait=True)
    house.ecology.advance(2.0)
    assert not run.running
    house.by_name["late"] = house.ecology.add(Source("late", "image"), CAMERA.replace("NAME", "late"))
    assert house.ecology.until(lambda: run.running)
    house.ecology.advance(1.0)
    assert house.navigator.pose == ["t1", "late", "h1"]
