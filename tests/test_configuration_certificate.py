"""The certificate accepts what is a configuration, and nothing else."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given

from selfconf import configuration_certificate
from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.partition import Recruit
from selfconf.model.template import Parameter, Setting, Task
from selfconf.model.term import Literal
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruiting import recruited
from selfconf.search.strategies import first
from tests.search.oracle import World
from tests.search.worlds import agreement, component, iri, problem, problems


@given(problems())
@agreement(0.3)
def test_every_answer_is_accepted(problem: Problem) -> None:
    answer = first.search(problem)
    if isinstance(answer, Configuration):
        assert broken_conditions(problem.task, problem.partition, answer, problem.hierarchy) == []


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
    faults = broken_conditions(
        problem.task, problem.partition, replace(configuration, assignments=tuple(assignments)), problem.hierarchy
    )
    if not (eligible and world.valid(players)):
        assert faults


def _answer() -> tuple[Problem, Configuration]:
    """Return a problem and its answer: a camera on Astrid, a mind that is set to that robot, a goal that is bound."""
    plain = problem(
        {
            "eye": [component("camera", outputs="o:Image"), component("spare", outputs="o:Image")],
            "mind": [component("cap", "i:Image"), component("idle"), component("mute")],
        },
        "eye>mind",
        {"mind": (1, 3)},
        values={"eye": {"camera": 0b01}},
        domain=("Astrid", "Pippi"),
    )
    template = plain.task.template
    eye, mind = template.roles
    template = replace(
        template,
        roles=(eye, replace(mind, settings=(Setting(iri("Goal"), iri("robot")),))),
        parameters=(Parameter(iri("robot"), "robot", in_shape=True, is_set=True), Parameter(iri("goal"), "goal")),
    )
    given_ = Problem(Task(template, {iri("goal"): GOAL}), plain.partition)
    answer = first.search(given_)
    assert isinstance(answer, Configuration)
    assert broken_conditions(given_.task, given_.partition, answer) == []
    return given_, answer


GOAL = Literal("(AT BEDROOM)")
BROKEN: dict[str, dict[str, Any]] = {
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
    "mind asks for 1 components, and mute is not connected": {
        "assignments": (
            Assignment(iri("eye"), (iri("camera"),)),
            Assignment(iri("mind"), (iri("cap"), iri("idle"), iri("mute"))),
        )
    },
    "its roles are not those of the template": {"assignments": ()},
    "it is a configuration of other": {"template": iri("other")},
    "this connection is missing": {"connections": ()},
    "the input 'i' of cap is not fed": {"connections": ()},
    "no interaction makes this connection": {
        "connections": (
            Connection(iri("camera"), "o", iri("cap"), "i"),
            Connection(iri("cap"), "i", iri("camera"), "o"),
        )
    },
    "there 2 times": {"connections": (Connection(iri("camera"), "o", iri("cap"), "i"),) * 2},
    "goal is bound to (AT BEDROOM), not to (AT KITCHEN)": {
        "bindings": {"goal": Literal("(AT KITCHEN)"), "robot": iri("Astrid")}
    },
    "goal is bound to (AT BEDROOM), not to None": {"bindings": {"robot": iri("Astrid")}},
    "robot has no value, and 1 components depend on it": {"bindings": {"goal": GOAL}},
    "robot is urn:test:Karlsson, which no candidate allows": {"bindings": {"goal": GOAL, "robot": iri("Karlsson")}},
    "camera does not allow robot to be urn:test:Pippi": {"bindings": {"goal": GOAL, "robot": iri("Pippi")}},
    "the role mind sets a parameter to something that has no value": {"bindings": {"goal": GOAL}},
    "is not asked for": {"settings": (ParameterSetting(iri("cap"), "goal", Literal("1")),)},
    "setting 'goal' of cap to urn:test:Astrid is missing": {"settings": ()},
}


def _recruited() -> tuple[Problem, Configuration]:
    """Return a problem in which a user is fed by a maker, which is fed by a source; both are recruited."""
    plain = problem({"user": [component("user", "s:S", "u:U")]})
    names = {
        "maker": component("maker", "t:T", "s:S"),
        "source": component("source", "", "t:T"),
        "loop": component("loop", "s:S", "t:T"),
        "other": component("other", "", "s:S"),
    }
    recruits = tuple(Recruit(one, frozenset(() if name == "other" else (0,))) for name, one in names.items())
    template = replace(plain.task.template, roles=(replace(plain.roles[0], recruits=True),))
    given_ = Problem(replace(plain.task, template=template), replace(plain.partition, recruits=recruits))
    found = recruited(given_, first.search(given_))
    assert found is not None
    return given_, found[0]


FEEDS, SUPPLIES = Connection(iri("maker"), "s", iri("user"), "s"), Connection(iri("source"), "t", iri("maker"), "t")
BADLY_RECRUITED: dict[str, dict[str, Any]] = {
    "nobody cannot be recruited": {"recruits": (iri("nobody"),)},
    "source is recruited and feeds nothing": {"connections": (FEEDS,)},
    "the output cannot feed the input": {"connections": (FEEDS, replace(SUPPLIES, output="x"))},
    "the input has a source besides": {"connections": (FEEDS, SUPPLIES, replace(FEEDS, source=iri("other")))},
    "no recruit of this role feeds it": {
        "connections": (replace(FEEDS, source=iri("other")),),
        "recruits": (iri("other"),),
    },
    "the recruits loop, maker feed each other in a cycle": {
        "connections": (
            FEEDS,
            Connection(iri("loop"), "t", iri("maker"), "t"),
            Connection(iri("maker"), "s", iri("loop"), "s"),
        ),
        "recruits": (iri("maker"), iri("loop")),
    },
}


def test_of_a_long_chain_of_recruits_each_connection_is_looked_at_a_few_times() -> None:
    class Followed(list[Connection]):
        """Connections that count how often they are gone through."""

        times = 0

        def __iter__(self) -> Iterator[Connection]:
            Followed.times += 1
            return super().__iter__()

    recruits = [iri(f"r{k:03}") for k in range(200)]
    chain = [Connection(source, "s", sink, "s") for source, sink in pairwise(recruits)]
    assert not list(configuration_certificate._cycle(recruits, Followed(chain)))
    assert list(configuration_certificate._cycle(recruits, [*chain, Connection(recruits[-1], "s", recruits[0], "s")]))
    assert Followed.times == 1


@pytest.mark.parametrize("fault", [*BROKEN, *BADLY_RECRUITED])
def test_a_fault_is_named(fault: str) -> None:
    assert any(fault in said for said in _said(fault))


def _said(fault: str) -> list[str]:
    given_, answer = _answer() if fault in BROKEN else _recruited()
    changed = replace(answer, **(BROKEN | BADLY_RECRUITED)[fault])
    return broken_conditions(given_.task, given_.partition, changed)


def _sentences() -> list[str]:
    """Every sentence of the certificate, as a pattern."""
    return [
        "".join(re.escape(str(part.value)) if isinstance(part, ast.Constant) else ".+" for part in parts)
        for node in ast.walk(ast.parse(inspect.getsource(configuration_certificate)))
        if isinstance(node, ast.Yield) and isinstance(node.value, ast.Constant | ast.JoinedStr)
        for parts in [node.value.values if isinstance(node.value, ast.JoinedStr) else [node.value]]
    ]


def test_every_sentence_of_the_certificate_is_earned_by_a_fault() -> None:
    named = [said for fault in (*BROKEN, *BADLY_RECRUITED) for said in _said(fault) if fault in said]
    sentences = _sentences()
    assert len(sentences) >= 16
    for sentence in sentences:
        assert any(re.fullmatch(sentence, said) for said in named), sentence
