"""What documents are made of."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.document_texts import is_turtle
from tests.lab import PREFIXES


@pytest.mark.parametrize(
    ("source", "turtle"),
    [
        (PREFIXES + ":lamp a sc:Component, :Lamp .\n", True),
        ("@prefix : <urn:x:> . :a :b :c .", True),
        ("PREFIX : <urn:x:> :a :b :c .", True),
        ("  @base <urn:x:> .", True),
        ("<urn:a> <urn:b>\n<urn:c> .", True),
        ("examples/clock", False),
        ("prefixes.ttl", False),
        ("a file with blanks.ttl", False),
        (Path("@prefix"), False),
    ],
)
def test_a_string_is_turtle_or_a_path(source: object, turtle: bool) -> None:
    assert is_turtle(source) is turtle
