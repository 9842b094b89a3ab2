"""What travels when an operation is called: a request and its answer, each as a signal with the stamp of its sender.

The request stands behind the stamp of the caller: the text of the stamp, a line feed, the payload. The answer has its
stamp beside it, as every signal has.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterable, Mapping
from typing import Any

from selfconf.errors import PeerError
from selfconf.model.immutable import immutable
from selfconf.model.profile import CALL_MARK, Input, Output
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI
from selfconf.protocol.stamps import PLAIN, StampReader, StampWriter
from selfconf.sdk.component import Signal
from selfconf.sdk.payloads import UnsayableError, as_bytes, as_json, read_payload

MOST_PAYLOAD = 1 << 20
"""The most bytes that a request may have, and an answer."""
MOST_CALLS = 64
"""How many requests wait for the code of a component at most, and how many calls of one for their answers."""
LONGEST_PATIENCE = 1e6
"""For how many seconds a caller can say that it waits: more than eleven days."""
_END_OF_STAMP = b"\n"


class NotOfItsTypeError(UnsayableError):
    """A value that is not what its type says."""


@immutable
class OperationFields:
    """The fields of what an operation takes and of what it answers, as far as their types have some."""

    request: SignalFields | None = None
    response: SignalFields | None = None


class OperationSignals:
    """What one component in one life sends as requests and as answers."""

    def __init__(self, component: IRI, life: str) -> None:
        self._stamp = StampWriter(component, life)
        self._sequence = itertools.count(1)

    def request(self, value: Any, fields: SignalFields | None, media: str) -> bytes:
        """A request that sends a value along. Raises UnsayableError for one that cannot be sent."""
        payload, stamp = self.write(value, fields, media)
        return stamp + _END_OF_STAMP + payload

    def write(self, value: Any, fields: SignalFields | None, media: str = "") -> tuple[bytes, bytes]:
        """The payload and the stamp of a value. Raises UnsayableError for one that cannot be sent."""
        packed = as_bytes(value, media)
        problem = None if fields is None else fields.problem_of_bytes() if packed else fields.problem(value)
        if problem is not None:
            raise NotOfItsTypeError(problem)
        payload, encoding = packed or (as_json(value), PLAIN)
        if len(payload) > MOST_PAYLOAD:
            raise UnsayableError(f"has {len(payload)} bytes, and {MOST_PAYLOAD} are allowed")
        return payload, self._stamp.write(next(self._sequence), time.time(), packed is not None, encoding)


def operation_fields(
    operations: Iterable[Input | Output], known: Mapping[IRI, SignalFields]
) -> dict[str, OperationFields]:
    """The fields of operations by their names, of which those of their kinds are known."""
    return {port.name.removesuffix(CALL_MARK): _fields(port, known) for port in operations}


def _fields(port: Input | Output, known: Mapping[IRI, SignalFields]) -> OperationFields:
    request, response = (None if one is None else known.get(one) for one in (port.request, port.response))
    return OperationFields(request, response)


def read_request(text: bytes) -> tuple[str, Signal]:
    """The life of the caller, and what it sends along. Raises PeerError and ValueError for what is no request."""
    stamp, _, payload = text.partition(_END_OF_STAMP)
    if len(payload) > MOST_PAYLOAD:
        raise PeerError(f"a request of {len(payload)} bytes is too large; {MOST_PAYLOAD} are allowed")
    return read_signal(stamp, payload)


def read_signal(attachment: bytes, payload: bytes) -> tuple[str, Signal]:
    """The life of what has sent a signal, and the signal. Raises PeerError and ValueError for what is none."""
    raw, stamp = StampReader().read(attachment)
    value = read_payload(payload, raw, stamp.encoding)
    return stamp.life, Signal(value, stamp.component, stamp.time, stamp.sequence, stamp.encoding.media)
