"""Every event of a run has its sentence and its JSON body."""

from __future__ import annotations

import json
import os
import string
from dataclasses import fields
from typing import Any

import pytest

from selfconf.model import run_event
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import (
    CallDeclined,
    ComponentLost,
    ComponentReleased,
    ComponentWoken,
    EcologyAsked,
    EcologyDiscovered,
    InputConnected,
    RunEvent,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.wording import MANY
from selfconf.render.names import short
from selfconf.render.run_events import SENTENCES, details, event_body, log_hint, lost_sentences, sentence
from tests.render.answers import CLOCK, CONFIGURATION, NAMES, REFUSAL, SCREEN, TEMPLATE

EVENTS = sorted(
    (one for one in vars(run_event).values() if isinstance(one, type) and issubclass(one, RunEvent) and one.act),
    key=lambda one: one.act,
)
FACTS: dict[str, Any] = {
    "component": CLOCK,
    "holder": "patrol",
    "source": CLOCK,
    "sink": SCREEN,
    "output": "time",
    "input": "text",
    "components": 2,
    "sites": ("home",),
    "missing": ("cellar",),
    "detail": "it burns",
    "reason": "it takes too long",
    "cause": "fail",
    "call": "apply",
    "site": "home",
    "outcome": CONFIGURATION,
    "seconds": 0.0015,
    "configuration": CONFIGURATION,
    "epoch": 3,
    "refusal": REFUSAL,
    "task": "tell-the-time",
    "owed": (SCREEN,),
    "lost": {CLOCK: "crash, its liveliness has ended"},
    "time": 12.5,
}
SILENT = {"activating", "refused"}
"""Acts that are not worth a line: another event says so more fully."""


def instance(kind: type[RunEvent]) -> RunEvent:
    """An event of a class, with a value for each of its facts."""
    facts = {one.name: FACTS[one.name] for one in fields(kind)}
    return kind(**facts | ({"refusal": None} if kind is TaskStopped else {}))


@pytest.mark.parametrize("kind", EVENTS, ids=lambda kind: kind.__name__)
def test_every_event_has_a_sentence_unless_another_says_it(kind: type[RunEvent]) -> None:
    said = sentence(instance(kind), NAMES)
    assert bool(said) is (kind.act not in SILENT)
    assert "\n" not in said
    assert "{" not in said
    assert "https://" not in said


@pytest.mark.parametrize("kind", EVENTS, ids=lambda kind: kind.__name__)
def test_every_event_has_a_body_with_act_time_message_process_and_its_facts(kind: type[RunEvent]) -> None:
    event = instance(kind)
    body = event_body(event)
    assert (body["act"], body["time"], body["process"]) == (kind.act, 12.5, os.getpid())
    assert body["message"] == sentence(event, short).strip()
    assert body.keys() == {"act", "message", "process", *(one.name for one in fields(kind))}
    assert json.loads(json.dumps(body, allow_nan=False)) == body


def test_a_component_that_others_share_is_not_said_to_be_off() -> None:
    assert sentence(ComponentReleased(CLOCK, "done"), short).strip() == "clock is off"
    assert sentence(ComponentReleased(CLOCK, "done", "patrol"), short).strip() == "clock acts on for the task patrol"


@pytest.mark.parametrize(("more", "said"), [(0, ""), (1, "; nor did 1 other"), (2, "; nor did 2 others")])
def test_of_very_many_sites_the_rest_is_counted(more: int, said: str) -> None:
    sites = tuple(f"s{number}" for number in range(MANY + more))
    silent = "".join(f"; site {site} did not answer in full" for site in sites[:MANY])
    assert sentence(EcologyDiscovered(1, (), sites), short).endswith(f"at no site{silent}{said}")
    found = sentence(EcologyDiscovered(1, sites, ()), short)
    assert found.endswith(f", s{MANY - 1}" + said.replace("; nor did", " and"))


def test_each_sentence_belongs_to_an_event() -> None:
    assert SENTENCES.keys() == {kind.act for kind in EVENTS}
    assert len(EVENTS) == len(SENTENCES)


def test_a_sentence_speaks_of_nothing_that_its_event_does_not_have() -> None:
    computed = {"missing", "found", "milliseconds", "loss", "state"}
    for kind in EVENTS:
        named = {name for _, name, _, _ in string.Formatter().parse(SENTENCES[kind.act]) if name}
        assert named <= {one.name for one in fields(kind)} | computed


def test_iris_are_shortened_by_the_names_that_are_given() -> None:
    event = InputConnected(CLOCK, "time", SCREEN, "text")
    assert sentence(event, NAMES) == "act 4  :clock time -> :screen text"
    assert sentence(event, short) == "act 4  clock time -> screen text"
    assert event_body(event)["source"] == CLOCK


def test_the_name_of_a_port_forges_no_line() -> None:
    event = InputConnected(CLOCK, "time\nact 5  running", SCREEN, "text\x1b[2J")
    assert sentence(event, NAMES) == r"act 4  :clock time\nact 5  running -> :screen text\x1b[2J"
    assert event_body(event)["output"] == "time\nact 5  running"


def test_a_discovery_names_the_sites_that_did_not_answer_in_full() -> None:
    plain = sentence(EcologyDiscovered(2, ("home", "hall")), NAMES)
    assert plain == "act 2  2 components at home, hall"
    missing = sentence(EcologyDiscovered(2, ("home",), ("cellar", "attic")), NAMES)
    assert missing == (
        "act 2  2 components at home; site cellar did not answer in full; site attic did not answer in full"
    )
    assert sentence(EcologyDiscovered(1, ("home",)), NAMES) == "act 2  1 component at home"
    assert sentence(EcologyDiscovered(0, ()), NAMES) == "act 2  0 components at no site"


@pytest.mark.parametrize(
    ("outcome", "words"),
    [
        (CONFIGURATION, "2 components in 1.5 ms"),
        (REFUSAL, "no configuration in 1.5 ms"),
        (Undecided(7), "no answer in"),
    ],
)
def test_the_end_of_a_search_says_what_it_came_to(outcome: Any, words: str) -> None:
    assert words in sentence(SearchEnded(outcome, 0.0015), NAMES)


def test_what_a_component_says_is_quoted() -> None:
    assert "it burns" in sentence(ComponentLost(CLOCK, "fail", "it burns"), NAMES)
    assert "not {here}" in sentence(CallDeclined(CLOCK, "not {here}"), NAMES)
    assert "site home starts it" in sentence(ComponentWoken(CLOCK, "home"), NAMES)


def test_a_task_that_waits_or_is_refused_says_why_first() -> None:
    lost = {CLOCK: "crash, its liveliness has ended"}
    for kind in (TaskWaiting, TaskRefused):
        said = "\n".join(details(kind(REFUSAL, lost), NAMES))
        assert said.startswith("no configuration for :tell\n")
        assert said.endswith("\n  :clock was lost: crash, its liveliness has ended")
    assert list(details(TaskWaiting(Undecided(7)), NAMES)) == ["  not decided within 7 steps; allow more by steps"]
    assert list(details(TaskWaiting(None), NAMES)) == []


def test_other_events_have_nothing_to_say_first() -> None:
    for event in (EcologyAsked(), TaskRunning(CONFIGURATION, 1), TaskStopped(lost={CLOCK: "x"})):
        assert list(details(event, NAMES)) == []


def test_losses_are_a_line_each() -> None:
    assert list(lost_sentences({CLOCK: "fail", SCREEN: "silence"}, short)) == [
        "  clock was lost: fail",
        "  screen was lost: silence",
    ]


def test_the_body_of_an_event_holds_the_bodies_of_its_values() -> None:
    waiting = event_body(TaskWaiting(Refusal(TEMPLATE, ()), {CLOCK: "fail"}))
    assert waiting["refusal"]["template"] == TEMPLATE
    assert waiting["lost"] == {CLOCK: "fail"}
    assert event_body(TaskWaiting(None))["refusal"] is None
    assert event_body(TaskWaiting(Undecided(7)))["refusal"]["code"] == "undecided"
    assert event_body(TaskRunning(CONFIGURATION, 3))["configuration"]["template"] == TEMPLATE


def test_what_has_been_told_of_a_loss_is_not_told_again_and_the_log_is_named_for_what_has_ended() -> None:
    assert list(lost_sentences({CLOCK: "fail", SCREEN: "silence"}, short, {CLOCK})) == ["  screen was lost: silence"]
    assert log_hint(ComponentLost(CLOCK, "crash", "gone")) == "       `selfconf log clock` shows what it has printed"
    assert "`selfconf log clock --now`" in log_hint(ComponentLost(CLOCK, "crash", "gone"), "--now")
    assert log_hint(ComponentLost(CLOCK, "fail", "said so")) == ""
    assert sentence(ComponentLost(CLOCK, "refused", ""), short) == "LOST   clock: refused"
