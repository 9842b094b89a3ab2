"""An import of what lives: the nodes of a ROS 2 domain, as Turtle files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from selfconf.importing import ImportedDocument, ImportLedger, ImportReport, import_documents


def import_living_nodes(endpoint: str, domain: int, out: Path, namespace: str | None = None) -> ImportReport:
    """Import the nodes that live now in a domain, whose router listens at an endpoint, into a folder.

    The namespace is what the IRIs of components begin with, by default as a bridge names them. Raises NetworkError
    where the router cannot be reached, and AuthorError as `import_descriptions` does.
    """
    from selfconf.bridging.ros2 import living_graph
    from selfconf.bus.zenoh import client

    def read(ledger: ImportLedger) -> Iterator[ImportedDocument]:
        bus = client([endpoint], wanted="router of ROS 2")
        try:
            yield from living_graph(bus, domain, ledger)
        finally:
            bus.close()

    return import_documents("ros2", read, out, namespace)
