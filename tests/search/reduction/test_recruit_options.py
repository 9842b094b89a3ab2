"""Recruits as options of a role without slots: those that matter, and none that another could always replace."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from selfconf.search.reduction import with_recruits as reduced_with_recruits
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.worlds import component, problem


def test_what_leads_to_no_player_or_cannot_be_fed_is_no_option() -> None:
    recruits = [
        component("a", "t:T", "s:S"),
        component("b", "", "t:T"),
        component("useless", "", "u:U"),
        component("hungry", "v:V", "s:S"),
    ]
    found = reduced_with_recruits(with_recruits(problem({"user": [component("user", "s:S")]}), *recruits))
    assert [option.number for option in found.options[-1]] == [0, 1]
    assert found.slots == (0,)


def test_of_equal_recruits_one_is_an_option_and_more_where_it_could_be_a_player() -> None:
    one = component("one", "", "s:S")
    same = [replace(one, component=f"urn:test:{name}") for name in ("two", "three", "four")]
    given = with_recruits(problem({"user": [component("user", "s:S")]}), one, *same)
    assert [option.number for option in reduced_with_recruits(given).options[-1]] == [0]
    playing = with_recruits(problem({"user": [component("user", "s:S")], "job": [one]}), one, *same)
    assert [option.number for option in reduced_with_recruits(playing).options[-1]] == [0, 1]
    last = reduced_with_recruits(given, rank=lambda number: (Fraction(-number),))
    assert [option.number for option in last.options[-1]] == [3]


def test_a_player_may_feed_what_is_recruited_along_no_interaction() -> None:
    given = with_recruits(problem({"user": [component("user", "s:S", "t:T")]}), component("a", "t:T", "s:S"))
    found = reduced_with_recruits(given)
    (player,), (recruit,) = found.options
    assert set(recruit.kind.needs) <= set(player.kind.supports)
    assert set(player.kind.needs) <= set(recruit.kind.supports)
