"""Configurations as values."""

from __future__ import annotations

from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.term import IRI


def test_a_configuration_knows_its_components_and_their_roles() -> None:
    configuration = Configuration(
        IRI("urn:t"),
        (Assignment(IRI("urn:r"), (IRI("urn:a"), IRI("urn:b"))), Assignment(IRI("urn:s"), (IRI("urn:c"),))),
    )
    assert configuration.components == (IRI("urn:a"), IRI("urn:b"), IRI("urn:c"))
    assert configuration.role_of(IRI("urn:b")) == IRI("urn:r")
    assert configuration.role_of(IRI("urn:x")) is None
