"""The certificate accepts what is a configuration, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given

from selfconf.certificate import check
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.term import Literal
from selfconf.search import solve
from selfconf.search.problem import Problem
from tests.search.oracle import World
from tests.search.worlds import agreement, component, iri, problem, problems


@given(problems())
@agreement(0.3)
def test_every_answer_is_accepted(problem: Problem) -> None:
    answer = solve.search(problem)
    if isinstance(answer, Configuration):
        assert check(problem.task, problem.partition, answer, problem.hierarchy) == []


@given(problems(roles=3, components=4))
@agreement(0.2)
def test_what_is_accepted_is_valid_by_enumeration_too(problem: Problem) -> None:
    world = World(problem.task, problem.partition, problem.hierarchy)
    configuration = world.first()
    if configuration is None or len(configuration.components) < 2:
        return
    swapped = configuration.components[1], configuration.components[0], *configuration.components[2:]
    assignments, rest = [], list(swapped)
    for assignment in configuration.assignments:
        taken, rest = rest[: len(assignment.components)], rest[len(assignment.components) :]
        assignments.append(Assignment(assignment.role, tuple(taken)))
    by_role = [{c.profile.component: c for c in candidates} for candidates in problem.candidates]
    players = [[known[c] for c in a.components if c in known] for known, a in zip(by_role, assignments, strict=True)]
    eligible = all(len(p) == len(a.components) for p, a in zip(players, assignments, strict=True))
    faults = check(
        problem.task, problem.partition, replace(configuration, assignments=tuple(assignments)), problem.hierarchy
    )
    if not (eligible and world.valid(players)):
        assert faults


def _answer() -> tuple[Problem, Configuration]:
    given_ = problem(
        {
            "eye": [component("camera", outputs="o:Image"), component("spare", outputs="o:Image")],
            "mind": [component("cap", "i:Image")],
        },
        "eye>mind",
    )
    answer = solve.search(given_)
    assert isinstance(answer, Configuration)
    return given_, answer


BROKEN = {
    "is not eligible": {
        "assignments": (Assignment(iri("eye"), (iri("cap"),)), Assignment(iri("mind"), (iri("camera"),)))
    },
    "plays 2 parts": {"assignments": (Assignment(iri("eye"), (iri("cap"),)), Assignment(iri("mind"), (iri("cap"),)))},
    "asks for 1 components and has 0": {
        "assignments": (Assignment(iri("eye"), ()), Assignment(iri("mind"), (iri("cap"),)))
    },
    "allows 1 components and has 2": {
        "assignments": (Assignment(iri("eye"), (iri("camera"), iri("spare"))), Assignment(iri("mind"), (iri("cap"),)))
    },
    "its roles are not those of the template": {"assignments": ()},
    "it is a configuration of other": {"template": iri("other")},
    "this connection is missing": {"connections": ()},
    "no interaction makes this connection": {
        "connections": (
            Connection(iri("camera"), "o", iri("cap"), "i"),
            Connection(iri("cap"), "i", iri("camera"), "o"),
        )
    },
    "there 2 times": {"connections": (Connection(iri("camera"), "o", iri("cap"), "i"),) * 2},
    "is not asked for": {"settings": (ParameterSetting(iri("cap"), "goal", Literal("1")),)},
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_fault_is_named(fault: str) -> None:
    given_, answer = _answer()
    assert any(fault in said for said in check(given_.task, given_.partition, replace(answer, **BROKEN[fault])))
