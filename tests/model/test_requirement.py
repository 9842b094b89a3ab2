"""Requirements, in words."""

from __future__ import annotations

from typing import get_args

from selfconf.model.profile import WantedSignal
from selfconf.model.requirement import InputFed, OneRoleEach, OneValue, Requirement, RolePlayed
from selfconf.model.term import IRI

ROLE, SIGNAL = IRI("urn:mind"), IRI("urn:Image")
WORDED: dict[Requirement, str] = {
    RolePlayed(ROLE): "mind is played",
    InputFed(ROLE, WantedSignal((SIGNAL,))): "mind gets the Image that it needs",
    InputFed(ROLE, WantedSignal((SIGNAL,)), "left"): "mind gets the Image that it needs at 'left'",
    OneValue("room"): "there is one room for all",
    OneRoleEach(): "no component plays two roles",
}


def test_every_requirement_is_worded() -> None:
    assert {type(requirement) for requirement in WORDED} == set(get_args(Requirement))
    assert {requirement: str(requirement) for requirement in WORDED} == WORDED


def test_requirements_of_the_same_facts_are_one() -> None:
    assert {RolePlayed(ROLE), RolePlayed(IRI("urn:mind")), OneRoleEach(), OneRoleEach()} == {
        RolePlayed(ROLE),
        OneRoleEach(),
    }
