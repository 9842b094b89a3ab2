"""Components that are yet to be added: what they suit, and the values that they should state."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.partition import ANY_VALUE, Mention, Variable
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AddComponents, Addition
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.relaxations.newcomers import impossible, newcomer, with_mentioned_variables, without_values
from selfconf.search.relaxations.relaxations import with_relaxations
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


def mentioning(given: Problem, **mentions: Mention) -> Problem:
    """The problem where the shapes of some roles say more of the parameter."""
    found = [(mentions.get(role.iri.short, Mention(iri("robot"))),) for role in given.roles]
    return Problem(given.task, replace(given.partition, mentions=tuple(found)), given.hierarchy)


ASTRID, PIPPI, EMIL = map(iri, ("astrid", "pippi", "emil"))


def test_a_newcomer_suits_what_the_addition_says_or_else_every_value_or_those_that_it_has_to_state() -> None:
    given = problem({"sonar": []}, domain=["astrid", "pippi"])

    def admits(given: Problem, *values: tuple[str, IRI | None]) -> int:
        (mask,) = newcomer(given, Addition(iri("sonar"), 1, values=values), 0).admits
        return mask

    assert admits(given) == ANY_VALUE
    assert admits(given, ("robot", PIPPI)) == 0b10
    assert admits(given, ("robot", None)) == ANY_VALUE
    assert admits(mentioning(given, sonar=Mention(iri("robot"), never=frozenset((PIPPI,))))) == ANY_VALUE
    assert admits(mentioning(given, sonar=Mention(iri("robot"), None, frozenset((PIPPI,)), True))) == ~0b10
    assert admits(mentioning(given, sonar=Mention(iri("robot"), frozenset((PIPPI, EMIL)), required=True))) == 0b10


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


def test_values_that_shapes_list_join_those_that_are_stated() -> None:
    listing = Mention(iri("robot"), frozenset((PIPPI, EMIL)))
    given = mentioning(problem({"sonar": []}, domain=["astrid", "pippi"]), sonar=listing)
    (variable,) = with_mentioned_variables(given).variables
    assert variable.domain == (ASTRID, PIPPI, EMIL)
    (variable,) = with_mentioned_variables(unstated(given)).variables
    assert variable.domain == (EMIL, PIPPI)


def test_a_component_that_may_not_state_the_value_of_the_others_is_to_state_none() -> None:
    given = problem({"sonar": [component("sonar")], "drive": []}, values={"sonar": {"sonar": 1}}, domain=["astrid"])
    listing = Mention(iri("robot"), frozenset((PIPPI, EMIL)))
    assert added(mentioning(given, drive=listing)) == "add one more component for the role drive, with no robot"
    never = Mention(iri("robot"), never=frozenset((ASTRID,)))
    assert added(mentioning(given, drive=never)) == "add one more component for the role drive, with no robot"


def test_where_a_component_has_to_state_another_value_than_the_others_more_is_added() -> None:
    given = problem({"sonar": [component("sonar")], "drive": []}, values={"sonar": {"sonar": 1}}, domain=["astrid"])
    must = Mention(iri("robot"), frozenset((PIPPI, EMIL)), required=True)
    drive = "one more component for the role drive, with robot emil"
    assert added(mentioning(given, drive=must)) == (
        f"add one more component for the role sonar, with robot emil and {drive}"
    )


def test_for_a_role_whose_shape_contradicts_itself_nothing_is_added() -> None:
    given = problem({"sonar": [], "drive": [component("drive")]}, counts={"drive": (2, None)}, domain=["astrid"])
    closed = Problem(given.task, replace(given.partition, unaddable=frozenset((1,))), given.hierarchy)
    assert impossible(closed) == {1}
    assert added(closed) is None
    nothing = mentioning(given, sonar=Mention(iri("robot"), frozenset(), required=True))
    assert impossible(nothing) == {0}
    assert added(nothing) is None


def test_additions_without_values_say_none() -> None:
    one = AddComponents((Addition(iri("sonar"), 2, values=(("robot", PIPPI),)),), ("robot",))
    assert without_values(one) == AddComponents((Addition(iri("sonar"), 2),))
