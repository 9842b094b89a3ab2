"""A network with an observer, and sites that are honest or not, for tests of discovery."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from selfconf.bus.memory import Faults, Network
from selfconf.bus.port import Request
from selfconf.discovery import Discovery, EcologyView
from selfconf.discovery.inquiry import DISCOVERY
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Page
from selfconf.site import Shelf, Site
from tests.lab import PREFIXES, iri, write_advertisements

KEYS = Keys("lab")
TRACKER = iri("person-tracker")


class Field:
    """A network with an observer, and as many sites as a test likes."""

    def __init__(self, folder: Path, faults: Faults | None = None) -> None:
        self.network, self.folder = Network(0, faults), folder
        self.ecology = EcologyView(self.network.node(), "lab")

    def site(self, name: str, *names: str) -> Site:
        """An honest site."""
        complaints: list[str] = []
        return Site(
            self.network.node(),
            "lab",
            name,
            Shelf([write_advertisements(self.folder / name, *names)], complaints.append),
        )

    def stranger(self, name: str, answer: Callable[[Request], None]) -> None:
        """A site that answers as it likes."""
        node = self.network.node()
        node.announce(KEYS.site_life(name, "1"))

        def serve(request: Request) -> None:
            answer(request)
            request.finish()

        node.serve(KEYS.advertisements(name), serve)

    def lie(self, name: str, component: IRI, turtle: str | bytes) -> None:
        """A site that serves one advertisement, said to be of a component."""
        payload = turtle if isinstance(turtle, bytes) else (PREFIXES + turtle).encode()
        page = encode(Page(0, 1, 1, component, "somewhere.ttl"))
        self.stranger(name, lambda request: request.reply(KEYS.advertisement(name, component), payload, page))

    def discover(self) -> Discovery:
        """Ask all sites."""
        found: list[Discovery] = []
        self.ecology.discover(found.append)
        assert self.network.run(lambda: bool(found), 10 * DISCOVERY)
        return found[0]
