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
from typing import Any, TypeVar, get_args

import orjson

from selfconf.errors import PeerError
from selfconf.protocol.json_values import (
    encode_term,
    json_notation,
    read_all_wants,
    read_callers,
    read_cause,
    read_counts,
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
    read_remark,
    read_revisions,
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
_READERS: dict[tuple[type, str], Any] = {
    **{(kind, "epoch"): read_whole for kind in (Reserve, Apply, Release, CallAnswer, Fail, Status, TaskRecord)},
    **{(kind, "supervisor"): read_label for kind in (Reserve, Apply, Release, CallAnswer)},
    **{
        (kind, "task"): read_label
        for kind in (Reserve, Apply, Release, StateOf, CallAnswer, Fail, Free, Notice, Status)
    },
    (TaskRecord, "task"): read_task_identity,
    **{(kind, "priority"): read_whole for kind in (Reserve, Apply, Release, CallAnswer, Status, TaskRecord)},
    **{(kind, "beginning"): read_moment for kind in (Reserve, Apply, Release, CallAnswer, Status, TaskRecord)},
    **{(kind, "component"): read_iri for kind in (CallAnswer, Fail, Free, Moved, Wake, End, Stamp)},
    **{(kind, "life"): read_label for kind in (Reserve, Apply, Release, CallAnswer, Fail, Free, Moved, End, Stamp)},
    (Wake, "after"): read_label,
    **{(kind, "sequence"): read_whole for kind in (Fail, Notice, Stamp)},
    **{(kind, "detail"): read_remark for kind in (CallAnswer, Fail)},
    **{(kind, "inputs"): read_inputs for kind in (Reserve, Apply)},
    **{(kind, "values"): read_values for kind in (Reserve, Apply)},
    (Apply, "standby"): read_inputs,
    **{(kind, "callers"): read_callers for kind in (Apply, CallAnswer, Moved)},
    (Reserve, "waits"): read_truth,
    **{(Apply, member): read_truth for member in ("gently", "rests")},
    (CallAnswer, "place"): read_remark,
    (CallAnswer, "dropped"): read_whole,
    (CallAnswer, "age"): read_moment,
    (CallAnswer, "memory"): read_whole,
    (CallAnswer, "issued"): read_counts,
    (CallAnswer, "outputs"): read_inputs,
    (CallAnswer, "patience"): read_moment,
    (Moved, "outputs"): read_inputs,
    (CallAnswer, "verdict"): read_verdict,
    (CallAnswer, "active"): read_truth,
    (CallAnswer, "stopping"): read_truth,
    (CallAnswer, "shared"): read_truth,
    (Fail, "cause"): read_cause,
    (Page, "index"): read_whole,
    (Page, "total"): read_whole,
    (Page, "revision"): read_whole,
    (Page, "component"): read_maybe_iri,
    (Page, "source"): read_remark,
    (Page, "startable"): read_truth,
    (Page, "unable"): read_remark,
    (Page, "life"): read_label,
    (Page, "insecure"): read_truth,
    (Introduction, "certificate"): read_text,
    (Introduction, "known"): read_truth,
    (Introduction, "beside"): read_labels,
    **{(kind, "principal"): read_remark for kind in (Access, RefusedAttempt)},
    (Access, "sentence"): read_remark,
    (Access, "says"): read_labels,
    (Access, "asked"): read_labels,
    (Access, "hears"): read_labels,
    (Access, "about"): read_labels,
    (Access, "told"): read_labels,
    (RefusedAttempt, "attempt"): read_remark,
    (RefusedAttempt, "key"): read_remark,
    (RefusedAttempt, "number"): read_whole,
    (RefusedAttempt, "latest"): read_moment,
    (Known, "revisions"): read_revisions,
    (LogQuestion, "component"): read_label,
    (LogQuestion, "lines"): read_whole,
    **{(kind, "position"): read_label for kind in (LogQuestion, LogPart)},
    (LogPart, "lines"): read_log_lines,
    (LogPart, "more"): read_truth,
    (Notice, "configurator"): read_label,
    (Notice, "event"): read_sayable,
    (Stamp, "time"): read_moment,
    (Stamp, "encoding"): read_encoding,
    (Status, "configurator"): read_label,
    (Status, "phase"): read_remark,
    (Status, "template"): read_iri,
    (Status, "since"): read_moment,
    (Status, "host"): read_remark,
    (Status, "process"): read_whole,
    (Status, "components"): read_iris,
    (Status, "lost"): read_sayable,
    (Status, "owed"): read_iris,
    (Status, "outside"): read_maybe_iri,
    (Status, "dropped"): read_sayable,
    (Status, "wants"): read_all_wants,
    (TaskRecord, "revision"): read_whole,
    (TaskRecord, "ended"): read_truth,
    (TaskRecord, "document"): read_text,
    (TaskRecord, "source"): read_remark,
    (TaskRecord, "wanted"): read_label,
    (TaskRecord, "bindings"): read_values,
    (TaskRecord, "ontologies"): read_texts,
    (TaskRecord, "options"): read_sayable,
    (TaskRecord, "configuration"): read_sayable,
    (TaskRecord, "lost"): read_losses,
    (TaskRecord, "keeper"): read_label,
}

_FIELDS: dict[type, tuple[tuple[str, Any, bool], ...]] = {
    kind: tuple(
        (field.name, _READERS[kind, field.name], field.default is field.default_factory is dataclasses.MISSING)
        for field in dataclasses.fields(kind)
    )
    for kind in get_args(Message)
}
"""For each kind of message its fields: name, reader, and whether it must be there; a failover passes here often."""
