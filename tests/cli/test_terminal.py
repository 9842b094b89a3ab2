"""Writing on a terminal: what would steer it is spelt out, and everything else stays as it is."""

from __future__ import annotations

import os
import sys
from io import StringIO

import pytest

from selfconf.cli.terminal import Terminal, guard, plain, show


def test_what_steers_is_spelt_out_and_what_does_not_stays() -> None:
    assert plain("a\tb\nä 日本 ✓") == "a\tb\nä 日本 ✓"
    assert plain("\x1b[2J\r\x07\x9b1m\u202edrow") == r"\x1b[2J\r\x07\x9b1m\u202edrow"


def test_only_a_terminal_is_guarded_and_only_once(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs = os.openpty()
    with os.fdopen(theirs, "w") as terminal, os.fdopen(ours, "rb", buffering=0) as screen, StringIO() as nothing:
        monkeypatch.setattr(sys, "stdout", terminal)
        monkeypatch.setattr(sys, "stderr", nothing)
        guard()
        guard()
        assert sys.stderr is nothing
        assert isinstance(sys.stdout, Terminal)
        assert sys.stdout.fileno() == terminal.fileno()
        print("red \x1b[31m", flush=True)
        assert screen.read(100) == b"red \\x1b[31m\r\n"


def test_what_nobody_reads_ends_nothing_and_what_cannot_be_encoded_is_escaped(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs = os.pipe()
    with os.fdopen(theirs, "w", encoding="utf-8", errors="strict") as pipe:
        monkeypatch.setattr(sys, "stdout", pipe)
        monkeypatch.setattr(sys, "stderr", None)
        guard()
        show("file \udcff")
        assert os.read(ours, 100) == b"file \\udcff\n"
        os.close(ours)
        show("more than is read")
        show("and yet more")
        with sys.stderr as nowhere:
            show("nothing", nowhere)
