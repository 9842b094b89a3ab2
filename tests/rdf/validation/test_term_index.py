"""Which terms are known in one run."""

from __future__ import annotations

from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.term_index import TermIndex, index_of, namespace, skeleton
from tests.lab import PREFIXES

HOME = "https://example.org/peis-home#"
OWN = PREFIXES + "@prefix owl: <http://www.w3.org/2002/07/owl#> . :Lamp a owl:Class ; rdfs:subClassOf :Light ."


def test_a_namespace_ends_at_the_last_hash_or_slash() -> None:
    assert namespace(HOME + "Lamp") == HOME
    assert namespace("urn:x") == ""
    assert skeleton("https://www.example.org/a#") == skeleton("http://example.org/a/")


def test_an_ontology_covers_the_namespaces_in_which_it_declares_something() -> None:
    index = index_of([prefilter(OWN.encode())])
    assert index.strange(HOME + "Lmap")
    assert not index.strange(HOME + "Lamp")
    assert not TermIndex().strange(HOME + "Lmap")
    assert index.serves(HOME + "Lamp", HOME + "Light")
    assert not index.serves(HOME + "Light", HOME + "Lamp")


def test_a_namespace_that_is_nearly_a_known_one_is_told() -> None:
    assert TermIndex().confused("http://w3id.org/selfconf/") == "https://w3id.org/selfconf#"
    assert TermIndex().confused("https://w3id.org/selfconf#") is None
