"""What sites tell each other of the tasks that they keep, whoever comes, is cut off, or is not heard."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Replies, Request, Urgency
from selfconf.deployment.keeper import keeper_of
from selfconf.deployment.record_exchange import ASKED_AT_ONCE
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord
from tests.deployment.keepers import RECORD, Keepers
from tests.deployment.tasks import TASK


@pytest.fixture
def asked(keepers: Keepers, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The keys of the questions that the site a asks."""
    bus, keys = keepers.buses["a"], list[str]()
    ask = bus.ask

    def noted(key: str, payload: bytes, seconds: float, done: Callable[[Replies], None]) -> None:
        keys.append(key)
        ask(key, payload, seconds, done)

    monkeypatch.setattr(bus, "ask", noted)
    return keys


def test_sites_that_come_are_asked_at_once_and_once_more_but_of_many_most_are_asked_later(
    keepers: Keepers, asked: list[str]
) -> None:
    def begin(*numbers: int) -> list[str]:
        for number in numbers:
            keepers.begin(f"s{number}")
        return [keepers.lab.keys.kept_tasks(f"s{number}") for number in numbers]

    keepers.lab.let_pass(3.0)
    asked.clear()
    few = begin(*range(5))
    keepers.lab.let_pass(0.5)
    assert asked == few
    keepers.lab.let_pass(5.0)
    assert sorted(asked) == sorted(2 * few)
    asked.clear()
    many = begin(*range(5, 30))
    keepers.lab.let_pass(0.5)
    assert sorted(asked) == sorted(many[:ASKED_AT_ONCE])
    keepers.lab.let_pass(5.0)
    assert sorted(asked) == sorted(many + many[:ASKED_AT_ONCE])


def test_of_several_that_come_the_one_that_does_not_answer_is_asked_again(keepers: Keepers, asked: list[str]) -> None:
    answering = {"x", "z"}

    def answer(site: str, request: Request) -> None:
        if site in answering:
            request.finish()

    keys = keepers.lab.keys
    for site in ("x", "y", "z"):
        node = keepers.lab.network.node()
        node.serve(keys.kept_tasks(site), partial(answer, site))
        node.announce(keys.site_life(site, "1"))
    keepers.lab.let_pass(8.0)
    asked.clear()
    keepers.lab.let_pass(10.0)
    assert {*asked} == {keys.kept_tasks("y")}
    answering.add("y")
    keepers.lab.let_pass(4.0)
    asked.clear()
    keepers.lab.let_pass(10.0)
    assert not asked


def test_a_record_that_is_known_is_not_read_again_and_one_that_is_outdated_is_answered(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keepers.settled()
    record = keepers.keepers["a"].folder.records[RECORD.task]
    read, told = list[bytes](), list[bytes]()

    def noted(payload: bytes, kind: type[TaskRecord]) -> TaskRecord:
        read.append(payload)
        return decode(payload, kind)

    monkeypatch.setattr("selfconf.deployment.record_exchange.decode", noted)
    node = keepers.lab.network.node()
    node.subscribe(keepers.lab.keys.task(), lambda sample: told.append(sample.payload), Urgency.EVENT)
    node.publisher(keepers.lab.keys.task(RECORD.task), Urgency.EVENT).put(encode(record))
    keepers.lab.let_pass(1.0)
    assert not read
    told.clear()
    node.publisher(keepers.lab.keys.task(RECORD.task), Urgency.EVENT).put(encode(RECORD))
    keepers.lab.let_pass(1.0)
    assert encode(record) in told
    assert {*read} == {encode(RECORD)}


def test_a_site_that_hears_the_others_and_was_not_heard_as_it_asked_them_is_told_what_has_ended(
    keepers: Keepers,
) -> None:
    network, lone = keepers.lab.network, keepers.buses["b"]
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    assert isinstance(lone, MemoryBus)
    others = [node for node in network.nodes if node is not lone]
    for node in others:
        network.cut(lone, node)
    keepers.lab.let_pass(0.1)
    ended = encode(replace(RECORD, revision=9, ended=True))
    keepers.buses["a"].ask(keepers.lab.keys.keep(), ended, 1.0, lambda replies: None)
    keepers.lab.let_pass(0.1)
    for node in others:
        network.reconnect(lone, node)
        network.mute(lone, node)
    keepers.lab.let_pass(3.0)
    assert not keepers.keepers["b"].folder.records[RECORD.task].ended
    for node in others:
        network.reconnect(lone, node)
    keepers.lab.let_pass(3.0)
    assert all(one.folder.records[RECORD.task].ended for one in keepers.keepers.values())


def test_a_site_that_was_cut_off_when_it_began_hears_later_of_the_task_that_it_is_to_run(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.begin(first)
    late = keepers.lab.network.nodes[-1]
    others = keepers.lab.network.nodes[:-1]
    for other in others:
        keepers.lab.network.cut(late, other)
    keepers.lab.let_pass(5.0)
    assert not keepers.keepers[first].folder.records
    for other in others:
        keepers.lab.network.reconnect(late, other)
    assert keepers.lab.until(lambda: keepers.running() == [first])
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"tracker"})


def test_what_a_site_cannot_keep_of_what_others_send_is_said_to_people_once(
    keepers: Keepers, caplog: pytest.LogCaptureFixture
) -> None:
    publisher = keepers.lab.network.node().publisher(keepers.lab.keys.task("odd~1"), Urgency.EVENT)
    with caplog.at_level(logging.ERROR):
        for payload in (b"{", b"{", b"["):
            publisher.put(payload)
            keepers.lab.let_pass(0.1)
    said = [record.getMessage() for record in caplog.records if "does not keep the task" in record.getMessage()]
    assert len(said) == 2 * len(keepers.keepers)
    assert all(keepers.lab.keys.task("odd~1") in one for one in said)
