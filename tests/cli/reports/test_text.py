"""Reports for people and editors: a line for each problem."""

from __future__ import annotations

import re

import pytest

from selfconf.cli.reports import RENDERERS
from selfconf.cli.reports.text import illustrate, summary
from selfconf.model.diagnostic import Diagnostic, Severity, report
from tests.cli.diagnosed import NASTY


def test_on_a_terminal_the_place_is_underlined() -> None:
    found = Diagnostic("a.ttl", 12, 3, "SC-A01", "No.", width=3, source="\tx:abc .\x1b[2J")
    plain = re.sub(r"\x1b\[[\d;]*m", "", illustrate(report(["a.ttl"], [found])))
    assert plain.splitlines() == ["a.ttl:12:3: error[SC-A01]: No.", "   12 | \tx:abc .�[2J", "      | \t ^^^"]


def test_a_file_cannot_steer_the_terminal() -> None:
    assert "\x1b" not in RENDERERS["text"](NASTY)


ERROR = Diagnostic("a.ttl", 12, 3, "SC-A01", "No.", hint="Try.")
WARNING = Diagnostic("a.ttl", 12, 3, "SC-L02", "Well.", Severity.WARNING)
ELSEWHERE = Diagnostic("empty", 1, 1, "SC-S04", "Nothing.", Severity.WARNING)


def test_a_problem_is_one_line_with_its_hint_whatever_is_in_it() -> None:
    assert str(ERROR) == "a.ttl:12:3: error[SC-A01]: No. Try."
    assert (
        str(Diagnostic("a.ttl", 1, 1, "SC-A01", "two\nlines\t and \x07")) == "a.ttl:1:1: error[SC-A01]: two lines and �"
    )
    assert str(Diagnostic("a\n::b\x1b.ttl", 1, 1, "SC-A01", "No.")) == r"a\n::b\x1b.ttl:1:1: error[SC-A01]: No."
    assert RENDERERS["text"](report(["a.ttl"], [WARNING, ERROR])).splitlines() == [str(ERROR), str(WARNING)]


@pytest.mark.parametrize(
    ("files", "found", "said"),
    [
        ([], [], "0 files conform."),
        (["a.ttl"], [], "1 file conforms."),
        (["a.ttl", "b.ttl"], [ERROR], "1 error in 1 of 2 files."),
        (["a.ttl"], [ERROR, WARNING], "1 error and 1 warning in 1 of 1 file."),
        (["a.ttl"], [ELSEWHERE], "1 warning; 1 file conforms."),
    ],
)
def test_a_summary_counts_problems_and_files(files: list[str], found: list[Diagnostic], said: str) -> None:
    assert summary(report(files, found)) == said
