"""Histories whose tasks the sites keep, in any ecology: sites die, freeze, are cut off, and go on with the tasks.

`kept_tasks.py` plays the paper's ecology, in which only sites suffer that advertise nothing; here every site does, and
what it advertises and starts. `with_site_faults` makes a script one of a history of this kind.
"""

from __future__ import annotations

import random
import tempfile
from dataclasses import replace
from pathlib import Path

from selfconf.configurator.state import Policy
from selfconf.deployment import Keeper, RunRequest, TaskFolder, TaskRunner
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from tests.faults.histories import History
from tests.faults.kept_tasks import BEGAN, end_task
from tests.faults.script import MOMENTS, PAUSES, Action, Script
from tests.lab import request_for

SPARE = "spare"
"""A site that advertises nothing, and keeps tasks as the others do."""
BEGUN = (0.0, 0.01, 1.0)
"""Seconds after which tasks begin."""
BACK = (0.05, 0.5, 1.5, 3.0, 8.0)
"""Seconds after which a site is back."""
BY_RECORDS = ("begin", "begin_again", "begin_namesake", "stop_task")
"""What is done to a task by telling the sites of it."""
UNDONE = {"crash_site": "start_site", "isolate": "rejoin"}
"""What happens to sites, and what ends it."""


def with_site_faults(script: Script) -> Script:
    """The same script, in which the sites keep the tasks, and suffer more; in most there is one to spare."""
    chance, ecology = random.Random(f"sites {script.seed}"), script.ecology
    if chance.random() < 0.6:
        ecology = replace(ecology, sites={**ecology.sites, SPARE: ()})
    more = [Action(chance.choice(BEGUN), "begin", task) for task in ecology.tasks if chance.random() < 0.5]
    time = 2.0
    for _ in range(chance.randint(1, 6)):
        time += chance.choice(MOMENTS)
        kind, site = chance.choice((*UNDONE, "pause", "crash_site")), chance.choice([*ecology.sites])
        more.append(Action(time, kind, site, seconds=chance.choice(PAUSES) if kind == "pause" else 0.0))
        if kind in UNDONE and chance.random() < 0.8:
            more.append(Action(time + chance.choice(BACK), UNDONE[kind], site))
    actions = sorted((*script.actions, *more), key=lambda action: action.time)
    return replace(script, ecology=ecology, actions=tuple(actions), kept=True)


class KeepingHistory(History):
    """A history in which a task has no program of its own: it is handed to the sites."""

    def __init__(self, script: Script, folder: Path) -> None:
        self._keepers: dict[str, Keeper] = {}
        self._disks = tempfile.TemporaryDirectory()
        self._handed: dict[str, int] = {}
        """How many tasks of each name were handed to the sites."""
        super().__init__(script, folder)
        self._user = self.network.node()
        self.lab.let_pass(0.5)

    def run(self) -> None:
        """Play the script, and leave nothing of the disks."""
        with self._disks:
            super().run()

    @property
    def agents(self) -> list[TaskRunner]:
        """The configurators of the sites that live."""
        living = [self._keepers[name] for name in self.sites if self.node(name) is not None]
        return [runner for keeper in living for runner in keeper.runners.values()]

    def begin_site(self, name: str) -> None:
        """Let a site live that keeps what is on its disk."""
        super().begin_site(name)
        disk = TaskFolder(Path(self._disks.name) / name)
        self._keepers[name] = Keeper(self.sites[name].bus, "lab", name, disk, self._request, self._clock)

    def _clock(self) -> float:
        return BEGAN + self.network.time

    def _request(self, record: TaskRecord) -> RunRequest:
        who = record.task.partition("~")[0]
        plan, ecology = self.script.tasks[who], self.script.ecology
        bound = tuple((name, value.format(task=who)) for name, value in ecology.bindings)
        return replace(
            request_for(record, ecology.whole if plan.drives else ecology.part, bound),
            name=record.task,
            policy=Policy.DISMANTLE if plan.dismantles else Policy.REPAIR,
            upgrade=plan.upgrade,
        )

    def perform(self, action: Action) -> bool:
        """Do what an action says; a task is begun and stopped by records."""
        if action.kind not in BY_RECORDS:
            return super().perform(action)
        if (action.who in self._handed) == (action.kind == "begin"):
            return False
        if action.kind in ("stop_task", "begin_again"):
            end_task(self._user, self.lab.keys, f"{action.who}~{self._handed[action.who]}")
        if action.kind != "stop_task":
            number = self._handed[action.who] = self._handed.get(action.who, 0) + 1
            priority, beginning = self.script.tasks[action.who].priority, self._clock()
            record = TaskRecord(f"{action.who}~{number}", 1, priority=priority, beginning=beginning)
            self._user.ask(self.lab.keys.keep(), encode(record), 1.0, lambda replies: None)
        return True
