"""Messages as JSON, self-describing, so that a component in another language can join from the documentation alone.

A message is an object with a member `kind` and one member for each field. A term is an object: `{"iri": ...}`,
`{"blank": ...}`, or `{"literal": ..., "datatype": ..., "language": ...}`. What arrives is untrusted: anything that
is not a message of the expected kind raises PeerError, and nothing else. Members that are not known are passed over, so
that a newer peer can add some.

Messages are written and read by orjson, as a failover waits for several of them. What it refuses, numbers beyond any
double and halves of surrogate pairs, the standard library writes and reads: the field that may not hold it says why.
"""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any, TypeVar, get_args

import orjson

from selfconf.errors import PeerError
from selfconf.model.configuration import Wants
from selfconf.model.log_line import LONGEST_LINE, LogLine
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.model.wording import is_one_line, one_line
from selfconf.protocol.keys import is_task_identity
from selfconf.protocol.messages import (
    Access,
    Apply,
    CallAnswer,
    Cause,
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
    SignalEncoding,
    Stamp,
    StateOf,
    Status,
    TaskRecord,
    Verdict,
    Wake,
    Wire,
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
MOST_WIRES = 4096
"""How many outputs the inputs of a component can be set to follow in one call."""
MOST_ADVERTISED = 20_000
"""For how many components one site can speak; what it says of more is left out."""
_WHOLE = 1 << 63
"""Whole numbers lie between this and its negative, so that other languages can hold them too."""


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
        return orjson.dumps(body, _plain, orjson.OPT_PASSTHROUGH_DATACLASS)
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
            values[name] = reader(body[name])
        elif required:
            raise PeerError(f"a message of kind {KINDS[expected]!r} lacks {name!r}")
    return expected(**values)


def _read(payload: bytes) -> object:
    """What JSON says; raises ValueError or RecursionError."""
    try:
        return orjson.loads(payload)
    except orjson.JSONDecodeError:
        return json.loads(payload.decode())  # of bytes it would guess the encoding


def encode_term(term: Term) -> dict[str, str]:
    """A term as a JSON object."""
    if isinstance(term, Literal):
        body = {"literal": term.lexical, "datatype": str(term.datatype)}
        return {**body, "language": term.language} if term.language else body
    return {"iri": str(term)} if isinstance(term, IRI) else {"blank": str(term)}


def decode_term(body: object) -> Term:
    """The term that a JSON object stands for; raises PeerError."""
    if isinstance(body, dict):
        if "iri" in body:
            return _iri(body["iri"])
        if "blank" in body:
            return BlankNode(_text(body["blank"]))
        if "literal" in body:
            language = body.get("language")
            return Literal(
                _text(body["literal"]),
                _iri(body.get("datatype", STRING)),
                None if language is None else _text(language),
            )
    raise PeerError("not a term")


def _plain(value: object) -> object:
    """A value that JSON has no notation for, as one that it has."""
    if isinstance(value, Wire):
        return value.component, value.output, value.period
    if isinstance(value, Wants):
        return {"inputs": sorted(value.inputs), "values": {name: encode_term(term) for name, term in value.values}}
    if isinstance(value, SignalEncoding):
        return {name: member for name, member in dataclasses.asdict(value).items() if member}
    raise TypeError(f"no message holds a {type(value).__name__}")


_JSON = json.JSONEncoder(separators=(",", ":"), default=_plain)
_QUOTED = 80
"""How many characters of what a stranger has said an error quotes."""


def _text(value: object) -> str:
    """JSON can write half a surrogate pair, which no key and no file can hold: that is no text."""
    if not isinstance(value, str):
        raise PeerError("a text was expected")
    if value.isascii():
        return value
    try:
        value.encode()
    except UnicodeEncodeError:
        raise PeerError("a text was expected") from None
    return value


def _label(value: object) -> str:
    """A text that names something: it stands in keys and in lines for people, so it steers nothing and ends no line."""
    label = _text(value)
    if not is_one_line(label):
        raise PeerError(f"{one_line(label, _QUOTED)!r} holds control characters, and can name nothing")
    return label


def _remark(value: object) -> str:
    """A text for people, of which nothing else depends: on one line, whatever was said."""
    return one_line(_text(value))


def _name(value: object) -> str:
    name = _label(value)
    if not name:
        raise PeerError("a name that is not empty was expected")
    return name


def _task_identity(value: object) -> str:
    """The identity of a task that sites keep: it becomes the name of a file there, and a chunk of keys."""
    identity = _label(value)
    if not is_task_identity(identity):
        raise PeerError(f"{identity[:_QUOTED]!r} is no identity of a task: NAME~TOKEN was expected")
    return identity


def _iri(value: object) -> IRI:
    return IRI.unchecked(_label(value))


def _maybe_iri(value: object) -> IRI | None:
    return None if value is None else _iri(value)


def _whole(value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not -_WHOLE <= value < _WHOLE:
        raise PeerError("a whole number of 64 bits was expected")
    return value


def _number(value: object) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise PeerError("a number was expected")
    try:
        return float(value)
    except OverflowError:
        raise PeerError("a number that a float can hold was expected") from None


def _moment(value: object) -> float:
    """Tasks are served by their beginnings, and what is no number in JSON either has no place in an order."""
    moment = _number(value)
    if not math.isfinite(moment):
        raise PeerError("a finite number was expected")
    return moment


def _encoding(value: object) -> SignalEncoding:
    body = _object(value)
    shape = tuple(map(_whole, _list(body.get("shape", []))))
    if any(size < 0 for size in shape):
        raise PeerError("no dimension of an array is below zero")
    return SignalEncoding(_text(body.get("media", "")), _text(body.get("datatype", "")), shape)


def _truth(value: object) -> bool:
    if not isinstance(value, bool):
        raise PeerError("true or false was expected")
    return value


def _object(value: object) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise PeerError("an object was expected")
    return value


def _sayable(value: object) -> dict[str, Any]:
    """An object that is handed on as it is: every number in it is finite, and every text can be written."""
    body = _object(value)
    try:
        json.dumps(body, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError):
        raise PeerError("finite numbers and texts of whole characters were expected") from None
    return body


def _list(value: object) -> list[Any]:
    if not isinstance(value, list):
        raise PeerError("a list was expected")
    return value


def _wire(value: object) -> Wire:
    parts = _list(value)
    if len(parts) != 3:
        raise PeerError("a wire is a component, an output and a period")
    period = None if parts[2] is None else _number(parts[2])
    if period is not None and not 0 < period < math.inf:
        raise PeerError("the period of a wire is finite and above zero")
    return Wire(_iri(parts[0]), _name(parts[1]), period)


def _inputs(value: object) -> dict[str, tuple[Wire, ...]]:
    inputs = {_name(port): _list(wires) for port, wires in _object(value).items()}
    if sum(map(len, inputs.values())) > MOST_WIRES:
        raise PeerError(f"the inputs of a component follow {MOST_WIRES} outputs at most")
    return {port: tuple(map(_wire, wires)) for port, wires in inputs.items()}


def _callers(value: object) -> dict[str, tuple[IRI, ...]]:
    return {_name(operation): _iris(some) for operation, some in _object(value).items()}


def _values(value: object) -> dict[str, Term]:
    return {_name(name): decode_term(item) for name, item in _object(value).items()}


def _all_wants(value: object) -> dict[IRI, Wants]:
    return {_iri(component): _wants(one) for component, one in _object(value).items()}


def _wants(value: object) -> Wants:
    body = _object(value)
    inputs = [_list(one) for one in _list(body.get("inputs", []))]
    if any(len(one) != 3 for one in inputs):
        raise PeerError("what is wanted of an input is its name, a component and an output")
    return Wants(
        frozenset((_name(port), _iri(source), _name(output)) for port, source, output in inputs),
        frozenset(_values(body.get("values", {})).items()),
    )


def _revisions(value: object) -> dict[str, int]:
    return {_name(site): _whole(revision) for site, revision in _object(value).items()}


def _counts(value: object) -> dict[str, int]:
    return {_text(port): _whole(count) for port, count in _object(value).items()}


def _iris(value: object) -> tuple[IRI, ...]:
    return tuple(_iri(item) for item in _list(value))


def _log_lines(value: object) -> tuple[LogLine, ...]:
    return tuple(map(_log_line, _list(value)))


def _log_line(value: object) -> LogLine:
    parts = _list(value)
    if len(parts) != 4:
        raise PeerError("a line of a log is a time, a stream, the components of a process, and a text")
    time, stream, components, text = parts
    return LogLine(_printed(time), _printed(stream), _iris(components), _printed(text))


def _printed(value: object) -> str:
    return one_line(_text(value), LONGEST_LINE)


def _cause(value: object) -> Cause:
    try:
        return Cause(_text(value))
    except ValueError:
        raise PeerError(f"{one_line(_text(value), _QUOTED)!r} is no cause of a failure") from None


def _verdict(value: object) -> Verdict:
    try:
        return Verdict(_text(value))
    except ValueError:
        raise PeerError(f"{one_line(_text(value), _QUOTED)!r} is no verdict") from None


def _texts(value: object) -> tuple[str, ...]:
    return tuple(_text(item) for item in _list(value))


def _labels(value: object) -> tuple[str, ...]:
    return tuple(_label(item) for item in _list(value))


_READERS: dict[tuple[type, str], Any] = {
    **{(kind, "epoch"): _whole for kind in (Reserve, Apply, Release, CallAnswer, Fail, Status, TaskRecord)},
    **{(kind, "supervisor"): _label for kind in (Reserve, Apply, Release, CallAnswer)},
    **{(kind, "task"): _label for kind in (Reserve, Apply, Release, StateOf, CallAnswer, Fail, Free, Notice, Status)},
    (TaskRecord, "task"): _task_identity,
    **{(kind, "priority"): _whole for kind in (Reserve, Apply, Release, CallAnswer, Status, TaskRecord)},
    **{(kind, "beginning"): _moment for kind in (Reserve, Apply, Release, CallAnswer, Status, TaskRecord)},
    **{(kind, "component"): _iri for kind in (CallAnswer, Fail, Free, Moved, Wake, End, Stamp)},
    **{(kind, "life"): _label for kind in (Reserve, Apply, Release, CallAnswer, Fail, Free, Moved, End, Stamp)},
    (Wake, "after"): _label,
    **{(kind, "sequence"): _whole for kind in (Fail, Notice, Stamp)},
    **{(kind, "detail"): _remark for kind in (CallAnswer, Fail)},
    **{(kind, "inputs"): _inputs for kind in (Reserve, Apply)},
    **{(kind, "values"): _values for kind in (Reserve, Apply)},
    (Apply, "standby"): _inputs,
    **{(kind, "callers"): _callers for kind in (Apply, CallAnswer, Moved)},
    (Reserve, "waits"): _truth,
    **{(Apply, member): _truth for member in ("gently", "rests")},
    (CallAnswer, "place"): _remark,
    (CallAnswer, "dropped"): _whole,
    (CallAnswer, "age"): _moment,
    (CallAnswer, "memory"): _whole,
    (CallAnswer, "issued"): _counts,
    (CallAnswer, "outputs"): _inputs,
    (CallAnswer, "patience"): _moment,
    (Moved, "outputs"): _inputs,
    (CallAnswer, "verdict"): _verdict,
    (CallAnswer, "active"): _truth,
    (CallAnswer, "stopping"): _truth,
    (CallAnswer, "shared"): _truth,
    (Fail, "cause"): _cause,
    (Page, "index"): _whole,
    (Page, "total"): _whole,
    (Page, "revision"): _whole,
    (Page, "component"): _maybe_iri,
    (Page, "source"): _remark,
    (Page, "startable"): _truth,
    (Page, "unable"): _remark,
    (Status, "outside"): _maybe_iri,
    (Page, "life"): _label,
    (Page, "insecure"): _truth,
    (Introduction, "certificate"): _text,
    (Introduction, "known"): _truth,
    (Introduction, "beside"): _labels,
    **{(kind, "principal"): _remark for kind in (Access, RefusedAttempt)},
    (Access, "sentence"): _remark,
    (Access, "says"): _labels,
    (Access, "asked"): _labels,
    (Access, "hears"): _labels,
    (Access, "about"): _labels,
    (Access, "told"): _labels,
    (RefusedAttempt, "attempt"): _remark,
    (RefusedAttempt, "key"): _remark,
    (RefusedAttempt, "number"): _whole,
    (RefusedAttempt, "latest"): _moment,
    (Known, "revisions"): _revisions,
    (LogQuestion, "component"): _label,
    (LogQuestion, "lines"): _whole,
    **{(kind, "position"): _label for kind in (LogQuestion, LogPart)},
    (LogPart, "lines"): _log_lines,
    (LogPart, "more"): _truth,
    (Notice, "configurator"): _label,
    (Notice, "event"): _sayable,
    (Stamp, "time"): _number,
    (Stamp, "encoding"): _encoding,
    (Status, "configurator"): _label,
    (Status, "phase"): _remark,
    (Status, "template"): _iri,
    (Status, "since"): _moment,
    (Status, "host"): _remark,
    (Status, "process"): _whole,
    (Status, "components"): _iris,
    (Status, "lost"): _sayable,
    (Status, "owed"): _iris,
    (Status, "dropped"): _sayable,
    (Status, "wants"): _all_wants,
    (TaskRecord, "revision"): _whole,
    (TaskRecord, "ended"): _truth,
    (TaskRecord, "document"): _text,
    (TaskRecord, "source"): _remark,
    (TaskRecord, "wanted"): _label,
    (TaskRecord, "bindings"): _values,
    (TaskRecord, "ontologies"): _texts,
    (TaskRecord, "options"): _sayable,
    (TaskRecord, "configuration"): _sayable,
}

_FIELDS: dict[type, tuple[tuple[str, Any, bool], ...]] = {
    kind: tuple(
        (field.name, _READERS[kind, field.name], field.default is field.default_factory is dataclasses.MISSING)
        for field in dataclasses.fields(kind)
    )
    for kind in get_args(Message)
}
"""For each kind of message its fields: name, reader, and whether it must be there; a failover passes here often."""
