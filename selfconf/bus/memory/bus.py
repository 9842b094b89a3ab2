"""A node of the network in memory: what it subscribes to, serves, watches and announces, and the time by its clock."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from selfconf.bus.memory.key_expressions import intersects
from selfconf.bus.memory.questions import MemoryQuestion, MemoryRequest
from selfconf.bus.port import Replies, Sample, Urgency
from selfconf.model.immutable import immutable

if TYPE_CHECKING:
    from selfconf.bus.memory.network import Network

_T = TypeVar("_T")
_LEAST_TIMER = 1e-6
"""Seconds that a timer takes at least, unless it takes none: rounding may make less than that no time at all, and a
timer that is renewed until a time has come would never end."""


class MemoryBus:
    """A node of the simulated network."""

    def __init__(self, network: Network, number: int, clock: float) -> None:
        self.network, self.number, self.open = network, number, True
        self.clock = clock
        """By how many seconds the clock of this node is ahead of the network's time."""
        self.paused, self.pauses = False, 0
        self.expelled = False
        """Whether it was paused for so long that its links are gone."""
        self.host: frozenset[int] = frozenset()
        """The numbers of the nodes that it was paused together with: its links to these stay."""
        self.busy_until = 0.0
        """Until when a callback keeps the thread of this node busy; what it sends goes out after that."""
        self._late_timers: list[Callable[[], None]] = []
        self._late_arrivals: list[Callable[[], None]] = []
        self._subscribers: dict[int, tuple[str, Callable[[Sample], None]]] = {}
        self._queryables: dict[int, tuple[str, Callable[[MemoryRequest], None]]] = {}
        self._watchers: dict[int, _Watch] = {}
        self._tokens: dict[int, str] = {}
        self._publishers: dict[int, _Publisher] = {}
        self._count = itertools.count()

    @property
    def link(self) -> str:
        """The network, if this node reaches any other; one that is alone is not cut off."""
        others = [node for node in self.network.nodes if node is not self and node.open]
        reached = not others or any(
            self.network.reaches(self, node) or self.network.reaches(node, self) for node in others
        )
        return "network" if self.open and reached else ""

    def take(self, action: Callable[[], None], timer: bool = False) -> None:
        """Do what is due now, or keep it while this node is paused or busy."""
        if self.paused or self.network.time < self.busy_until:
            (self._late_timers if timer else self._late_arrivals).append(action)
        else:
            action()

    def catch_up(self) -> None:
        """Do what was kept: timers first, as a program's loop looks at its clock before it reads what has arrived."""
        if self.paused or self.network.time < self.busy_until:
            return
        late = [*((action, True) for action in self._late_timers), *((action, False) for action in self._late_arrivals)]
        self._late_timers, self._late_arrivals = [], []
        for action, timer in late:
            self.network.before_all_else(_again(self, action, timer))  # what is due by now comes after it

    def spend(self, seconds: float) -> None:
        """Keep the thread of this node busy, as slow code in a callback does; its lives go on meanwhile."""
        self.busy_until = max(self.network.time, self.busy_until) + seconds
        self.network.at_time(self.busy_until, self.catch_up)

    def when_lost(self, lost: Callable[[], None]) -> None:
        """Do nothing: no other code has the session of this node."""

    def now(self) -> float:
        """Seconds of simulated time, by the clock of this node."""
        return max(self.network.time, self.busy_until) + self.clock

    def later(self, seconds: float, action: Callable[[], None]) -> Callable[[], None]:
        """Call `action` once, after that time."""
        over = False

        def act() -> None:
            nonlocal over
            if not over:
                over = True
                action()

        def undo() -> None:
            nonlocal over
            if not over:
                over = True
                self.network.undo(number)

        seconds = seconds and max(seconds, _LEAST_TIMER)
        number = self.network.at(max(self.network.time, self.busy_until) + seconds, self, act)
        return undo

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` soon."""
        self.network.at_time(self.network.time, _again(self, action, timer=False))

    def publisher(
        self, key: str, urgency: Urgency, matched: Callable[[bool], None] | None = None, *, kept: int = 0
    ) -> _Publisher:
        """Declare a key to put on; here no subscriber asks for what was put before."""
        number = next(self._count)
        declared = _Publisher(self, number, key, urgency, matched)
        self._publishers[number] = declared
        declared.match()
        return declared

    def subscribe(
        self,
        key: str,
        receive: Callable[[Sample], None],
        urgency: Urgency = Urgency.SIGNAL,
        *,
        direct: bool = False,
    ) -> Callable[[], None]:
        """Receive every sample put on a key from now on; there is one thread, so `direct` makes no difference."""
        undo = self._declare(self._subscribers, (key, receive))
        self.match_all(key)

        def undone() -> None:
            undo()
            self.match_all(key)

        return undone

    def serve(self, key: str, answer: Callable[[MemoryRequest], None], *, complete: bool = False) -> Callable[[], None]:
        """Answer questions to a key; here all nodes that do are asked."""
        undo = self._declare(self._queryables, (key, answer))
        self.network.forget_serving()

        def undone() -> None:
            undo()
            self.network.forget_serving()

        return undone

    def answering(self, key: str) -> list[Callable[[MemoryRequest], None]]:
        """What answers questions to a key at this node, in the order of its declaration."""
        return [answer for served, answer in self._queryables.values() if intersects(key, served)]

    def ask(
        self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None], attachment: bytes = b""
    ) -> None:
        """Ask all queryables of a key; a question or a reply that is lost shows as a time-out."""
        question = MemoryQuestion(self, done)
        said = Sample(key, payload, attachment)
        for node, answer in self.network.serving(key):
            if self.network.reaches(self, node):
                question.asked(node, said, answer)
        question.sent(seconds)

    def announce(self, key: str) -> Callable[[], None]:
        """Be alive under a key."""
        undo = self._declare(self._tokens, key)
        self._publish_life(key, alive=True)

        def undone() -> None:
            if key in self._tokens.values():
                undo()
                self._publish_life(key, alive=False)

        return undone

    def watch(
        self, key: str, changed: Callable[[str, bool], None], *, history: bool = True, many: bool = False
    ) -> Callable[[], None]:
        """Follow every life under a key, those that are there already first, unless it is without `history`."""
        undo = self._declare(self._watchers, _Watch(key, changed, None if history else set()))
        number = max(self._watchers)
        for node in self.network.nodes if history else ():
            if self.network.reaches(node, self):
                for token in list(node._tokens.values()):
                    if intersects(key, token):
                        self.network.deliver(node, self, _life_notice(self, number, changed, token, alive=True))
        return undo

    def roll_call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """The keys that are alive right now."""
        alive = tuple(
            sorted(
                token
                for node in self.network.nodes
                if self.network.reaches(node, self)
                for token in node._tokens.values()
                if intersects(key, token)
            )
        )
        self.network.deliver(self, self, lambda: done(alive))

    def poll(self, seconds: float = 0.0) -> None:
        """Let the network run for that much simulated time."""
        self.network.let_pass(seconds)

    def run_aside(self) -> bool:
        """There is one thread, in which simulated time passes."""
        return False

    def run(self, until: Callable[[], bool]) -> None:
        """Let the network run until `until` holds."""
        self.network.run(until, float("inf"))

    def close(self) -> None:
        """Leave the network, as a crash or a clean exit does: others see the lives end."""
        for key in list(self._tokens.values()):
            self._publish_life(key, alive=False)
        self.open = False
        self.network.shape += 1
        self._tokens.clear()
        self._late_timers, self._late_arrivals = [], []
        self.match_all()

    def see(self, other: MemoryBus) -> None:
        """Notice the lives of another node."""
        self._notice_lives(other, alive=True)

    def unsee(self, other: MemoryBus) -> None:
        """Notice the end of the lives of another node."""
        self._notice_lives(other, alive=False)

    def _notice_lives(self, other: MemoryBus, alive: bool) -> None:
        for token in other._tokens.values():
            for number, watch in list(self._watchers.items()):
                if intersects(watch.key, token) and watch.tells(token, alive, alone=True):
                    notice = _life_notice(self, number, watch.changed, token, alive)
                    # Not before what has arrived already, as a timer would be: that may say the opposite.
                    self.network.at_time(self.network.time, _again(self, notice, timer=False))

    def _publish_life(self, token: str, alive: bool) -> None:
        for node in self.network.nodes:
            for number, watch in list(node._watchers.items()):
                if intersects(watch.key, token) and watch.tells(token, alive, alone=False):
                    notice = _life_notice(node, number, watch.changed, token, alive)
                    self.network.deliver(self, node, notice, outlasts_link=not alive)

    def _declare(self, where: dict[int, _T], what: _T) -> Callable[[], None]:
        number = next(self._count)
        where[number] = what

        def undo() -> None:
            where.pop(number, None)

        return undo

    def match_all(self, key: str | None = None) -> None:
        """Let every publisher of the network, or those on a key, notice whether there is a subscriber."""
        for node in self.network.nodes:
            for declared in list(node._publishers.values()):
                if key is None or intersects(key, declared.key):
                    declared.match()

    def _send(self, sample: Sample, urgency: Urgency) -> None:
        for node in self.network.nodes:
            for number, (key, receive) in list(node._subscribers.items()):
                if intersects(key, sample.key):
                    self.network.deliver(
                        self, node, _arrival(node, number, receive, sample), sure=urgency is Urgency.EVENT
                    )


@immutable
class _Watch:
    """Who follows the lives under a key, and without their history which of them it was shown."""

    key: str
    changed: Callable[[str, bool], None]
    shown: set[str] | None

    def tells(self, token: str, alive: bool, alone: bool) -> bool:
        """Whether the watch hears that a life begins or ends; `alone`: that a link comes or goes, and not the life."""
        if self.shown is None:
            return True
        told = alive or not alone or token in self.shown
        (self.shown.add if alive else self.shown.discard)(token)
        return told


def _again(node: MemoryBus, action: Callable[[], None], timer: bool) -> Callable[[], None]:
    def again() -> None:
        if node.open:
            node.take(action, timer)

    return again


def _arrival(node: MemoryBus, number: int, receive: Callable[[Sample], None], sample: Sample) -> Callable[[], None]:
    def arrive() -> None:
        if number in node._subscribers:  # it may have been undone while the sample was on its way
            receive(sample)

    return arrive


def _life_notice(
    node: MemoryBus, number: int, changed: Callable[[str, bool], None], token: str, alive: bool
) -> Callable[[], None]:
    def notice() -> None:
        if number in node._watchers:  # it may have been undone while the notice was on its way
            changed(token, alive)

    return notice


class _Publisher:
    """A declared key; it notices when there begins to be a subscriber."""

    def __init__(
        self, bus: MemoryBus, number: int, key: str, urgency: Urgency, matched: Callable[[bool], None] | None
    ) -> None:
        self._bus, self._number, self.key, self._urgency, self._matched = bus, number, key, urgency, matched
        self._matching = False

    def put(self, payload: bytes, attachment: bytes = b"") -> None:
        """Put a sample."""
        if self._bus.open:
            self._bus._send(Sample(self.key, payload, attachment), self._urgency)

    def undeclare(self) -> None:
        """Take the declaration back."""
        self._bus._publishers.pop(self._number, None)

    def match(self) -> None:
        """Call `matched` if it has changed whether there is a subscriber."""
        network = self._bus.network
        matching = any(
            intersects(key, self.key)
            for node in network.nodes
            if node._subscribers and network.reaches(node, self._bus)
            for key, _ in node._subscribers.values()
        )
        if matching != self._matching:
            self._matching = matching
            if self._matched is not None:
                matched = self._matched
                network.deliver(self._bus, self._bus, lambda: matched(matching))
