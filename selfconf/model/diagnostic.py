"""What is wrong with a file, and where: one value for each problem, however it was found and is
printed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum

UNREADABLE = frozenset(("SC-S01", "SC-S02", "SC-S03", "SC-S05"))
"""The codes of files that cannot be read: no Turtle, not UTF-8, not there, too deep."""


class Severity(str, Enum):
    """How much a problem weighs: an error keeps a file from conforming, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
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
    """What to try, where that can be told."""
    shape: str | None = None
    """The IRI of the SHACL shape that is violated, if it was one."""
    source: str = field(default="", compare=False)
    """The text of the line, to be shown under the message."""

    @property
    def order(self) -> tuple[str, int, int, str, str]:
        """The order of reports: by file, then by place, then by code."""
        return self.file, self.line, self.column, self.code, self.message


@dataclass(frozen=True, slots=True)
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


def report(files: Iterable[str], diagnostics: Iterable[Diagnostic]) -> Report:
    """Put problems in order, each once."""
    ordered = sorted(dict.fromkeys(diagnostics), key=lambda found: found.order)
    return Report(tuple(files), tuple(ordered))
