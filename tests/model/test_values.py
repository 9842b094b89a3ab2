"""The values of the model: terms, profiles, partitions, configurations, hierarchies."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable, ordered
from selfconf.model.profile import Place, Profile, candidate_order
from selfconf.model.template import Role, Template
from selfconf.model.term import IRI, BlankNode, Literal, Term, sort_key
from tests.protocol.strategies import terms


@pytest.mark.parametrize(
    ("iri", "short"),
    [
        ("https://w3id.org/selfconf/robotics#MotorDrive", "MotorDrive"),
        ("https://example.org/a/b", "b"),
        ("https://example.org/a/b/", "b"),
        ("urn:selfconf:configuration:12", "12"),
        ("https://example.org/x#", "x"),
    ],
)
def test_the_short_name_of_an_iri_is_its_last_segment(iri: str, short: str) -> None:
    assert IRI(iri).short == short


@given(st.lists(terms, max_size=10))
def test_the_order_of_terms_is_total_and_independent_of_arrival(some: list[Term]) -> None:
    backwards = some[::-1]
    assert sorted(some, key=sort_key) == sorted(backwards, key=sort_key)


def test_iris_come_before_blank_nodes_and_these_before_literals() -> None:
    some: list[Term] = [Literal("a"), BlankNode("_:a"), IRI("urn:z")]
    assert sorted(some, key=sort_key) == [IRI("urn:z"), BlankNode("_:a"), Literal("a")]


def test_candidates_are_tried_by_preference_and_then_by_iri() -> None:
    wishes = ("b", 0), ("a", 0), ("z", 10), ("y", -1)
    profiles = [Profile(IRI(f"urn:{name}"), preference=Decimal(wish)) for name, wish in wishes]
    in_order = [candidate.profile.component for candidate in ordered([Candidate(profile) for profile in profiles])]
    assert in_order == ["urn:z", "urn:a", "urn:b", "urn:y"]
    assert candidate_order(profiles[2]) < candidate_order(profiles[0])


def test_a_partition_without_the_lost_keeps_everybody_else_in_order() -> None:
    a, b, c = (Candidate(Profile(IRI(f"urn:{name}")), (1,)) for name in "abc")
    partition = Partition(((a, b), (b, c)), (Variable(IRI("urn:p"), (IRI("urn:x"),)),))
    assert partition.without(frozenset({IRI("urn:b")})) == Partition(((a,), (c,)), partition.variables)


def test_values_that_only_the_lost_stated_are_lost_with_them() -> None:
    profiles = [Profile(IRI(f"urn:{name}")) for name in "abc"]
    masks = ((0b001, 1), (~0b010, -1), (0b110, -1))
    candidates = tuple(Candidate(profile, mask) for profile, mask in zip(profiles, masks, strict=True))
    x, y, z = (IRI(f"urn:{name}") for name in "xyz")
    partition = Partition((candidates,), (Variable(IRI("urn:p"), (x, y, z)), Variable(IRI("urn:q"), (x,))))
    assert partition.without(frozenset({IRI("urn:a")})) == Partition(
        ((Candidate(profiles[1], (~0b01,)), Candidate(profiles[2], (0b11,))),), (Variable(IRI("urn:p"), (y, z)),)
    )


def test_a_variable_takes_the_first_value_that_a_mask_allows() -> None:
    variable = Variable(IRI("urn:p"), (IRI("urn:a"), IRI("urn:b"), IRI("urn:c")))
    assert variable.first(0b110) == IRI("urn:b")
    assert variable.first(ANY_VALUE) is None


def test_a_configuration_knows_its_components_and_their_roles() -> None:
    configuration = Configuration(
        IRI("urn:t"),
        (Assignment(IRI("urn:r"), (IRI("urn:a"), IRI("urn:b"))), Assignment(IRI("urn:s"), (IRI("urn:c"),))),
    )
    assert configuration.components == (IRI("urn:a"), IRI("urn:b"), IRI("urn:c"))
    assert configuration.role_of(IRI("urn:b")) == IRI("urn:r")
    assert configuration.role_of(IRI("urn:x")) is None


def test_a_template_finds_its_roles_by_iri() -> None:
    template = Template(IRI("urn:t"), (Role(IRI("urn:r")),))
    assert template.role(IRI("urn:r")) == Role(IRI("urn:r"))
    with pytest.raises(KeyError):
        template.role(IRI("urn:x"))


def test_offered_matches_wanted_if_wanted_is_offered_itself_or_above_it() -> None:
    above = Hierarchy([(IRI("urn:a"), IRI("urn:b"))])
    assert above.matches(IRI("urn:a"), IRI("urn:b"))
    assert not above.matches(IRI("urn:b"), IRI("urn:a"))
    assert not NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:b"))
    assert NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:a"))


def test_a_place_is_shown_as_editors_know_it() -> None:
    assert str(Place("ads.ttl", 7)) == "ads.ttl:7"
    assert str(Place("ads.ttl")) == "ads.ttl"
