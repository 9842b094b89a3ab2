"""The parameters of a component: which are set, when, and what a task may not set."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from selfconf.model.profile import OperationalParameter
from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Cause, Fail, Verdict
from selfconf.sdk.component import Refused
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    CAP_PROFILE,
    US,
    XSD,
    Stage,
    apply,
)


def test_parameters_are_set_by_name_and_as_values_of_python() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    given: list[tuple[Term, Any]] = [
        (Literal("(AT BEDROOM)"), "(AT BEDROOM)"),
        (IRI("urn:x"), "urn:x"),
        (Literal("3", IRI(XSD + "integer")), 3),
        (Literal("1", IRI(XSD + "unsignedInt")), 1),
        (Literal("0.5", IRI(XSD + "decimal")), 0.5),
        (Literal("0.5", IRI(XSD + "double")), 0.5),
        (Literal("0.5", IRI(XSD + "float")), 0.5),
        (Literal("true", IRI(XSD + "boolean")), True),
        (Literal("0", IRI(XSD + "boolean")), False),
    ]
    for value, _ in given:
        assert stage.call(apply(1, US, values={"goal": value})).verdict is Verdict.DONE
    assert stage.recorder.said[1:] == [("goal", value) for _, value in given]


def test_parameters_are_set_before_the_component_is_started_and_once() -> None:
    stage = Stage()
    for _ in range(2):
        assert stage.call(apply(1, US, values={"goal": Literal("x")})).verdict is Verdict.DONE
    assert stage.recorder.said == [("goal", "x"), ("started",)]


def test_a_parameter_that_changes_is_set_without_a_stop_and_the_others_are_not_set_again() -> None:
    parameters = tuple(OperationalParameter(name, IRI("urn:p:Goal")) for name in ("goal", "speed"))
    stage = Stage(profile=replace(CAP_PROFILE, parameters=parameters))
    stage.call(apply(1, US, values={"goal": Literal("x"), "speed": Literal("slow")}))
    stage.call(apply(2, US, values={"goal": Literal("x"), "speed": Literal("fast")}))
    assert stage.recorder.said == [("goal", "x"), ("speed", "slow"), ("started",), ("speed", "fast")]


def test_a_component_that_fails_and_is_started_again_has_its_parameters_set_again() -> None:
    stage = Stage()
    stage.call(apply(1, US, values={"goal": Literal("x")}))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    stage.call(apply(2, US, values={"goal": Literal("x")}))
    assert stage.recorder.said == [("goal", "x"), ("started",), ("stopped",), ("goal", "x"), ("started",)]


def test_a_component_that_refuses_a_parameter_is_not_started() -> None:
    class Picky(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            raise Refused

    stage = Stage(Picky())
    answer = stage.call(apply(1, US, values={"goal": Literal("x")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it refuses goal = x")
    assert stage.recorder.said == []
    assert stage.runtime.activation.phase is ActivationPhase.IDLE


def test_a_parameter_that_is_not_declared_or_no_number_is_refused_with_a_reason() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    answer = stage.call(apply(1, US, values={"colour": Literal("red")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it declares no parameter 'colour'")
    answer = stage.call(apply(1, US, values={"goal": Literal("three", IRI(XSD + "integer"))}))
    assert answer.verdict is Verdict.REFUSED
    assert "goal" in answer.detail


def test_a_change_that_is_refused_is_refused_again_when_it_is_asked_for_again() -> None:
    class Stubborn(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if value == "y":
                raise Refused("not that one")

    stage = Stage(Stubborn())
    stage.call(apply(1, US, values={"goal": Literal("x")}))
    for epoch in (2, 2, 3):
        answer = stage.call(apply(epoch, US, values={"goal": Literal("y")}))
        assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "not that one")
    assert stage.call(apply(4, US, values={"goal": Literal("z")})).verdict is Verdict.DONE
    assert stage.recorder.said[-2:] == [("goal", "y"), ("goal", "z")]


def test_a_component_that_fails_as_a_parameter_is_set_says_so_and_is_not_started() -> None:
    class Unable(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if value == "x":
                self.fail("cannot take it")
                self.fail("once more")

    stage = Stage(Unable())
    answer = stage.call(apply(1, US, values={"goal": Literal("x")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has failed")
    assert stage.fails == [Fail(CAP, "life-1", 1, Cause.FAIL, "cannot take it")]
    assert stage.recorder.said == [("goal", "x")]
    assert not stage.state().active
    again = stage.call(apply(1, US, values={"goal": Literal("y")}))
    assert (again.verdict, again.detail) == (Verdict.REFUSED, "it has failed"), "it stays failed for its epoch"
    assert stage.call(apply(2, US, values={"goal": Literal("y")})).active
    assert stage.recorder.said == [("goal", "x"), ("goal", "y"), ("started",)]
