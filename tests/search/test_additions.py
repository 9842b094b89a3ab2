"""Optional roles are used when that is what it takes, and no more of them than it takes."""

from __future__ import annotations

from collections import Counter
from itertools import product

import pytest
from hypothesis import given

from selfconf.composition import Strategy, searches
from selfconf.composition.searches import Searches
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Recruit
from selfconf.model.refusal import Refusal, Undecided
from selfconf.search import additions
from selfconf.search.additions import MOST_OF_A_ROLE, asking_for, with_additions
from selfconf.search.problem import Problem
from tests.search.oracle import World
from tests.search.worlds import agreement, component, problem, problems


def solvable(problem: Problem) -> bool:
    """Whether there is a solution, by enumeration."""
    return World(problem.task, problem.partition, problem.hierarchy).first() is not None


def choices(problem: Problem) -> list[Counter[int]]:
    """What may be asked for of the optional roles that feed others, the fewest first, then by their order."""
    optional = [k for k, role in enumerate(problem.roles) if role.minimum == 0 and problem.sinks[k]]
    rooms = [problem.roles[k].maximum for k in optional]
    most = [
        min(len(problem.candidates[k]), 99 if room is None else room) for k, room in zip(optional, rooms, strict=True)
    ]
    counts = (dict(zip(optional, some, strict=True)) for some in product(*(range(n + 1) for n in most)))
    return sorted((+Counter(some) for some in counts), key=lambda some: (some.total(), sorted(some.elements())))


@given(problems(roles=3, components=4))
@agreement(0.5)
def test_the_fewest_optional_roles_are_asked_for_that_make_a_solution_possible(problem: Problem) -> None:
    if solvable(problem):
        return
    found = with_additions(problem)
    expected = next((one for one in choices(problem) if solvable(asking_for(problem, one))), None)
    assert not isinstance(found, Undecided)
    assert (found and found.roles) == (expected and asking_for(problem, expected).roles)


def fan(number: int, optional: int, most: int = 1) -> Problem:
    """A user of so many signals, the last of so many optional roles that issue a signal each."""
    names = [f"r{k:02}" for k in range(optional)]
    parts = {name: [component(f"{name}-{c}", outputs=f"o:S{k}") for c in range(most)] for k, name in enumerate(names)}
    wanted = " ".join(f"i{k}:S{k}" for k in range(optional - number, optional))
    return problem(
        {**parts, "user": [component("user", wanted)]},
        " ".join(f"{name}>user" for name in names),
        counts=dict.fromkeys(names, (0, most)),
    )


@pytest.mark.parametrize(("number", "optional"), [(1, 70), (2, 30), (6, 12), (20, 20)])
def test_as_many_optional_roles_are_asked_for_as_it_takes(number: int, optional: int) -> None:
    given_ = fan(number, optional)
    found = with_additions(given_)
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [*(0,) * (optional - number), *(1,) * number, 1]


def test_one_role_may_be_asked_for_several_components() -> None:
    sources = [component(f"s{k}", outputs=f"o:S{k}") for k in range(5)]
    both = component("both", outputs="o:S0 p:S1 q:S2 r:S3")
    given_ = problem(
        {"many": sources, "rare": [both], "user": [component("user", "i0:S0 i1:S1 i2:S2 i3:S3 i4:S4")]},
        "many>user rare>user",
        counts={"many": (0, None), "rare": (0, 1)},
    )
    found = with_additions(given_)
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [1, 1, 1]


def test_optional_roles_that_feed_each_other_are_asked_for_as_many_as_it_takes() -> None:
    user, first = component("user", "i:S"), component("first", "t:T", "s:S")
    counts: dict[str, tuple[int, int | None]] = {"aid": (0, None), "other": (0, None)}
    itself = problem({"user": [user], "aid": [first, component("last", "", "t:T")]}, "aid>user aid>aid", counts)
    found = with_additions(itself)
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [1, 2]
    between = {"aid": [first, component("last", "", "u:U")], "other": [component("middle", "u:U", "t:T")]}
    found = with_additions(problem({"user": [user], **between}, "aid>user aid>other other>aid", counts))
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [1, 2, 1]


def test_of_many_that_want_the_same_of_each_other_few_are_tried() -> None:
    peers = [component(f"peer{number}", "in:T", "out:T") for number in range(2 * MOST_OF_A_ROLE)]
    given_ = problem({"peer": peers, "user": [component("user", "i:S")]}, "peer>peer peer>user", {"peer": (0, None)})
    assert with_additions(given_) is None


def test_where_none_issues_what_is_lacking_more_than_are_tried_do_not_help() -> None:
    peers = [component(f"peer{number}", f"in:T{number}", f"out:T{number + 1}") for number in range(2 * MOST_OF_A_ROLE)]
    given_ = problem({"peer": peers, "user": [component("user", "i:S")]}, "peer>peer peer>user", {"peer": (0, None)})
    assert with_additions(given_) is None
    helped = problem({"peer": peers, "user": [component("user", "i:T1")]}, "peer>peer peer>user", {"peer": (0, None)})
    assert with_additions(helped) is None  # `peer0` lacks what none issues


def test_more_of_one_role_than_are_tried_is_not_decided() -> None:
    many = MOST_OF_A_ROLE + 1
    sources = [component(f"s{k:02}", outputs=f"o:S{k}") for k in range(many)]
    wanted = " ".join(f"i{k}:S{k}" for k in range(many))
    given_ = problem({"many": sources, "user": [component("user", wanted)]}, "many>user", counts={"many": (0, None)})
    assert isinstance(with_additions(given_), Undecided)


def test_a_question_that_is_not_decided_in_its_steps_leaves_the_answer_undecided(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(additions, "solution", lambda *question: Undecided(1))
    assert isinstance(with_additions(fan(1, 2)), Undecided)
    *_, answer = Searches(Strategy.FIRST).answers(fan(1, 2))
    assert isinstance(answer, Undecided)


def test_that_no_optional_role_helps_is_found_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A refusal is told twice, the second time with its reasons."""
    asked: list[Problem] = []
    monkeypatch.setattr(searches, "with_additions", lambda given_, steps: asked.append(given_))
    user = {"one": [component("a", "i:T", "o:S")], "user": [component("user", "i:S")]}
    answers = list(Searches(Strategy.FIRST).answers(problem(user, "one>user", counts={"one": (0, 1)})))
    assert [bool(one.reasons) for one in answers if isinstance(one, Refusal)] == [False, True]
    assert len(asked) == 1


def test_of_equally_few_the_first_role_is_asked() -> None:
    sources = [component("a", outputs="o:S")], [component("b", outputs="o:S")]
    given_ = problem(
        {"one": sources[0], "two": sources[1], "user": [component("user", "i:S")]},
        "one>user two>user",
        counts={"one": (0, 1), "two": (0, 1)},
    )
    found = with_additions(given_)
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [1, 0, 1]


def test_two_of_one_role_are_fewer_than_one_of_each_of_three() -> None:
    roles = {
        "many": [component("a", outputs="x:X"), component("b", outputs="y:Y z:Z")],
        "two": [component("c", outputs="y:Y")],
        "three": [component("d", outputs="z:Z")],
        "user": [component("user", "x:X y:Y z:Z")],
    }
    counts = dict.fromkeys(("many", "two", "three"), (0, 2))
    found = with_additions(problem(roles, "many>user two>user three>user", counts=counts))
    assert isinstance(found, Problem)
    assert [role.minimum for role in found.roles] == [2, 0, 0, 1]


@pytest.mark.parametrize(("interactions", "joining"), [("", ["m1"]), ("many>screen", [])])
def test_a_role_is_asked_for_of_which_only_recruits_need_what_it_issues(interactions: str, joining: list[str]) -> None:
    """Where it feeds another role as well, that needs nothing of it; in no interaction, all that fit join it."""
    plain = problem(
        {
            "many": [component(f"m{k}", outputs=f"o:S{k}") for k in range(3)],
            "screen": [component("screen")],
            "user": [component("user", "i:T")],
        },
        interactions,
        counts={"many": (0, None)},
    )
    roles = tuple(replace(role, recruits=role.iri.short == "user") for role in plain.roles)
    recruits = (Recruit(component("converter", "a:S0 b:S2", "o:T"), frozenset({2})),)
    given_ = Problem(
        replace(plain.task, template=replace(plain.task.template, roles=roles)),
        replace(plain.partition, recruits=recruits),
    )
    *_, answer = Searches(Strategy.FIRST).answers(given_)
    assert isinstance(answer, Configuration)
    assert [one.short for one in answer.components] == ["m0", "m2", *joining, "screen", "user", "converter"]


def test_where_a_role_lacks_candidates_nothing_is_tried() -> None:
    given_ = problem({"one": [component("a", outputs="o:S")], "user": []}, "one>user", counts={"one": (0, 1)})
    assert with_additions(given_) is None
