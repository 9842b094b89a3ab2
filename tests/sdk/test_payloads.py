"""Bytes and arrays travel as they are, and arrive as what they were."""

from __future__ import annotations

import array
import json
from collections import OrderedDict
from typing import Any

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import SignalEncoding
from selfconf.sdk import payloads
from selfconf.sdk.payloads import ELEMENT_FORMATS, LARGEST_JSON, UnsayableError, as_bytes, as_json, read_payload

numpy = pytest.importorskip("numpy")


def sent(value: Any) -> Any:
    """What arrives of an array."""
    packed = as_bytes(value)
    assert packed is not None
    return read_payload(packed[0], True, packed[1])


@pytest.mark.parametrize("value", [b"ab", bytearray(b"ab"), memoryview(b"ab")])
def test_bytes_travel_as_they_are_with_their_media_type(value: Any) -> None:
    assert as_bytes(value, "image/png") == (b"ab", SignalEncoding("image/png"))
    assert as_bytes(value) == (b"ab", SignalEncoding())
    assert read_payload(b"ab", True, SignalEncoding("image/png")) == b"ab"


@pytest.mark.parametrize("value", [{"x": 1}, [1], "text", 1, 1.5, True, None, object(), numpy.float32(1)])
def test_everything_else_is_a_value_of_json(value: Any) -> None:
    assert as_bytes(value) is None


@pytest.mark.parametrize("value", [numpy.array(2.5), numpy.int64(1), numpy.bool_(True), {"x": numpy.array(1)}])
def test_a_single_element_of_an_array_is_refused_with_what_makes_a_number_of_it(value: Any) -> None:
    assert as_bytes(value) is None
    single = value["x"] if isinstance(value, dict) else value
    with pytest.raises(UnsayableError, match=rf"type {type(single).__name__} .* `\.item\(\)` makes one of it"):
        as_json(value)
    assert as_json(single.item())


@pytest.mark.parametrize("value", [object(), float("nan"), numpy.float32(1), {1: {2}}, "\ud800", {"\udfff": 1}])
def test_what_json_cannot_say_is_refused(value: Any) -> None:
    with pytest.raises(UnsayableError):
        as_json(value)


@pytest.mark.parametrize(
    "number", [2**63, 2**64 - 1, 2**64, -(2**63), -(2**63) - 1, 10**40, -(10**40), 0.00012345678901234567]
)
def test_a_number_arrives_as_it_was_however_long(number: float) -> None:
    value = {"numbers": [1, number, 2.5], "text": "-12345678901234567890"}
    arrived = read_payload(as_json(value), False, SignalEncoding())
    assert arrived == value
    assert type(arrived["numbers"][1]) is type(number)


def test_only_a_long_whole_number_is_read_by_the_standard_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(json, "loads", lambda _: "the standard library")
    doubles = [0.00012345678901234567, -0.00099999999999999992, 1234567890123456.7, 1.7976931348623157e308]
    for number in (*doubles, 2**63, -(2**59), 1764560000000000000):
        assert read_payload(as_json([number, number]), False, SignalEncoding()) == [number, number]
    for number in (2**64, -(2**63)):
        assert read_payload(as_json([0.5, number]), False, SignalEncoding()) == "the standard library"


@pytest.mark.parametrize("value", [{1: "a"}, {"x": OrderedDict(a=None)}, (1, [2]), IRI("urn:x"), {True: 1}])
def test_what_looks_like_json_to_python_is_json(value: Any) -> None:
    assert as_json(value) == json.dumps(value, separators=(",", ":")).encode()


@pytest.mark.parametrize("payload", [b"[NaN]", b"-Infinity", b'"\\ud800"', b"1e400", b"\xef\xbb\xbf[1]"])
def test_what_other_libraries_write_as_json_is_read(payload: bytes) -> None:
    assert repr(read_payload(payload, False, SignalEncoding())) == repr(json.loads(payload))


@pytest.mark.parametrize("datatype", ELEMENT_FORMATS)
@pytest.mark.parametrize("shape", [(6,), (2, 3), (1, 2, 3), (0, 3)])
def test_an_array_arrives_with_its_datatype_and_shape(datatype: str, shape: tuple[int, ...]) -> None:
    value = numpy.arange(6 if all(shape) else 0).astype(datatype).reshape(shape)
    packed = as_bytes(value, "image/x-raw")
    assert packed is not None
    assert packed == (value.tobytes(), SignalEncoding("image/x-raw", datatype, shape))
    arrived = sent(value)
    assert (arrived.dtype, arrived.shape) == (value.dtype, value.shape)
    assert (arrived == value).all()
    assert not arrived.flags.writeable


def test_an_array_that_is_not_contiguous_travels_row_by_row() -> None:
    value = numpy.arange(12, dtype="int16").reshape(3, 4)
    for view in (value.T, value[::2], value[:, 1:3]):
        assert (sent(view) == view).all()


def test_whatever_has_a_buffer_of_numbers_is_an_array() -> None:
    assert sent(array.array("d", [1.5, 2.5])).tolist() == [1.5, 2.5]
    assert sent(array.array("l", [1, -2])).tolist() == [1, -2]
    assert sent(memoryview(bytes(6)).cast("B", (2, 3))).shape == (2, 3)


@pytest.mark.parametrize("datatype", [">f4", "datetime64[s]", "longdouble", object, [("a", "f4")], "S3"])
def test_an_array_of_other_elements_is_refused(datatype: Any) -> None:
    with pytest.raises(UnsayableError):
        as_bytes(numpy.zeros(3, datatype))


@pytest.mark.parametrize("datatype", ELEMENT_FORMATS)
def test_without_numpy_an_array_is_a_memoryview(datatype: str, monkeypatch: pytest.MonkeyPatch) -> None:
    value = numpy.arange(6).astype(datatype).reshape(2, 3)
    monkeypatch.setattr(payloads, "_numpy", lambda: None)
    arrived = sent(value)
    assert isinstance(arrived, memoryview)
    assert arrived.tobytes() == value.tobytes()
    if datatype not in ("float16", "complex64", "complex128"):
        assert arrived.tolist() == value.tolist()
    assert sent(numpy.zeros((0, 3), datatype)).tobytes() == b""


@pytest.mark.parametrize(
    "encoding",
    [SignalEncoding("", "uint8", (2, 2)), SignalEncoding("", "uint16", (3,)), SignalEncoding("", "text", (3,))],
)
def test_a_payload_that_is_not_what_its_encoding_says_is_refused(encoding: SignalEncoding) -> None:
    with pytest.raises(ValueError, match="3 bytes are no"):
        read_payload(b"abc", True, encoding)


@pytest.mark.parametrize("shape", [(0, 1 << 80), (0, 1 << 40, 1 << 40), (0,) * 65])
def test_a_shape_that_no_array_has_is_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"dimension|too big"):
        read_payload(b"", True, SignalEncoding("", "uint8", shape))


def test_json_is_small_on_both_ways() -> None:
    text = "x" * LARGEST_JSON
    with pytest.raises(UnsayableError, match="an array or bytes can be that large"):
        as_json(text)
    with pytest.raises(ValueError, match="too many"):
        read_payload(b"[" * (LARGEST_JSON + 1), False, SignalEncoding())
    assert read_payload(as_json(text[2:]), False, SignalEncoding()) == text[2:]
