"""The trials of relaxations are limited, by a number that grows with the ecology, and say when they end before."""

from __future__ import annotations

import pytest

from selfconf.model.refusal import Refusal
from selfconf.search import relaxation_effort
from selfconf.search.relaxations import relaxations, with_relaxations
from selfconf.search.strategies import first
from tests.search.worlds import component, problem


@pytest.mark.slow
def test_what_may_be_tried_grows_with_the_ecology(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(relaxation_effort, "TRIAL_STEPS", 100)
    given_ = problem({f"r{number}": [component(f"c{other}") for other in range(59)] for number in range(60)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert str(next(relaxations(given_, refused))) == "add one more component for the role r0"


def test_a_search_for_repairs_that_ends_before_all_was_tried_says_so() -> None:
    given_ = problem({f"r{number}": [component(f"c{other}") for other in range(9)] for number in range(10)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    whole = with_relaxations(given_, refused)
    assert not whole.repairs_stopped
    for steps in (1, 100, 500, 2000):
        found = with_relaxations(given_, refused, steps=steps)
        assert found.repairs_stopped or found.repairs == whole.repairs
        assert set(map(str, found.repairs)) <= set(map(str, whole.repairs))
    assert with_relaxations(given_, refused, steps=1).repairs_stopped
