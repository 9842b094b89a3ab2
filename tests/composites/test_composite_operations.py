"""Operations of a composite are answered, and called, by the components inside."""

from __future__ import annotations

from typing import Any

from selfconf.api.task import template
from selfconf.model.term import IRI
from selfconf.sdk import Component, Signal
from selfconf.testing import MemoryEcology
from tests.composites.composite_house import (
    PREFIXES,
    lost,
)

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
