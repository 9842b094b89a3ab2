"""Tasks that live in the sites: who keeps them, who runs them, and what is known of those that have ended."""

from __future__ import annotations

import errno
import itertools
import logging
import os
from collections.abc import Callable
from dataclasses import replace

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Undo, Urgency
from selfconf.deployment import Keeper, RunRequest
from selfconf.deployment.keeper import keeper_of
from selfconf.protocol.messages import TaskRecord
from tests.deployment.keepers import RECORD, Keepers
from tests.deployment.tasks import TASK
from tests.lab import request_for


def test_the_keeper_is_the_same_for_all_and_few_tasks_move_when_a_site_goes() -> None:
    tasks = [f"t~{number}" for number in range(200)]
    before = {task: keeper_of(task, ["a", "b", "c"]) for task in tasks}
    after = {task: keeper_of(task, ["c", "a"]) for task in tasks}
    assert set(before.values()) == {"a", "b", "c"}
    assert all(after[task] == site for task, site in before.items() if site != "b")
    assert keeper_of("t", []) == ""


def test_a_task_that_is_handed_over_runs_at_one_site_and_is_kept_by_all(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.lab.let_pass(2.0)
    assert keepers.running() == [keeper_of(RECORD.task, "abc")]
    assert {name: list(k.folder.records) for name, k in keepers.keepers.items()} == {
        name: [RECORD.task] for name in "abc"
    }


def test_a_site_sleeps_that_keeps_no_task_and_a_task_wakes_it(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keepers.lab.let_pass(3.0)
    bus, looks = keepers.buses["a"], []
    later = bus.later

    def counted(seconds: float, action: Callable[[], None]) -> Undo:
        looks.append(keepers.lab.network.time)
        return later(seconds, action)

    monkeypatch.setattr(bus, "later", counted)
    keepers.lab.let_pass(10.0)
    assert not looks
    keepers.settled()
    assert looks


def test_while_all_sites_find_each_other_again_hardly_another_takes_a_task(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each sees the others come one by one; only where the last that is missing has the task, the next one takes it."""
    for name in "defgh":
        keepers.begin(name)
    keeper, begun = keepers.settled(), list[str]()
    run = Keeper._run

    def noted(self: Keeper, record: TaskRecord) -> None:
        begun.append(self.site)
        run(self, record)

    monkeypatch.setattr(Keeper, "_run", noted)
    network = keepers.lab.network
    nodes = [bus for bus in keepers.buses.values() if isinstance(bus, MemoryBus)]
    assert len(nodes) == 8
    others = [node for node in network.nodes if node not in nodes]
    pairs = [*itertools.combinations(nodes, 2), *itertools.product(nodes, others)]
    for left, right in pairs:
        network.cut(left, right)
    keepers.lab.let_pass(0.05)
    for left, right in pairs:
        network.reconnect(left, right)
        keepers.lab.let_pass(0.05 if right in nodes else 0.0)
    keepers.lab.let_pass(5.0)
    assert len(begun) <= 1
    assert keepers.running() == [keeper]


def test_no_other_site_takes_a_task_while_the_hub_of_its_site_is_opened_anew(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the other sites only that one seems to have gone, as if it had been killed."""
    keeper, begun = keepers.settled(), list[str]()
    monkeypatch.setattr(Keeper, "_run", lambda self, record: begun.append(self.site))
    network, node = keepers.lab.network, keepers.buses[keeper]
    assert isinstance(node, MemoryBus)
    others = [other for other in network.nodes if other is not node]
    node.publisher(keepers.lab.keys.reopens(keeper), Urgency.EVENT).put(b"")
    keepers.lab.let_pass(0.05)
    for other in others:
        network.cut(node, other)
    keepers.lab.let_pass(0.5)
    for other in others:
        network.reconnect(node, other)
    keepers.lab.let_pass(5.0)
    assert not begun
    assert keepers.running() == [keeper]


def test_after_all_sites_were_restarted_the_task_comes_back_from_their_disks(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    for name in "abc":
        keepers.end(name)
    keepers.lab.let_pass(5.0)
    assert keepers.lab.active() == set()
    for name in "abc":
        keepers.begin(name)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"tracker"})


def test_a_task_that_was_ended_comes_to_rest_and_does_not_come_back(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.hand_over(TaskRecord(RECORD.task, 100, ended=True))
    assert keepers.lab.until(lambda: not keepers.lab.active())
    keepers.end("a")
    keepers.begin("a")
    keepers.lab.let_pass(5.0)
    assert (keepers.running(), keepers.lab.active()) == ([], set())


def test_a_task_that_cannot_be_read_keeps_no_site_from_its_other_tasks(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    def request_or_not(record: TaskRecord) -> RunRequest:
        if record.task != RECORD.task:
            raise OSError("no space left on the device")
        return request_for(record)

    for keeper in keepers.keepers.values():
        monkeypatch.setattr(keeper._requests, "_request_for", request_or_not)
    keepers.hand_over(TaskRecord("another~1", 1))
    keepers.lab.let_pass(3.0)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))


def fill_disk(keeper: Keeper, monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave no room for what a site keeps."""

    def write(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(keeper.folder, "_write", write)


def test_a_task_that_its_keeper_has_no_room_for_is_run_by_it_as_other_sites_keep_it(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keeper = keeper_of(RECORD.task, (*keepers.keepers, "astrid", "living-room"))
    fill_disk(keepers.keepers[keeper], monkeypatch)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: keepers.running() == [keeper])


def test_a_task_that_no_site_has_room_for_is_not_run_though_others_are(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keepers.settled()
    refused = replace(RECORD, task="patrol~2", priority=9)
    for keeper in keepers.keepers.values():
        fill_disk(keeper, monkeypatch)
    keepers.hand_over(refused)
    keepers.lab.let_pass(10.0)
    assert not any(refused.task in keeper.runners for keeper in keepers.keepers.values())


def test_a_task_whose_configuration_cannot_be_read_begins_anew_and_that_is_said(
    keepers: Keepers, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.ERROR):
        keepers.hand_over(replace(RECORD, configuration={"nonsense": 1}, epoch=3))
        assert keepers.lab.until(lambda: len(keepers.running()) == 1)
    assert "the task patrol~1 begins anew, as its configuration is not to be read" in caplog.text


def test_a_task_whose_configuration_is_nonsense_keeps_no_other_from_being_adopted(keepers: Keepers) -> None:
    first = keepers.settled()
    acting = [name for name, component in keepers.lab.components.items() if component.active]
    nonsense = {"template": "urn:t", "roles": [["urn:r", ["urn:b"]]], "parameters": [], "bindings": {}}
    connections = [["urn:a", ["out"], "urn:b", "in"]]
    keepers.hand_over(
        replace(RECORD, task="nonsense~1", priority=0, epoch=3, configuration={**nonsense, "connections": connections})
    )
    keepers.lab.let_pass(5.0)
    keepers.end(first)
    for name in acting:
        keepers.lab.components[name].said.clear()
    keepers.lab.let_pass(5.0)
    assert keepers.running()
    assert {name for name in acting if ("stopped",) in keepers.lab.components[name].said} == set()
