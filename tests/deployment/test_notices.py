"""What a configurator tells those who look on, and that nothing of the run depends on them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.deployment.notices import LATEST, RunNotices
from selfconf.model.configuration import Configuration, ParameterSetting
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import AnswerRejected, TaskRunning, TaskStopped, TaskWaiting
from selfconf.model.term import Literal
from selfconf.protocol.codec import LARGEST, decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice
from tests.lab import Lab, iri


def latest(lab: Lab, key: str) -> list[Notice]:
    """The events that a configurator has kept."""
    replies: list[Replies] = []
    lab.network.node().ask(key, b"", 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    return [decode(sample.payload, Notice) for sample in replies[0].samples]


def test_an_observer_hears_what_fails_and_what_takes_over(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(1.0)
    (lost,) = [notice.event for notice in heard if notice.event["act"] == "lost"]
    assert (lost["component"], lost["cause"]) == (iri("person-tracker"), "fail")
    first, second = (notice.event for notice in heard if notice.event["act"] == "running")
    assert iri("person-tracker") in json.dumps(first["configuration"])
    assert iri("absolute-odometry") in json.dumps(second["configuration"])
    assert [notice.sequence for notice in heard] == list(range(1, len(heard) + 1))
    assert {(notice.configurator, notice.task) for notice in heard} == {(agent.name, agent.identity.task)}


def test_how_a_run_has_ended_is_heard_though_the_network_drops_what_it_may(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    lab.network.faults = replace(lab.network.faults, loss=1.0)
    for event in (AnswerRejected("dropped"), TaskStopped()):
        told.put(event)
    told.close()
    lab.let_pass(0.1)
    assert [(notice.sequence, notice.event["act"]) for notice in heard] == [(2, "stopped")]


def test_what_is_put_after_the_end_is_told_to_no_one(lab: Lab) -> None:
    """On a site that hands its task over, a component may answer a call after that."""
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    told.put(TaskStopped())
    told.close()
    told.put(AnswerRejected("after the end"))
    lab.let_pass(0.1)
    assert [notice.event["act"] for notice in heard] == ["stopped"]


def test_who_comes_late_is_told_the_latest_events(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    told = latest(lab, lab.keys.notices())
    assert [notice.event["act"] for notice in told] == [event.act for event in lab.events]


def test_the_oldest_events_are_forgotten(lab: Lab) -> None:
    node, keys = lab.network.node(), Keys("lab")
    told = RunNotices(node, keys, "c1", "tidy~c1")
    for number in range(LATEST + 5):
        told.put(AnswerRejected(str(number)))
    found = latest(lab, keys.notices("c1"))
    assert [notice.event["detail"] for notice in found] == [str(number) for number in range(5, LATEST + 5)]
    told.close()
    assert latest(lab, keys.notices("c1")) == []


def test_nothing_is_written_while_nobody_listens(lab: Lab) -> None:
    written: list[Sample] = []
    node: Bus = lab.network.node()
    told = RunNotices(node, Keys("lab"), "c1", "tidy~c1")
    told.put(AnswerRejected("unheard"))
    undo = lab.network.node().subscribe(Keys("lab").notices(), written.append)
    lab.let_pass(0.1)
    told.put(AnswerRejected("heard"))
    lab.let_pass(0.1)
    undo()
    lab.let_pass(0.1)
    told.put(AnswerRejected("unheard again"))
    lab.let_pass(0.1)
    assert [decode(sample.payload, Notice).event["detail"] for sample in written] == ["heard"]


def test_an_event_that_is_explained_is_told_once_more_by_its_number(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    waits, twin = TaskWaiting(Refusal(iri("navigate"), ())), TaskWaiting(Refusal(iri("navigate"), ()))
    for event in (waits, AnswerRejected("after it")):
        told.put(event)
    told.amend(twin, TaskStopped())
    told.amend(waits, replace(waits, refusal=Refusal(iri("navigate"), (), hint="try another")))
    lab.let_pass(0.1)
    assert [(notice.sequence, notice.event["act"]) for notice in heard] == [
        (1, "waiting"),
        (2, "complaint"),
        (1, "waiting"),
    ]
    explained = [{"code": "reasoning", "message": "try another"}]
    assert [notice.event["refusal"]["repairs"] for notice in heard[::2]] == [[], explained]
    kept = latest(lab, lab.keys.notices("c1"))
    assert [notice.event["act"] for notice in kept] == ["waiting", "complaint"]
    assert kept[0].event["refusal"]["repairs"] == explained
    told.close()
    told.amend(waits, waits)  # the explanation comes too late


def test_a_run_that_waits_hands_its_refusal_out_to_be_explained(lab: Lab) -> None:
    asked: list[Refusal] = []

    def explain(refusal: Refusal, found: Callable[[Refusal], None]) -> None:
        asked.append(refusal)
        found(replace(refusal, hint="try another"))

    lab.crash("drive")
    agent = lab.agent(patient=True, explain=explain)
    assert lab.until(lambda: bool(asked), 10.0)
    lab.let_pass(0.1)
    (waits,) = [
        notice.event for notice in latest(lab, lab.keys.notices(agent.name)) if notice.event["act"] == "waiting"
    ]
    assert waits["refusal"]["repairs"] == [{"code": "reasoning", "message": "try another"}]
    assert asked[0].hint is None


def test_an_event_that_is_too_large_is_told_in_a_sentence(lab: Lab) -> None:
    setting = ParameterSetting(iri("thinking-cap"), "goal", Literal("x" * LARGEST))
    told = RunNotices(lab.network.node(), Keys("lab"), "c1", "tidy~c1")
    told.put(TaskRunning(Configuration(iri("navigate"), (), settings=(setting,)), 7, time=3.0))
    (notice,) = latest(lab, Keys("lab").notices("c1"))
    assert notice.event == {"act": "running", "time": 3.0, "message": "running"}
