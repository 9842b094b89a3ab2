"""Tables, counts and times in plain text."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest

from selfconf.render import clock_time, duration, table


def test_the_columns_of_a_table_are_as_wide_as_their_widest_cell() -> None:
    assert table(["name", "n"], [["a", "1"], ["longer", "20"]]).splitlines() == [
        "name    n",
        "------  --",
        "a       1",
        "longer  20",
    ]


def test_a_table_without_rows_is_its_head() -> None:
    assert table(["name", "n"], []) == "name  n\n----  -"


def test_no_line_ends_with_blanks() -> None:
    assert all(line == line.rstrip() for line in table(["a", "b"], [["1", ""], ["22", ""]]).splitlines())


def test_a_row_with_a_cell_too_many_is_no_row() -> None:
    with pytest.raises(ValueError, match="argument"):
        table(["a"], [["1", "2"]])


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (-1, "0 s"),
        (0.9, "0 s"),
        (59, "59 s"),
        (60, "1 min"),
        (185, "3 min 5 s"),
        (7440, "2 h 4 min"),
        (435600, "5 d 1 h"),
    ],
)
def test_a_duration_has_its_two_largest_units(seconds: float, words: str) -> None:
    assert duration(seconds) == words


def test_a_moment_of_another_day_has_its_date_and_one_beyond_any_date_its_seconds() -> None:
    now = datetime.now().astimezone()
    assert clock_time(now.timestamp()) in (now.strftime("%H:%M:%S"), now.strftime("%Y-%m-%d %H:%M:%S"))
    before = now - timedelta(days=3)
    assert clock_time(before.timestamp()) == before.strftime("%Y-%m-%d %H:%M:%S")
    assert (
        clock_time(before.timestamp(), exact=True)
        == f"{clock_time(before.timestamp())}.{before.microsecond // 1000:03}"
    )
    assert clock_time(1e300) == clock_time(1e300, exact=True) == "1e+300 s"


def test_cells_may_be_styled_without_a_change_of_their_widths() -> None:
    shown = table(
        ["a", "state"], [["x", "up"]], lambda column, cell, padded: padded.upper() if cell == "up" else padded
    )
    assert shown.splitlines()[-1] == "x  UP"
