"""Stamps as they travel with signals, written and read once for each signal, and therefore quickly.

The stamps of one source differ from each other in their ends alone, the number and the time. So a writer keeps the
text of what comes before, and a reader what that text says. A stamp of any other form, from a component in another
language, is read as every message is.
"""

from __future__ import annotations

import json
import math

import orjson

from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import SignalEncoding, Stamp

RAW = b"raw"
"""What stands before the stamp of a signal that is bytes and not JSON."""
_LAST = ("sequence", "time")
_MOST = 10**18
"""The number of a signal whose stamp is read quickly is below this."""
_JSON = json.JSONEncoder(separators=(",", ":"))
PLAIN = SignalEncoding()
"""The encoding of JSON, and of bytes of which nothing is said."""


class StampWriter:
    """Writes the stamps of the signals of one output in one life of its component."""

    def __init__(self, component: IRI, life: str) -> None:
        self._component, self._life = component, life
        self._of: tuple[bool, SignalEncoding] | None = None
        self._beginning = b""
        """The beginning of the stamps of such signals."""

    def write(self, sequence: int, time: float, raw: bool = False, encoding: SignalEncoding = PLAIN) -> bytes:
        """The stamp of a signal, as an attachment; `raw` if the signal is bytes and not JSON."""
        if (raw, encoding) != self._of:
            self._of = raw, encoding
            stamp = encode(Stamp(self._component, self._life, 0, 0.0, encoding))
            body = {name: member for name, member in json.loads(stamp).items() if name not in _LAST and member != {}}
            self._beginning = (RAW if raw else b"") + _JSON.encode(body).removesuffix("}").encode() + b","
        return self._beginning + orjson.dumps({"sequence": sequence, "time": float(time)})[1:]


class StampReader:
    """Reads the stamps of one source, on any thread."""

    def __init__(self) -> None:
        # No stamp begins with nothing, but what is no stamp may.
        self._known: tuple[bytes | None, bool, Stamp] = None, False, Stamp(IRI.unchecked(""), "", 0, 0.0)
        """The beginning of the stamp that was read last in full, and what stamps with it say, but for number and time;
        in one, as another thread may read meanwhile."""

    def read(self, attachment: bytes) -> tuple[bool, Stamp]:
        """Whether a signal is bytes and not JSON, and its stamp. Raises PeerError for what is no stamp."""
        beginning, _, end = attachment.partition(b',"sequence":')
        last = _number_and_time(end)
        known, raw, said = self._known
        if last is not None and beginning == known:
            number, time = last
            return raw, Stamp(said.component, said.life, number, time, said.encoding)
        raw = attachment.startswith(RAW)
        stamp = decode(attachment[len(RAW) :] if raw else attachment, Stamp)
        if last is not None:
            self._known = beginning, raw, stamp
        return raw, stamp


def _number_and_time(end: bytes) -> tuple[int, float] | None:
    """What the end of a stamp says, from the number on; None if it is not these two as a writer writes them."""
    try:
        last = orjson.loads(b'{"sequence":' + end)
    except orjson.JSONDecodeError:
        return None
    number, time = last["sequence"], last.get("time")
    plain = len(last) == 2 and type(number) is int and type(time) is float and 0 <= number < _MOST
    return (number, time) if plain and math.isfinite(time) else None
