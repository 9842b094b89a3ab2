"""What components print: kept line by line with time, component and stream, and shown; nothing waits for a terminal."""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.site import printed_lines
from selfconf.site.log_file import LogFile
from selfconf.site.printed_lines import CHUNK, LONGEST_LINE, PrintedLines

LINE = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z (\S+) (\S+) (.*)")


@pytest.fixture
def printed(tmp_path: Path) -> Iterator[PrintedLines]:
    """Lines that are kept in `home.log`."""
    made = PrintedLines(LogFile(tmp_path / "home.log"))
    yield made
    made.close()


def say(printed: PrintedLines, said: bytes, source: str = "urn:c", stream: str = "stdout") -> None:
    """Print something on a pipe of its own, and wait until it has been read."""
    ended = threading.Event()
    reading, writing = os.pipe()
    printed.follow(reading, stream, source, ended.set)
    with os.fdopen(writing, "wb") as pipe:
        pipe.write(said)
    assert ended.wait(10)


def kept(tmp_path: Path) -> list[tuple[str, ...]]:
    """Stream, component and text of each line."""
    found = [LINE.fullmatch(line) for line in (tmp_path / "home.log").read_text().split("\n")[:-1]]
    return [match.groups() if match else () for match in found]


def test_each_line_has_its_time_its_stream_and_its_component(printed: PrintedLines, tmp_path: Path) -> None:
    say(printed, b"12:00:01\n\n12:00:02\r\nno end", "urn:clock")
    say(printed, b"oh\n", "urn:a,urn:b", "stderr")
    printed.note("urn:clock", "has ended")
    printed.note("urn:clock", os.fsdecode(b"/h\xf6me is not there"))  # a name of a file that is no UTF-8
    printed.close()
    assert kept(tmp_path) == [
        ("stdout", "urn:clock", "12:00:01"),
        ("stdout", "urn:clock", ""),
        ("stdout", "urn:clock", "12:00:02"),
        ("stdout", "urn:clock", "no end"),
        ("stderr", "urn:a,urn:b", "oh"),
        ("site", "urn:clock", "has ended"),
        ("site", "urn:clock", "/h?me is not there"),
    ]


def test_what_steers_a_terminal_and_what_is_no_text_is_spelt_out(printed: PrintedLines, tmp_path: Path) -> None:
    say(printed, b"\x1b[2J \xff \xc3\xa9\t.\n")
    printed.close()
    assert kept(tmp_path) == [("stdout", "urn:c", "\\x1b[2J \\xff \u00e9\t.")]


def test_a_line_without_end_is_broken(printed: PrintedLines, tmp_path: Path) -> None:
    say(printed, b"x" * (3 * CHUNK))
    printed.close()
    found = kept(tmp_path)
    assert max(len(text) for _, _, text in found) <= LONGEST_LINE
    assert sum(len(text) for _, _, text in found) == 3 * CHUNK


def test_a_line_without_end_is_kept_before_it_ends(printed: PrintedLines, tmp_path: Path) -> None:
    reading, writing = os.pipe()
    printed.follow(reading, "stdout", "urn:c", lambda: None)
    os.write(writing, b"x" * (LONGEST_LINE + 1))
    say(printed, b"later\n")
    assert "x" in (tmp_path / "home.log").read_text()
    os.close(writing)


def test_a_character_that_comes_in_two_pieces_is_one(printed: PrintedLines, tmp_path: Path) -> None:
    ended = threading.Event()
    reading, writing = os.pipe()
    printed.follow(reading, "stdout", "urn:c", ended.set)
    for piece in (b"caf\xc3", b"\xa9\n"):
        os.write(writing, piece)
    os.close(writing)
    assert ended.wait(10)
    printed.close()
    assert kept(tmp_path) == [("stdout", "urn:c", "caf\u00e9")]


def test_lines_of_many_components_are_whole(printed: PrintedLines, tmp_path: Path) -> None:
    sayers = [
        threading.Thread(target=say, args=(printed, b"".join(b"%d-%d\n" % (one, n) for n in range(500)), f"urn:{one}"))
        for one in range(8)
    ]
    for sayer in sayers:
        sayer.start()
    for sayer in sayers:
        sayer.join()
    printed.close()
    found = kept(tmp_path)
    for one in range(8):
        assert [text for _, source, text in found if source == f"urn:{one}"] == [f"{one}-{n}" for n in range(500)]


def test_it_is_shown_besides_and_a_terminal_that_is_held_holds_up_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    terminal, stderr = os.pipe()
    monkeypatch.setattr(printed_lines, "STDERR", stderr)
    monkeypatch.setattr(printed_lines, "LAST_LINES", 0.1)
    printed = PrintedLines(LogFile(tmp_path / "home.log"))
    say(printed, b"first\n")
    assert os.read(terminal, 100) == b"first\n"
    for number in range(40):  # nobody reads the terminal any more
        say(printed, b"%03d" % number + b"x" * 20_000 + b"\n")
    printed.close()
    assert len({text[:3] for _, _, text in kept(tmp_path)}) >= 40
    os.close(terminal)  # the other end stays open: its number must not become that of another file


def test_without_a_log_lines_are_only_shown(capfd: pytest.CaptureFixture[str]) -> None:
    printed = PrintedLines(None)
    say(printed, b"hello\n")
    printed.note("urn:c", "started")
    printed.close()
    assert capfd.readouterr().err == "hello\n"


def test_who_prints_very_much_has_to_wait_and_others_do_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(printed_lines, "MOST_A_SECOND", CHUNK)
    monkeypatch.setattr(printed_lines, "LAST_LINES", 10.0)
    printed = PrintedLines(LogFile(tmp_path / "home.log"))
    ended, (reading, writing) = threading.Event(), os.pipe()
    printed.follow(reading, "stdout", "urn:much", ended.set)
    os.write(writing, b"much\n" * (4 * CHUNK // 5))
    say(printed, b"little\n", "urn:little")
    os.close(writing)
    assert not ended.wait(0.5)
    printed.close()
    found = kept(tmp_path)
    assert found.count(("stdout", "urn:much", "much")) == 4 * CHUNK // 5
    assert ("stdout", "urn:little", "little") in found


def test_who_has_printed_very_much_is_read_again_a_second_later(
    printed: PrintedLines, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(printed_lines, "MOST_A_SECOND", CHUNK)
    say(printed, b"much\n" * (3 * CHUNK // 5))


def test_nothing_is_done_while_nothing_is_printed(printed: PrintedLines, monkeypatch: pytest.MonkeyPatch) -> None:
    say(printed, b"hello\n")
    printed.note("urn:c", "started")
    looks = list[None]()
    say(printed, b"hello\n")  # what was said before is read by now
    monkeypatch.setattr(printed, "_read_again", lambda: looks.append(None))
    assert not threading.Event().wait(0.1)
    assert len(looks) <= 1
