"""Probing removes options of which enumeration knows no solution, and no others that are in the least one."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.wiring import counted, profile
from selfconf.model.partition import Candidate
from selfconf.search.budget import Budget
from selfconf.search.engines import encoding, hall_set, probed, probing
from selfconf.search.engines.encoding import Encoding
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, ReducedProblem, pruned, reduced
from selfconf.search.strategies import solution
from tests.search.oracle import World
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, problems, rivalries


def licences(roles: int, people: int, asked: int, seed: int) -> Problem:
    """Roles that draw on one pool, where each person wants one licence and one role decides which are issued."""
    rng = random.Random(seed)
    issuers = [Candidate(profile(f"issuer{k}", (), [f"l{x}" for x in rng.sample(range(8), 5)])) for k in range(6)]
    pool = [Candidate(profile(f"p{k:03}", [f"l{rng.randrange(8)}"])) for k in range(people)]
    parts = [[one for one in pool if rng.random() < 0.5] for _ in range(roles)]
    return counted([issuers, *parts], [1, *([asked] * roles)], [(0, role + 1) for role in range(roles)])


def pairs(given_: ReducedProblem) -> set[tuple[int, int]]:
    """The options, each by its role and number."""
    return {(role, option.number) for role, options in enumerate(given_.options) for option in options}


@given(st.one_of(rivalries(), problems()))
@agreement()
def test_what_is_removed_is_in_no_solution(problem: Problem) -> None:
    before = pruned(reduced(problem))
    removed = pairs(before) - pairs(probed(before))
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        assert not removed & {
            (role, problem.candidates[role].index(one)) for role, chosen in enumerate(players) for one in chosen
        }


def test_an_option_is_removed_that_leaves_others_too_few_components() -> None:
    before = pruned(reduced(licences(7, 44, 4, 12)))
    assert hall_set(before.slots, before.components()) is None
    after = probed(before)
    assert pairs(after) < pairs(before)
    assert 0 < len(after.options[0]) < len(before.options[0])


def test_what_is_too_large_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probing, "MOST_PROBED", 10)
    before = pruned(reduced(licences(6, 40, 4, 0)))
    assert probed(before) is before


def test_a_choice_that_leaves_too_few_is_found_without_counting_by_cases() -> None:
    """Clause learning alone has needed more than a minute."""
    budget = Budget(20_000)
    assert isinstance(solution(LazyReduction(licences(7, 44, 4, 12)), budget), list)


@pytest.mark.parametrize("seed", [0, 4, 7, 17])
def test_without_solvers_options_are_tried_alone_before_depth_first_search_goes_on(seed: int) -> None:
    """Without that these are undecided after as many steps."""
    with without_solvers():
        assert solution(LazyReduction(licences(5, 20, 3, seed)), Budget(3_000)) is None


def test_what_trying_options_alone_rules_out_is_added_to_the_clauses() -> None:
    before = pruned(reduced(licences(7, 44, 4, 12)))
    removed = pairs(before) - pairs(probed(before))
    written = Encoding(before)
    literals = {
        literal: (role, option.number)
        for role, (some, options) in enumerate(zip(written.plays, before.options, strict=True))
        for literal, option in zip(some, options, strict=True)
    }
    clauses = written.probe()
    assert {literals[-literal] for (literal,) in clauses} == removed


def test_options_are_not_tried_alone_where_roles_share_no_component(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = counted([[Candidate(profile(f"{role}{k}")) for k in range(2)] for role in range(2)], [1, 1], [])
    monkeypatch.setattr(encoding, "probed", lambda _: pytest.fail("options were tried"))
    assert Encoding(reduced(problem)).probe() == []
