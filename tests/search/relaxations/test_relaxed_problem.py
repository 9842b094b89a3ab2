"""A relaxation changes of a problem what it says, and leaves the rest as it is."""

from __future__ import annotations

from selfconf.model.obstacle import PropertyUnmet
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.property_fault import NotAmong
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AskForFewer,
    LetRecruit,
    Relaxation,
)
from selfconf.search.problem import Problem
from selfconf.search.relaxations.relaxed_problem import relaxed_by
from tests.search.worlds import component, iri, problem


def asked() -> Problem:
    """A task for an eye, which has a candidate, and two minds, of which there is one."""
    cast = {"eye": [component("camera", outputs="i:Image")], "mind": [component("cap", "i:Image")]}
    return problem(cast, counts={"mind": (2, None)})


def candidates(given: Problem) -> list[list[str]]:
    """The names of the candidates of each role."""
    return [[candidate.profile.component.short for candidate in some] for some in given.candidates]


def test_components_that_are_added_and_near_misses_that_are_accepted_are_candidates_of_their_role() -> None:
    two = relaxed_by(asked(), AddComponents((Addition(iri("mind"), 2, ()),)))
    assert [len(some) for some in candidates(two)] == [1, 3]
    unmet = PropertyUnmet(iri("support"), (NotAmong(frozenset((iri("Pippi"),)), frozenset((iri("Astrid"),))),))
    accepted = AcceptNearMiss(NearMiss(iri("eye"), iri("tracker"), unmet), Candidate(component("tracker")))
    assert candidates(relaxed_by(asked(), accepted)) == [["camera", "tracker"], ["cap"]]


def test_an_interaction_and_what_a_role_asks_for_are_changed_in_the_template_alone() -> None:
    changes: list[Relaxation] = [
        AddInteraction(iri("eye"), iri("mind")),
        AskForFewer(iri("mind"), 1),
        LetRecruit(iri("mind"), ()),
    ]
    linked, fewer, recruiting = (relaxed_by(asked(), change) for change in changes)
    assert [(one.source.short, one.sink.short) for one in linked.task.template.interactions] == [("eye", "mind")]
    assert [role.minimum for role in fewer.roles] == [1, 1]
    assert [role.recruits for role in recruiting.roles] == [False, True]
    for changed in (linked, fewer, recruiting):
        assert changed.partition == asked().partition
