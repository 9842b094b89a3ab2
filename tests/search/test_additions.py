"""Optional roles are used when that is what it takes, and no more of them than it takes."""

from __future__ import annotations

from collections import Counter
from itertools import product

from hypothesis import given

from selfconf.search.additions import MOST_ADDITIONS, asking_for, with_additions
from selfconf.search.problem import Problem
from tests.search.oracle import World
from tests.search.worlds import agreement, component, problem, problems


def solvable(problem: Problem) -> bool:
    """Whether there is a solution, by enumeration."""
    return World(problem.task, problem.partition, problem.hierarchy).first() is not None


@given(problems(roles=3, components=4))
@agreement(0.5)
def test_the_fewest_optional_roles_are_asked_for_that_make_a_solution_possible(problem: Problem) -> None:
    if solvable(problem):
        return
    found = with_additions(problem)
    counts = [range(MOST_ADDITIONS + 1) if role.minimum == 0 else range(1) for role in problem.roles]
    choices = (Counter(dict(enumerate(chosen))) for chosen in product(*counts) if 0 < sum(chosen) <= MOST_ADDITIONS)
    fewest = min(
        (
            sum(chosen.values())
            for chosen in choices
            if all(
                role.maximum is None or chosen[number] <= role.maximum
                for number, role in enumerate(problem.roles)
                if role.minimum == 0
            )
            and solvable(asking_for(problem, +chosen))
        ),
        default=None,
    )
    if found is None:
        # A role that feeds none is not asked for: it could help nobody.
        assert fewest is None
    else:
        added = sum(new.minimum - old.minimum for new, old in zip(found.roles, problem.roles, strict=True))
        assert added == fewest
        assert solvable(found)


def test_of_equally_few_the_first_role_is_asked() -> None:
    sources = [component("a", outputs="o:S")], [component("b", outputs="o:S")]
    given_ = problem(
        {"one": sources[0], "two": sources[1], "user": [component("user", "i:S")]},
        "one>user two>user",
        counts={"one": (0, 1), "two": (0, 1)},
    )
    found = with_additions(given_)
    assert found is not None
    assert [role.minimum for role in found.roles] == [1, 0, 1]


def test_where_a_role_lacks_candidates_nothing_is_tried() -> None:
    given_ = problem({"one": [component("a", outputs="o:S")], "user": []}, "one>user", counts={"one": (0, 1)})
    assert with_additions(given_) is None
