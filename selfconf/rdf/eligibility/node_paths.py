"""SHACL's property paths (SHACL, 2.3.1) walked over the statements of one advertisement."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from selfconf.model.term import IRI, Term
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import FIRST, SH

Step = Callable[[Term], Iterable[Term]]
"""From a node to the nodes that a path leads to."""


class WalkedStatements:
    """What is said of and about each node, some statements given."""

    def __init__(self, triples: Iterable[Triple]) -> None:
        self._forth: dict[tuple[Term, IRI], list[Term]] = {}
        self._back: dict[tuple[Term, IRI], list[Term]] = {}
        self._known: dict[tuple[Term, Term, bool], list[Term]] = {}
        """Where a path leads from a node, forth or back: stars in stars would be walked again and again."""
        for subject, predicate, value in triples:
            self._forth.setdefault((subject, predicate), []).append(value)
            self._back.setdefault((value, predicate), []).append(subject)

    def values(self, node: Term, predicate: IRI) -> Iterable[Term]:
        """The values of a property of a node."""
        return self._forth.get((node, predicate), ())

    def walked(self, document: Document, path: Term, node: Term, back: bool = False) -> list[Term]:
        """The nodes to which a path leads, each once; `back` walks a predicate against its direction."""
        key = path, node, back
        if key not in self._known:
            self._known[key] = list(dict.fromkeys(self._walked(document, path, node, back)))
        return self._known[key]

    def _walked(self, document: Document, path: Term, node: Term, back: bool) -> Iterable[Term]:
        def step(inner: Term, reverse: bool = back) -> Step:
            return lambda start: self.walked(document, inner, start, reverse)

        if isinstance(path, IRI):
            return self._back.get((node, path), ()) if back else self.values(node, path)
        if document.value(path, FIRST) is not None:
            steps = document.items(path)
            return _one_after_another([step(each) for each in (reversed(steps) if back else steps)], node)
        for predicate, inner in document.about(path):
            if predicate == SH.inversePath:
                return step(inner, not back)(node)
            if predicate == SH.alternativePath:
                return [end for each in document.items(inner) for end in step(each)(node)]
            if predicate == SH.zeroOrOnePath:
                return [node, *step(inner)(node)]
            if predicate in (SH.zeroOrMorePath, SH.oneOrMorePath):
                return _repeated(step(inner), node, itself=predicate == SH.zeroOrMorePath)
        return ()


def _one_after_another(steps: Iterable[Step], node: Term) -> list[Term]:
    ends: list[Term] = [node]
    for step in steps:
        ends = list(dict.fromkeys(end for start in ends for end in step(start)))
    return ends


def _repeated(step: Step, node: Term, itself: bool) -> list[Term]:
    """The nodes that a step leads to when it is taken again and again; with `itself` also where it began."""
    found: dict[Term, None] = {}
    waiting = [node]
    while waiting:
        for end in step(waiting.pop()):
            if end not in found:
                found[end] = None
                waiting.append(end)
    return [*dict.fromkeys((node, *found))] if itself else [*found]
