"""From an offset in a text to a diagnostic."""

from __future__ import annotations

from selfconf.model.codes import BY_CODE
from selfconf.model.diagnostic import Diagnostic, Severity, excerpt, shortened
from selfconf.rdf.positions import Positions


def at(
    positions: Positions,
    offset: int,
    code: str,
    message: str,
    severity: Severity | None = None,
    hint: str | None = None,
    shape: str | None = None,
) -> Diagnostic:
    """A diagnostic at an offset; as severe as its code usually is, unless it is said otherwise."""
    place = positions.place(offset)
    return Diagnostic(
        positions.file,
        place.line,
        place.column,
        code,
        shortened(message),
        severity or BY_CODE[code].severity,
        positions.width(place),
        hint and shortened(hint),
        shape,
        *excerpt(positions.text, *positions.bounds(place.line), place.column),
    )
