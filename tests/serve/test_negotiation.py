"""Which media type is chosen by the header Accept."""

from __future__ import annotations

import pytest
from starlette.requests import Request

from selfconf.serve.negotiation import acceptable, accepted_by

OFFERED = ["application/json", "text/csv", "text/turtle"]


@pytest.mark.parametrize(
    ("accept", "chosen"),
    [
        ("", OFFERED),
        ("*/*", OFFERED),
        ("text/csv", ["text/csv"]),
        ("TEXT/CSV; q=0.5, text/turtle", ["text/turtle", "text/csv"]),
        ("text/*;q=0.2, application/json;q=0.1", ["text/csv", "text/turtle", "application/json"]),
        ("*/*;q=0.1, text/turtle;q=0", ["application/json", "text/csv"]),
        ("text/csv;q=much, text/turtle", ["text/turtle"]),
        ("image/png", []),
        ("text/csv;q=0.1, text/turtle;q=0.5, text/csv;q=0.9", ["text/csv", "text/turtle"]),
    ],
)
def test_the_most_specific_range_weighs(accept: str, chosen: list[str]) -> None:
    assert acceptable(accept, OFFERED) == chosen


def test_the_header_may_stand_in_several_lines() -> None:
    lines = [(b"accept", b"image/png"), (b"host", b"x"), (b"accept", b"text/turtle;q=0.5")]
    assert accepted_by(Request({"type": "http", "headers": lines})) == "image/png,text/turtle;q=0.5"
    assert accepted_by(Request({"type": "http", "headers": []})) == ""
