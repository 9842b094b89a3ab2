"""The log of a site: lines are added, it is put aside when it is full, and it breaks nothing where it cannot be."""

from __future__ import annotations

import os
import resource
import shutil
from pathlib import Path

import pytest

from selfconf.site.log_file import MOST_LOGS, PUT_ASIDE, LogFile, forget_oldest


def open_files() -> int:
    """How many files this process has open."""
    return sum(1 for _ in Path("/proc/self/fd").iterdir())


def test_lines_are_added_to_what_is_there(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "home.log"
    for text in (b"one\n", b"two\n"):
        log = LogFile(path)
        log.write(text)
        log.close()
    assert path.read_bytes() == b"one\ntwo\n"
    assert path.stat().st_mode & 0o077 == 0


def test_a_file_without_lines_is_not_made(tmp_path: Path) -> None:
    LogFile(tmp_path / "home.log").close()
    assert list(tmp_path.iterdir()) == []


def test_a_full_file_is_put_aside_and_the_oldest_goes(tmp_path: Path) -> None:
    log = LogFile(tmp_path / "home.log", most_bytes=30)
    lines = [f"line {number:04}\n".encode() for number in range(40)]
    for line in lines:
        log.write(line)
    log.close()
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["home.log", *(f"home.log.{number + 1}" for number in range(PUT_ASIDE))]
    kept = b"".join((tmp_path / name).read_bytes() for name in [*reversed(names[1:]), names[0]])
    assert kept == b"".join(lines[-kept.count(b"\n") :])
    assert all(path.stat().st_size <= 30 for path in tmp_path.iterdir())


def test_where_nothing_can_be_written_that_is_said_once(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder = tmp_path / "folder"
    log = LogFile(folder / "home.log")
    for _ in range(2):
        caplog.clear()
        folder.write_text("")
        log.write(b"one\n")
        assert "cannot write" in caplog.text
        log.write(b"two\n")
        assert len(caplog.records) == 1
        folder.unlink()
        log.write(b"three\n")
        shutil.rmtree(folder)


def test_a_log_that_is_put_aside_or_removed_leaves_no_file_open(tmp_path: Path) -> None:
    log, before = LogFile(tmp_path / "home.log", most_bytes=30), open_files()
    for number in range(20):
        log.write(f"line {number:04}\n".encode())
        if number % 3 == 0:
            log.path.unlink()
    assert open_files() == before + 1
    log.close()
    assert open_files() == before


def test_a_file_that_was_removed_or_moved_away_is_made_anew(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "home.log"
    log = LogFile(path)
    log.write(b"one\n")
    path.unlink()
    log.write(b"two\n")
    path.rename(tmp_path / "by-hand.log")
    path.parent.rmdir()
    log.write(b"three\n")
    assert path.read_bytes() == b"three\n"
    assert (tmp_path / "by-hand.log").read_bytes() == b"two\n"


def test_a_line_that_a_full_disk_has_cut_does_not_run_into_the_next_one(tmp_path: Path) -> None:
    path, room = tmp_path / "home.log", resource.getrlimit(resource.RLIMIT_FSIZE)
    log = LogFile(path)
    resource.setrlimit(resource.RLIMIT_FSIZE, (6, room[1]))
    try:
        for line in (b"one\n", b"lost in part\n", b"lost\n"):
            log.write(line)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, room)
    for line in (b"two\n", b"three\n"):
        log.write(line)
    assert path.read_bytes() == b"one\nlo\ntwo\nthree\n"


def test_nor_into_the_first_one_of_the_next_life_of_a_site(tmp_path: Path) -> None:
    path = tmp_path / "home.log"
    path.write_bytes(b"one\nlo")
    log = LogFile(path)
    for line in (b"two\n", b"three\n"):
        log.write(line)
    log.close()
    assert path.read_bytes() == b"one\nlo\ntwo\nthree\n"


def test_the_oldest_logs_of_sites_that_have_ended_are_forgotten(tmp_path: Path) -> None:
    for number in range(MOST_LOGS + 5):
        for suffix in ("", ".1"):
            path = tmp_path / f"home@s{number:02}.log{suffix}"
            path.write_text("line\n")
            at = 100 - number if suffix else 100 + number
            os.utime(path, ns=(at, at))
    (tmp_path / "other.txt").write_text("stays")
    forget_oldest(tmp_path, {"home@s00.log"})
    left = sorted(path.name for path in tmp_path.iterdir())
    expected = ["home@s00.log", *(f"home@s{number:02}.log" for number in range(5, MOST_LOGS + 5))]
    assert left == sorted([*expected, *(f"{name}.1" for name in expected), "other.txt"])
    forget_oldest(tmp_path / "nowhere", ())
