"""Every relaxation of a refused task makes it possible, and no fewer components to add would."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations_with_replacement

import pytest
from hypothesis import given

from selfconf.model.obstacle import PropertyUnmet
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Profile
from selfconf.model.property_fault import NotAmong
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AcceptNearMiss, AddComponents, Addition
from selfconf.search.additions import asking_for
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruit_refusal import refusal_of_recruits
from selfconf.search.relaxations.components_to_add import wanted_of
from selfconf.search.relaxations.relaxations import with_relaxations
from selfconf.search.relaxations.relaxed_problem import relaxed_by
from selfconf.search.strategies import first
from tests.search.recruiting.test_recruiting import RecruitingWorld, recruiting, with_recruits
from tests.search.test_additions import choices, solvable
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, component, iri, problem, problems

OF_PIPPI = PropertyUnmet(iri("support"), (NotAmong(frozenset((iri("Pippi"),)), frozenset((iri("Astrid"),))),))


def _possible(problem: Problem) -> bool:
    """Whether there is a solution, with optional roles where it takes them, by enumeration."""
    return solvable(problem) or any(solvable(asking_for(problem, one)) for one in choices(problem))


@given(problems(roles=3, components=4))
@agreement()
def test_every_relaxation_works_and_adds_as_few_components_as_possible(problem: Problem) -> None:
    refused = first.search(problem)
    if not isinstance(refused, Refusal) or _possible(problem):
        return
    explained = with_relaxations(problem, refused)
    found = explained.repairs
    for one in found:
        assert str(one)
        assert one.code
        assert one.role in {role.iri for role in problem.roles}
        assert _possible(relaxed_by(problem, one)), one
    added = [one for one in found if isinstance(one, AddComponents)]
    for some in [one.additions for one in added]:
        for place, addition in enumerate(some):
            for output in addition.outputs:
                less = replace(addition, outputs=tuple(other for other in addition.outputs if other != output))
                assert not _possible(relaxed_by(problem, AddComponents((*some[:place], less, *some[place + 1 :]))))
    fewest = sum(addition.count for addition in added[0].additions) if added else 0 if explained.repairs_stopped else 3
    for size in range(1, min(fewest, 3)):
        choices = [(role, outputs) for role in range(len(problem.roles)) for outputs in wanted_of(problem, role)]
        for chosen in combinations_with_replacement(choices, size):
            more = tuple(Addition(problem.roles[role].iri, 1, outputs) for role, outputs in chosen)
            assert not _possible(relaxed_by(problem, AddComponents(more)))


def test_what_is_lacking_is_asked_for_by_signal() -> None:
    given_ = problem(
        {"position": [component("bumper", outputs="b:Bump")], "control": [component("cap", "p:Pose b:Bump")]},
        "position>control",
        counts={"position": (1, None)},
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words[0] == "add one more component for the role position that issues Bump and Pose"


def test_a_near_miss_that_would_do_is_offered_first() -> None:
    given_ = problem({"position": [], "control": [component("cap", "p:Pose")]}, "position>control")
    near = NearMiss(iri("position"), iri("tracker"), OF_PIPPI)
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    candidate = Candidate(component("tracker", outputs="p:Pose"))
    offered = with_relaxations(given_, refused, [(near, candidate)]).repairs[0]
    assert isinstance(offered, AcceptNearMiss)
    assert str(offered) == "let the role position take tracker, although its support is Pippi, not Astrid"


def test_a_near_miss_of_a_value_of_its_own_is_tried_beside_recruits_without_a_solver() -> None:
    roles = {"user": [component("user", "s:S"), component("of-pippi", "s:S")], "other": []}
    plain = problem(roles, values={"user": {"of-pippi": 1}}, domain=["Pippi"])
    helped = with_recruits(plain, component("supplier", "", "s:S"))
    near = component("near"), (0b10,)
    miss = NearMiss(iri("other"), iri("near"), OF_PIPPI)
    with without_solvers():
        refused = first.search(helped)
        assert isinstance(refused, Refusal)
        found = with_relaxations(helped, refused, [(miss, Candidate(*near))]).repairs
    assert isinstance(found[0], AcceptNearMiss)


def test_a_near_miss_that_is_the_first_of_its_class_elsewhere_is_distinguished() -> None:
    eyes = [component(name, outputs="p:Pose") for name in ("a", "b")]
    given_ = problem({"position": eyes, "spare": []})
    near = NearMiss(iri("spare"), iri("a"), OF_PIPPI)
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert isinstance(with_relaxations(given_, refused, [(near, Candidate(eyes[0]))]).repairs[0], AcceptNearMiss)


def test_a_role_that_asks_for_too_many_may_ask_for_fewer() -> None:
    given_ = problem({"speaker": [component("left"), component("right")]}, counts={"speaker": (4, None)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words == [
        "add 2 more components for the role speaker",
        "let the role speaker ask for 2 (sc:minCount 2)",
    ]


def test_a_link_that_is_missing_is_found() -> None:
    given_ = problem({"eye": [component("camera", outputs="i:Image")], "mind": [component("cap", "i:Image")]})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert "let the role eye feed the role mind (sc:feeds)" in [
        str(one) for one in with_relaxations(given_, refused).repairs
    ]


def test_a_link_by_name_is_not_the_plain_one() -> None:
    for named in ("eye.picture>mind", "eye>mind.picture", "eye.picture>mind.picture"):
        given_ = problem(
            {"eye": [component("camera", outputs="i:Image")], "mind": [component("cap", "i:Image")]}, named
        )
        refused = first.search(given_)
        assert isinstance(refused, Refusal)
        assert "let the role eye feed the role mind (sc:feeds)" in [
            str(one) for one in with_relaxations(given_, refused).repairs
        ]


def test_a_role_that_asks_for_far_too_many_is_advised_to_ask_for_those_there_are() -> None:
    given_ = problem({"speaker": [component("left"), component("right")]}, counts={"speaker": (10**12, None)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words == ["let the role speaker ask for 2 (sc:minCount 2)"]


def test_an_addition_names_a_value_with_which_there_are_recruits() -> None:
    # The first of the drives needs what itself alone issues.
    given_ = problem(
        {"sonar": [], "drive": [component("first", "x:X", "x:X"), component("second")]},
        values={"drive": {"first": 0b01, "second": 0b10}},
        domain=["astrid", "pippi"],
    )
    helped = with_recruits(given_, component("first", "x:X", "x:X"))
    refused = first.search(helped)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(helped, refused).repairs]
    assert words[0] == "add one more component for the role sonar, with robot pippi"


def test_a_role_asks_for_so_few_that_there_are_recruits_for_them() -> None:
    # One could be played, if it were fed; but it needs what itself alone issues.
    given_ = problem({"drive": [component("first", "x:X", "x:X")]}, counts={"drive": (2, 2)})
    helped = with_recruits(given_, component("first", "x:X", "x:X"))
    refused = first.search(helped)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(helped, refused).repairs]
    assert words == [
        "add 2 more components for the role drive",
        "let the role drive be optional (sc:minCount 0)",
    ]


@given(recruiting())
@agreement(0.3)
def test_a_refusal_of_roles_that_recruit_says_what_to_add(problem: Problem) -> None:
    pytest.importorskip("pysat")
    if problem.unvalued or RecruitingWorld(problem).answer() is not None:
        return
    outcome = first.search(problem)
    refused = outcome if isinstance(outcome, Refusal) else refusal_of_recruits(problem)
    found = with_relaxations(problem, refused).repairs
    for one in found:
        assert RecruitingWorld(relaxed_by(problem, one)).answer() is not None, str(one)
    # Where more would have to be added, the trials may end before.
    if sum(role.minimum for role in problem.roles) < 3:
        assert any(isinstance(one, AddComponents) for one in found)


def test_what_a_player_cannot_be_recruited_for_is_to_be_issued_by_a_recruit_that_is_added() -> None:
    given_ = problem({"boat": [component("boat", "s:S t:T")], "eye": [component("camera", outputs="t:T")]})
    helped = with_recruits(given_, component("camera", outputs="t:T"))
    refused = first.search(helped)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(helped, refused).repairs]
    assert words[0] == "add one more component for the role boat to recruit that issues S and T"


def test_optional_roles_help_after_a_change() -> None:
    where, needy = component("where", outputs="p:Pose"), component("needy", "p:Pose")
    given_ = problem({"a": [where], "b": []}, "a>b", {"a": (0, 1)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused, [(_slip("b", needy), Candidate(needy))]).repairs]
    assert words[0].startswith("let the role b take needy, although")
    given_ = problem({"a": [where], "b": [needy]}, "a>b", {"a": (0, 1), "b": (2, 2)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words == ["add one more component for the role b", "let the role b ask for 1 (sc:minCount 1)"]


def test_a_component_is_asked_for_an_optional_role_that_nothing_plays() -> None:
    given_ = problem({"a": [], "b": [component("needy", "p:Pose")]}, "a>b", {"a": (0, 1)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words[0] == "add one more component for the role a that issues Pose"


def _slip(role: str, profile: Profile) -> NearMiss:
    return NearMiss(iri(role), profile.component, OF_PIPPI)
