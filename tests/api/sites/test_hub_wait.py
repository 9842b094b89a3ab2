"""How long a site waits for a hub, by a clock that is turned by hand."""

from __future__ import annotations

import pytest

from selfconf.api.sites.hub_wait import HUNG, REACHED, SLOW, HubWait
from selfconf.bus.zenoh import GREETING

MOMENT = 0.01


class Clock:
    """A clock that is turned by hand, and a wait by it of a site that has two hubs."""

    def __init__(self, endpoints_each: int = 1) -> None:
        self.now = 100.0
        self.wait = HubWait(lambda: self.now, ["one", "two"], endpoints_each)

    def is_over_after(self, seconds: float, suspended: bool = True) -> bool:
        """Whether the wait is over by so many seconds from now, and not a moment before."""
        self.now += seconds - MOMENT
        before = self.wait.is_over(suspended)
        self.now += 2 * MOMENT
        return self.wait.is_over(suspended) and not before


def test_a_site_with_a_hub_waits_for_none() -> None:
    clock = Clock()
    clock.now += 1000.0
    assert not clock.wait.is_over(suspended=True)
    clock.wait.begin()
    clock.wait.end(["two"])
    clock.now += 1000.0
    assert not clock.wait.is_over(suspended=True)
    assert clock.wait.awaited == ["two"]


@pytest.mark.parametrize(("suspended", "seconds"), [(True, HUNG), (False, HUNG + SLOW)])
def test_one_that_is_suspended_is_taken_to_hang_sooner_than_one_that_may_be_busy(
    suspended: bool, seconds: float
) -> None:
    clock = Clock()
    clock.wait.begin()
    assert clock.is_over_after(seconds, suspended)


def test_a_hub_that_is_lost_again_and_again_is_not_waited_for_anew() -> None:
    clock = Clock()
    clock.wait.begin()
    clock.now += HUNG / 2
    clock.wait.begin()
    assert clock.is_over_after(HUNG / 2)


@pytest.mark.parametrize("endpoints_each", [1, 2])
def test_one_that_relays_since_is_left_time_for_handshakes_with_all_before(endpoints_each: int) -> None:
    clock = Clock(endpoints_each)
    clock.wait.begin()
    clock.wait.begin_anew(["three"])
    assert clock.wait.awaited == ["three"]
    assert clock.is_over_after(2 * endpoints_each * GREETING + REACHED)
    clock.wait.begin_anew([])
    assert clock.is_over_after(endpoints_each * GREETING + REACHED)
