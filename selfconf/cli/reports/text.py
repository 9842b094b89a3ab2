"""For people, editors and tools that read compiler output: one line for each problem, `file:line:column: error[CODE]:
message`.
"""

from __future__ import annotations

from selfconf.cli.terminal import paint
from selfconf.model.diagnostic import Diagnostic, Report, Severity
from selfconf.model.wording import counted, one_line

_COLOURS = {Severity.ERROR: "red", Severity.WARNING: "yellow"}


def render(report: Report) -> str:
    """The problems in order, a line each; nothing if there are none."""
    return "".join(f"{line(found)}\n" for found in report.diagnostics)


def illustrate(report: Report) -> str:
    """The problems for a terminal: in colour, with the line of the file underlined below each."""
    return "".join(f"{_coloured(found)}\n{_underlined(found)}" for found in report.diagnostics)


def line(found: Diagnostic) -> str:
    """One problem on one line; the hint, if there is one, follows the message."""
    return f"{_place(found)}: {_kind(found)}: {_words(found)}"


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


def _place(found: Diagnostic) -> str:
    return f"{one_line(found.file)}:{found.line}:{found.column}"


def _kind(found: Diagnostic) -> str:
    return f"{found.severity.value}[{found.code}]"


def _words(found: Diagnostic) -> str:
    words = f"{found.message} {found.hint}" if found.hint else found.message
    return _visible(" ".join(words.split()))


def _coloured(found: Diagnostic) -> str:
    return f"{_place(found)}: {paint(_kind(found), _COLOURS[found.severity])}: {_words(found)}"


def _underlined(found: Diagnostic) -> str:
    if not found.source.strip():
        return ""
    number = f"{found.line:>5}"
    column = found.column - found.source_column + 1
    before = "".join("\t" if character == "\t" else " " for character in found.source[: column - 1])
    mark = "^" * max(1, min(found.width, len(found.source) - column + 1))
    below = f"{' ' * len(number)} | {before}{paint(mark, _COLOURS[found.severity])}"
    return f"{number} | {_visible(found.source)}\n{below}\n"


def _visible(words: str) -> str:
    """Without control characters: a file from somewhere must not steer the terminal that shows it."""
    return "".join(character if character == "\t" or character.isprintable() else "�" for character in words)
