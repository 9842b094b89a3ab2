"""The least solution has interchangeable roles played in order."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.search.budget import Budget
from selfconf.search.engines.least_solution import any_by_clauses, least_by_clauses
from selfconf.search.engines.symmetry import interchangeable
from selfconf.search.problem import Problem
from selfconf.search.reduction import reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, component, problem, problems

pytest.importorskip("pysat")


@st.composite
def teams(draw: st.DrawFn) -> Problem:
    """Workers that draw on one pool, fed by one role and feeding another; some of them are not like the others."""
    signals = st.sampled_from("STU")
    pool = [
        component(f"c{k}", draw(st.sampled_from(["", "i:S", "i:T"])), f"o:{draw(signals)} p:{draw(signals)}")
        for k in range(draw(st.integers(2, 5)))
    ]
    workers = [f"w{k}" for k in range(draw(st.integers(2, 4)))]
    roles = {"source": [component(f"s{k}", outputs=f"o:{draw(signals)}") for k in range(2)]}
    roles |= {worker: pool if draw(st.integers(0, 5)) else pool[1:] for worker in workers}
    roles["sink"] = [component(f"k{k}", f"i:{draw(signals)} j:{draw(signals)}") for k in range(2)]
    links = [f"source>{worker}" for worker in workers if draw(st.integers(0, 5))]
    links += [f"{worker}>sink" for worker in workers if draw(st.integers(0, 5))]
    links += [f"{workers[0]}>{workers[1]}"] if not draw(st.integers(0, 4)) else []
    return problem(roles, " ".join(links))


@given(st.one_of(teams(), problems()))
@agreement()
def test_the_least_solution_is_found_where_roles_are_interchangeable(drawn: Problem) -> None:
    given_ = reduced(drawn)
    found = least_by_clauses(given_, Budget(100_000))
    assert numbers(found) == least_numbers(drawn)
    assert (any_by_clauses(given_, Budget(100_000)) is None) == (found is None)


@given(teams())
@agreement(0.3)
def test_exchanging_two_roles_takes_solutions_to_solutions(drawn: Problem) -> None:
    solutions = {
        tuple(tuple(c.profile.component for c in some) for some in players)
        for players in World(drawn.task, drawn.partition, drawn.hierarchy).solutions()
    }
    for one, other in interchangeable(reduced(drawn)):
        for solution in solutions:
            image = list(solution)
            image[one], image[other] = image[other], image[one]
            assert tuple(image) in solutions


def test_workers_that_do_the_same_are_interchangeable() -> None:
    pool = [component(f"c{k}", "i:S", "o:T") for k in range(4)]
    roles = {"source": [component("s", outputs="o:S")], "a": pool, "b": pool, "c": pool, "d": pool}
    given_ = problem(roles, "source>a source>b source>c source>d c>d")
    # What `c` could feed, nobody wants; but `d` has a source more.
    assert list(interchangeable(reduced(given_))) == [(1, 2), (2, 3)]
