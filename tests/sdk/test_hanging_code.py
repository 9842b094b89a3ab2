"""The code of a component on a real thread: where it hangs or is slow, the component is off all the same."""

from __future__ import annotations

import itertools
import threading
import time
from typing import Any

import pytest

from selfconf.bus.port import Urgency
from selfconf.model.term import IRI, Literal
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Release, Reserve, Stamp, Verdict, Wire
from selfconf.sdk.component import Component, Signal
from selfconf.sdk.runtime.supervision import GRACE
from tests.sdk.living import PATIENCE, LivingStage, until


class Hanging(Component):
    """Hangs where it is told to, until the end of the test."""

    component = "urn:c:lamp"

    def __init__(self, stage: LivingStage, where: str) -> None:
        self.stage, self.where, self.begun = stage, where, threading.Event()

    def hang(self, where: str) -> None:
        if where == self.where:
            self.began = time.monotonic()
            self.begun.set()
            self.stage.release_code.wait(PATIENCE)

    def started(self) -> None:
        self.every(0.05, lambda: self.hang("every"))
        self.hang("started")

    def parameter_set(self, name: str, value: Any) -> None:
        self.hang("parameter goal")

    def received(self, port: str, signal: Signal) -> None:
        self.hang("received")

    def stopped(self) -> None:
        self.hang("stopped")


LAMP = """:lamp a sc:Component, :Lamp ; sc:deadline [ sc:value 0.3 ; sc:unit unit:SEC ] ;
    sc:hasInput [ sc:name "level" ; sc:signalType :Level ] ; sc:hasOutput [ sc:name "light" ; sc:signalType :Light ] ;
    sc:hasParameter [ sc:name "goal" ; sc:parameterType :Goal ] ."""
BELL = ':bell a sc:Component, :Bell ; sc:hasOutput [ sc:name "ring" ; sc:signalType :Ring ] .'
SOURCE = IRI("urn:c:source")


def hanging(living: LivingStage, where: str, advertised: str = LAMP) -> Hanging:
    """A lamp that hangs as soon as it is activated, or gets a signal, or else once it is turned off."""
    lamp = living.component(living.advertised(Hanging, advertised)(living, where))
    inputs = {"level": (Wire(SOURCE, "level"),)}
    reserved = living.call("urn:c:lamp", "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: reserved)
    living.apply("urn:c:lamp", inputs=inputs, values={"goal": Literal("x")})
    if where == "received":
        assert until(lambda: lamp.active)
        source = living.caller.publisher(living.keys.output(SOURCE, "level"), Urgency.SIGNAL)
        until(lambda: source.put(b"1", encode(Stamp(SOURCE, "l", 1, 0.0))) or lamp.begun.is_set())
    assert where == "stopped" or lamp.begun.wait(PATIENCE)
    return lamp


@pytest.mark.parametrize("where", ["every", "received", "parameter goal", "started"])
def test_code_that_hangs_is_a_failure_within_half_a_second_of_its_deadline(living: LivingStage, where: str) -> None:
    lamp = hanging(living, where)
    assert until(lambda: living.fails)
    moment, fail = living.fails[0]
    assert (fail.component, fail.cause) == ("urn:c:lamp", Cause.HUNG)
    assert fail.detail == f"`{where}` has not returned within 0.3 s"
    assert 0.3 <= moment - lamp.began <= 0.8
    assert not lamp.active
    assert living.hangs == [f"urn:c:lamp: {fail.detail}"]
    state = living.call("urn:c:lamp", "state")
    assert until(lambda: state, 1.0)
    assert not state[0].active


def test_a_failure_that_another_thread_raises_while_a_parameter_is_set_is_heard_and_nothing_starts(
    living: LivingStage,
) -> None:
    class Watched(Hanging):
        on = False

        def started(self) -> None:
            self.on = True

    lamp = living.component(living.advertised(Watched, LAMP)(living, "parameter goal"))
    answers = living.apply("urn:c:lamp", inputs={"level": (Wire(SOURCE, "level"),)}, values={"goal": Literal("x")})
    assert lamp.begun.wait(PATIENCE)
    lamp.fail("the bulb is broken")
    living.release_code.set()
    assert until(lambda: answers)
    assert (answers[0].verdict, answers[0].detail) == (Verdict.REFUSED, "it has failed")
    assert [(fail.cause, fail.detail) for _, fail in living.fails] == [(Cause.FAIL, "the bulb is broken")]
    assert not lamp.on


@pytest.mark.parametrize("where", ["received", "started", "stopped"])
def test_code_goes_on_no_longer_than_a_release_may_take_where_its_configurator_is_gone(
    living: LivingStage, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    """Whatever its deadline: an actuator would act for nothing until then."""
    monkeypatch.setattr("selfconf.sdk.code_thread.TO_REST", 0.3)
    lamp = hanging(living, where, LAMP.replace("0.3", "60.0"))
    assert until(lambda: lamp.active)
    if where != "stopped":
        assert not until(lambda: living.hangs, 0.6), "it may take so long while it acts"
    living.leave()
    assert until(lambda: living.hangs)
    assert living.hangs == [
        f"urn:c:lamp: `{where}` has not returned within 0.3 s, though a component is to come to rest"
    ]


MOTOR = LAMP.replace("0.3", "60.0").replace(
    'sc:hasOutput [ sc:name "light" ; sc:signalType :Light ]', "sc:tolerates [ sc:value 0.1 ; sc:unit unit:SEC ]"
)


def test_an_actuator_that_is_blind_for_too_long_has_no_longer_to_come_to_rest_than_one_that_is_turned_off(
    living: LivingStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever its deadline: it would go on by what is not true any more. Its source shows no life, and so is lost."""
    monkeypatch.setattr("selfconf.sdk.code_thread.TO_REST", 0.3)
    motor = hanging(living, "received", MOTOR)
    assert until(lambda: living.hangs)
    late = "`received` has not returned within 0.3 s, though a component is to come to rest"
    assert living.hangs == [f"urn:c:lamp: {late}"]
    assert until(lambda: living.fails)
    assert [(fail.cause, fail.detail) for _, fail in living.fails] == [(Cause.HUNG, late)]
    assert not motor.active


def test_what_keeps_another_component_of_its_program_from_coming_to_rest_has_not_failed(
    living: LivingStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that a site has started ends all the same, as the one that is to rest may act on."""
    monkeypatch.setattr("selfconf.sdk.code_thread.TO_REST", 0.3)

    class Bell(Component):
        component = "urn:c:bell"

    host = living.host()
    lamp = host.add(living.advertised(Hanging, LAMP.replace("0.3", "60.0"))(living, "started"))
    bell = host.add(living.advertised(Bell, BELL)())
    living.run(host)
    living.apply("urn:c:bell")
    assert until(lambda: bell.active)
    answers = living.apply("urn:c:lamp", values={"goal": Literal("x")})
    assert lamp.begun.wait(PATIENCE)
    living.call("urn:c:bell", "release", Release(2, living.supervisor, "task~1"))
    assert until(lambda: living.hangs)
    assert living.hangs == [
        "urn:c:lamp: `started` has not returned within 0.3 s, though a component is to come to rest"
    ]
    living.release_code.set()
    assert until(lambda: answers)
    assert ([answer.verdict for answer in answers], living.fails) == ([Verdict.DONE], [])


def test_starting_may_take_longer_where_no_deadline_is_stated(
    living: LivingStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.model.profile.START_DEADLINE", 0.7)
    lamp = hanging(living, "started", LAMP.replace("sc:deadline [ sc:value 0.3 ; sc:unit unit:SEC ] ;", ""))
    assert until(lambda: living.fails)
    moment, fail = living.fails[0]
    assert fail.detail == "`started` has not returned within 0.7 s"
    assert 0.7 <= moment - lamp.began <= 1.2


def test_a_release_turns_a_component_off_while_its_code_hangs_and_is_answered_when_that_has_returned(
    living: LivingStage,
) -> None:
    lamp = hanging(living, "every")
    assert lamp.active
    answers = living.call("urn:c:lamp", "release", Release(2, living.supervisor, "task~1"))
    assert until(lambda: not lamp.active, 1.0)
    state = living.call("urn:c:lamp", "state")
    assert until(lambda: state, 1.0)
    assert (state[0].active, state[0].task) == (False, "")
    assert answers == []
    living.release_code.set()
    assert until(lambda: answers)
    assert answers[0].verdict is Verdict.DONE


def test_a_component_whose_code_hangs_is_off_when_its_configurator_is_gone(living: LivingStage) -> None:
    slow = LAMP.replace("0.3", "60")
    lamp = living.component(living.advertised(Hanging, slow)(living, "every"))
    answers = living.apply("urn:c:lamp")
    assert lamp.begun.wait(PATIENCE)
    assert until(lambda: answers)
    living.leave()
    began = time.monotonic()
    assert until(lambda: not lamp.active, 5 * GRACE)
    assert GRACE - 0.1 <= time.monotonic() - began <= GRACE + 0.5
    assert until(lambda: [fail.cause for _, fail in living.fails] == [Cause.LET_GO])


def test_a_component_that_is_too_slow_for_its_signals_is_released_at_once_and_hears_the_newest(
    living: LivingStage,
) -> None:
    class Slow(Component):
        component = "urn:c:lamp"

        def __init__(self) -> None:
            self.heard: list[int] = []

        def received(self, port: str, signal: Signal) -> None:
            self.heard.append(signal.value)
            pause.wait(0.05)

    pause = threading.Event()
    lamp = living.component(living.advertised(Slow, LAMP)())
    answers = living.apply("urn:c:lamp", inputs={"level": (Wire(SOURCE, "level", 0.001),)})
    assert until(lambda: answers)
    source = living.caller.publisher(living.keys.output(SOURCE, "level"), Urgency.SIGNAL)
    numbers = itertools.count(1)

    def issue() -> bool:
        for number in itertools.islice(numbers, 500):
            source.put(b"%d" % number, encode(Stamp(SOURCE, "l", number, 0.0)))
        return len(lamp.heard) > 3

    assert until(issue)
    assert lamp.heard[-1] - lamp.heard[0] > len(lamp.heard)
    began = time.monotonic()
    released = living.call("urn:c:lamp", "release", Release(2, living.supervisor, "task~1"))
    assert until(lambda: released)
    assert time.monotonic() - began < 0.5
    heard = len(lamp.heard)
    issue()
    state = living.call("urn:c:lamp", "state")
    assert until(lambda: state)
    assert len(lamp.heard) == heard


def test_fail_may_be_raised_from_any_thread(living: LivingStage) -> None:
    lamp = living.component(living.advertised(Hanging, LAMP)(living, "nowhere"))
    answers = living.apply("urn:c:lamp")
    assert until(lambda: answers)
    lamp.fail("told to")
    assert not lamp.active
    assert until(lambda: living.fails)
    assert living.fails[0][1].detail == "told to"
