"""A role as a shape for any SHACL engine and as a query for any SPARQL engine, or one sentence why there is none."""

from __future__ import annotations

import pyoxigraph as ox
import pyshacl
import pytest
from rdflib import SH, Graph, Literal

from selfconf.errors import AuthorError
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.rdf import role_export
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.eligibility import Partitioner
from selfconf.rdf.sparql import Dataset
from selfconf.rdf.tasks import TaskDocument, bind, read_task
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

ABOVE = Hierarchy([(iri("Lamp"), iri("Light")), (iri("Goal"), iri("Aim"))], [(iri("red"), iri("colour"))])
ADS = PREFIXES + (
    ":a a sc:Component, :Lamp ; :p 1, 2 ; :most 2 ; :colour :warm ; sc:preference 1 ."
    ' :b a sc:Component, :Light ; :p 10 ; :red :cold ; rdfs:label "Bee" .'
    ' :c a sc:Component, :Bell ; :p "x" ; sc:hasParameter [ sc:name "n" ; sc:parameterType :Aim ] .'
)
TEMPLATE = (
    ":t a sc:Template ; sc:roles ( :r :s ) ; sc:parameter :robot . :r a sc:Role ; {} . :s a sc:Role ; sh:class :Other ."
    ' :robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .'
)
SHAPES = [
    ("sh:class :Lamp", "a"),
    ("sh:class :Light", "ab"),
    ("sh:in ( :b :c )", "bc"),
    ("sh:property [ sh:path :colour ; sh:minCount 1 ]", "ab"),
    ("sh:property [ sh:path :p ; sh:minCount 2 ]", "a"),
    ("sh:property [ sh:path :p ; sh:maxCount 1 ]", "bc"),
    ("sh:property [ sh:path :p ; sh:hasValue 10 ]", "b"),
    ("sh:property [ sh:path :p ; sh:in ( 1 2 10 ) ]", "ab"),
    ("sh:property [ sh:path :p ; sh:datatype xsd:integer ]", "ab"),
    ("sh:property [ sh:path :p ; sh:minInclusive 2 ]", "b"),
    ("sh:property [ sh:path :p ; sh:lessThan :most ]", "bc"),
    ("sh:property [ sh:path :p ; sh:lessThanOrEquals :most ]", "abc"),
    ("sh:property [ sh:path :p ; sh:lessThan :colour ]", "c"),
    ("sh:property [ sh:path :colour ; sh:pattern 'WARM$' ; sh:flags 'i' ]", "ac"),
    ("sh:property [ sh:path rdfs:label ; sh:maxLength 2 ]", "ac"),
    ("sh:property [ sh:path :p ; sh:nodeKind sh:IRI ]", ""),
    ("sh:property [ sh:path :p ; sh:qualifiedMinCount 1 ; sh:qualifiedValueShape [ sh:in ( 2 10 ) ] ]", "ab"),
    ("sh:property [ sh:path :p ; sh:qualifiedMinCount 1 ; sh:qualifiedValueShape [ sh:hasValue 2 ] ]", "a"),
    ("sh:property [ sh:path :p ; sh:qualifiedMinCount 2 ; sh:qualifiedValueShape [ sh:maxInclusive 9 ] ]", "a"),
    ("sh:property [ sh:path :p ; sh:qualifiedMaxCount 0 ; sh:qualifiedValueShape [ sh:nodeKind sh:Literal ] ]", ""),
    ("sh:property [ sh:path :p ; sh:qualifiedMaxCount 1 ; sh:qualifiedValueShape [ sh:minInclusive 1 ] ]", "bc"),
    ("sh:or ( [ sh:class :Lamp ] [ sh:class :Bell ] )", "ac"),
    ("sh:not [ sh:class :Light ]", "c"),
    ("sh:xone ( [ sh:class :Light ] [ sh:class :Lamp ] )", "b"),
    ("sc:sets [ sc:parameterType :Goal ; sc:value 1 ]", "c"),
]


def read(shape: str, *bound: tuple[str, str]) -> TaskDocument:
    """A task with a role `:r` of that shape, and values for its parameters."""
    return bind(read_task(parse(PREFIXES + TEMPLATE.format(shape), "t.ttl")), bound)


def role_shape(given: TaskDocument) -> str:
    """The shape of the role `:r`."""
    return role_export.shape(given, Partitioner(given, ABOVE).roles[0], ABOVE)


def role_query(given: TaskDocument, hierarchy: Hierarchy = ABOVE) -> str:
    """The query of the role `:r`."""
    ecology = read_advertisements(ADS.encode(), "a.ttl")[0]
    return role_export.query(Partitioner(given, hierarchy).roles[0], hierarchy, ecology)


def answers(query: str) -> str:
    """The components that a query finds, in order."""
    dataset = Dataset()
    dataset.add_advertisements(read_advertisements(ADS.encode(), "a.ttl")[0])
    found = dataset.query(query)
    assert isinstance(found, ox.QuerySolutions)
    return "".join(row["component"].value.rpartition("#")[2] for row in found)


@pytest.mark.parametrize(("shape", "components"), SHAPES, ids=[shape for shape, _ in SHAPES])
def test_the_query_finds_the_candidates_of_the_role(shape: str, components: str) -> None:
    given = read(shape)
    partition = Partitioner(given, ABOVE).partition(read_advertisements(ADS.encode(), "a.ttl")[0])
    candidates = "".join(candidate.profile.component.short for candidate in partition.candidates[0])
    assert answers(role_query(given)) == candidates == components


def test_without_a_hierarchy_only_the_class_itself_is_asked_for() -> None:
    assert answers(role_query(read("sh:class :Light"), NOTHING_ABOVE)) == "b"


def test_a_string_in_the_shape_is_to_rdflib_what_it_is_in_advertisements() -> None:
    shapes = Graph().parse(data=role_shape(read("sh:property [ sh:path :p ; sh:hasValue 'red' ]")), format="turtle")
    assert list(shapes.objects(predicate=SH.hasValue)) == [Literal("red")]


def test_the_shape_has_what_the_role_sets_as_a_constraint() -> None:
    given = read("sh:class :Bell ; sc:sets [ sc:parameterType :Goal ; sc:value 1 ]")
    shapes = Graph().parse(data=role_shape(given), format="turtle")
    ads = Graph().parse(data=ADS, format="turtle")
    verdicts = [
        pyshacl.validate(ads, shacl_graph=shapes, focus_nodes=[iri(name)], use_shapes=[iri("r")])[0] for name in "abc"
    ]
    assert verdicts == [False, False, True]


def test_the_shape_is_the_role_alone_with_the_prefixes_of_its_file() -> None:
    shape = role_shape(read("sh:node :Named ; sc:feeds :s . :Named sh:nodeKind sh:IRI"))
    graph = Graph().parse(data=shape, format="turtle")
    assert {str(subject) for subject in graph.subjects()} == {iri("r"), iri("Named")}
    assert f"@prefix : <{iri('')}> ." in shape


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('"1"^^xsd:integer', '"x"^^xsd:integer'),
        ('"2024-01-01"^^xsd:date', '"1"^^xsd:integer'),
    ],
)
def test_the_query_of_a_datatype_finds_what_is_of_it(right: str, wrong: str) -> None:
    found = read(f"sh:property [ sh:path :p ; sh:minCount 1 ; sh:datatype {right.rpartition('^')[2]} ]")
    literals = (right, '"no literal of the datatype"', wrong)
    ads = PREFIXES + " ".join(f":c{n} a sc:Component, :Lamp ; :p {one} ." for n, one in enumerate(literals))
    dataset = Dataset()
    dataset.add_advertisements(read_advertisements(ads.encode(), "a.ttl")[0])
    answer = dataset.query(role_query(found))
    assert isinstance(answer, ox.QuerySolutions)
    assert [row["component"].value for row in answer] == [iri("c0")]


IN_LIST = "sh:property [ sh:path :colour ; sh:in ( :robot ) ]"


def test_a_bound_parameter_stands_as_its_value_in_both() -> None:
    given = read(IN_LIST, ("robot", ":warm"))
    assert ":warm" in role_shape(given)
    assert ":robot" not in role_shape(given)
    assert answers(role_query(given)) == "ac"


def test_a_free_parameter_has_no_shape_and_is_named() -> None:
    with pytest.raises(AuthorError, match="mentions the free parameter robot; bind it to see the shape"):
        role_shape(read(IN_LIST))


def test_several_free_parameters_are_all_named() -> None:
    names = ("x", "y", "z")
    asked = " , ".join(f"[ sh:path :p ; sh:in ( :{name} ) ]" for name in names)
    parameters = " ".join(f":{name} a sc:Parameter ; sc:name '{name}' ." for name in names)
    template = f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :x , :y , :z . :r a sc:Role ; sh:property {asked} ."
    given = read_task(parse(f"{PREFIXES} {template} {parameters}", "t.ttl"))
    with pytest.raises(AuthorError, match="mentions the free parameters x, y and z; bind them to see the shape"):
        role_shape(given)


def test_a_free_parameter_in_one_place_may_be_any_one_value_in_the_query() -> None:
    assert answers(role_query(read(IN_LIST))) == "abc"


def test_a_free_parameter_in_two_places_has_no_query() -> None:
    twice = f"{IN_LIST} ; sh:property [ sh:path :p ; sh:hasValue :robot ]"
    with pytest.raises(AuthorError, match="mentions a free parameter twice; bind it to see the query"):
        role_query(read(twice))


def test_what_sparql_cannot_say_is_referred_to_the_shape() -> None:
    with pytest.raises(AuthorError, match="says what a SPARQL query cannot; see its shape by show='shape'"):
        role_query(read("sh:property [ sh:path :p ; sh:equals :q ]"))
