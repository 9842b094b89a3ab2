"""Stamps that are written and read quickly say what the messages say."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Release, SignalEncoding, Stamp
from selfconf.protocol.stamps import PLAIN, RAW, StampReader, StampWriter
from tests.protocol import strategies

STAMPS = st.lists(st.tuples(st.booleans(), strategies.by_kind[Stamp]), max_size=4)
IMAGE = SignalEncoding("image/png", "uint8", (480, 640))


@given(STAMPS, st.integers(1, 3))
def test_what_one_writes_another_reads_and_so_does_whoever_reads_messages(
    stamps: list[tuple[bool, Stamp]], times: int
) -> None:
    reader = StampReader()
    for raw, stamp in stamps:
        writer = StampWriter(stamp.component, stamp.life)
        for number in range(times):
            written = writer.write(stamp.sequence + number, stamp.time, raw, stamp.encoding)
            expected = Stamp(stamp.component, stamp.life, stamp.sequence + number, stamp.time, stamp.encoding)
            assert reader.read(written) == (raw, expected)
            assert decode(written.removeprefix(RAW), Stamp) == expected


@given(STAMPS)
def test_a_stamp_in_any_order_of_its_members_is_read(stamps: list[tuple[bool, Stamp]]) -> None:
    reader = StampReader()
    for raw, stamp in stamps:
        body = json.loads(encode(stamp))
        for members in (body, dict(reversed(body.items())), {**body, "further": {"a": 1, "sequence": 5, "time": 1.0}}):
            for _ in range(2):
                assert reader.read((RAW if raw else b"") + json.dumps(members).encode()) == (raw, stamp)


NUMBERS = st.one_of(
    st.sampled_from(
        ["1_000", "nan", "NaN", "inf", "-Infinity", "1e999", "9" * 400, "9" * 5000, "", " 1", "1 ", "+1", "-1"]
    ),
    st.sampled_from(
        ["007", "00.5", "1.", ".5", "1e5", "1E+5", "1e", "-0", "-0.0", "true", "٣", "1}", '1,"time":2', "[]"]
    ),
    st.integers().map(str),
    st.floats().map(repr),
    st.text("0123456789._eE+-naif }", max_size=6),
)


def said_of(read: Callable[[], tuple[bool, Stamp]]) -> str:
    """What a stamp says; that it is refused, if it is."""
    try:
        return repr(read())  # the time may be no number, which equals nothing
    except PeerError:
        return "refused"


@given(st.booleans(), NUMBERS, NUMBERS, st.sampled_from(["}", "", "}}", "} ", ',"further":1}', " }"]))
@example(False, "1", "1_000.0", "}")
@example(False, "1", "1.0", "")
@example(False, "1", "NaN", "}")
@example(False, "1", "1e999", "}")
def test_a_stamp_whose_beginning_is_known_says_what_it_says_to_a_reader_of_messages(
    raw: bool, sequence: str, time: str, end: str
) -> None:
    reader, writer = StampReader(), StampWriter(IRI("urn:a"), "l")
    first = writer.write(1, 2.0, raw)
    reader.read(first)
    attachment = first.partition(b"1")[0] + f'{sequence},"time":{time}{end}'.encode()
    decoded = said_of(lambda: (raw, decode(attachment.removeprefix(RAW), Stamp)))
    assert said_of(lambda: reader.read(attachment)) == decoded


def test_what_comes_after_the_time_is_heeded_though_the_beginning_is_known() -> None:
    reader = StampReader()
    plain = b'{"kind":"stamp","component":"urn:a","life":"l","sequence":%d,"time":1.0%s}'
    encoded = b',"encoding":{"media":"image/png"}'
    said = [reader.read(plain % (n, encoded if n % 2 else b""))[1] for n in range(4)]
    assert [stamp.sequence for stamp in said] == [0, 1, 2, 3]
    assert [stamp.encoding.media for stamp in said] == ["", "image/png", "", "image/png"]


def test_an_encoding_is_written_where_there_is_one_only() -> None:
    writer = StampWriter(IRI("urn:a"), "l")
    assert writer.write(1, 2.0) == b'{"kind":"stamp","component":"urn:a","life":"l","sequence":1,"time":2.0}'
    assert b'"encoding":{"media":"image/png","datatype":"uint8","shape":[480,640]}' in writer.write(2, 2, True, IMAGE)
    assert b"encoding" not in writer.write(3, 2.0, True, PLAIN)


@pytest.mark.parametrize(
    "attachment",
    [b"", b"raw", b"raw{}", b',"sequence":1,"time":1.0}', b'{"sequence":1,"time":1.0}', encode(Release(1, "s"))],
)
def test_what_is_no_stamp_is_refused(attachment: bytes) -> None:
    with pytest.raises(PeerError):
        StampReader().read(attachment)
