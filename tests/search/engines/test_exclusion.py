"""Groups of options exclude each other, and what counting them says is true of every solution."""

from __future__ import annotations

import random
from itertools import combinations, pairwise
from operator import eq, ne

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.graphs import colouring
from benchmarks.search.families.scaling import distinct
from benchmarks.search.families.wiring import counted, in_pairs, iri, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.template import Interaction, Role, Task, Template
from selfconf.search.budget import Budget
from selfconf.search.engines.conflict_graph import ConflictGraph
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.exclusion import exclusive_groups
from selfconf.search.engines.least_solution import least_by_clauses
from selfconf.search.engines.odd_sets import odd_sets
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction import ReducedProblem, pruned, reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, packings, problems, rivalries


@given(st.one_of(rivalries(), packings(), problems()))
@agreement()
def test_groups_and_what_counting_proves_hold_in_every_solution(problem: Problem) -> None:
    given_ = pruned(reduced(problem))
    found = exclusive_groups(given_)
    options = [option for some in given_.options for option in some]
    sets = odd_sets(
        found.groups, [[k for k, some in enumerate(found.groups) if n in some] for n in range(len(options))]
    )
    place = {(option.kind.role, option.number): number for number, option in enumerate(options)}
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        assert not found.impossible
        pairs = [(role, problem.candidates[role].index(c)) for role, chosen in enumerate(players) for c in chosen]
        if not all(pair in place for pair in pairs):
            continue  # a solution with a dominated candidate
        playing = {place[pair] for pair in pairs}
        assert all(len(playing & set(group)) <= 1 for group in found.groups)
        assert all(len(playing & some) <= most for some, most in sets.items())
        assert all(playing & set(some) for some in found.played)
        assert not playing & found.excluded


@given(st.one_of(rivalries(), packings()))
@agreement()
def test_clause_learning_with_groups_finds_the_least_solution(problem: Problem) -> None:
    pytest.importorskip("pysat")
    assert numbers(least_by_clauses(reduced(problem), Budget(10_000))) == least_numbers(problem)


def test_as_many_components_as_slots_are_all_played_where_nothing_else_excludes() -> None:
    found = exclusive_groups(reduced(distinct(4, 4)))
    assert [*map(list, found.played)] == [*map(list, found.groups)] == [[k, k + 4, k + 8, k + 12] for k in range(4)]
    assert exclusive_groups(reduced(distinct(4, 3))).crowded == {0, 1, 2, 3}


def test_groups_take_the_place_of_the_needs_that_they_state() -> None:
    given_ = pruned(reduced(colouring(12, 3, 4.0, 1)))
    used = {need for options in given_.options for option in options for need in option.kind.needs}
    assert exclusive_groups(given_).stated == used


def in_step(excluding: int, following: int) -> ReducedProblem:
    """Roles of seven components: some that are to differ pair by pair, and others, each of which follows the last."""
    last = excluding + following
    alike = dict.fromkeys(pairwise(range(excluding, last)), eq)
    return reduced(in_pairs([range(7)] * last, {**dict.fromkeys(combinations(range(excluding), 2), ne), **alike}))


def test_few_conflicts_among_many_needs_that_few_options_meet_stay_needs() -> None:
    assert exclusive_groups(in_step(3, 0)).stated
    found = exclusive_groups(in_step(3, 60))
    assert (found.groups, found.stated) == ((), frozenset())


@pytest.mark.parametrize("shared", [False, True])
def test_where_no_three_roles_have_conflicts_with_each_other_needs_stay_needs(shared: bool) -> None:
    """A square of four roles has none; with a component in two of its corners it has two triangles."""
    square = in_pairs([range(5)] * 4, dict.fromkeys([(0, 1), (1, 2), (2, 3), (0, 3)], ne))
    both = Candidate(profile("both"))
    corners = [(*some, both) if shared and role in (0, 2) else some for role, some in enumerate(square.candidates)]
    found = exclusive_groups(reduced(Problem(square.task, Partition(tuple(corners)))))
    assert bool(found.stated) == shared
    assert bool(found.groups) == shared


def test_pigeonholes_are_counted_beside_many_needs_that_few_options_meet() -> None:
    assert exclusive_groups(in_step(8, 100)).crowded == {*range(8)}


def lectures(number: int, asked: int = 1) -> ReducedProblem:
    """So many lectures, all of them by one teacher, each of which may be at one of three times."""
    busy = tuple(Variable(iri(f"time{t}"), tuple(iri(f"lecture{k}") for k in range(number))) for t in range(3))
    parts = [
        [
            Candidate(profile(f"lecture{k}.{t}"), tuple(1 << k if t == time else ANY_VALUE for time in range(3)))
            for t in range(3)
        ]
        for k in range(number)
    ]
    return pruned(reduced(counted(parts, [asked] * number, (), busy)))


def test_lectures_of_one_teacher_have_a_time_each() -> None:
    assert exclusive_groups(lectures(4)).crowded == {0, 1, 2, 3}
    groups = exclusive_groups(lectures(3))
    assert not groups.impossible
    assert groups.settled == {0, 1, 2}
    assert sorted(groups.groups) == [[0, 3, 6], [1, 4, 7], [2, 5, 8]]


def test_where_groups_say_all_of_values_these_have_no_literals() -> None:
    given_ = lectures(3)
    assert Encoding(given_).top == sum(map(len, given_.options))


def test_a_role_of_several_slots_draws_on_values_as_often() -> None:
    given_ = lectures(2, asked=2)
    assert exclusive_groups(given_).crowded == {0, 1}  # four slots, three times, each of one lecture
    assert least_by_clauses(given_, Budget()) is None
    assert least_by_clauses(lectures(1, asked=2), Budget()) is not None


def test_a_role_of_several_slots_may_have_one_value_in_all_of_them() -> None:
    site = (Variable(iri("site"), tuple(map(iri, "nsew"))),)
    parts = [[Candidate(profile(f"{name}{k}"), (values,)) for k in range(3)] for name, values in (("a", 3), ("b", 12))]
    assert not exclusive_groups(pruned(reduced(counted(parts, [2, 2], (), site)))).settled
    assert least_by_clauses(pruned(reduced(counted(parts[:1], [2], (), site))), Budget()) is not None


def test_roles_that_may_agree_on_a_value_do_not_exclude_each_other() -> None:
    site = (Variable(iri("site"), (iri("north"), iri("south"))),)
    parts = [[Candidate(profile(f"{name}{k}"), (1 << k,)) for k in range(2)] for name in "ab"]
    assert not exclusive_groups(pruned(reduced(counted(parts, [1, 1], (), site)))).settled


def contested(halls: int, carts: int) -> ReducedProblem:
    """Carts of one pool, one for each hall, that hear a beacon of the hall and feed a belt, which hears both."""
    rng = random.Random(halls)
    pool = [profile(f"cart{k:03}", (f"x{k % 2}",), (f"y{k % 3}", f"y{(k + 1) % 3}")) for k in range(carts)]
    parts, links = list[tuple[Candidate, ...]](), list[Interaction]()
    for hall in range(halls):
        beacon, cart, belt = (iri(f"role{3 * hall + k}") for k in range(3))
        parts += [
            tuple(Candidate(profile(f"beacon{hall}.{k}", (), (f"x{k}", f"z{k}"))) for k in range(2)),
            tuple(Candidate(some) for some in rng.sample(pool, 3)),
            tuple(Candidate(profile(f"belt{hall}.{k}", (f"y{k}", f"z{k % 2}"))) for k in range(3)),
        ]
        links += [Interaction(beacon, cart), Interaction(cart, belt, None, "i0"), Interaction(beacon, belt, None, "i1")]
    template = Template(iri("template"), tuple(Role(iri(f"role{k}")) for k in range(len(parts))), tuple(links))
    return pruned(reduced(Problem(Task(template), Partition(tuple(parts)))))


def test_components_are_groups_as_they_stand_where_roles_that_share_them_do_not_feed_each_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ConflictGraph, "add_components", lambda _: pytest.fail("components were entered pair by pair"))
    given_ = contested(4, 9)
    found = exclusive_groups(given_)
    assert found.stated
    options = [option for some in given_.options for option in some]
    playing = [number for number, option in enumerate(options) if "cart" in option.component]
    for one, other in combinations(playing, 2):
        if options[one].component == options[other].component:
            assert any({one, other} <= set(group) for group in found.groups)


def test_components_of_roles_that_feed_each_other_are_part_of_the_graph(monkeypatch: pytest.MonkeyPatch) -> None:
    entered = list[bool]()
    add = ConflictGraph.add_components
    monkeypatch.setattr(ConflictGraph, "add_components", lambda graph: entered.append(True) or add(graph))
    pairs = in_pairs([range(4)] * 3, dict.fromkeys(combinations(range(3), 2), ne))
    both = Candidate(profile("both"))
    parts = [(*some, both) if role < 2 else some for role, some in enumerate(pairs.candidates)]
    exclusive_groups(reduced(Problem(pairs.task, Partition(tuple(parts)))))
    assert entered


@pytest.mark.parametrize("halls", range(2, 6))
def test_contested_components_are_shared_out_as_depth_first_search_does(halls: int) -> None:
    pytest.importorskip("pysat")
    for carts in range(halls, halls + 4):
        problem = contested(halls, max(carts, 3))
        assert numbers(least_by_clauses(problem, Budget())) == numbers(first_solution(problem, Budget()))
