"""What components say of themselves on the bus, as events of a configurator's machine: FAIL, free, moved."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import TypeVar

from selfconf.bus.port import Sample, Urgency
from selfconf.configurator import BegunElsewhere, Failed, Freed, Rewired
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.task_context import TaskContext
from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import component_chunk, owner_of_fail
from selfconf.protocol.messages import Cause, Fail, Free, Message, Moved

log = logging.getLogger(__name__)

Said = TypeVar("Said", bound=Message)


class ComponentMessages:
    """Receives what components say, and feeds the machine of one task with what is about it."""

    def __init__(
        self,
        context: TaskContext,
        lives: HeldLives,
        ends: PortEnds,
        heed: Callable[[Failed], None],
    ) -> None:
        """`heed` receives each failure that is about the task."""
        self._keys, self._task = context.ecology.keys, context.identity().task
        self._lives, self._ends, self._state, self._step = lives, ends, context.state, context.step
        self._heed = heed
        self._watched: set[IRI] = set()
        bus = context.ecology.bus
        # One subscription for the FAIL of all components: one for each that joins would delay its activation.
        self._subscriptions = [
            bus.subscribe(self._keys.any_fail(), partial(self._received, Fail, self._failed), Urgency.EVENT),
            bus.subscribe(self._keys.any_free(), partial(self._received, Free, self._freed), Urgency.EVENT),
            bus.subscribe(self._keys.any_moved(), partial(self._received, Moved, self._moved), Urgency.EVENT),
        ]

    def watch(self, component: IRI) -> None:
        """Let the FAIL of a component count from now on."""
        self._watched.add(component)

    def unwatch(self, component: IRI) -> None:
        """Pass over the FAIL of a component from now on."""
        self._watched.discard(component)

    def close(self) -> None:
        """Receive nothing any more."""
        for undo in self._subscriptions:
            undo()

    def _received(self, kind: type[Said], heed: Callable[[str, Said], None], sample: Sample) -> None:
        """Heed a message, given the key on which it came, unless it cannot be read."""
        try:
            message = decode(sample.payload, kind)
        except PeerError as error:
            log.warning("passed over a message on %s: %s", sample.key, error)
        else:
            heed(sample.key, message)

    def _failed(self, key: str, fail: Fail) -> None:
        own = key == self._keys.fail(fail.component)
        reported = fail.cause is Cause.SILENCE and self._may_report(owner_of_fail(key), fail.component)
        if not self._heeds(fail):
            return
        if (
            own
            and fail.cause is Cause.CRASH
            and fail.component in (self._state().held.keys() | self._state().owed.keys())
        ):
            self._lives.gone(fail.component)  # its site has told: its process has ended, or is being ended
        if fail.cause is Cause.LET_GO and fail.component in self._state().held:
            log.warning("%s has let go of this task: %s", fail.component.short, fail.detail)
        if fail.component in self._watched and (own or reported):
            self._heed(Failed(fail.component, fail.life, fail.cause, fail.detail))

    def _may_report(self, reporter: str, silent: IRI) -> bool:
        """Whether a component, given by its chunk, may say that another one is silent: one that may follow it.

        That is one of this task, or of what issues outputs of the composite that this is the inside of anyone outside.
        """
        target = self._state().target
        outside = target is not None and self._ends.stands_outside(silent, target)
        return outside or reporter in map(component_chunk, self._watched)

    def _heeds(self, fail: Fail) -> bool:
        """Whether a FAIL may be about this task, as far as it says itself."""
        if fail.task not in ("", self._task):
            return False
        if fail.cause is Cause.LET_GO:
            return fail.epoch > 0  # else it has obeyed a release, which those need to know that follow its outputs
        if fail.cause is not Cause.YIELD or fail.task:
            return True
        # An older component names no task with a yield, and this one may be the one that asks.
        held = self._state().held.get(fail.component)
        return held is not None and held.reserved

    def _moved(self, key: str, moved: Moved) -> None:
        mine = key == self._keys.moved(moved.component) and moved.component in self._state().held
        if mine and self._state().held[moved.component].life in ("", moved.life):
            self._ends.moved(moved.component, moved.outputs, moved.callers)
            self._step(Rewired(moved.component))

    def _freed(self, key: str, free: Free) -> None:
        if key != self._keys.free(free.component):
            return
        if free.task == self._task:
            self._step(Freed(free.component))
        elif not free.task:
            self._step(BegunElsewhere(free.component))
