"""Harsher histories of tasks that live in the sites: disks are full, slow or of before, clocks are set, and more.

The same tasks, conditions and end as in `kept_tasks.py`, with seeds of their own. `KINDS` are the faults beside those;
one after the other is the first of a seed, and happens at least twice where it can.

    python -m tests.faults.harsh_kept_tasks FIRST LAST
"""

from __future__ import annotations

import errno
import random
import shutil
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

from selfconf.bus.memory import MemoryBus
from selfconf.deployment import Keeper, TaskFolder
from selfconf.protocol.messages import TaskRecord
from tests.faults.harsh import AWHILE, STALLS, STEPS
from tests.faults.kept_tasks import BEGAN, CLOCKS, FAULTY, KEEPING, SETTLED, KeptHistory, main
from tests.lab import request_for

KINDS = (
    "fill_disk",
    "slow_disk",
    "roll_back",
    "roll_back_all",
    "set_clock",
    "stall_machine",
    "freeze_some",
    "flap",
    "deafen",
    "silence",
)
"""What happens beside what happens in `KeptHistory`."""
SLOW = (0.05, 0.5, 1.5, 3.0)
"""For how many seconds a slow disk keeps a site that writes a task."""
COPIED = 2.5
"""Seconds after which the disk of a site is copied, to be what it has when it is rolled back."""


class FaultyFolder(TaskFolder):
    """A folder of tasks on a disk that may be full, or slow."""

    def __init__(self, folder: Path, node: MemoryBus) -> None:
        super().__init__(folder)
        self._node = node
        self.full, self.seconds = False, 0.0

    def _write(self, folder: Path, record: TaskRecord) -> None:
        if self.full:
            raise OSError(errno.ENOSPC, "No space left on device")
        if self.seconds:
            self._node.spend(self.seconds)
        super()._write(folder, record)


class HarshKeptHistory(KeptHistory):
    """One history; `done` counts what has happened of each kind."""

    def __init__(self, seed: int, folder: Path) -> None:
        self._seed, self.done, self._folders = seed, Counter[str](), dict[str, FaultyFolder]()
        super().__init__(seed, folder)
        self._chance = random.Random(f"harsh {seed}")
        # A site that lets go of a task while its disk is slow does not say so before it has written: its components
        # take it for alive until then, and are right to.
        self._travel += max(SLOW) / 2

    def play(self) -> None:
        """Let everything go wrong, and then let it come into order."""
        usual = (self._end, self._come_back, self._pause, self._cut, self._hand_over, self._stop, self._fail)
        first = KINDS[self._seed % len(KINDS)]
        kinds = [first, first] if self._chance.random() < 0.4 else [first, *KINDS]
        moments = sorted(self._chance.uniform(0.0, FAULTY) for _ in range(self._chance.randrange(6, 20)))
        self._hand_over()
        self._copy_disks()
        for number, moment in enumerate(moments):
            self.lab.let_pass(max(0.0, moment - self.network.time))
            if number > 1 and self._chance.random() < 0.5:
                self._chance.choice(usual)()
                continue
            kind = first if number < 2 else self._chance.choice(kinds)
            act: Callable[[str], bool] = getattr(self, f"_{kind}")
            name = self._chance.choice(KEEPING)
            if act(name):
                self.done[kind] += 1
        self.lab.let_pass(1.0)
        self._cease()
        self.lab.let_pass(SETTLED)
        self.broken += self._out_of_order()

    def _begin(self, name: str) -> None:
        node = self._nodes[name] = self.network.node()
        self._clocks.setdefault(name, self._wrong.choice(CLOCKS))
        folder = self._folders[name] = FaultyFolder(self._disks / name, node)
        clock = partial(self._clock, name)
        self.keepers[name] = Keeper(node, "lab", name, folder, request_for, clock)
        if name in KEEPING:
            node.announce(self.lab.keys.site_life(name, f"{name}{len(self.network.nodes)}"))

    def _clock(self, name: str) -> float:
        return BEGAN + self.network.time + self._clocks[name]

    def _cease(self) -> None:
        for folder in self._folders.values():
            folder.full, folder.seconds = False, 0.0
        super()._cease()

    # What happens. Each says whether it could.

    def _copy_disks(self) -> None:
        """Copy the disks from time to time."""
        for name in self._nodes:
            if (self._disks / name).is_dir():
                shutil.copytree(self._disks / name, self._disks / f"{name} before", dirs_exist_ok=True)
        if self.network.time < FAULTY:
            self.network.after(COPIED, self._copy_disks)

    def _fill_disk(self, name: str) -> bool:
        return self._spoil_disk(name, "full", True)

    def _slow_disk(self, name: str) -> bool:
        return self._spoil_disk(name, "seconds", self._chance.choice(SLOW))

    def _spoil_disk(self, name: str, attribute: str, value: float) -> bool:
        folder, seconds = self._folders[name], self._chance.choice([2.0, 8.0])
        self._tell(f"the disk of {name} is {attribute}: {value} for {seconds:g} s")
        setattr(folder, attribute, value)
        self.network.after(seconds, lambda: setattr(folder, attribute, type(value)()))
        return name in self.keepers

    def _roll_back(self, name: str) -> bool:
        """A site dies, and comes back with the disk that it had some time before."""
        before = self._disks / f"{name} before"
        if name not in self.keepers or not before.is_dir():
            return False
        self._tell(f"{name} begins again with its disk of before")
        self._nodes[name].close()
        shutil.rmtree(self._disks / name, ignore_errors=True)
        shutil.copytree(before, self._disks / name)
        del self.keepers[name]
        self._begin(name)
        return True

    def _roll_back_all(self, name: str) -> bool:
        """All that keeps tasks begins again with disks of before: nothing knows any more of what came after."""
        rolled_back = [one for one in list(self.keepers) if self._roll_back(one)]
        return bool(rolled_back)

    def _set_clock(self, name: str) -> bool:
        seconds = self._chance.choice(STEPS)
        self._tell(f"the clock of {name} is set by {seconds:+g} s")
        self._clocks[name] += seconds
        return name in self.keepers

    def _stall_machine(self, name: str) -> bool:
        seconds = self._chance.choice(STALLS)
        self._tell(f"everything stalls for {seconds:g} s")
        self.network.after(seconds, self.network.stall())
        return True

    def _freeze_some(self, name: str) -> bool:
        """A site is frozen together with another one, and with the components of one of the lab's sites."""
        seconds, other = self._chance.choice(STALLS), self._chance.choice(KEEPING)
        some = [self._nodes[one] for one in {name, other}]
        if self._chance.random() < 0.5:
            some += map(self.lab.node_of, ("control", "drive"))
        some = [node for node in some if node.open and not node.paused]
        self._tell(f"{name} and {other}, {len(some)} nodes, are frozen for {seconds:g} s")
        self.network.pause(*some)
        self.network.after(seconds, lambda: [self.network.resume(node) for node in some])
        return bool(some)

    def _flap(self, name: str) -> bool:
        node, end = self._nodes[name], self.network.time + self._chance.choice(AWHILE)
        chance = random.Random(f"{self._seed} {end}")
        self._tell(f"all links of {name} flap until {end:.3f}")

        def cut() -> None:
            if self.network.time < end and node.open:
                ends = [one for one in self.network.nodes if one is not node and self.network.reaches(node, one)]
                for one in ends:
                    self.network.cut(node, one)
                self.network.after(chance.choice((0.001, 0.02, 0.3)), partial(heal, ends))

        def heal(ends: list[MemoryBus]) -> None:
            self._mend(node, ends)
            self.network.after(chance.choice((0.001, 0.02, 0.3)), cut)

        cut()
        return name in self.keepers

    def _deafen(self, name: str) -> bool:
        return self._is_one_way(name, True)

    def _silence(self, name: str) -> bool:
        return self._is_one_way(name, False)

    def _is_one_way(self, name: str, deaf: bool) -> bool:
        node, seconds = self._nodes[name], self._chance.choice(AWHILE)
        self._tell(f"{name} is {'deaf' if deaf else 'mute'} for {seconds:g} s")
        others = [one for one in self.network.nodes if one is not node]
        for other in others:
            self.network.mute(*((other, node) if deaf else (node, other)))
        self.network.after(seconds, lambda: [self.network.reconnect(node, other) for other in others])
        return name in self.keepers


def played(seed: int, folder: Path) -> HarshKeptHistory:
    """The history of a seed, played to its end."""
    history = HarshKeptHistory(seed, folder)
    history.play()
    return history


if __name__ == "__main__":
    raise SystemExit(main(played))
