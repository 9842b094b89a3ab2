"""The last words of configurators that are asked to stop: which components had not obeyed as their tasks ended.

No configurator can be asked for that once it has ended, and none knows it before.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.port import Sample
from selfconf.errors import PeerError
from selfconf.model.run_event import TaskRefused, TaskStopped
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice

OVERTAKEN = 0.3
"""Seconds for which last words are waited for: the end of a life may overtake them."""
_ENDS = (TaskStopped.act, TaskRefused.act)


class LastWords:
    """Hears how some configurators end, from when it is made until it is asked."""

    def __init__(self, bus: SynchronousBus, keys: Keys, configurators: Iterable[str]) -> None:
        self._bus, self._keys = bus, keys
        self._owed: dict[str, frozenset[IRI] | None] = dict.fromkeys(configurators)
        """What each configurator was owed at its end; None: it has not said so yet."""
        self._undo = [bus.subscribe(keys.notices(one), self._noticed) for one in self._owed]
        # A configurator tells nothing before it knows that it is listened to, which it does once it answers.
        bus.ask_each([(keys.notices(one), b"") for one in self._owed])

    def owed(self) -> frozenset[IRI]:
        """The components that had not obeyed their release, by configurators that have ended; hears nothing after."""
        deadline = self._bus.now() + OVERTAKEN
        self._bus.run(lambda: None not in self._owed.values() or self._bus.now() > deadline)
        for undo in self._undo:
            undo()
        return frozenset().union(*(owed or () for owed in self._owed.values()))

    def _noticed(self, sample: Sample) -> None:
        with suppress(PeerError, ValueError):
            notice = decode(sample.payload, Notice)
            own = sample.key == self._keys.notices(notice.configurator) and notice.configurator in self._owed
            if own and notice.event.get("act") in _ENDS:
                owed = notice.event.get("owed", ())
                said = owed if isinstance(owed, list) else ()
                self._owed[notice.configurator] = frozenset(map(IRI, map(str, said)))
