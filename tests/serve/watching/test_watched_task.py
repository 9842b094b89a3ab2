"""A task as an observer sees it, by status and notices."""

from __future__ import annotations

from selfconf.protocol.messages import Notice, Status
from selfconf.serve.watching.watched_task import WatchedTask
from tests.lab import iri


def notice(sequence: int, **event: object) -> Notice:
    """An event of a run."""
    return Notice("c1", sequence, "tidy~c1", event)


def test_an_event_counts_once() -> None:
    task = WatchedTask("c1")
    event = task.hear(notice(1, act="lost", component="urn:a", cause="fail", detail="why", process=3))
    assert event is not None
    assert (event["task"], "process" in event) == ("tidy~c1", False)
    assert task.hear(notice(1, act="lost", component="urn:a")) is None
    assert task.lost["urn:a"]["detail"] == "why"


def test_what_is_not_worth_a_line_is_still_counted() -> None:
    task = WatchedTask("c1")
    assert task.hear(notice(1, act="watching", component="urn:a")) is None
    assert task.sequence == 1


def test_a_component_that_is_lost_no_more_is_forgotten() -> None:
    task = WatchedTask("c1")
    task.hear(notice(1, act="lost", component="urn:a", cause="crash", detail=""))
    task.take_status(Status("c1", "running", iri("t"), 7, 0.0, lost={"urn:b": "fail"}, task="tidy~c1"))
    assert task.lost == {"urn:b": {"cause": "fail", "detail": "", "time": None}}


def test_the_refusal_of_a_task_that_waits_is_explained_by_a_notice_that_comes_once_more() -> None:
    task = WatchedTask("c1")
    mend = {"code": "reasoning", "message": "try another"}
    plain, explained = ({"template": "urn:t", "reasons": [], "repairs": repairs} for repairs in ([], [mend]))
    assert task.hear(notice(4, act="waiting", refusal=plain)) is not None
    assert task.hear(notice(5, act="composed", outcome="refused")) is not None
    assert task.hear(notice(4, act="waiting", refusal=explained)) is None
    assert len((task.refusal or {})["repairs"]) == 1
    assert task.sequence == 5
    task.hear(notice(3, act="waiting", refusal=plain))
    task.hear(notice(4, act=["odd"]))
    assert len((task.refusal or {})["repairs"]) == 1
    task.hear(notice(6, act="running", configuration={"roles": []}))
    task.hear(notice(4, act="waiting", refusal=explained))
    assert task.refusal is None


def test_a_task_that_is_over_holds_nothing() -> None:
    task = WatchedTask("c1")
    task.take_status(Status("c1", "running", iri("t"), 7, 0.0, components=(iri("a"),), task="tidy~c1"))
    task.hear(notice(1, act="running", epoch=7, configuration={"roles": []}))
    assert task.body(detached=False)["components"] == [iri("a")]
    assert task.body(detached=False)["configuration"] is not None
    task.hear(notice(2, act="running", epoch=8))
    assert task.body(detached=False)["configuration"] is not None, "one that tells no more than that it runs"
    task.alive = False
    body = task.body(detached=False)
    assert (body["phase"], body["components"], body["configuration"]) == ("gone", [], None)


def test_an_event_of_a_stranger_that_is_of_no_known_form_does_no_harm() -> None:
    task = WatchedTask("c1")
    task.hear(notice(1, act="running", configuration="none"))
    task.hear(notice(2, act=["odd"]))
    assert task.configuration is None
