"""What a server has kept of an ecology (`selfconf serve --history DIR`), read from its folder, also while it writes.

The store in the folder belongs to the server, and no other process may open it meanwhile. So its files are copied, and
the copy is opened, as the store itself would be after a crash: the write-ahead logs first and what names the others
last, for then each file that the copy names is there, or the copy is refused and made anew. What was written during
the copying is missing from it.
"""

from __future__ import annotations

import math
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pyoxigraph as ox

from selfconf.api.living.component_terms import iri_or_local_name
from selfconf.api.living.deployed import deployed_body, passed_over
from selfconf.errors import AuthorError
from selfconf.model.immutable import immutable
from selfconf.model.moments import parsed_moment
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import as_typed
from selfconf.rdf import turtle
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import PROV, SC
from selfconf.render.why import told_why

COPIES = 5
"""How often the files are copied until a copy can be opened."""
_ORDER = (".log", ".sst", "")
"""The endings of the files in the order of copying: write-ahead logs, tables, and what names them."""


@immutable
class PastConfiguration:
    """A configuration as the history has it: who deployed it, from when until when, after and until which failures."""

    name: str
    """The IRI of the configuration."""
    revises: str
    """The IRI of the one that it has taken the place of; empty if of none."""
    configurator: str
    task: str
    """The name of the task; in what older versions have kept its local name, or that of its template."""
    generated: float
    """When it was deployed, in seconds of the Unix epoch."""
    ended: float | None
    """When it was deployed no more; None for one that ran when it was seen last."""
    failures: tuple[Mapping[str, Any], ...]
    """The failures that have led to it, as the events of a run."""
    losses: tuple[Mapping[str, Any], ...]
    """The failures that have ended it, where no other has taken its place, as the events of a run."""
    body: Mapping[str, Any]
    """The configuration as JSON."""

    def events(self) -> Iterator[Mapping[str, Any]]:
        """What has happened, as the events of a run."""
        yield from self.failures
        yield {"act": "running", "time": self.generated, "configuration": self.body, "revises": bool(self.revises)}


def past_graphs(folder: Path) -> dict[str, bytes]:
    """Every configuration that a folder has, as N-Triples by its name. Raises AuthorError where it holds no history."""
    if not (folder / "CURRENT").is_file():
        raise AuthorError(f"{folder} holds no history; `selfconf serve --history {as_typed(folder)}` keeps one there")
    trouble: Exception | None = None
    for _ in range(COPIES):
        with tempfile.TemporaryDirectory(prefix="selfconf-history-") as copy:
            try:
                for ending in _ORDER:
                    for path in filter(Path.is_file, folder.iterdir()):  # no folder, such as lost+found
                        if path.suffix == ending or (not ending and path.suffix not in _ORDER):
                            shutil.copy2(path, copy)
                store = ox.Store.read_only(copy)
                graphs = [graph for graph in store.named_graphs() if isinstance(graph, ox.NamedNode)]
                found = {g.value: store.dump(format=ox.RdfFormat.N_TRIPLES, from_graph=g) or b"" for g in graphs}
                del store
                return found
            except (OSError, RuntimeError) as error:  # a file went while it was copied, or one that is named came later
                trouble = error
    raise AuthorError(f"cannot read the history in {folder} ({trouble})")


def past_configurations(graphs: Mapping[str, bytes]) -> list[PastConfiguration]:
    """The configurations of a history in the order in which they were deployed; what is none is passed over."""
    found = (_configuration(name, turtle.parse(text, name)) for name, text in graphs.items())
    return sorted((one for one in found if one is not None), key=lambda one: (one.generated, one.configurator))


def past_why(folder: Path, term: str, at: float | None) -> list[str]:
    """Why components played the roles that a term means, in sentences, at a moment or at the end.

    Tasks that were over by then, of which a history has any number, are passed over; where no other has to do with the
    term, the answer is about the one that was over last. Raises AuthorError where the folder holds no history.
    """
    by_task: dict[tuple[str, str], list[PastConfiguration]] = {}
    for one in past_configurations(past_graphs(folder)):
        by_task.setdefault((one.task, one.configurator), []).append(one)
    told: list[tuple[float, list[str]]] = []
    for (task, _), several in sorted(by_task.items(), key=lambda item: item[1][0].generated):
        meant = [one for one in several if at is None or one.generated <= at]
        if meant:
            said = told_why(task, _events(several), iri_or_local_name(term), at, passed_over(meant[-1].body))
            ended = several[-1].ended
            over = math.inf if ended is None or (at is not None and at < ended) else ended
            told += [(over, said)] if said else []
    latest = max((over for over, _ in told), default=math.inf)
    return [sentence for over, said in told if over == latest for sentence in said]


def _events(several: list[PastConfiguration]) -> Iterator[Mapping[str, Any]]:
    """What has happened to one task: its configurations, and the times between in which it had none."""
    for one, after in zip(several, (*several[1:], None), strict=True):
        yield from one.events()
        if one.ended is not None and (after is None or after.revises != one.name or one.losses):
            yield from one.losses
            yield {"act": "stopped", "time": one.ended}


def _configuration(name: str, document: Document) -> PastConfiguration | None:
    body, node = deployed_body(document), IRI.unchecked(name)
    generated = _moment(document.value(node, PROV.generatedAtTime))
    if body is None or generated is None:
        return None
    asked = document.value(node, SC.task)
    agent = document.value(node, PROV.wasAttributedTo)
    named = None if asked is None else document.value(asked, SC.name)
    task = _text(named) or (asked.short if isinstance(asked, IRI) else IRI.unchecked(body["template"]).short)
    failures, losses = (
        tuple(sorted(_failures(document, node, role), key=lambda failure: failure["time"]))
        for role in (PROV.wasInfluencedBy, PROV.qualifiedInvalidation)
    )
    ended = _moment(document.value(node, PROV.invalidatedAtTime))
    revises = str(document.value(node, PROV.wasRevisionOf) or "")
    return PastConfiguration(
        name, revises, str(agent).rpartition(":")[2], task, generated, ended, failures, losses, body
    )


def _failures(document: Document, node: IRI, predicate: IRI) -> Iterator[Mapping[str, Any]]:
    """The failures that a predicate leads to from a configuration, as the events of a run."""
    for failure in document.values(node, predicate):
        yield {
            "act": "lost",
            "component": str(document.value(failure, SC.component)),
            "cause": _text(document.value(failure, SC.cause)),
            "detail": _text(document.value(failure, SC.detail)),
            "time": _moment(document.value(failure, PROV.atTime)) or 0.0,
        }


def _text(term: Term | None) -> str:
    return term.lexical if isinstance(term, Literal) else ""


def _moment(term: Term | None) -> float | None:
    try:
        return parsed_moment(_text(term)).timestamp()
    except ValueError:
        return None
