"""Numbers of seconds that something may take, or that it waits: one rule for arguments, options, files and records."""

from __future__ import annotations

from numbers import Real
from typing import TypeGuard

LONGEST_SECONDS = 1e6
"""Seconds that an alarm can be set to everywhere."""
LIMIT_IN_WORDS = f"a number of seconds above zero and at most {LONGEST_SECONDS:,.0f}"
DELAY_IN_WORDS = f"a number of seconds from 0 to {LONGEST_SECONDS:,.0f}"


def is_limit(seconds: object) -> TypeGuard[float]:
    """Whether it is a number of seconds that something may take."""
    return is_delay(seconds) and seconds > 0


def is_delay(seconds: object) -> TypeGuard[float]:
    """Whether it is a number of seconds after which something may be done; zero is at once."""
    if isinstance(seconds, bool) or not isinstance(seconds, Real):
        return False
    return seconds <= LONGEST_SECONDS and not seconds < 0
