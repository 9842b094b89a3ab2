"""What is wrong with a file, and where: one value for each problem, however it was found and is
printed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from enum import Enum

from selfconf.model.immutable import immutable
from selfconf.model.wording import one_line, printable

LONGEST_SOURCE = 240
"""Characters of a line that are shown: a file on one line may have a million problems, all of them on that line."""
BEFORE = 80
"""How many characters of what is shown of a line stand before the place."""
LONGEST_SAID = 1_000
"""Characters of a message or hint, which may quote what an author wrote."""
UNREADABLE = frozenset(("SC-S01", "SC-S02", "SC-S03", "SC-S05", "SC-P01"))
"""The codes of files that cannot be read: no Turtle, not UTF-8, not there, too deep; no TOML."""


class Severity(str, Enum):
    """How much a problem weighs: an error keeps a file from conforming, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


@immutable
class Diagnostic:
    """One problem in one file; line and column count from one, the width from there is counted in characters."""

    file: str
    line: int
    column: int
    code: str
    message: str
    """One sentence for people."""
    severity: Severity = Severity.ERROR
    width: int = 1
    hint: str | None = None
    """What to try, where that is known."""
    shape: str | None = None
    """The IRI of the SHACL shape that is violated, if it was one."""
    source: str = field(default="", compare=False)
    """The text of the line around the place, to be shown under the message."""
    source_column: int = field(default=1, compare=False)
    """The column at which that text begins; in a long line there is more before it, and after it."""

    @property
    def order(self) -> tuple[str, int, int, str, str]:
        """The order of reports: by file, then by place, then by code."""
        return self.file, self.line, self.column, self.code, self.message

    @property
    def where(self) -> str:
        """The place, as compilers write it: `file:line:column`."""
        return f"{one_line(self.file)}:{self.line}:{self.column}"

    @property
    def kind(self) -> str:
        """The severity and the code: `error[CODE]`."""
        return f"{self.severity.value}[{self.code}]"

    @property
    def words(self) -> str:
        """The message on one line; the hint, if there is one, follows it."""
        words = f"{self.message} {self.hint}" if self.hint else self.message
        return printable(" ".join(words.split()))

    def __str__(self) -> str:
        return f"{self.where}: {self.kind}: {self.words}"


@immutable
class Report:
    """The problems of several files, in order."""

    files: tuple[str, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def unreadable(self) -> frozenset[str]:
        """The files that cannot be read, so that nothing else is known of them."""
        return frozenset(found.file for found in self.diagnostics if found.code in UNREADABLE)

    @property
    def errors(self) -> int:
        """How many problems are errors."""
        return sum(found.severity is Severity.ERROR for found in self.diagnostics)

    @property
    def warnings(self) -> int:
        """How many problems are warnings."""
        return len(self.diagnostics) - self.errors

    @property
    def conforms(self) -> bool:
        """Whether no file has an error."""
        return not self.errors


def excerpt(text: str, begin: int, end: int, column: int) -> tuple[str, int]:
    """Of the line between two offsets of a text what is shown for a column, and the column at which that begins."""
    start = begin if end - begin <= LONGEST_SOURCE else begin + max(0, column - 1 - BEFORE)
    return text[start : min(end, start + LONGEST_SOURCE)].rstrip("\r\n"), start - begin + 1


def shortened(words: str) -> str:
    """A message with its middle left out, where it is too long to be read."""
    half = LONGEST_SAID // 2
    return words if len(words) <= LONGEST_SAID else f"{words[:half]} ... {words[-half:]}"


def report(files: Iterable[str], diagnostics: Iterable[Diagnostic]) -> Report:
    """Put problems in order, each once."""
    ordered = sorted(dict.fromkeys(diagnostics), key=lambda found: found.order)
    return Report(tuple(files), tuple(ordered))
