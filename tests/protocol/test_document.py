"""What `docs/protocol.md` shows is what the codec reads and writes."""

from __future__ import annotations

import json
import re
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
