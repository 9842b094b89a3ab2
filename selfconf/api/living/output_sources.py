"""Where the signals of an output are heard: on its own key; of a composite, on the keys of those that issue inside.

A composite passes on nothing: a configurator learns which outputs stand behind those of the composite that it starts.
A reader receives nothing, so it asks the composite for its `state`, again and again as long as it listens.

Outputs are latched: a reader asks each output that it begins to hear for its last signal, as an input does. An output
that no input follows issues it again by itself; the reader gets it once.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection

from selfconf.bus.port import Bus, Replies, Sample, Undo
from selfconf.errors import AuthorError, PeerError
from selfconf.model.profile import Profile
from selfconf.model.wording import listed
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer

OUTPUTS_ASKED_AGAIN = 1.0
"""Seconds between two questions to a composite which outputs stand behind its own."""
COMPOSITE_PATIENCE = 2.0
"""Seconds that a composite may take to answer."""
LAST_SIGNAL_PATIENCE = 2.0
"""Seconds that an output may take to say its last signal."""


def check_output(profile: Profile, output: str) -> None:
    """Raises AuthorError for what is no output of a component that issues signals."""
    outputs = {port.name: port.is_operation for port in profile.outputs}
    if outputs.get(output, False):
        raise AuthorError(
            f"{output} is an operation of {profile.component.short}: it answers calls, and issues nothing"
        )
    if output not in outputs:
        names = listed(repr(name) for name, is_operation in outputs.items() if not is_operation) or "none"
        raise AuthorError(f"{profile.component.short} has no output {output!r}; its outputs: {names}")


def follow_output(bus: Bus, keys: Keys, profile: Profile, output: str, heard: Callable[[Sample], None]) -> Undo:
    """Hear an output of a component, first its last signal if there is one, until undone; on the thread of the bus."""
    if profile.inside is None:
        return _Latched(bus, keys.output(profile.component, output), heard).end
    return _IssuedInside(bus, keys, profile, output, heard).end


class _Latched:
    """Hears what is issued on a key, and what was issued there last, each signal once."""

    def __init__(self, bus: Bus, key: str, heard: Callable[[Sample], None]) -> None:
        self._heard = heard
        self._last: bytes | None = None
        """The stamp of what was heard last; None if nothing was."""
        self._undo: Undo | None = bus.subscribe(key, self._issued)
        bus.ask(key, b"", LAST_SIGNAL_PATIENCE, self._answered)

    def end(self) -> None:
        """Hear no more."""
        undo, self._undo = self._undo, None
        if undo is not None:
            undo()

    def _issued(self, sample: Sample) -> None:
        again = sample.attachment and sample.attachment == self._last
        if self._undo is not None and not again:
            self._last = sample.attachment
            self._heard(sample)

    def _answered(self, replies: Replies) -> None:
        for sample in replies.samples:
            if self._last is None:  # else what was issued meanwhile is newer
                self._issued(sample)


class _IssuedInside:
    """Hears an output of a composite, whichever component issues it inside; none while the composite rests."""

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
                self._followed[key] = _Latched(self._bus, key, self._heard).end
