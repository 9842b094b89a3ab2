"""What an advertisement is: what it takes along of a document, and when it says the same as another one."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.advertisements.advertisement import about, allowed, property_order
from selfconf.rdf.advertisements.reader import read_document
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, TYPE, XSD
from tests.lab import PREFIXES, iri

LAMP = ":lamp a sc:Component, :Lamp ; rob:place :hall ."


def said(text: str) -> set[tuple[Term, IRI, Term]]:
    """What the advertisement of `:lamp` takes along of a text that has `:bell` for another component."""
    return set(about(parse(PREFIXES + text, "a.ttl"), iri("lamp"), frozenset((iri("lamp"), iri("bell")))))


def one(text: str) -> Advertisement:
    """The only advertisement of a text."""
    (found,), _ = read_document(parse(PREFIXES + text, "a.ttl"))
    return found


def test_what_is_said_of_a_named_thing_is_taken_along() -> None:
    assert (iri("hall"), ROB.floor, Literal("2", XSD.integer)) in said(f"{LAMP} :hall rob:floor 2 .")


def test_what_is_said_of_another_component_or_of_a_type_is_left_out() -> None:
    text = f"{LAMP} :lamp :beside :bell . :bell rob:place :hall . :Lamp rob:place :shop ."
    assert {subject for subject, _, _ in said(text)} == {iri("lamp")}


def test_things_that_mention_each_other_are_told_of_once() -> None:
    assert len(said(f"{LAMP} :hall rob:beside :yard . :yard rob:beside :hall .")) == 5


@pytest.mark.parametrize(
    ("predicate", "value"),
    [
        (RDFS.subClassOf, iri("Light")),
        (RDFS.domain, iri("Light")),
        (OWL.sameAs, iri("bell")),
        (SH.property, iri("shape")),
        (TYPE, OWL.Class),
        (TYPE, RDFS.Class),
        (TYPE, SH.NodeShape),
        (TYPE, RDF.Property),
    ],
)
def test_axioms_and_shapes_are_not_allowed(predicate: IRI, value: IRI) -> None:
    assert not allowed(predicate, value)


@pytest.mark.parametrize(
    ("predicate", "value"), [(TYPE, iri("Lamp")), (RDFS.label, Literal("lamp")), (RDFS.seeAlso, OWL.Class)]
)
def test_types_of_its_own_and_labels_are_allowed(predicate: IRI, value: Term) -> None:
    assert allowed(predicate, value)


def test_two_advertisements_that_say_the_same_are_equal_and_count_once() -> None:
    first, second = one(LAMP), one(LAMP)
    assert first is not second
    assert len({first, second}) == 1
    assert first != one(f"{LAMP} :lamp sc:preference 1 .")
    assert first != "lamp"


def test_one_that_speaks_of_a_named_thing_besides_its_component_is_not_self_contained() -> None:
    assert one(LAMP).self_contained
    assert one(f'{LAMP} :lamp sc:hasInput [ sc:name "a" ; sc:signalType :S ] .').self_contained
    assert not one(f"{LAMP} :hall rob:floor 2 .").self_contained


def test_its_breadth_is_how_often_its_most_frequent_property_is_there() -> None:
    assert one(f"{LAMP} :lamp :shines :red, :green, :blue .").breadth == 3


def test_properties_are_ordered_by_predicate_and_then_by_value() -> None:
    pairs: list[tuple[IRI, Term]] = [(iri("p"), Literal("b")), (iri("p"), Literal("a")), (iri("o"), Literal("z"))]
    assert sorted(pairs, key=property_order) == [pairs[2], pairs[1], pairs[0]]


def test_it_is_shown_by_the_name_of_its_component() -> None:
    assert repr(one(LAMP)) == f"<advertisement of {iri('lamp')}>"
    assert SC.Component in one(LAMP).types
