"""What was deployed before, kept on disk as PROV-O, so that questions reach back over the end of a configurator.

Each configuration is a named graph under its own name, as its configurator has told it: which task, what generated it
and when, which configuration it revises, which failures have influenced it, and what was passed over. When another
one takes its place, or its configurator has gone, it gets the time of its end (prov:invalidatedAtTime). One that was
running when the server ended gets none, for when it ended was not seen.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path

import pyoxigraph as ox

from selfconf.errors import AuthorError
from selfconf.rdf.provenance import moment
from selfconf.rdf.turtle import ox_term
from selfconf.rdf.vocabulary import PROV, SC, TYPE

DEPLOYED = "urn:selfconf:selfconf/"
"""What the names of the graphs begin with in which configurators tell what they have deployed."""
MOST_KEPT = 5000
"""How many configurations are kept; then the oldest one goes."""
KEPT_FOR = 366 * 86_400.0
"""Seconds for which a configuration is kept that was generated then, and is not deployed any more."""
_GENERATED, _ENDED = ox.NamedNode(PROV.generatedAtTime), ox.NamedNode(PROV.invalidatedAtTime)


class History:
    """The configurations of one ecology, in a store in a folder that no other server uses."""

    def __init__(self, folder: Path, clock: Callable[[], float] = time.time) -> None:
        """Raises AuthorError for a folder that cannot be used."""
        self._clock = clock
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._store = ox.Store(str(folder))
        except (OSError, RuntimeError) as error:  # the latter is how Oxigraph says that a store is broken
            raise AuthorError(f"cannot keep a history in {folder} ({error}); does another server use it?") from None
        self._current: dict[str, str] = {}
        """The configuration that is deployed, by the graph that states it."""
        self._unsettled = {name for name in self._names() if not self._has_ended(name)}
        """Those that ran when the last server ended: they may run still."""

    def close(self) -> None:
        """Write everything down, and leave the folder to others."""
        self._store.flush()
        del self._store

    def past(self) -> dict[str, bytes]:
        """Every configuration that has ended, as N-Triples by its name."""
        return {name: self._triples(name) for name in self._names() if name not in self._unsettled}

    def settle(self) -> dict[str, bytes]:
        """Return those that ran when the last server ended, and are not deployed any more; called once."""
        over = self._unsettled - set(self._current.values())
        self._unsettled.clear()
        return {name: self._triples(name) for name in over}

    def note(self, graphs: Mapping[str, bytes]) -> dict[str, bytes]:
        """Note what configurators tell of what they have deployed; return what has ended by that."""
        over: dict[str, bytes] = {}
        for graph, triples in graphs.items():
            if graph.startswith(DEPLOYED):
                over |= self._note(graph, triples)
        return over

    def _note(self, graph: str, triples: bytes) -> dict[str, bytes]:
        quads = list(ox.parse(triples, format=ox.RdfFormat.N_TRIPLES))
        kind, wanted = ox.NamedNode(TYPE), ox.NamedNode(SC.Configuration)
        name = next((q.subject.value for q in quads if (q.predicate, q.object) == (kind, wanted)), None)
        if name is not None and self._has_ended(name):
            return {}  # told late: another has taken its place already
        before = self._current.pop(graph, None)
        over: dict[str, bytes] = {}
        if before is not None and before != name:
            node = ox.NamedNode(before)
            self._store.add(ox.Quad(node, _ENDED, ox_term(moment(self._clock())), node))
            over[before] = self._triples(before)
        if name is not None:
            self._current[graph] = name
            if not any(self._store.quads_for_pattern(None, None, None, ox.NamedNode(name))):
                self._store.extend(ox.Quad(q.subject, q.predicate, q.object, ox.NamedNode(name)) for q in quads)
                over |= self._forget_oldest()
        return over

    def _forget_oldest(self) -> dict[str, bytes]:
        """Forget what is too old or one too many, and return it as graphs that are empty now."""
        names = sorted(self._names(), key=self._generated)
        limit = str(ox_term(moment(self._clock() - KEPT_FOR)))
        old = sum(self._generated(name) < limit for name in names)
        over = [name for name in names[: max(old, len(names) - MOST_KEPT)] if name not in self._current.values()]
        for name in over:
            self._store.remove_graph(ox.NamedNode(name))
        return dict.fromkeys(over, b"")

    def _names(self) -> list[str]:
        return [graph.value for graph in self._store.named_graphs() if isinstance(graph, ox.NamedNode)]

    def _generated(self, name: str) -> str:
        node = ox.NamedNode(name)
        return next((str(q.object) for q in self._store.quads_for_pattern(node, _GENERATED, None, node)), "")

    def _has_ended(self, name: str) -> bool:
        node = ox.NamedNode(name)
        return any(self._store.quads_for_pattern(node, _ENDED, None, node))

    def _triples(self, name: str) -> bytes:
        return self._store.dump(format=ox.RdfFormat.N_TRIPLES, from_graph=ox.NamedNode(name)) or b""
