"""A refusal is explained as far as there is time, and the last one is not explained again."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.method import Method
from selfconf.api.task import completed
from selfconf.api.tasks.refusal_explanations import RefusalExplanations
from selfconf.api.tasks.run_outcomes import composing
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

CLOCK = Path(__file__).resolve().parents[3] / "examples" / "clock"


class Refused:
    """A task that is refused among the components of the example, and what is found out about that."""

    def __init__(self) -> None:
        task = completed(sc.template(CLOCK / "tell-the-time.ttl").bind(room=":cellar"))
        method = Method.of("first", "syntactic", (), None, None)
        composer = method.composer(task)
        self.described = 0
        self.explanations = RefusalExplanations(task, method, composer, self._described)
        self._compose, self._home = composing(composer, None), sc.read(CLOCK).advertisements()
        self.refusal = self.refused()

    def refused(self, *without: str) -> Refusal:
        """The refusal among all components but some."""
        left = {component: one for component, one in self._home.items() if component.short not in without}
        outcome = self._compose(left, frozenset(), None)
        assert isinstance(outcome, Refusal)
        return outcome

    def _described(self) -> dict[IRI, Advertisement]:
        self.described += 1
        return {}


@pytest.fixture
def refused() -> Refused:
    """A task that is refused."""
    return Refused()


@pytest.mark.parametrize("over", [True, False])
def test_a_refusal_is_explained_once_by_what_would_help(refused: Refused, over: bool) -> None:
    explain = refused.explanations.in_full if over else refused.explanations.meanwhile
    explained = explain(refused.refusal)
    assert [str(miss) for miss in explained.near_misses] == ["its place is kitchen, not cellar"]
    assert explained.repairs
    assert not refused.refusal.repairs
    assert explain(refused.refusal) is explained
    assert refused.described == 1
    assert not explain(refused.refused("display")).near_misses, "in another ecology it is another refusal"


def test_of_a_last_refusal_that_had_no_time_nothing_more_is_found_out(refused: Refused) -> None:
    waiting = refused.explanations.with_places(refused.refusal, is_last=False)
    assert not waiting.repairs
    assert refused.explanations.in_full(refused.refusal).repairs
    last = refused.explanations.with_places(refused.refusal, is_last=True)
    assert refused.explanations.in_full(refused.refusal) is last
    assert not last.repairs
