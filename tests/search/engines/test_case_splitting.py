"""The cases by the values of free parameters hold every solution, and the least of theirs is the least of all."""

from __future__ import annotations

import random
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.wiring import counted, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import (
    any_by_clauses,
    case_splitting,
    hall_set,
    least_by_clauses,
    least_solution,
    value_cases,
)
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, ReducedProblem, pruned, reduced
from selfconf.search.strategies import first, solution
from tests.search.comparison import numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, iri, problems, rivalries


def depots(roles: int, asked: int, people: int, sites: int, share: float, seed: int, parameters: int = 1) -> Problem:
    """Roles that draw on one pool, all of one site for each parameter; a person works at a share of the sites."""
    rng = random.Random(seed)
    variables = tuple(
        Variable(iri(f"site{number}"), tuple(iri(f"s{number}-{k}") for k in range(sites)))
        for number in range(parameters)
    )
    pool = [
        Candidate(
            profile(f"p{number:03}"),
            tuple(sum(1 << k for k in range(sites) if rng.random() < share) or 1 for _ in variables),
        )
        for number in range(people)
    ]
    return counted([[one for one in pool if rng.random() < 0.6] for _ in range(roles)], [asked] * roles, [], variables)


@given(st.one_of(rivalries(), problems()))
@agreement()
def test_every_solution_is_one_of_some_case(problem: Problem) -> None:
    before = pruned(reduced(problem))
    cases = value_cases(before)
    if cases is None:
        return
    left = [{(role, one.number) for role, some in enumerate(case.options) for one in some} for case in cases]
    known = {(role, one.number) for role, some in enumerate(before.options) for one in some}
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        chosen = {(role, problem.candidates[role].index(one)) for role, some in enumerate(players) for one in some}
        assert not chosen <= known or any(chosen <= case for case in left)


@given(st.one_of(rivalries(), problems()))
@agreement(0.5)
def test_the_least_solution_of_all_is_that_of_some_case(problem: Problem) -> None:
    found = solution(LazyReduction(problem), Budget(None))
    before = reduced(problem)
    cases = value_cases(pruned(before))
    if cases is not None and not any(role.minimum == 0 for role in problem.roles):
        least = first._least_of_cases(cases, Budget(None), least_by_clauses)
        assert isinstance(least, list) == isinstance(found, list)
        if isinstance(found, list) and isinstance(least, list):
            assert [one.component for one in least] == [c.profile.component for some in found for c in some]


def by_hand(problem: Problem) -> list[list[int]] | None:
    """The least solution of a problem of roles for one component each, by trying all."""
    for places in product(*(range(len(some)) for some in problem.candidates)):
        players = [some[k] for some, k in zip(problem.candidates, places, strict=True)]
        agreed = [ANY_VALUE] * len(problem.variables)
        for one in players:
            agreed = [left & mask for left, mask in zip(agreed, one.admits, strict=True)]
        if len({one.profile.component for one in players}) == len(players) and all(agreed):
            return [[place] for place in places]
    return None


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("parameters", [1, 2])
def test_roles_that_draw_on_one_pool_get_the_least_solution(
    monkeypatch: pytest.MonkeyPatch, seed: int, parameters: int
) -> None:
    monkeypatch.setattr(first, "CANDIDATE_STEPS", 0)
    monkeypatch.setattr(first, "REDUCED_PACE", 0.0)
    problem = depots(4, 1, 9, 3, 0.5, seed, parameters)
    found, expected = solution(LazyReduction(problem), Budget(None)), by_hand(problem)
    assert not isinstance(found, Undecided)
    places = found and [[problem.candidates[role].index(one) for one in some] for role, some in enumerate(found)]
    assert places == expected


def bound_depots(seed: int, roles: int = 5, asked: int = 2, people: int = 20) -> Problem:
    """As `depots`, where each person also wants a signal of a role beside the own one, and issues two."""
    rng = random.Random(seed)
    variable = Variable(iri("site"), tuple(iri(f"s{k}") for k in range(4)))
    pool = [
        Candidate(
            profile(f"p{k:03}", [rng.randrange(4)], rng.sample(range(4), 2)),
            (ANY_VALUE if rng.random() < 0.2 else sum(1 << v for v in rng.sample(range(4), 2)),),
        )
        for k in range(people)
    ]
    edges = sorted({(a, b) for b in range(roles) for a in rng.sample(range(roles), 2) if a != b})
    return counted(
        [[one for one in pool if rng.random() < 0.5] for _ in range(roles)], [asked] * roles, edges, (variable,)
    )


def hard_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each problem count as one that no engine decides soon."""
    monkeypatch.setattr(first, "CANDIDATE_STEPS", 0)
    monkeypatch.setattr(first, "REDUCED_PACE", 0.0)
    for moment in ("UNSUPPORTED", "BRIEF"):
        monkeypatch.setattr(least_solution, moment, 0)


def test_what_clause_learning_decides_soon_is_not_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pysat")
    problem = bound_depots(3)
    assert value_cases(pruned(reduced(problem))) is not None
    hard_at_once(monkeypatch)
    divided: list[ReducedProblem] = []
    monkeypatch.setattr(first, "value_cases", divided.append)
    expected = solution(LazyReduction(problem), Budget(None))
    assert len(divided) == 1
    monkeypatch.setattr(least_solution, "UNSUPPORTED", 100)
    assert solution(LazyReduction(problem), Budget(None)) == expected
    assert len(divided) == 1


def test_cases_that_clause_learning_has_to_decide_are_decided_together(monkeypatch: pytest.MonkeyPatch) -> None:
    hard_at_once(monkeypatch)
    merged: list[list[ReducedProblem]] = []
    together = first._together

    def noted(cases: list[ReducedProblem]) -> ReducedProblem:
        merged.append(cases)
        return together(cases)

    monkeypatch.setattr(first, "_together", noted)
    for seed in range(40):
        problem = bound_depots(seed)
        found = solution(LazyReduction(problem), Budget(None))
        assert not isinstance(found, Undecided)
        undivided = numbers(least_by_clauses(pruned(reduced(problem)), Budget(None)))
        assert undivided == (
            found and [problem.candidates[role].index(one) for role, some in enumerate(found) for one in some]
        )
    assert len(merged) > 3


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("parameters", [1, 2])
def test_each_value_that_leaves_too_few_is_seen_without_counting_by_cases(seed: int, parameters: int) -> None:
    """Clause learning alone has needed half a minute, and a minute has not been enough."""
    problem = depots(6, 4, 40, 6, 0.5, seed) if parameters == 1 else depots(8, 3, 40, 8, 0.7, seed, 2)
    before = pruned(reduced(problem))
    assert hall_set(before.slots, before.components()) is None
    assert not isinstance(solution(LazyReduction(problem), Budget(20_000)), Undecided)


def test_any_solution_is_one_of_the_first_case_that_has_one() -> None:
    problem = depots(6, 4, 40, 6, 0.5, 1)
    found = solution(LazyReduction(problem), Budget(20_000), any_by_clauses)
    assert isinstance(found, list)
    assert len({one.profile.component for some in found for one in some}) == 24


def free(case: ReducedProblem) -> int:
    """How many parameters have a choice among several values."""
    return sum(len(case_splitting._values(case, variable)) > 1 for variable in range(len(case.values)))


def test_what_has_too_many_values_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    before = pruned(reduced(depots(4, 2, 20, 6, 0.5, 1, parameters=2)))
    for most, left in ((36, 0), (35, 1), (6, 1)):
        monkeypatch.setattr(case_splitting, "MOST_CASES", most)
        cases = value_cases(before)
        assert cases
        assert {free(case) for case in cases} == {left}
    monkeypatch.setattr(case_splitting, "MOST_CASES", 5)
    assert value_cases(before) is None


def test_there_are_no_cases_where_most_values_leave_enough_components() -> None:
    before = pruned(reduced(depots(4, 1, 20, 40, 0.9, 1)))
    assert value_cases(before) is None


def test_values_that_mostly_leave_too_few_components_have_cases() -> None:
    cases = value_cases(pruned(reduced(depots(6, 4, 60, 40, 0.4, 2))))
    assert cases is not None
    assert 8 < len(cases) < 20


@pytest.mark.parametrize("seed", [1, 2, 4])
def test_a_case_is_not_divided_again(monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    """Of six parameters four have cases; cases of cases, and of these, took longer than anybody waits."""
    hard_at_once(monkeypatch)
    divided: list[ReducedProblem] = []

    def noted(given: ReducedProblem) -> list[ReducedProblem] | None:
        divided.append(given)
        assert len(divided) == 1
        return value_cases(given)

    monkeypatch.setattr(first, "value_cases", noted)
    problem = depots(6, 1, 12, 4, 0.7, seed, parameters=6)
    assert isinstance(solution(LazyReduction(problem), Budget(None)), list)
    assert divided


def test_a_parameter_that_few_constrain_has_no_cases() -> None:
    """Whatever hour is given for something, those who have no hours for it are left."""
    variable = Variable(iri("hour"), (iri("nine"), iri("ten")))

    def pool(busy: int) -> list[Candidate]:
        return [Candidate(profile(f"p{k}", (), [k]), (1 << k % 2 if k < busy else ANY_VALUE,)) for k in range(12)]

    def cases(busy: int) -> list[ReducedProblem] | None:
        # A role of which no one has hours for it does not count.
        idle = [Candidate(profile(f"q{k}"), (ANY_VALUE,)) for k in range(20)]
        return value_cases(pruned(reduced(counted([pool(busy), pool(busy), idle], [1, 1, 1], [(0, 2)], (variable,)))))

    assert cases(7) is None
    assert len(cases(8) or ()) == len(["nine", "ten"])  # those who have any other hour have these as well


def test_where_each_value_leaves_more_than_enough_components_there_are_no_cases() -> None:
    variable = Variable(iri("site"), (iri("s"), iri("t")))

    def cases(people: int) -> list[ReducedProblem] | None:
        pool = [Candidate(profile(f"p{number}", (), [number]), (1 << number % 2,)) for number in range(people)]
        sinks = [Candidate(profile(f"sink{number}", [number]), (ANY_VALUE,)) for number in range(people)]
        return value_cases(pruned(reduced(counted([pool, pool, sinks], [1, 1, 1], [(0, 2)], (variable,)))))

    # Each may play two roles, and those of one site are half of the pool.
    assert len(cases(3) or ()) == len(["s"])
    assert cases(6) is None


def test_all_values_that_no_option_states_are_one_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(case_splitting, "SHARE_FREE", 1)
    variable = Variable(iri("site"), (iri("s"), iri("t")))
    pool = [Candidate(profile(f"p{number}"), (mask,)) for number, mask in enumerate((~1, 1, ANY_VALUE, ANY_VALUE))]
    cases = value_cases(pruned(reduced(counted([pool, pool], [2, 1], [], (variable,)))))
    assert cases
    assert [case.values for case in cases] == [(1,), (2,)]
    assert [[option.number for option in case.options[0]] for case in cases] == [[1, 2, 3], [0, 2, 3]]


def test_a_value_for_which_another_can_always_stand_is_no_case() -> None:
    variable = Variable(iri("site"), (iri("s"), iri("t"), iri("u"), iri("v")))

    def cases(*masks: int) -> list[tuple[int, ...]] | None:
        pool = [Candidate(profile(f"p{number}"), (mask,)) for number, mask in enumerate(masks * 2)]
        found = value_cases(pruned(reduced(counted([pool, pool[: len(masks)]], [1, 1], [], (variable,)))))
        return None if found is None else [case.values for case in found]

    # Who works at u works at t as well, and v is the same to everyone as s.
    assert cases(0b1001, 0b0110, 0b0010) == [(0b0001,), (0b0010,)]
    assert cases(0b1111, 0b1111) is None


def test_a_parameter_of_which_no_option_states_a_value_has_no_cases() -> None:
    variable = Variable(iri("site"), (iri("s"), iri("t")))
    pool = [Candidate(profile(f"p{number}"), (ANY_VALUE,)) for number in range(4)]
    assert value_cases(pruned(reduced(counted([pool, pool], [1, 1], [], (variable,))))) is None


def test_a_case_in_which_no_option_states_a_value_of_another_parameter_is_one() -> None:
    """With the first option goes the only statement about the second parameter."""
    variables = tuple(Variable(iri(name), (iri("s0"), iri("s1"))) for name in ("site", "shift"))
    pool = [Candidate(profile("p0"), (0b01, ~0b01)), Candidate(profile("p1"), (0b10, ANY_VALUE))]
    free_of_all = [Candidate(one.profile, (ANY_VALUE, ANY_VALUE)) for one in pool]
    problem = counted([pool, free_of_all], [1, 1], [], variables)
    cases = value_cases(pruned(reduced(problem)))
    assert cases is not None
    assert [[one.number for one in case.options[0]] for case in cases] == [[0], [1]]


@pytest.mark.parametrize("seed", range(4))
def test_persons_who_work_anywhere_do_not_hide_the_sites_that_leave_too_few(seed: int) -> None:
    """One instance of this kind was undecided after half a minute."""
    problem = bound_depots(seed, roles=8, asked=3, people=60)
    assert not isinstance(solution(LazyReduction(problem), Budget(20_000)), Undecided)


def test_no_case_is_left_out_that_has_a_solution() -> None:
    for seed in range(6):
        problem = depots(3, 1, 6, 2, 0.6, seed)
        cases = value_cases(pruned(reduced(problem))) or []
        possible = {case.values for case in cases}
        for value in (1, 2):
            pools = [[one for one in some if one.admits[0] & value] for some in problem.candidates]
            fits = any(len({one.profile.component for one in chosen}) == len(chosen) for chosen in product(*pools))
            assert not fits or not cases or (value,) in possible
