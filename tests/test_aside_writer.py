"""What a program says to people: a terminal that is held holds up nothing else."""

from __future__ import annotations

import logging
import os
import threading
from functools import partial

import pytest

from selfconf.aside_writer import AsideHandler, AsideWriter, write_bytes, write_line


def test_what_is_said_is_written_in_its_order_and_all_of_it_by_the_end() -> None:
    written: list[str] = []
    writer = AsideWriter(written.append, str)
    for number in range(100):
        writer.put(str(number))
    writer.close()
    assert written == [*map(str, range(100))]


def test_who_says_something_waits_for_no_reader_and_what_is_left_out_is_counted() -> None:
    written: list[str] = []
    held, holding = threading.Event(), threading.Event()

    def write(piece: str) -> None:
        holding.set()
        assert held.wait(10)
        written.append(piece)

    writer = AsideWriter(write, str, most=3)
    writer.put("first")
    assert holding.wait(10)
    for number in range(10):
        writer.put(str(number))
    held.set()
    writer.close()
    assert written == ["first", "0", "1", "2"]
    writer.put("and")
    writer.close()
    assert written[4:] == ["(7 pieces of output were left out here)", "and"]


def test_a_reader_that_never_reads_does_not_keep_a_program_from_its_end() -> None:
    reading, writing = os.pipe()
    writer = AsideWriter(partial(write_bytes, writing), str.encode, last_words=0.05)
    for _ in range(3):
        writer.put(b"x" * 200_000)
    writer.close()
    os.close(reading)


def test_a_reader_that_has_gone_breaks_nothing() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    writer = AsideWriter(partial(write_bytes, writing), str.encode)
    for _ in range(3):
        writer.put(b"x")
    writer.close()
    os.close(writing)


def test_a_line_steers_no_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    write_line("a \x1b[2J b")
    assert capfd.readouterr().err == "a \\x1b[2J b\n"


def test_where_stderr_is_no_file_a_line_is_written_all_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    write_line("said")
    assert capsys.readouterr().err == "said\n"


def test_a_log_is_written_aside_with_tracebacks(capfd: pytest.CaptureFixture[str]) -> None:
    handler = AsideHandler("%(name)s: %(message)s")
    log = logging.getLogger("tests.aside")
    log.addHandler(handler)
    try:
        raise ValueError("why")
    except ValueError:
        log.exception("%s broke", "it")
    log.removeHandler(handler)
    handler.close()
    said = capfd.readouterr().err
    assert said.startswith("tests.aside: it broke\nTraceback")
    assert said.endswith("ValueError: why\n")


def test_what_cannot_be_worded_breaks_nobody_s_work(capsys: pytest.CaptureFixture[str]) -> None:
    handler = AsideHandler("%(message)s")
    handler.handle(logging.LogRecord("one", logging.ERROR, "", 0, "%d", ("no number",), None))
    handler.close()
    assert "no number" in capsys.readouterr().err
