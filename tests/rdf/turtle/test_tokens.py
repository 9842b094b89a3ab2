"""The tokens of Turtle that hide signs: a string is one token, whatever is in it, and ends where Turtle ends it."""

from __future__ import annotations

import re

import pytest

from selfconf.rdf.turtle.tokens import COMMENT, QUOTED

TOKEN = re.compile(f"{QUOTED}|{COMMENT}", re.DOTALL)


@pytest.mark.parametrize(
    "token",
    [
        '""',
        "''",
        '""""""',
        '"a # b"',
        r'"a\" # b"',
        "'it is \"one\"'",
        r"'it\'s'",
        '"""a\n"b" # c"""',
        '"""a""b\\""""',
        "'''a''b\n'''",
        "# a 'b \"c",
    ],
)
def test_a_token_is_taken_whole(token: str) -> None:
    assert [found[0] for found in TOKEN.finditer(f"x {token}\n y")] == [token]


@pytest.mark.parametrize("text", ['"a\nb', "'a\nb", '"""a" b ', "'''a' b"])
def test_what_has_no_end_is_no_string(text: str) -> None:
    found = TOKEN.match(text)
    assert found is None


def test_a_comment_ends_with_its_line() -> None:
    assert TOKEN.findall("# a\nb # c") == ["# a", "# c"]
