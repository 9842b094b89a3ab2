"""Templates and tasks as values."""

from __future__ import annotations

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.profile import OperationalParameter
from selfconf.model.template import Parameter, Role, Setting, Task, Template
from selfconf.model.term import IRI, Literal


def test_a_template_finds_its_roles_by_iri() -> None:
    template = Template(IRI("urn:t"), (Role(IRI("urn:r")),))
    assert template.role(IRI("urn:r")) == Role(IRI("urn:r"))
    with pytest.raises(KeyError):
        template.role(IRI("urn:x"))


def test_a_parameter_has_one_value_that_of_its_own_type_before_one_that_its_type_is_above() -> None:
    limit, hard, soft = (IRI(f"urn:{name}") for name in ("limit", "hard", "soft"))
    below = Hierarchy([(hard, limit), (soft, limit)])
    settings = tuple(Setting(kind, Literal(kind.short)) for kind in (hard, limit))
    role, parameter = Role(IRI("urn:r"), settings=settings), OperationalParameter("low", limit)
    assert role.setting_of(parameter, below) == settings[1]
    assert role.setting_of(OperationalParameter("high", hard), below) == settings[0]
    assert role.setting_of(OperationalParameter("soft", soft), below) is None
    lacking = Role(IRI("urn:r"), settings=(settings[0], Setting(soft, Literal("soft"))))
    assert lacking.setting_of(parameter, below) == settings[0]
    assert lacking.setting_of(parameter, NOTHING_ABOVE) is None


def test_the_bindings_of_a_task_are_known_by_the_names_of_its_parameters() -> None:
    parameters = (Parameter(IRI("urn:p"), "room"), Parameter(IRI("urn:q"), "goal"))
    template = Template(IRI("urn:t"), (), parameters=parameters)
    assert Task(template, {IRI("urn:q"): Literal("x")}).by_name() == {"goal": Literal("x")}
    assert Task(template).by_name() == {}
    with pytest.raises(KeyError):
        Task(template, {IRI("urn:r"): Literal("x")}).by_name()
