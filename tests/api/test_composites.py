"""Composites: outside a component, inside a task of their site; repaired inside, and a FAIL only if that is refused."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from selfconf import files
from selfconf.api.composites import LOOK_AT_REFUSED, NEXT_LIFE, OTHER_LIFE
from selfconf.api.task import template
from selfconf.configurator import Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.discovery import EcologyView
from selfconf.model.run_event import ComponentActivated, ComponentLost, InputConnected
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.sdk import Component, Signal
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import ECOLOGY_NAME, REPORT_LAG, MemoryRun
from tests.deployment.simulated import slow_code
from tests.lab import PREFIXES as LAB_PREFIXES
from tests.lab import Lab, iri, write_advertisements

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

    mute = False

    def __init__(self, name: str) -> None:
        self.name, self.heard = name, {"image": "", "hint": ""}

    def received(self, port: str, signal: Signal) -> None:
        self.heard[port] = signal.value
        if not self.mute:
            self.emit("pose", [self.name, self.heard["image"], self.heard["hint"]])


class Navigator(Component):
    """Keeps the last pose, and who issued it."""

    pose: Any = None
    source = ""

    def received(self, port: str, signal: Signal) -> None:
        self.pose, self.source = signal.value, signal.source.short


class House:
    """An ecology in memory with a composite, what may be inside of it, and a task that needs it."""

    def __init__(
        self,
        *,
        cameras: str = "c1 c2",
        trackers: str = "t1 t2",
        hinters: str = "h1 h2",
        tracker: str = TRACKER,
        navigator: str = NAVIGATOR,
    ) -> None:
        self.ecology = MemoryEcology()
        self.by_name: dict[str, Component] = {}
        for names, kind, text in ((cameras, "image", CAMERA), (hinters, "hint", HINTER)):
            for name in names.split():
                self.by_name[name] = self.ecology.add(Source(name, kind), text.replace("NAME", name))
        for name in trackers.split():
            self.by_name[name] = self.ecology.add(Tracker(name), tracker.replace("NAME", name))
        self.navigator = self.ecology.add(Navigator(), navigator)

    def run(self, *composites: str, task: str = TASK) -> MemoryRun:
        """Run the task with some composites."""
        for text in composites:
            self.ecology.advertise(text)
        self.ecology.advance(2.0)
        run = self.ecology.run(template(task)).started()
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


def test_an_output_that_falls_silent_inside_is_repaired_inside() -> None:
    """It is noticed outside, by who follows it."""
    rate = "sc:signalType :Pose ; sc:rate [ sc:value 10 ; sc:unit <http://qudt.org/vocab/unit/HZ> ]"
    house = House(tracker=TRACKER.replace("sc:signalType :Pose", rate))
    run = house.run(SERVICE)
    tracker = house.by_name["t1"]
    assert isinstance(tracker, Tracker)
    tracker.mute = True
    house.ecology.advance(3.0)
    assert (house.navigator.pose, house.navigator.source) == (["t2", "c1", "h1"], "t2")
    assert lost(run) == []


@pytest.mark.parametrize("roles", [":positions :navigator", ":navigator :positions"])
def test_a_composite_in_a_loop_is_heard_whatever_comes_first(roles: str) -> None:
    output = '; sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] .'
    house = House(navigator=NAVIGATOR.rstrip(" .") + output)
    task = TASK.replace(":hints :positions :navigator", roles).replace(
        ":hints a sc:Role ; sh:class :Hinter ; sc:feeds :positions .", ""
    )
    house.run(SERVICE, task=task.replace(":Nav .", ":Nav ; sc:feeds :positions ."))
    assert house.navigator.source == "t1"


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


OPTIONAL_HINT = SERVICE.replace(":Hint ] ; sc:hasOutput", ":Hint ; sc:optional true ] ; sc:hasOutput", 1)
WITHOUT_HINT = TRACKER.replace(', [ sc:name "hint" ; sc:signalType :Hint ]', "")


def test_the_inside_is_configured_again_when_an_optional_input_gets_a_source_or_loses_it() -> None:
    # Of the trackers the first needs hints; the other one does without, and comes later by its IRI.
    house = House(trackers="t1", hinters="h1")
    house.by_name["u1"] = house.ecology.add(Tracker("u1"), WITHOUT_HINT.replace("NAME", "u1"))
    house.ecology.advertise(OPTIONAL_HINT)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":hints a", ":hints sc:minCount 0 ; sc:maxCount 1 ; a"))).started()
    house.ecology.advance(1.0)
    assert (house.navigator.pose, house.acting()) == (["t1", "c1", "h1"], {"c1", "t1", "h1"})
    house.crash("h1")
    assert (house.navigator.pose, house.acting()) == (["u1", "c1", ""], {"c1", "u1"})
    assert lost(run) == [IRI("urn:c:h1")]
    assert run.running


def test_a_composite_fails_whose_inside_cannot_do_without_an_optional_input_that_nobody_feeds() -> None:
    house = House(hinters="")
    house.ecology.advertise(OPTIONAL_HINT)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":hints a", ":hints sc:minCount 0 ; sc:maxCount 1 ; a")))
    assert house.ecology.until(lambda: run.ended)
    house.ecology.advance(REPORT_LAG)
    (event,) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert event.component == SERVED
    assert event.detail.startswith("its inside is refused: the input 'hint' (Hint) of")
    assert not [event for event in run.events if isinstance(event, ComponentActivated) and event.component == SERVED]


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
            "its parameter 'a' is none of the template localise",
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


OFFERING = f"""{PREFIXES}
:service a sc:Component, :Help ; sc:hasOperation [ sc:name "help" ; sc:request :Q ; sc:response :A ] ;
    sc:needsOperation [ sc:name "light" ; sc:response :L ] ;
    sc:grounding [ sc:template :helping ] .
:helping a sc:Template ; sc:roles ( :helper ) ;
    sc:hasOperation [ sc:name "help" ; sc:request :Q ; sc:response :A ; sc:of :helper ] ;
    sc:needsOperation [ sc:name "light" ; sc:response :L ; sc:of :helper ] .
:helper a sc:Role ; sh:class :Helper ."""
HELPER = f"""{PREFIXES}
:NAME a sc:Component, :Helper ; sc:hasOperation [ sc:name "answer" ; sc:request :Q ; sc:response :A ] ;
    sc:needsOperation [ sc:name "lamp" ; sc:response :L ] ."""
LAMP = f'{PREFIXES}:NAME a sc:Component, :Lamp ; sc:hasOperation [ sc:name "shine" ; sc:response :L ] .'
ASKER = f"""{PREFIXES}
:NAME a sc:Component, :Asker ; sc:needsOperation [ sc:name "ask" ; sc:request :Q ; sc:response :A ] ."""
HELP_TASK = f"""{PREFIXES}
:task a sc:Template ; sc:roles ( :lamp :helping-hand :asker ) .
:lamp a sc:Role ; sh:class :Lamp ; sc:feeds :helping-hand .
:helping-hand a sc:Role ; sh:class :Help ; sc:feeds :asker .
:asker a sc:Role ; sh:class :Asker ."""


class Lamp(Component):
    """Answers with its name."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.callers: list[str] = []

    def called(self, operation: str, request: Signal) -> Any:
        self.callers.append(request.source.short)
        return self.name


class Helper(Component):
    """Answers with its name, once it has asked for light."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.light: list[Any] = []

    def called(self, operation: str, request: Signal) -> Any:
        self.call("lamp", None, answered=lambda answer: self.light.append(answer.value or answer.detail))
        return [self.name, request.source.short]


class Asker(Component):
    """Keeps what it was answered."""

    answers: list[Any]

    def ask(self) -> None:
        self.answers = []
        self.call("ask", "what", answered=lambda answer: self.answers.append(answer.value or answer.detail))


class Helpdesk:
    """A composite that offers an operation and needs one, between a component that asks and lamps."""

    def __init__(self, *texts: str, task: str = HELP_TASK) -> None:
        self.ecology = MemoryEcology()
        self.lamps = {name: self.ecology.add(Lamp(name), LAMP.replace("NAME", name)) for name in ("l1", "l2")}
        self.helpers = {name: self.ecology.add(Helper(name), HELPER.replace("NAME", name)) for name in ("h1", "h2")}
        self.asker = self.ecology.add(Asker(), ASKER.replace("NAME", "asker"))
        for text in texts or (OFFERING,):
            self.ecology.advertise(text)
        self.ecology.advance(2.0)
        assert self.ecology.complaints == []
        self.run = self.ecology.run(template(task)).started()

    def asked(self) -> Any:
        """What the component that asks is answered."""
        self.asker.ask()
        self.ecology.advance(1.0)
        (answer,) = self.asker.answers
        return answer


def test_an_operation_of_a_composite_is_answered_by_what_is_inside_and_by_another_after_a_repair() -> None:
    desk = Helpdesk()
    assert desk.asked() == ["h1", "asker"]
    desk.ecology.crash(desk.helpers["h1"])
    desk.ecology.advance(3.0)
    assert desk.asked() == ["h2", "asker"]
    assert lost(desk.run) == []


def test_an_operation_that_a_composite_needs_is_called_from_inside() -> None:
    desk = Helpdesk()
    desk.asked()
    assert desk.helpers["h1"].light == ["l1"]
    assert desk.lamps["l1"].callers == ["h1"]
    desk.ecology.crash(desk.lamps["l1"])
    desk.ecology.advance(3.0)
    desk.ecology.crash(desk.helpers["h1"])
    desk.ecology.advance(3.0)
    desk.asked()
    assert desk.helpers["h2"].light == ["l2"]
    assert lost(desk.run) == [IRI("urn:c:l1")]


def test_operations_reach_through_composites_that_nest() -> None:
    outer = OFFERING.replace(":service", ":outer").replace(":Help ;", ":Outer ;").replace(":helping", ":wrapping")
    outer = outer.replace(":Helper .", ":Help .").replace(":helper", ":wrapped")
    desk = Helpdesk(OFFERING, outer, task=HELP_TASK.replace("sh:class :Help ;", "sh:class :Outer ;"))
    assert desk.asked() == ["h1", "asker"]
    assert desk.helpers["h1"].light == ["l1"]
    desk.ecology.crash(desk.helpers["h1"])
    desk.ecology.advance(3.0)
    assert desk.asked() == ["h2", "asker"]
    assert desk.helpers["h2"].light == ["l1"]


def test_the_inside_of_a_composite_sees_the_hierarchy_of_its_site(tmp_path: Path) -> None:
    ontology = tmp_path / "eyes.ttl"
    ontology.write_text(
        f"{PREFIXES}@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . :Camera rdfs:subClassOf :Eye ."
    )
    wanted = SERVICE.replace("sh:class :Camera", "sh:class :Eye")
    for reasoning, complaints in (("syntactic", 1), ("subclass", 0)):
        house = House()
        house.ecology = MemoryEcology(ontologies=[ontology], reasoning=reasoning)
        house.ecology.add(Source("c1", "image"), CAMERA.replace("NAME", "c1"))
        house.ecology.add(Tracker("t1"), TRACKER.replace("NAME", "t1"))
        house.ecology.advertise(wanted)
        house.ecology.advance(2.0)
        assert len(house.ecology.complaints) == complaints


def test_an_ecology_is_told_why_a_composite_cannot_act_now() -> None:
    house = House(cameras="")
    house.ecology.advertise(SERVICE)
    house.ecology.advance(2.0)
    view = EcologyView(house.ecology.network.node(), ECOLOGY_NAME)
    told: list[str] = []

    def look() -> None:
        view.discover(lambda found: told.append(found.found[SERVED].unable))
        house.ecology.advance(1.0)

    look()
    assert told == ["its inside cannot be configured now: no component is eligible for the role eye"]
    house.by_name["late"] = house.ecology.add(Source("late", "image"), CAMERA.replace("NAME", "late"))
    house.ecology.advance(2.0)
    look()
    assert told[1:] == [""]


def test_a_composite_of_itself_through_two_sites_lives_at_neither(tmp_path: Path) -> None:
    bare = OUTER.removeprefix(PREFIXES).replace(":c:", ":peis-home:")
    other = bare.replace("whole", "other").replace("Whole", "Other").replace("KIND", "Whole").replace(":part", ":piece")
    lab = Lab(tmp_path, advertised={"whole": bare.replace("KIND", "Other"), "other": other})
    lab.site("first", "whole")
    lab.site("second", "other")
    lab.let_pass(3.0)
    assert [said.partition("does not live: ")[2] for said in lab.complaints] == [
        "its inside cannot be configured now: no component is eligible for the role part",
        "its inside cannot be configured now: no component is eligible for the role piece",
    ]


EYE = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:shareable false ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "plain": """:plain a sc:Component, :Plain ; sc:preference -1 ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
} | {
    name: f""":{name} a sc:Component, :{name.title()} ;
        sc:hasInput [ sc:name "seen" ; sc:signalType rob:Text ] ."""
    for name in ("low", "middle", "high")
}  # fmt: skip
"""A composite that tasks share, with one component inside that they do not, and for each task what follows them."""
LOOK = f"""{LAB_PREFIXES}
:look a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class :Eye ; sc:feeds :sink . :sink a sc:Role ; sh:class :SINK ."""


def eye(folder: Path, advertised: Mapping[str, str] = EYE) -> Lab:
    """A site with the composite, and with all that lives."""
    lab = Lab(folder, advertised=advertised)
    lab.site("home", *advertised)
    for name in sorted(advertised.keys() - {"eye", "outer"}):
        lab.component(name)
    lab.let_pass(3.0)
    return lab


def looking(lab: Lab, sink: str, priority: int, source: str = "Eye") -> TaskRunner:
    """A task that begins, and gets as far as it does."""
    agent = lab.agent(LOOK.replace("SINK", sink).replace(":Eye", f":{source}"), (), priority=priority)
    lab.running(agent)
    lab.let_pass(3.0)
    return agent


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


@pytest.mark.parametrize("fails", [True, False])
def test_a_composite_that_acts_no_more_lives_no_more_if_its_inside_cannot_be_configured(
    tmp_path: Path, fails: bool
) -> None:
    lab = eye(tmp_path)
    low, advertised = looking(lab, "Low", 0), tmp_path / "home" / "lens.ttl"
    text = advertised.read_text()
    advertised.unlink()
    lab.let_pass(3.0)
    assert lab.complaints[-1].endswith("no component is eligible for the role lens")
    assert (low.state.phase, list(lab.composites["home"].living)) == (Phase.RUNNING, [iri("eye")])
    if fails:
        lab.crash("lens")
    else:
        low.stop()
    lab.let_pass(3.0)
    assert low.state.phase is (Phase.REFUSED if fails else Phase.STOPPED)
    assert not lab.composites["home"].living
    advertised.write_text(text)
    lab.component("lens")
    lab.let_pass(3.0)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


@pytest.mark.parametrize("acts", [True, False])
def test_a_composite_that_is_another_by_now_begins_a_new_life_once_it_is_at_rest(tmp_path: Path, acts: bool) -> None:
    glass = EYE["lens"].replace("lens-1", "glass-1").replace(":Lens", ":Glass")
    lab = eye(tmp_path, EYE | {"glass": glass})
    low = looking(lab, "Low", 0) if acts else None
    advertised, lens = tmp_path / "home" / "eye.ttl", list(lab.components["lens"].said)
    advertised.write_text(advertised.read_text().replace("sh:class :Lens", "sh:class :Glass"))
    lab.let_pass(3.0)
    assert lab.components["lens"].said == lens
    if low is not None:
        assert low.state.phase is Phase.RUNNING
        low.stop()
        lab.let_pass(3.0)
    before = list(lab.components["lens"].said)
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING
    assert (lab.components["lens"].said, lab.components["glass"].said) == (before, [("started",)])


def test_a_composite_begins_no_life_before_its_inside_has_come_to_rest(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    low, composites = looking(lab, "Low", 0), lab.composites["home"]
    (before,) = composites.living.values()
    low.stop()
    assert lab.until(lambda: before.ending)
    composites.refresh(_advertised(tmp_path / "home"))  # read anew, they are others
    lab.until(lambda: before.runner is None or before not in composites.living.values())
    assert before.runner is None
    lab.let_pass(3.0)
    assert before not in composites.living.values()
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING


def test_a_composite_begins_its_next_life_when_the_last_is_seen_no_more(tmp_path: Path) -> None:
    lab = eye(tmp_path)
    composites, advertised = lab.composites["home"], _advertised(tmp_path / "home")
    first = composites.living[iri("eye")].runtime.life
    composites.refresh({})
    composites.refresh(advertised)
    lab.let_pass(NEXT_LIFE / 2)
    assert not composites.living
    lab.let_pass(NEXT_LIFE)
    assert composites.living[iri("eye")].runtime.life != first


def test_a_composite_that_has_left_as_another_life_was_seen_lives_again_once_that_has_ended(tmp_path: Path) -> None:
    """As where a host was cut off, and begins anew before the others have seen its end."""
    lab = Lab(tmp_path, advertised=EYE)
    ended = lab.network.node().announce(lab.keys.life(iri("eye"), "0"))
    lab.site("home", *EYE)
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(3 * OTHER_LIFE)
    assert not lab.composites["home"].living
    ended()
    lab.let_pass(OTHER_LIFE + 2 * NEXT_LIFE)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


def test_of_two_sites_that_advertise_a_composite_one_goes_on_when_the_other_has_ended(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=EYE)
    sites = {name: lab.site(name, "eye", "lens") for name in ("home", "inn")}
    lab.site("rest", *(EYE.keys() - {"eye", "lens"}))
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(5.0)
    (having,) = (name for name in sites if lab.composites[name].living)
    (first,) = lab.composites[having].living.values()
    low = looking(lab, "Low", 0)
    lab.let_pass(60.0)
    assert (low.state.phase, first.runtime.closed) == (Phase.RUNNING, False), "the other one does not begin beside it"
    low.stop()
    lab.let_pass(3.0)
    lab.crash(sites[having])
    lab.let_pass(10.0)
    assert looking(lab, "Low", 0).state.phase is Phase.RUNNING


def test_a_composite_that_lives_is_not_driven_out_by_one_that_comes_later(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=EYE)
    first = lab.site("home", *EYE)
    for name in sorted(EYE.keys() - {"eye"}):
        lab.component(name)
    lab.let_pass(3.0)
    low = looking(lab, "Low", 0)
    for number in range(6):  # of each two lives either may be the smaller one
        lab.site(f"inn-{number}", "eye", "lens")
    lab.let_pass(10.0)
    assert (low.state.phase, lab.acts("lost")) == (Phase.RUNNING, [])
    assert [name for name, composites in lab.composites.items() if composites.living] == [first.name]


def _advertised(folder: Path) -> dict[IRI, Advertisement]:
    return {one.component: one for path in folder.iterdir() for one in files.advertisements(path)[0]}


@pytest.mark.parametrize("how", ["free", "new life", "another"])
def test_a_task_that_upgrades_returns_to_a_composite_once_its_inside_can_act_again(tmp_path: Path, how: str) -> None:
    lab = eye(tmp_path)
    task = LOOK.replace("SINK", "Low").replace("sh:class :Eye", "sh:or ( [ sh:class :Eye ] [ sh:class :Plain ] )")
    low = lab.agent(task, (), upgrade=1.0)
    assert lab.running(low)
    middle = None
    if how == "free":
        middle = looking(lab, "Middle", 1, "Lens")
    else:
        lab.runtimes["lens"].fail("it is dirty")
    lab.let_pass(60.0)
    assert (low.state.phase, played(low)) == (Phase.RUNNING, {iri("plain"), iri("low")})
    fails = [event for event in lab.acts("lost") if event.component == iri("eye")]
    assert len(fails) == 1
    if middle is not None:
        middle.stop()
    elif how == "new life":
        lab.crash("lens")
        lab.component("lens")
    else:
        lens = EYE["lens"].replace("lens-1", "lens-2")
        write_advertisements(tmp_path / "home", "other", advertisements={"other": lens})
        lab.advertised = {**EYE, "other": lens}
        lab.component("other")
    lab.let_pass(20.0)
    assert (low.state.phase, played(low)) == (Phase.RUNNING, {iri("eye"), iri("low")})
    assert [event for event in lab.acts("lost") if event.component == iri("eye")] == fails


def test_a_composite_whose_inside_lacks_what_its_own_task_holds_is_tried_again_at_growing_intervals(
    tmp_path: Path,
) -> None:
    lab = eye(tmp_path)
    task = LOOK.replace(":source :sink", ":source :lens :sink").replace("SINK", "Low")
    low = lab.agent(f"{task} :lens a sc:Role ; sh:class :Lens .", (), patient=True)
    tried = list[int]()
    for _ in range(4):
        before = len(lab.acts("lost"))
        lab.let_pass(300.0)
        tried.append(len(lab.acts("lost")) - before)
    assert (low.state.phase, low.configuration) == (Phase.REFUSED, None)
    assert tried[0] < 300.0 / LOOK_AT_REFUSED
    assert max(tried[2:]) <= 300.0 / TRY_AGAIN / 4, "the pause of the task doubles as well, while nothing begins anew"
    low.stop()
    lab.let_pass(3.0)
    assert looking(lab, "High", 0).state.phase is Phase.RUNNING


def played(agent: TaskRunner) -> set[IRI]:
    """The components of what a task has deployed."""
    return set() if agent.configuration is None else set(agent.configuration.components)


HINTED = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:optional true ] ; sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :lens ] ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "high": EYE["high"],
} | {
    f"hinter{number}": f""":hinter{number} a sc:Component, :Hinter ; sc:preference -{number} ;
        sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] ."""
    for number in range(2)
}  # fmt: skip
"""A composite that can be fed or not, with a component inside that has to be fed."""


def test_a_composite_does_not_fail_while_what_feeds_its_optional_input_is_replaced(tmp_path: Path) -> None:
    lab = eye(tmp_path, HINTED)
    node = lab.network.node()
    task = LOOK.replace(":source :sink", ":hints :source :sink").replace("SINK", "High")
    hints = ":hints a sc:Role ; sh:class :Hinter ; sc:feeds :source ."
    agent = lab.agent(task + hints, (), aside=lambda work: node.later(1.0, work))
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    lab.let_pass(0.5)
    assert agent.state.phase is Phase.COMPOSING
    assert lab.runtimes["lens"].inputs.followed == set()
    assert lab.running(agent)
    lab.let_pass(0.1)
    assert [event.component for event in lab.acts("lost")] == [iri("hinter0")]
    ((_, wire),) = lab.runtimes["lens"].inputs.followed
    assert wire.component == iri("hinter1")


BASE = {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :motor ] .
        :motor a sc:Role ; sh:class :Motor .""",
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] .',
    "control": ':control a sc:Component, :Control ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;'
    ' sc:hasOutput [ sc:name "go" ; sc:signalType :Go ] .',
} | {name: HINTED[name] for name in ("hinter0", "hinter1")}
"""An actuator inside of a composite, and what drives it."""
DRIVE_BASE = f"""{LAB_PREFIXES}
:drive a sc:Template ; sc:roles ( :hints :control-role :base-role ) .
:hints a sc:Role ; sh:class :Hinter ; sc:feeds :control-role .
:control-role a sc:Role ; sh:class :Control ; sc:feeds :base-role . :base-role a sc:Role ; sh:class :Base ."""


def test_an_actuator_inside_rests_as_soon_as_one_outside_would(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=BASE)
    lab.site("home", *BASE)
    for name in sorted(BASE.keys() - {"base"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "hinter1")
    lab.components["hinter1"].slow = 4.0
    agent = lab.agent(DRIVE_BASE, ())
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    turns = dict[float, list[str]]()
    for tenth in range(60):
        lab.components["control"].emit("go", tenth)
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != "go"]
    assert (turns[0.8], turns[1.3]) == (["started"], ["started", "stopped"])
    assert agent.state.phase is Phase.RUNNING
    assert turns[5.9] == ["started", "stopped", "started"]


PILOTED = BASE | {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :pilot :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :pilot ] .
        :pilot a sc:Role ; sh:class :Pilot ; sc:feeds :motor .
        :motor a sc:Role ; sh:class :Motor .""",
    "pilot": ':pilot-1 a sc:Component, :Pilot ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;'
    ' sc:hasOutput [ sc:name "turn" ; sc:signalType :Turn ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "turn" ; sc:signalType :Turn ] .',
}
"""An actuator inside of a composite that is driven by another component inside, and not from outside."""


def test_an_actuator_that_is_driven_from_inside_rests_as_well(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=PILOTED)
    lab.site("home", *PILOTED)
    for name in sorted(PILOTED.keys() - {"base"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "hinter1")
    lab.components["hinter1"].slow = 4.0
    agent = lab.agent(DRIVE_BASE, ())
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    turns = dict[float, list[str]]()
    for tenth in range(60):
        lab.components["pilot"].emit("turn", tenth)
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != "turn"]
    assert (turns[0.8], turns[1.3]) == (["started"], ["started", "stopped"])
    assert agent.state.phase is Phase.RUNNING
    assert turns[5.9] == ["started", "stopped", "started"]
