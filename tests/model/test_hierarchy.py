"""The hierarchy of classes and properties."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.term import IRI


def test_offered_matches_wanted_if_wanted_is_offered_itself_or_above_it() -> None:
    above = Hierarchy([(IRI("urn:a"), IRI("urn:b"))])
    assert above.matches(IRI("urn:a"), IRI("urn:b"))
    assert not above.matches(IRI("urn:b"), IRI("urn:a"))
    assert not NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:b"))
    assert NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:a"))
