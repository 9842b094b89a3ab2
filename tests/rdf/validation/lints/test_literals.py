"""Lints about literals: in the place of things, and of another datatype than their property has."""

from __future__ import annotations

import pytest

from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Severity
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.harness.effort import thorough
from tests.rdf.validation.lints.linted_text import HEAD, ONTOLOGIES, SHAPES, TEMPLATE, lints, only


def test_a_literal_comes_with_an_iri_to_write_instead() -> None:
    assert only(":a a sc:Component, rob:Tuner ; rob:place 'living room' .").hint == (
        "Write an IRI, such as :living-room."
    )


def test_a_literal_where_a_thing_is_wanted_is_noticed_in_every_known_ontology() -> None:
    assert only(':a a sc:Component, rob:Tuner ; rob:support "Astrid" .').code == "SC-L07"


@pytest.mark.parametrize("asked", ["sh:hasValue :p", "sh:in ( :hall :p )"])
def test_a_parameter_that_stands_for_a_literal_where_a_thing_is_wanted_is_noticed(asked: str) -> None:
    text = TEMPLATE + f":t sc:parameter :p . :r sh:property [ sh:path rob:place ; {asked} ] . :p a sc:Parameter ; "
    found = only(text + "sc:name 'p' ; sh:datatype xsd:string .")
    assert (found.code, found.hint) == ("SC-L07", "Say sh:nodeKind sh:IRI of :p in place of its sh:datatype.")
    assert not lints(text + "sc:name 'p' .")
    assert not lints(text.replace("rob:place", ":floor") + "sc:name 'p' ; sh:datatype xsd:integer .")


def test_a_label_is_a_literal_and_stays_one() -> None:
    assert not lints(':a a sc:Component, rob:Tuner ; rdfs:label "tuner" ; :note "x" .')


@pytest.mark.parametrize(
    ("datatype", "value", "hint"),
    [
        ("integer", '"2"', "2"),
        ("integer", '"two"', "a whole number, such as 10"),
        ("boolean", '"true"', "true"),
        ("boolean", "1", "true"),
        ("boolean", '"0"', "false"),
        ("negativeInteger", "5", "a whole number, such as -10"),
        ("double", '"INF"', '"INF"^^xsd:double'),
        ("duration", '"P1D"', '"P1D"^^xsd:duration'),
        ("boolean", '"yes"', "true or false"),
        ("date", '"2026-01-31"', '"2026-01-31"^^xsd:date'),
        ("date", '"31.1.2026"^^xsd:date', 'it as in "2026-01-31"^^xsd:date'),
    ],
)
def test_a_literal_of_another_datatype_than_its_property_has_is_told(datatype: str, value: str, hint: str) -> None:
    declared = f":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:{datatype} .\n"
    found = only(f"{declared}:a a sc:Component, rob:Tuner ; :p {value} .")
    assert (found.code, found.severity, found.hint) == ("SC-L26", Severity.WARNING, f"Write {hint}.")


def test_a_literal_of_one_of_the_datatypes_of_its_property_is_not_told() -> None:
    declared = ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer, xsd:date .\n"
    assert lints(f"{declared}:a a sc:Component, rob:Tuner ; :p 2, '2026-01-31'^^xsd:date .") == []


def test_the_literal_of_a_file_is_told_whose_property_another_file_declares() -> None:
    vocabulary = PREAMBLE + ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer ."
    texts = [SourceText("a.ttl", (PREAMBLE + ":a a sc:Component, rob:Tuner ; :p '2' .").encode())]
    ontologies = [*ONTOLOGIES, SourceText("v.ttl", vocabulary.encode())]
    assert [one.code for one in validate_texts(texts, SHAPES, ontologies).diagnostics] == ["SC-L26"]


@pytest.mark.parametrize(
    ("asked", "code", "at"),
    [
        ("sh:path rob:place ; sh:hasValue 'kitchen'", "SC-L07", "'kitchen'"),
        ("sh:path rob:place ; sh:in ( :hall 'kitchen' )", "SC-L07", "'kitchen'"),
        ("sh:path :p ; sh:maxInclusive '2'", "SC-L26", "'2'"),
        ("sh:path :p ; sh:in ( 1 '2' 3 )", "SC-L26", "'2'"),
    ],
)
def test_what_a_shape_asks_of_a_property_is_as_the_property_wants_it(asked: str, code: str, at: str) -> None:
    declared = ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer .\n"
    role = f":r sh:property [ {asked} ] ."
    found = only(declared + TEMPLATE + role)
    assert (found.code, found.line, found.column) == (code, HEAD + 3, role.index(at) + 1)


def test_what_a_shape_asks_of_a_longer_path_is_left_alone() -> None:
    asked = "sh:path ( rob:support rob:place ) ; sh:hasValue 'kitchen'"
    assert lints(f"{TEMPLATE}:r sh:property [ {asked} ] .") == []


@thorough
def test_a_list_of_thousands_may_be_asked_for() -> None:
    many = " ".join(f":p{number}" for number in range(3000))
    assert only(f"{TEMPLATE}:r sh:property [ sh:path rob:place ; sh:in ( {many} 'kitchen' ) ] .").code == "SC-L07"


@pytest.mark.parametrize(
    ("said", "pair"), [(":p 1,5", "1,5 are two values, 1 and 5."), (":p 7 , -12,0", "-12,0 are two values, -12 and 0.")]
)
def test_a_number_with_a_comma_is_two_values(said: str, pair: str) -> None:
    found = only(f":a a sc:Component, rob:Tuner ; {said} .")
    assert (found.code, found.message) == ("SC-L26", pair)


@pytest.mark.parametrize("said", [":p 1 , 5", ":p 1,5,7", ":p '1,5'", ":p 1.5,2.5", ":p 1 ; rdfs:comment '''\n1,5'''"])
def test_values_with_commas_between_are_left_alone(said: str) -> None:
    assert lints(f":a a sc:Component, rob:Tuner ; {said} .") == []


@pytest.mark.parametrize(
    ("asked", "more"),
    [
        ("sh:datatype xsd:string", ""),
        ("sh:in ( :place )", ":t sc:parameter :place . :place a sc:Parameter ; sc:name 'place' ; sh:in ( 'hall' ) ."),
    ],
)
def test_a_shape_that_asks_a_property_of_things_for_literals_is_noticed(asked: str, more: str) -> None:
    found = only(f"{TEMPLATE}:r sh:property [ sh:path rob:place ; {asked} ] .\n{more}")
    assert (found.code, found.line) == ("SC-L07", HEAD + 2)
