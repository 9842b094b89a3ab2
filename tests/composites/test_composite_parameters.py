"""Parameters of a composite are those of its template, and reach the components inside."""

from __future__ import annotations

from typing import Any

from selfconf.api.task import template
from selfconf.model.run_event import ComponentLost
from selfconf.model.term import IRI
from selfconf.sdk import Component, Signal
from selfconf.testing.memory_ecology import REPORT_LAG
from tests.composites.composite_house import (
    CAMERA,
    PREFIXES,
    House,
    Source,
    Tracker,
    lost,
)

TUNED = f"""{PREFIXES}
:service a sc:Component, :Positions ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasParameter [ sc:name "speed" ; sc:parameterType :Speed ] , [ sc:name "robot" ; sc:parameterType :Robot ] ;
    sc:grounding [ sc:template :localise ] .
:localise a sc:Template ; sc:parameter :robot , :speed ; sc:roles ( :eye :tracker ) ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:speed a sc:Parameter ; sc:name "speed" ; sh:nodeKind sh:Literal .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker ; sh:property [ sh:path :sees ; sh:in ( :robot ) ] .
:tracker a sc:Role ; sh:class :Tracker ; sc:sets [ sc:parameterType :Speed ; sc:value :speed ] .
"""
TUNED_TRACKER = f"""{PREFIXES}
:t1 a sc:Component, :Tracker ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ;
    sc:hasParameter [ sc:name "rate" ; sc:parameterType :Speed ] ."""
TUNING_TASK = f"""{PREFIXES}
:task a sc:Template ; sc:parameter :who , :fast ; sc:roles ( :positions :navigator ) .
:who a sc:Parameter ; sc:name "who" . :fast a sc:Parameter ; sc:name "fast" .
:positions a sc:Role ; sh:class :Positions ; sc:feeds :navigator ;
    sc:sets [ sc:parameterType :Robot ; sc:value :who ] , [ sc:parameterType :Speed ; sc:value :fast ] .
:navigator a sc:Role ; sh:class :Nav ."""


class TunedTracker(Tracker):
    """Issues as well what its parameter is."""

    rate: Any = None

    def parameter_set(self, name: str, value: Any) -> None:
        self.rate = value

    def received(self, port: str, signal: Signal) -> None:
        self.emit("pose", [signal.value, self.rate])


def tuned_house() -> House:
    """A house where each camera sees another robot, with a composite that is told which one to follow."""
    house = House(cameras="", trackers="", hinters="")
    for name, robot in (("c1", "Astrid"), ("c2", "Pippi")):
        text = CAMERA.replace("NAME", name).replace("Astrid", robot)
        house.by_name[name] = house.ecology.add(Source(name, "image"), text)
    house.by_name["t1"] = house.ecology.add(TunedTracker("t1"), TUNED_TRACKER)
    house.ecology.advertise(TUNED)
    house.ecology.advance(2.0)
    return house


def test_the_parameters_of_a_composite_are_those_of_its_template() -> None:
    house = tuned_house()
    for robot, camera, speed in (("Pippi", "c2", 3), ("Astrid", "c1", 5)):
        run = house.ecology.run(template(TUNING_TASK).bind(who=f":{robot}", fast=speed)).started()
        house.ecology.advance(1.0)
        assert house.navigator.pose == [camera, speed]
        run.stop()
        assert house.acting() == set()


def test_a_composite_whose_parameter_has_another_value_begins_anew_inside() -> None:
    house = tuned_house()
    free = TUNING_TASK.replace('sc:name "who" .', 'sc:name "who" ; sh:in ( :Pippi :Astrid ) .').replace(
        ":navigator a sc:Role", ":guide a sc:Role ; sh:class :Guide ; sh:property [ sh:path :of ; sh:in ( :who ) ] .\n"
        ":navigator a sc:Role").replace("( :positions", "( :guide :positions")  # fmt: skip
    guides = {}
    for robot in ("Pippi", "Astrid"):
        text = f"{PREFIXES}:guide-{robot} a sc:Component, :Guide ; :of :{robot} ; sc:preference {len(robot)} ."
        guides[robot] = house.ecology.add(Component(), text)
    run = house.ecology.run(template(free).bind(fast=1)).started()
    house.ecology.advance(1.0)
    assert house.navigator.pose == ["c1", 1]
    house.ecology.crash(guides["Astrid"])
    house.ecology.advance(5.0)
    assert run.running
    assert house.navigator.pose == ["c2", 1]
    assert house.acting() == {"c2", "t1"}
    assert lost(run) == [IRI("urn:c:guide-Astrid")]


def test_a_composite_that_is_set_to_what_its_inside_cannot_be_fails_with_the_reason() -> None:
    house = tuned_house()
    for robot, why in (
        ('"a robot"', "cannot stand for the parameter 'robot': "),
        (":Nobody", "its inside is refused: no component is eligible for the role eye"),
    ):
        run = house.ecology.run(template(TUNING_TASK).bind(who=robot, fast=1))
        assert house.ecology.until(lambda run=run: run.ended)
        house.ecology.advance(REPORT_LAG)
        details = [event.detail for event in run.events if isinstance(event, ComponentLost)]
        assert any(why in detail for detail in details)
    unset = TUNING_TASK.replace(" , [ sc:parameterType :Speed ; sc:value :fast ]", "").replace(", :fast", "")
    run = house.ecology.run(template(unset).bind(who=":Astrid"))
    assert house.ecology.until(lambda: run.ended)
    house.ecology.advance(REPORT_LAG)
    details = [event.detail for event in run.events if isinstance(event, ComponentLost)]
    assert any("the parameter 'speed' of its template localise needs a value" in one for one in details)
