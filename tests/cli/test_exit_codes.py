"""What a command returns says whether all have answered that it has asked."""

from __future__ import annotations

import pytest

from selfconf import join
from selfconf.cli.exit_codes import code_of_tasks
from tests.cli.processes import Home
from tests.suspended_run import suspended_run

pytestmark = pytest.mark.process


def test_a_run_of_this_machine_that_is_suspended_leaves_the_tasks_unknown(
    home: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
    home.site("attic", "ads")
    with join(home.ecology, connect=[home.endpoint()]) as living:
        assert living.tasks == ()
        assert code_of_tasks(living) == 0
        with suspended_run(home.ecology, "patrol", home.endpoint()):
            assert living.tasks == ()
            assert code_of_tasks(living) == 2
        assert living.tasks == ()
        assert code_of_tasks(living) == 0
