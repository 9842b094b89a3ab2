"""Configurations as values."""

from __future__ import annotations

from itertools import permutations

from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting, Wants
from selfconf.model.template import Interaction
from selfconf.model.term import IRI, Literal


def test_a_configuration_knows_its_components_and_their_roles() -> None:
    configuration = Configuration(
        IRI("urn:t"),
        (Assignment(IRI("urn:r"), (IRI("urn:a"), IRI("urn:b"))), Assignment(IRI("urn:s"), (IRI("urn:c"),))),
    )
    assert configuration.components == (IRI("urn:a"), IRI("urn:b"), IRI("urn:c"))
    assert configuration.role_of(IRI("urn:b")) == IRI("urn:r")
    assert configuration.role_of(IRI("urn:x")) is None


def test_a_configuration_is_true_also_without_roles() -> None:
    assert Configuration(IRI("urn:t"), ())


def test_connections_have_an_order_that_does_not_depend_on_where_they_came_from() -> None:
    a, b = IRI("urn:a"), IRI("urn:b")
    first, second, third = Connection(a, "x", b, "y"), Connection(a, "y", b, "x"), Connection(b, "x", a, "y")
    for arrived in permutations((first, second, third)):
        assert sorted(arrived) == [first, second, third]


def test_a_role_that_nobody_plays_belongs_to_the_configuration_too() -> None:
    configuration = Configuration(IRI("urn:t"), (Assignment(IRI("urn:r"), ()),))
    assert configuration
    assert (configuration.components, configuration.connections) == ((), ())


def test_an_interaction_connects_nothing_where_no_players_of_its_roles_are_connected_along_it() -> None:
    talker, listener, clock = IRI("urn:talker"), IRI("urn:listener"), IRI("urn:clock")
    source, sink, time, none = (IRI(f"urn:{name}-role") for name in ("source", "sink", "time", "none"))
    players = {source: (talker,), sink: (listener,), time: (clock,), none: ()}
    configuration = Configuration(
        IRI("urn:t"),
        tuple(Assignment(role, some) for role, some in players.items()),
        (Connection(talker, "words", listener, "text"),),
    )
    connects = [Interaction(source, sink), Interaction(source, sink, "words"), Interaction(source, sink, None, "text")]
    nothing = [Interaction(time, sink), Interaction(source, sink, "noise"), Interaction(source, sink, "words", "sound")]
    unplayed = [Interaction(none, sink), Interaction(source, none)]
    assert configuration.unconnected([*connects, *nothing, *unplayed]) == tuple(nothing)


def test_what_is_wanted_of_a_component_are_its_inputs_and_its_values() -> None:
    a, b, goal = IRI("urn:a"), IRI("urn:b"), Literal("(AT BEDROOM)")
    configuration = Configuration(
        IRI("urn:t"),
        (Assignment(IRI("urn:r"), (a, b)),),
        (Connection(a, "out", b, "in"),),
        (ParameterSetting(b, "goal", goal),),
    )
    assert configuration.wants(a) == Wants()
    assert configuration.wants(b) == Wants(frozenset({("in", a, "out")}), frozenset({("goal", goal)}))


def test_two_tasks_want_the_same_in_whatever_order_they_say_it() -> None:
    eye = IRI("urn:test:eye")
    one = Wants(frozenset({("in", eye, "a"), ("in", eye, "b")}), frozenset({("goal", Literal("x"))}))
    other = Wants(frozenset({("in", eye, "b"), ("in", eye, "a")}), frozenset({("goal", Literal("x"))}))
    assert one == other
    assert len({one, other, Wants()}) == 2
    assert one != Wants(one.inputs, frozenset({("goal", Literal("y"))}))
