"""What sites say to each other of keys: who is let in, who may do what, and what was tried in vain."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.protocol.messages.texts import Label, Remark


@immutable
class Introduction:
    """A certificate that is shown to a site, which lets its holder in if the authority issued it, and shows its own."""

    certificate: str
    """The certificate, as PEM. It is no secret: it is of no use without its key."""
    known: bool = False
    """In an answer: whether the site knew the one that asks, so that its rules stay as they are."""
    beside: tuple[Label, ...] = ()
    """In an answer: the sites of its host. One that does not answer has lost its hub for a moment, or hangs."""


@immutable
class Access:
    """What a holder may do at the hubs of a site, as keys, and as a sentence that says it."""

    principal: Remark
    """A common name; empty for every holder of a certificate of the authority."""
    sentence: Remark
    says: tuple[Label, ...] = ()
    """Under which keys it may say something."""
    asked: tuple[Label, ...] = ()
    """As which keys, besides, others may ask for that or listen to it: they know it by wider ones."""
    hears: tuple[Label, ...] = ()
    """Under which keys it may ask and listen."""
    about: tuple[Label, ...] = ()
    """The components that it speaks for, by their chunks."""
    told: tuple[Label, ...] = ()
    """What reaches it of what it hears; empty: all of it. Another site hears from each host what is said there."""


@immutable
class RefusedAttempt:
    """What a client has tried, and may not."""

    principal: Remark
    """A common name; empty for a client that has shown no trusted certificate."""
    attempt: Remark
    """What was tried, such as `Query`, or why the certificate is not believed."""
    key: Remark
    """Under which key; empty where there was no link."""
    number: int
    """How often."""
    latest: float
    """When it was last tried, in seconds of the Unix epoch."""
