"""Tests for `selfconf.deployment.stable_view`."""

from __future__ import annotations

import pytest

from selfconf.deployment.stable_view import CALM, CALM_OVER_NEW_LINK, LONGEST_UNREST, StableView


class Observed:
    """The view of a site, the time, and the link."""

    def __init__(self, *seen: str) -> None:
        self.time, self.link = 100.0, "hub 1"
        self.view = StableView(lambda: self.time, lambda: self.link)
        self.come(*seen)

    def come(self, *sites: str) -> None:
        """Some sites come, one after the other."""
        for site in sites:
            self.view.changes(site, True)

    def go(self, *sites: str) -> None:
        """Some sites go, one after the other."""
        for site in sites:
            self.view.changes(site, False)

    def unrest(self) -> float:
        """For how many seconds more there is unrest."""
        return self.view.unrest()


@pytest.fixture
def observed() -> Observed:
    """Five sites that were seen for a minute."""
    observed = Observed("a", "b", "c", "d", "e")
    observed.time += 60.0
    return observed


def test_a_site_that_begins_waits_until_none_comes_any_more() -> None:
    observed = Observed()
    assert observed.unrest() == pytest.approx(CALM)
    observed.time += 0.6 * CALM
    observed.come("a")
    observed.time += 0.6 * CALM
    assert observed.unrest() == pytest.approx(0.4 * CALM)
    observed.time += 0.5 * CALM
    assert not observed.unrest()


def test_one_that_goes_counts_at_once_and_several_after_a_while(observed: Observed) -> None:
    observed.go("a")
    assert not observed.unrest()
    observed.time += 0.5 * CALM
    observed.go("b")
    assert observed.unrest() == pytest.approx(CALM)
    observed.time += 1.1 * CALM
    assert not observed.unrest()
    observed.go("c")
    assert not observed.unrest()


def test_who_has_come_back_and_goes_counts_at_once_when_at_most_one_is_missing(observed: Observed) -> None:
    observed.go("a", "b", "c", "d")
    observed.come("a", "b")
    assert observed.unrest() > 0.0
    observed.come("d")
    assert not observed.unrest()
    observed.go("a", "d", "c")
    assert not observed.unrest()


@pytest.mark.parametrize("link", ["", "hub 1"], ids=["noticed at once", "noticed later"])
def test_over_a_new_link_nobody_is_taken_for_gone_so_soon(observed: Observed, link: str) -> None:
    observed.go("a", "b", "c")
    observed.link = link
    observed.go("d", "e")
    observed.link = "hub 2"
    observed.time += 2.0 * CALM
    observed.come("a", "b")
    assert observed.unrest() == pytest.approx(CALM_OVER_NEW_LINK)
    observed.time += 1.1 * CALM_OVER_NEW_LINK
    assert not observed.unrest()
    observed.go("a", "b", "c")
    assert observed.unrest() == pytest.approx(CALM)


def test_where_a_hub_is_opened_anew_the_only_site_that_is_missing_is_waited_for(observed: Observed) -> None:
    observed.view.reopens()
    observed.time += 0.05
    observed.go("a")
    assert observed.unrest() == pytest.approx(CALM_OVER_NEW_LINK)
    observed.time += 1.1 * CALM
    observed.come("b")
    assert observed.unrest() == pytest.approx(CALM_OVER_NEW_LINK)
    observed.time += 1.1 * CALM_OVER_NEW_LINK
    assert not observed.unrest()
    observed.go("b")
    assert not observed.unrest()


def test_hubs_that_are_opened_anew_again_and_again_are_waited_for_no_longer_than_a_while(observed: Observed) -> None:
    observed.view.reopens()
    observed.go("a")
    waited = 0.0
    while observed.unrest():
        observed.time += 0.5 * CALM
        waited += 0.5 * CALM
        observed.view.reopens()
    assert LONGEST_UNREST <= waited < LONGEST_UNREST + CALM


def test_a_site_that_comes_does_not_end_the_wait_of_one_that_has_just_begun_and_lost_its_link() -> None:
    observed = Observed()
    observed.link = "hub 2"
    observed.time += 2.0 * CALM
    assert observed.unrest() == pytest.approx(CALM_OVER_NEW_LINK - 2.0 * CALM)
    observed.come("a")
    assert observed.unrest() == pytest.approx(CALM_OVER_NEW_LINK)


def test_a_site_that_has_begun_in_calm_goes_on_at_once_with_what_it_loses_with_its_hub() -> None:
    observed = Observed("a", "b")
    observed.time += 2.0 * CALM
    observed.link = ""
    observed.go("a")
    observed.link = "hub 2"
    assert not observed.unrest()


def test_unrest_that_does_not_end_is_waited_for_no_longer_than_a_while(observed: Observed) -> None:
    observed.go("a", "b")
    waited = 0.0
    while observed.unrest():
        observed.time += 0.5 * CALM
        waited += 0.5 * CALM
        observed.come("x")
        observed.go("x")
    assert LONGEST_UNREST <= waited < LONGEST_UNREST + CALM
