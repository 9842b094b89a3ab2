"""The parameters of a template: their names, their defaults, and where they stand for a value."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import Parameter, Role, Setting
from selfconf.model.term import Literal
from selfconf.rdf.tasks.parameters import parameters_of
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
    "stated",
    [
        "sh:nodeKind sh:IRI ; sh:defaultValue 5",
        "sh:nodeKind sh:Literal ; sh:defaultValue :kitchen",
        "sh:datatype xsd:decimal ; sh:defaultValue 5",
        "sh:datatype xsd:string ; sh:defaultValue :kitchen",
    ],
)
def test_a_default_of_another_datatype_or_kind_is_an_error(stated: str) -> None:
    with pytest.raises(TemplateError, match=r"^t\.ttl: the default of the parameter .* is not of its sh:datatype"):
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
        (':t sc:parameter :p, :q . :p sc:name "goal" . :q sc:name "goal" .', "two parameters have the name 'goal'"),
        (f"{ONE} sh:defaultValue 1, 2 .", "has several defaults"),
    ],
)
def test_what_is_no_parameter_is_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        parameters(text)
