"""The logs of sites: read with what was put aside, in the order of time, and followed over a rotation."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf import rendezvous
from selfconf.api.site_logs import LogLine, followed_lines, kept_lines, site_logs
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.term import IRI
from selfconf.site.log_file import LogFile

CLOCK, LAMP = "https://example.org/x#clock", "https://example.org/x#lamp"


def said(second: int, text: str, sources: str = CLOCK, stream: str = "stdout") -> str:
    return f"2026-11-22T06:30:{second:02}.000Z {stream} {sources} {text}\n"


def test_a_line_is_taken_apart(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text(said(1, "two words ", f"{CLOCK},{LAMP}") + "torn\n" + said(2, ""))
    first, torn, empty = kept_lines([tmp_path / "a.log"])
    assert first == LogLine("2026-11-22T06:30:01.000Z", "stdout", (IRI(CLOCK), IRI(LAMP)), "two words ")
    assert first.body()["components"] == [CLOCK, LAMP]
    assert len(first.local_time) == len("06:30:01.000")
    assert torn.components == ()
    assert torn.local_time == "torn"
    assert empty.text == ""


def test_the_last_lines_of_a_component_come_from_all_files_in_the_order_of_time(tmp_path: Path) -> None:
    (tmp_path / "a.log.2").write_text(said(1, "oldest"))
    (tmp_path / "a.log.1").write_text(said(3, "older"))
    (tmp_path / "a.log").write_text(said(5, "newest") + said(6, "other", LAMP))
    (tmp_path / "b.log").write_text(said(4, "elsewhere", f"{LAMP},{CLOCK}"))
    logs = [tmp_path / "a.log", tmp_path / "b.log"]
    assert [one.text for one in kept_lines(logs)] == ["oldest", "older", "elsewhere", "newest", "other"]
    assert [one.text for one in kept_lines(logs, "clock")] == ["oldest", "older", "elsewhere", "newest"]
    assert [one.text for one in kept_lines(logs, LAMP, 1)] == ["other"]
    assert kept_lines(logs, "nobody") == []
    assert kept_lines(logs, "", 0) == []


def test_what_is_added_is_followed_also_when_the_file_is_put_aside_and_when_it_is_only_half_a_line(
    tmp_path: Path,
) -> None:
    log = LogFile(tmp_path / "a.log", most_bytes=200)
    log.write(said(1, "before").encode())
    steps: Iterator[list[bytes]] = iter(
        [
            [said(2, "one").encode()],
            [said(3, "half")[:-3].encode()],
            [said(3, "half")[-3:].encode()],
            [said(second, f"more {second}").encode() for second in (4, 5)],  # the second goes into a new file
        ]
    )

    def step(_: float) -> None:
        for lines in next(steps):
            log.write(lines)

    lines = followed_lines([tmp_path / "a.log"], step, "clock")
    found = [next(lines).text for _ in range(4)]
    log.close()
    assert found == ["one", "half", "more 4", "more 5"]
    assert (tmp_path / "a.log.1").exists()


def test_a_log_that_is_made_later_is_followed_from_its_beginning(tmp_path: Path) -> None:
    steps = iter([None])

    def step(_: float) -> None:
        next(steps)
        (tmp_path / "a.log").write_text(said(1, "first"))

    assert next(followed_lines([tmp_path / "a.log"], step)).text == "first"


@pytest.fixture
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "runtime"))
    return tmp_path / "runtime"


def test_logs_are_found_where_they_are_usual_and_where_sites_that_run_say(runtime: Path, tmp_path: Path) -> None:
    with pytest.raises(NetworkError, match="no site has kept a log in"):
        site_logs(None)
    (runtime / "log").mkdir(parents=True)
    (runtime / "log" / "home@gone.log").touch()
    assert [path.name for path in site_logs(None)] == ["home@gone.log"]
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "home@here.log").touch()
    rendezvous.announce(
        rendezvous.LocalSite(
            "home", "here", "tcp/127.0.0.1:1", os.getpid(), log=str(tmp_path / "own" / "home@here.log")
        )
    )
    assert [path.name for path in site_logs("home")] == ["home@here.log", "home@gone.log"]
    assert [path.name for path in site_logs("home", tmp_path / "own")] == ["home@here.log"]
    with pytest.raises(NetworkError, match="no site of the ecology 'other'"):
        site_logs("other")


def test_of_several_ecologies_the_one_that_lives_is_meant_else_one_has_to_be_named(runtime: Path) -> None:
    (runtime / "log").mkdir(parents=True)
    for name in ("home", "lab"):
        (runtime / "log" / f"{name}@x.log").touch()
    with pytest.raises(AuthorError, match="--ecology: home, lab"):
        site_logs(None)
    rendezvous.announce(rendezvous.LocalSite("lab", "x", "tcp/127.0.0.1:1", os.getpid()))
    assert [path.name for path in site_logs(None)] == ["lab@x.log"]
