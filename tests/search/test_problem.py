"""The rules of the problem that every strategy shares: which outputs feed which inputs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.profile import Output, Ports
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
