"""What a task does about components that act for other tasks as well, as these want the same of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from selfconf.configurator.deploying import MOST_ASKED_AHEAD, MOST_ASKED_BEHIND
from selfconf.configurator.effects import AwaitRelease, Compose, Discover, Effect, WakeUp
from selfconf.configurator.events import (
    Accepted,
    BegunElsewhere,
    Call,
    Discovered,
    Event,
    Failed,
    Freed,
    Improvable,
    Ranked,
    WaitedLong,
)
from selfconf.configurator.state import Phase, State
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    ODOMETRY,
    OTHERS,
    REFUSAL,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
    released,
)

TASK = State(task="go~1")
AHEAD, BEHIND = replace(OTHERS, task="a~1"), replace(OTHERS, task="z~1")
"""Other tasks that rank before this one, and after it."""


def sharers(configuration: Configuration) -> dict[IRI, Holder]:
    """Another task that holds the controller, which it would share, as in a configuration of its own."""
    return {CONTROL: replace(OTHERS, wants=configuration.wants(CONTROL))}


def repairing() -> History:
    """The tracker was lost, and the controller, which another task shares, is to follow odometry in its place."""
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL, "lost her"))
    history.composed(navigation(ODOMETRY))
    history.answer(ODOMETRY, Call.WAKE)
    history.all_answer(Call.RESERVE)
    history.answer(ODOMETRY, Call.APPLY)
    assert (CONTROL, Call.APPLY) in history.state.pending
    return history


def told_to_wait(history: History, holder: Holder = OTHERS) -> list[Effect]:
    """The controller acts for another task as well, which still wants the tracker."""
    return history.answer(CONTROL, Call.APPLY, Verdict.BUSY, holder=holder, shared=True)


def test_a_task_waits_for_the_others_to_want_the_same_in_place_of_what_all_have_lost() -> None:
    history = repairing()
    assert told_to_wait(history) == [AwaitRelease(CONTROL, history.state.epoch)]
    assert CONTROL not in history.state.lost
    assert applied(history.hear(WaitedLong(CONTROL, history.state.epoch))) == [CONTROL]
    told_to_wait(history)
    assert applied(history.hear(Freed(CONTROL))) == [CONTROL], "the component says that all agree"
    history.answer(CONTROL, Call.APPLY)
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


@pytest.mark.parametrize("told", [lambda epoch: WaitedLong(CONTROL, epoch), lambda epoch: Freed(CONTROL)])
def test_a_component_that_has_not_answered_yet_is_not_asked_again(told: Callable[[int], Event]) -> None:
    """It has been asked again already, and tells all that wait for it that it acts otherwise."""
    history = repairing()
    told_to_wait(history)
    history.hear(WaitedLong(CONTROL, history.state.epoch))
    assert history.hear(told(history.state.epoch)) == []


@pytest.mark.parametrize(("holder", "most"), [(AHEAD, MOST_ASKED_BEHIND), (BEHIND, MOST_ASKED_AHEAD)])
def test_of_two_tasks_that_go_on_to_disagree_one_gives_way_sooner(holder: Holder, most: int) -> None:
    history = repairing()
    for _ in range(most):
        assert told_to_wait(history, holder) == [AwaitRelease(CONTROL, history.state.epoch)]
        history.hear(WaitedLong(CONTROL, history.state.epoch))
    effects = told_to_wait(history, holder)
    assert released(effects) == [CONTROL]
    assert effects[-1] == Compose(3, frozenset({TRACKER, CONTROL}), navigation(ODOMETRY))
    assert history.state.lost[CONTROL].busy
    assert MOST_ASKED_BEHIND < MOST_ASKED_AHEAD


def improving() -> History:
    """Odometry works, but the tracker would be rather had, and the controller is to follow that."""
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(navigation())
    history.answer(TRACKER, Call.WAKE)
    history.all_answer(Call.RESERVE)
    history.answer(TRACKER, Call.APPLY)
    assert history.state.pending == {(CONTROL, Call.APPLY)}
    return history


def test_what_others_share_is_changed_for_the_better_if_they_are_of_lower_priority() -> None:
    history = improving()
    assert told_to_wait(history, replace(OTHERS, priority=-1)) == [AwaitRelease(CONTROL, history.state.epoch)]
    assert applied(history.hear(Freed(CONTROL))) == [CONTROL]
    history.all_answer()
    assert (history.state.phase, history.state.target) == (Phase.RUNNING, navigation())


def test_what_others_share_is_not_changed_for_the_better() -> None:
    history = improving()
    told_to_wait(history)
    assert history.state.target == navigation(ODOMETRY)
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert not history.state.lost


def test_what_others_share_is_known_before_it_is_changed_for_the_better() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered({}, sharers(navigation(ODOMETRY))))
    assert history.composed(navigation()) == [Compose(history.state.attempt, frozenset({(0, TRACKER)}), None)]
    assert history.composed(navigation(ODOMETRY)) == []


def test_a_component_that_others_share_is_done_without_where_it_cannot_do_without_the_sources_to_avoid() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered({}, sharers(navigation(ODOMETRY))))
    history.composed(navigation())
    assert history.composed(REFUSAL) == [Compose(history.state.attempt, frozenset({CONTROL}), None)]
    assert history.composed(REFUSAL) == []
    assert history.state.phase is Phase.RUNNING


def test_a_component_is_shared_as_its_holder_wants_where_that_can_be() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({}, sharers(navigation(ODOMETRY))))
    assert history.composed(navigation()) == [Compose(2, frozenset({(0, TRACKER)}), None)]
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert not history.state.taken


def test_a_task_that_waits_looks_again_when_what_it_would_share_begins_to_act_for_another_task() -> None:
    history = History(replace(TASK, patient=True))
    history.hear(Accepted(100), Discovered({}, sharers(navigation(ODOMETRY))))
    history.composed(navigation())
    history.composed(REFUSAL)
    history.composed(REFUSAL)
    history.composed(navigation())
    assert (history.state.phase, history.state.queued) == (Phase.REFUSED, {CONTROL})
    assert history.hear(BegunElsewhere(TRACKER)) == []
    assert history.hear(BegunElsewhere(CONTROL)) == [Discover()]
    history.hear(Discovered({}, sharers(navigation())))
    assert kinds(history.composed(navigation()))[-1] is WakeUp


def test_a_loss_begins_a_search_that_avoids_nothing() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({}, sharers(navigation(ODOMETRY))))
    history.composed(navigation())
    assert history.hear(Discovered()) == []
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    effects = history.hear(Failed(ODOMETRY, "1", Cause.FAIL))
    assert effects[-1] == Compose(3, frozenset({ODOMETRY}), navigation(ODOMETRY))
    assert not history.state.avoided


@pytest.mark.parametrize("event", [Freed(CONTROL), Ranked(1)], ids=["free", "ranked"])
def test_a_component_may_be_had_that_others_have_let_go_of_while_a_search_avoids_sources_for_it(event: Event) -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({}, sharers(navigation(ODOMETRY))))
    history.composed(navigation())
    history.hear(event)
    effects = history.composed(REFUSAL)
    assert effects == [Compose(3, frozenset(), None)]
    assert not history.state.taken
