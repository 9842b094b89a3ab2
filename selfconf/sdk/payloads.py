"""What signals are on the wire: JSON, bytes as they are, or the elements of an array.

An array is anything with a buffer of numbers: a NumPy array, a memoryview with a shape, an `array.array`. Its elements
travel little-endian, the last dimension quickest (C order); their datatype and the shape stand in the stamp. What
arrives is a view of the bytes that came, without a copy: a NumPy array that is not to be written to, or, where NumPy is
not installed, a memoryview. NumPy is imported by the first array that arrives, and by nothing else.

JSON is written and read by orjson, in a tenth of the time of the standard library, and by that library wherever the two
could differ: values that orjson refuses, numbers that it writes as null or would round, text that it takes for none.
"""

from __future__ import annotations

import json
import math
import sys
from functools import cache
from types import ModuleType
from typing import Any, NoReturn

import orjson

from selfconf.protocol.messages import SignalEncoding
from selfconf.protocol.stamps import PLAIN

ELEMENT_FORMATS = {
    "bool": "?",
    "int8": "b",
    "int16": "h",
    "int32": "i",
    "int64": "q",
    "uint8": "B",
    "uint16": "H",
    "uint32": "I",
    "uint64": "Q",
    "float16": "e",
    "float32": "f",
    "float64": "d",
    "complex64": "Zf",
    "complex128": "Zd",
}
"""The datatypes of elements, with their formats in the buffer protocol."""
_SAME = {"l": "q", "n": "q", "L": "Q", "N": "Q"}
"""Formats that are others by another name, where their elements have eight bytes."""
LARGEST_JSON = 1 << 22
"""Bytes of a signal of JSON at most: read, it takes up to fifty times that memory. Arrays and bytes may be larger."""
_OF_JSON = (dict, list, str, int, float)


def _unsayable(value: object) -> NoReturn:
    """Say why JSON has no such value. Raises TypeError.

    A number of NumPy, and its array without dimensions, look like numbers of Python and are none.
    """
    kind = type(value).__name__
    try:
        single = memoryview(value).ndim == 0  # type: ignore[arg-type]  # whether it has a buffer is the question
    except (TypeError, ValueError):
        single = False
    if single:
        raise TypeError(f"a single element of type {kind} is no number of Python, and `.item()` makes one of it")
    raise TypeError(f"an object of type {kind} is nothing of JSON")


_WRITER = json.JSONEncoder(separators=(",", ":"), allow_nan=False, ensure_ascii=False, default=_unsayable)
"""Writes what orjson does not, and says why where there is nothing to write.

It does not escape letters: text that is none, with half of a surrogate pair, is noticed where UTF-8 cannot say it.
"""
_PLAIN_TYPES = orjson.OPT_PASSTHROUGH_SUBCLASS | orjson.OPT_PASSTHROUGH_DATETIME | orjson.OPT_PASSTHROUGH_DATACLASS
"""Has orjson refuse what is nothing of JSON, but for a UUID and a member of an `Enum`, which travel as their values."""
_DIGITS = bytes.maketrans(b"123456789", b"000000000")
"""Makes every digit a zero."""
_LONG, _LONG_NEGATIVE = b"0" * 20, b"-" + b"0" * 19
"""What whole numbers beyond 64 bits have in them once their digits are zeros: orjson reads these as doubles."""
_LONGEST = b"0" * 19
"""The most digits of a whole number of which 64 bits hold every one; both of the above have them in them."""


class UnsayableError(Exception):
    """A value that a signal cannot carry, and why, as a sentence without its subject."""


def as_bytes(value: Any, media: str = "") -> tuple[bytes, SignalEncoding] | None:
    """The payload and the encoding of what travels as it is; None for a value of JSON. Raises UnsayableError."""
    if type(value) is bytes:
        return value, SignalEncoding(media) if media else PLAIN
    if isinstance(value, _OF_JSON):
        return None
    try:
        view = memoryview(value)
    except TypeError:
        return None
    except ValueError as error:  # NumPy has datatypes that no buffer has, such as points in time
        raise UnsayableError(f"is no signal: {error}") from None
    if isinstance(value, bytes | bytearray) or (type(value) is memoryview and (view.format, view.ndim) == ("B", 1)):
        return view.tobytes(), SignalEncoding(media)
    return (view.tobytes(), SignalEncoding(media, _datatype(view), tuple(view.shape or ()))) if view.ndim else None


def as_json(value: Any) -> bytes:
    """A signal as JSON, in UTF-8, with neither NaN nor infinity: a component in another language could not read them.

    Raises UnsayableError.
    """
    try:
        said = orjson.dumps(value, None, _PLAIN_TYPES)
    except orjson.JSONEncodeError:
        said = b""
    # NaN and infinity are null to orjson; in numbers a single letter is looked for in a tenth of the time of the word.
    if not said or (b"u" in said and b"null" in said):
        try:
            said = _WRITER.encode(value).encode()
        except (TypeError, ValueError, RecursionError) as error:
            raise UnsayableError(f"is nothing that JSON can say: {error}") from None
    if len(said) > LARGEST_JSON:
        raise UnsayableError(f"has {len(said)} bytes as JSON, which are too many; an array or bytes can be that large")
    return said


def read_payload(payload: bytes, raw: bool, encoding: SignalEncoding) -> Any:
    """The value of a signal. Raises ValueError for a payload that is not what its encoding says."""
    if not raw:
        if len(payload) > LARGEST_JSON:
            raise ValueError(f"{len(payload)} bytes of JSON are too many")
        return _read_json(payload)
    if not encoding.datatype:
        return payload
    if encoding.datatype not in ELEMENT_FORMATS or _size(encoding.datatype) * math.prod(encoding.shape) != len(payload):
        raise ValueError(f"{len(payload)} bytes are no {encoding.datatype} of shape {list(encoding.shape)}")
    numpy = _numpy()
    if numpy is not None:
        return numpy.frombuffer(payload, numpy.dtype(encoding.datatype).newbyteorder("<")).reshape(encoding.shape)
    try:
        form = ELEMENT_FORMATS[encoding.datatype]
        return memoryview(payload).cast(form, encoding.shape)  # type: ignore[call-overload]  # `form` is no constant
    except (TypeError, ValueError):  # a memoryview knows neither these datatypes nor dimensions without any element
        return memoryview(payload)


def _read_json(payload: bytes) -> Any:
    """The value that JSON says. Raises ValueError, and RecursionError where it is nested too deeply."""
    zeros = payload.translate(_DIGITS)
    if _LONGEST not in zeros or not _has_long_whole_number(zeros):
        try:
            return orjson.loads(payload)
        except orjson.JSONDecodeError:
            pass  # what the standard library takes for JSON, such as NaN, goes on being read, and it says what is wrong
    return json.loads(payload)


def _has_long_whole_number(zeros: bytes) -> bool:
    """Whether JSON, with every digit a zero, may have a whole number beyond 64 bits.

    A double may have as many digits, seventeen and three zeros before them, but only after its point.
    """
    return _LONG_NEGATIVE in zeros or (_LONG in zeros and _LONG in zeros.replace(b".0", b"."))


def _datatype(view: memoryview) -> str:
    order, kind = (view.format[0], view.format[1:]) if view.format[0] in "@=<>!" else ("@", view.format)
    little = view.itemsize == 1 or order == "<" or (order in "@=" and sys.byteorder == "little")
    kind = _SAME.get(kind, kind)
    for datatype, one in ELEMENT_FORMATS.items():
        if one == kind and little and _size(datatype) == view.itemsize:
            return datatype
    raise UnsayableError(f"is an array of {view.format!r}; those of little-endian numbers and truth values can be sent")


def _size(datatype: str) -> int:
    """The bytes of an element."""
    return 1 if datatype == "bool" else int(datatype.lstrip("abcdefghijklmnopqrstuvwxyz")) // 8


@cache
def _numpy() -> ModuleType | None:
    try:
        import numpy
    except ImportError:
        return None
    return numpy
