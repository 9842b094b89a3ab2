"""An optimum counts what is not known of it."""

from __future__ import annotations

from fractions import Fraction

from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum
from selfconf.model.term import IRI


def test_each_term_without_a_number_is_unknown() -> None:
    lamp, price, weight = IRI("urn:lamp"), IRI("urn:price"), IRI("urn:weight")
    none = Optimum(Configuration(IRI("urn:t"), ()), (Fraction(1),), (Fraction(1),), (), proved=True)
    assert none.unknown_terms == 0
    two = Optimum(none.configuration, none.cost, none.bound, ((lamp, price), (lamp, weight)), proved=True)
    assert two.unknown_terms == 2
