"""What goes with each signal."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.messages.texts import Label


@immutable
class SignalEncoding:
    """What the bytes of a signal are; empty for JSON, and for bytes of which nothing is said."""

    media: str = ""
    """The media type."""
    datatype: str = ""
    """The datatype of the elements of an array, such as `uint8`; empty for what is no array."""
    shape: tuple[int, ...] = ()
    """How many elements an array has in each of its dimensions."""


@immutable
class Stamp:
    """What goes with each signal: its source, in which life, its number there, its time in seconds, its encoding."""

    component: IRI
    life: Label
    sequence: int
    time: float
    encoding: SignalEncoding = SignalEncoding()
