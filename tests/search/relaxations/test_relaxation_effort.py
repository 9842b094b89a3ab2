"""The trials of relaxations are limited, by a number that grows with the ecology, and say when they end before."""

from __future__ import annotations

import pytest

from selfconf.model.obstacle import WrongType
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AddComponents, AskForFewer
from selfconf.search.relaxations import components_to_add, relaxation_effort
from selfconf.search.relaxations.relaxations import MOST_ROLES, NEAR, with_relaxations
from selfconf.search.strategies import first
from tests.search.worlds import component, iri, problem


@pytest.mark.slow
def test_what_may_be_tried_grows_with_the_ecology(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(relaxation_effort, "TRIAL_STEPS", 100)
    given_ = problem({f"r{number}": [component(f"c{other}") for other in range(59)] for number in range(60)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert str(with_relaxations(given_, refused).repairs[0]) == "add one more component for the role r0"


def test_a_search_for_relaxations_that_ends_before_all_was_tried_says_so() -> None:
    given_ = problem({f"r{number}": [component(f"c{other}") for other in range(7)] for number in range(8)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    whole = with_relaxations(given_, refused)
    assert not whole.repairs_stopped
    for steps in (1, 100, 500, 2000):
        found = with_relaxations(given_, refused, steps=steps)
        assert found.repairs_stopped or found.repairs == whole.repairs
        assert set(map(str, found.repairs)) <= set(map(str, whole.repairs))
    assert with_relaxations(given_, refused, steps=1).repairs_stopped


def test_where_enough_was_tried_and_more_is_left_it_says_so() -> None:
    given_ = problem({"a": [], "b": [component("b1", "x:X y:Y z:Z")]}, "a>b")
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert not with_relaxations(given_, refused).repairs_stopped
    slip = NearMiss(iri("a"), iri("slip"), WrongType(iri("A")))
    near = [(slip, Candidate(component("slip", outputs="w:W")))] * (NEAR + 1)
    assert not with_relaxations(given_, refused, near[1:]).repairs_stopped
    assert with_relaxations(given_, refused, near).repairs_stopped


def test_sets_of_components_that_are_not_tried_are_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    given_ = problem({"a": [], "b": [component("b1", "x:X y:Y")]}, "a.out>b")
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert any(isinstance(one, AddComponents) for one in with_relaxations(given_, refused).repairs)
    monkeypatch.setattr(components_to_add, "TRIALS", 1)
    few = with_relaxations(given_, refused)
    assert few.repairs_stopped
    assert not any(isinstance(one, AddComponents) for one in few.repairs)


def test_roles_of_a_conflict_that_are_not_asked_for_fewer_are_told_of() -> None:
    given_ = problem({f"r{number}": [component(f"c{other}") for other in range(9)] for number in range(10)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    found = with_relaxations(given_, refused)
    assert len([one for one in found.repairs if isinstance(one, AskForFewer)]) == MOST_ROLES
    assert found.repairs_stopped
