"""Histories of tasks that live in the sites: sites die, come back with their disks, hang, and lose sight of each other.

A history is decided by its seed. Two tasks that want the same drive are handed to sites, of which some die, begin again
with the disk that they had, are paused, or are cut off from one other, and whose clocks differ by minutes; tasks are
stopped; the tracker fails. At every step of the network it is looked at whom the components act for. Then the faults
cease, every site begins again and reaches every other, and after a while each task must be run by the one site that is
to run it, or be over everywhere.

    python -m tests.faults.kept_tasks FIRST LAST
"""

from __future__ import annotations

import argparse
import random
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from operator import attrgetter
from pathlib import Path

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.bus.port import Replies
from selfconf.configurator.state import Phase
from selfconf.deployment import Keeper, TaskFolder
from selfconf.deployment.keeper import keeper_of
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import TaskRecord
from selfconf.sdk.runtime.supervision import GRACE
from tests.lab import Lab, request_for

KEEPING = ("a", "b", "c")
"""The sites that suffer; the two of the lab, which advertise the components, keep tasks as well, and are spared."""
TASKS = (TaskRecord("patrol~1", 1, priority=1, beginning=5.0), TaskRecord("tidy~2", 1, beginning=6.0))
BEGAN = 1_800_000_000.0
"""When a history begins, in seconds since 1970."""
CLOCKS = (0.0, 0.0, -300.0, 300.0)
FAULTY = 25.0
"""Seconds in which things go wrong."""
SETTLED = 90.0
"""Seconds after the last fault in which everything must be in order: a patient task looks again after a minute."""
LOOKED_AGAIN = 3.0
"""Seconds that a task which waits may take to look again, as it does from time to time: it is undecided meanwhile."""
TWO_RUN = 12.0
"""Seconds for which two sites may believe that they run one task: no component acts for both meanwhile."""

_OF_RUNTIME = attrgetter("activation", "code.turn", "code._acting_turn")  # by the turns it is decided whether it acts


def end_task(user: MemoryBus, keys: Keys, task: str, ending: Callable[[], None] = lambda: None) -> None:
    """End a task as `selfconf stop` does: by a newer record than those that the sites answer with, if any keeps it."""

    def answered(replies: Replies) -> None:
        records = [decode(sample.payload, TaskRecord) for sample in replies.samples]
        newest = max((one.revision for one in records if one.task == task and not one.ended), default=0)
        if newest:
            ending()
            user.ask(keys.keep(), encode(TaskRecord(task, newest + 1, ended=True)), 1.0, lambda replies: None)

    user.ask(keys.kept_tasks(), b"", 1.0, answered)


class KeptHistory:
    """One history; `told` says what has happened, and `broken` what was not as it must be."""

    def __init__(self, seed: int, folder: Path) -> None:
        self._chance = random.Random(seed)
        slow, late = self._chance.choice([0.0005, 0.02]), self._chance.choice([0.0, 0.5])
        self._travel = 2 * (slow + late) + 0.2
        self.lab = Lab(
            folder,
            seed,
            Faults(doubling=self._chance.choice([0.0, 0.3]), most_delay=slow, most_event_delay=late),
            still=True,
        )
        self.network = self.lab.network
        self.lab.navigation()
        self._disks = folder / "disks"
        self._wrong = random.Random(f"clocks {seed}")
        self._clocks: dict[str, float] = {}
        """By how many seconds the clock of each site is wrong."""
        self.keepers: dict[str, Keeper] = {}
        self._nodes: dict[str, MemoryBus] = {}
        self.told: list[str] = []
        self.broken: list[str] = []
        self._since: dict[str, float] = {}
        self._present: dict[str, float] = {}
        """What is not as it should be now, and for how many seconds each of it may last."""
        self._seen: list[object] = []
        for name in ("living-room", "astrid", *KEEPING):
            self._begin(name)
        self._user = self.network.node()
        self.lab.let_pass(0.5)
        self.network.stepped = self._look

    def play(self) -> None:
        """Let everything go wrong, and then let it come into order."""
        faults = (self._end, self._come_back, self._pause, self._cut, self._hand_over, self._stop, self._fail)
        moments = sorted(self._chance.uniform(0.0, FAULTY) for _ in range(self._chance.randrange(4, 16)))
        self._hand_over()
        for moment in moments:
            self.lab.let_pass(max(0.0, moment - self.network.time))
            self._chance.choice(faults)()
        self.lab.let_pass(1.0)
        self._cease()
        self.lab.let_pass(SETTLED)
        self.broken += self._out_of_order()

    # What happens.

    def _tell(self, what: str) -> None:
        self.told.append(f"{self.network.time:8.3f}  {what}")

    def _begin(self, name: str) -> None:
        node = self._nodes[name] = self.network.node()
        folder, ahead = TaskFolder(self._disks / name), self._clocks.setdefault(name, self._wrong.choice(CLOCKS))
        self.keepers[name] = Keeper(node, "lab", name, folder, request_for, lambda: BEGAN + self.network.time + ahead)
        if name in KEEPING:  # the others are announced by their sites
            node.announce(self.lab.keys.site_life(name, f"{name}{len(self.network.nodes)}"))

    def _end(self) -> None:
        name = self._chance.choice(KEEPING)
        if name in self.keepers:
            self._tell(f"{name} dies")
            del self.keepers[name]
            self._nodes[name].close()

    def _come_back(self) -> None:
        for name in KEEPING:
            if name not in self.keepers:
                self._tell(f"{name} comes back")
                self._begin(name)
                return

    def _pause(self) -> None:
        name, seconds = self._chance.choice(KEEPING), self._chance.choice([0.3, 2.0, 6.0])
        node = self._nodes[name]
        if name in self.keepers and not node.paused:
            self._tell(f"{name} is frozen for {seconds:g} s")
            self.network.pause(node)
            self.network.after(seconds, lambda: self.network.resume(node) if node.paused else None)

    def _cut(self) -> None:
        """Cut a site off from another one, or from everything, for a while."""
        name, seconds = self._chance.choice(KEEPING), self._chance.choice([0.5, 3.0, 8.0])
        node = self._nodes[name]
        if name not in self.keepers:
            return
        other = self._chance.choice([*(one for one in self.keepers if one != name), "everything"])
        self._tell(f"{name} is cut off from {other} for {seconds:g} s")
        ends = [one for one in self.network.nodes if one is not node] if other == "everything" else [self._nodes[other]]
        cut = [end for end in ends if self.network.reaches(node, end)]
        for end in cut:
            self.network.cut(node, end)
        self.network.after(seconds, lambda: self._mend(node, cut))

    def _mend(self, node: MemoryBus, ends: list[MemoryBus]) -> None:
        for end in ends:
            if not self.network.reaches(node, end):
                self.network.reconnect(node, end)

    def _hand_over(self) -> None:
        record = self._chance.choice(TASKS)
        self._tell(f"{record.task} is handed over")
        self._user.ask(self.lab.keys.keep(), encode(record), 1.0, lambda replies: None)

    def _stop(self) -> None:
        task = self._chance.choice(TASKS).task
        end_task(self._user, self.lab.keys, task, lambda: self._tell(f"{task} is ended"))

    def _fail(self) -> None:
        if self.lab.runtimes["tracker"].active:
            self._tell("the tracker fails")
            self.lab.components["tracker"].fail("lost")

    def _cease(self) -> None:
        self._tell("the faults cease")
        for node in self.network.nodes:
            if node.paused:
                self.network.resume(node)
        for node in self.network.nodes:
            self._mend(node, [one for one in self.network.nodes if one is not node])
        while len(self.keepers) < len(KEEPING) + 2:
            self._come_back()

    # What must hold.

    def _look(self) -> None:
        """At every step: what may last for a moment only must be over in time."""
        now = self.network.time
        if self._is_changed():
            self._present = dict(self._conditions())
            self._since = {what: self._since.get(what, now) for what in self._present}
        for what, since in self._since.items():
            if now - since > self._present[what] and not any(what in one for one in self.broken):
                self.broken.append(f"{now:8.3f}  {what}, since {since:.3f}")

    def _is_changed(self) -> bool:
        """Whether anything that the conditions depend on is another than at the last look."""
        runners = [(one, one.state) for keeper in self.keepers.values() for one in keeper.runners.values()]
        seen: list[object] = [self.network.shape, runners, list(map(_OF_RUNTIME, self.lab.runtimes.values()))]
        changed = seen != self._seen
        self._seen = seen
        return changed

    def _conditions(self) -> Iterator[tuple[str, float]]:
        supervisors = {
            runner.supervisor: self._nodes[name]
            for name, one in self.keepers.items()
            for runner in one.runners.values()
        }
        for name, runtime in self.lab.runtimes.items():
            acting = [hold for hold in runtime.activation.holds if hold.active] if runtime.active else []
            if len({str(hold.wants) for hold in acting}) > 1:
                yield f"{name} acts for tasks that disagree", 0.0
            if acting and not any(hold.claim.supervisor in supervisors for hold in acting):
                yield f"{name} acts for nobody", GRACE + 2 * self._travel + 1.0
        for record in TASKS:
            running = [
                name
                for name, keeper in self.keepers.items()
                if not self._nodes[name].paused and self._runs(keeper, record.task, Phase.RUNNING)
            ]
            if len(running) > 1:
                yield f"{record.task} runs at {running}", TWO_RUN

    @staticmethod
    def _runs(keeper: Keeper, task: str, phase: Phase | None = None) -> bool:
        """Whether a site runs a task, and has come so far with it."""
        runner = keeper.runners.get(task)
        return runner is not None and phase in (None, runner.state.phase)

    def _is_run(self, task: str, phase: Phase) -> bool:
        return any(self._runs(keeper, task, phase) for keeper in self.keepers.values())

    def _out_of_order(self) -> Iterator[str]:
        """In the end: all keep the same, one runs what is to run, and nobody what has ended."""
        known = {
            name: {task: (one.revision, one.ended) for task, one in keeper.folder.records.items()}
            for name, keeper in self.keepers.items()
        }
        ended = {name: {task for task, (_, over) in records.items() if over} for name, records in known.items()}
        if any(records.keys() != known["a"].keys() for records in known.values()) or any(
            over != ended["a"] for over in ended.values()
        ):
            yield f"the sites keep different tasks: {known}"
            return
        going = [record for record in TASKS if record.task in known["a"].keys() - ended["a"]]
        for record in TASKS:
            running = [name for name, keeper in self.keepers.items() if self._runs(keeper, record.task)]
            rightly = [keeper_of(record.task, self.keepers)] if record in going else []
            if running != rightly:
                yield f"{record.task} is run by {running}, and should be by {rightly}"
        for record in going:
            wanted = Phase.RUNNING if record is going[0] else Phase.REFUSED
            if not self.network.run(partial(self._is_run, record.task, wanted), LOOKED_AGAIN):
                yield f"{record.task} is not {wanted.value}"
        acting = self.lab.active() - {"tracker", "odometry"}
        if acting != ({"sonar", "encoder", "control", "drive"} if going else set()):
            yield f"in the end {sorted(acting)} act"


def played(seed: int, folder: Path) -> KeptHistory:
    """The history of a seed, played to its end."""
    history = KeptHistory(seed, folder)
    history.play()
    return history


def account(seed: int, history: KeptHistory) -> str:
    """What has happened in a history, and what was not as it must be."""
    return "\n".join([f"seed {seed}", *history.told, "", *history.broken])


def main(play: Callable[[int, Path], KeptHistory] = played) -> int:
    """Play the histories of some seeds; 1 if any of them broke something."""
    parser = argparse.ArgumentParser(description="play histories of tasks that live in the sites")
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    given, broken = parser.parse_args(), 0
    for seed in range(given.first, given.last):
        with tempfile.TemporaryDirectory() as folder:
            history = play(seed, Path(folder))
        if history.broken:
            broken += 1
            print(account(seed, history) + "\n")
    print(f"{given.last - given.first} histories, {broken} broken")
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
