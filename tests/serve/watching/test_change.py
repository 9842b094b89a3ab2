"""A change knows whether it holds anything."""

from __future__ import annotations

from selfconf.serve.watching.change import EcologyChange


def test_a_change_of_anything_is_not_empty() -> None:
    assert EcologyChange().empty
    assert not EcologyChange(sites={"attic": None}).empty
    assert not EcologyChange(graphs={"urn:g": b""}).empty
    assert not EcologyChange(deployed={"urn:g": b""}).empty
