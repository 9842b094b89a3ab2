"""RDF terms as values: their order, and how they are written."""

from __future__ import annotations

import copy
import pickle
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import selfconf as sc
from selfconf.model.profile import Operation
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal, Term, sort_key
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


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "'' is no IRI: a text that is not empty is needed"),
        ("urn:my home", "'urn:my home' is no IRI: it has ' ', which is written as %20"),
        ("urn:\udcff", "is no IRI: it has '\\udcff', which is no character"),
        *((f"urn:a{wrong}b", "is no IRI: it has ") for wrong in '<>"{}|^`\\\n\x00'),
    ],
)
def test_what_can_be_no_iri_is_refused_in_a_sentence_and_passed_on_where_it_was_heard(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=re.escape(words)):
        sc.IRI(text)
    heard = IRI.unchecked(text)
    assert isinstance(heard, IRI)
    assert heard == text
    assert pickle.loads(pickle.dumps(heard)) == copy.copy(heard) == heard
    assert type(copy.deepcopy(heard)) is IRI
    assert type(copy.copy(Operation.of(None))) is Operation


def test_an_iri_is_made_of_text() -> None:
    with pytest.raises(TypeError, match="an IRI is made of text, not of NoneType"):
        IRI(None)  # type: ignore[arg-type]  # that is what is tested
    assert IRI("https://example.org/ä?q=1#x%20y") == "https://example.org/ä?q=1#x%20y"


@given(st.lists(terms, max_size=10))
def test_the_order_of_terms_is_total_and_independent_of_arrival(some: list[Term]) -> None:
    backwards = some[::-1]
    assert sorted(some, key=sort_key) == sorted(backwards, key=sort_key)


def test_iris_come_before_blank_nodes_and_these_before_literals() -> None:
    some: list[Term] = [Literal("a"), BlankNode("_:a"), IRI("urn:z")]
    assert sorted(some, key=sort_key) == [IRI("urn:z"), BlankNode("_:a"), Literal("a")]


def test_a_blank_node_is_no_iri_though_both_are_text() -> None:
    assert BlankNode("_:a") != IRI("urn:a")
    assert repr(IRI("urn:a")) == "<urn:a>"


@pytest.mark.parametrize(
    ("lexical", "datatype", "written"),
    [
        ("5", "integer", "5"),
        ("-5.0", "decimal", "-5.0"),
        ("1e3", "double", "1e3"),
        ("true", "boolean", "true"),
        ("5.", "decimal", '"5."^^decimal'),
        ("5", "byte", '"5"^^byte'),
        ("five", "integer", '"five"^^integer'),
        ("yes", "boolean", '"yes"^^boolean'),
        ('a "b"\n\\', "string", '"a \\"b\\"\\n\\\\"'),
    ],
)
def test_a_literal_is_bare_in_turtle_only_where_turtle_reads_it_as_its_datatype(
    lexical: str, datatype: str, written: str
) -> None:
    assert Literal(lexical, IRI(XSD_NAMESPACE + datatype)).turtle(lambda iri: iri.short) == written


def test_a_double_of_many_digits_is_written_in_linear_time() -> None:
    digits = "1" * 1_000_000  # hours, where two parts of a pattern could take each digit
    assert Literal(digits, IRI(XSD_NAMESPACE + "double")).turtle(lambda iri: iri.short) == f'"{digits}"^^double'


def test_a_literal_with_a_language_has_it_as_its_tag() -> None:
    assert Literal("hello", IRI("urn:langString"), "en").turtle(str) == '"hello"@en'
    assert str(Literal("hello", IRI("urn:langString"), "en")) == "hello"
