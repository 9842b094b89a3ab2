"""Tasks of the tests of the deployment: what the paper's needs, and tasks that contend for components."""

from __future__ import annotations

from pathlib import Path

from selfconf.deployment.runner import TaskRunner
from tests.lab import PREFIXES, Lab

TASK = {"sonar", "encoder", "control", "drive"}
"""What the paper's task needs, besides a sensor for the position."""
SPARE = {
    name: f":{name} a sc:Component, :Drive ; sc:preference {preference} ; sc:shareable false ."
    for name, preference in (("left", 2), ("right", 1))
}
"""Two components that are eligible for one role, and that no tasks share."""
DRIVEN = PREFIXES + ":go a sc:Template ; sc:roles ( :drive ) . :drive a sc:Role ; sh:class :Drive ."


def contended(folder: Path) -> tuple[Lab, list[TaskRunner]]:
    """An ecology in which two components could play the role of a task, and the tasks that hold one each."""
    lab, agents = Lab(folder, advertised=SPARE), list[TaskRunner]()
    lab.site("shared", *SPARE)
    for name in SPARE:
        lab.component(name)
    for name in SPARE:
        agents.append(lab.agent(DRIVEN, (), name=f"holds-{name}"))
        assert lab.running(agents[-1])
    return lab, agents
