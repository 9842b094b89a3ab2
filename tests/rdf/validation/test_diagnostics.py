"""From an offset in a text to a diagnostic."""

from __future__ import annotations

from selfconf.model.diagnostic import Severity
from selfconf.rdf.positions import Positions
from selfconf.rdf.validation.diagnostics import at


def test_a_diagnostic_has_line_column_and_width_of_the_token_at_its_offset() -> None:
    text = "@prefix : <urn:x#> .\n:a :b :lamp .\n"
    found = at(Positions("a.ttl", text), text.index(":lamp"), "SC-L02", "message")
    assert (found.line, found.column, found.width, found.source) == (2, 7, 5, ":a :b :lamp .")


def test_a_diagnostic_is_as_severe_as_its_code_unless_it_is_said_otherwise() -> None:
    positions = Positions("a.ttl", ":a")
    assert at(positions, 0, "SC-S01", "m").severity is Severity.ERROR
    assert at(positions, 0, "SC-S01", "m", Severity.WARNING).severity is Severity.WARNING
