"""A text that is not UTF-8 is named with the byte and the place, also where a parser would pass over it."""

from __future__ import annotations

import pytest

from selfconf.errors import TurtleError
from selfconf.rdf.turtle import check_utf_8, first_not_utf_8


@pytest.mark.parametrize("before", ["", "\ufeff"])
@pytest.mark.parametrize("text", ["# ä\n<urn:a> <urn:b> 'ä%s' .\n", "# ä\n# another line ä%s\n"])
def test_a_byte_that_is_no_utf_8_is_named_with_its_place(text: str, before: str) -> None:
    head, tail = f"{before}{text}".split("%s")
    with pytest.raises(TurtleError) as caught:
        check_utf_8(head.encode() + "ö".encode("latin-1") + tail.encode(), "t.ttl")
    wrong = "this is not UTF-8: the byte 0xF6 cannot stand here; save the file in the encoding UTF-8"
    place = len(head.rpartition("\n")[2]) + 1
    assert str(caught.value) == f"t.ttl:2:{place}: {wrong}"


@pytest.mark.parametrize("text", ["", "a", "ä\U0001f916", "\ufeffa"])
def test_a_text_that_is_utf_8_is_passed(text: str) -> None:
    assert first_not_utf_8(text.encode()) is None
    check_utf_8(text.encode(), "t.ttl")


@pytest.mark.parametrize("octets", [b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xc0\xaf"])
def test_what_only_looks_like_utf_8_is_found(octets: bytes) -> None:
    found = first_not_utf_8(b"\n ab" + octets)
    assert found is not None
    assert found[:2] == (2, 4)
