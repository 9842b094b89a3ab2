"""What a terminal shows while something takes long: a line that is gone afterwards, and nothing before or elsewhere."""

from __future__ import annotations

import threading
import time
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import TextIO

import pytest

from selfconf.cli import progress as module
from selfconf.cli.main import main
from selfconf.cli.progress import ProgressLine, progress
from selfconf.cli.run import MAY_TAKE_LONG
from selfconf.cli.terminal import Terminal
from selfconf.model.run_event import EcologyAsked, EcologyDiscovered
from tests.harness.frozen import nothing_frozen

PATIENCE = 20.0


class Screen(StringIO):
    """What a terminal shows, which may be held."""

    held = False

    def write(self, text: str) -> int:
        """Show a text, once the terminal is not held any more."""
        while self.held:
            time.sleep(0.01)
        return super().write(text)

    def shows(self, text: str) -> bool:
        """Whether it comes to show a text."""
        end = time.monotonic() + PATIENCE
        while text not in self.getvalue() and time.monotonic() < end:
            time.sleep(0.01)
        return text in self.getvalue()


def shown_on(stream: TextIO, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let standard error be a stream, for progress alone: pytest sets the true one anew before each test."""
    monkeypatch.setattr(module, "sys", SimpleNamespace(stderr=stream))


@pytest.fixture
def screen(monkeypatch: pytest.MonkeyPatch) -> Screen:
    screen = Screen()
    shown_on(Terminal(screen), monkeypatch)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(module, "SHOWN_AFTER", 0.0)
    monkeypatch.setattr(module, "RENEWED_EACH", 0.01)
    return screen


def test_what_takes_long_is_shown_in_a_line_that_is_gone_afterwards(screen: Screen) -> None:
    with progress("searching for \x1b[31ma configuration"):
        assert screen.shows("\r\x1b[2Ksearching for \\x1b[31ma configuration, 0 s so far; Ctrl-C ends it")
    assert screen.getvalue().endswith("Ctrl-C ends it\r\x1b[2K")


def test_what_comes_next_takes_the_place_of_what_was_before(screen: Screen) -> None:
    with ProgressLine() as shown:
        shown.begin("asking")
        assert screen.shows("asking, ")
        shown.begin("searching")
        assert screen.shows("searching, ")
        shown.end()
        assert screen.getvalue().endswith("\r\x1b[2K")
        before = screen.getvalue()
    assert screen.getvalue() == before


def test_what_breaks_or_is_interrupted_leaves_no_line(screen: Screen) -> None:
    def interrupted() -> None:
        assert screen.shows("searching, ")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), progress("searching"):
        interrupted()
    assert screen.getvalue().endswith("\r\x1b[2K")


def test_what_is_over_soon_is_not_shown(screen: Screen, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "SHOWN_AFTER", PATIENCE)
    with progress("searching"):
        pass
    assert screen.getvalue() == ""


def test_no_thread_shows_anything_while_it_is_paused(screen: Screen, monkeypatch: pytest.MonkeyPatch) -> None:
    with ProgressLine() as shown:
        shown.begin("validating")
        assert screen.shows("validating, 0 s so far")
        with shown.paused():
            assert screen.getvalue().endswith("\r\x1b[2K")
            assert "progress" not in [thread.name for thread in threading.enumerate()]
            monkeypatch.setattr(module.time, "monotonic", lambda now=time.monotonic: now() + 60)
        assert screen.shows("validating, 60 s so far")
    with shown.paused():
        pass
    assert shown._showing is None


def test_a_file_a_program_and_a_simple_terminal_are_shown_nothing(
    screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TERM", "dumb")
    with progress("searching") as _, ProgressLine() as shown:
        shown.begin("searching")
        assert shown._showing is None
    monkeypatch.setenv("TERM", "xterm")
    shown_on(screen, monkeypatch)  # of which nothing says that it is a terminal
    with ProgressLine() as shown:
        shown.begin("searching")
        assert shown._showing is None
    assert screen.getvalue() == ""


TASK = "examples/clock/tell-the-time.ttl", "--ads", "examples/clock"


@pytest.mark.parametrize(
    ("command", "what"),
    [
        (("configure", *TASK), ["looking which components are eligible", "searching for a configuration"]),
        (("partition", *TASK), ["looking which components are eligible"]),
        (
            ("partition", *TASK, "--why"),
            [
                "looking which components are eligible",
                "computing what configurations with each candidate would cost",
            ],
        ),
        (("validate", "examples/clock"), ["validating"]),
    ],
)
def test_commands_that_may_take_long_say_what_they_do(
    command: tuple[str, ...], what: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    said = list[str]()
    monkeypatch.chdir(Path(__file__).parents[2])
    monkeypatch.setattr(ProgressLine, "begin", lambda _, what: said.append(what))
    with nothing_frozen():
        assert main(command) == 0
    assert said == what


def test_a_run_says_what_it_does_after_events_that_there_are() -> None:
    assert MAY_TAKE_LONG.keys() == {EcologyAsked.act, EcologyDiscovered.act}


def test_a_terminal_that_is_held_holds_nothing_up(screen: Screen, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "HELD", 0.01)
    screen.held = True
    with progress("searching"):
        pass
    screen.held = False
    assert screen.shows("\r\x1b[2K")
