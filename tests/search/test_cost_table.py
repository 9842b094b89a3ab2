"""Integers that are ordered as levels of cost are, with recruits that reward and those that cost."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, product

from selfconf.model.cost import CostTerm
from selfconf.search.cost_table import LEADING_LEVELS, CostTable
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.strategies.test_best import stating
from tests.search.strategies.test_best_recruited import stated
from tests.search.worlds import component, iri, problem


def test_combined_costs_are_ordered_as_levels_and_stand_for_them() -> None:
    players = [stated(component(f"p{k}"), latency=k / 2, error=3 - k) for k in range(3)]
    extras = [stated(component("saves"), latency=-2, error=1), stated(component("takes"), latency=1.5, error=-1)]
    terms = [(CostTerm(iri(name)),) for name in ("latency", "error")]
    given = stating(with_recruits(problem({"user": players}), *extras), *terms)
    table = CostTable(given, recruits=range(2))
    found = []
    for player, size in product(given.candidates[0], range(3)):
        for chosen in combinations(range(2), size):
            levels = table.levels([[player]], chosen)
            total = table.total([[player]], chosen)
            assert table.levels_of(total, 1) == levels
            found.append((total, levels))
    assert [levels for _, levels in sorted(found)] == sorted(levels for _, levels in found)
    assert len(found) == 12
    assert {levels[:LEADING_LEVELS] for _, levels in found} == {(Fraction(0), Fraction(0))}
