"""Tasks are read in advance, once; what gives trouble is left alone for a while, and what cannot be read for good."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import Network
from selfconf.deployment import RunRequest
from selfconf.deployment.task_requests import GIVES_WAY, GIVES_WAY_AT_MOST, RESPITE, TaskRequests
from selfconf.errors import AuthorError
from selfconf.model.immutable import replace
from selfconf.protocol.messages import TaskRecord
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.keepers import RECORD
from tests.lab import request_for


class Reader:
    """Reads tasks, or raises what it is told to, and counts."""

    def __init__(self) -> None:
        self.network = Network()
        self.trouble: Exception | None = None
        self.times = 0
        self.requests = TaskRequests(self.network.node(), self._request_for)

    def _request_for(self, record: TaskRecord) -> RunRequest:
        self.times += 1
        if self.trouble is not None:
            raise self.trouble
        return request_for(record)

    def read(self, record: TaskRecord = RECORD) -> bool:
        """Whether the task can be run, once it was read."""
        self.requests.read(record)
        return self.requests.of(record.task) is not None

    def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        self.network.run(lambda: False, seconds)


def test_a_task_is_read_once_however_often_its_record_changes() -> None:
    reader = Reader()
    assert reader.requests.of(RECORD.task) is None
    assert reader.read()
    assert reader.read(replace(RECORD, revision=9))
    assert reader.times == 1


def test_a_task_that_cannot_be_read_is_not_read_again(caplog: pytest.LogCaptureFixture) -> None:
    reader = Reader()
    reader.trouble = AuthorError("is no template")
    assert not reader.read()
    reader.pass_time(2 * RESPITE)
    assert not reader.read()
    assert reader.times == 1
    assert [one.getMessage() for one in caplog.records] == [f"the task {RECORD.task} cannot be run: is no template"]


def test_a_task_for_which_there_is_no_room_now_is_read_again_later(caplog: pytest.LogCaptureFixture) -> None:
    reader = Reader()
    reader.trouble = OSError("no space left on the device")
    for _ in range(3):
        assert not reader.read()
    assert reader.times == 1
    assert [one.getMessage() for one in caplog.records] == [
        f"the task {RECORD.task} cannot be read now: no space left on the device; trying again in 60 s"
    ]
    reader.trouble = None
    reader.pass_time(RESPITE + 1.0)
    assert reader.read()


def test_a_task_that_has_ended_is_forgotten_with_its_trouble() -> None:
    reader = Reader()
    reader.read()
    reader.requests.leave_alone(RECORD.task, "its search broke")
    assert not reader.read(replace(RECORD, ended=True))
    assert reader.read()


def test_a_task_that_has_given_trouble_is_not_run_for_a_while() -> None:
    reader = Reader()
    assert reader.read()
    reader.requests.leave_alone(RECORD.task, "its search broke")
    assert not reader.read()
    reader.pass_time(RESPITE + 1.0)
    assert reader.read()
    assert reader.times == 1


def test_a_task_is_left_to_another_configurator_for_longer_each_time_until_that_has_let_go() -> None:
    reader = Reader()
    reader.read()
    waits = [reader.requests.give_way(RECORD.task) for _ in range(5)]
    assert waits == [GIVES_WAY, 2 * GIVES_WAY, 4 * GIVES_WAY, GIVES_WAY_AT_MOST, GIVES_WAY_AT_MOST]
    assert waits[-1] > GRACE
    assert not reader.read()
    reader.pass_time(GIVES_WAY_AT_MOST)
    assert reader.read()
    reader.requests.give_way(RECORD.task)
    reader.requests.insist(RECORD.task)
    assert reader.read()
    assert reader.requests.give_way(RECORD.task) == GIVES_WAY


def test_a_task_that_has_given_trouble_is_left_alone_though_another_configurator_has_let_go_of_it() -> None:
    reader = Reader()
    reader.read()
    reader.requests.leave_alone(RECORD.task, "its search broke")
    reader.requests.insist(RECORD.task)
    assert not reader.read()
