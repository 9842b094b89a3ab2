"""The actuators inside of a composite rest for as long as all tasks lack a part that the composite acts for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from selfconf.model.term import Literal, Term
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, Release, Reserve, Wire
from tests.lab import Lab, iri
from tests.sdk.stage import KEYS, THEM, US, apply, release, reserve

BASE = {
    "base": """:base a sc:Component, :Base ; sc:shareable true ; sc:grounding [ sc:template :driving ] ;
        sc:hasInput [ sc:name "goal" ; sc:signalType :Goal ; sc:optional true ] ;
        sc:hasParameter [ sc:name "speed" ; sc:parameterType :Speed ] .
        :driving a sc:Template ; sc:parameter :speed ; sc:roles ( :pilot :motor ) ;
            sc:hasInput [ sc:name "goal" ; sc:signalType :Goal ; sc:of :pilot ] .
        :speed a sc:Parameter ; sc:name "speed" ; sh:nodeKind sh:Literal .
        :pilot a sc:Role ; sh:class :Pilot ; sc:feeds :motor ;
            sc:sets [ sc:parameterType :Speed ; sc:value :speed ] .
        :motor a sc:Role ; sh:class :Motor .""",
    "pilot": ':pilot-1 a sc:Component, :Pilot ; sc:hasOutput [ sc:name "turn" ; sc:signalType :Turn ] ;'
    ' sc:hasInput [ sc:name "goal" ; sc:signalType :Goal ; sc:optional true ] ;'
    ' sc:hasParameter [ sc:name "rate" ; sc:parameterType :Speed ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "turn" ; sc:signalType :Turn ] .',
}
SLOW: Mapping[str, Term] = {"speed": Literal("slow")}
FAST: Mapping[str, Term] = {"speed": Literal("fast")}


class Motor:
    """An ecology with a composite that tests call themselves, and the motor inside."""

    def __init__(self, folder: Path) -> None:
        self.lab = Lab(folder, advertised=BASE)
        self.lab.site("home", *BASE)
        for name in ("pilot", "motor"):
            self.lab.component(name)
        self.caller = self.lab.network.node()
        self.leave = {task: self.caller.announce(task) for task in (US, THEM)}
        self.lab.let_pass(3.0)

    def call(self, *messages: Reserve | Apply | Release) -> None:
        """Call the composite, and let half a second pass after each call, in which the pilot issues something."""
        for message in messages:
            name = {Reserve: "reserve", Apply: "apply", Release: "release"}[type(message)]
            self.caller.ask(KEYS.call(iri("base"), name), encode(message), 1.0, lambda replies: None)
            self.lab.let_pass(0.3)
            if self.lab.runtimes["pilot"].active:
                self.lab.components["pilot"].emit("turn", 1)
            self.lab.let_pass(0.2)

    @property
    def turns(self) -> bool:
        """Whether the motor was started, and not stopped since."""
        said = [one[0] for one in self.lab.components["motor"].said if one[0] in ("started", "stopped")]
        return said[-1:] == ["started"]


@pytest.fixture
def motor(tmp_path: Path) -> Motor:
    """The motor, which turns for two tasks."""
    motor = Motor(tmp_path)
    for task in (US, THEM):
        motor.call(reserve(supervisor=task, values=SLOW), apply(1, task, values=SLOW))
    assert motor.turns
    return motor


@pytest.mark.parametrize("ends", ["release", "orphan"])
def test_the_inside_rests_when_the_task_lets_go_of_a_composite_that_lacked_nothing(motor: Motor, ends: str) -> None:
    motor.call(apply(2, THEM, values=SLOW, rests=True))
    assert motor.turns, "the other task lacks nothing"
    if ends == "release":
        motor.call(release(2, US))
    else:
        motor.leave[US]()
        motor.lab.let_pass(1.5)
    assert not motor.turns
    motor.call(apply(3, THEM, values=SLOW))
    assert motor.turns


def test_the_inside_rests_on_when_it_begins_anew(motor: Motor) -> None:
    motor.call(release(2, US), apply(2, THEM, values=FAST, rests=True))
    motor.lab.let_pass(2.0)
    assert ("rate", "fast") in motor.lab.components["pilot"].said
    assert not motor.turns
    motor.call(apply(3, THEM, values=FAST))
    assert motor.turns


def test_the_inside_rests_and_acts_again_also_where_another_optional_input_is_fed_than_before(motor: Motor) -> None:
    fed = {"goal": (Wire(iri("planner"), "goal"),)}
    motor.call(release(2, US), apply(2, THEM, values=SLOW, inputs=fed))
    assert motor.turns
    motor.call(apply(3, THEM, values=SLOW, rests=True))
    assert not motor.turns
    motor.call(apply(4, THEM, values=SLOW, inputs=fed))
    assert motor.turns
