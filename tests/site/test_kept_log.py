"""The log of a site: its latest lines, and what was added since a position, over files that are put aside."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.errors import PeerError
from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI
from selfconf.protocol.codec import LARGEST, decode, encode
from selfconf.protocol.messages import LogPart, LogQuestion
from selfconf.site.kept_log import MOST_LOG_LINES, log_part
from selfconf.site.log_file import LogFile
from tests.lab import write_advertisements
from tests.site.served import KEYS, ask, serve

CLOCK, LAMP = "https://example.org/x#clock", "https://example.org/x#lamp"


def said(second: int, text: str, sources: str = CLOCK) -> str:
    return f"2026-11-22T06:30:{second:02}.000Z stdout {sources} {text}\n"


def texts(part: LogPart) -> list[str]:
    return [line.text for line in part.lines]


def latest(path: Path, component: str = "", lines: int = 100) -> list[str]:
    return texts(log_part(path, LogQuestion(component, lines)))


def test_a_line_is_taken_apart(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text(said(1, "two words ", f"{CLOCK}|{LAMP}") + "torn\n" + said(2, "") + "unfinished")
    first, torn, empty = log_part(tmp_path / "a.log", LogQuestion(lines=9)).lines
    assert first == LogLine("2026-11-22T06:30:01.000Z", "stdout", (IRI(CLOCK), IRI(LAMP)), "two words ")
    assert torn == LogLine("torn", "", (), "")
    assert empty.text == ""


def test_a_component_whose_iri_has_a_comma_has_its_lines(tmp_path: Path) -> None:
    path, tag = tmp_path / "lab@here.log", "tag:example.org,2026:lamp"
    path.write_text(said(1, "ticks") + said(2, "glows", f"{CLOCK}|{tag}"))
    assert latest(path, tag) == ["glows"]
    assert latest(path, CLOCK) == ["ticks", "glows"]


def test_the_latest_lines_of_a_component_come_from_all_files(tmp_path: Path) -> None:
    (tmp_path / "a.log.2").write_text(said(1, "oldest"))
    (tmp_path / "a.log.1").write_text(said(3, "older"))
    (tmp_path / "a.log").write_text(said(5, "newest") + said(6, "other, not the clock", LAMP))
    path = tmp_path / "a.log"
    assert latest(path) == ["oldest", "older", "newest", "other, not the clock"]
    assert latest(path, "clock") == ["oldest", "older", "newest"]
    assert latest(path, CLOCK, 2) == ["older", "newest"]
    assert latest(path, LAMP, 1) == ["other, not the clock"]
    assert texts(log_part(path, LogQuestion(position=log_part(path, LogQuestion(lines=100)).position))) == []
    assert latest(path, "nobody") == latest(path, lines=0) == latest(tmp_path / "none.log") == []


def test_each_line_comes_once_however_often_the_file_is_put_aside_between_two_looks(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    part, found = log_part(path, LogQuestion(lines=0)), []
    log = LogFile(path, most_bytes=400)
    for number in range(40):
        log.write(said(number, f"line {number}", LAMP if number % 2 else CLOCK).encode())
        if number % 11 == 0:
            part = log_part(path, LogQuestion("clock", position=part.position))
            found += texts(part)
    log.close()
    found += texts(log_part(path, LogQuestion("clock", position=part.position)))
    assert found == [f"line {number}" for number in range(0, 40, 2)]
    assert texts(log_part(path, LogQuestion(position="1:90"))) == latest(path)  # a file that is gone: all that is kept


def test_what_is_half_a_line_comes_when_it_is_whole(tmp_path: Path) -> None:
    path, whole = tmp_path / "a.log", said(3, "half")
    path.write_text(said(2, "before") + whole[:-3])
    part = log_part(path, LogQuestion(lines=5))
    assert texts(part) == ["before"]
    path.write_text(said(2, "before") + whole)
    assert texts(log_part(path, LogQuestion(position=part.position))) == ["half"]


def test_an_answer_is_bounded_and_says_that_there_is_more(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.touch()
    begin = log_part(path, LogQuestion()).position
    path.write_text("".join(said(9, f"{number} {'ü' * 4000}") for number in range(100)))
    assert len(encode(log_part(path, LogQuestion(lines=1000)))) < LARGEST
    found, part = [], LogPart((), begin, more=True)
    while part.more:
        part = log_part(path, LogQuestion(position=part.position))
        assert len(encode(part)) < LARGEST
        found += [text.split()[0] for text in texts(part)]
    assert found == list(map(str, range(100)))


def test_lines_of_any_length_come_though_the_file_is_put_aside_before_they_were_asked_for(tmp_path: Path) -> None:
    """Bytes that are no text are spelt out in the log, so a line there may be longer than was printed."""
    path = tmp_path / "a.log"
    log, printed = LogFile(path, most_bytes=2000), [f"{'x' * 350} {number}" for number in range(9)]
    part, found = log_part(path, LogQuestion(lines=0)), []
    for text in (*printed[:8], "y" * 700, printed[8]):
        log.write(said(1, text).encode())
    for _ in range(20):
        part = log_part(path, LogQuestion(position=part.position), most_bytes=600)
        found += texts(part)
        if not part.more:
            break
    assert found == [*printed[:8], "y" * 700, printed[8]]


def test_an_answer_is_bounded_also_where_each_of_the_files_is_small(tmp_path: Path) -> None:
    log, found, part = LogFile(tmp_path / "a.log", most_bytes=300), list[str](), LogPart((), "1:0", more=True)
    for number in range(20):
        log.write(said(1, str(number)).encode())
    kept = latest(log.path)
    while part.more:
        part = log_part(log.path, LogQuestion(position=part.position), most_bytes=400)
        assert len(part.lines) <= 400 // len(said(1, "")) + 1
        found += texts(part)
    assert found == kept


@pytest.mark.parametrize("position", ["x", "1", "-1:2", "1:2:3", "1:" + "9" * 99])
def test_what_is_no_position_is_refused(position: str, tmp_path: Path) -> None:
    with pytest.raises(PeerError, match="is no position in a log"):
        log_part(tmp_path / "a.log", LogQuestion(position=position))


def test_a_site_tells_its_log_over_the_bus_and_refuses_what_is_no_question(network: Network, tmp_path: Path) -> None:
    path = tmp_path / "lab@home.log"
    path.write_text("".join(said(1, str(number)) for number in range(MOST_LOG_LINES + 1)))
    serve(network, write_advertisements(tmp_path / "ads", "tracker"), log_path=path)
    answer = ask(network, KEYS.log("home"), encode(LogQuestion("clock", 1 << 40)))
    part = decode(answer.samples[0].payload, LogPart)
    assert (len(part.lines), part.lines[-1].text) == (MOST_LOG_LINES, str(MOST_LOG_LINES))
    assert ask(network, KEYS.log("home"), b"?").errors[0].startswith("not a message")
    assert "is no position" in ask(network, KEYS.log("home"), encode(LogQuestion(position="?"))).errors[0]


def test_a_site_without_a_log_says_so(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path, "tracker"))
    assert ask(network, KEYS.log("home"), encode(LogQuestion())).errors == ("the site home keeps no log",)
