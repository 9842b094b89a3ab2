"""The events of a run as values."""

from __future__ import annotations

from collections import Counter
from dataclasses import FrozenInstanceError

import pytest

from selfconf.model import run_event
from selfconf.model.run_event import CallAnswered, ComponentActivated, RunEvent, TaskStopped, TaskWaiting
from selfconf.model.term import IRI

EVENTS = [one for one in vars(run_event).values() if isinstance(one, type) and issubclass(one, RunEvent) and one.act]


def test_an_act_is_of_one_class() -> None:
    assert max(Counter(kind.act for kind in EVENTS).values()) == 1
    assert len(EVENTS) == 23


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
