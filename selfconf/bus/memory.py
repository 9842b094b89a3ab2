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
from functools import lru_cache
from math import isfinite
from numbers import Real
from typing import TypeVar

from selfconf.bus.port import LARGEST_REPLIES, Replies, Sample, Urgency
from selfconf.errors import ProgrammerError
from selfconf.model.immutable import immutable
from selfconf.model.wording import listed

_T = TypeVar("_T")


@lru_cache(maxsize=1 << 14)
def intersects(left: str, right: str) -> bool:
    """Whether two key expressions meet: `*` is one chunk, `**` any number of them, neither stands for `@...`.

    Of a chunk that ends with `$*` the beginning is compared.
    """
    return _intersect(left.split("/"), right.split("/"))


def _intersect(left: list[str], right: list[str]) -> bool:
    if not left or not right:
        return all(chunk == "**" for chunk in left or right)
    if left[0] == "**":
        return _intersect(left[1:], right) or (_wild(right[0]) and _intersect(left, right[1:]))
    if right[0] == "**":
        return _intersect(right, left)
    return (_covers(left[0], right[0]) or _covers(right[0], left[0])) and _intersect(left[1:], right[1:])


def _covers(pattern: str, chunk: str) -> bool:
    """Whether a chunk is what another one means, which may be `*`, or `a$*`: whatever begins with an `a`."""
    return pattern == chunk or (pattern == "*" and _wild(chunk)) or _begins(pattern, chunk)


def _begins(pattern: str, chunk: str) -> bool:
    return pattern.endswith("$*") and chunk.startswith(pattern.removesuffix("$*"))


def _wild(chunk: str) -> bool:
    return not chunk.startswith("@")


LEASE = 1.0
"""Seconds after which a node that is paused counts as gone: its lives seem to have ended."""
REJOINING = 0.1
"""Seconds that a node whose lease has run out needs to be connected again, once it goes on."""
_LEAST_TIMER = 1e-6
"""Seconds that a timer takes at least, unless it takes none: rounding may make less than that no time at all, and a
timer that is renewed until a time has come would never end."""


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
        self._cut: set[tuple[int, int]] = set()
        """The one-way links that are cut: sender, receiver."""
        self._latest: dict[tuple[int, int], float] = {}
        """When the latest event from one node to another arrives, which no later one may overtake."""
        self._serving: dict[str, list[tuple[MemoryBus, Callable[[_Request], None]]]] = {}
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
        lone = sender is not receiver and (sender.expelled or receiver.expelled)
        return lone or (sender.number, receiver.number) in self._cut

    def pause(self, node: MemoryBus) -> None:
        """Let a node do nothing, as SIGSTOP does: what arrives waits, timers are late, and after `LEASE` it is gone.

        Pausing a node that never resumes, and closing it later, is what others see of a host that loses its power.
        """
        if node.paused or not node.open:
            return
        node.pauses += 1
        self.shape += 1
        node.paused, number = True, node.pauses

        def expel() -> None:
            if node.open and node.paused and node.pauses == number:
                self._expel(node)

        self.after(LEASE, expel)

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
            other.unsee(node)
        for other in heard:
            node.unsee(other)
        node.match_all()

    def _readmit(self, node: MemoryBus) -> None:
        node.expelled = False
        self.shape += 1
        for other in self.nodes:
            if other is not node and other.open:
                if self.reaches(node, other):
                    other.see(node)
                if self.reaches(other, node):
                    node.see(other)
        node.match_all()

    def serving(self, key: str) -> list[tuple[MemoryBus, Callable[[_Request], None]]]:
        """The nodes that serve a key, in reach or not, each with what answers."""
        found = self._serving.get(key)
        if found is None:
            found = self._serving[key] = [
                (node, answer)
                for node in self.nodes
                for served, answer in node._queryables.values()
                if intersects(key, served)
            ]
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
            self._at(moment, arrive)
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

    def at(self, time: float, node: MemoryBus, action: Callable[[], None]) -> None:
        """Have a node do something at a time, if it is still there: a timer."""

        def act() -> None:
            if node.open:
                node.take(action, timer=True)

        self._at(time, act)

    def after(self, seconds: float, action: Callable[[], None]) -> None:
        """Have something happen to the network itself, which is never paused."""
        self._at(self.time + seconds, action)

    def _at(self, time: float, action: Callable[[], None]) -> None:
        heapq.heappush(self._events, (time, next(self._count), action))

    def step(self) -> bool:
        """Let the next thing happen; False if nothing is left."""
        if not self._events:
            return False
        time, _, action = heapq.heappop(self._events)
        if time > self.time:
            self.time = time
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


class MemoryBus:
    """A node of the simulated network."""

    def __init__(self, network: Network, number: int, clock: float = 0.0) -> None:
        self.network, self.number, self.open = network, number, True
        self.clock = clock
        """By how many seconds the clock of this node is ahead of the network's time."""
        self.paused, self.pauses = False, 0
        self.expelled = False
        """Whether it was paused for so long that its links are gone."""
        self.busy_until = 0.0
        """Until when a callback keeps the thread of this node busy; what it sends goes out after that."""
        self._late_timers: list[Callable[[], None]] = []
        self._late_arrivals: list[Callable[[], None]] = []
        self._subscribers: dict[int, tuple[str, Callable[[Sample], None]]] = {}
        self._queryables: dict[int, tuple[str, Callable[[_Request], None]]] = {}
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
            self.network._at(self.network.time, _again(self, action, timer))

    def spend(self, seconds: float) -> None:
        """Keep the thread of this node busy, as slow code in a callback does; its lives go on meanwhile."""
        self.busy_until = max(self.network.time, self.busy_until) + seconds
        self.network._at(self.busy_until, self.catch_up)

    def now(self) -> float:
        """Seconds of simulated time, by the clock of this node."""
        return max(self.network.time, self.busy_until) + self.clock

    def later(self, seconds: float, action: Callable[[], None]) -> Callable[[], None]:
        """Call `action` once, after that time."""
        undone = False

        def act() -> None:
            if not undone:
                action()

        def undo() -> None:
            nonlocal undone
            undone = True

        seconds = seconds and max(seconds, _LEAST_TIMER)
        self.network.at(max(self.network.time, self.busy_until) + seconds, self, act)
        return undo

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` soon."""
        self.network._at(self.network.time, _again(self, action, timer=False))

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

    def serve(self, key: str, answer: Callable[[_Request], None], *, complete: bool = False) -> Callable[[], None]:
        """Answer questions to a key; here all nodes that do are asked."""
        undo = self._declare(self._queryables, (key, answer))
        self.network.forget_serving()

        def undone() -> None:
            undo()
            self.network.forget_serving()

        return undone

    def ask(
        self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None], attachment: bytes = b""
    ) -> None:
        """Ask all queryables of a key; a question or a reply that is lost shows as a time-out."""
        question = _Question(self, done)
        said = Sample(key, payload, attachment)
        for node, answer in self.network.serving(key):
            if self.network.reaches(self, node):
                question.asked(node, said, answer)
        question.sent(seconds)

    def announce(self, key: str) -> Callable[[], None]:
        """Be alive under a key."""
        undo = self._declare(self._tokens, key)
        self._publish_life(key, True)

        def undone() -> None:
            if key in self._tokens.values():
                undo()
                self._publish_life(key, False)

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
                        self.network.deliver(node, self, _life_notice(self, number, changed, token, True))
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
            self._publish_life(key, False)
        self.open = False
        self.network.shape += 1
        self._tokens.clear()
        self._late_timers, self._late_arrivals = [], []
        self.match_all()

    def see(self, other: MemoryBus) -> None:
        """Notice the lives of another node."""
        self._notice_lives(other, True)

    def unsee(self, other: MemoryBus) -> None:
        """Notice the end of the lives of another node."""
        self._notice_lives(other, False)

    def _notice_lives(self, other: MemoryBus, alive: bool) -> None:
        for token in other._tokens.values():
            for number, watch in list(self._watchers.items()):
                if intersects(watch.key, token) and watch.tells(token, alive, alone=True):
                    self.network.at(self.network.time, self, _life_notice(self, number, watch.changed, token, alive))

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


class _Question:
    """A question that was asked: collects replies until all queryables have finished, or the time is over."""

    def __init__(self, bus: MemoryBus, done: Callable[[Replies], None]) -> None:
        self.bus, self._done = bus, done
        self._samples: list[Sample] = []
        self._errors: list[str] = []
        self._open = self._size = 0
        self._over = False

    def asked(self, node: MemoryBus, said: Sample, answer: Callable[[_Request], None]) -> None:
        self._open += 1
        request = _Request(self, node, said)
        self.bus.network.deliver(self.bus, node, lambda: answer(request), sure=False)

    def sent(self, seconds: float) -> None:
        if self._open == 0:
            self.bus.network.deliver(self.bus, self.bus, lambda: self._end(True))
        self.bus.later(seconds, lambda: self._end(False))

    def replied(self, sample: Sample | None, error: str | None) -> None:
        self._size += len(error or "") if sample is None else len(sample.payload)
        if self._size > LARGEST_REPLIES:
            return
        if sample is not None:
            self._samples.append(sample)
        if error is not None:
            self._errors.append(error)

    def finished(self) -> None:
        self._open -= 1
        if self._open == 0:
            self._end(True)

    def _end(self, complete: bool) -> None:
        if not self._over:
            self._over = True
            self._done(Replies(tuple(self._samples), tuple(self._errors), complete and self._size <= LARGEST_REPLIES))


class _Request:
    """A question as it arrived at a node."""

    def __init__(self, question: _Question, node: MemoryBus, said: Sample) -> None:
        self._question, self._node = question, node
        self.key, self.payload, self.attachment = said
        self._finished = False
        self._lost = node.network.loses()
        """Whether the answer is lost: all of it, and its end, so that it shows as a time-out."""

    def reply(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """One reply."""
        self._back(lambda: self._question.replied(Sample(key, payload, attachment), None))

    def refuse(self, reason: str) -> None:
        """Reply that it cannot be answered."""
        self._back(lambda: self._question.replied(None, reason))

    def finish(self) -> None:
        """End the answer."""
        if not self._finished:
            self._finished = True
            self._back(self._question.finished)

    def _back(self, action: Callable[[], None]) -> None:
        if not self._lost:
            self._node.network.deliver(self._node, self._question.bus, action)
