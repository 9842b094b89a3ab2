"""A component as the page shows it: what it is, where, and whether it lives."""

from __future__ import annotations

from selfconf.discovery import FoundAdvertisement
from selfconf.model.profile import CALL_MARK, Input, Output, Profile
from selfconf.model.term import Literal
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.vocabulary import LABEL, ROB, SC
from selfconf.render import Names, short
from selfconf.serve.watching.change import Body

KNOWN_NAMES = Names(QUERY_PREFIXES)
"""Shortens IRIs by the prefixes that every query may use."""


def label_of(profile: Profile) -> str:
    """What its author calls a component; empty if nothing is said."""
    return next((one.lexical for one in profile.values(LABEL) if isinstance(one, Literal)), "")


def component_body(found: FoundAdvertisement, state: str) -> Body:
    """A component as JSON."""
    profile = found.advertisement.profile
    return {
        "name": short(profile.component),
        "label": label_of(profile),
        "types": sorted(KNOWN_NAMES(kind) for kind in profile.types - {SC.Component}),
        "site": found.site,
        "source": found.source,
        "places": [short(place) for place in profile.values(ROB.place)],
        "state": state,
        "inputs": [_port(port) for port in profile.signal_inputs],
        "outputs": [_port(port) for port in profile.signal_outputs],
        "operations": [_operation(port) for port in profile.operations],
        "needed_operations": [_operation(port) for port in profile.needed_operations],
        "parameters": [{"name": one.name, "type": KNOWN_NAMES(one.type)} for one in profile.parameters],
        "preference": float(profile.preference),
        "shareable": profile.is_shareable,
        "inside": short(profile.inside) if profile.inside else "",
    }


def _operation(port: Input | Output) -> Body:
    types = {name: KNOWN_NAMES(one) for name, one in (("request", port.request), ("response", port.response)) if one}
    body: Body = {"name": port.name.removesuffix(CALL_MARK), **types}
    return {**body, "optional": True} if isinstance(port, Input) and port.optional else body


def _port(port: Input | Output) -> Body:
    unit = port.unit if isinstance(port, Output) else None if port.condition is None else port.condition.unit
    body: Body = {"name": port.name, "signals": list(map(KNOWN_NAMES, port.signals))}
    if unit is not None:
        body["unit"] = KNOWN_NAMES(unit)
    if isinstance(port, Input):
        return {**body, "optional": True} if port.optional else body
    return body if port.rate is None else {**body, "rate": port.rate}
