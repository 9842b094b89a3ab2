"""Sites that keep tasks, simulated."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from selfconf.bus.port import Bus
from selfconf.configurator.state import Phase
from selfconf.deployment import Keeper, RunRequest, TaskFolder
from selfconf.deployment.keeper import keeper_of
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from tests.lab import Lab, request_for

RECORD = TaskRecord("patrol~1", 1, priority=1, beginning=5.0)


class Keepers:
    """The paper's ecology, with a keeper at each of three more sites."""

    def __init__(self, lab: Lab, folder: Path, request_for: Callable[[TaskRecord], RunRequest] = request_for) -> None:
        self.lab, self.folder, self.request_for = lab, folder, request_for
        self.buses: dict[str, Bus] = {}
        self.keepers: dict[str, Keeper] = {}
        self.ahead: dict[str, float] = {}
        """By how many seconds the clock of a site is ahead of the others, from when it begins on."""
        for name in ("a", "b", "c"):
            self.begin(name)
        lab.let_pass(0.1)

    def begin(self, name: str) -> None:
        """Start a site that keeps tasks, with the disk that it had."""
        bus = self.buses[name] = self.lab.network.node()
        kept, ahead = TaskFolder(self.folder / name), self.ahead.get(name, 0.0)
        self.keepers[name] = Keeper(bus, "lab", name, kept, self.request_for, lambda: self.lab.network.time + ahead)
        bus.announce(self.lab.keys.site_life(name, f"{name}{len(self.lab.network.nodes)}"))

    def end(self, name: str) -> None:
        """End a site as kill -9 does."""
        del self.keepers[name]
        self.buses[name].close()

    def hand_over(self, record: TaskRecord) -> None:
        """Give a record to all sites, as `run --detach` does."""
        self.lab.network.node().ask(self.lab.keys.keep(), encode(record), 1.0, lambda replies: None)

    def running(self) -> list[str]:
        """The sites that run the task."""
        return [
            name
            for name, keeper in self.keepers.items()
            if any(runner.state.phase is Phase.RUNNING for runner in keeper.runners.values())
        ]

    def settled(self) -> str:
        """Give the record to all sites, and return the one that has run its task for a second."""
        self.hand_over(RECORD)
        assert self.lab.until(lambda: bool(self.running()))
        self.lab.let_pass(1.0)
        (keeper,) = self.running()
        return keeper


def keepers_in_turn(task: str, *sites: str) -> tuple[str, str]:
    """Which site is to run a task, and which one after its end."""
    first = keeper_of(task, sites)
    return first, keeper_of(task, {*sites} - {first})
