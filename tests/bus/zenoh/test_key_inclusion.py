"""Which keys include others."""

from __future__ import annotations

import pytest

from selfconf.bus.zenoh import includes


@pytest.mark.parametrize(
    ("wide", "narrow", "expected"),
    [
        ("a/b", "a/b", True),
        ("a/*", "a/b", True),
        ("a/**", "a/b/c", True),
        ("a/**", "a/*", True),
        ("a/b", "a/*", False),
        ("a/*", "a/**", False),
        ("a/**", "a/@b", False),
        ("**", "", False),
        ("**", "a//b", False),
    ],
)
def test_a_key_includes_what_is_no_wider(wide: str, narrow: str, expected: bool) -> None:
    assert includes(wide, narrow) is expected
