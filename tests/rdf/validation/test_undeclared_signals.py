"""Signal types that no ontology declares: one warning for each namespace of a run, where it is first used."""

from __future__ import annotations

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.term_index import TermIndex, index_of
from selfconf.rdf.validation.undeclared_signals import undeclared_signals
from tests.lab import PREFIXES

HEAD = PREFIXES.count("\n")
OTHER = "@prefix other: <https://example.org/other#> .\n"
DECLARED = PREFIXES + "@prefix owl: <http://www.w3.org/2002/07/owl#> . :Sound a owl:Class ; rdfs:subClassOf sc:Signal ."


def component(name: str, *signals: str) -> str:
    """A component with an input for each signal type, on a line each."""
    ports = " ,\n".join(f'[ sc:name "i{number}" ; sc:signalType {signal} ]' for number, signal in enumerate(signals))
    return f":{name} a sc:Component, :Lamp ; sc:hasInput\n{ports} .\n"


def told(*texts: str, index: TermIndex | None = None) -> list[Diagnostic]:
    """The warnings about some files of the names 0.ttl, 1.ttl and so on."""
    files = [(f"{number}.ttl", (PREFIXES + OTHER + text).encode()) for number, text in enumerate(texts)]
    seen = {name: prefilter(octets) for name, octets in files}
    return list(undeclared_signals(files, seen, index or index_of([])))


def test_a_type_of_an_unknown_namespace_is_told_where_it_is_first_used() -> None:
    (only,) = told(component("a", "sc:Signal", ":Sound", ":Sound"))
    assert (only.code, only.file, only.line - HEAD) == ("SC-L03", "0.ttl", 4)
    assert only.message == "No loaded ontology declares the signal type <https://example.org/peis-home#Sound>."
    assert "ontologies=" in (only.hint or "")


def test_a_blank_node_is_no_type_that_an_ontology_could_declare() -> None:
    assert not told(component("a", "[ a :Sound ]", "( sc:Signal sc:Signal )"))


def test_several_types_of_one_namespace_are_counted_in_one_warning() -> None:
    (only,) = told(component("a", ":Sound", ":Light"))
    assert only.message.endswith("<https://example.org/peis-home#>: this file uses 2 of them.")


def test_a_namespace_is_told_once_in_a_run_and_another_one_again() -> None:
    found = told(component("a", ":Sound"), component("b", ":Light"), component("c", ":Sound", "other:Smell"))
    assert [(each.file, each.message.partition("<")[2]) for each in found] == [
        ("0.ttl", "https://example.org/peis-home#Sound>."),
        ("2.ttl", "https://example.org/other#Smell>."),
    ]


def test_a_type_that_an_ontology_declares_is_not_told() -> None:
    assert told(component("a", ":Sound"), index=index_of([prefilter(DECLARED.encode())])) == []


def test_a_type_of_that_name_in_another_namespace_is_proposed() -> None:
    index = index_of([prefilter(DECLARED.encode())])
    (only,) = told(component("a", "other:Light", "other:Sound"), index=index)
    assert (only.hint or "").startswith("Did you mean <https://example.org/peis-home#Sound>? If not, give the ontology")
    (only,) = told(component("a", "other:Light"), index=index)
    assert (only.hint or "").startswith("Give the ontology")


def test_a_file_that_the_prefilter_has_not_seen_is_passed_over() -> None:
    files = [("a.ttl", (PREFIXES + component("a", ":Sound")).encode())]
    assert list(undeclared_signals(files, {}, TermIndex())) == []
