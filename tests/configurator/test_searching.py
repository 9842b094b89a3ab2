"""What the configurator does when no configuration is found: it refuses its task, or waits for something to appear."""

from __future__ import annotations

from selfconf.configurator.effects import (
    Compose,
    Discover,
    Finish,
    Running,
    Unwatch,
)
from selfconf.configurator.events import (
    Appeared,
    Call,
    Discovered,
    Failed,
    Stopped,
)
from selfconf.configurator.state import MOST_PUT_OFF, Phase
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    ODOMETRY,
    PATIENT,
    REFUSAL,
    TRACKER,
    History,
    kinds,
    navigation,
    released,
)


def test_a_refusal_releases_all_that_was_touched() -> None:
    history = History().running()
    history.hear(Failed(DRIVE, "1", Cause.FAIL))
    effects = history.composed(REFUSAL)
    assert effects[:3] == [Unwatch(component) for component in sorted([TRACKER, CONTROL, DRIVE])]
    assert sorted(released(effects)) == sorted([DRIVE, CONTROL])  # what the drive gave up feeds nothing any more
    history.answer(DRIVE, Call.RELEASE)
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish(REFUSAL)]
    assert (history.state.phase, dict(history.state.held)) == (Phase.REFUSED, {})


def test_a_refusal_with_nothing_touched_ends_at_once() -> None:
    history = History().accepted()
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]


def test_a_refusal_is_said_once() -> None:
    history = History().accepted()
    history.composed(REFUSAL)
    assert history.hear(Stopped()) == []
    assert history.hear(Appeared({ODOMETRY: "2"})) == []


def test_a_refusal_does_not_count_if_something_has_appeared_since_the_ecology_was_asked() -> None:
    history = History().running()
    history.hear(Appeared({ODOMETRY: "1"}), Failed(TRACKER, "1", Cause.FAIL))
    assert history.composed(REFUSAL) == [Discover()]
    assert history.hear(Discovered()) == [Compose(3, frozenset({TRACKER}), navigation())]
    assert history.composed(REFUSAL)[-1] != Discover()


def test_where_something_appears_all_the_time_a_task_is_refused_all_the_same() -> None:
    history = History().accepted()
    for _ in range(MOST_PUT_OFF):
        history.hear(Appeared({ODOMETRY: "1"}))
        assert history.composed(REFUSAL) == [Discover()]
        history.hear(Discovered())
    history.hear(Appeared({ODOMETRY: "1"}))
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]


def test_a_loss_while_the_ecology_is_asked_waits_for_its_answer() -> None:
    history = History().running()
    history.hear(Appeared({}), Failed(TRACKER, "1", Cause.FAIL))
    history.composed(REFUSAL)
    effects = history.hear(Failed(DRIVE, "1", Cause.FAIL))
    assert released(effects) == [DRIVE]
    assert history.state.phase is Phase.DISCOVERING
    assert history.hear(Discovered()) == [Compose(3, frozenset({TRACKER, DRIVE}), navigation())]


def test_patience_waits_for_something_to_appear() -> None:
    history = History(PATIENT).accepted()
    assert history.composed(REFUSAL) == []
    assert history.state.phase is Phase.REFUSED
    assert history.hear(Appeared({})) == [Discover()]
    history.hear(Discovered())
    history.composed(navigation())
    assert kinds(history.all_answer()) == [Running]


def test_patience_does_not_miss_what_appears_while_everything_is_taken_down() -> None:
    history = History(PATIENT).running()
    history.hear(Failed(DRIVE, "1", Cause.FAIL))
    history.composed(REFUSAL)
    history.hear(Appeared({DRIVE: "2"}))
    assert history.all_answer() == [Discover()]


def test_patience_tries_again_what_has_refused_a_call_without_saying_in_which_life() -> None:
    """Such an answer is an error of the bus: the component knows no input of the name that is advertised by now."""
    history = History(PATIENT).reserved()
    history.answer(TRACKER, Call.APPLY, Verdict.REFUSED, life="")
    history.composed(REFUSAL)
    history.all_answer()
    assert history.state.phase is Phase.REFUSED
    assert history.hear(Appeared({TRACKER: ""})) == [Discover()]
    assert history.hear(Discovered()) == [Compose(3, frozenset(), None)]


def test_patience_ends_with_a_stop() -> None:
    history = History(PATIENT).accepted()
    history.composed(REFUSAL)
    assert history.hear(Stopped()) == [Finish()]
    assert history.state.phase is Phase.STOPPED
