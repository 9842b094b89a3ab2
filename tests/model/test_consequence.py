"""The consequence of a failure, in words."""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI

A, B, C, ROLE, OTHER = (IRI(f"urn:{name}") for name in ("a", "b", "c", "role", "other"))
AFTER = Configuration(IRI("urn:t"), ())


def test_a_component_without_which_there_is_no_configuration_is_a_single_point_of_failure() -> None:
    fatal = Consequence(A, ROLE, Refusal(IRI("urn:t"), ()))
    assert fatal.fatal
    assert str(fatal) == "a (role): NONE, a single point of failure"


def test_what_comes_instead_is_told_with_what_moves_and_stops() -> None:
    assert not Consequence(A, ROLE, AFTER).fatal
    assert str(Consequence(A, ROLE, AFTER, (B,))) == "a (role): b"
    assert str(Consequence(A, ROLE, AFTER, (B, C))) == "a (role): b, c"
    assert str(Consequence(A, ROLE, AFTER, moved=((B, OTHER),))) == "a (role): b as other"
    assert str(Consequence(A, ROLE, AFTER, (B,), (C,))) == "a (role): b, and c would stop"


def test_a_component_that_nothing_replaces_was_not_needed() -> None:
    assert str(Consequence(A, ROLE, AFTER)) == "a (role): no component needed"


def test_names_are_as_they_are_asked_for() -> None:
    assert Consequence(A, ROLE, AFTER, (B,), (C,)).told(str.upper) == "URN:B, and URN:C would stop"
