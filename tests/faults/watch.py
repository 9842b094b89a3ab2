"""The watch over a history: at every step it looks at the invariants, and notes what has lasted for too long."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from operator import attrgetter
from typing import Any

from selfconf.composites import InsideOfComposite
from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.model.configuration import Configuration
from selfconf.model.profile import CALL_MARK
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Wire
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.runtime import ComponentRuntime
from tests.faults import final_invariants, invariants, upgrades
from tests.faults.final_invariants import undecided
from tests.faults.histories import History, Life
from tests.faults.invariants import MOST_WAITING
from tests.faults.simulated_code import SimulatedCodeThread

STEPS = (*invariants.STEPS, *upgrades.STEPS)
"""What must hold at every step."""
ENDS = (*final_invariants.ENDS, *upgrades.ENDS)
"""What must hold in the end."""
ROUNDING = 1e-6
"""By how many seconds a sum of times may be wrong."""
LOOKS = 0.25
"""Seconds after which conditions are looked at again while signals are heard, though nothing else has changed."""
_TURNING = (("started",), ("stopped",))
"""What components write down that decides whether they are on."""
_STATE = attrgetter("state")
_ACTIVATION = attrgetter("activation")
_TURN, _ACTING_TURN = attrgetter("turn"), attrgetter("_acting_turn")  # by these it is decided whether code acts
_LIMIT = attrgetter("limit_until")
CONNECTED = "who calls is connected"
TRIES_FIRST = "a composite tries first"
NOTED = (CONNECTED, TRIES_FIRST, *upgrades.NOTED)
"""What is noted when it happens: that a call is answered though the caller is not connected, that a composite fails
that has not looked for another inside, and what comes of upgrades."""
Composed = Sequence[tuple[IRI | None, Configuration]]
"""Configurations, each with the composite that it is the inside of."""


class Watch:
    """Looks at the invariants of a history at every step, and notes what has lasted for too long."""

    def __init__(self, history: History) -> None:
        self._history = history
        self._bounds = {invariant.name: invariant.bound(history) for invariant in STEPS}
        self._since: dict[tuple[str, str], float] = {}
        self._noted: set[tuple[str, str]] = set()
        self._overdue = math.inf
        """When the first of the conditions that are present has lasted for too long."""
        self._seen: list[object] = []
        self._shape = (-1, 0)
        """The shape of the network, and how many processes there have been, when it was noted which of them live."""
        self._runtimes: list[ComponentRuntime] = []
        self._codes: list[ComponentCode] = []
        self._lives: list[Life] = []
        self._said: list[list[tuple[Any, ...]]] = []
        """What each of these lives has written down."""
        self._lengths: list[int] = []
        """How much that was at the last look."""
        self._followed: list[set[tuple[str, Wire]]] = []
        """What their inputs followed when the conditions were looked at last, which was at a time."""
        self._compared_at = self._changed_at = -math.inf
        self._threads: list[SimulatedCodeThread] = []
        self.broken: list[str] = []
        self.names: set[str] = set()
        """The names of the invariants that were broken."""
        self.longest: dict[str, float] = {}
        """How long a condition of each invariant has lasted at most."""
        self._composed: dict[str, list[tuple[IRI | None, Configuration]]] = {}
        """What each configurator has composed, by its life, each with the composite that it is the inside of."""
        self.upgrades = upgrades.UpgradeWatch(history, self.note)
        self._inside: dict[InsideOfComposite, tuple[TaskRunner, int]] = {}
        """What runs, or ran, the inside of each composite, with its search of which came what ran last."""

    def look(self) -> None:
        """Look at the ecology as it is now; conditions need a second look only if something has changed."""
        changed, heard = self._is_changed(), self._heard()
        if changed or heard:
            self._changed_at = self._history.network.time
            with self._history.standing_still():
                matters = changed or self._matters(heard)
                if matters:
                    self._note_composed()
                self.upgrades.look()  # of what signals are heard matters to these alone
                if matters:
                    self._compare()
        now = self._history.network.time
        if now < self._overdue:
            return
        for (name, condition), since in self._since.items():
            self._judge(name, condition, now - since)
        self._await()

    def _judge(self, name: str, condition: str, lasted: float) -> None:
        """Note a condition once if it has lasted for too long, though it may be over: nothing need happen meanwhile."""
        if lasted > self._bounds[name] and (name, condition) not in self._noted:
            self._noted.add((name, condition))
            self.note(name, f"{condition}, since {self._history.network.time - lasted:.3f}")

    def _await(self) -> None:
        """Note when to look again at the conditions that are present, a little early, as sums of times are rounded."""
        lasting = (since + self._bounds[one[0]] for one, since in self._since.items() if one not in self._noted)
        self._overdue = min(lasting, default=math.inf) - ROUNDING

    def is_quiet(self, seconds: float) -> bool:
        """Whether nothing has changed for so long, no task is being started, and nothing is amiss that may not last."""
        unchanged = self._history.network.time - self._changed_at
        return not self._since and unchanged >= seconds and self.all_decided()

    def all_decided(self) -> bool:
        """Whether every task is running or refused."""
        return not any(undecided(self._history))

    def end(self) -> None:
        """Look at what must hold in the end."""
        self.look()
        for invariant in ENDS:
            for condition in invariant.conditions(self._history):
                self.note(invariant.name, condition)

    def _note_composed(self) -> None:
        """Note what was composed, and which composites fail that have not looked for another inside first."""
        for agent in self._history.living():
            composed, outside = self._composed.setdefault(agent.supervisor, []), agent.request.outside
            if agent.configuration is not None and (not composed or composed[-1][1] is not agent.configuration):
                composed.append((None if outside is None else outside.composite, agent.configuration))
        for inside in self._history.insides():
            runner, attempt = self._inside.get(inside, (None, 0))
            if inside.runner is not None and (
                inside.runner is not runner or inside.runner.state.phase is Phase.RUNNING
            ):
                attempt = inside.runner.state.attempt if inside.runner.state.phase is Phase.RUNNING else 0
                self._inside[inside] = inside.runner, attempt
            failed = inside.runtime.activation.phase is ActivationPhase.FAILED
            if failed and runner is not None and not (
                isinstance(runner.state.refusal, Refusal) and runner.state.attempt > attempt
            ):  # fmt: skip
                del self._inside[inside]
                self.note(TRIES_FIRST, f"{inside.profile.component.short} fails, and has not been refused")

    def served(self, runtime: ComponentRuntime, operation: str, caller: IRI) -> None:
        """A component answers a call: it may have been connected to the caller by a task that holds it."""
        self._note_composed()
        wanted, name = runtime.profile.component, operation + CALL_MARK
        composed = [one for hold in runtime.activation.holds for one in self._composed.get(hold.claim.supervisor, ())]
        if caller not in set(self._callers(wanted, name, composed)):
            self.note(CONNECTED, f"{wanted.short} answers {operation!r} of {caller.short}")

    def _callers(self, component: IRI, name: str, composed: Composed) -> Iterator[IRI]:
        """Who might call an operation, by some configurations; across composites by any that there have been."""
        everything = [one for some in self._composed.values() for one in some]
        for outside, configuration in composed:
            for one in configuration.connections:
                if (one.source, one.output) != (component, name):
                    continue
                if one.sink == outside:
                    yield from self._callers(one.sink, one.input, [c for c in everything if c[0] != outside])
                elif inner := [c for c in everything if c[0] == one.sink]:
                    yield from self._callers(one.sink, one.input, inner)
                else:
                    yield one.sink

    def _heard(self) -> list[tuple[int, int]]:
        """The lives that have written something down since the last look, by number, and how much they had before."""
        before, self._lengths = self._lengths, list(map(len, self._said))
        if before == self._lengths:
            return []
        return [(n, had) for n, (had, has) in enumerate(zip(before, self._lengths, strict=True)) if had != has]

    def _matters(self, heard: Sequence[tuple[int, int]]) -> bool:
        """Whether what lives have heard may change a condition: by being started or stopped, or what is followed.

        Some conditions end as time passes, so they are looked at from time to time.
        """
        return self._history.network.time >= self._compared_at + LOOKS or any(
            any(said in _TURNING for said in self._said[number][had:])
            or self._lives[number].followed != self._followed[number]
            for number, had in heard
        )

    def _compare(self) -> None:
        now = self._compared_at = self._history.network.time
        self._followed = [life.followed for life in self._lives]
        present = {(one.name, condition) for one in STEPS for condition in one.conditions(self._history)}
        for name, condition in list(self._since):
            if (name, condition) not in present:
                lasted = now - self._since.pop((name, condition))
                self.longest[name] = max(lasted, self.longest.get(name, 0.0))
                self._judge(name, condition, lasted - ROUNDING)
        for name, condition in present:
            self._since.setdefault((name, condition), now)
        self._await()

    def note(self, name: str, what: str) -> None:
        """An invariant is broken."""
        self.names.add(name)
        self.broken.append(f"{self._history.network.time:8.3f}  {name}: {what}")

    def _is_changed(self) -> bool:
        """Whether anything that the conditions depend on is another than at the last look.

        A value that is the one of the last look is not looked into: to compare these lists costs little.
        """
        history, network = self._history, self._history.network
        if (network.shape, len(history.processes)) != self._shape:
            self._shape = network.shape, len(history.processes)
            self._lives = [life for life in history.processes if life.node.open]
            self._runtimes = [life.runtime for life in self._lives]
            self._codes = [life.runtime.code for life in self._lives]
            self._threads = [life.thread for life in self._lives]
            self._said = [life.recorder.said for life in self._lives]
            self._lengths = list(map(len, self._said))
            self._seen.clear()
        now = network.time
        seen: list[object] = [
            len(network._events) > MOST_WAITING,
            *map(_ACTIVATION, self._runtimes),
            *map(_TURN, self._codes),
            *map(_ACTING_TURN, self._codes),
            *map(_STATE, history.agents),
        ]
        if min(map(_LIMIT, self._threads), default=math.inf) < now:
            # Few threads have a limit that is over; of those it matters whether they hang.
            seen += [(thread, thread.hangs) for thread in self._threads if thread.limit_until < now]
        if history.script.ecology.composites:
            for one in history.insides():
                code = one.runtime.code
                seen.append((one.runtime.activation, code.turn, code._acting_turn, one.runner and one.runner.state))
        changed = seen != self._seen
        self._seen = seen
        return changed
