"""RDF terms as values: their order, and how they are written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

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
