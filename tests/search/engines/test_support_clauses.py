"""Support clauses are true of every solution, and let propagation see what follows in both directions."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.graphs import coloured_parameters, tour
from benchmarks.search.families.puzzles import crossword
from benchmarks.search.families.rosters import hours
from selfconf.search.budget import Budget
from selfconf.search.engines import least_solution, support_clauses
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.least_solution import least_by_clauses, least_of_clauses
from selfconf.search.engines.support_clauses import clauses_of_needs
from selfconf.search.problem import Problem
from selfconf.search.reduction import pruned, reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, component, problem, problems, rivalries

WORDS = problem(
    {
        "across": [component(f"{letter}.{k}", outputs=f"o:{letter} p:Ending{k}") for letter in "ABC" for k in range(2)],
        "down": [component(f"from.{letter}", f"i:{letter}") for letter in "ABC"],
        "last": [component(f"to.{k}", f"i:Ending{k}") for k in range(2)],
    },
    "across>down across>last",
)
"""Two words for each letter that a third one begins with."""

MEETING = problem(
    {
        "host": [component("early"), component("later"), component("free")],
        "guest": [component("late"), component("both"), component("any")],
    },
    values={
        "host": {"early": 0b0011, "later": 0b1110, "free": 0b1010},
        "guest": {"late": 0b1100, "both": 0b0110, "any": 0b0101},
    },
    domain=("nine", "ten", "eleven", "noon"),
)
"""Who can come at some of four hours, each."""


@given(st.one_of(rivalries(), problems()), st.integers(1, 3))
@agreement()
def test_with_support_clauses_from_the_beginning_the_answer_is_the_least(problem: Problem, few: int) -> None:
    pytest.importorskip("pysat")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(support_clauses, "SHARE_FITTING", few)
        patch.setattr(least_solution, "UNSUPPORTED", 0)
        assert numbers(least_by_clauses(reduced(problem), Budget(10_000))) == least_numbers(problem)


@given(st.one_of(rivalries(), problems()), st.integers(1, 3))
@agreement()
def test_what_support_clauses_say_of_options_is_true_of_every_solution(problem: Problem, few: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(support_clauses, "SHARE_FITTING", few)
        encoding = Encoding(reduced(problem))
        options = {abs(literal) for literals in encoding.plays for literal in literals}
        added = [one for one in encoding.support() if isinstance(one, list) and options.issuperset(map(abs, one))]
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        names = [{c.profile.component for c in some} for some in players]
        playing = {
            literal if option.component in names[role] else -literal
            for role, (some, literals) in enumerate(zip(encoding.reduced.options, encoding.plays, strict=True))
            for option, literal in zip(some, literals, strict=True)
        }
        if all(names[role].issubset(some) for role, some in enumerate(map(set, encoding.reduced.components()))):
            assert all(playing.intersection(clause) for clause in added)


def naive(
    source: list[int], sink: list[int], needs: dict[int, tuple[list[int], list[int]]]
) -> set[tuple[frozenset[int], frozenset[int]]]:
    """Return what goes with options that support the same needs, option by option, where it is few."""
    alike: dict[frozenset[int], set[int]] = {}
    for one in source:
        alike.setdefault(frozenset(n for n, (_, supporting) in needs.items() if one in supporting), set()).add(one)
    fitting = {
        supported: frozenset(o for o in sink if all(n in supported for n, (having, _) in needs.items() if o in having))
        for supported in alike
    }
    return {
        (frozenset(some), fitting[supported])
        for supported, some in alike.items()
        if 2 * len(fitting[supported]) <= len(sink)
    }


@pytest.mark.parametrize("several", [False, True], ids=["one need each", "several needs each"])
@given(st.data())
def test_the_clauses_are_those_that_a_look_at_each_option_finds(several: bool, data: st.DataObject) -> None:
    source, sink, numbers_ = [1, 2, 3, 4, 5], [11, 12, 13, 14, 15, 16], [0, 1, 2]
    most = 3 if several else 1
    of_option = st.lists(st.sampled_from(numbers_), max_size=most, unique=True)
    chosen = {one: data.draw(of_option) for one in (*source, *sink)}
    needs = {n: ([o for o in sink if n in chosen[o]], [o for o in source if n in chosen[o]]) for n in numbers_}
    needs = {n: (having, supporting) for n, (having, supporting) in needs.items() if having and supporting}
    sums: dict[int, frozenset[int]] = {}

    def any_of(literals: list[int]) -> int:
        sums[100 + len(sums)] = frozenset(literals)
        return 99 + len(sums)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(support_clauses, "SHARE_FITTING", 2)
        found = [(sums[-one], frozenset(rest)) for one, *rest in clauses_of_needs(source, sink, needs, any_of)]
    assert len(found) == len(set(found))
    if found:
        assert set(found) == naive(source, sink, needs)


def implied_by(encoding: Encoding, literal: int) -> set[int]:
    """Return what propagation concludes from a literal."""
    solvers = pytest.importorskip("pysat.solvers")
    with solvers.Minicard(bootstrap_with=list(encoding.clauses())) as solver:
        for bound in encoding.bounds:
            solver.add_atmost(list(bound.literals), bound.most)
        return set(solver.propagate([literal])[1])


def test_without_an_option_propagation_excludes_what_only_that_one_can_do_with() -> None:
    encoding = Encoding(reduced(WORDS))
    across, down, _ = encoding.plays
    assert not implied_by(encoding, -down[0]).intersection(across, map(int.__neg__, across))
    encoding.support()
    assert implied_by(encoding, -down[0]).issuperset([-across[0], -across[1]])


def test_an_option_excludes_those_that_admit_other_values_alone() -> None:
    encoding = Encoding(reduced(MEETING))
    (early, _, _), (late, both, _) = encoding.plays
    assert encoding.valued
    assert -late not in implied_by(encoding, early)
    assert [one for one in encoding.exclude() if isinstance(one, list)]
    assert -late in implied_by(encoding, early)
    assert -both not in implied_by(encoding, early)


def test_where_values_have_no_literals_none_are_excluded() -> None:
    encoding = Encoding(reduced(WORDS))
    assert not encoding.valued
    assert not encoding.exclude()


@pytest.mark.parametrize(
    ("made", "share"),
    [
        (lambda: crossword(4, 100, 6, 501), 20),
        (lambda: coloured_parameters(40, 4, 8.0, 501), 4),
        (lambda: tour(24, 4.0, 501), 4),
        (lambda: hours(7, 36, 8, 12, 501), 4),
    ],
    ids=["needs", "values", "needs of roles that share components", "several values of one option"],
)
def test_with_support_clauses_a_solver_meets_a_fraction_of_the_conflicts(
    made: Callable[[], Problem], share: int
) -> None:
    pytest.importorskip("pysat")
    given_ = pruned(reduced(made()))
    conflicts = []
    for supported in (False, True):
        encoding = Encoding(given_)
        if supported:
            encoding.support()
            encoding.exclude()
        with ClauseSolver(given_, encoding=encoding) as clauses:
            assert clauses.solve((), Budget()) is True
            assert isinstance(least_of_clauses(clauses, Budget()), list)
            conflicts.append(clauses.conflicts)
    assert conflicts[1] * share < conflicts[0]
