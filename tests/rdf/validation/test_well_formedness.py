"""Whether the shape of a role can be asked about a component: what keeps it from that, and where it stands."""

from __future__ import annotations

import pytest
from rdflib import SH, Graph

from selfconf.errors import TemplateError
from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.tasks import read_task
from selfconf.rdf.turtle import parse
from selfconf.rdf.validation.well_formedness import (
    endless_lists,
    malformed_roles,
    shape_of_shapes,
)
from tests.lab import PREFIXES, iri

HEAD = PREFIXES.count("\n")
LISTS = "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . "
PARAMETER = ':robot a sc:Parameter ; sc:name "robot" ; {} .\n'


def malformed(text: str) -> list[Diagnostic]:
    """What keeps the roles of a text from being shapes."""
    return list(malformed_roles(*parse_with_positions(PREFIXES + text, "a.ttl")))


def places(text: str) -> list[tuple[int, int]]:
    """Line below the prefixes and column of each list in a text that has no end."""
    found = list(endless_lists(*parse_with_positions(PREFIXES + text, "a.ttl")))
    assert {each.code for each in found} <= {"SC-S06"}
    return [(each.line - HEAD, each.column) for each in found]


@pytest.mark.parametrize(
    "shape",
    [
        "sh:class :Lamp",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:in ( 1 2 ) ]",
        "sh:property [ sh:path :p ; sh:minCount +1 ; sh:maxCount 02 ; sh:minLength -0 ]",
        "sh:or ( [ sh:class :A ] [ sh:class :B ] )",
        "sh:pattern '^(?=([a-z:-]+)+!)'",  # which takes years for a long name
        "sh:property [ sh:path ( :p :q ) ; sh:pattern '^a+$' ]",
        "sh:property [ sh:path ( :p :q ) ; sh:pattern 'a(b' ; sh:flags 'q' ]",
        "sh:sparql [ sh:select 'SELECT $this WHERE { $this a ?type }' ]",
        "sc:recruits [ sh:path :p ; sh:minCount 1 ]",
        "sc:recruits true",
        "sh:or ( [ sh:path [ sh:alternativePath ( :p ( :q :p ) ) ] ; sh:minCount 1 ] [ sh:class :K ] )",
    ],
)
def test_a_role_that_is_a_shape_has_nothing_wrong(shape: str) -> None:
    assert malformed(f":r a sc:Role ; {shape} .") == []


def test_a_shape_that_is_no_role_is_not_looked_at() -> None:
    assert malformed(":s sh:class 5 .") == []


@pytest.mark.parametrize(
    ("shape", "column", "sentence"),
    [
        ("sh:class 5", 25, "sh:class"),
        ("sh:property [ sh:minCount 1 ]", 28, "exactly one sh:path"),
        ("sh:minCount 1", 16, "how many play a role is sc:minCount"),
        ("sh:path :p ; sh:hasValue 1", 24, "has no sh:path: write sh:property [ sh:path ... ]"),
        ("sh:hasValue 1 ; sh:lessThan :p", 32, "write sh:property"),
        ("sh:node 'x'", 24, "sh:node"),
        ("sh:property [ sh:path :p ; sh:node [ sh:path :q ] ]", 51, "one with a sh:path stands behind sh:property"),
        ("sh:property [ sh:path :p ; sh:minCount ' 1 '^^xsd:integer ]", 55, "has to be a whole number"),
        ("sh:property [ sh:path :p ; sh:qualifiedValueShape [ ] ; sh:qualifiedMaxCount -1 ]", 93, "a whole number"),
        ("sh:property [ sh:path :p ; sh:minCount 1 , 2 ]", 59, "A shape has one sh:minCount at most."),
        ("sh:property [ sh:path :p ; sh:pattern '(' ]", 54, "This is no regular expression"),
        ("sh:property [ sh:path :p ; sh:pattern 'a{99999999999}' ]", 54, "it repeats something too often"),
        ("sh:qualifiedMaxCount 1", 16, "Beside sh:qualifiedMaxCount stands sh:qualifiedValueShape."),
        (
            "sh:property [ sh:path :p ; sh:node [ sh:ignoredProperties ( :p ) ] ]",
            53,
            "Beside sh:ignoredProperties stands sh:closed.",
        ),
        (r"sh:property [ sh:path :p ; sh:pattern '\\p{L}+' ]", 54, r"a letter of any language is [^\W\d_]."),
        ("sh:sparql [ sh:select 'SELECT' ]", 38, "This is not SPARQL: at 1:7 it ends too soon."),
        (
            "sh:sparql [ sh:select 'SELECT $this { $this k:x 1 }' ]",
            38,
            "the prefix k: is not declared; begin with PREFIX",
        ),
        ("sh:sparql [ sh:select 'SELECT ?x { ?x a ?t }' ]", 38, "has to be a SELECT query that selects $this."),
        (
            "sh:sparql [ sh:select 'CONSTRUCT WHERE { $this a ?t }' ]",
            38,
            "has to be a SELECT query that selects $this.",
        ),
        (
            "sh:sparql [ sh:select 'SELECT $this {}' ; sh:ask 'SELECT $this { $this a ?t }' ]",
            65,
            "The value of sh:ask has to be an ASK query.",
        ),
    ],
)
def test_what_is_wrong_with_a_shape_is_told_where_it_stands(shape: str, column: int, sentence: str) -> None:
    found = malformed(f":r a sc:Role ; {shape} .")
    assert {(each.code, each.line - HEAD, each.column) for each in found} == {("SC-T13", 1, column)}
    assert sentence in found[0].message


def test_a_query_with_a_costly_pattern_of_its_own_is_told_at_its_role() -> None:
    query = f"SELECT $this {{ BIND (STR('{'a' * 80}!') AS ?text) FILTER (REGEX(?text, '^(a+)+\\\\\\\\1+$')) }}"
    (only,) = malformed(f':r a sc:Role ; sh:sparql [ sh:select "{query}" ] .')
    assert only.code == "SC-T13"
    assert "matching the pattern" in only.message


def test_a_query_that_would_leave_this_machine_is_refused() -> None:
    query = "SELECT $this WHERE { SERVICE <http://example.org/> { $this a ?type } }"
    (only,) = malformed(f":r a sc:Role ; sh:sparql [ sh:select '{query}' ] .")
    assert only.code == "SC-T13"


@pytest.mark.parametrize(
    ("opened", "closed", "levels"),
    [
        ("sh:property [ sh:path :p ; ", " ]", 1),
        ("sh:property [ sh:path :p ; sh:node [ ", " ] ]", 2),
        ("sh:not [ ", " ]", 1),
        ("sh:or ( [ ", " ] [ sh:class :A ] )", 1),
    ],
)
def test_a_shape_that_nests_deeper_than_pyshacl_follows_is_told_also_where_only_values_lead_there(
    opened: str, closed: str, levels: int
) -> None:
    most = (DEEPEST_SHAPE - 1) // levels
    for times, wrong in ((most, False), (most + 1, True)):
        found = malformed(f":r a sc:Role ; {opened * times}sh:class :A{closed * times} .")
        assert [each.message for each in found] == ["The shape of this role nests shapes more than 15 deep."] * wrong


def test_a_shape_that_comes_back_to_itself_is_not_taken_to_be_deep() -> None:
    assert malformed(":r a sc:Role ; sh:property [ sh:path :p ; sh:node :r ] .") == []


@pytest.mark.parametrize(
    ("kind", "wrong"),
    [
        ("sh:datatype xsd:integer", False),
        ("sh:datatype xsd:string", True),
        ("sh:nodeKind sh:IRI", True),
        ("rdfs:comment 'of any kind'", False),
    ],
)
def test_a_parameter_is_judged_by_a_sample_of_its_datatype(kind: str, wrong: bool) -> None:
    text = PARAMETER.format(kind) + ":r a sc:Role ; sh:property [ sh:path :p ; sh:minCount :robot ] ."
    assert bool(malformed(text)) == wrong


@pytest.mark.parametrize("kind", ["sh:datatype xsd:string", "sh:nodeKind sh:IRI", "rdfs:comment 'of any kind'"])
@pytest.mark.parametrize("predicate", ["sh:property", "sh:sparql", "sh:path"])
def test_no_parameter_stands_for_a_part_of_a_shape(predicate: str, kind: str) -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :robot . :r a sc:Role ; {predicate} :robot .\n"
    text += PARAMETER.format(kind)
    assert {one.code for one in malformed(text)} == {"SC-T13"}
    with pytest.raises(TemplateError):
        read_task(parse(PREFIXES + text, "a.ttl"), iri("t"))


@pytest.mark.parametrize("kind", ["sh:datatype xsd:integer", "rdfs:comment 'of any kind'"])
@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("sh:minCount :robot", "how many play a role is sc:minCount"),
        ("sh:lessThan :robot", "sh:lessThan is asked of the values of a property"),
        ("sh:uniqueLang :robot", "sh:uniqueLang is asked of the values of a property"),
        ("sh:property [ sh:path :p ; sh:path :robot ]", "exactly one sh:path"),
    ],
)
def test_a_parameter_whatever_it_stands_for_is_a_mistake_where_no_value_may_be(
    said: str, words: str, kind: str
) -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :robot . :r a sc:Role ; {said} .\n"
    text += PARAMETER.format(kind)
    assert any(words in one.message for one in malformed(text))
    with pytest.raises(TemplateError):
        read_task(parse(PREFIXES + text, "a.ttl"), iri("t"))


def test_a_parameter_of_any_kind_may_be_a_property_of_a_path() -> None:
    for path in (":robot", "[ sh:inversePath :robot ]", "( :p [ sh:zeroOrMorePath :robot ] )"):
        text = f":r a sc:Role ; sh:property [ sh:path {path} ; sh:minCount 1 ] .\n"
        assert malformed(text + PARAMETER.format("rdfs:comment 'of any kind'")) == []


@pytest.mark.parametrize("kind", ["sh:datatype xsd:{}", "rdfs:comment 'of any kind, not {}'"])
@pytest.mark.parametrize(
    ("said", "datatype"),
    [
        ("sh:languageIn ( 'de' :robot )", "string"),
        ("sh:qualifiedValueShape [ sh:class :A ] ; sh:qualifiedMaxCount :robot", "integer"),
    ],
)
def test_a_parameter_may_be_a_language_of_a_list_or_the_only_count_of_a_shape(
    said: str, datatype: str, kind: str
) -> None:
    text = f":r a sc:Role ; sh:property [ sh:path :p ; {said} ] .\n"
    assert malformed(text + PARAMETER.format(kind.format(datatype))) == []


@pytest.mark.parametrize("recruited", ["[ sh:path 'x' ]", "[ sh:path :p ; sh:class 5 ]"])
def test_a_shape_of_what_is_recruited_is_looked_at(recruited: str) -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sc:recruits {recruited} ."
    assert {one.code for one in malformed(text)} == {"SC-T13"}
    with pytest.raises(TemplateError):
        read_task(parse(PREFIXES + text, "a.ttl"), iri("t"))


@pytest.mark.parametrize("shape", ["{}", "sh:path [ sh:zeroOrOnePath :p ] ; sh:node [ {} ]"])
def test_a_shape_of_what_is_recruited_is_tried_as_that_of_a_role(shape: str) -> None:
    query = "SELECT $this { $this ?p 1 { SELECT ?p { ?s ?p 2 } } }"
    asked = shape.format(f'sh:sparql [ sh:select "{query}" ]')
    (only,) = malformed(f":r a sc:Role ; sc:recruits true .\n:s a sc:Role ; sc:recruits [ {asked} ] .")
    assert (only.code, only.line - HEAD) == ("SC-T13", 2)
    assert only.message.startswith("The shape of what is recruited cannot be evaluated: ")
    assert "nested SELECT" in only.message


def test_a_shape_of_what_is_recruited_may_nest_as_deep_as_that_of_a_role() -> None:
    deep = "[ sh:node " * (DEEPEST_SHAPE - 1) + "[ sh:class :Lamp ]" + " ]" * (DEEPEST_SHAPE - 1)
    assert malformed(f":r a sc:Role ; sc:recruits {deep} .") == []


def test_a_constraint_component_that_a_parameter_is_given_to_is_tried() -> None:
    role = ":r a sc:Role ; :one :robot . :One a sh:ConstraintComponent ; sh:parameter [ sh:path :one ]"
    text = PARAMETER.format("") + role
    (only,) = malformed(f"{text} .")
    assert only.code == "SC-T13"
    assert malformed(f'{text} ; sh:validator [ a sh:SPARQLAskValidator ; sh:ask "ASK {{ $value ?any $one }}" ] .') == []


@pytest.mark.parametrize("shape", ["sh:class 5", "sh:path :p"])
def test_of_two_roles_only_the_one_that_cannot_be_asked_is_told(shape: str) -> None:
    found = malformed(f":good a sc:Role ; sh:class :A .\n:bad a sc:Role ; {shape} .")
    assert [each.line - HEAD for each in found] == [2]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (":a :p ( 1 2 3 ) .", 0),
        (LISTS + ":a rdf:first 1 ; rdf:rest :a .", 1),
        (LISTS + ":a rdf:rest :b . :b rdf:rest :c . :c rdf:rest :b .", 1),
        (LISTS + ":a rdf:rest :a . :b rdf:rest :b .", 2),
        (LISTS + ":a rdf:rest :b . :b rdf:rest rdf:nil .", 0),
    ],
)
def test_each_list_that_comes_back_to_itself_is_told_once(text: str, found: int) -> None:
    assert len(places(text)) == found


def test_a_list_without_an_end_is_told_where_a_cell_of_it_is_described() -> None:
    assert places("@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n:a rdf:rest :a .") == [(2, 1)]


def test_the_shape_of_shapes_is_that_of_shacl_and_is_read_once() -> None:
    assert isinstance(shape_of_shapes(), Graph)
    assert (None, SH.path, SH.minCount) in shape_of_shapes()
    assert shape_of_shapes() is shape_of_shapes()


def test_a_parameter_that_cannot_stand_where_it_does_is_told_there() -> None:
    (found,) = malformed(PARAMETER.format("sh:datatype xsd:string") + ":r a sc:Role ; sh:class :robot .")
    assert (found.line - HEAD, found.column) == (2, 25)
    assert found.message == "The value of sh:class has to be an IRI, and this parameter stands for another value."
    assert not malformed(PARAMETER.format("sh:nodeKind sh:IRI") + ":r a sc:Role ; sh:class :robot .")


@pytest.mark.parametrize("said", ["sh:in :a , :b", "sh:in 1 , 2 , 3", "sh:or [ sh:class :A ] , [ sh:class :B ]"])
def test_members_with_commas_between_are_one_problem_at_the_first(said: str) -> None:
    (found,) = malformed(f":r a sc:Role ; sh:property [ sh:path :p ; {said} ] .")
    assert found.message.startswith(f"The value of {said[:5]} has to be a list in parentheses")
    assert found.column == len(":r a sc:Role ; sh:property [ sh:path :p ; ") + 7
