"""The tests that a role makes of a profile: each passes, or returns the obstacle with its facts."""

from __future__ import annotations

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.obstacle import (
    Excluded,
    NoAlternative,
    NotJudged,
    ParameterUndeclared,
    PropertyUnmet,
    WrongComponent,
    WrongType,
)
from selfconf.model.profile import OperationalParameter, Profile
from selfconf.model.property_fault import Ambiguous, ConstraintFailed, Fault, Missing, NotAmong, WrongCount
from selfconf.model.term import Literal, Term
from selfconf.rdf.eligibility.role_tests import (
    ClassTest,
    CompiledRole,
    Count,
    ParameterTest,
    PropertyTest,
    RoleTest,
    SelfTest,
)
from selfconf.rdf.shacl import ValueTest
from selfconf.rdf.shacl.patterns import LONGEST_TEXT
from selfconf.rdf.vocabulary import SH, XSD
from tests.lab import iri

ABOVE = Hierarchy([(iri("Lamp"), iri("Light")), (iri("Speed"), iri("Number"))], [(iri("red"), iri("colour"))])
P, A, B, ROBOT = iri("p"), Literal("a"), Literal("b"), iri("robot")
LAMP = Profile(iri("lamp"), frozenset((iri("Lamp"),)), parameters=(OperationalParameter("n", iri("Number")),))


def with_values(*values: Term) -> Profile:
    """A lamp with values of the property `:p`."""
    return Profile(iri("lamp"), frozenset((iri("Lamp"),)), properties=tuple((P, value) for value in values))


def faults(test: PropertyTest, *values: Term) -> tuple[Fault, ...]:
    """What a test finds wrong with some values of `:p`."""
    obstacle = test.obstacle(with_values(*values), NOTHING_ABOVE)
    assert obstacle is None or isinstance(obstacle, PropertyUnmet)
    return () if obstacle is None else obstacle.faults


def test_a_class_above_serves_only_where_the_hierarchy_is_seen() -> None:
    assert ClassTest(iri("Lamp")).obstacle(LAMP, NOTHING_ABOVE) is None
    assert ClassTest(iri("Light")).obstacle(LAMP, ABOVE) is None
    assert ClassTest(iri("Light")).obstacle(LAMP, NOTHING_ABOVE) == WrongType(iri("Light"))


def test_a_component_that_is_not_listed_is_the_wrong_one() -> None:
    members = frozenset[Term]((iri("bell"),))
    assert SelfTest(members | {iri("lamp")}).obstacle(LAMP, NOTHING_ABOVE) is None
    assert SelfTest(members).obstacle(LAMP, NOTHING_ABOVE) == WrongComponent(members)


def test_a_declared_parameter_takes_values_of_the_types_below_its_own() -> None:
    assert ParameterTest(iri("Speed")).obstacle(LAMP, ABOVE) is None
    assert ParameterTest(iri("Speed")).obstacle(LAMP, NOTHING_ABOVE) == ParameterUndeclared(iri("Speed"))


def test_the_values_of_a_property_are_also_those_of_the_properties_below_it() -> None:
    profile = Profile(iri("lamp"), properties=((iri("colour"), A), (iri("red"), B)))
    assert PropertyTest(iri("colour")).values(profile, ABOVE) == {A, B}
    assert PropertyTest(iri("colour")).values(profile, NOTHING_ABOVE) == {A}


@pytest.mark.parametrize(
    ("test", "values", "found"),
    [
        (PropertyTest(P, minimum=1), (A,), ()),
        (PropertyTest(P, minimum=1), (), (Missing(),)),
        (PropertyTest(P, minimum=2), (A,), (WrongCount(1, False),)),
        (PropertyTest(P, maximum=1), (A, B), (WrongCount(2, True),)),
        (PropertyTest(P, allowed=(frozenset((A,)),)), (), ()),
        (
            PropertyTest(P, allowed=(frozenset((A,)),)),
            (A, B),
            (NotAmong(frozenset((B,)), frozenset((A,)), partly=True),),
        ),
        (PropertyTest(P, required=(A,)), (A, B), ()),
        (PropertyTest(P, required=(A,)), (B,), (NotAmong(frozenset((B,)), frozenset((A,))),)),
        (PropertyTest(P, required=(A,)), (), (Missing(),)),
        (
            PropertyTest(P, each=(ValueTest(SH.nodeKind, SH.IRI),)),
            (A, P),
            (ConstraintFailed(frozenset((A,)), SH.nodeKind, SH.IRI),),
        ),
        (PropertyTest(P, free_in=((ROBOT, frozenset((A,))),)), (A, B), ()),
        (PropertyTest(P, free_in=((ROBOT, frozenset()),)), (A, B), (Ambiguous(ROBOT),)),
        (PropertyTest(P, free_required=(ROBOT,)), (), (Missing(),)),
    ],
)
def test_all_that_is_wrong_with_the_values_of_a_property_is_one_obstacle(
    test: PropertyTest, values: tuple[Term, ...], found: tuple[Fault, ...]
) -> None:
    assert faults(test, *values) == found


def test_the_value_of_a_free_parameter_in_a_list_is_the_one_that_is_not_listed_besides() -> None:
    test = PropertyTest(P, free_in=((ROBOT, frozenset((A,))),))
    assert test.allows(with_values(A, B), NOTHING_ABOVE) == {ROBOT: frozenset((B,))}
    assert test.allows(with_values(A), NOTHING_ABOVE) == {}


def test_the_value_of_a_free_parameter_that_is_required_is_any_that_is_there() -> None:
    test = PropertyTest(P, free_required=(ROBOT,))
    assert test.allows(with_values(A, B), NOTHING_ABOVE) == {ROBOT: frozenset((A, B))}


def test_a_free_parameter_in_two_tests_has_a_value_that_both_allow() -> None:
    other = PropertyTest(iri("q"), free_required=(ROBOT,))
    role = CompiledRole(iri("r"), (PropertyTest(P, free_required=(ROBOT,)), other), complete=True)
    profile = Profile(iri("lamp"), properties=((P, A), (P, B), (iri("q"), B)))
    assert role.allows(profile, NOTHING_ABOVE) == {ROBOT: frozenset((B,))}


PASSED: tuple[RoleTest, ...] = (ClassTest(iri("Lamp")),)
FAILED: tuple[RoleTest, ...] = (ClassTest(iri("Bell")),)
NO_BELL = WrongType(iri("Bell"))


@pytest.mark.parametrize(
    ("test", "obstacle"),
    [
        (Count((PASSED, FAILED), 1), None),
        (Count((FAILED, FAILED), 1), NoAlternative((NO_BELL, NO_BELL))),
        (Count((PASSED + FAILED,), 1), NoAlternative((NO_BELL,))),
        (Count((PASSED, PASSED), 1, 1), Excluded(several=True, classes=(iri("Lamp"),))),
        (Count((PASSED,), 0, 0), Excluded(classes=(iri("Lamp"),))),
        (Count(((PropertyTest(P, maximum=0),), FAILED), 0, 0), Excluded(paths=(P,))),
        (Count(((Count((FAILED, PASSED), 1),),), 0, 0), Excluded(classes=(iri("Lamp"),))),
        (Count((FAILED,), 0, 0), None),
    ],
    ids=[
        "or",
        "or, in vain",
        "and inside or",
        "xone, twice",
        "not, in vain",
        "not a property",
        "not of alternatives",
        "not",
    ],
)
def test_of_several_groups_as_many_are_passed_as_are_asked_for(test: Count, obstacle: object) -> None:
    assert test.obstacle(LAMP, NOTHING_ABOVE) == obstacle


def test_every_obstacle_is_told_in_the_order_of_the_shape() -> None:
    role = CompiledRole(iri("r"), (*FAILED, *PASSED, PropertyTest(P, minimum=1)), complete=True)
    assert role.obstacles(LAMP, NOTHING_ABOVE) == (NO_BELL, PropertyUnmet(P, (Missing(),)))
    assert role.classes == (*FAILED, *PASSED)


def test_a_component_that_cannot_be_judged_has_that_obstacle_alone() -> None:
    beyond = PropertyTest(P, each=(ValueTest(SH.pattern, Literal(r"^(?=(\w+)+$)", XSD.string)),))
    role = CompiledRole(iri("r"), (*FAILED, beyond), complete=True)
    (found,) = role.obstacles(with_values(Literal("a" * LONGEST_TEXT * 2 + "!")), NOTHING_ABOVE)
    assert isinstance(found, NotJudged)
