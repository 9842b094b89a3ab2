"""A task that is stopped, in whatever phase, ends with everything released."""

from __future__ import annotations

import pytest

from selfconf.configurator.effects import (
    Decline,
    Finish,
)
from selfconf.configurator.events import (
    Answered,
    Appeared,
    Call,
    Failed,
    Freed,
    Reconnected,
    Stopped,
    Unanswered,
)
from selfconf.configurator.state import Phase, Policy
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DISMANTLE,
    DRIVE,
    TRACKER,
    History,
    kinds,
    released,
    state_in,
)


@pytest.mark.parametrize("phase", [phase for phase in Phase if phase not in (Phase.REFUSED, Phase.STOPPED)])
@pytest.mark.parametrize("policy", Policy)
def test_a_stop_in_every_phase_ends_with_everything_released(phase: Phase, policy: Policy) -> None:
    history = History(state_in(phase, policy=policy))
    touched = set(history.state.held)
    history.hear(Stopped())
    history.all_answer()
    assert history.state.phase is Phase.STOPPED
    assert not history.state.held
    assert not history.state.owed
    assert touched <= {IRI(c) for c in released(history.effects)} | (touched if phase is Phase.DISMANTLING else set())
    assert kinds(history.effects).count(Finish) == 1
    assert history.hear(Stopped()) == []


def test_a_stop_while_dismantling_for_a_search_ends_it() -> None:
    history = History(DISMANTLE).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Stopped())
    assert history.all_answer() == [Finish()]
    assert history.state.phase is Phase.STOPPED


def test_a_stop_does_not_wait_for_a_component_that_cannot_be_reached() -> None:
    history = History().running()
    assert released(history.hear(Stopped())) == [DRIVE]
    assert released(history.answer(DRIVE, Call.RELEASE, Unanswered.SILENT)) == [CONTROL]
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]
    assert history.state.owed.keys() == {DRIVE}


def test_a_stop_waits_for_a_component_that_was_just_released() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Stopped())
    history.answer(DRIVE, Call.RELEASE)
    history.answer(CONTROL, Call.RELEASE)
    assert history.state.pending == {(TRACKER, Call.RELEASE)}
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]


@pytest.mark.parametrize("state", [Phase.STOPPED, Phase.REFUSED])
def test_nothing_is_done_any_more_about_a_task_that_has_ended(state: Phase) -> None:
    history = History(state_in(state))
    late = Answered(TRACKER, Call.RESERVE, history.state.epoch, Verdict.DONE, "1")
    for event in (
        late,
        Appeared({TRACKER: "2"}),
        Reconnected(),
        Stopped(),
        Failed(TRACKER, "1", Cause.FAIL),
    ):
        assert history.hear(event) == []
    assert kinds(history.hear(Freed(TRACKER))) == [Decline]
