"""Configurations as values."""

from __future__ import annotations

from itertools import permutations

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.term import IRI


def test_a_configuration_knows_its_components_and_their_roles() -> None:
    configuration = Configuration(
        IRI("urn:t"),
        (Assignment(IRI("urn:r"), (IRI("urn:a"), IRI("urn:b"))), Assignment(IRI("urn:s"), (IRI("urn:c"),))),
    )
    assert configuration.components == (IRI("urn:a"), IRI("urn:b"), IRI("urn:c"))
    assert configuration.role_of(IRI("urn:b")) == IRI("urn:r")
    assert configuration.role_of(IRI("urn:x")) is None


def test_connections_have_an_order_that_does_not_depend_on_where_they_came_from() -> None:
    a, b = IRI("urn:a"), IRI("urn:b")
    first, second, third = Connection(a, "x", b, "y"), Connection(a, "y", b, "x"), Connection(b, "x", a, "y")
    for arrived in permutations((first, second, third)):
        assert sorted(arrived) == [first, second, third]


def test_a_role_that_nobody_plays_belongs_to_the_configuration_too() -> None:
    configuration = Configuration(IRI("urn:t"), (Assignment(IRI("urn:r"), ()),))
    assert configuration
    assert (configuration.components, configuration.connections) == ((), ())
