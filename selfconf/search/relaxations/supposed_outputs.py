"""Outputs of components that are yet to be added, as a trial supposes them.

What an author makes of "issues S as the sc:accepts of its input asks" conforms to that shape, and states whatever the
shape asks for: a unit, say, that is not known here. So it feeds inputs that ask for the signal or for the shape, and
none that asks for a unit or a frame of its own, unless the output is to state that one.
"""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.model.profile import Output
from selfconf.model.term import IRI

NOT_KNOWN = IRI("urn:selfconf:not-known")
"""A unit or frame that no input asks for."""


def supposed(outputs: Iterable[Output]) -> tuple[Output, ...]:
    """Return outputs that are to be added as they are tried: of what is to conform to a shape little else is known."""
    return tuple(map(_supposed, outputs))


def _supposed(output: Output) -> Output:
    if not output.conforms:
        return output
    unit = NOT_KNOWN if output.unit is None else output.unit
    return output._replace(unit=unit, frame=NOT_KNOWN if output.frame is None else output.frame)
