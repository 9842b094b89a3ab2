"""What inputs accept is validated at the statement that is at fault."""

from __future__ import annotations

import pytest

from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.validation.input_shapes import unaccepted_shapes
from tests.lab import PREFIXES


@pytest.mark.parametrize(
    ("shape", "found"),
    [
        ("[ sh:property [ sh:path sc:unit ; sh:minCount 1 ] ]", []),
        ("[ sh:targetNode :a ]", ["1:45"]),
        ('[ sh:property [ sh:path :p ; sh:pattern "(" ] ]', ["1:69"]),
        ("[ sh:property [ sh:path :p ; sh:pattern 'a{99999999999}' ] ]", ["1:69"]),
        ("[ sh:property [ sh:path :p ; sh:pattern 3 ] ]", ["1:69"]),
        ("[ sh:minCount 1 ]", ["1:43"]),
        ("[ sh:or ( ) ]", ["1:37"]),
        ("[ sh:property [ sh:path :p ; sh:maxCount 2 , 3 ] ]", ["1:74"]),
        ("[ ]", ["1:29"]),
    ],
)
def test_a_shape_is_blamed_where_it_is_at_fault(shape: str, found: list[str]) -> None:
    text = f":x sc:hasInput [ sc:accepts {shape} ] .\n"
    lines = PREFIXES.count("\n")
    diagnostics = unaccepted_shapes(*parse_with_positions(PREFIXES + text, "x.ttl", "file:///"))
    assert [f"{one.line - lines}:{one.column}" for one in diagnostics] == found
