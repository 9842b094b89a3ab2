"""The tasks that run are told by their configurators; who tells none is passed over."""

from __future__ import annotations

from pathlib import Path

import selfconf as sc
from selfconf.api.answer import Method
from selfconf.api.detached import task_record
from selfconf.configurator.state import Policy
from selfconf.protocol.keys import Keys
from selfconf.serve.running_tasks import running_tasks
from tests.lab import NAVIGATE, Lab
from tests.serve.asgi import meanwhile


def test_a_task_is_told_with_its_bindings(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    task = sc.template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)").complete()
    assert lab.running(lab.agent(record=task_record(task, Method.of(), Policy.REPAIR)))
    lab.agent()  # it tells no task
    (record,) = meanwhile(lab, running_tasks(lab.network.node(), Keys("lab")))
    assert record.task.startswith("navigate~")
    assert sorted(record.bindings) == ["goal", "robot"]
