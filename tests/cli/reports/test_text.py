"""Reports for people and editors: a line for each problem."""

from __future__ import annotations

import re

from selfconf.cli.reports import RENDERERS
from selfconf.cli.reports.text import illustrate
from selfconf.model.diagnostic import Diagnostic, report
from tests.cli.diagnosed import NASTY


def test_on_a_terminal_the_place_is_underlined() -> None:
    found = Diagnostic("a.ttl", 12, 3, "SC-A01", "No.", width=3, source="\tx:abc .\x1b[2J")
    plain = re.sub(r"\x1b\[[\d;]*m", "", illustrate(report(["a.ttl"], [found])))
    assert plain.splitlines()[1:] == ["   12 | \tx:abc .�[2J", "      | \t ^^^"]


def test_a_file_cannot_steer_the_terminal() -> None:
    assert "\x1b" not in RENDERERS["text"](NASTY)
