"""Who may do what in an ecology, as values, in words, and as the access control of Zenoh.

Everything that is not granted is denied. A grant holds for the links whose certificate has a common name, at each hub
and uplink of a site, whose own certificate may do everything: it is the site that decides. What comes from another host
comes by a link of *its* site, so that site is granted the keys of the components that it advertises, and no others.

Zenoh matches keys by inclusion: a grant must be as wide as what is asked, and `**` does not include a chunk that begins
with `@`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from selfconf.access.principal import Principal, PrincipalKind
from selfconf.bus.zenoh import includes
from selfconf.model.immutable import immutable, replace
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, any_ecology, component_chunk
from selfconf.protocol.messages import Access, RefusedAttempt

SPEAK = ("put", "delete", "declare_queryable", "reply", "liveliness_token")
"""The messages by which a client says something under a key: a sample, an answer, a life."""
LISTEN = ("declare_subscriber", "query", "liveliness_query", "declare_liveliness_subscriber")
"""The messages by which a client asks to hear what is said under a key."""
BY, TO = "ingress", "egress"
"""What comes by the link of a client, and what goes to that link."""


@immutable
class AccessRules:
    """Who may do what at the hubs of one site."""

    accesses: tuple[Access, ...]
    """What each may do; the first is what every holder of a certificate may."""
    at_uplinks: Access | None = None
    """What every holder may do at uplinks: there the other end is a hub that this site was set up to connect to, and it
    has to answer a client that shows a certificate before it is known. At a hub only known sites answer that."""

    def knows(self, principals: Sequence[Principal]) -> bool:
        """Whether they speak of the holder of a certificate, and of the components that share its process."""
        first, *others = principals
        about = {access.principal: access.about for access in self.accesses}.get(first.common_name)
        return about is not None and all(one.name in about for one in others)

    def allow(self, refused: RefusedAttempt) -> bool:
        """Whether they allow what a client has tried: then earlier ones have refused it."""
        message = refused.attempt.lower().replace(" ", "_")
        return any(
            includes(key, refused.key)
            for access in self.accesses
            if access.principal in ("", refused.principal)
            for key in (access.says if message in SPEAK else access.hears if message in LISTEN else ())
        )

    def access_control(self, at_uplinks: bool = False) -> dict[str, Any]:
        """The rules as the member `access_control` of a configuration of Zenoh: of a hub, or of its uplinks."""
        rules, subjects, policies = [], [], []
        accesses = self.accesses
        if at_uplinks and self.at_uplinks is not None:
            accesses = (self.at_uplinks, *accesses[1:])
        for number, access in enumerate(accesses):
            identity = access.principal or "everybody"
            mine = _rules(str(number), access)
            who = {"cert_common_names": [access.principal]} if access.principal else {"link_protocols": ["tls"]}
            rules += mine
            subjects.append({"id": identity, **who})
            policies.append({"id": identity, "rules": [rule["id"] for rule in mine], "subjects": [identity]})
        return {
            "enabled": True,
            "default_permission": "deny",
            "rules": rules,
            "subjects": subjects,
            "policies": policies,
        }


def rules_of(
    ecology: str,
    site: str,
    processes: Iterable[Sequence[Principal]],
    others: Mapping[str, Collection[IRI]],
    shown: Iterable[Sequence[Principal]],
    beside: Collection[str] = (),
) -> AccessRules:
    """The rules of a site, in an order that does not depend on chance.

    `processes` are those of components of this host, each with the principals of its certificate, its subject first;
    `shown` what other certificates have been shown. `others` are the components that each other site vouches for.
    `beside` are the other sites of this host, which are connected to no hub but this one: it passes on everything.
    """
    keys = Keys(ecology)
    speaks: dict[Principal, dict[Principal, None]] = {}
    for process in (*processes, *shown):
        speaks.setdefault(process[0], {}).update(dict.fromkeys(process))
    here = sorted({one.name for process in speaks.values() for one in process if one.kind is PrincipalKind.COMPONENT})
    said_here = [*keys.all_of_site(site), *keys.all_of_configurators("*"), keys.task()]
    said_here += [key for chunk in here for key in keys.all_of_component(chunk)]
    found = [_everybody(keys), _site_itself(keys, site)]
    for principal in sorted(speaks, key=str):
        if principal.kind is PrincipalKind.COMPONENT:
            found.append(_component(keys, principal, speaks[principal]))
        elif principal.kind is PrincipalKind.CONFIGURATOR:
            found.append(_configurator(keys, principal))
        elif principal.kind is PrincipalKind.READER:
            found.append(_reader(keys, principal))
        elif principal.name != site:
            told = () if principal.name in beside else said_here
            found.append(_other_site(keys, principal, others.get(principal.name, ()), told))
    return AccessRules(tuple(found), replace(_everybody(keys), says=(keys.introduce("*"),)))


def _everybody(keys: Keys) -> Access:
    return Access(
        "",
        "everybody with a certificate of the authority may show it to a site, and learn which sites live",
        hears=(keys.introduce("*"), any_ecology()),
    )


def _site_itself(keys: Keys, site: str) -> Access:
    everything = keys.everything()
    return Access(
        Principal(PrincipalKind.SITE, site).common_name,
        "this site: everything, at its own hubs",
        says=everything,
        hears=(*everything, any_ecology()),
    )


def _component(keys: Keys, principal: Principal, process: Iterable[Principal]) -> Access:
    mine = tuple(sorted(one.name for one in process if one.kind is PrincipalKind.COMPONENT))
    own = tuple(key for chunk in mine for key in keys.all_of_component(chunk))
    heard = (
        keys.any_output(),
        *map(keys.any_operation, mine),
        keys.any_fail(),
        keys.any_free(),
        keys.any_life(),
        keys.any_configurator_life(),
    )
    return Access(
        principal.common_name,
        "speaks on its own outputs, FAIL and calls; hears signals, FAIL and lives; asks for operations as itself",
        says=own,
        asked=(keys.any_output(), keys.any_fail(), keys.any_free(), keys.any_call("state")),
        hears=(*own, *heard),
        about=mine,
    )


def _looking(keys: Keys) -> tuple[str, ...]:
    """What may be asked and heard by a reader."""
    return (
        keys.advertisements(),
        keys.changed(),
        keys.reopens(),
        keys.access(),
        keys.any_site_life(),
        keys.any_life(),
        keys.any_configurator_life(),
        keys.configuration(),
        keys.notices(),
        keys.configurator_call("*", "status"),
        keys.configurator_call("*", "task"),
        keys.kept_tasks(),
        keys.task(),
    )


def _reader(keys: Keys, principal: Principal) -> Access:
    return Access(
        principal.common_name,
        "may discover, query and watch; hears no signals, calls no component",
        hears=_looking(keys),
    )


def _configurator(keys: Keys, principal: Principal) -> Access:
    mine = keys.all_of_configurators(principal.name)
    of_sites = (keys.wake("*"), keys.end("*"), keys.keep("*"), keys.log("*"))
    called = (keys.any_call(), *of_sites, keys.configurator_call("*"))
    heard = (keys.any_output(), keys.any_fail(), keys.any_free(), keys.any_moved())
    return Access(
        principal.common_name,
        f"may run and stop tasks, as configurators {principal.name}-*: calls components and sites; hears all signals",
        says=mine,
        asked=keys.all_of_configurators("*"),
        hears=(*_looking(keys), *called, *heard),
    )


def _other_site(keys: Keys, principal: Principal, components: Collection[IRI], told: Collection[str]) -> Access:
    """What another site may say and hear; of what it hears, only `told` is passed on to it, if any is.

    To a site of another host a hub passes on what is said on its own host: what third sites say, too, would be refused
    there as coming from this one.
    """
    vouched = tuple(sorted(map(component_chunk, components)))
    said = [*keys.all_of_site(principal.name), *keys.all_of_configurators("*"), keys.task()]
    said += [key for chunk in vouched for key in keys.all_of_component(chunk)]
    asks = (*keys.all_but_operations(), *map(keys.any_operation, vouched), any_ecology())
    return Access(
        principal.common_name,
        f"another site: speaks for itself, the components that it advertises ({len(vouched)}), and the configurators"
        " that are connected to it; hears everything, and asks for operations as these components",
        says=tuple(said),
        asked=(*keys.everything(), any_ecology()),
        hears=asks,
        about=vouched,
        told=tuple(told),
    )


def _rules(identity: str, access: Access) -> list[dict[str, Any]]:
    """The rules of Zenoh: one that may say something hears who listens, and one that may listen what is said."""
    granted = (
        (BY, SPEAK, access.says),
        (TO, LISTEN, (*access.says, *access.asked)),
        (BY, LISTEN, access.hears),
        (TO, SPEAK, access.told or access.hears),
    )
    return [
        {
            "id": f"{identity}-{number}",
            "permission": "allow",
            "flows": [flow],
            "messages": list(messages),
            "key_exprs": list(keys),
        }
        for number, (flow, messages, keys) in enumerate(granted)
        if keys
    ]
