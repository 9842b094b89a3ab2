"""Templates and tasks as values."""

from __future__ import annotations

import pytest

from selfconf.model.template import Parameter, Role, Task, Template
from selfconf.model.term import IRI, Literal


def test_a_template_finds_its_roles_by_iri() -> None:
    template = Template(IRI("urn:t"), (Role(IRI("urn:r")),))
    assert template.role(IRI("urn:r")) == Role(IRI("urn:r"))
    with pytest.raises(KeyError):
        template.role(IRI("urn:x"))


def test_the_bindings_of_a_task_are_known_by_the_names_of_its_parameters() -> None:
    parameters = (Parameter(IRI("urn:p"), "room"), Parameter(IRI("urn:q"), "goal"))
    template = Template(IRI("urn:t"), (), parameters=parameters)
    assert Task(template, {IRI("urn:q"): Literal("x")}).by_name() == {"goal": Literal("x")}
    assert Task(template).by_name() == {}
    with pytest.raises(KeyError):
        Task(template, {IRI("urn:r"): Literal("x")}).by_name()
