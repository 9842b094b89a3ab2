"""Candidates are tried by preference, then by name."""

from __future__ import annotations

from decimal import Decimal

from selfconf.model.candidate_order import candidate_order
from selfconf.model.profile import Profile
from selfconf.model.term import IRI


def test_the_preferred_come_first_and_names_decide_between_equals() -> None:
    said = {"b": "2", "a": "2", "c": "10", "d": "-1", "e": "2.0000000000000000000000000000001"}
    profiles = [Profile(IRI(f"urn:{name}"), frozenset(), preference=Decimal(value)) for name, value in said.items()]
    assert [one.component[4:] for one in sorted(profiles, key=candidate_order)] == ["c", "e", "a", "b", "d"]
