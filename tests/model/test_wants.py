"""What a task wants of a component, as a value."""

from __future__ import annotations

from selfconf.model.term import IRI, Literal
from selfconf.model.wants import Wants

EYE = IRI("urn:test:eye")


def test_two_tasks_want_the_same_in_whatever_order_they_say_it() -> None:
    one = Wants(frozenset({("in", EYE, "a"), ("in", EYE, "b")}), frozenset({("goal", Literal("x"))}))
    other = Wants(frozenset({("in", EYE, "b"), ("in", EYE, "a")}), frozenset({("goal", Literal("x"))}))
    assert one == other
    assert len({one, other, Wants()}) == 2
    assert one != Wants(one.inputs, frozenset({("goal", Literal("y"))}))
