"""Names that stay."""

from __future__ import annotations

import pytest

from selfconf.importing.naming import DistinctNames, absolute, slug, stem
from selfconf.importing.sources import SourceDocument
from selfconf.model.term import IRI


@pytest.mark.parametrize("text", ["lamp", "urn:", "a b:c", "urn:x y", "urn:<x>", "urn:x\n", "urn:%", "http://[/"])
def test_what_is_no_absolute_iri(text: str) -> None:
    assert absolute(text) is None


@pytest.mark.parametrize("text", ["urn:dev:lamp", "http://example.org/ü#x", "file:/Data.owl;#PlanarVel"])
def test_what_is_an_absolute_iri(text: str) -> None:
    assert absolute(text) == IRI(text)


@pytest.mark.parametrize(
    ("text", "name"), [("My Lamp!", "My-Lamp"), ("../x", "x"), ("", "unnamed"), ("...", "unnamed")]
)
def test_a_slug_is_one_harmless_segment(text: str, name: str) -> None:
    assert slug(text) == name


@pytest.mark.parametrize(
    ("name", "expected"),
    [("kitchen/lamp.td.json", "kitchen/lamp.td"), ("a.nodl.xml", "a"), ("../../etc/x.json", "unnamed/unnamed/etc/x")],
)
def test_a_stem_keeps_the_path_without_the_ending(name: str, expected: str) -> None:
    assert stem(SourceDocument(name, name, b"")) == expected


def test_a_name_that_is_taken_gets_the_stem_of_its_source_and_then_a_number() -> None:
    names, lamp = DistinctNames(), IRI("urn:lamp")
    sources = [SourceDocument(name, name, b"") for name in ("a.json", "b/c.json", "b/c.json")]
    assert [names.component(lamp, source) for source in sources] == ["urn:lamp", "urn:lamp-b-c", "urn:lamp-b-c-2"]
    assert [(each.component, each.was) for each in names.renamed] == [("urn:lamp-b-c", lamp), ("urn:lamp-b-c-2", lamp)]


def test_files_whose_names_differ_in_case_only_are_told_apart() -> None:
    names = DistinctNames()
    assert [names.file(name) for name in ("Lamp", "lamp", "lamp", "LAMP")] == ["Lamp", "lamp-2", "lamp-3", "LAMP-4"]
