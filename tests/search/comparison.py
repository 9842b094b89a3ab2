"""What tests of the search compare: solutions as the numbers of candidates, slot by slot."""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Undecided
from selfconf.search.problem import Problem
from selfconf.search.reduction import Option
from selfconf.search.strategies import first
from tests.search.oracle import World


def least_pairs(problem: Problem) -> list[tuple[int, int]] | None:
    """Return the least solution by enumeration: for each slot its role and the number of its candidate."""
    players = next(World(problem.task, problem.partition, problem.hierarchy).solutions(), None)
    if players is None:
        return None
    return [(role, problem.candidates[role].index(c)) for role, chosen in enumerate(players) for c in chosen]


def least_numbers(problem: Problem) -> list[int] | None:
    """Return the least solution by enumeration: for each slot the number of its candidate."""
    pairs = least_pairs(problem)
    return None if pairs is None else [number for _, number in pairs]


def numbers(found: list[Option] | Undecided | None) -> list[int] | None:
    """Return the chosen options of an engine by the numbers of their candidates."""
    assert not isinstance(found, Undecided)
    return None if found is None else [option.number for option in found]


def first_configuration(problem: Problem) -> Configuration | None:
    """Return the answer of the strategy `first`, if it is a configuration."""
    answer = first.search(problem)
    return answer if isinstance(answer, Configuration) else None
