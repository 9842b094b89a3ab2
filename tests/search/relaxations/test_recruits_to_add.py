"""What could be added for roles to recruit: all that is lacking, and nothing that can be spared."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.profile import Condition, Ports
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AddRecruits
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruiting import possible_with_recruits
from selfconf.search.relaxations.recruits_to_add import MOST_LACKING, recruits_to_add, with_more_recruits
from selfconf.search.relaxations.relaxation_effort import RelaxationEffort
from selfconf.search.relaxations.relaxations import with_relaxations
from selfconf.search.strategies import first
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.worlds import component, iri, problem

STEPS = 5_000


def possible(changed: Problem) -> bool:
    """Whether there is a configuration with recruits."""
    return possible_with_recruits(changed, STEPS)


def advice(given: Problem) -> AddRecruits | None:
    """What to add, seen to be enough."""
    found = recruits_to_add(given, RelaxationEffort(None), lambda one: possible(with_more_recruits(given, one)))
    if found is not None:
        assert possible(with_more_recruits(given, found))
    return found


def issued(found: AddRecruits | None) -> list[list[str]]:
    """The signals that each added recruit issues."""
    assert found is not None
    return [[output.signals[0].short for output in one.outputs] for one in found.additions]


def test_only_what_is_lacking_is_to_be_issued() -> None:
    given = with_recruits(problem({"user": [component("user", "s:S t:T u:U")]}), component("a", "", "t:T"))
    assert issued(advice(given)) == [["S", "U"]]


def test_of_several_players_one_is_enough() -> None:
    given = with_recruits(problem({"user": [component("a", "s:S t:T"), component("b", "u:U")]}))
    assert issued(advice(given)) == [["U"]]


def test_each_role_gets_what_its_players_lack() -> None:
    given = with_recruits(problem({"eye": [component("eye", "s:S")], "ear": [component("ear", "t:T")]}))
    assert issued(advice(given)) == [["S"], ["T"]]


def test_what_has_to_conform_to_a_shape_gets_a_component_of_its_own() -> None:
    user = component("user", "s:S t:T u:U")
    inputs = [
        port._replace(condition=Condition(accepts=f"shape-{port.name}")) if port.name != "u" else port
        for port in user.inputs
    ]
    given = with_recruits(problem({"user": [replace(user, ports=Ports(tuple(inputs), ()))]}))
    assert issued(advice(given)) == [["U"], ["S"], ["T"]]


def test_there_is_no_advice_where_recruits_do_not_help() -> None:
    assert advice(with_recruits(problem({"user": []}))) is None
    fixed = problem({"user": [component("user", "s:S")]})
    assert advice(fixed) is None
    many = " ".join(f"p{k}:S{k}" for k in range(MOST_LACKING + 1))
    given = with_recruits(problem({"user": [component("user", many)]}))
    assert advice(given) is None
    refused = first.search(given)
    assert isinstance(refused, Refusal)
    assert with_relaxations(given, refused).repairs_stopped


def test_what_has_to_conform_to_a_shape_is_not_taken_to_have_a_unit() -> None:
    user = component("user", "s:S t:S")
    asking = Condition(unit=iri("CentiM")), Condition(accepts="in metres")
    inputs = tuple(port._replace(condition=one) for port, one in zip(user.inputs, asking, strict=True))
    given = with_recruits(problem({"user": [replace(user, ports=Ports(inputs, ()))]}))
    assert issued(advice(given)) == [["S"], ["S"]]
