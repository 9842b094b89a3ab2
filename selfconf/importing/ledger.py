"""What an importer notes on its way through the sources."""

from __future__ import annotations

from selfconf.importing.imported import Omission
from selfconf.importing.naming import DistinctNames, slug
from selfconf.importing.sources import SourceDocument, Unreadable
from selfconf.model.term import IRI


class ImportLedger:
    """What an importer notes on its way: what it cannot read, what it leaves out, and which names are taken."""

    def __init__(self, namespace: str, unreadable: Unreadable) -> None:
        self.namespace, self.unreadable = namespace, unreadable
        self.names = DistinctNames()
        self._omitted: dict[tuple[str, str], dict[str, int]] = {}

    def leave_out(self, what: str, reason: str, source: SourceDocument, number: int = 1) -> None:
        """Note that something of a source will not be in the advertisements, unless there is none of it."""
        if not number:
            return
        counts = self._omitted.setdefault((what, reason), {})
        counts[source.shown] = counts.get(source.shown, 0) + number

    def omissions(self) -> tuple[Omission, ...]:
        """What was left out, with one entry for all sources in which it is left out for one reason."""
        return tuple(
            Omission(what, reason, tuple(counts), sum(counts.values()))
            for (what, reason), counts in sorted(self._omitted.items())
        )

    def minted(self, *path: str) -> IRI:
        """The IRI of something to which its source gives a name, but no IRI."""
        return IRI.unchecked(self.namespace + "/".join(map(slug, path)))
