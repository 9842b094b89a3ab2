"""The normal form of shapes: all that is asked of a node and of the values of each path, wherever it stands."""

from __future__ import annotations

import pytest
from rdflib import RDF, SH, Graph, URIRef
from rdflib.term import Node

from selfconf.rdf.validation.lints.normal_form import NormalForm, ShapeSource, ShapeStatement, ValueNormalForm
from tests.lab import PREFIXES, iri

P = (URIRef(iri("p")),)


def graph(text: str) -> Graph:
    return Graph().parse(data=PREFIXES + text, format="turtle")


def source(text: str) -> ShapeSource:
    """The shapes of a text."""
    return ShapeSource(graph(text))


def form(shape: str, more: str = "") -> NormalForm:
    """What the shape `:s` asks of a node."""
    return NormalForm(source(f":s {shape} . {more}"), [URIRef(iri("s"))])


def written(statements: list[ShapeStatement]) -> set[str]:
    """Predicate and object of some statements, as short as can be."""
    return {f"{_short(predicate)} {_short(value)}" for _, predicate, value in statements}


def _short(node: Node) -> str:
    return str(node).rpartition("#")[2]


def bounds(values: ValueNormalForm) -> tuple[list[int], list[int]]:
    """The numbers of values that there are at least, and at most."""
    return [number for number, _ in values.least], [number for number, _ in values.most]


def test_constraints_of_nested_and_of_named_shapes_hold_of_the_node_itself() -> None:
    found = form("sh:class :A ; sh:node [ sh:class :B ] ; sh:and ( :n )", ":n sh:nodeKind sh:IRI .")
    assert written(found.own) == {"class A", "class B", "nodeKind IRI"}
    assert found.whole


def test_two_property_shapes_over_one_path_ask_for_the_same_values() -> None:
    found = form("sh:property [ sh:path :p ; sh:minCount 1 ] , [ sh:path :p ; sh:maxCount 3 ; sh:class :A ]")
    assert list(found.values) == [P]
    assert bounds(found.values[P]) == ([1], [3])
    assert written(found.values[P].each.own) == {"class A"}
    assert found.own == []


def test_of_several_least_numbers_the_greatest_is_needed() -> None:
    found = form("sh:property [ sh:path :p ; sh:minCount 1 ] , [ sh:path :p ; sh:minCount 2 ]")
    needed = found.along(P).needed()
    assert needed is not None
    assert (needed[0], _short(needed[1][1])) == (2, "minCount")
    assert form("sh:property [ sh:path :p ; sh:minCount 0 ]").along(P).needed() is None


def test_a_required_value_is_one_that_has_to_be_there() -> None:
    values = form("sh:property [ sh:path :p ; sh:hasValue :a ]").along(P)
    assert bounds(values) == ([1], [])
    assert written(values.required) == {"hasValue a"}
    assert values.each.own == []


def test_choices_negations_and_closed_shapes_are_kept_apart() -> None:
    found = form("sh:or ( [ sh:class :A ] ) ; sh:xone ( [ sh:class :B ] ) ; sh:not [ sh:class :C ] ; sh:closed true")
    assert [len(some) for some in (found.choices, found.nots, found.closed, found.own)] == [2, 1, 1, 0]


@pytest.mark.parametrize(
    ("shape", "whole"),
    [
        ("sh:class :A ; sh:message 'a lamp' ; rdfs:label 'lamp'", True),
        ("sh:class :robot", False),
        ("sh:in ( :a :robot )", False),
        ("sh:property [ sh:path :p ; sh:minCount :robot ]", False),
        ("sh:sparql [ sh:select 'SELECT' ]", False),
        ("sh:equals :p", False),
    ],
)
def test_what_is_not_understood_or_not_known_yet_is_left_out_and_noted(shape: str, whole: bool) -> None:
    assert form(shape, ":robot a sc:Parameter .").whole == whole


def test_a_deactivated_shape_asks_for_nothing() -> None:
    found = form("sh:class :A ; sh:node :n", ":n sh:class :B ; sh:deactivated true .")
    assert written(found.own) == {"class A"}


def test_shapes_that_speak_of_themselves_come_to_an_end() -> None:
    found = form("sh:property :m", ":m sh:path :p ; sh:property :n . :n sh:path :p ; sh:property :m .")
    depth = 0
    while P in found.values:
        found, depth = found.values[P].each, depth + 1
    assert 1 < depth < 10
    assert not found.whole


def test_a_sequence_asks_also_for_what_its_steps_ask_for_one_by_one() -> None:
    step = "sh:property [ sh:path :p ; sh:property [ sh:path :q ; sh:class :B ] ]"
    found = form(f"{step} ; sh:property [ sh:path ( :p :q ) ; sh:class :A ]")
    sequence = (RDF.first, URIRef(iri("p")), URIRef(iri("q")))
    assert written(found.values[sequence].each.own) == {"class A", "class B"}


def test_what_holds_of_every_object_of_a_property_holds_of_its_values() -> None:
    asked = graph(":s sh:property [ sh:path :p ; sh:minCount 1 ] . :other sh:targetObjectsOf :p ; sh:class :A .")
    always = graph(":always sh:targetObjectsOf :p ; sh:nodeKind sh:IRI .")
    found = NormalForm(ShapeSource(asked, always), [URIRef(iri("s"))])
    assert written(found.values[P].each.own) == {"nodeKind IRI"}


def test_a_further_shape_is_added_to_a_form_of_its_own() -> None:
    found = form("sh:class :A ; sh:property [ sh:path :p ; sh:minCount 1 ]", ":n sh:class :B .")
    more = found.plus(URIRef(iri("n")))
    assert written(more.own) == {"class A", "class B"}
    assert bounds(more.along(P)) == ([1], [])
    assert written(found.own) == {"class A"}


def test_paths_that_are_written_alike_are_equal() -> None:
    given = source(":s :a [ sh:inversePath :p ] ; :b [ sh:inversePath :p ] ; :c ( :p :q ) ; :d :p .")
    paths = [given.path(given.values(URIRef(iri("s")), URIRef(iri(name)))[0]) for name in "abcd"]
    assert paths[0] == paths[1]
    assert len(set(paths)) == 3
    assert paths[3] == P


def test_the_members_of_a_list_without_an_end_are_each_told_once() -> None:
    given = source("@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . :a rdf:first 1 ; rdf:rest :a .")
    assert len(given.items(URIRef(iri("a")))) == 1
    assert given.items(SH.path) == []
