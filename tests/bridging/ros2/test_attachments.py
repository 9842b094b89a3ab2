"""The 33 octets beside each message, and what is none of them."""

from __future__ import annotations

import pytest

from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.errors import PeerError

OCTETS = bytes.fromhex("010000000000000000e40b540200000010" + "ab" * 16)


def test_an_attachment_is_read_and_written() -> None:
    assert RosAttachment.unpack(OCTETS) == RosAttachment(1, 10_000_000_000, b"\xab" * 16)
    assert RosAttachment(1, 10_000_000_000, b"\xab" * 16).pack() == OCTETS


@pytest.mark.parametrize(
    ("octets", "words"),
    [
        (b"", "of 0 octets"),
        (OCTETS[:-1], "of 32 octets"),
        (OCTETS + b"x", "of 34 octets"),
        (b"\x0fsequence_number", "of 16 octets"),
        (OCTETS[:16] + b"\x08" + OCTETS[17:], "16 octets, not 8"),
    ],
)
def test_what_is_no_attachment_is_refused(octets: bytes, words: str) -> None:
    with pytest.raises(PeerError, match=words):
        RosAttachment.unpack(octets)
