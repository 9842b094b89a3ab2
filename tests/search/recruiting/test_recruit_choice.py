"""What some recruits are enough for: placed one after another, and without what can be spared."""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.profile import Profile
from selfconf.search.recruiting.recruit_choice import RecruitChoice
from selfconf.search.strategies import first
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.worlds import component, problem


def choice(*recruits: Profile) -> RecruitChoice:
    """The choice for a user that wants a signal S."""
    given = with_recruits(problem({"user": [component("user", "s:S")]}), *recruits)
    found = first.search(given)
    assert isinstance(found, Configuration)
    return RecruitChoice(given, found, ())


def test_what_only_feeds_itself_has_no_place() -> None:
    given = choice(component("a", "t:T", "s:S"), component("b", "s:S", "t:T"), component("c", "", "s:S"))
    assert given.placed([0, 1]) == []
    assert given.placed([0, 1, 2]) == [2, 1, 0]
    assert not given.sufficient([0, 1])
    assert given.sufficient([2])


def test_what_plays_is_no_recruit() -> None:
    user = component("user", "s:S", "t:T")
    given = with_recruits(problem({"user": [user]}), user, component("a", "t:T", "s:S"))
    found = first.search(given)
    assert isinstance(found, Configuration)
    assert sorted(RecruitChoice(given, found, ()).needs) == [1]


def test_a_chain_is_enough_and_what_can_be_spared_leaves_it() -> None:
    given = choice(component("a", "t:T u:U", "s:S"), component("b", "", "t:T"), component("c", "", "t:T u:U"))
    assert given.sufficient(given.chain())
    assert given.without_spare([0, 1, 2]) == [0, 2]


def test_a_supplier_of_two_needs_is_counted_once() -> None:
    given = choice(
        component("a", "t:T u:U", "s:S"),
        component("b", "x:X", "t:T u:U"),
        component("c", "", "x:X"),
        component("d", "y:Y z:Z", "s:S"),
        component("e", "", "y:Y"),
        component("f", "", "z:Z"),
        component("g", "s:S y:Y", "s:S"),
    )
    assert given.chain() == [0, 1, 2]


def test_one_is_exchanged_for_what_the_others_feed() -> None:
    given = choice(component("a", "t:T", "s:S"), component("b", "", "t:T"), component("c", "t:T", "s:S u:U"))
    assert given.exchanged([0, 1], 0) == [1, 2]
    assert given.exchanged([0, 1], 1) is None


def test_of_recruits_that_need_and_issue_the_same_the_first_is_looked_at() -> None:
    twins = component("b", "", "t:T"), component("c", "", "other:T"), component("d", "", "t:T u:U")
    given = choice(component("a", "t:T", "s:S"), *twins)
    assert sorted(given.needs) == [0, 1, 3]
