"""Which values a parameter can have."""

from __future__ import annotations

import pytest

from selfconf.model.template import Parameter
from selfconf.model.term import IRI, Literal
from selfconf.rdf.tasks.parameter_values import misfits, suitable
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import XSD
from tests.lab import PREFIXES, iri

LEVEL = Parameter(iri("level"), "level")
TEXT = PREFIXES + ":level a sc:Parameter ; sc:name 'level' ; sh:datatype xsd:integer ; sh:maxInclusive 5 ."


def test_compiled_constraints_tell_which_values_suit() -> None:
    good, high, text = Literal("5", XSD.integer), Literal("6", XSD.integer), Literal("5")
    document = parse(TEXT, "t.ttl")
    assert suitable(LEVEL, frozenset((good, high, text)), document) == {good}
    assert misfits(LEVEL, (good, high, text), document).keys() == {high, text}


def test_what_is_not_compiled_is_judged_by_pyshacl() -> None:
    document = parse(TEXT.replace("sh:maxInclusive 5", "sh:in ( 1 2 )"), "t.ttl")
    one, three = Literal("1", XSD.integer), Literal("3", XSD.integer)
    assert suitable(LEVEL, frozenset((one, three)), document) == {one}


def test_a_constraint_component_of_the_document_is_judged() -> None:
    text = """:level a sc:Parameter ; sc:name 'level' ; :atMost 1 .
        :AtMost a sh:ConstraintComponent ; sh:parameter [ sh:path :atMost ] ;
            sh:validator [ a sh:SPARQLAskValidator ; sh:ask "ASK { FILTER ($value <= $atMost) }" ] ."""
    document = parse(PREFIXES + text, "t.ttl")
    one, three = Literal("1", XSD.integer), Literal("3", XSD.integer)
    assert suitable(LEVEL, frozenset((one, three)), document) == {one}
    assert misfits(LEVEL, (one, three), document).keys() == {three}


def test_a_parameter_that_asks_for_nothing_takes_anything() -> None:
    document = parse(PREFIXES + ":level a sc:Parameter ; sc:name 'level' .", "t.ttl")
    assert misfits(LEVEL, (IRI("urn:a"), Literal("a")), document) == {}


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        ("sh:minInclusive 5", "it is 3, not at least 5"),
        ("sh:datatype xsd:string", "it is 3, not a string"),
        ("sh:nodeKind sh:IRI", "it is 3, not an IRI"),
        ("sh:pattern '^a'", "it is 3, not like /^a/"),
        ("sh:in ( :a 4 'x' )", 'it is 3, not "x" or 4 or a'),
        ("sh:hasValue 7", "it is 3, not 7"),
        ("sh:class :K", "Value does not have class <https://example.org/peis-home#K>"),
        ("sh:node [ sh:datatype xsd:string ]", "Value does not conform to Shape [ sh:datatype xsd:string ]"),
        ("sh:not [ sh:datatype xsd:integer ]", 'Node "3" must not conform to shape [ sh:datatype xsd:integer ]'),
        ("sh:minCount 2", "Less than 2 values on it"),
        ("sh:equals :q", 'Value of its <https://example.org/peis-home#q> != "3"'),
        ("sh:minInclusive 5 ; sh:message 'Literal(\"a lot\") is asked for.'", 'Literal("a lot") is asked for.'),
    ],
)
def test_the_reason_is_in_words_without_the_names_of_our_own(asked: str, reason: str) -> None:
    document = parse(f"{PREFIXES}:level a sc:Parameter ; sc:name 'level' ; {asked} .", "t.ttl")
    assert list(misfits(LEVEL, (Literal("3", XSD.integer),), document).values()) == [reason]


@pytest.mark.parametrize(
    "asked", ["sh:maxInclusive 5 ; sh:datatype xsd:integer", "sh:datatype xsd:integer ; sh:maxInclusive 5"]
)
def test_the_reason_is_the_same_in_any_order_of_statements(asked: str) -> None:
    document = parse(f"{PREFIXES}:level a sc:Parameter ; sc:name 'level' ; {asked} .", "t.ttl")
    text = Literal("high")
    assert misfits(LEVEL, (text,), document) == {text: 'it is "high", not an integer'}


def test_a_pattern_that_takes_too_long_is_said_of_the_value_and_not_of_a_shape_of_our_own() -> None:
    document = parse(PREFIXES + ":level a sc:Parameter ; sc:name 'level' ; sh:pattern '^(?=(\\\\w+)+$)' .", "t.ttl")
    value = Literal("ab" * 40 + "!")
    (reason,) = misfits(LEVEL, (value,), document).values()
    assert "takes too long" in reason
    assert "urn:" not in reason
    assert suitable(LEVEL, frozenset((value,)), document) == frozenset()
