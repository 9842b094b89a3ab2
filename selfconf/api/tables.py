"""Values that print as a table: as text in a terminal, as HTML in a notebook, a screen of either at most."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from itertools import islice

from selfconf.model.wording import plain
from selfconf.render import html_table, html_text, table

LONGEST_TABLE = 60
"""How many rows are printed; the value itself has them all."""
WIDEST_CELL = 120
"""How many characters of a cell are printed."""


class Tabular(ABC):
    """A value that prints as a table. What strangers wrote cannot steer a terminal, nor a page."""

    __slots__ = ()

    @abstractmethod
    def _head(self) -> Sequence[str]:
        """The names of the columns."""

    @abstractmethod
    def _cells(self) -> Iterable[Sequence[str]]:
        """The rows in order; no more are made than are printed."""

    def _printed(self) -> tuple[list[list[str]], str]:
        """The rows that are printed, and a remark where there are more."""
        rows = [[_cut(cell) for cell in row] for row in islice(self._cells(), LONGEST_TABLE + 1)]
        more = f"... only the first {LONGEST_TABLE} are shown" if len(rows) > LONGEST_TABLE else ""
        return rows[:LONGEST_TABLE], more

    def __repr__(self) -> str:
        rows, remark = self._printed()
        return "\n".join(filter(None, (table(self._head(), rows), remark)))

    def _repr_html_(self) -> str:
        rows, remark = self._printed()
        return html_table(self._head(), rows) + (html_text(remark) if remark else "")


def _cut(cell: str) -> str:
    """The text of a cell on one line, without what would steer a terminal."""
    line = plain(cell).replace("\n", "\\n").replace("\t", "\\t")
    return line if len(line) <= WIDEST_CELL else f"{line[: WIDEST_CELL - 1]}…"
