"""The fewest recruits: fewer than a chain of suppliers may have, and never a circle."""

from __future__ import annotations

import pytest

from selfconf.search.budget import Budget
from selfconf.search.recruiting.fewest_recruits import fewest
from tests.search.recruiting.test_recruit_choice import choice
from tests.search.worlds import component

ONE_FOR_EACH = (component("a", "t:T u:U", "s:S"), component("b", "", "t:T"), component("c", "", "u:U"))
ONE_FOR_ALL = component("d", "", "t:T u:U")


def test_a_supplier_of_all_is_better_than_one_for_each() -> None:
    pytest.importorskip("pysat")
    given = choice(*ONE_FOR_EACH, ONE_FOR_ALL)
    assert fewest(given, Budget()) == ([0, 3], True)


def test_a_circle_that_would_be_smaller_is_excluded() -> None:
    pytest.importorskip("pysat")
    given = choice(
        component("a", "t:T", "s:S"),
        component("b", "s:S", "t:T"),
        component("c", "u:U", "t:T"),
        component("d", "", "u:U"),
    )
    assert fewest(given, Budget()) == ([0, 2, 3], True)


def test_where_no_steps_are_left_it_is_what_cannot_be_spared() -> None:
    pytest.importorskip("pysat")
    given = choice(component("a", "t:T", "s:S"), component("b", "", "t:T"), component("c", "", "s:S"))
    found, proved = fewest(given, Budget(0))
    assert given.sufficient(found)
    assert not proved


def test_one_is_exchanged_for_another_where_no_steps_are_left_to_prove_it() -> None:
    pytest.importorskip("pysat")
    given = choice(*ONE_FOR_EACH, ONE_FOR_ALL)
    assert fewest(given, Budget(0)) == ([0, 1, 2], False)
    assert fewest(given, Budget(1)) == ([0, 3], False)
