"""What `docs/protocol.md` shows is what the codec reads and writes."""

from __future__ import annotations

import json
import re
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from selfconf.protocol.codec import KINDS, decode, encode

PAGE = Path(__file__).parents[2] / "docs" / "protocol.md"
MESSAGES = {kind: message for message, kind in KINDS.items()}


def examples() -> list[str]:
    """Every message of the page, with a value for each placeholder."""
    text = PAGE.read_text().replace('"IRI"', "IRI")
    found = re.findall(r'`(\{"kind".*?\})`|^(\{"kind".*?\})$', text, re.DOTALL | re.MULTILINE)
    return [re.sub(r"\b(IRI|KEY)\b", '"x"', one or other) for one, other in found]


@pytest.mark.parametrize("example", examples())
def test_a_message_of_the_page_is_read_and_written_as_it_stands(example: str) -> None:
    body = json.loads(example)
    message = decode(example.encode(), MESSAGES[body["kind"]])
    assert json.loads(encode(message)).items() >= body.items()


def test_the_page_shows_a_message_of_every_kind() -> None:
    assert {json.loads(example)["kind"] for example in examples()} == set(MESSAGES)


def test_the_page_names_every_member_of_every_message() -> None:
    text, shown = PAGE.read_text("utf-8"), [json.loads(example) for example in examples()]
    for message, kind in KINDS.items():
        members = {name for body in shown if body["kind"] == kind for name in body}
        unshown = {field.name for field in fields(message)} - members
        assert {name for name in unshown if not re.search(rf'`{name}`|`"{name}": ', text)} == set(), kind


def test_the_page_says_which_members_a_message_must_have() -> None:
    table = PAGE.read_text("utf-8").partition("| message | must have |")[2].partition("\n\n")[0]
    rows = re.findall(r"^\| (`\w+`(?:, `\w+`)*) \| (.*?)(?:;.*)? \|$", table, re.MULTILINE)
    said = {kind: set(re.findall(r"`(\w+)`", members)) for kinds, members in rows for kind in re.findall(r"\w+", kinds)}
    must = {
        kind: {f.name for f in fields(message) if f.default is MISSING and f.default_factory is MISSING}
        for message, kind in KINDS.items()
    }
    assert {kind: said.get(kind) for kind in must} == must
