"""Which terms are known in one run."""

from __future__ import annotations

import pytest

from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.term_index import TermIndex, index_of, namespace, one_slip_apart, skeleton
from selfconf.rdf.vocabulary import SC
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


@pytest.mark.parametrize(
    ("one", "other", "near"),
    [
        ("robotics", "robotic", True),
        ("selfconf", "self-conf", True),
        ("selfconf", "selfcomf", True),
        ("selfconf", "slefconf", True),
        ("selfconf", "selfconf", True),
        ("selfconf", "selfcnfo", False),
        ("selfconf", "solvconf", False),
        ("self", "selfconf", False),
        ("shacl", "shex", False),
        ("owl", "prov", False),
    ],
)
def test_a_text_is_nearly_another_if_one_slip_is_between_them(one: str, other: str, near: bool) -> None:
    assert one_slip_apart(one, other) == one_slip_apart(other, one) == near


def test_a_namespace_of_others_is_confused_only_by_its_scheme_or_its_end() -> None:
    index = TermIndex(covered={SC.base, "https://example.org/home#"})
    assert index.confused("http://example.org/home/") == "https://example.org/home#"
    assert index.confused("https://example.org/home2#") is None
    assert index.confused("https://w3id.org/selfconv#") == SC.base
