"""IRIs for people: shortened by prefixes, and never to something that reads as another IRI."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from selfconf.rdf.turtle import parse
from selfconf.render import Names, ecology_names, short

PREFIXES = {"": "https://example.org/home#", "ex": "https://example.org/", "xsd": XSD_NAMESPACE, "u": "urn:"}
NAMES = Names(PREFIXES)


@pytest.mark.parametrize(
    ("iri", "shown"),
    [
        ("https://example.org/home#clock", ":clock"),
        ("https://example.org/clock", "ex:clock"),
        ("https://example.org/home/clock", "<https://example.org/home/clock>"),
        ("https://example.org/home#", "<https://example.org/home#>"),
        ("https://example.org/home#a b", "<https://example.org/home#a b>"),
        ("https://example.org/home#-x", "<https://example.org/home#-x>"),
        ("https://example.com/x", "<https://example.com/x>"),
        ("urn:xß-1.2", "u:xß-1.2"),
        ("urn:x.", "<urn:x.>"),
        ("https://example.org/home#камера", ":камера"),
        ("https://example.org/home#5µm", "<https://example.org/home#5µm>"),
    ],
)
def test_an_iri_is_shortened_by_the_longest_prefix_where_a_curie_can_say_it(iri: str, shown: str) -> None:
    assert NAMES(IRI.unchecked(iri)) == shown


@pytest.mark.parametrize("local", ["clock", "a.b", "a-b", "_x", "0", "xß", "x_1", "a..b", "камера"])
def test_a_curie_is_turtle_for_the_iri_that_it_was_made_of(local: str) -> None:
    iri = IRI(PREFIXES[""] + local)
    head = "".join(f"@prefix {name}: <{base}> .\n" for name, base in PREFIXES.items())
    ((_, _, found),) = parse(f"{head}<urn:a> <urn:b> {NAMES(iri)} .", "curie.ttl").triples()
    assert found == iri


def test_a_literal_is_written_as_turtle_writes_it() -> None:
    assert NAMES(Literal("5", IRI(XSD_NAMESPACE + "integer"))) == "5"
    assert NAMES(Literal("5", IRI(XSD_NAMESPACE + "byte"))) == '"5"^^xsd:byte'
    assert NAMES(Literal('say "x"')) == '"say \\"x\\""'
    assert NAMES(BlankNode("_:b")) == "_:b"


def test_without_prefixes_the_local_name_has_to_do() -> None:
    assert short(IRI("https://example.org/home#clock")) == "clock"
    assert short(Literal("5", IRI(XSD_NAMESPACE + "byte"))) == '"5"^^byte'
    assert short(BlankNode("_:b")) == "_:b"
    assert Names({})(IRI("urn:x")) == "<urn:x>"


def test_the_empty_prefix_stands_for_the_namespace_that_most_iris_of_an_ecology_have() -> None:
    home, lab = "https://example.org/home#", "https://example.org/lab/"
    names, note = ecology_names({"rob": "urn:rob:"}, [f"{lab}a", f"{home}b", f"{home}c"])
    assert (names(IRI(f"{home}b")), names(IRI(f"{lab}a")), note) == (":b", f"<{lab}a>", f": is <{home}>")
    assert ecology_names({"rob": "urn:rob:"}, [])[1] == ""
    assert ecology_names({"h": home}, [f"{home}b"])[1] == ""


def test_a_word_means_an_iri_in_each_of_its_forms() -> None:
    iri = IRI("https://example.org/home#clock")
    for word in (iri, f"<{iri}>", "clock", ":clock"):
        assert NAMES.means(word, iri), word
    for word in ("Clock", "ex:clock", "<clock>", "", None):
        assert not NAMES.means(word, iri), word
