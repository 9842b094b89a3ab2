"""Which inputs are needs, where only the first roles count."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pytest

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import numbers
from tests.search.worlds import component, iri, problem


def test_an_input_that_a_later_role_may_feed_is_no_need_of_the_first_roles() -> None:
    parts = {"cap": [component("cap", "pose:Pose")], "deaf": [component("deaf")], "pose": [component("pose")]}
    by_type, by_name = problem(parts, "deaf>cap pose>cap"), problem(parts, "deaf>cap.pose pose>cap.pose")
    for given_ in (by_type, by_name):
        assert first_solution(reduced(given_, roles=3), Budget()) is None
        assert numbers(first_solution(reduced(given_, roles=2), Budget())) == [0, 0]
    assert first_solution(reduced(problem(parts, "deaf>cap"), roles=2), Budget()) is None


def test_what_an_output_of_a_name_and_a_type_feeds_is_looked_up_once_for_a_role(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    served = Hierarchy.served
    asked: list[Sequence[IRI]] = []

    def noted(self: Hierarchy, signals: Sequence[IRI]) -> Iterable[IRI]:
        asked.append(signals)
        return served(self, signals)

    # Each has another second output, so that all are of classes of their own.
    poses = [component(f"pose{k}", outputs=f"pose:Pose x:Other{k}") for k in range(20)]
    given_ = problem({"pose": poses, "cap": [component("cap", "pose:Pose")]}, "pose.pose>cap.pose")
    monkeypatch.setattr(Hierarchy, "served", noted)
    found = reduced(given_)
    assert [option.kind.supports for option in found.options[0]] == [(0,)] * 20
    assert asked.count((iri("Pose"),)) == 1
