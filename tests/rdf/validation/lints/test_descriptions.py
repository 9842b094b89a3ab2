"""Lints about what a file describes: twice, or by an IRI that depends on its place."""

from __future__ import annotations

from selfconf.model.codes import PREAMBLE
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.rdf.validation.lints.linted_text import ONTOLOGIES, SHAPES, TEMPLATE, only


def test_a_component_that_two_files_describe_is_noticed_in_the_second() -> None:
    texts = [SourceText(name, f"{PREAMBLE}:a a sc:Component, rob:Tuner .".encode()) for name in ("a.ttl", "b.ttl")]
    found = validate_texts(texts, SHAPES, ONTOLOGIES).diagnostics
    assert {(one.code, one.file) for one in found} == {("SC-L04", "b.ttl")}


def test_a_template_that_two_files_describe_alike_is_not_told() -> None:
    def codes(more: str) -> list[str]:
        texts = [SourceText(name, f"{PREAMBLE}{TEMPLATE}{text}".encode()) for name, text in (("a", ""), ("b", more))]
        return [one.code for one in validate_texts(texts, SHAPES, ONTOLOGIES).diagnostics]

    assert codes("") == []
    assert codes(":r sc:minCount 2 .") == ["SC-L31"]


def test_a_component_with_a_relative_iri_is_noticed() -> None:
    assert only("<tuner> a sc:Component, rob:Tuner .").code == "SC-L08"
