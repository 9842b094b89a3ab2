"""Moments as ISO 8601 and xsd:dateTime write them, read alike by every Python that selfconf runs on."""

from __future__ import annotations

import re
from datetime import datetime

_FRACTION = re.compile(r"\.(\d+)")
_MICROSECONDS = 6
"""Digits of a fraction of a second that a datetime has."""


def parsed_moment(text: str) -> datetime:
    """The moment that a text such as `2026-11-27T13:05:00.5Z` names. Raises ValueError.

    Python 3.10 reads no Z, and of a fraction of a second three digits or six alone.
    """
    whole = _FRACTION.sub(lambda found: f".{found[1][:_MICROSECONDS]:0<{_MICROSECONDS}}", text, count=1)
    return datetime.fromisoformat(f"{whole[:-1]}+00:00" if whole.endswith("Z") else whole)
