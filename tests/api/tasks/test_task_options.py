"""The options of a task, as a caller of the library names them."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.api.tasks.task_options import AS_USUAL, TaskOptions
from selfconf.configurator import Policy
from selfconf.errors import AuthorError, ProgrammerError


def test_what_is_not_said_is_as_usual() -> None:
    assert TaskOptions.of("repair", "", None, None) == AS_USUAL
    assert TaskOptions.of("dismantle", "tidy", 2, 0.5) == TaskOptions(Policy.DISMANTLE, "tidy", 2, 0.5)


@pytest.mark.parametrize(("policy", "name"), [("mend", "tidy"), ("repair", 7)])
def test_a_policy_and_a_name_that_are_none_are_refused(policy: str, name: Any) -> None:
    with pytest.raises(ProgrammerError):
        TaskOptions.of(policy, name, None, None)


def test_a_name_that_no_task_can_have_is_refused_before_anything_is_begun_for_it() -> None:
    with pytest.raises(AuthorError, match="cannot name a task"):
        TaskOptions.of("repair", "no/name", None, None)
