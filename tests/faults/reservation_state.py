"""What the explicit-state model of reservations is made of: claims, rules, configurators and components.

A state is a value of numbers and texts; `Thawed` takes apart what a step changes (`tests/faults/reservation_model.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

Mask = int
"""A set of components, as bits; the order of the components is the order of the bits."""


@dataclass(frozen=True, slots=True)
class Claim:
    """What a configurator wants: target sets, best first; its priority; the components that are actuators."""

    targets: tuple[Mask, ...]
    priority: int = 0
    patient: bool = True
    actuators: Mask = 0
    dormant: Mask = 0
    """The components that have to be started before the task reserves any in turn."""


@dataclass(frozen=True, slots=True)
class Scheme:
    """The rules, each of which can be turned off."""

    one_by_one: bool = True
    """Reserve in order and queue where it is held; else reserve all at once and try again where one is held."""
    asks_to_yield: bool = True
    """Ask a holder of lower priority to yield; else take the component from it."""
    rests_first: bool = True
    """Let actuators confirm that they rest before the component that is asked for is released."""
    tells_waiting: bool = True
    """Tell the waiting when a component begins to act, so that they let go of what they hold."""
    keeps_order: bool = True
    """Let go of what comes later in the order, or search without the component, instead of waiting out of order."""
    offers_end: bool = True
    """Offer a free component for a short time only, and once to each that waits."""
    asks_again: bool = True
    """Reserve again where the component may have forgotten who waits; ask from time to time who is held."""


# A configurator's phases.
RESERVING, WAITING, SOURCES, ACTUATORS, RUNNING, RESTING, RELEASING, QUEUED, ENDED, DEAD, WAKING = range(11)


class Configurator:
    """What a configurator knows."""

    __slots__ = ("after", "confirmed", "excluded", "held", "offered", "pending", "phase", "queued", "target", "wanted")

    def __init__(self, frozen: tuple[int, ...]) -> None:
        (
            self.phase,
            self.target,
            self.held,
            self.confirmed,
            self.pending,
            self.excluded,
            self.queued,
            self.wanted,
            self.after,
            self.offered,
        ) = frozen

    def freeze(self) -> tuple[int, ...]:
        """All of it, as a value."""
        return (
            self.phase,
            self.target,
            self.held,
            self.confirmed,
            self.pending,
            self.excluded,
            self.queued,
            self.wanted,
            self.after,
            self.offered,
        )


class Place:
    """What a component knows.

    The holder (-1: none), the configuration that it acts in (0: at rest), to whom it is offered (-1: nobody), who
    waits, whether the holder was asked to yield, and who of the waiting has been offered it since it became free.
    """

    __slots__ = ("acting", "asked", "holder", "offer", "offered", "queue")

    def __init__(self, frozen: tuple[int, ...]) -> None:
        self.holder, self.acting, self.offer, self.queue, self.asked, self.offered = frozen

    def freeze(self) -> tuple[int, ...]:
        """All of it, as a value."""
        return self.holder, self.acting, self.offer, self.queue, self.asked, self.offered


State = tuple[
    tuple[tuple[int, ...], ...],
    tuple[tuple[int, ...], ...],
    tuple[tuple[str, ...], ...],
    tuple[tuple[str, ...], ...],
    tuple[int, int, int],
]


def bits(mask: Mask) -> list[int]:
    """The components of a set, in order."""
    return [index for index in range(mask.bit_length()) if mask >> index & 1]


Machine = TypeVar("Machine", Configurator, Place)
Frozen = tuple[tuple[int, ...], ...]


class Thawed(dict[int, Machine]):
    """The machines of one kind in a state, by number; an action touches few, and only these are taken apart."""

    __slots__ = ("_frozen", "_kind")

    def __init__(self, kind: Callable[[tuple[int, ...]], Machine], frozen: Frozen) -> None:
        self._kind, self._frozen = kind, frozen

    def __missing__(self, number: int) -> Machine:
        one = self[number] = self._kind(self._frozen[number])
        return one

    def freeze(self) -> Frozen:
        """All of them as a value."""
        frozen = list(self._frozen)
        for number, one in self.items():
            frozen[number] = one.freeze()
        return tuple(frozen)
