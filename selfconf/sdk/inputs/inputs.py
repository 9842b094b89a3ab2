"""The inputs of one component, as the calls of configurators say which outputs they are to follow.

What each of them does is in `signal_input`. They change one after the other: first all listen to what is new, then each
says whether it is unfed, and then all deliver, so that the component hears what it has lost before what it has gained.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Protocol

from selfconf import ros2
from selfconf.bus.port import Bus
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, Wire, Wires
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.inputs.signal_input import InputEvents, SignalInput

HANDOVER_PATIENCE = 30.0
"""Seconds for which the caller may wait for an input to be handed over: the longest handover, and what comes of it."""
HANDOVER_CHECK = 0.01
"""How often, in seconds, it is checked whether the new output has issued one."""


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


class Inputs:
    """The inputs of code, by name; those for calls of operations are none of them."""

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
        self._bus = bus
        self._inputs = {
            port.name: SignalInput(bus, keys, code, port, events, read)
            for port in sorted(profile.signal_inputs, key=lambda port: port.name)
        }
        self._when_settled: list[Callable[[], None]] = []
        """What is to be done once no input is handed over any more; while there is any, it is checked whether it is so.
        """

    def follow(self, message: Apply) -> None:
        """Follow exactly the outputs that a call names, and listen to those that stand by.

        New connections are made first, because others wait for what flows over them; the old ones end when the call
        has been answered.
        """
        for name, one in self._inputs.items():
            one.listen(message.inputs.get(name, ()), message.standby.get(name, ()))
        for one in self._inputs.values():
            one.change(message.gently)
        for one in self._inputs.values():
            one.deliver()

    @property
    def patience(self) -> float:
        """For how many seconds the caller may wait for the inputs that are being handed over; zero: for none."""
        return HANDOVER_PATIENCE if self._handed_over else 0.0

    def holders_changed(self) -> None:
        """Do nothing: the inputs of code follow the same for all that hold the component."""

    def lack_a_part(self, lacking: bool) -> None:
        """Do nothing: it is the code that rests."""

    def say_again(self, woken_by: str) -> None:
        """Ask for what inputs have passed over while the code was at rest, or had before, but for one that is fed."""
        for name, one in self._inputs.items():
            if name != woken_by:
                one.say_again()

    def when_settled(self, action: Callable[[], None]) -> None:
        """Do something once no input follows an output any more that it is to let go of."""
        self._when_settled.append(action)
        if len(self._when_settled) == 1:
            self._look_whether_settled(self._bus.now())

    def _look_whether_settled(self, due: float) -> None:
        """Look again and again; by as much as a look comes late this process stood still, and no signal could come."""
        if not self._handed_over:
            waiting, self._when_settled = self._when_settled, []
            for action in waiting:
                action()
            return
        late = max(0.0, self._bus.now() - due)
        for one in self._inputs.values():
            one.look(late)
        pause = HANDOVER_CHECK if self._handed_over else 0.0
        self._bus.later(pause, partial(self._look_whether_settled, self._bus.now() + pause))

    @property
    def _handed_over(self) -> bool:
        return any(one.handed_over for one in self._inputs.values())

    def end(self) -> None:
        """Follow nothing."""
        for one in self._inputs.values():
            one.end()

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return sum(one.dropped for one in self._inputs.values())

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
        return {(name, wire) for name, one in self._inputs.items() for wire in one.followed}
