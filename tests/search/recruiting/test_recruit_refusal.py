"""Why no players have recruits, without what has nothing to do with it."""

from __future__ import annotations

import pytest

from selfconf.model.refusal import Conflict
from selfconf.model.requirement import InputFed, OneRoleEach, RolePlayed
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruit_refusal import refusal_of_recruits
from selfconf.search.recruiting.recruiting import first_recruited
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.worlds import component, iri, problem


def torn() -> Problem:
    """A user whose only supplier has to play a role, beside a role that has nothing to do with it."""
    supplier = component("supplier", outputs="s:S")
    roles = {"idle": [component("idle")], "user": [component("user", "s:S")], "job": [supplier]}
    return with_recruits(problem(roles), supplier)


def test_what_has_nothing_to_do_with_it_is_no_reason() -> None:
    pytest.importorskip("pysat")
    assert first_recruited(torn()) is None
    refused = refusal_of_recruits(torn())
    (reason,) = refused.reasons
    assert isinstance(reason, Conflict)
    assert refused.irreducible
    assert reason.roles == (iri("user"), iri("job"))
    kinds = [type(one) for one in reason.requirements]
    assert kinds == [RolePlayed, RolePlayed, InputFed, OneRoleEach]


@pytest.mark.usefixtures("no_solvers")
def test_without_a_solver_all_roles_are_named_and_nothing_is_proved() -> None:
    refused = refusal_of_recruits(torn())
    assert not refused.irreducible
    assert [type(one) for one in refused.reasons] == [Conflict]


def test_where_no_steps_are_left_the_reason_may_be_reducible() -> None:
    pytest.importorskip("pysat")
    assert not refusal_of_recruits(torn(), steps=0).irreducible
