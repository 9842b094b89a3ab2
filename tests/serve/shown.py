"""The components of the lab as a server shows them."""

from __future__ import annotations

from selfconf.discovery import FoundAdvertisement
from selfconf.rdf import advertisements, turtle
from selfconf.serve.change import EcologyChange
from selfconf.serve.component_bodies import component_body
from tests.lab import ADVERTISEMENTS, PREFIXES


def found(name: str) -> FoundAdvertisement:
    """One of the advertisements of the lab, as a discovery finds it."""
    good, _ = advertisements.read_advertisements((PREFIXES + ADVERTISEMENTS[name]).encode(), name)
    return FoundAdvertisement(good[0], "astrid", f"{name}.ttl", startable=name == "control")


def advertised(*names: str) -> EcologyChange:
    """The change by which some components are there."""
    all_found = [found(name) for name in names]
    components = {one.advertisement.component: one for one in all_found}
    return EcologyChange(
        components,
        {str(c): component_body(one, "alive") for c, one in components.items()},
        {"astrid": {"missing": False}},
        graphs={str(c): turtle.ntriples(one.advertisement.triples) for c, one in components.items()},
    )
