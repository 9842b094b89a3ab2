"""Writing on a terminal: what would steer it is spelt out, and everything else stays as it is."""

from __future__ import annotations

import fcntl
import os
import struct
import subprocess
import sys
import termios
from collections.abc import Sequence
from io import BytesIO, StringIO, TextIOWrapper
from pathlib import Path

import pytest

from selfconf.cli.main import main
from selfconf.cli.terminal import Terminal, display, display_json, guard, in_colour, paint, plain
from tests.harness.frozen import nothing_frozen
from tests.lab import PREFIXES

pytestmark = pytest.mark.process


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


def test_a_terminal_that_is_gone_is_let_go_of() -> None:
    """As Python ends, what stands for the terminal may be the last to be closed."""
    there = StringIO()
    terminal = Terminal(there)
    there.close()
    terminal.close()
    assert terminal.closed


def test_a_terminal_that_was_closed_is_a_reader_that_has_gone() -> None:
    """As where its window is closed: what ends for that has not failed."""
    ours, theirs = os.openpty()
    stream = os.fdopen(theirs, "w")
    terminal = Terminal(stream)
    os.close(ours)
    with pytest.raises(BrokenPipeError):
        print("a line", file=terminal, flush=True)
    display("another line", terminal)  # which lets what is still to be written come to nothing
    stream.close()


def test_what_nobody_reads_ends_nothing_and_what_cannot_be_encoded_is_escaped(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs = os.pipe()
    with os.fdopen(theirs, "w", encoding="utf-8", errors="strict") as pipe:
        monkeypatch.setattr(sys, "stdout", pipe)
        monkeypatch.setattr(sys, "stderr", None)
        guard()
        display("file \udcff")
        assert os.read(ours, 100) == b"file \\udcff\n"
        os.close(ours)
        display("more than is read")
        display("and yet more")
        with sys.stderr as nowhere:
            display("nothing", nowhere)


def test_letters_of_every_script_are_letters_in_json(capsys: pytest.CaptureFixture[str]) -> None:
    display_json({"lämp": ["灯"]})
    assert capsys.readouterr().out == '{\n  "lämp": [\n    "灯"\n  ]\n}\n'


def test_what_programs_read_is_utf_8_whatever_the_terminal_would_have(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked_here: pytest.MonkeyPatch
) -> None:
    (tmp_path / "lamp.ttl").write_text(PREFIXES + ":lämp a sc:Component, :Lamp .", encoding="utf-8")
    role = ":r a sc:Role ; sh:class :Lamp ."
    (tmp_path / "t.ttl").write_text(f"{PREFIXES} :t a sc:Template ; sc:roles ( :r ) . {role}", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    lamps = "query", "SELECT ?c WHERE { ?c a sc:Component }", "--ads", "lamp.ttl"
    configured = "configure", "t.ttl", "--ads", "lamp.ttl"

    def written(*command: str) -> bytes:
        """What a command writes where Python writes ASCII."""
        buffer = BytesIO()
        with monkeypatch.context() as patch, nothing_frozen():
            patch.setattr(sys, "stdout", TextIOWrapper(buffer, encoding="ascii"))
            assert main(command) == 0
            sys.stdout.flush()
            return buffer.getvalue()

    for command, forms in ((lamps, ("json", "csv", "tsv")), (configured, ("json", "turtle", "mermaid"))):
        for form in forms:
            assert "lämp" in written(*command, "--format", form).decode(), form
        assert b"l\\xe4mp" in written(*command)
    for form, name in ((("--format", "json"), "lämp".encode()), ((), b"l\\xe4mp")):
        started, environment = [sys.executable, "-m", "selfconf", *configured, *form], {"PYTHONIOENCODING": "ascii"}
        done = subprocess.run(started, env={**os.environ, **environment}, capture_output=True, check=True)
        assert name in done.stdout, "a process writes the same"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no device that is always full")
@pytest.mark.parametrize(
    ("words", "speaker"),
    [
        (("query", "ASK {}", "--ads", "lamp.ttl"), "selfconf query"),
        (("query", "--help"), "selfconf query"),
        (("--help",), "selfconf"),
        (("--version",), "selfconf"),
    ],
    ids=" ".join,
)
def test_what_the_system_says_is_told_without_its_number(tmp_path: Path, words: Sequence[str], speaker: str) -> None:
    (tmp_path / "lamp.ttl").write_text(PREFIXES + ":lamp a sc:Component, :Lamp .")
    command = [sys.executable, "-m", "selfconf", *words]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, f"{speaker}: No space left on device\n")


def test_only_a_terminal_gets_colours_and_only_from_paint(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert paint("bad", "red") == "bad"
    ours, theirs = os.openpty()
    with os.fdopen(theirs, "w") as terminal, os.fdopen(ours, "rb", buffering=0) as screen:
        monkeypatch.setattr(sys, "stdout", Terminal(terminal))
        print(paint("bad", "red"), "\x1b[31m", paint("", "red"), flush=True)
        assert screen.read(100) == b"\x1b[1;31mbad\x1b[0m \\x1b[31m \r\n"
        assert paint("plain", "") == "plain"
        for name, value in (("NO_COLOR", "1"), ("TERM", "dumb")):
            with monkeypatch.context() as patch:
                patch.setenv(name, value)
                assert not in_colour()
                assert paint("bad", "red") == "bad"


@pytest.mark.parametrize(("columns", "shown"), [(20, b"searching for a con"), (0, b"searching for a configuration")])
def test_a_line_that_is_renewed_stays_one_on_a_narrow_terminal(columns: int, shown: bytes) -> None:
    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with os.fdopen(theirs, "w") as terminal, os.fdopen(ours, "rb", buffering=0) as screen:
        Terminal(terminal).renew_line("searching for a configuration")
        assert screen.read(100) == b"\r\x1b[2K" + shown


def test_a_screen_is_renewed_as_a_whole() -> None:
    ours, theirs = os.openpty()
    with os.fdopen(theirs, "w") as terminal, os.fdopen(ours, "rb", buffering=0) as screen:
        Terminal(terminal).renew("new\x1b[2J\n")
        assert screen.read(100) == b"\x1b[H\x1b[2Jnew\\x1b[2J\r\n"
