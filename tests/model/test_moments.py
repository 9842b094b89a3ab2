"""Moments as texts."""

from __future__ import annotations

from datetime import datetime, timedelta, timezone

import pytest

from selfconf.model.moments import parsed_moment


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("2026-11-27T13:05:00.5Z", datetime(2026, 11, 27, 13, 5, 0, 500_000, timezone.utc)),
        ("2026-11-27T13:05:00Z", datetime(2026, 11, 27, 13, 5, tzinfo=timezone.utc)),
        (
            "2026-11-27T13:05:00.1234567-01:30",
            datetime(2026, 11, 27, 13, 5, 0, 123_456, timezone(timedelta(hours=-1.5))),
        ),
        ("2026-11-27 13:05", datetime(2026, 11, 27, 13, 5)),
        ("2026-11-27", datetime(2026, 11, 27)),
    ],
)
def test_a_moment_is_read(text: str, moment: datetime) -> None:
    assert parsed_moment(text) == moment


@pytest.mark.parametrize("text", ["", "Z", "soon", "2026-11-31T00:00:00Z"])
def test_what_is_no_moment_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"isoformat|day"):
        parsed_moment(text)
