"""What to try when a text is not Turtle is said by all that read it, in the same words."""

from __future__ import annotations

import pytest

from selfconf.errors import TurtleError
from selfconf.rdf import turtle
from selfconf.rdf.validation.checking import SourceText, validate_texts

SLIPS = [
    ("<urn:a> a <urn:my home> .", "In an IRI a blank is written %20."),
    ("<urn:a> a rob:Tuner .", "Write @prefix rob: <https://w3id.org/selfconf/robotics#> . at the head of the file."),
    ("<urn:a> <urn:p> 'x' <urn:q> 'y' .", "Perhaps a semicolon is missing before this, or a dot behind @prefix."),
    ("@prefix : <urn:x>\n<urn:a> a :b .", "Perhaps a semicolon is missing before this, or a dot behind @prefix."),
    ("@prefix : <urn:x> .\n<urn:a>\n:p { :q 1 } .", "Brackets are square: [ ... ]."),
    ("@prefix : urn:x .", "An IRI stands in angle brackets: <https:...>."),
    (r"<urn:a> <urn:p> 'C:\prog' .", r"A backslash in a string is written \\."),
    ("<urn:a> a <urn:b>", "Perhaps the dot after the last statement is missing."),
    ("<urn:a> <urn:p> 'x .", "Perhaps a closing quotation mark or a > is missing."),
    ("<urn:a> <urn:p> True .", "Truth values are written true and false."),
    ("<urn:a> <urn:p> Lamp .", 'A name has a prefix, as in :lamp; a text stands in quotation marks, as in "lamp".'),
    ("<urn:a> <urn:p> ?room .", "Variables belong to SPARQL; a parameter stands as its IRI, such as :room."),
    (
        "<urn:a> <urn:p> 2026-01-02 .",
        "A literal is no subject. Between values stand commas, and around a date quotation marks.",
    ),
    ("<urn:a> <urn:p> http://example.org/ .", "An IRI stands in angle brackets: <http:...>."),
    ("<urn:a> <urn:p> ( 1 ] .", "Perhaps an object or the closing ) is missing before this."),
    ("<urn:a> <urn:p> 1 ) .", "Perhaps it is too many, or what it closes is not opened."),
    ("PREFIX : <urn:x> . <urn:a> a :b .", "Perhaps a dot is too many; behind PREFIX, unlike @prefix, there is none."),
    ("<urn:a> <urn:p>\u00a01 .", "This is a special blank, such as the no-break space; write a plain one."),
    ("<urn:a> <urn:p> \u22121 .", "A minus is written -."),
    ("<urn:a> <urn:p> 'x'@de^^<urn:d> .", "A text has a language or a datatype, not both."),
    ("<urn:a> <urn:p> 'x'@ .", 'Behind @ stands a language, as in "Tor"@de.'),
    (
        "<urn:a> <urn:p> 'x'^^<http://www.w3.org/1999/02/22-rdf-syntax-ns#langString> .",
        'Write the language in place of the datatype, as in "Tor"@de.',
    ),
    (
        "<urn:a> <urn:p> 'x'@de_DE .",
        'A blank node is written _:name, and a language that has two parts with a hyphen, as in "Tor"@de-AT.',
    ),
    ("// <urn:a> a <urn:b> .", r"A comment begins with #; in a name behind a prefix / is written \/."),
]


@pytest.mark.parametrize(("text", "said"), SLIPS)
def test_a_text_that_is_not_turtle_is_refused_with_what_to_try(text: str, said: str) -> None:
    for read in (lambda: turtle.parse(text, "a.ttl"), lambda: turtle.read_ontology(text.encode(), "a.ttl")):
        with pytest.raises(TurtleError) as caught:
            read()
        assert str(caught.value).endswith(f". {said}")


@pytest.mark.parametrize(("text", "said"), SLIPS)
def test_validation_says_the_same(text: str, said: str) -> None:
    first, *_ = validate_texts([SourceText("a.ttl", text.encode())], [], []).diagnostics
    assert first.hint == said


def test_an_undeclared_prefix_is_found_in_the_message_of_the_parser() -> None:
    assert turtle.undeclared_prefix("The prefix rob: has not been declared") == "rob"
    assert turtle.undeclared_prefix("Invalid IRI code point ' '") is None


def test_of_what_nothing_is_known_nothing_is_said() -> None:
    assert turtle.advice("something else") is None
    with pytest.raises(TurtleError, match=r"not Turtle: Invalid IRI code point '<'$"):
        turtle.parse("<urn:a> a <urn:b<> .", "a.ttl")
