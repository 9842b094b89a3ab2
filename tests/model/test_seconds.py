"""Numbers of seconds: which may limit something, and which may pass before it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from selfconf.model.seconds import DELAY_IN_WORDS, LIMIT_IN_WORDS, LONGEST_SECONDS, is_delay, is_limit


@pytest.mark.parametrize("seconds", [1, 0.5, Fraction(1, 4), LONGEST_SECONDS])
def test_a_number_above_zero_is_a_limit_and_a_delay(seconds: object) -> None:
    assert is_limit(seconds)
    assert is_delay(seconds)


def test_zero_is_a_delay_and_no_limit() -> None:
    assert is_delay(0)
    assert not is_limit(0.0)


@pytest.mark.parametrize("seconds", [-1, 1e6 + 1, 10**400, float("nan"), float("inf"), True, "5", None, 1j])
def test_what_no_alarm_can_be_set_to_is_neither(seconds: object) -> None:
    assert not is_delay(seconds)
    assert not is_limit(seconds)


def test_the_words_name_the_bounds() -> None:
    assert LIMIT_IN_WORDS == "a number of seconds above zero and at most 1,000,000"
    assert DELAY_IN_WORDS == "a number of seconds from 0 to 1,000,000"
