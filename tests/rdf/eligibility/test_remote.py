"""What an endpoint is asked so that it hands out the components that roles could want."""

from __future__ import annotations

import pyoxigraph as ox
import pytest

from selfconf.model.term import IRI
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.eligibility.remote import ANY_COMPONENT, TYPES, prefaced, statements
from tests.lab import PREFIXES, iri

STORE = ox.Store()
STORE.load(
    (PREFIXES + ":a a sc:Component, :A ; :size [ :of [ :unit :m ] ] . :b a sc:Component, :B .").encode(),
    format=ox.RdfFormat.TURTLE,
)


def test_the_statements_of_components_of_some_types_are_asked_for_through_blank_nodes() -> None:
    found = {triple.predicate.value for triple in STORE.query(statements([iri("A")]))}
    assert {iri("size"), iri("of"), iri("unit")} <= {IRI(predicate) for predicate in found}
    subjects = {triple.subject for triple in STORE.query(statements([iri("B")]))}
    assert subjects == {ox.NamedNode(iri("b"))}


def test_the_shape_that_an_input_accepts_is_handed_out_whole_however_deep_it_is() -> None:
    text = """:a a sc:Component, :A ; sc:hasInput [ sc:name "i" ; sc:signalType :S ;
        sc:accepts [ sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :on ) ; sh:in ( :x :y ) ] ] ] ."""
    store = ox.Store()
    store.load((PREFIXES + text).encode(), format=ox.RdfFormat.TURTLE)
    handed_out = ox.serialize(store.query(statements([iri("A")])), format=ox.RdfFormat.TURTLE)
    (one,), (other,) = (read_advertisements(source, "a")[0] for source in (handed_out, (PREFIXES + text).encode()))
    assert one.profile.inputs == other.profile.inputs
    assert one.profile.inputs[0].condition is not None


@pytest.mark.parametrize("members", ["", "1", "1 2", "1 2 3 4 5"])
def test_a_list_of_any_length_is_handed_out_whole(members: str) -> None:
    text = f"{PREFIXES} :a a sc:Component, :A ; :sizes ( {members} ) ."
    store = ox.Store()
    store.load(text.encode(), format=ox.RdfFormat.TURTLE)
    handed_out = set(store.query(statements([iri("A")])))
    assert len(handed_out) == len(set(store))


def test_an_endpoint_tells_whether_it_has_components_and_of_which_types() -> None:
    assert STORE.query(ANY_COMPONENT)
    assert {str(row[0].value) for row in STORE.query(TYPES)} >= {iri("A"), iri("B")}


def test_a_query_gets_the_prefixes_that_it_uses_and_does_not_declare() -> None:
    assert prefaced("SELECT * { ?c a sc:Component }").startswith("PREFIX sc: <https://w3id.org/selfconf#> SELECT")
    own = "PREFIX sc: <urn:x#> SELECT * { ?c a sc:Component }"
    assert prefaced(own) == own
