"""What a role asks for and sets, and the statements that make up its shape."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import Role
from selfconf.rdf.tasks import read_task
from selfconf.rdf.tasks.roles import mentions, shape_statements, shape_triples, substituted
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import FIRST, REST, SC, SH
from tests.lab import PREFIXES, iri

DOCUMENT = parse(
    PREFIXES
    + ":r a sc:Role ; sc:feeds :s ; sh:class :A ; sh:node :Named ; sh:property [ sh:path :p ; sh:in ( :robot ) ] ."
    " :Named sh:nodeKind sh:IRI ; sh:node :Named . :s a sc:Role ; sh:class :B .",
    "t.ttl",
)


def role(text: str) -> Role:
    """The role `:r` of a template that has it alone, with what a text says of it."""
    template = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :L ."
    (found,) = read_task(parse(f"{PREFIXES}{template} {text}", "t.ttl")).template.roles
    return found


def test_nested_and_named_shapes_belong_to_the_shape_and_other_roles_do_not() -> None:
    said = list(shape_statements(DOCUMENT, iri("r")))
    assert {(SH["class"], iri("A")), (SH.nodeKind, SH.IRI), (SH.path, iri("p"))} <= set(said)
    assert (SH["class"], iri("B")) not in said
    assert len(list(shape_triples(DOCUMENT, iri("r")))) == len(said)


def test_a_parameter_in_a_list_is_mentioned() -> None:
    assert mentions(DOCUMENT, iri("r"), frozenset((iri("robot"), iri("goal")))) == {iri("robot")}
    assert mentions(DOCUMENT, iri("s"), frozenset((iri("robot"),))) == set()


def test_a_parameter_is_replaced_in_shapes_and_nowhere_else() -> None:
    found = substituted(DOCUMENT, {iri("robot"): iri("Astrid"), iri("p"): iri("q"), iri("s"): iri("other")})
    said = set(shape_statements(found, iri("r")))
    assert {(FIRST, iri("Astrid")), (SH.path, iri("q"))} <= said
    assert not {(FIRST, iri("robot")), (SH.path, iri("p"))} & said
    assert found.values(iri("r"), SC.feeds) == [iri("s")]
    assert mentions(DOCUMENT, iri("r"), frozenset((iri("robot"),))), "the template itself stays as it is"


@pytest.mark.parametrize(
    ("counts", "minimum", "maximum"),
    [
        ("", 1, 1),
        (":r sc:minCount 2 .", 2, None),
        (":r sc:maxCount 3 .", 1, 3),
        (":r sc:minCount 0 ; sc:maxCount 1 .", 0, 1),
        (":r sc:minCount -0 ; sc:maxCount +03 .", 0, 3),
        (":r sc:maxCount '2'^^xsd:nonNegativeInteger .", 1, 2),
        (":r sc:minCount 2 ; sc:maxCount 2 .", 2, 2),
    ],
)
def test_a_role_asks_for_exactly_one_unless_it_says_otherwise(counts: str, minimum: int, maximum: int | None) -> None:
    found = role(counts)
    assert (found.minimum, found.maximum) == (minimum, maximum)


@pytest.mark.parametrize(("text", "value"), [("true", True), ("1", True), ("false", False), ("0", False)])
def test_a_role_says_that_it_recruits_by_a_truth_value_however_it_is_written(text: str, value: bool) -> None:
    assert role(f':r sc:recruits "{text}"^^xsd:boolean .').recruits is value


def test_the_same_setting_twice_is_one() -> None:
    settings = ":r sc:sets [ sc:parameterType :P ; sc:value 1 ] , [ sc:parameterType :P ; sc:value 1 ] ."
    assert [setting.type for setting in role(settings).settings] == [iri("P")]
    with pytest.raises(TemplateError, match="2 different values"):
        role(settings.replace("1", "1.0", 1))


@pytest.mark.parametrize(
    "shape",
    [
        "sh:class 5",
        "sh:minCount 1",
        "sh:path :p ; sh:hasValue :x",
        "sh:closed true ; sh:ignoredProperties ( 5 )",
        "sh:property 5",
        "sh:property [ sh:minCount 1 ]",
        "sh:or :x",
        f"sh:or [ <{FIRST}> [ sh:class :L ] ]",
        f"sh:property [ sh:path rob:place ; sh:in [ <{FIRST}> :x ] ]",
        f"sh:property [ sh:path rob:place ; sh:in [ <{FIRST}> :x, :y ; <{REST}> () ] ]",
        f"sh:property [ sh:path [ <{FIRST}> :x ; <{REST}> [ <{FIRST}> :y ] ] ; sh:minCount 1 ]",
        "sh:node 5",
        "sh:property [ sh:path rob:place ; sh:minInclusive :x ]",
        "sh:closed 'yes'",
        "sh:sparql [ sh:select 'SELECT' ]",
    ],
)
def test_a_role_that_is_no_shape_is_not_read(shape: str) -> None:
    with pytest.raises(TemplateError, match="role"):
        role(f":r {shape} .")
