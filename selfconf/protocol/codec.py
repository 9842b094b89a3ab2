"""Messages as JSON, self-describing, so that a component in another language can join from the documentation alone.

A message is an object with a member `kind` and one member for each field, whose value is written and read by
`json_values`. What arrives is untrusted: anything that is not a message of the expected kind raises PeerError, and
nothing else. Members that are not known are passed over, so that a newer peer can add some.

Messages are written and read by orjson, as a failover waits for several of them. What it refuses, numbers beyond any
double and halves of surrogate pairs, the standard library writes and reads: the field that may not hold it says why.
What is no finite number it writes as `null`: a message has none to send.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from typing import Any, TypeVar, get_args

import orjson

from selfconf.errors import PeerError
from selfconf.protocol.json_values import (
    encode_term,
    json_notation,
    read_all_wants,
    read_callers,
    read_cause,
    read_encoding,
    read_inputs,
    read_iri,
    read_iris,
    read_label,
    read_labels,
    read_log_lines,
    read_losses,
    read_maybe_iri,
    read_moment,
    read_numbers,
    read_remark,
    read_sayable,
    read_task_identity,
    read_text,
    read_texts,
    read_truth,
    read_values,
    read_verdict,
    read_whole,
)
from selfconf.protocol.messages import (
    Access,
    Apply,
    CallAnswer,
    End,
    Fail,
    Free,
    Introduction,
    Known,
    LogPart,
    LogQuestion,
    Message,
    Moved,
    Notice,
    Page,
    RefusedAttempt,
    Release,
    Reserve,
    Stamp,
    StateOf,
    Status,
    TaskRecord,
    Wake,
)

M = TypeVar("M", bound=Message)
KINDS: dict[type, str] = {
    Reserve: "reserve",
    Apply: "apply",
    Release: "release",
    StateOf: "state",
    CallAnswer: "answer",
    Fail: "fail",
    Free: "free",
    Moved: "moved",
    Wake: "wake",
    End: "end",
    Introduction: "introduction",
    Access: "access",
    RefusedAttempt: "refused",
    Known: "known",
    LogQuestion: "lines",
    LogPart: "log",
    Notice: "notice",
    Page: "page",
    Stamp: "stamp",
    Status: "status",
    TaskRecord: "task",
}
"""What each message is called on the wire; programs in other languages rely on it, whatever a class is called here."""
LARGEST = 1 << 20
"""A control message of more bytes than this is refused unread."""
MOST_ADVERTISED = 20_000
"""For how many components one site can speak; what it says of more is left out."""


def encode(message: Message) -> bytes:
    """The bytes of a message."""
    body: dict[str, Any] = {"kind": KINDS[type(message)]}
    for name, _, _ in _FIELDS[type(message)]:
        body[name] = getattr(message, name)
    if isinstance(message, Reserve | Apply):
        body["values"] = {name: encode_term(value) for name, value in message.values.items()}
    if isinstance(message, TaskRecord):
        body["bindings"] = {name: encode_term(value) for name, value in message.bindings.items()}
    try:
        return orjson.dumps(body, json_notation, orjson.OPT_PASSTHROUGH_DATACLASS)
    except TypeError:
        return _JSON.encode(body).encode()


def decode(payload: bytes, expected: type[M]) -> M:
    """The message that some bytes are; raises PeerError if they are not one of the expected kind."""
    if len(payload) > LARGEST:
        raise PeerError(f"a message of {len(payload)} bytes is too large")
    try:
        body = _read(payload)
    except (ValueError, RecursionError) as error:
        raise PeerError(f"not a message: {error}") from None
    if not isinstance(body, dict) or body.get("kind") != KINDS[expected]:
        raise PeerError(f"not a message of kind {KINDS[expected]!r}")
    values: dict[str, Any] = {}
    for name, reader, required in _FIELDS[expected]:
        if name in body:
            try:
                values[name] = reader(body[name])
            except PeerError as error:
                raise PeerError(f"the member {name!r} of a message of kind {KINDS[expected]!r}: {error}") from None
        elif required:
            raise PeerError(f"a message of kind {KINDS[expected]!r} lacks {name!r}")
    return expected(**values)


def _read(payload: bytes) -> object:
    """What JSON says; raises ValueError or RecursionError."""
    try:
        return orjson.loads(payload)
    except orjson.JSONDecodeError:
        return json.loads(payload.decode())  # of bytes it would guess the encoding


_JSON = json.JSONEncoder(separators=(",", ":"), default=json_notation)
_READERS: dict[str, Callable[[object], object]] = {
    "int": read_whole,
    "float": read_moment,
    "bool": read_truth,
    "str": read_text,
    "tuple[str, ...]": read_texts,
    "Label": read_label,
    "tuple[Label, ...]": read_labels,
    "Remark": read_remark,
    "Identity": read_task_identity,
    "IRI": read_iri,
    "IRI | None": read_maybe_iri,
    "tuple[IRI, ...]": read_iris,
    "Cause": read_cause,
    "Verdict": read_verdict,
    "SignalEncoding": read_encoding,
    "tuple[LogLine, ...]": read_log_lines,
    "tuple[RecordedLoss, ...]": read_losses,
    "Mapping[str, int]": read_numbers,
    "Mapping[str, Any]": read_sayable,
    "Mapping[str, Term]": read_values,
    "Wires": read_inputs,
    "Mapping[str, tuple[IRI, ...]]": read_callers,
    "Mapping[IRI, Wants]": read_all_wants,
}
"""What reads a field, by the type that `selfconf.protocol.messages` gives it."""
_FIELDS: dict[type, tuple[tuple[str, Any, bool], ...]] = {
    kind: tuple(
        (field.name, _READERS[str(field.type)], field.default is field.default_factory is dataclasses.MISSING)
        for field in dataclasses.fields(kind)
    )
    for kind in get_args(Message)
}
"""For each kind of message its fields: name, reader, and whether it must be there; a failover passes here often."""
