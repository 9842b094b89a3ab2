"""One input of a component: which outputs it follows, when it is unfed, how one output follows another.

An input has a subscription for each output that it follows (`input_subscription`). It is handed over from one output to
another if a call asks for that (`handover`).

An output is lost when the life of its component ends, or when that component raises FAIL, falls silent, or lets go of a
task and acts for no other. An input is unfed when it has lost the last of its outputs, or when another output has taken
the place of the last one and has not issued a signal yet. The next signal that comes feeds it.

Signals of a lost output that still wait are dropped: a slow component would take them for new ones. So is what an
output that stands by has issued for another task, if its component does not act for that task any more.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from selfconf.bus.port import Bus
from selfconf.model.immutable import immutable, replace
from selfconf.model.profile import Input
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Wire
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Signal
from selfconf.sdk.inputs.handover import HANDOVER, Handover
from selfconf.sdk.inputs.input_subscription import InputSubscription
from selfconf.sdk.inputs.signal_queue import SignalQueue
from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE


@immutable
class InputEvents:
    """What the inputs of a component report: on the code's thread what arrives, on the bus's thread the rest."""

    deliver: Callable[[str, Signal], None]
    """A signal has arrived on an input; called on the thread of the component's code."""
    silent: Callable[[Wire, float], None]
    """An output that has promised a rate has issued nothing for so many seconds."""
    unfed: Callable[[str], None]
    """An input has lost its last source."""


class SignalInput:
    """One input, with a subscription for each output that it follows or that stands by for it."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        code: CodeThread,
        port: Input,
        events: InputEvents,
        read: Callable[[Any, str], Any],
    ) -> None:
        """`read` makes of a value and its media type what the component receives; it may raise ValueError."""
        self._bus, self._keys, self._code, self._port, self._events, self._read = bus, keys, code, port, events, read
        self._subscriptions: dict[Wire, InputSubscription] = {}
        self._wanted: tuple[Wire, ...] = ()
        """Which outputs it is to follow."""
        self._spare: tuple[Wire, ...] = ()
        """Which outputs stand by."""
        self._handover: Handover | None = None
        self._dropped = 0
        """How many signals were dropped of subscriptions that have ended."""

    @property
    def followed(self) -> list[Wire]:
        """Which outputs it follows, those that only stand by left out."""
        return [wire for wire, subscription in self._subscriptions.items() if not subscription.muted]

    @property
    def handed_over(self) -> bool:
        """Whether it waits for the first signal of a new output."""
        return self._handover is not None

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return self._dropped + sum(subscription.dropped for subscription in self._subscriptions.values())

    # What a call says, in this order.

    def listen(self, wanted: tuple[Wire, ...], spare: tuple[Wire, ...]) -> None:
        """Take note of which outputs are to be followed and which stand by, and listen to all of them."""
        self._wanted, self._spare = wanted, spare
        for wire in (*wanted, *spare):
            if wire not in self._subscriptions:
                self._subscriptions[wire] = self._subscription(wire)

    def change(self, gently: bool) -> None:
        """Begin to be handed over, if that is how the input changes; tell that it is unfed if nothing feeds it."""
        fed_by, before = self._fed_by(), self._handover
        self._handover = self._opening(gently)
        if self._handover is None and fed_by:
            self._handover = self._changed(fed_by, gently, before)
        elif not fed_by and not self._wanted and not self._port.optional:
            self._events.unfed(self._port.name)  # behind a composite may stand nothing just now

    def deliver(self) -> None:
        """Deliver from now on what comes of the outputs that are to be followed, and let go of the others."""
        for wire in self._wanted:
            self._subscriptions[wire].unmute()
        self._let_go()

    def _changed(self, fed_by: frozenset[Wire], gently: bool, before: Handover | None) -> Handover | None:
        """Return how the input is handed over, if it is; tell that it is unfed if it loses all that may feed it."""
        awaited = tuple(wire for wire in self._wanted if wire not in fed_by)
        if fed_by.issubset(self._wanted) or any(self._subscriptions[wire].just_issued for wire in awaited):
            return None
        if before is not None and awaited and before.new == awaited:
            return before  # a call that was repeated, or of another task that wants the same of the component
        if awaited and gently:
            return Handover.beginning(self._bus.now(), fed_by.difference(self._wanted), awaited)
        if fed_by.isdisjoint(self._wanted):
            self._events.unfed(self._port.name)
        return None

    def _opening(self, gently: bool) -> Handover | None:
        """Return that the input waits for the first signal of an output, where it has followed nothing before."""
        last, new = self._handover, self._wanted
        if last is not None and last.opens and last.new == new:  # a call that was repeated
            return last
        if gently and not any(map(self._is_own, self.followed)) and self._is_promised():
            return Handover.beginning(self._bus.now(), frozenset(), new)
        return None

    def _is_promised(self) -> bool:
        """Whether an output that is wanted and not lost promises a signal soon, and none has just issued one."""
        there = [wire for wire in self._wanted if not self._subscriptions[wire].lost]
        soon = any(wire.period is not None and PATIENCE * wire.period <= BEGINNING for wire in there)
        return soon and not any(self._subscriptions[wire].just_issued for wire in there)

    # What feeds it.

    def _fed_by(self) -> frozenset[Wire]:
        """What may feed it: an output that is lost, or not its own yet, does not."""
        return frozenset(
            wire for wire in self.followed if self._may_be_fed_by(wire) and not self._subscriptions[wire].lost
        )

    def _may_be_fed_by(self, wire: Wire) -> bool:
        """Whether it may be fed by an output: its own, or one of those that it opens with, if none has yet."""
        return (self._handover is not None and self._handover.opens) or self._is_own(wire)

    def _is_own(self, wire: Wire) -> bool:
        """Whether it is not only being handed over to an output: that may have delivered before it is looked."""
        going = self._handover
        return going is None or wire not in going.new or self._subscriptions[wire].heard_since(going.began)

    def _lost(self) -> None:
        """One output that it follows is lost; it is unfed if that was the last one.

        An output to which it is only being handed over has not fed it yet: there is nothing to hand over any more.
        """
        if all(self._subscriptions[wire].lost for wire in self.followed if self._may_be_fed_by(wire)):
            self._events.unfed(self._port.name)
            if self._handover is not None:
                self._handover = None
                self._bus.later(0.0, self._let_go)

    # What becomes of a handover.

    def look(self, late: float) -> None:
        """End a handover that is over, or report the new outputs as silent that issue nothing in time.

        For `late` seconds no signal could come, since it was looked last.
        """
        if self._handover is None:
            return
        self._handover = going = replace(self._handover, due=self._handover.due + late)
        now = self._bus.now()
        if self._is_over(going, now):
            self._handover = None
        elif now >= going.due:
            self._handover = replace(going, due=now + HANDOVER)
            for wire in going.new:
                if not going.opens or wire.period is not None:  # where none was before, by what it has promised
                    self._events.silent(wire, now - going.began)
        self._let_go()

    def _is_over(self, handover: Handover, now: float) -> bool:
        """Whether a new output delivers, or in time the new ones are as quiet as the old, and one of them lives."""
        old = [self._subscriptions[wire] for wire in handover.old]
        new = [self._subscriptions[wire] for wire in handover.new]
        if any(one.delivers_since(handover.began) for one in new):
            return True
        if handover.opens or now < handover.due:
            return False
        return not (any(one.heard_since(handover.began) for one in old) or all(one.lost for one in new))

    def _let_go(self) -> None:
        """End or mute what it is not to follow any more; while it is handed over, it goes on following the old ones."""
        kept = self._handover.old if self._handover is not None else ()
        for wire, subscription in list(self._subscriptions.items()):
            if wire in self._wanted or wire in kept:
                continue
            subscription.mute()
            if wire not in self._spare:
                del self._subscriptions[wire]
                self._bus.wake_up(subscription.end)
                self._dropped += subscription.dropped

    def say_again(self) -> None:
        """Ask for what it has passed over while the code was at rest, or had before."""
        for subscription in self._subscriptions.values():
            subscription.say_again()

    def end(self) -> None:
        """Follow nothing."""
        for subscription in self._subscriptions.values():
            subscription.end()
            self._dropped += subscription.dropped
        self._subscriptions.clear()
        self._handover = None

    def _subscription(self, wire: Wire) -> InputSubscription:
        queue = SignalQueue(self._port.depth or (1 if wire.period is not None else None))
        deliver, silent = partial(self._deliver, wire), partial(self._events.silent, wire)
        return InputSubscription(
            self._bus, self._keys, self._code, wire, queue, deliver, silent, self._lost, self._read
        )

    def _deliver(self, wire: Wire, signal: Signal) -> None:
        """Deliver a signal, but none of the old outputs once a new one has: it may be looked only later who issues.

        Called on the thread of the component's code.
        """
        going = self._handover
        if going is not None and wire in going.old:
            new = map(self._subscriptions.get, going.new)  # None once the input has ended
            if any(one is not None and one.has_delivered_since(going.began) for one in new):
                return
        self._events.deliver(self._port.name, signal)
