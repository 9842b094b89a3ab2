"""An error about a template leads to the statement that it is about, by way of what has an IRI."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from selfconf.errors import TemplateError
from selfconf.rdf.tasks.mistakes import placed
from selfconf.rdf.tasks.templates import read_task
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES
from tests.rdf.tasks.test_templates import wrong_about_templates

OTHERWHERE = {
    "cell-two-rests": "the reader sees the roles of both lists, and names a second role",
    "cell-two-roles": "the reader speaks of the list, validation of its cell",
    "cell-without-role": "the reader speaks of the list, validation of its cell",
    "roles-without-end": "the reader speaks of the list, validation of its cell",
}
"""Files in which the reader speaks of another place than validation does, and why."""


def mistake(text: str, name: str = "t.ttl") -> TemplateError:
    """What is wrong with a text, with its place."""
    with pytest.raises(TemplateError) as caught:
        read_task(parse(text, name))
    assert caught.value.line is None
    return placed(caught.value, text, "file:///t.ttl")


def place(text: str, at: str) -> tuple[int, int]:
    """The line and column of a mark in a text."""
    before = text[: text.index(at)]
    return before.count("\n") + 1, len(before) - before.rfind("\n")


ROLES = ":t a sc:Template ; sc:roles ( :r :s ) . :s a sc:Role .\n"


@pytest.mark.parametrize(
    ("text", "at"),
    [
        (ROLES + ":r a sc:Role ; sc:minCount -1 ; sc:maxCount -2 .", "-1"),
        (ROLES + ":r a sc:Role ; sh:class 5 ; sh:property [ sh:path rob:place ; sh:minInclusive :x ] .", "5 ;"),
        (ROLES + ":r a sc:Role ; sh:class :A ; sh:property [ sh:path rob:place ; sh:minInclusive :x ] .", ":x ]"),
        (ROLES + ":r a sc:Role ; sh:property [ sh:path :a ] , [ sh:path :b ; sh:pattern '(' ] .", "'('"),
        (ROLES + ":r a sc:Role . [] a sc:Interaction ; sc:from :r ; sc:to :s , :r .", ":r ."),
        (
            ROLES + ":r a sc:Role . [ sc:from :r ; sc:to :s ] a sc:Interaction . [] a sc:Interaction ; sc:from :r .",
            "[]",
        ),
        (ROLES + ":r a sc:Role ; sc:sets [ sc:parameterType :P ; sc:value 1 ] , [ sc:parameterType 'P' ] .", "'P'"),
        (ROLES + ":r a sc:Role . :t sc:cost ( [ sc:term [ sc:property :p ] , [ sc:property 5 ] ] ) .", "5 ]"),
        (ROLES + ":r a sc:Role . :t sc:cost ( [ sc:term [ sc:property :p ] ] [] ) .", "[] )"),
    ],
)
def test_the_place_of_a_mistake_is_that_of_the_value_at_fault(text: str, at: str) -> None:
    found = mistake(PREFIXES + text)
    assert (found.line, found.column) == place(PREFIXES + text, at)


@pytest.mark.parametrize("path", wrong_about_templates(), ids=lambda path: path.stem)
def test_the_place_of_a_mistake_is_one_that_validation_names(path: Path) -> None:
    text = path.read_text("utf-8")
    found = mistake(text, path.name)
    named = re.findall(r"(\d+):(\d+) error", text)
    elsewhere = "is not in this file" in str(found)  # a mistake that validation does not know
    if path.stem not in OTHERWHERE and not elsewhere and (found.subject or found.steps):
        assert (found.line, found.column) in {(int(line), int(column)) for line, column in named}


def test_what_comes_from_no_named_node_has_no_place() -> None:
    error = TemplateError("no template in it", file="t.ttl")
    assert placed(error, PREFIXES, "file:///t.ttl") is error
    text = (
        PREFIXES
        + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role . _:a :p _:b . _:b :p _:a ; sc:from :r ; sc:to :r ."
    )
    assert mistake(text).line is None
