"""A program shows its certificate to the sites, so that the hub which it is connected to lets it in."""

from __future__ import annotations

from functools import partial

from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Bus, Replies
from selfconf.errors import NetworkError, PeerError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction

ANSWER = 2.0
"""Seconds that the sites may take to answer."""
OPENED_ANEW = 1.0
"""Seconds within which a hub that has learnt a name is opened anew."""
UNHEARD = 0.2
"""Seconds after which it is shown again where nobody has answered."""
ROUNDS = 5
"""How often a certificate is shown at most: a hub may be opened anew for others as well."""


def introduce(bus: Bus, ecology: str, credentials: Credentials) -> None:
    """Show a certificate until every site that answers knows it. To be called before the bus runs on its own thread.

    A site may not answer while its hub is opened anew. Raises NetworkError if no site lets it in; nothing where none
    answers in the end, as that is found out anyway.
    """
    key, mine = Keys(ecology).introduce("*"), encode(Introduction(credentials.certificate.read_text()))
    for _ in range(ROUNDS):
        link = bus.link
        replies = _asked(bus, key, mine)
        known = [_known(sample.payload) for sample in replies.samples]
        if not known and replies.errors:
            raise NetworkError(f"{credentials.name} is not let in: {replies.errors[0]}")
        if known and all(known):
            return
        deadline = bus.now() + (OPENED_ANEW if known else UNHEARD)
        bus.run(partial(_opened_anew, bus, link, deadline))


def _opened_anew(bus: Bus, link: str, deadline: float) -> bool:
    return bus.link not in ("", link) or bus.now() > deadline


def _known(payload: bytes) -> bool:
    try:
        return decode(payload, Introduction).known
    except PeerError:
        return True  # a site that answers in another way will not get to know anybody


def _asked(bus: Bus, key: str, payload: bytes) -> Replies:
    heard: list[Replies] = []
    bus.ask(key, payload, ANSWER, heard.append)
    bus.run(lambda: bool(heard))
    return heard[0]
