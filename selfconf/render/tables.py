"""Tables and times in plain text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime


def duration(seconds: float) -> str:
    """How long something has lasted, in the two largest units: `12 s`, `3 min 5 s`, `2 h 4 min`, `5 d 1 h`."""
    whole = max(0, int(seconds))
    units = (("d", 86400), ("h", 3600), ("min", 60), ("s", 1))
    first = next((number for number, (_, size) in enumerate(units) if whole >= size), len(units) - 1)
    said: list[str] = []
    for unit, size in units[first : first + 2]:
        count_of, whole = divmod(whole, size)
        if count_of or not said:
            said.append(f"{count_of} {unit}")
    return " ".join(said)


def clock_time(seconds: float, *, exact: bool = False) -> str:
    """A moment, in seconds of the Unix epoch, as the clock here shows it: with the date, unless that is today's.

    `exact`: to the millisecond. What a stranger says may be beyond any date; then the seconds are shown.
    """
    try:
        moment = datetime.fromtimestamp(seconds).astimezone()
    except (OverflowError, OSError, ValueError):
        return f"{seconds:g} s"
    today = moment.date() == datetime.now().astimezone().date()
    shown = moment.strftime("%H:%M:%S" if today else "%Y-%m-%d %H:%M:%S")
    return f"{shown}.{moment.microsecond // 1000:03}" if exact else shown


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    styled: Callable[[str, str, str], str] = lambda column, cell, padded: padded,
) -> str:
    """A table with aligned columns and a line under its head.

    `styled` is what becomes of a cell, which it is given with the name of its column, bare and padded.
    """
    widths = [max(len(row[column]) for row in (head, *rows)) for column in range(len(head))]
    lines = [
        "  ".join(
            styled(name, cell, cell.ljust(width)) if row is not head else cell.ljust(width)
            for name, cell, width in zip(head, row, widths, strict=True)
        ).rstrip()
        for row in (head, *rows)
    ]
    return "\n".join((lines[0], "  ".join("-" * width for width in widths), *lines[1:]))
