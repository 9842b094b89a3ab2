"""The inputs of a component: which outputs they follow, when they are unfed, how one output follows another.

Each input has a subscription for each of its outputs (`input_subscription`).

*Blindness.* An input is unfed when the life of the last of its outputs has ended, or that output's component has raised
FAIL, has fallen silent, or has let go of a task and acts for no other, or another output has taken its place and has
not issued anything yet. It is fed again by the first signal that comes; what still waits of a lost output is dropped,
or a slow component would take it for news. So is what an output that stands by has issued for another task, which it
acts for no more.

*Handing over.* Where a call asks for it (`gently`), an input goes on following the old output until the new one has
issued a signal, also where it follows others before and afterwards. One that is lost right after its first has taken no
place yet. A new output that issues nothing in time while the old one does is reported as silent, and again as long as
both is so; what becomes of that is for the configurator to say. An output that has nothing to issue, such as a
doorbell, looks like one that never will: where the old one has issued nothing in that time either, and both live, the
new one takes its place, and the input has lost nothing.

*Opening.* Where such a call starts the component, an input has followed nothing before. Then it waits for the first
signal of an output that promises a rate, as what the component takes the place of goes on until then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from functools import partial
from typing import Any, Protocol

from selfconf import ros2
from selfconf.bus.port import Bus
from selfconf.model.immutable import immutable, replace
from selfconf.model.profile import CALL_MARK, Profile
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, Wire, Wires
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Signal
from selfconf.sdk.inputs.input_subscription import InputEvents, InputSubscription
from selfconf.sdk.inputs.signal_queue import SignalQueue
from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE

HANDOVER = 2.0
"""Seconds in which an output that an input is handed over to has to issue a signal: more where it promises one only in
`PATIENCE` longer periods, but not more than `BEGINNING`."""
HANDOVER_PATIENCE = 30.0
"""Seconds for which the caller may wait for an input to be handed over: the longest handover, and what comes of it."""
HANDOVER_CHECK = 0.01
"""How often, in seconds, it is looked whether the new output has issued one."""


class InputFollower(Protocol):
    """What does as the calls of a configurator say about inputs: the inputs of code, or the inside of a composite."""

    ending: bool
    """Whether what it did for the last activation has not come to rest yet."""

    @property
    def settled(self) -> bool:
        """Whether it does what it was asked."""
        ...

    @property
    def patience(self) -> float:
        """For how many seconds its caller may wait until it is settled; zero: as long as for any component."""
        ...

    @property
    def issued(self) -> Wires:
        """Which outputs stand behind those of the component, if they are others."""
        ...

    @property
    def callers(self) -> Mapping[str, tuple[IRI, ...]]:
        """Which components call the operations that the component needs, if they are others."""
        ...

    @property
    def dropped(self) -> int:
        """How many signals were dropped."""
        ...

    def follow(self, message: Apply) -> None:
        """Do as a call says."""
        ...

    def when_settled(self, action: Callable[[], None]) -> None:
        """Do something once what the call has said is done."""
        ...

    def holders_changed(self) -> None:
        """Take note that other tasks hold the component than before, or otherwise."""
        ...

    def lack_a_part(self, lacking: bool) -> None:
        """Let actuators inside rest while all tasks that the component acts for lack a part."""
        ...

    def say_again(self, woken_by: str) -> None:
        """Deliver the last signals once more, but for those of the input by which the code was woken from its rest."""
        ...

    def end(self) -> None:
        """Follow nothing."""
        ...


@immutable
class Handover:
    """The change of an input to other outputs: it follows the old and the new until one of the new has issued a signal.

    What it goes on following is neither. There are no old ones where it opens. `due` is when it is looked next whether
    the new ones issue nothing although the old ones do, or although they promise a rate.
    """

    old: frozenset[Wire]
    new: tuple[Wire, ...]
    began: float
    due: float

    @classmethod
    def beginning(cls, now: float, old: frozenset[Wire], new: tuple[Wire, ...]) -> Handover:
        """Return a handover that begins now; one of the new outputs may take as long as the slowest promises."""
        seconds = max(HANDOVER, *(PATIENCE * (wire.period or 0.0) for wire in new))
        return cls(old, new, now, now + min(seconds, BEGINNING))


class Inputs:
    """The subscriptions of one component, by input and output."""

    ending = False
    settled = True

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        code: CodeThread,
        profile: Profile,
        events: InputEvents,
        read: Callable[[Any, str], Any] = ros2.received,
    ) -> None:
        """`read` makes of a value and its media type what the component receives; it may raise ValueError."""
        self._bus, self._keys, self._code, self._events, self._read_value = bus, keys, code, events, read
        self._depths = {port.name: port.depth for port in profile.signal_inputs}
        self._required = {port.name for port in profile.required if not port.is_operation}
        self._subscriptions: dict[tuple[str, Wire], InputSubscription] = {}
        self._wanted: frozenset[tuple[str, Wire]] = frozenset()
        self._spare: frozenset[tuple[str, Wire]] = frozenset()
        """Which outputs each input is to follow, and which stand by."""
        self._handovers: dict[str, Handover] = {}
        """The inputs that follow what they followed before as well, until a new output has issued a signal."""
        self._when_settled: list[Callable[[], None]] = []
        """What is to be done once no input is handed over any more; while there is any, it is looked whether it is so.
        """
        self._dropped = 0
        """How many signals were dropped of subscriptions that have ended."""

    def follow(self, message: Apply) -> None:
        """Follow exactly the outputs that a call names, and listen to those that stand by.

        New connections are made first, because others wait for what flows over them; the old ones end when the call
        has been answered.
        """
        now = self._bus.now()
        wanted, spare = dict.fromkeys(_signals(message.inputs)), dict.fromkeys(_signals(message.standby))
        for port, wire in (*wanted, *spare):
            if (port, wire) not in self._subscriptions:
                self._subscriptions[port, wire] = self._subscription(port, wire)
        fed, opening = self._fed(), dict(self._opening(message, now))
        before, self._handovers = self._handovers, opening
        for port, wires in fed.items():
            handover = self._change(port, wires, message, before.get(port)) if port not in opening else None
            if handover is not None:
                self._handovers[port] = handover
        self._tell_unfed(fed.keys(), message.inputs)
        self._wanted, self._spare = frozenset(wanted), frozenset(spare)
        for key in wanted:
            self._subscriptions[key].unmute()
        self._let_go()

    def _change(self, port: str, fed_by: frozenset[Wire], message: Apply, last: Handover | None) -> Handover | None:
        """Return how an input is handed over, if it is; tell that it is unfed if it loses all that may feed it."""
        new = message.inputs.get(port, ())
        awaited = tuple(wire for wire in new if wire not in fed_by)
        if fed_by.issubset(new) or any(self._subscriptions[port, wire].just_issued for wire in awaited):
            return None
        if last is not None and awaited and last.new == awaited:
            return last  # a call that was repeated, or of another task that wants the same of the component
        if awaited and message.gently:
            return Handover.beginning(self._bus.now(), fed_by.difference(new), awaited)
        if fed_by.isdisjoint(new):
            self._events.unfed(port)
        return None

    def _tell_unfed(self, known: Set[str], inputs: Wires) -> None:
        """Tell of the required inputs that nothing feeds: behind a composite may stand nothing just now."""
        for port in self._required - known:
            if not inputs.get(port):
                self._events.unfed(port)

    def _fed(self) -> dict[str, frozenset[Wire]]:
        """The inputs that may be fed, with what they follow: an output that is lost, or not theirs yet, feeds none."""
        fed: dict[str, set[Wire]] = {}
        for port, wire in self.followed:
            if self._may_be_fed_by(port, wire) and not self._subscriptions[port, wire].lost:
                fed.setdefault(port, set()).add(wire)
        return {port: frozenset(wires) for port, wires in sorted(fed.items())}

    def _opening(self, message: Apply, now: float) -> Iterator[tuple[str, Handover]]:
        """Yield the inputs that have followed nothing, and are to wait for the first signal of an output."""
        known = {port for port, wire in self.followed if self._is_own(port, wire)}
        for port, new in message.inputs.items():
            last = self._handovers.get(port)
            if last is not None and not last.old and last.new == new:  # a call that was repeated
                yield port, last
            elif message.gently and port not in known and self._promised(port, new):
                yield port, Handover.beginning(now, frozenset(), new)

    def _is_own(self, port: str, wire: Wire) -> bool:
        """Whether an input is not only being handed over to an output: that may have delivered before it is looked."""
        handover = self._handovers.get(port)
        return (
            handover is None or wire not in handover.new or self._subscriptions[port, wire].heard_since(handover.began)
        )

    def _may_be_fed_by(self, port: str, wire: Wire) -> bool:
        """Whether an input may be fed by an output: its own, or one of those that it opens with, if none has yet."""
        handover = self._handovers.get(port)
        return (handover is not None and not handover.old) or self._is_own(port, wire)

    def _promised(self, port: str, new: tuple[Wire, ...]) -> bool:
        """Whether an output that is not lost promises to issue a signal soon, and none has just done so."""
        if port.endswith(CALL_MARK):
            return False
        there = [wire for wire in new if not self._subscriptions[port, wire].lost]
        soon = any(wire.period is not None and PATIENCE * wire.period <= BEGINNING for wire in there)
        return soon and not any(self._subscriptions[port, wire].just_issued for wire in there)

    @property
    def patience(self) -> float:
        """For how many seconds the caller may wait for the inputs that are being handed over; zero: for none."""
        return HANDOVER_PATIENCE if self._handovers else 0.0

    def holders_changed(self) -> None:
        """Do nothing: the inputs of code follow the same for all that hold the component."""

    def lack_a_part(self, lacking: bool) -> None:
        """Do nothing: it is the code that rests."""

    def say_again(self, woken_by: str) -> None:
        """Ask for what inputs have passed over while the code was at rest, or had before, but for one that is fed."""
        for (port, _), subscription in self._subscriptions.items():
            if port != woken_by:
                subscription.say_again()

    def when_settled(self, action: Callable[[], None]) -> None:
        """Do something once no input follows an output any more that it is to let go of."""
        self._when_settled.append(action)
        if len(self._when_settled) == 1:
            self._look_whether_settled(self._bus.now())

    def _look_whether_settled(self, due: float) -> None:
        """Look again and again; by as much as a look comes late this process stood still, and no signal could come."""
        if not self._handovers:
            waiting, self._when_settled = self._when_settled, []
            for action in waiting:
                action()
            return
        late = max(0.0, self._bus.now() - due)
        for port, handover in list(self._handovers.items()):
            self._handovers[port] = later = replace(handover, due=handover.due + late)
            self._hand_over(port, later)
        self._let_go()
        pause = HANDOVER_CHECK if self._handovers else 0.0
        self._bus.later(pause, partial(self._look_whether_settled, self._bus.now() + pause))

    def _hand_over(self, port: str, handover: Handover) -> None:
        """End a handover if the new outputs deliver, or are as quiet as the old; report them as silent if they are."""
        old = [self._subscriptions[port, wire] for wire in handover.old]
        new = [self._subscriptions[port, wire] for wire in handover.new]
        now, began = self._bus.now(), handover.began
        delivers = any(one.delivers_since(began) for one in new)
        if not delivers and now < handover.due:
            return
        quiet = old and not any(one.heard_since(began) for one in old) and not all(one.lost for one in new)
        if delivers or quiet:
            del self._handovers[port]
            return
        self._handovers[port] = replace(handover, due=now + HANDOVER)
        for wire in handover.new:
            if old or wire.period is not None:  # where there is none to compare with, by what it has promised
                self._events.silent(wire, now - began)

    def _let_go(self) -> None:
        """End or mute what no input is to follow any more; an input that is handed over goes on following it."""
        kept = {(port, wire) for port, handover in self._handovers.items() for wire in handover.old}
        for key, subscription in list(self._subscriptions.items()):
            if key in self._wanted or key in kept:
                continue
            subscription.mute()
            if key not in self._spare:
                del self._subscriptions[key]
                self._bus.wake_up(subscription.end)
                self._dropped += subscription.dropped

    def end(self) -> None:
        """Follow nothing."""
        for subscription in self._subscriptions.values():
            subscription.end()
            self._dropped += subscription.dropped
        self._subscriptions.clear()
        self._handovers = {}

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return self._dropped + sum(subscription.dropped for subscription in self._subscriptions.values())

    @property
    def issued(self) -> Wires:
        """Nothing: the component issues its own outputs."""
        return {}

    @property
    def callers(self) -> Mapping[str, tuple[IRI, ...]]:
        """Nothing: the component itself calls the operations that it needs."""
        return {}

    @property
    def followed(self) -> set[tuple[str, Wire]]:
        """Which output each input follows, those that only stand by left out."""
        return {key for key, subscription in self._subscriptions.items() if not subscription.muted}

    def _subscription(self, port: str, wire: Wire) -> InputSubscription:
        queue = SignalQueue(self._depths.get(port) or (1 if wire.period is not None else None))
        events = replace(self._events, deliver=partial(self._deliver, wire))
        return InputSubscription(
            self._bus, self._keys, self._code, port, wire, queue, events, self._lost, self._read_value
        )

    def _deliver(self, wire: Wire, port: str, signal: Signal) -> None:
        """Deliver a signal, but none of the old outputs once a new one has: it may be looked only later who issues.

        Called on the thread of the component's code.
        """
        handover = self._handovers.get(port)
        if handover is not None and wire in handover.old:
            new = (self._subscriptions.get((port, one)) for one in handover.new)  # none once the inputs have ended
            if any(one is not None and one.has_delivered_since(handover.began) for one in new):
                return
        self._events.deliver(port, signal)

    def _lost(self, port: str) -> None:
        """One output that an input follows is lost; the input is unfed if that was the last one.

        An output to which it is only being handed over has not fed it yet: there is nothing to hand over any more.
        """
        following = [
            subscription
            for (one, wire), subscription in self._subscriptions.items()
            if one == port and not subscription.muted and self._may_be_fed_by(port, wire)
        ]
        if all(subscription.lost for subscription in following):
            self._events.unfed(port)
            if self._handovers.pop(port, None) is not None:
                self._bus.later(0.0, self._let_go)


def _signals(inputs: Wires) -> Iterator[tuple[str, Wire]]:
    """Yield which inputs are to follow which outputs, operations left out."""
    return ((port, wire) for port, wires in inputs.items() if not port.endswith(CALL_MARK) for wire in wires)
