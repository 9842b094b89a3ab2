"""The parameters of a template are read, with a sentence for each mistake, and judge their values."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import Parameter, Role, Setting
from selfconf.model.term import IRI, Literal
from selfconf.rdf.tasks.parameters import misfits, parameters_of, suitable
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import XSD
from tests.lab import PREFIXES, iri

ONE = ':t sc:parameter :p . :p sc:name "goal" ; '


def parameters(text: str, *settings: Setting) -> tuple[Parameter, ...]:
    """The parameters of the template `:t` in a text, whose one role `:r` makes some settings."""
    return parameters_of(parse(PREFIXES + text, "t.ttl"), iri("t"), (Role(iri("r"), settings=settings),))


def test_a_template_without_parameters_has_none() -> None:
    assert parameters(":t a sc:Template .") == ()


def test_parameters_are_sorted_by_name_whatever_their_iris() -> None:
    found = parameters(':t sc:parameter :a, :b . :a sc:name "robot" . :b sc:name "goal" .')
    assert [(parameter.iri.short, parameter.name) for parameter in found] == [("b", "goal"), ("a", "robot")]


def test_a_parameter_in_the_shape_of_a_role_is_known_to_stand_there() -> None:
    shape = ":r sh:property [ sh:path rob:place ; sh:in ( :p :kitchen ) ] ."
    assert parameters(f"{ONE} sh:datatype xsd:string . {shape}") == (Parameter(iri("p"), "goal", in_shape=True),)


def test_a_parameter_that_a_role_sets_is_known_to_be_set() -> None:
    (found,) = parameters(f"{ONE} sh:datatype xsd:string .", Setting(iri("Goal"), iri("p")))
    assert (found.in_shape, found.is_set) == (False, True)


@pytest.mark.parametrize(
    "stated",
    [
        'sh:defaultValue "kitchen"',
        'sh:datatype xsd:string ; sh:defaultValue "kitchen"',
        'sh:nodeKind sh:Literal ; sh:defaultValue "kitchen"',
    ],
)
def test_a_default_that_keeps_to_datatype_and_kind_is_read(stated: str) -> None:
    assert parameters(f"{ONE} {stated} .")[0].default == Literal("kitchen")


@pytest.mark.parametrize(
    ("stated", "reason"),
    [
        ("sh:nodeKind sh:IRI ; sh:defaultValue 5", "it is 5, not an IRI"),
        ("sh:nodeKind sh:Literal ; sh:defaultValue :kitchen", "it is kitchen, not a Literal"),
        ("sh:datatype xsd:decimal ; sh:defaultValue 5", "it is 5, an integer, not a decimal"),
        ("sh:datatype xsd:string ; sh:defaultValue :kitchen", "it is kitchen, not a string"),
        ("sh:minInclusive 7 ; sh:defaultValue 5", "it is 5, not at least 7"),
        ("sh:in ( 1 2 ) ; sh:defaultValue 5", "it is 5, not 1 or 2"),
        ('sh:in ( :hall ) ; sh:defaultValue "hall"', 'it is "hall", not <.*#hall>'),
        ("sh:defaultValue []", "it is a blank node, which is another one in each file"),
    ],
)
def test_a_default_that_its_parameter_does_not_allow_is_an_error(stated: str, reason: str) -> None:
    sentence = rf"^t\.ttl: the default of the parameter .* cannot stand for it: {reason}$"
    with pytest.raises(TemplateError, match=sentence):
        parameters(f"{ONE} {stated} .")


def test_a_default_is_read_as_it_is_written() -> None:
    assert parameters(f"{ONE} sh:datatype xsd:integer ; sh:defaultValue 05 .")[0].default == Literal("05", XSD.integer)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('[] sc:name "goal" . :t sc:parameter "goal" .', "a parameter of a template needs an IRI"),
        (":t sc:parameter :p .", "needs exactly one sc:name"),
        (':t sc:parameter :p . :p sc:name "goal", "aim" .', "needs exactly one sc:name"),
        (':t sc:parameter :p . :p sc:name "the goal" .', "one word, a string"),
        (':t sc:parameter :p . :p sc:name "Ziel"@de .', "one word, a string"),
        (':t sc:parameter :p . :p sc:name "goal=" .', "one word, a string without control characters or ="),
        (r':t sc:parameter :p . :p sc:name "go\u202Eal" .', "one word, a string without control characters"),
        (':t sc:parameter :p, :q . :p sc:name "goal" . :q sc:name "goal" .', "two parameters have the name 'goal'"),
        (f"{ONE} sh:defaultValue 1, 2 .", "has several defaults"),
    ],
)
def test_what_is_no_parameter_is_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        parameters(text)


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
        ("sh:datatype xsd:string", "it is 3, an integer, not a string"),
        ("sh:nodeKind sh:IRI", "it is 3, not an IRI"),
        ("sh:pattern '^a'", "it is 3, not like /^a/"),
        ("sh:in ( :a 4 'x' )", 'it is 3, not "x" or 4 or a'),
        ("sh:hasValue 7", "it is 3, not 7"),
        ("sh:class :K", "it is 3, not a K"),
        ("sh:node [ sh:datatype xsd:string ]", "it is 3, an integer, not a string"),
        ("sh:not [ sh:datatype xsd:integer ]", "it is 3, and must not conform to shape [ sh:datatype xsd:integer ]"),
        ("sh:minCount 2", "there are fewer than 2 of it"),
        ("sh:equals :q", "it and q differ by 3"),
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
