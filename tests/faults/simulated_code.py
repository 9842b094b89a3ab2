"""The thread of a component's code in simulated time: apart from that of the bus, and busy for as long as it says.

Code runs at once, but what follows from its end (reports to the bus, the next piece of code) comes when the time is
over that it spends. Code that spends more than its deadline is noticed as the host of a real process does.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import Any

from selfconf.bus.memory import MemoryBus
from selfconf.sdk.code_thread import Action, CodeThread, RunningCode
from selfconf.sdk.component_code import ComponentCode


class SimulatedCodeThread(CodeThread):
    """Runs the code of one component on its node; `hung` hears what has not returned within its deadline."""

    def __init__(self, node: MemoryBus, hung: Callable[[str], None]) -> None:
        super().__init__(inline=False)
        self._node, self._network, self._hung = node, node.network, hung
        self._due = False
        self.busy_until = 0.0
        self._starting_until = 0.0
        self.limit_until = math.inf
        """When code that spends more than it may would have to have returned."""

    @property
    def hangs(self) -> bool:
        """Whether code has not returned within its deadline."""
        return self.limit_until < self._network.time < self.busy_until

    def spend(self, seconds: float) -> None:
        """Be busy for some time, from within the code."""
        self.busy_until = self._free() + seconds

    def _free(self) -> float:
        return max(self._network.time, self.busy_until)

    def _put(self, actions: deque[Action], action: Action) -> None:
        super()._put(actions, action)
        self._schedule()

    def _schedule(self) -> None:
        if not self._due:
            self._due = True
            self._network.at(self._free(), self._node, self._run_next)

    def _run_next(self) -> None:
        self._due = False
        if self._network.time >= self.busy_until:
            action = self._next(0.0)
            if action is None:
                return
            action()
        self._schedule()

    @property
    def starting(self) -> bool:
        """Whether the code is in `started`."""
        return self._network.time < self._starting_until

    def limited(self, owner: object, what: str, limit: float, action: Callable[[], object]) -> None:
        """Run code of a component; note when it would have to have returned."""
        began = self._free()
        # One that wakes from rest has started before, and has acted since.
        starts = what == "started" and isinstance(owner, ComponentCode) and owner._started_turn != owner.turn
        action()
        if starts:
            self._starting_until = self.busy_until
        self.limit_until = math.inf
        if self.busy_until - began > limit:
            self.limit_until = began + limit
            why = RunningCode(owner, what, began, limit).why_overdue
            self._network.at(self.limit_until, self._node, lambda: self._hung(why))


class SimulatedComponentCode(ComponentCode):
    """Code that has not started before the time is over that it spends in `started`."""

    @classmethod
    def simulate(cls, code: ComponentCode, node: MemoryBus, thread: SimulatedCodeThread) -> None:
        """Have the code of a runtime spend time as a thread of its own does."""
        late: Any = ReportsLate(node, thread)
        code.__class__, code._bus = cls, late

    @property
    def started(self) -> bool:
        """Whether the component acts, and `started` has returned."""
        return super().started and not (isinstance(self._thread, SimulatedCodeThread) and self._thread.starting)


class ReportsLate:
    """A bus on which the code's thread reports once it is not busy any more."""

    def __init__(self, node: MemoryBus, thread: SimulatedCodeThread) -> None:
        self._node, self._thread = node, thread

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` when the code has returned."""
        self._node.network.at(max(self._node.network.time, self._thread.busy_until), self._node, action)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._node, name)
