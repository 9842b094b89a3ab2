"""The tasks of a site on its disk: the newest record of each, also after the site has ended."""

from __future__ import annotations

import errno
import logging
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.deployment.task_folder import MOST_RECORDS, TaskFolder
from selfconf.errors import PeerError
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord

FIRST = TaskRecord("navigate~1", revision=1)
SECOND = TaskRecord("navigate~1", revision=2, ended=True)


def test_what_was_learnt_is_known_again_from_the_disk(tmp_path: Path) -> None:
    folder = TaskFolder(tmp_path / "tasks")
    assert folder.learn(FIRST)
    assert folder.learn(SECOND)
    assert TaskFolder(tmp_path / "tasks").records == {"navigate~1": SECOND}


@pytest.mark.parametrize("late", [FIRST, SECOND], ids=["older", "equal"])
def test_a_record_that_is_not_newer_is_not_learnt(tmp_path: Path, late: TaskRecord) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(SECOND)
    assert not folder.learn(late)
    assert TaskFolder(tmp_path).records == {"navigate~1": SECOND}


def test_a_record_is_encoded_once_and_anew_when_a_newer_one_is_learnt() -> None:
    folder = TaskFolder(None)
    folder.learn(FIRST)
    assert folder.encoded("navigate~1") == encode(FIRST)
    assert folder.encoded("navigate~1") is folder.encoded("navigate~1")
    folder.learn(SECOND)
    assert folder.encoded("navigate~1") == encode(SECOND)


def test_each_task_has_a_file_of_its_own_and_nothing_else_is_left(tmp_path: Path) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(FIRST)
    folder.learn(TaskRecord("watch~1", revision=1))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["navigate~1.json", "watch~1.json"]


def test_the_folder_is_made_when_it_is_needed_and_for_its_owner_alone(tmp_path: Path) -> None:
    place = tmp_path / "tasks"
    folder = TaskFolder(place)
    assert not place.exists()
    folder.learn(FIRST)
    assert place.stat().st_mode & 0o777 == 0o700


def test_without_a_folder_records_are_kept_in_memory() -> None:
    folder = TaskFolder(None)
    assert folder.learn(FIRST)
    assert folder.records == {"navigate~1": FIRST}


def test_a_copy_of_an_older_record_that_lies_beside_it_does_not_count(tmp_path: Path) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(FIRST)
    (tmp_path / "navigate~1_before.json").write_bytes((tmp_path / "navigate~1.json").read_bytes())
    folder.learn(SECOND)
    assert TaskFolder(tmp_path).records == {"navigate~1": SECOND}


def test_a_file_that_is_no_record_is_passed_over_and_that_is_said_to_people(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    TaskFolder(tmp_path).learn(FIRST)
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "folder.json").mkdir()
    with caplog.at_level(logging.ERROR):
        assert TaskFolder(tmp_path).records == {"navigate~1": FIRST}
    for path, why in (("broken.json", "not a message"), ("folder.json", "Is a directory")):
        assert f"the task in {tmp_path / path} cannot be read, and this site does not run it: {why}" in caplog.text
    assert "`selfconf run --detach`" in caplog.text


@pytest.mark.parametrize("trouble", [PermissionError(errno.EACCES, "Permission denied"), NotADirectoryError()])
def test_a_folder_that_cannot_be_read_is_named_and_the_site_goes_on_without_its_tasks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, trouble: OSError
) -> None:
    TaskFolder(tmp_path).learn(FIRST)

    def refuse(folder: Path) -> Iterator[Path]:
        raise trouble

    monkeypatch.setattr(Path, "iterdir", refuse)  # who is root may read every folder
    with caplog.at_level(logging.ERROR):
        assert TaskFolder(tmp_path).records == {}
    assert f"the tasks in {tmp_path} cannot be read, and this site runs none of them" in caplog.text


def test_of_too_many_tasks_those_that_have_ended_go_and_then_none_is_taken(tmp_path: Path) -> None:
    folder = TaskFolder(tmp_path)
    for number in range(MOST_RECORDS):
        folder.learn(TaskRecord(f"t~{number}", 1, ended=number < 2, beginning=float(number)))
    folder.learn(TaskRecord("late~1", 1))
    assert "t~0" not in folder.records
    assert not (tmp_path / "t~0.json").exists()
    folder.learn(TaskRecord("late~2", 1))
    with pytest.raises(PeerError, match="selfconf stop"):
        folder.learn(TaskRecord("late~3", 1))
    assert folder.learn(TaskRecord("late~1", 2))
    assert len(folder.records) == MOST_RECORDS


@pytest.fixture
def full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From now on there is no room on the disk."""

    def full(opened: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)


def test_a_new_task_that_finds_no_room_is_refused_and_leaves_nothing_behind(tmp_path: Path, full: None) -> None:
    folder = TaskFolder(tmp_path)
    with pytest.raises(OSError, match="No space"):
        folder.learn(FIRST)
    assert list(tmp_path.iterdir()) == []
    assert folder.records == {}
    folder.hold(FIRST)  # as another site has it on its disk
    assert folder.learn(SECOND)
    assert TaskFolder(tmp_path).records == {}


def test_what_becomes_of_a_task_counts_though_there_is_no_room_for_it(
    tmp_path: Path, request: pytest.FixtureRequest, caplog: pytest.LogCaptureFixture
) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(FIRST)
    request.getfixturevalue("full")
    later = TaskRecord("navigate~1", revision=2)
    assert folder.learn(later)
    assert folder.records == {"navigate~1": later}
    assert "cannot write what has become of the task navigate~1: No space left on device" in caplog.text
    assert TaskFolder(tmp_path).records == {"navigate~1": FIRST}


def test_a_task_that_has_ended_does_not_come_back_though_there_was_no_room_to_say_so(
    tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(FIRST)
    request.getfixturevalue("full")
    assert folder.learn(SECOND)
    assert TaskFolder(tmp_path).records == {}


def test_the_end_of_a_task_is_final_whatever_was_written_of_it_meanwhile(tmp_path: Path) -> None:
    folder = TaskFolder(tmp_path)
    folder.learn(TaskRecord("navigate~1", revision=7))
    assert folder.learn(SECOND)
    assert not folder.learn(TaskRecord("navigate~1", revision=9))
    assert TaskFolder(tmp_path).records == {"navigate~1": SECOND}
