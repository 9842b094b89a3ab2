"""The rules of the problem that every strategy shares: which outputs feed which inputs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.profile import OperationalParameter, Output, Ports
from selfconf.model.template import Setting
from selfconf.model.term import Literal
from selfconf.search.problem import Problem
from selfconf.search.strategies import first
from tests.search.worlds import component, iri, problem


def test_a_problem_is_printed_with_its_task_and_candidates() -> None:
    plain = problem({"source": [component("a", "", "o:Pose")], "sink": [component("b", "i:Pose")]}, "source>sink")
    assert repr(plain) == f"Problem({plain.task!r}, {plain.partition!r})"
    assert "<urn:test:source>" in repr(plain)


@pytest.mark.parametrize("hierarchy", [NOTHING_ABOVE, Hierarchy([(iri("Pose"), iri("Place"))])])
def test_an_output_without_a_type_that_is_named_feeds_under_every_hierarchy(hierarchy: Hierarchy) -> None:
    source = replace(component("a"), ports=Ports((), (Output("o", ()),)))
    plain = problem({"source": [source], "sink": [component("b", "i:Pose")]}, "source.o>sink.i")
    answer = first.search(Problem(plain.task, plain.partition, hierarchy))
    assert isinstance(answer, Configuration)
    assert [(one.output, one.input) for one in answer.connections] == [("o", "i")]


def test_what_a_role_could_serve_is_what_lies_above_the_outputs_of_its_candidates() -> None:
    plain = problem(
        {"source": [component("a", "", "o:Pose"), component("b", "", "o:Image")], "sink": []}, "source>sink"
    )
    above = Problem(plain.task, plain.partition, Hierarchy([(iri("Pose"), iri("Place"))]))
    assert plain.served(0) == {iri("Pose"), iri("Image")}
    assert above.served(0) == above.served(0) == {iri("Pose"), iri("Image"), iri("Place")}
    assert above.served(1) == frozenset()


def test_a_parameter_that_several_settings_match_has_one_value() -> None:
    limit, hard = iri("Limit"), iri("HardLimit")
    parameters = OperationalParameter("low", limit), OperationalParameter("high", hard)
    plain = problem({"lamp": [replace(component("a"), parameters=parameters)]})
    role = replace(plain.roles[0], settings=(Setting(hard, Literal("2")), Setting(limit, Literal("1"))))
    task = replace(plain.task, template=replace(plain.task.template, roles=(role,)))
    below = Hierarchy([(hard, limit)])
    answer = first.search(Problem(task, plain.partition, below))
    assert isinstance(answer, Configuration)
    assert {(one.name, str(one.value)) for one in answer.settings} == {("low", "1"), ("high", "2")}
    assert len(answer.settings) == 2
    assert broken_conditions(task, plain.partition, answer, below) == []
