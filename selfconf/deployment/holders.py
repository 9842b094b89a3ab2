"""Which components the other tasks of an ecology hold, as their configurators say."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from selfconf.bus.port import Bus, Replies
from selfconf.errors import PeerError
from selfconf.model.holder import Holder
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Status

STATUS = 1.0
"""Seconds that the configurators may take to say what they hold; a component itself knows better, when it is asked."""


def ask_holders(bus: Bus, keys: Keys, own: str, done: Callable[[Mapping[IRI, Holder]], None]) -> None:
    """Ask all configurators but the `own` one what they hold; `done` receives the holder of each component.

    Of several holders of one component the one of the highest priority counts, then the one that began first.
    """

    def answered(replies: Replies) -> None:
        done(holders_in(replies, keys, own))

    bus.ask(keys.configurator_call("*", "status"), b"", STATUS, answered)


def holders_in(replies: Replies, keys: Keys, own: str = "") -> Mapping[IRI, Holder]:
    """The holder of each component by the answers of configurators; an answer that is none is passed over."""
    found: dict[IRI, Holder] = {}
    for sample in replies.samples:
        try:
            status = decode(sample.payload, Status)
        except PeerError:
            continue
        if status.configurator == own or sample.key != keys.configurator_call(status.configurator, "status"):
            continue
        alone = Holder(status.task, status.priority, status.beginning, status.configurator)
        for component in status.components:
            holder = replace(alone, wants=status.wants[component]) if component in status.wants else alone
            known = found.get(component)
            if known is None or (-known.priority, known.beginning) > (-holder.priority, holder.beginning):
                found[component] = holder
    return found
