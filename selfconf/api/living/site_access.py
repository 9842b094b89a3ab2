"""Who may do what at the hubs of an ecology with keys, as its sites tell it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from selfconf.bus.port import Replies
from selfconf.errors import PeerError
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import component_chunk, site_of
from selfconf.protocol.messages import Access, RefusedAttempt


@immutable
class SiteAccess:
    """Who may do what at the hub of a site with keys, and what was refused there, the latest first."""

    site: str
    accesses: tuple[Access, ...]
    refused: tuple[RefusedAttempt, ...]
    components: Mapping[str, IRI]
    """The components of the ecology, by their chunks in keys and common names."""

    def access_control(self) -> dict[str, Any]:
        """The rules as Zenoh has them, at the member `access_control` of a configuration."""
        from selfconf.access import AccessRules  # what it needs is an extra

        return AccessRules(self.accesses).access_control()


def site_accesses(replies: Replies, components: Iterable[IRI]) -> tuple[tuple[SiteAccess, ...], tuple[str, ...]]:
    """Return what the sites have answered, sorted by site, and what was left out of it and why."""
    found: dict[str, list[Access]] = {}
    refused: dict[str, list[RefusedAttempt]] = {}
    rejected = []
    for sample in replies.samples:
        try:
            site = site_of(sample.key)
            if b'"kind": "refused"' in sample.payload or b'"kind":"refused"' in sample.payload:
                refused.setdefault(site, []).append(decode(sample.payload, RefusedAttempt))
            else:
                found.setdefault(site, []).append(decode(sample.payload, Access))
        except PeerError as error:
            rejected.append(f"left out an answer: {error}")
    chunks = {component_chunk(component): component for component in components}
    accesses = (SiteAccess(site, tuple(found[site]), tuple(refused.get(site, ())), chunks) for site in sorted(found))
    return tuple(accesses), tuple(rejected)
