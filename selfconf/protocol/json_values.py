"""The values in messages as JSON: how each kind is written, and read from a stranger.

A term is an object: `{"iri": ...}`, `{"blank": ...}`, or `{"literal": ..., "datatype": ..., "language": ...}`. What
arrives is untrusted: each function `read_...` takes what JSON has said, and returns the value that it is named after,
or raises PeerError, and nothing else.
"""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import orjson

from selfconf.errors import PeerError
from selfconf.model.configuration import Wants
from selfconf.model.log_line import LONGEST_LINE, LogLine
from selfconf.model.profile import CALL_MARK, LONGEST_PORT_NAME
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.model.wording import is_one_line, one_line
from selfconf.protocol.keys import is_task_identity
from selfconf.protocol.messages import Cause, RecordedLoss, SignalEncoding, Verdict, Wire

MOST_WIRES = 4096
"""How many outputs the inputs of a component can be set to follow in one call."""
MOST_DIMENSIONS = 64
"""How many dimensions an array has at most, as in Python and NumPy; to multiply very many sizes takes seconds."""
_WHOLE = 1 << 63
"""Whole numbers lie between this and its negative, so that other languages can hold them too."""
_LONGEST_NAME = LONGEST_PORT_NAME + len(CALL_MARK)
_QUOTED = 80
"""How many characters of what a stranger has said an error quotes."""


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
            return read_iri(body["iri"])
        if "blank" in body:
            return BlankNode(read_text(body["blank"]))
        if "literal" in body:
            language = body.get("language")
            return Literal(
                read_text(body["literal"]),
                read_iri(body.get("datatype", STRING)),
                None if language is None else read_text(language),
            )
    raise PeerError("not a term")


def json_notation(value: object) -> object:
    """A value that JSON has no notation for, as one that it has: what `json` calls for such a value."""
    if isinstance(value, Wire):
        return value.component, value.output, value.period
    if isinstance(value, RecordedLoss):
        return value.component, value.life, value.cause, value.detail
    if isinstance(value, Wants):
        return {"inputs": sorted(value.inputs), "values": {name: encode_term(term) for name, term in value.values}}
    if isinstance(value, SignalEncoding):
        return {name: member for name, member in dataclasses.asdict(value).items() if member}
    raise TypeError(f"no message holds a {type(value).__name__}")


def read_text(value: object) -> str:
    """A text; JSON can write half a surrogate pair, which no key and no file can hold: that is none."""
    if not isinstance(value, str):
        raise PeerError("a text was expected")
    if value.isascii():
        return value
    try:
        value.encode()
    except UnicodeEncodeError:
        raise PeerError("a text was expected") from None
    return value


def read_label(value: object) -> str:
    """A `Label`, on one line."""
    label = read_text(value)
    if not is_one_line(label):
        raise PeerError(f"{one_line(label, _QUOTED)!r} holds control characters, and can name nothing")
    return label


def read_remark(value: object) -> str:
    """A `Remark`, of which one line is made."""
    return one_line(read_text(value))


def read_name(value: object) -> str:
    """A text that names something, and is neither empty nor longer than the name of an operation."""
    name = read_label(value)
    if not 0 < len(name) <= _LONGEST_NAME:
        raise PeerError(f"a name of 1 to {_LONGEST_NAME} characters was expected")
    return name


def read_task_identity(value: object) -> str:
    """An `Identity`, with its two parts."""
    identity = read_label(value)
    if not is_task_identity(identity):
        raise PeerError(f"{identity[:_QUOTED]!r} is no identity of a task: NAME~TOKEN was expected")
    return identity


def read_iri(value: object) -> IRI:
    """An IRI, which may be none that Turtle could write: it names something all the same."""
    return IRI.unchecked(read_label(value))


def read_maybe_iri(value: object) -> IRI | None:
    """An IRI, or nothing."""
    return None if value is None else read_iri(value)


def read_whole(value: object) -> int:
    """A whole number of 64 bits."""
    if not isinstance(value, int) or isinstance(value, bool) or not -_WHOLE <= value < _WHOLE:
        raise PeerError("a whole number of 64 bits was expected")
    return value


def read_number(value: object) -> float:
    """A number, which may be infinite or none."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise PeerError("a number was expected")
    try:
        return float(value)
    except OverflowError:
        raise PeerError("a number that a float can hold was expected") from None


def read_moment(value: object) -> float:
    """Tasks are served by their beginnings, and what is no number in JSON either has no place in an order."""
    moment = read_number(value)
    if not math.isfinite(moment):
        raise PeerError("a finite number was expected")
    return moment


def read_encoding(value: object) -> SignalEncoding:
    """How a signal is encoded."""
    body = _read_object(value)
    sizes = _read_list(body.get("shape", []))
    if len(sizes) > MOST_DIMENSIONS:
        raise PeerError(f"an array has {MOST_DIMENSIONS} dimensions at most")
    shape = tuple(map(read_whole, sizes))
    if any(size < 0 for size in shape):
        raise PeerError("no dimension of an array is below zero")
    return SignalEncoding(read_text(body.get("media", "")), read_text(body.get("datatype", "")), shape)


def read_truth(value: object) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise PeerError("true or false was expected")
    return value


def _read_object(value: object) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise PeerError("an object was expected")
    return value


def read_sayable(value: object) -> dict[str, Any]:
    """An object that is handed on as it is: every number in it is one of doubles, and every text can be written."""
    body = _read_object(value)
    try:
        orjson.loads(json.dumps(body, ensure_ascii=False, allow_nan=False).encode())  # refuses 10**400
    except (ValueError, RecursionError):
        raise PeerError("finite numbers and texts of whole characters were expected") from None
    return body


def _read_list(value: object) -> list[Any]:
    if not isinstance(value, list):
        raise PeerError("a list was expected")
    return value


def _read_wire(value: object) -> Wire:
    """An output that an input follows, with its period if it promises a rate."""
    parts = _read_list(value)
    if len(parts) != 3:
        raise PeerError("a wire is a component, an output and a period")
    period = None if parts[2] is None else read_number(parts[2])
    if period is not None and not 0 < period < math.inf:
        raise PeerError("the period of a wire is finite and above zero")
    return Wire(read_iri(parts[0]), read_name(parts[1]), period)


def read_inputs(value: object) -> dict[str, tuple[Wire, ...]]:
    """The outputs that each input follows, by the name of the input."""
    inputs = {read_name(port): _read_list(wires) for port, wires in _read_object(value).items()}
    if sum(map(len, inputs.values())) > MOST_WIRES:
        raise PeerError(f"the inputs of a component follow {MOST_WIRES} outputs at most")
    return {port: tuple(map(_read_wire, wires)) for port, wires in inputs.items()}


def read_callers(value: object) -> dict[str, tuple[IRI, ...]]:
    """The components that may call each operation, by its name."""
    return {read_name(operation): read_iris(some) for operation, some in _read_object(value).items()}


def read_values(value: object) -> dict[str, Term]:
    """Terms by name."""
    return {read_name(name): decode_term(item) for name, item in _read_object(value).items()}


def read_all_wants(value: object) -> dict[IRI, Wants]:
    """What is wanted of each component."""
    return {read_iri(component): _read_wants(one) for component, one in _read_object(value).items()}


def _read_wants(value: object) -> Wants:
    body = _read_object(value)
    inputs = [_read_list(one) for one in _read_list(body.get("inputs", []))]
    if any(len(one) != 3 for one in inputs):
        raise PeerError("what is wanted of an input is its name, a component and an output")
    return Wants(
        frozenset((read_name(port), read_iri(source), read_name(output)) for port, source, output in inputs),
        frozenset(read_values(body.get("values", {})).items()),
    )


def read_numbers(value: object) -> dict[str, int]:
    """Whole numbers by name."""
    return {read_name(name): read_whole(number) for name, number in _read_object(value).items()}


def read_iris(value: object) -> tuple[IRI, ...]:
    """Some IRIs."""
    return tuple(read_iri(item) for item in _read_list(value))


def read_log_lines(value: object) -> tuple[LogLine, ...]:
    """Some lines of a log."""
    return tuple(map(_read_log_line, _read_list(value)))


def _read_log_line(value: object) -> LogLine:
    parts = _read_list(value)
    if len(parts) != 4:
        raise PeerError("a line of a log is a time, a stream, the components of a process, and a text")
    time, stream, components, text = parts
    return LogLine(_read_printed(time), _read_printed(stream), read_iris(components), _read_printed(text))


def _read_printed(value: object) -> str:
    return one_line(read_text(value), LONGEST_LINE)


def read_cause(value: object) -> Cause:
    """The cause of a failure."""
    try:
        return Cause(read_text(value))
    except ValueError:
        raise PeerError(f"{one_line(read_text(value), _QUOTED)!r} is no cause of a failure") from None


def read_losses(value: object) -> tuple[RecordedLoss, ...]:
    """Some components that a task has lost."""
    return tuple(map(_read_loss, _read_list(value)))


def _read_loss(value: object) -> RecordedLoss:
    parts = _read_list(value)
    if len(parts) != 4:
        raise PeerError("a loss is a component, a life, a cause and a detail")
    component, life, cause, detail = parts
    return RecordedLoss(read_iri(component), read_label(life), read_cause(cause), read_remark(detail))


def read_verdict(value: object) -> Verdict:
    """What a component has made of a call."""
    try:
        return Verdict(read_text(value))
    except ValueError:
        raise PeerError(f"{one_line(read_text(value), _QUOTED)!r} is no verdict") from None


def read_texts(value: object) -> tuple[str, ...]:
    """Some texts."""
    return tuple(read_text(item) for item in _read_list(value))


def read_labels(value: object) -> tuple[str, ...]:
    """Some texts that name something."""
    return tuple(read_label(item) for item in _read_list(value))
