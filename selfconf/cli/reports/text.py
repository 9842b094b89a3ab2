"""For people, editors and tools that read compiler output: one line for each problem, `file:line:column: error[CODE]:
message`.
"""

from __future__ import annotations

from selfconf.cli.terminal import paint
from selfconf.model.diagnostic import Diagnostic, Report, Severity
from selfconf.model.wording import counted, printable

_COLOURS = {Severity.ERROR: "red", Severity.WARNING: "yellow"}


def render(report: Report) -> str:
    """The problems in order, a line each; nothing if there are none."""
    return "".join(f"{found}\n" for found in report.diagnostics)


def illustrate(report: Report) -> str:
    """The problems for a terminal: in colour, with the line of the file underlined below each."""
    return "".join(f"{_coloured(found)}\n{_underlined(found)}" for found in report.diagnostics)


def summary(report: Report) -> str:
    """What became of all the files, in one sentence."""
    number = len(report.files)
    files = counted(number, "file")
    if not report.diagnostics:
        return f"{_conforming(files, number)}."
    kinds = (report.errors, "error"), (report.warnings, "warning")
    problems = " and ".join(counted(of_kind, kind) for of_kind, kind in kinds if of_kind)
    concerned = len({found.file for found in report.diagnostics}.intersection(report.files))
    return f"{problems} in {concerned} of {files}." if concerned else f"{problems}; {_conforming(files, number)}."


def _conforming(files: str, number: int) -> str:
    return f"{files} conform{'s' * (number == 1)}"


def _coloured(found: Diagnostic) -> str:
    return f"{found.where}: {paint(found.kind, _COLOURS[found.severity])}: {found.words}"


def _underlined(found: Diagnostic) -> str:
    if not found.source.strip():
        return ""
    number = f"{found.line:>5}"
    column = found.column - found.source_column + 1
    before = "".join("\t" if character == "\t" else " " for character in found.source[: column - 1])
    mark = "^" * max(1, min(found.width, len(found.source) - column + 1))
    below = f"{' ' * len(number)} | {before}{paint(mark, _COLOURS[found.severity])}"
    return f"{number} | {printable(found.source)}\n{below}\n"
