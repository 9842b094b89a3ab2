"""Where the signals of an output are heard: on its own key; of a composite, on the keys of those that issue inside.

A composite passes on nothing: a configurator is told which outputs stand behind those of the composite that it starts.
Who only looks on is told nothing, so it asks the composite for its `state`, again and again as long as it listens.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection

from selfconf.bus.port import Bus, Replies, Sample, Undo
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer

OUTPUTS_ASKED_AGAIN = 1.0
"""Seconds between two questions to a composite which outputs stand behind its own."""
COMPOSITE_PATIENCE = 2.0
"""Seconds that a composite may take to answer."""


def follow_output(bus: Bus, keys: Keys, profile: Profile, output: str, heard: Callable[[Sample], None]) -> Undo:
    """Hear the signals of an output of a component, until that is undone; runs on the thread of the bus."""
    if profile.inside is None:
        return bus.subscribe(keys.output(profile.component, output), heard)
    return _IssuedInside(bus, keys, profile, output, heard).end


class _IssuedInside:
    """Hears an output of a composite, by whomever it is issued inside; by nobody while the composite does not act."""

    def __init__(self, bus: Bus, keys: Keys, profile: Profile, output: str, heard: Callable[[Sample], None]) -> None:
        self._bus, self._keys, self._composite, self._output = bus, keys, profile.component, output
        self._heard = heard
        self._followed: dict[str, Undo] = {}
        """What takes back each subscription, by its key."""
        self._ended = False
        self._ask()

    def end(self) -> None:
        """Hear no more."""
        self._ended = True
        self._follow(())

    def _ask(self) -> None:
        if not self._ended:
            self._bus.ask(self._keys.call(self._composite, "state"), b"", COMPOSITE_PATIENCE, self._told)

    def _told(self, replies: Replies) -> None:
        if self._ended:
            return
        for sample in replies.samples:  # without an answer it goes on as before: whatever is silent is heard no more
            with contextlib.suppress(PeerError):
                wires = decode(sample.payload, CallAnswer).outputs.get(self._output, ())
                self._follow({self._keys.output(wire.component, wire.output) for wire in wires})
        self._bus.later(OUTPUTS_ASKED_AGAIN, self._ask)

    def _follow(self, wanted: Collection[str]) -> None:
        for key in [key for key in self._followed if key not in wanted]:
            self._followed.pop(key)()
        for key in wanted:
            if key not in self._followed:
                self._followed[key] = self._bus.subscribe(key, self._heard)
