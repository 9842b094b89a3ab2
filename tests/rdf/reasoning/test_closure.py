"""The hierarchy that a reasoning mode lets a role see."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rdflib.namespace import DefinedNamespaceMeta

from selfconf import library
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.reasoning.closure import hierarchy
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import RDFS, ROB
from tests.lab import PREFIXES, iri

OWL = "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n"


def of(text: str, reasoning: Reasoning = Reasoning.SUBCLASS) -> Hierarchy:
    """The hierarchy of an ontology."""
    return hierarchy([turtle.parse(PREFIXES + OWL + text, "ontology.ttl")], reasoning)


def test_syntactic_mode_knows_no_hierarchy() -> None:
    found = of(":A rdfs:subClassOf :B .", Reasoning.SYNTACTIC)
    assert not found.matches(iri("A"), iri("B"))
    assert found.matches(iri("A"), iri("A"))


def test_a_class_matches_every_class_above_it_and_none_below() -> None:
    found = of(":A rdfs:subClassOf :B . :B rdfs:subClassOf :C . :D rdfs:subClassOf :B .")
    assert found.matches(iri("A"), iri("C"))
    assert not found.matches(iri("C"), iri("A"))
    assert not found.matches(iri("A"), iri("D"))
    assert found.superclasses(iri("A")) == {iri("A"), iri("B"), iri("C")}


def test_equivalent_classes_match_each_other_and_circles_end() -> None:
    found = of(":A owl:equivalentClass :B . :B rdfs:subClassOf :C . :C rdfs:subClassOf :A .")
    for one in "ABC":
        for other in "ABC":
            assert found.matches(iri(one), iri(other))


def test_properties_have_a_hierarchy_of_their_own() -> None:
    found = of(":p rdfs:subPropertyOf :q . :q owl:equivalentProperty :r . :p rdfs:subClassOf :X .")
    assert found.superproperties(iri("p")) == {iri("p"), iri("q"), iri("r")}
    assert found.superclasses(iri("p")) == {iri("p"), iri("X")}


def test_what_has_no_name_is_left_out() -> None:
    assert of(":A rdfs:subClassOf [ a owl:Restriction ] .").flat
    assert of(":A owl:equivalentClass [ a owl:Restriction ] .").flat


@pytest.mark.parametrize(
    "text",
    [
        ":A rdfs:subClassOf [ rdfs:subClassOf :B ] .",
        ":A rdfs:subClassOf [ rdfs:subClassOf [ rdfs:subClassOf :C ] ] . :C rdfs:subClassOf :B .",
        ":A owl:equivalentClass _:x . :B owl:equivalentClass _:x .",
        ":A rdfs:subClassOf [ rdfs:subClassOf _:x ] . _:x owl:equivalentClass _:y . _:y rdfs:subClassOf :B .",
        ":A rdfs:subClassOf _:x . _:y rdfs:subClassOf _:x ; owl:equivalentClass _:x ; rdfs:subClassOf :B , 5 .",
    ],
)
@pytest.mark.parametrize("mode", [Reasoning.SUBCLASS, Reasoning.OWL_RL])
def test_a_class_lies_below_what_lies_above_a_class_without_a_name(text: str, mode: Reasoning) -> None:
    found = of(text, mode)
    assert found.matches(iri("A"), iri("B"))
    assert all(isinstance(above, IRI) for above in found.superclasses(iri("A")))


@pytest.mark.parametrize("mode", [Reasoning.SUBCLASS, Reasoning.OWL_RL])
def test_owl_thing_lies_above_the_classes_of_which_an_ontology_says_so(mode: Reasoning) -> None:
    thing = IRI("http://www.w3.org/2002/07/owl#Thing")
    text = ":A rdfs:subClassOf :B . :B rdfs:subClassOf owl:Thing . :C a owl:Class ; rdfs:subClassOf rdfs:Resource ."
    found = of(text, mode)
    assert found.superclasses(iri("A")) == {iri("A"), iri("B"), thing}
    assert found.superclasses(iri("C")) == {iri("C"), RDFS.Resource}
    assert of(":A a owl:Class . :B a owl:Class .", mode).superclasses(iri("A")) == {iri("A")}


def test_the_rules_of_owl_rl_look_up_no_term_each_time_that_they_mention_it(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_up, look_up = list[str](), DefinedNamespaceMeta.__getattr__

    def noting(namespace: DefinedNamespaceMeta, name: str) -> Any:
        looked_up.append(name)
        return look_up(namespace, name)

    of(":A rdfs:subClassOf :B .", Reasoning.OWL_RL)  # which loads owlrl, and looks up each term once
    monkeypatch.setattr(DefinedNamespaceMeta, "__getattr__", noting)
    classes = "".join(f":c{n} rdfs:subClassOf :c{n + 1} .\n" for n in range(20))
    of(classes, Reasoning.OWL_RL)
    assert len(looked_up) < 1000


def test_owl_rl_infers_what_subclass_mode_does_not() -> None:
    text = ":A owl:unionOf ( :B :C ) . :A a owl:Class ."
    assert not of(text).matches(iri("B"), iri("A"))
    assert of(text, Reasoning.OWL_RL).matches(iri("B"), iri("A"))


@pytest.mark.parametrize(
    "text",
    [
        ":A owl:intersectionOf ( :B :C [ a owl:Restriction ] ) .",
        ":A owl:equivalentClass [ owl:intersectionOf ( :B :C ) ] .",
        "[ owl:intersectionOf ( :B :C ) ] owl:equivalentClass :A .",
        ":A rdfs:subClassOf [ a owl:Class ; owl:intersectionOf ( [ a owl:Restriction ] :B :C ) ] .",
    ],
)
@pytest.mark.parametrize("mode", [Reasoning.SUBCLASS, Reasoning.OWL_RL])
def test_a_class_lies_below_the_named_classes_that_it_is_an_intersection_of(text: str, mode: Reasoning) -> None:
    found = of(f"{text} :A a owl:Class .", mode)
    assert found.superclasses(iri("A")) == {iri("A"), iri("B"), iri("C")}
    assert not found.matches(iri("B"), iri("A"))


@pytest.mark.parametrize(
    "text",
    [
        ":A owl:disjointWith [ owl:intersectionOf ( :B :C ) ] .",
        "[ owl:intersectionOf ( :B :C ) ] rdfs:subClassOf :A .",
    ],
)
def test_a_class_that_does_not_lie_below_an_intersection_does_not_lie_below_its_members(text: str) -> None:
    assert of(text).superclasses(iri("A")) == {iri("A")}


def test_owl_rl_says_no_less_than_subclass_mode_and_hands_out_no_values() -> None:
    text = ":A rdfs:subClassOf :B . :B rdfs:subClassOf :C . :x :p 1 . :y :p 1.0 ."
    assert of(text, Reasoning.OWL_RL).superclasses(iri("A")) >= of(text).superclasses(iri("A"))


def test_the_ontologies_that_ship_put_a_person_tracker_below_a_position_sensor() -> None:
    documents = [turtle.parse(path.read_bytes(), str(path)) for path in library.ontologies()]
    found = hierarchy(documents, Reasoning.SUBCLASS)
    assert found.matches(ROB.PersonTracker, ROB.PositionSensor)
    assert not found.matches(ROB.PositionSensor, ROB.PersonTracker)


edges = st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=16)


@given(edges)
def test_the_closure_is_reflexive_and_transitive_and_no_more(pairs: list[tuple[int, int]]) -> None:
    found = of(" ".join(f":c{low} rdfs:subClassOf :c{high} ." for low, high in pairs))
    reach = {number: {number} for number in range(8)}
    for _ in range(8):
        for low, high in pairs:
            reach[low] |= reach[high]
    for number in range(8):
        assert found.superclasses(iri(f"c{number}")) == {iri(f"c{other}") for other in reach[number]}
