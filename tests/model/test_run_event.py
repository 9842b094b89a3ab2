"""The events of a run as values."""

from __future__ import annotations

from collections import Counter
from dataclasses import FrozenInstanceError
from typing import get_args

import pytest

from selfconf.model import run_event
from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import AnyRunEvent, CallAnswered, ComponentActivated, RunEvent, TaskStopped, TaskWaiting
from selfconf.model.term import IRI

EVENTS = [one for one in vars(run_event).values() if isinstance(one, type) and issubclass(one, RunEvent) and one.act]


def test_an_act_is_of_one_class() -> None:
    assert max(Counter(kind.act for kind in EVENTS).values()) == 1


def test_any_event_is_one_of_those_that_have_an_act() -> None:
    assert sorted(get_args(AnyRunEvent), key=EVENTS.index) == EVENTS


def test_only_what_says_more_than_its_subclasses_has_no_act() -> None:
    assert (RunEvent.act, CallAnswered.act) == ("", "")
    assert issubclass(ComponentActivated, CallAnswered)


def test_events_are_values_with_a_time() -> None:
    event = ComponentActivated(IRI("urn:lamp"), time=2.5)
    assert event == ComponentActivated(IRI("urn:lamp"), time=2.5) != ComponentActivated(IRI("urn:lamp"), time=3.0)
    assert TaskStopped().time == 0.0
    with pytest.raises(FrozenInstanceError):
        event.time = 3.0  # type: ignore[misc]  # that is what is tested


def test_losses_are_not_shared_among_events() -> None:
    assert TaskWaiting(None).lost == {}
    assert TaskWaiting(None).lost is not TaskWaiting(None).lost


def test_an_event_is_printed_in_one_line_and_what_is_large_by_its_size() -> None:
    clock = IRI("https://example.org/my-home#clock")
    lost = run_event.ComponentLost(clock, "crash", "its life has ended", time=3.0)
    assert str(lost) == "lost component=clock cause=crash detail='its life has ended'"
    assert str(TaskStopped(lost={clock: "crash"}, owed=(clock,))) == "stopped refusal=None lost=(clock) owed=(clock)"
    assert str(TaskWaiting(Undecided(3))).startswith("waiting refusal=<undecided>")
    configured = Configuration(clock, (Assignment(clock, (clock,)),))
    assert str(run_event.TaskRunning(configured, 7)) == "running configuration=<1 components> epoch=7"
    assert str(TaskWaiting(Refusal(clock, ()))).startswith("waiting refusal=<refused>")
