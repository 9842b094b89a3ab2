"""A network in memory: one thread, a clock turned by hand, and a seed for everything that can go wrong.

`Network` delivers what nodes send in the order of simulated time. Faults are policy: each message may be delayed, lost
or doubled with given chances; nodes may be cut off from each other, one way or both; a node may be paused, be busy, or
have a clock of its own. Events are never lost between nodes that reach each other, as on the real bus. A history is
replayed by its seed.
"""

from __future__ import annotations

import heapq
import itertools
import random
from collections.abc import Callable
from math import isfinite
from numbers import Real

from selfconf.bus.memory.bus import MemoryBus
from selfconf.bus.memory.questions import MemoryRequest
from selfconf.errors import ProgrammerError
from selfconf.model.immutable import immutable
from selfconf.model.wording import listed

LEASE = 1.0
"""Seconds after which a node that is paused counts as gone: its lives seem to have ended."""
REJOINING = 0.1
"""Seconds that a node whose lease has run out needs to be connected again, once it goes on."""


@immutable
class Faults:
    """The chances per message, and the delays in seconds; a perfect and fast network by default.

    >>> MemoryEcology(seed=7, faults=Faults(loss=0.05, most_delay=0.2))
    <ecology in memory of 0 components after 0.0 s>
    """

    loss: float = 0.0
    doubling: float = 0.0
    least_delay: float = 0.0005
    most_delay: float = 0.0005
    most_event_delay: float = 0.0
    """How long events and notices of lives may be delayed at most; they keep their order all the same."""

    def __post_init__(self) -> None:
        for name, chance in (("loss", self.loss), ("doubling", self.doubling)):
            if not _is_number(chance) or not 0 <= chance <= 1:
                raise ProgrammerError(f"{name} is a chance: a number from 0 to 1, not {chance!r}")
        delays = self.least_delay, self.most_delay, self.most_event_delay
        if not all(_is_number(delay) and delay >= 0 for delay in delays):
            raise ProgrammerError(f"delays are numbers of seconds from zero on, not {listed(map(repr, delays))}")


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)


class Network:
    """The simulated network: its nodes, its time, and which nodes reach each other.

    `stepped` is called after each thing that has happened, for callers that look at every step of a history.
    """

    def __init__(self, seed: int = 0, faults: Faults | None = None) -> None:
        self.time = 0.0
        self.faults = faults or Faults()
        self.stepped: Callable[[], None] = lambda: None
        self._chance = random.Random(seed)
        self._events: list[tuple[float, int, Callable[[], None]]] = []
        self._count = itertools.count()
        self._overdue = itertools.count(-(1 << 62))
        """Numbers of events that come before all others of their time."""
        self._undone: set[int] = set()
        """The numbers of events that do not happen any more, though they are still among the others."""
        self._cut: set[tuple[int, int]] = set()
        """The one-way links that are cut: sender, receiver."""
        self._latest: dict[tuple[int, int], float] = {}
        """When the latest event from one node to another arrives, which no later one may overtake."""
        self._serving: dict[str, list[tuple[MemoryBus, Callable[[MemoryRequest], None]]]] = {}
        """Who serves each key that was asked, in order; forgotten when a node begins to serve a key, or ends."""
        self.nodes: list[MemoryBus] = []
        self.shape = 0
        """Counts what changes the reach of nodes: those that come, go, are paused or go on, and links that are cut."""

    def node(self, clock: float = 0.0) -> MemoryBus:
        """A new node that reaches all others; its clock is ahead of the network's time by that many seconds."""
        bus = MemoryBus(self, len(self.nodes), clock)
        self.nodes.append(bus)
        self.shape += 1
        return bus

    def cut(self, left: MemoryBus, right: MemoryBus) -> None:
        """Nothing gets through between two nodes from now on; to each the other's lives seem to have ended."""
        self.mute(left, right)
        self.mute(right, left)

    def mute(self, sender: MemoryBus, receiver: MemoryBus) -> None:
        """Nothing of one node reaches another from now on; the way back stays open."""
        if self.reaches(sender, receiver):
            self._cut.add((sender.number, receiver.number))
            self.shape += 1
            receiver.unsee(sender)
            sender.match_all()

    def reconnect(self, left: MemoryBus, right: MemoryBus) -> None:
        """Two nodes reach each other again, and see each other's lives."""
        if self._cut.isdisjoint([(left.number, right.number), (right.number, left.number)]):
            return
        self.shape += 1
        for sender, receiver in ((left, right), (right, left)):
            reached = self.reaches(sender, receiver)
            self._cut.discard((sender.number, receiver.number))
            if not reached and self.reaches(sender, receiver):
                receiver.see(sender)
        left.match_all()

    def reaches(self, sender: MemoryBus, receiver: MemoryBus) -> bool:
        """Whether a message of one node gets through to another."""
        return sender.open and receiver.open and not self._severed(sender, receiver)

    def _severed(self, sender: MemoryBus, receiver: MemoryBus) -> bool:
        lone = sender.expelled or receiver.expelled
        one_host = sender is receiver or (sender.number in receiver.host and receiver.number in sender.host)
        return (lone and not one_host) or (sender.number, receiver.number) in self._cut

    def pause(self, *nodes: MemoryBus) -> None:
        """Let a node do nothing, as SIGSTOP does: what arrives waits, timers are late, and after `LEASE` it is gone.

        Pausing a node that never resumes, and closing it later, is what others see of a host that loses its power.
        Several nodes are those of a host that is frozen: they are gone for all others, and not for each other; one that
        is gone already, from a pause before, is gone for these too.
        """
        still = [node for node in nodes if node.open and not node.paused]
        host = frozenset(node.number for node in still if not node.expelled)
        for node in still:
            number = self._pause(node)
            if not node.expelled:
                node.host = host

            def expel(node: MemoryBus = node, number: int = number) -> None:
                if node.open and node.paused and node.pauses == number:
                    self._expel(node)

            self.after(LEASE, expel)

    def stall(self) -> Callable[[], None]:
        """Let all nodes do nothing, as a machine that stalls; the result lets them go on, in any order.

        None of them notices that another one does nothing.
        """
        stalled = [(node, self._pause(node)) for node in self.nodes if node.open and not node.paused]

        def go_on() -> None:
            self._chance.shuffle(stalled)
            for node, number in stalled:
                if node.open and node.pauses == number:
                    self.resume(node)

        return go_on

    def _pause(self, node: MemoryBus) -> int:
        """Have a node do nothing from now on; how often it was paused by then."""
        node.paused = True
        node.pauses += 1
        self.shape += 1
        return node.pauses

    def resume(self, node: MemoryBus) -> None:
        """Let a node go on: first with the timers that are due, then with what has arrived before it was gone."""
        if not node.paused:
            return
        node.paused = False
        self.shape += 1
        node.catch_up()
        number = node.pauses

        def readmit() -> None:
            if node.open and node.expelled and not node.paused and node.pauses == number:
                self._readmit(node)

        self.after(REJOINING, readmit)

    def _expel(self, node: MemoryBus) -> None:
        others = [other for other in self.nodes if other is not node and other.open]
        reached = [other for other in others if self.reaches(node, other)]
        heard = [other for other in others if self.reaches(other, node)]
        node.expelled = True
        self.shape += 1
        for other in reached:
            if not self.reaches(node, other):
                other.unsee(node)
        for other in heard:
            if not self.reaches(other, node):
                node.unsee(other)
        node.match_all()

    def _readmit(self, node: MemoryBus) -> None:
        others = [other for other in self.nodes if other is not node and other.open]
        links = [link for other in others for link in ((node, other), (other, node)) if not self.reaches(*link)]
        node.expelled = False
        self.shape += 1
        for sender, receiver in links:
            if self.reaches(sender, receiver):
                receiver.see(sender)
        node.match_all()

    def serving(self, key: str) -> list[tuple[MemoryBus, Callable[[MemoryRequest], None]]]:
        """The nodes that serve a key, in reach or not, each with what answers."""
        found = self._serving.get(key)
        if found is None:
            found = self._serving[key] = [(node, answer) for node in self.nodes for answer in node.answering(key)]
        return found

    def forget_serving(self) -> None:
        """Look anew which nodes serve a key, when it is asked next."""
        self._serving.clear()

    def loses(self) -> bool:
        """Whether the next message is lost."""
        return self._chance.random() < self.faults.loss

    def deliver(
        self,
        sender: MemoryBus,
        receiver: MemoryBus,
        action: Callable[[], None],
        sure: bool = True,
        outlasts_link: bool = False,
    ) -> bool:
        """Have the receiver act on a message after the network's delay; False if it is lost.

        What is `sure` is neither lost nor doubled, and keeps its order. What is on the way is lost with the link unless
        it `outlasts_link`: to a node that has lost a link all lives beyond it have ended, those that were ending too.
        """
        if not self.reaches(sender, receiver) or (not sure and self.loses()):
            return False

        def arrive() -> None:
            if receiver.open and (outlasts_link or not self._severed(sender, receiver)):
                receiver.take(action)

        times = 2 if not sure and self._chance.random() < self.faults.doubling else 1
        begins = max(self.time, sender.busy_until)
        for _ in range(times):
            delay = self._chance.uniform(self.faults.least_delay, self.faults.most_delay)
            moment = begins + (self._in_order(sender, receiver, begins) if sure else delay)
            self.at_time(moment, arrive)
        return True

    def _in_order(self, sender: MemoryBus, receiver: MemoryBus, begins: float) -> float:
        """The delay of an event, which overtakes no earlier one between two nodes."""
        delay, most = self.faults.least_delay, self.faults.most_event_delay
        if most:
            delay += self._chance.uniform(0.0, most)
        link = sender.number, receiver.number
        if sender is receiver:
            return self.faults.least_delay
        moment = max(begins + delay, self._latest.get(link, 0.0))
        self._latest[link] = moment
        return moment - begins

    def at(self, time: float, node: MemoryBus, action: Callable[[], None]) -> int:
        """Have a node do something at a time, if it is still there: a timer. Returns its number, for `undo`."""

        def act() -> None:
            if node.open:
                node.take(action, timer=True)

        return self.at_time(time, act)

    def after(self, seconds: float, action: Callable[[], None]) -> None:
        """Have something happen to the network itself, which is never paused."""
        self.at_time(self.time + seconds, action)

    def at_time(self, time: float, action: Callable[[], None]) -> int:
        """Have something happen to the network itself at a time. Returns its number, for `undo`."""
        number = next(self._count)
        heapq.heappush(self._events, (time, number, action))
        return number

    def before_all_else(self, action: Callable[[], None]) -> None:
        """Have something happen before all that is due now, and after what was put there likewise."""
        heapq.heappush(self._events, (self.time, next(self._overdue), action))

    def undo(self, number: int) -> None:
        """Have something not happen that has not happened yet: its time passes, but `stepped` is not called."""
        self._undone.add(number)

    def step(self) -> bool:
        """Let the next thing happen; False if nothing is left."""
        if not self._events:
            return False
        time, number, action = heapq.heappop(self._events)
        if time > self.time:
            self.time = time
        if number in self._undone:
            self._undone.discard(number)
        else:
            action()
            self.stepped()
        return True

    def run(self, until: Callable[[], bool], seconds: float = 60.0) -> bool:
        """Let things happen until `until` holds, or that much simulated time has passed; whether it holds."""
        deadline = self.time + seconds
        while not until():
            if not self._events or self._events[0][0] > deadline:
                self.time = deadline
                return until()
            self.step()
        return True

    def let_pass(self, seconds: float) -> None:
        """Let that much simulated time pass, and happen what is due in it."""
        deadline = self.time + seconds
        while self._events and self._events[0][0] <= deadline:
            self.step()
        self.time = deadline
