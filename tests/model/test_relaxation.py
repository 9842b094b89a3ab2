"""Relaxations word themselves as requests."""

from __future__ import annotations

from selfconf.model.obstacle import WrongType
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Profile
from selfconf.model.relaxation import AcceptNearMiss
from tests.lab import iri


def test_a_repair_by_type_says_what_the_component_is_not() -> None:
    near = NearMiss(iri("r0"), iri("c1"), WrongType(iri("A1")))
    assert str(AcceptNearMiss(near, Candidate(Profile(iri("c1"))))) == "let c1 play r0, although it is no A1"
