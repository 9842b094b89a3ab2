"""Lints about hierarchies: circles, and classes in the place of properties."""

from __future__ import annotations

import pytest

from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.rdf.validation.lints.linted_text import HEAD, ONTOLOGIES, SHAPES, lints, only


def labelled(*terms: str, kind: str = "owl:Class") -> str:
    return "".join(f'{term} a {kind} ; rdfs:label "x" .\n' for term in terms)


CLASSES = labelled(":A", ":B", ":C")
PROPERTIES = labelled(":p", ":q", kind="owl:ObjectProperty")


def circles(text: str) -> list[Diagnostic]:
    return [found for found in lints(text) if found.code == "SC-L29"]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (":A rdfs:subClassOf :B . :B rdfs:subClassOf :A .", ":A and :B"),
        (":A rdfs:subClassOf :B . :B rdfs:subClassOf :C . :C rdfs:subClassOf :A .", ":A, :B and :C"),
        (":A rdfs:subClassOf :B . :B owl:equivalentClass :C . :C rdfs:subClassOf :A .", ":A, :B and :C"),
        (":A rdfs:subClassOf sc:Component . sc:Component rdfs:subClassOf :A .", ":A and sc:Component"),
        (":A rdfs:subClassOf rob:Image . rob:Signal rdfs:subClassOf :A .", ":A, rob:Image and rob:Signal"),
    ],
)
def test_a_circle_of_classes_is_reported_once_with_all_of_them(text: str, names: str) -> None:
    (found,) = circles(CLASSES + text)
    assert found.message.startswith(f"The classes {names} lie below each other")
    assert found.column == text.rindex("rdfs:subClassOf ") + len("rdfs:subClassOf ") + 1
    assert found.hint is not None
    assert "owl:equivalentClass" in found.hint


def test_a_circle_of_properties_is_reported() -> None:
    found = only(PROPERTIES + ":p rdfs:subPropertyOf :q . :q rdfs:subPropertyOf :p .")
    assert (found.code, found.hint) == ("SC-L29", "If that is meant, say so by owl:equivalentProperty.")


def test_two_circles_are_reported_apart() -> None:
    text = ":A rdfs:subClassOf :B . :B rdfs:subClassOf :A . :C rdfs:subClassOf :D . :D rdfs:subClassOf :C ."
    assert len(circles(CLASSES + labelled(":D") + text)) == 2


@pytest.mark.parametrize(
    "text",
    [
        ":A rdfs:subClassOf :A .",
        ":A rdfs:subClassOf :B , :C . :B rdfs:subClassOf :C .",
        ":A owl:equivalentClass :B .",
        ":A owl:equivalentClass :B . :A rdfs:subClassOf :B . :B rdfs:subClassOf :A .",
    ],
)
def test_what_is_no_circle_or_is_said_to_be_one_class_is_left_alone(text: str) -> None:
    assert not lints(CLASSES + text)


def test_a_circle_may_go_through_several_files() -> None:
    one = (PREAMBLE + labelled(":A") + ":A rdfs:subClassOf :B .").encode()
    two = (PREAMBLE + labelled(":B") + ":B rdfs:subClassOf :A .").encode()
    report = validate_texts([SourceText("one.ttl", one), SourceText("two.ttl", two)], SHAPES, ONTOLOGIES)
    assert [(found.file, found.line, found.code) for found in report.diagnostics] == [
        ("one.ttl", HEAD + 2, "SC-L29"),
        ("two.ttl", HEAD + 2, "SC-L29"),
    ]


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        (":p rdfs:subClassOf :q .", "rdfs:subClassOf stands between classes, and :p is", "rdfs:subPropertyOf"),
        (":A rdfs:subPropertyOf :B .", "rdfs:subPropertyOf stands between properties, and :A is", "rdfs:subClassOf"),
        (":new rdfs:subClassOf rob:place .", "rdfs:subClassOf stands between classes, and rob:place is", "rdfs:sub"),
        (":p owl:equivalentClass :q .", "owl:equivalentClass stands between classes, and :p", "owl:equivalentProp"),
        (":p rdfs:subPropertyOf rob:Lamp .", "rdfs:subPropertyOf stands between properties, and rob:Lamp is", None),
        (":A rdfs:subClassOf :p .", "rdfs:subClassOf stands between classes, and :p is a property.", None),
    ],
)
def test_a_class_is_no_property(text: str, message: str, hint: str | None) -> None:
    found = only(CLASSES + PROPERTIES + text)
    assert found.code == "SC-L30"
    assert found.message.startswith(message)
    assert hint in found.hint if hint is not None and found.hint is not None else found.hint is hint


def test_what_is_declared_as_both_may_stand_in_both_hierarchies() -> None:
    text = ":both a owl:Class, owl:ObjectProperty ; rdfs:label 'both' ; rdfs:subClassOf :A ; rdfs:subPropertyOf :p ."
    assert not lints(CLASSES + PROPERTIES + text)
