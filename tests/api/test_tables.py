"""A table prints a screen at most, each cell on a line, and steers nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from selfconf.api.tables import LONGEST_TABLE, WIDEST_CELL, Tabular


class Numbers(Tabular):
    """Rows that know how many of them were made."""

    def __init__(self, count: int, cell: str = "x") -> None:
        self.count, self.cell, self.made = count, cell, 0

    def _head(self) -> Sequence[str]:
        return "number", "cell"

    def _cells(self) -> Iterator[list[str]]:
        for number in range(self.count):
            self.made += 1
            yield [str(number), self.cell]


def test_no_more_rows_are_made_than_are_printed() -> None:
    million = Numbers(1_000_000)
    assert repr(million).splitlines()[-1] == f"... only the first {LONGEST_TABLE} are shown"
    assert million.made == LONGEST_TABLE + 1
    assert "only the first" in million._repr_html_()
    assert "only the first" not in repr(Numbers(LONGEST_TABLE))


def test_a_long_cell_is_cut_and_one_of_several_lines_is_one_line() -> None:
    assert repr(Numbers(1, "a" * 10_000)).splitlines()[-1].endswith("a…")
    assert max(map(len, repr(Numbers(1, "a" * 10_000)).splitlines())) < WIDEST_CELL + 20
    assert repr(Numbers(1, "a\nb\tc")).splitlines()[-1] == "0       a\\nb\\tc"


def test_control_characters_are_spelt_out_and_html_is_escaped() -> None:
    hostile = Numbers(1, "\x1b[2J\u202e<script>")
    assert repr(hostile).splitlines()[-1] == "0       \\x1b[2J\\u202e<script>"
    assert "<script>" not in hostile._repr_html_()
