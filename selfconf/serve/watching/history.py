"""What was deployed before, kept on disk as PROV-O, so that questions reach back over the end of a configurator.

Each configuration is a named graph under its own name, as its configurator has told it: which task, what generated it
and when, which configuration it revises, which failures have influenced it, and what was passed over. When another
one takes its place, or its configurator has gone, it gets the time of its end (prov:invalidatedAtTime). One that was
running when the server ended gets none, for when it ended was not seen. Where none takes its place, no other graph says
which failures have ended it; so its own does (prov:qualifiedInvalidation).

A store that could not write once, as on a full disk, refuses to from then on, so it is opened anew. What could not be
noted is noted then, as far as it is deployed still. So it is where the folder was removed, or has another name by now:
a store that is open would write on into files that nothing finds.
"""

from __future__ import annotations

import logging
import time
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

import pyoxigraph as ox

from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI
from selfconf.protocol.keys import configurator_of
from selfconf.rdf.provenance import CONFIGURATION, failure_triples, moment
from selfconf.rdf.turtle import ox_term
from selfconf.rdf.vocabulary import PROV, SC, TYPE
from selfconf.serve.watching.change import Body

log = logging.getLogger(__name__)

MOST_KEPT = 5000
"""How many configurations are kept; then the oldest one goes."""
KEPT_FOR = 366 * 86_400.0
"""Seconds for which a configuration is kept that was generated then, and is not deployed any more."""
CANNOT_WRITE = (OSError, RuntimeError)
"""What a store raises that cannot be opened or written; the latter where it is broken."""
_IN_EACH_STORE = "CURRENT"
"""The file that says which state of a store of RocksDB is the latest."""
_LOCK = "LOCK"
"""The file that keeps a second program out of a store of RocksDB."""
_GENERATED, _ENDED = ox.NamedNode(PROV.generatedAtTime), ox.NamedNode(PROV.invalidatedAtTime)
_PARTS = (ox.NamedNode(SC.component), ox.NamedNode(SC.recruited))


class History:
    """The configurations of one ecology, in a store in a folder that no other server uses."""

    def __init__(self, folder: Path, clock: Callable[[], float] = time.time) -> None:
        """Raises AuthorError for a folder that cannot be used."""
        self._clock, self._folder = clock, folder
        self._opened: ox.Store | None = None
        self._in_order: list[tuple[str, str]] = []
        """When each configuration was generated, and its name; the oldest first. To ask the store takes long."""
        try:
            self._open()
        except CANNOT_WRITE as error:
            advice = "; does another server use it?" if _LOCK in str(error) else ""
            reason = getattr(error, "strerror", None) or error
            raise AuthorError(f"cannot keep a history in {folder} ({reason}){advice}") from None
        self._current: dict[str, str] = {}
        """The configuration that is deployed, by the graph that states it."""
        self._unsettled = {name for name in self._names() if not self._has_ended(name)}
        """The configurations that ran when the last server ended: they may run still."""
        self._losses: dict[str, dict[str, Body]] = {}
        """By the graph that states a configuration, the latest loss of each component that has a part in it."""
        self._to_note: dict[str, bytes] = {}
        """What each graph says that could not be noted yet."""

    @property
    def _store(self) -> ox.Store:
        return self._open() if self._opened is None else self._opened

    def _open(self) -> ox.Store:
        self._folder.mkdir(parents=True, exist_ok=True)
        self._opened = ox.Store(str(self._folder))
        self._in_order = sorted((self._generated(name), name) for name in self._names())
        return self._opened

    def close(self) -> None:
        """Write everything down, and leave the folder to others."""
        try:
            if self._opened is not None:
                self._opened.flush()
        except CANNOT_WRITE as error:
            log.error("the latest changes may be missing in the history: %s", error)
        finally:
            self._opened = None

    def past(self) -> dict[str, bytes]:
        """Every configuration that has ended, as N-Triples by its name."""
        return {name: self._triples(name) for name in self._names() if name not in self._unsettled}

    def settle(self) -> dict[str, bytes]:
        """Return those that ran when the last server ended, and are not deployed any more; called once."""
        over = self._unsettled - set(self._current.values())
        self._unsettled.clear()
        return {name: self._triples(name) for name in over}

    def note(self, deployed: Mapping[str, bytes], events: Iterable[Body] = ()) -> dict[str, bytes]:
        """Note what has happened to tasks, then what configurators tell of what they have deployed.

        Returns what has ended by that. Raises one of CANNOT_WRITE where it cannot be written; then it is noted later.
        """
        self._to_note.update(deployed)
        try:
            self._look_whether_removed()
            return self._note_all(events)
        except CANNOT_WRITE:
            self._opened = None
            raise

    def _look_whether_removed(self) -> None:
        """Begin anew where the store that is open is in its folder no more, with what is deployed now."""
        if self._opened is None or (self._folder / _IN_EACH_STORE).exists():
            return
        log.warning("the history in %s is not there any more; a new one begins there", self._folder)
        deployed = {graph: self._triples(name) for graph, name in self._current.items()}
        self._opened = None
        self._current.clear()
        for graph, triples in deployed.items():
            self._note(graph, triples)

    def _note_all(self, events: Iterable[Body]) -> dict[str, bytes]:
        for event in events:
            if event["act"] == "lost":
                self._note_loss(event)
        over: dict[str, bytes] = {}
        for graph, triples in list(self._to_note.items()):
            over |= self._note(graph, triples)
            del self._to_note[graph]
        return over

    def _note(self, graph: str, triples: bytes) -> dict[str, bytes]:
        quads = list(ox.parse(triples, format=ox.RdfFormat.N_TRIPLES))
        name, before = _configuration(quads), self._current.get(graph)
        if name == before:
            return {}
        over: dict[str, bytes] = {}
        if name is not None and self._is_kept(name):
            if self._has_ended(name):
                if before is not None:
                    return {}  # told late: another has taken its place already
                self._forget(self._generated(name), name)
            over = {name: b""}  # it counts as past no more: the way to its configurator was gone, or another goes on
        added = self._added(name, quads)
        ended = before if before is not None and list(self._current.values()).count(before) == 1 else None
        if ended is not None:
            added += self._end(graph, ended, replaced=name is not None)
        self._store.extend(added)  # all of it or nothing: where this fails, nothing has changed
        self._current.pop(graph, None)
        self._losses.pop(graph, None)
        if ended is not None:
            over[ended] = self._triples(ended)
        return over | (self._deployed(graph, name) if name is not None else {})

    def _added(self, name: str | None, quads: Iterable[ox.Quad]) -> list[ox.Quad]:
        """What is to be kept of a configuration of which nothing is; nothing of one that is, or is none."""
        if name is None or self._is_kept(name):
            return []
        return [ox.Quad(q.subject, q.predicate, q.object, ox.NamedNode(name)) for q in quads]

    def _deployed(self, graph: str, name: str) -> dict[str, bytes]:
        """Note which configuration a graph states; return what is forgotten, as it is one too many."""
        self._current[graph] = name
        entry = self._generated(name), name
        place = bisect_left(self._in_order, entry)
        if self._in_order[place : place + 1] == [entry]:
            return {}
        self._in_order.insert(place, entry)
        return self._forget_oldest()

    def _end(self, graph: str, name: str, replaced: bool) -> Iterator[ox.Quad]:
        """The end of a configuration, now; with what has failed in it, where no other one has replaced it."""
        node = ox.NamedNode(name)
        yield ox.Quad(node, _ENDED, ox_term(moment(self._clock())), node)
        if not replaced:
            yield from self._failures(node, self._losses.get(graph, {}))

    def _note_loss(self, event: Body) -> None:
        for graph, name in self._current.items():
            if _configurator(graph) == event.get("configurator") and self._has_part(event.get("component"), name):
                self._losses.setdefault(graph, {})[event["component"]] = event

    def _has_part(self, component: str | None, name: str) -> bool:
        """Whether a configuration has a component for a player or a recruit."""
        quads = self._store.quads_for_pattern(None, None, None, ox.NamedNode(name))
        return any(q.predicate in _PARTS and getattr(q.object, "value", None) == component for q in quads)

    def _failures(self, name: ox.NamedNode, losses: Mapping[str, Body]) -> Iterator[ox.Quad]:
        """What has ended a configuration: the failures of its components."""
        for component, loss in losses.items():
            when = min(max(loss["time"], 0.0), self._clock())  # a stranger may say anything
            said = failure_triples(IRI.unchecked(component), loss.get("cause", ""), loss.get("detail", ""), when)
            node = ox.BlankNode()
            yield ox.Quad(name, ox.NamedNode(PROV.qualifiedInvalidation), node, name)
            yield from (ox.Quad(node, ox.NamedNode(predicate), ox_term(value), name) for predicate, value in said)

    def _forget_oldest(self) -> dict[str, bytes]:
        """Forget what is too old or one too many, and return it as graphs that are empty now."""
        limit = str(ox_term(moment(self._clock() - KEPT_FOR)))
        old, current = bisect_left(self._in_order, (limit, "")), set(self._current.values())
        oldest = self._in_order[: max(old, len(self._in_order) - MOST_KEPT)]
        over = [entry for entry in oldest if entry[1] not in current]
        for entry in over:
            self._forget(*entry)
        return {name: b"" for _, name in over}

    def _forget(self, generated: str, name: str) -> None:
        self._store.remove_graph(ox.NamedNode(name))
        self._in_order.remove((generated, name))

    def _names(self) -> list[str]:
        return [graph.value for graph in self._store.named_graphs() if isinstance(graph, ox.NamedNode)]

    def _generated(self, name: str) -> str:
        node = ox.NamedNode(name)
        return next((str(q.object) for q in self._store.quads_for_pattern(node, _GENERATED, None, node)), "")

    def _is_kept(self, name: str) -> bool:
        return any(self._store.quads_for_pattern(None, None, None, ox.NamedNode(name)))

    def _has_ended(self, name: str) -> bool:
        node = ox.NamedNode(name)
        return any(self._store.quads_for_pattern(node, _ENDED, None, node))

    def _triples(self, name: str) -> bytes:
        return self._store.dump(format=ox.RdfFormat.N_TRIPLES, from_graph=ox.NamedNode(name)) or b""


def _configuration(quads: Iterable[ox.Quad]) -> str | None:
    """The configuration that some quads describe, if they do; none that is called as a component may be."""
    kind, wanted = ox.NamedNode(TYPE), ox.NamedNode(SC.Configuration)
    found = (q.subject for q in quads if (q.predicate, q.object) == (kind, wanted))
    names = (subject.value for subject in found if isinstance(subject, ox.NamedNode))
    return next((name for name in names if name.startswith(CONFIGURATION)), None)


def _configurator(graph: str) -> str:
    """The configurator that states a graph; empty for a graph of another kind."""
    try:
        return configurator_of(graph.removeprefix("urn:selfconf:"))
    except PeerError:
        return ""
