"""A program shows its certificate to the sites, so that the hub which it is connected to lets it in."""

from __future__ import annotations

from functools import partial

from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Bus, Replies
from selfconf.errors import NetworkError, PeerError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, site_of
from selfconf.protocol.messages import Introduction

ANSWER = 2.0
"""Seconds that the sites may take to answer."""
OPENED_ANEW = 1.0
"""Seconds within which a hub that has learnt a name is opened anew."""
UNHEARD = 0.2
"""Seconds after which it is shown again where a site has not answered."""
ROUNDS = 5
"""How often a certificate is shown at most: a hub may be opened anew for others as well."""


def introduce(bus: Bus, ecology: str, credentials: Credentials) -> None:
    """Show a certificate until all sites know it that can be expected to answer.

    A site may not answer while its hub is opened anew, and what it advertises would be missed then: so the other sites
    of its host say that it should. To be called before the bus runs on its own thread. Raises NetworkError if no site
    lets the program in; nothing where none answers in the end, as that is found out anyway.
    """
    key, mine = Keys(ecology).introduce("*"), encode(Introduction(credentials.certificate.read_text()))
    for _ in range(ROUNDS):
        link = bus.link
        replies = _asked(bus, key, mine)
        answers = {site_of(sample.key): _answer(sample.payload) for sample in replies.samples}
        if not answers and replies.errors:
            raise NetworkError(f"{credentials.name} is not let in: {replies.errors[0]}")
        known = all(answer.known for answer in answers.values())
        if answers and known and all(answers.keys() >= set(answer.beside) for answer in answers.values()):
            return
        deadline = bus.now() + (UNHEARD if known else OPENED_ANEW)
        bus.run(partial(_opened_anew, bus, link, deadline))


def _opened_anew(bus: Bus, link: str, deadline: float) -> bool:
    return bus.link not in ("", link) or bus.now() > deadline


def _answer(payload: bytes) -> Introduction:
    try:
        return decode(payload, Introduction)
    except PeerError:
        return Introduction("", known=True)  # a site that answers in another way will not get to know any client


def _asked(bus: Bus, key: str, payload: bytes) -> Replies:
    heard: list[Replies] = []
    bus.ask(key, payload, ANSWER, heard.append)
    bus.run(lambda: bool(heard))
    return heard[0]
