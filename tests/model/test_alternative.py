"""A candidate beside another one: what it costs more, level by level."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

from selfconf.model.alternative import Alternative
from selfconf.model.term import IRI


def test_what_it_costs_more_is_told_where_both_have_a_total() -> None:
    one = Alternative(IRI("urn:a"), Decimal(0), (), 0, False, "possible", (Fraction(3), Fraction(1)))
    other = one._replace(total=(Fraction(1), Fraction(2)))
    assert one.extra(other) == (2, -1)
    assert one.extra(None) == ()
    assert one.extra(other._replace(total=())) == ()
    assert one._replace(total=()).extra(other) == ()
