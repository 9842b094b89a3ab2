"""The tasks of a site on its disk: the newest record of each, also after the site has ended."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from selfconf.deployment.task_folder import MOST_RECORDS, TaskFolder
from selfconf.errors import PeerError
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


def test_a_file_that_is_no_record_is_passed_over_and_named(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    TaskFolder(tmp_path).learn(FIRST)
    (tmp_path / "broken.json").write_text("{")
    with caplog.at_level(logging.WARNING):
        assert TaskFolder(tmp_path).records == {"navigate~1": FIRST}
    assert f"passed over {tmp_path / 'broken.json'}" in caplog.text


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
