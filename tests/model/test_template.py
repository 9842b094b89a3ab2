"""Templates and tasks as values."""

from __future__ import annotations

import pytest

from selfconf.model.template import Role, Template
from selfconf.model.term import IRI


def test_a_template_finds_its_roles_by_iri() -> None:
    template = Template(IRI("urn:t"), (Role(IRI("urn:r")),))
    assert template.role(IRI("urn:r")) == Role(IRI("urn:r"))
    with pytest.raises(KeyError):
        template.role(IRI("urn:x"))
