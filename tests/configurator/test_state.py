"""What a configurator knows: whether its task has ended, and whether a search in vain counts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.state import Held, Loss, Phase, Revival, State
from selfconf.model.configuration import Wants
from selfconf.model.holder import Holder
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
from tests.configurator.builders import CONTROL, TRACKER, navigation

EYE = IRI("urn:test:eye")


@pytest.mark.parametrize("phase", Phase)
def test_of_all_phases_only_refused_and_stopped_end_a_task(phase: Phase) -> None:
    assert State(phase=phase).ended == (phase in (Phase.REFUSED, Phase.STOPPED))


def test_a_patient_task_does_not_end_with_a_refusal_but_when_it_is_stopped() -> None:
    refused = State(phase=Phase.REFUSED, patient=True)
    assert not refused.ended
    assert replace(refused, phase=Phase.STOPPED).ended
    assert [one.phase_in_words for one in (refused, replace(refused, patient=False))] == ["waiting", "refused"]


def test_a_search_that_finds_nothing_counts_as_long_as_nothing_has_changed() -> None:
    assert not State().searches_again
    assert State(news=True).searches_again


def test_a_lost_component_that_its_site_can_start_is_worth_another_search() -> None:
    crashed = Loss(Cause.CRASH, revival=Revival.POSSIBLE)
    assert State(lost={EYE: crashed}).searches_again
    assert not State(lost={EYE: replace(crashed, revival=Revival.NONE)}).searches_again


def test_what_others_would_share_is_contested_where_they_want_something_else_and_this_task_has_not_got_it() -> None:
    configuration = navigation()
    same, other = (Holder("tidy~2", wants=wants) for wants in (configuration.wants(CONTROL), Wants()))
    assert State(sharers={CONTROL: same, TRACKER: other}).contested(configuration) == {}
    assert State(sharers={CONTROL: other}).contested(configuration) == {CONTROL: other}
    assert State(sharers={CONTROL: other}, held={CONTROL: Held({})}).contested(configuration) == {}
