"""Components that are yet to be added: what they suit, and the values that they should state."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.partition import ANY_VALUE, Mention, Variable
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AddComponents
from selfconf.search.newcomers import newcomer, with_mentioned_variables
from selfconf.search.problem import Problem
from selfconf.search.relaxations import with_relaxations
from selfconf.search.strategies import first
from tests.search.worlds import component, iri, problem


def added(given: Problem) -> str | None:
    """The components to be added, in words."""
    refused = first.search(given)
    assert isinstance(refused, Refusal)
    found = with_relaxations(given, refused).repairs
    return next((str(one) for one in found if isinstance(one, AddComponents)), None)


def unstated(given: Problem) -> Problem:
    """The problem where no component states a value of the parameter, so that it is no variable."""
    candidates = tuple(tuple(replace(c, admits=()) for c in some) for some in given.candidates)
    return Problem(given.task, replace(given.partition, candidates=candidates, variables=()), given.hierarchy)


def test_a_newcomer_suits_every_value() -> None:
    given = problem({"sonar": []}, domain=["astrid", "pippi"])
    assert newcomer(given, iri("sonar"), 0, ()).admits == (ANY_VALUE,)


def test_a_parameter_that_a_shape_mentions_becomes_a_variable_though_nobody_states_a_value() -> None:
    given = unstated(problem({"sonar": [component("sonar")]}, domain=["astrid"]))
    roomy = with_mentioned_variables(given)
    assert roomy.variables == (Variable(iri("robot"), ()),)
    assert roomy.candidates[0][0].admits == (ANY_VALUE,)
    assert with_mentioned_variables(roomy) is roomy


def test_what_is_also_set_does_not_become_a_variable() -> None:
    given = unstated(problem({"sonar": []}, domain=["astrid"]))
    (parameter,) = given.task.template.parameters
    template = replace(given.task.template, parameters=(replace(parameter, is_set=True),))
    assert with_mentioned_variables(Problem(replace(given.task, template=template), given.partition)).variables == ()


def test_several_components_to_be_added_have_to_share_a_value_that_nothing_decides() -> None:
    given = problem({"sonar": [], "drive": []}, domain=["astrid", "pippi"])
    said = "add one more component for the role sonar and one more component for the role drive"
    assert added(given) == f"{said}, with one robot for both"
    assert added(unstated(given)) == f"{said}, with one robot for both"
    many = problem({"sonar": []}, counts={"sonar": (3, None)}, domain=["astrid"])
    assert added(many) == "add 3 more components for the role sonar, with one robot for all"


def test_a_single_component_may_state_any_value_where_nothing_decides_it() -> None:
    assert added(problem({"sonar": []}, domain=["astrid", "pippi"])) == "add one more component for the role sonar"


def test_roles_that_do_not_mention_a_parameter_share_no_value() -> None:
    given = problem({"sonar": [], "drive": []}, domain=["astrid"])
    partition = replace(given.partition, mentions=((Mention(iri("robot")),), ()))
    said = "add one more component for the role sonar and one more component for the role drive"
    assert added(Problem(given.task, partition)) == said


def test_of_the_values_that_the_others_do_not_forbid_one_that_is_stated_is_told() -> None:
    given = problem(
        {"sonar": [], "drive": [component("drive")]},
        values={"drive": {"drive": ~0b01}},
        domain=["astrid", "pippi"],
    )
    assert added(given) == "add one more component for the role sonar, with robot pippi"
