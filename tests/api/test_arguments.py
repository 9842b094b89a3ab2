"""One path is not taken for its letters, a word that is no option is answered with those that are, limits count."""

from __future__ import annotations

from enum import Enum
from fractions import Fraction
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from selfconf.api.arguments import (
    checked_choice,
    checked_delay,
    checked_flag,
    checked_moment,
    checked_path,
    checked_priority,
    checked_rows,
    checked_seconds,
    checked_seconds_limit,
    checked_steps,
    checked_text,
    checked_upgrade,
    listed_endpoints,
    listed_paths,
)
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.seconds import LONGEST_SECONDS


class Colour(Enum):
    """A choice."""

    RED = "red"
    BLUE = "blue"


def test_one_path_is_a_list_of_one() -> None:
    assert listed_paths("examples") == ["examples"]
    assert listed_paths(Path("examples")) == [Path("examples")]
    assert listed_paths(path for path in ("a", Path("b"))) == ["a", Path("b")]


def test_one_endpoint_is_a_list_of_one() -> None:
    assert listed_endpoints("tcp/127.0.0.1:1") == ["tcp/127.0.0.1:1"]
    assert listed_endpoints(f"tcp/127.0.0.1:{port}" for port in (1, 2)) == ["tcp/127.0.0.1:1", "tcp/127.0.0.1:2"]
    for endpoints in (None, 5, b"tcp", [b"tcp"]):
        with pytest.raises(ProgrammerError, match=r"^endpoints are one or several, as text, not "):
            listed_endpoints(endpoints)  # type: ignore[arg-type]  # that is what is tested


def test_an_upgrade_comes_after_some_seconds_or_never() -> None:
    assert [checked_upgrade(one) for one in (None, 0, 0.5)] == [None, 0.0, 0.5]
    wrong: tuple[Any, ...] = (-1, float("nan"), float("inf"), True, "5")
    for seconds in wrong:
        with pytest.raises(ProgrammerError, match=r"^an upgrade comes after a number of seconds from 0 to 1,000,000"):
            checked_upgrade(seconds)


def test_a_word_is_an_option_or_is_answered_with_the_options() -> None:
    assert checked_choice(Colour, "colour", "red") is Colour.RED
    with pytest.raises(ProgrammerError) as error:
        checked_choice(Colour, "colour", "green")
    assert str(error.value) == "there is no colour 'green'; choose one of 'red', 'blue'"


@pytest.mark.parametrize(
    ("path", "why"),
    [
        ("", "the current folder is"),
        ("a\0b", "no null character"),
        ("a" * 300, "File name too long"),
        (":a a :b .\n" * 99, "not the text of a document; write it into a file"),
        (":a a :b .\n", "not the text of a document; write it into a file"),
    ],
)
def test_a_text_that_names_no_path_is_refused_in_a_sentence(path: str, why: str) -> None:
    for call in (checked_path, listed_paths):
        with pytest.raises(AuthorError, match=why):
            call(path)
    assert (checked_path("a"), checked_path(Path())) == (Path("a"), Path())
    with pytest.raises(ProgrammerError, match=r"^a path is text or a Path, not 42$"):
        checked_path(42)  # type: ignore[arg-type]  # that is what is tested


def test_texts_and_flags_are_what_they_are_called() -> None:
    assert (checked_text("a", "a name"), checked_flag(True, "wait")) == ("a", True)
    for text in (None, 3, b"a"):
        with pytest.raises(ProgrammerError, match=r"^a name is text, not "):
            checked_text(text, "a name")  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(AuthorError, match=r"^a name is no text in UTF-8: '\\udcff'$"):
        checked_text("\udcff", "a name")
    for flag in ("no", 1, None):
        with pytest.raises(ProgrammerError, match=r"^wait is True or False, not "):
            checked_flag(flag, "wait")  # type: ignore[arg-type]  # that is what is tested


@pytest.mark.parametrize("rows", [0, -1, 1.5, True, "x", None])
def test_rows_are_a_number_above_zero(rows: Any) -> None:
    assert checked_rows(1) == 1
    with pytest.raises(ProgrammerError, match=r"^rows are a whole number above zero, not "):
        checked_rows(rows)


@pytest.mark.parametrize("seconds", [0, float("nan"), "x", None])
def test_an_answer_has_a_limit_of_seconds(seconds: Any) -> None:
    assert checked_seconds(0.5) == 0.5
    with pytest.raises(ProgrammerError, match=r"^seconds are a number above zero and at most 1,000,000, not "):
        checked_seconds(seconds)


@pytest.mark.parametrize("moment", ["x", float("nan"), float("inf"), True])
def test_a_moment_is_a_number_or_now(moment: Any) -> None:
    assert (checked_moment(None), checked_moment(5)) == (None, 5.0)
    with pytest.raises(ProgrammerError, match=r"^a moment is a number of seconds of the Unix epoch"):
        checked_moment(moment)


@pytest.mark.parametrize("paths", [None, 5, b"examples", [None], ["examples", 5], StringIO("examples")])
def test_what_is_no_path_is_refused_in_a_sentence(paths: Any) -> None:
    with pytest.raises(ProgrammerError, match=r"^paths are one path or several, as text or as Path, not "):
        listed_paths(paths)


def test_limits_are_numbers_above_zero_or_none() -> None:
    assert (checked_steps(None), checked_steps(1)) == (None, 1)
    assert (checked_seconds_limit(None), checked_seconds_limit(1), checked_seconds_limit(0.5)) == (None, 1.0, 0.5)
    assert checked_seconds_limit(Fraction(1, 4)) == 0.25  # type: ignore[arg-type]  # a number too, when it runs
    assert checked_seconds_limit(LONGEST_SECONDS) == LONGEST_SECONDS


@pytest.mark.parametrize("steps", [0, -1, 1.5, 1.0, True, "5"])
def test_what_is_no_number_of_steps_is_refused_in_a_sentence(steps: Any) -> None:
    with pytest.raises(ProgrammerError, match=r"^steps are a whole number above zero, or None for no limit, not "):
        checked_steps(steps)


@pytest.mark.parametrize("priority", [10**6 + 1, -(10**23), 1.0, True, "5", None])
def test_what_is_no_priority_is_refused_in_a_sentence(priority: Any) -> None:
    assert [checked_priority(one) for one in (-(10**6), 0, 10**6)] == [-(10**6), 0, 10**6]
    with pytest.raises(ProgrammerError, match=r"^a priority is a whole number from -1000000 to 1000000, not "):
        checked_priority(priority)


def test_simulated_seconds_are_none_or_more() -> None:
    assert (checked_delay(0), checked_delay(0.5)) == (0.0, 0.5)
    with pytest.raises(ProgrammerError, match=r"^simulated seconds are a number from 0 to 1,000,000, not nan$"):
        checked_delay(float("nan"))


@pytest.mark.parametrize("seconds", [0, -1, float("nan"), float("inf"), 1e300, True, "5"])
def test_what_is_no_time_is_refused_in_a_sentence(seconds: Any) -> None:
    with pytest.raises(ProgrammerError, match=r"^seconds are a number above zero and at most 1,000,000, or None "):
        checked_seconds_limit(seconds)
