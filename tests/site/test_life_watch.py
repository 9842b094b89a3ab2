"""The watchdog of a site: what has no life, is frozen or does not answer is told from what is well."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Request
from selfconf.model.profile import START_DEADLINE, Profile
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import CallAnswer, Verdict
from selfconf.site.life_watch import (
    BEYOND_DEADLINE,
    FROZEN,
    QUESTION_ACTIVE,
    QUESTION_IDLE,
    WITHOUT_LIFE,
    LifeWatch,
)
from tests.site.served import KEYS, SLEEPER


class Actor:
    """A component with a life that answers, or does not answer, for its state."""

    def __init__(self, network: Network, life: str = "own") -> None:
        self.node: MemoryBus = network.node()
        self.life, self.active, self.answers, self.asked = life, True, True, 0
        self.payload: bytes | None = None
        """What it answers in place of how things are with it."""
        self.node.serve(KEYS.call(SLEEPER, "state"), self._answer)
        self.end_life = self.node.announce(KEYS.life(SLEEPER, life))

    def _answer(self, request: Request) -> None:
        self.asked += 1
        if self.answers:
            answer = CallAnswer(Verdict.DONE, SLEEPER, self.life, active=self.active)
            request.reply(KEYS.call(SLEEPER, "state"), self.payload or encode(answer))
            request.finish()


def watched(network: Network, deadline: float | None = None) -> LifeWatch:
    """The watch over the component, whose process has been given the life `own`."""
    return LifeWatch(network.node(), KEYS, Profile(SLEEPER, deadline=deadline), "own")


def passes(network: Network, seconds: float) -> None:
    """Let time pass."""
    network.run(lambda: False, seconds)


def test_a_process_has_some_time_until_its_component_lives(network: Network) -> None:
    watch = watched(network)
    passes(network, WITHOUT_LIFE - 0.5)
    assert watch.lifeless(frozen=False) is None
    passes(network, 1.0)
    assert "has had no life" in (watch.lifeless(frozen=False) or "")


def test_a_process_that_is_frozen_before_it_lives_is_noticed_soon(network: Network) -> None:
    watch = watched(network)
    passes(network, FROZEN - 0.5)
    assert watch.lifeless(frozen=True) is None
    passes(network, 1.0)
    assert "frozen" in (watch.lifeless(frozen=True) or "")
    assert watch.lifeless(frozen=False) is None


def test_a_component_that_lives_and_answers_is_left_alone(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    passes(network, 100.0)
    assert watch.alive
    assert watch.hanging() is None
    assert 90 <= actor.asked <= 100 / QUESTION_ACTIVE


def test_a_component_that_is_not_active_is_asked_rarely(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    actor.active = False
    passes(network, 100.0)
    assert actor.asked <= 100 / QUESTION_IDLE + 1
    assert watch.hanging() is None


@pytest.mark.parametrize("deadline", [None, 0.5, 30.0])
def test_a_component_that_does_not_answer_for_longer_than_a_callback_may_take_hangs(
    network: Network, deadline: float | None
) -> None:
    watch, actor = watched(network, deadline), Actor(network)
    passes(network, 10.0)
    actor.answers = False
    longest = (deadline or START_DEADLINE) + BEYOND_DEADLINE
    passes(network, longest - 0.5)
    assert watch.hanging() is None
    passes(network, 0.5 + 2 * QUESTION_ACTIVE)
    assert "it hangs" in (watch.hanging() or "")


def test_a_component_that_lives_late_is_watched_from_then_on(network: Network) -> None:
    watch = watched(network)
    passes(network, 5.0)
    Actor(network).answers = False
    passes(network, START_DEADLINE + BEYOND_DEADLINE + 3.0)
    assert "it hangs" in (watch.hanging() or "")


def test_what_is_no_answer_does_not_count_and_is_not_asked_for_at_once(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    actor.payload = b"?"
    seconds = START_DEADLINE + BEYOND_DEADLINE + 3.0
    passes(network, seconds)
    assert "it hangs" in (watch.hanging() or "")
    assert actor.asked <= seconds / QUESTION_ACTIVE


def test_a_component_that_answers_again_in_time_does_not_hang(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    for _ in range(5):
        actor.answers = False
        passes(network, START_DEADLINE - 2.0)
        actor.answers = True
        passes(network, 3.0)
    assert watch.hanging() is None


def test_what_another_life_answers_does_not_count(network: Network) -> None:
    watch, actor, _ = watched(network), Actor(network), Actor(network, "other")
    actor.answers = False
    passes(network, START_DEADLINE + BEYOND_DEADLINE + 3.0)
    assert "it hangs" in (watch.hanging() or "")


def test_a_program_that_names_its_life_itself_is_watched_as_well(network: Network) -> None:
    watch, actor = watched(network), Actor(network, "of-its-own")
    passes(network, 10.0)
    assert watch.is_life("of-its-own")
    assert watch.is_life("own")
    assert not watch.is_life("another")
    assert watch.hanging() is None
    actor.answers = False
    passes(network, START_DEADLINE + BEYOND_DEADLINE + 3.0)
    assert watch.hanging() is not None


@pytest.mark.parametrize("life", ["own", "of-its-own"])
def test_a_life_that_has_ended_was_that_of_the_process(network: Network, life: str) -> None:
    watch, actor = watched(network), Actor(network, life)
    passes(network, 1.0)
    actor.end_life()
    passes(network, 1.0)
    assert watch.was_life(life)
    assert not watch.was_life("another")


def test_the_life_of_a_second_process_is_not_that_of_the_first(network: Network) -> None:
    watch, _, _ = watched(network), Actor(network), Actor(network, "other")
    passes(network, 1.0)
    assert watch.is_life("own")
    assert not watch.is_life("other")
    assert not watch.was_life("other")


def test_a_life_that_ends_begins_the_time_anew(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    passes(network, 100.0)
    actor.end_life()
    passes(network, WITHOUT_LIFE - 1.0)
    assert not watch.alive
    assert watch.lifeless(frozen=False) is None
    passes(network, 2.0)
    assert watch.lifeless(frozen=False) is not None


def test_a_watch_that_is_closed_asks_nothing(network: Network) -> None:
    watch, actor = watched(network), Actor(network)
    passes(network, 3.0)
    asked = actor.asked
    watch.close()
    passes(network, 30.0)
    assert asked <= actor.asked <= asked + 1
