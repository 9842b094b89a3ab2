"""Whether a hub answers is asked in time that a simulated network passes."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.api.sites.hub_health import BUSY, HUB_ANSWER, UNANSWERED, HubHealth
from selfconf.bus.memory import MemoryBus, Network


class Hub:
    """A hub of which it is said after how many seconds each answer comes; the end of the time is an empty answer."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.network = Network()
        self.bus = self.network.node()
        self.seconds, self.asked, self.broken = 0.01, list[float](), list[float]()
        self.health = HubHealth(self.bus, "lives", lambda: self.broken.append(self.bus.now()))
        monkeypatch.setattr(MemoryBus, "roll_call", self._roll_call)

    def _roll_call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        assert (key, seconds) == ("lives", HUB_ANSWER)
        self.asked.append(self.bus.now())
        self.bus.later(self.seconds, lambda: done(()))

    def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        self.network.run(lambda: False, seconds)


@pytest.fixture
def hub(monkeypatch: pytest.MonkeyPatch) -> Hub:
    """A hub that answers."""
    return Hub(monkeypatch)


def test_a_hub_that_answers_is_asked_once(hub: Hub) -> None:
    hub.health.ask()
    hub.pass_time(10.0)
    assert (len(hub.asked), hub.broken) == (1, [])


def test_a_hub_is_broken_that_leaves_some_questions_in_a_row_unanswered(hub: Hub) -> None:
    hub.seconds = HUB_ANSWER
    hub.health.ask()
    hub.health.ask()
    hub.pass_time(UNANSWERED * HUB_ANSWER + 0.1)
    assert hub.asked == pytest.approx([number * HUB_ANSWER for number in range(UNANSWERED)], abs=0.1)
    assert hub.broken == pytest.approx([UNANSWERED * HUB_ANSWER], abs=0.1)
    hub.pass_time(10.0)
    assert len(hub.asked) == UNANSWERED, "it is asked no more by itself"


def test_a_hub_that_answers_in_between_is_not_broken(hub: Hub) -> None:
    hub.seconds = HUB_ANSWER
    hub.health.ask()
    hub.pass_time((UNANSWERED - 1) * HUB_ANSWER - 0.1)
    hub.seconds = 0.01
    hub.pass_time(10.0)
    hub.seconds = HUB_ANSWER
    hub.health.ask()
    hub.pass_time((UNANSWERED - 1) * HUB_ANSWER + 0.1)
    assert hub.broken == []


def test_what_is_heard_too_late_says_that_this_program_was_busy_and_nothing_of_the_hub(hub: Hub) -> None:
    hub.seconds = HUB_ANSWER + BUSY + 0.1
    hub.health.ask()
    hub.pass_time(10 * hub.seconds)
    assert hub.broken == []
    assert len(hub.asked) >= 10, "so it is asked again at once"
