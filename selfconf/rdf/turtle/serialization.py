"""Triples as text: N-Triples for the wire and Turtle, both by Oxigraph, and Turtle with brackets for people to read.

In brackets stands a blank node that is named once, where it is named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import overload

import pyoxigraph as ox

from selfconf.model.curie import is_local_name
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle.document import Triple
from selfconf.rdf.vocabulary import LABEL, PROV, ROB, SC, TYPE, XSD

TURTLE_PREFIXES = {"sc": SC.base, "rob": ROB.base, "prov": PROV.base, "xsd": XSD.base}


@overload
def ox_term(value: IRI | BlankNode) -> ox.NamedNode | ox.BlankNode: ...
@overload
def ox_term(value: Term) -> ox.NamedNode | ox.BlankNode | ox.Literal: ...
def ox_term(value: Term) -> ox.NamedNode | ox.BlankNode | ox.Literal:
    """A value of the model as one of Oxigraph's terms."""
    if isinstance(value, IRI):
        return ox.NamedNode(value)
    if isinstance(value, Literal):
        if value.language:
            return ox.Literal(value.lexical, language=value.language)
        return ox.Literal(value.lexical, datatype=ox.NamedNode(value.datatype))
    return ox.BlankNode(value[2:])


def _ox_triples(triples: Iterable[Triple]) -> Iterator[ox.Triple]:
    for subject, predicate, value in triples:
        yield ox.Triple(ox_term(subject), ox.NamedNode(predicate), ox_term(value))


def ntriples(triples: Iterable[Triple]) -> bytes:
    """The triples as N-Triples, which is Turtle too."""
    return ox.serialize(_ox_triples(triples), format=ox.RdfFormat.N_TRIPLES) or b""


def to_turtle(triples: Iterable[Triple], prefixes: Mapping[str, str] | None = None) -> str:
    """The triples as Turtle for people."""
    prefixes = {**TURTLE_PREFIXES, **(prefixes or {})}
    return (ox.serialize(_ox_triples(triples), format=ox.RdfFormat.TURTLE, prefixes=prefixes) or b"").decode()


MOST_NESTED = 200
"""Where there are more blank nodes than that, each is named: what a stranger wrote may nest without end."""
ONE_LINE = 78
"""What is in brackets stands in one line if that has no more characters."""
_FIRST = {TYPE: 0, LABEL: 1}
"""The predicates that come first; the others follow in the order of the triples."""


def pretty_turtle(triples: Iterable[Triple], prefixes: Mapping[str, str]) -> str:
    """The triples as Turtle, subjects in the order of their first triples; only prefixes that are used are declared."""
    writer = _Writer(list(triples), prefixes)
    statements = [writer.statement(subject) for subject in writer.tops()]
    declared = [f"@prefix {prefix}: <{prefixes[prefix]}> .\n" for prefix in sorted(writer.used)]
    return "".join(declared) + ("\n" if declared else "") + "\n".join(statements)


class _Writer:
    """Writes subjects, and remembers which prefixes were used."""

    def __init__(self, triples: list[Triple], prefixes: Mapping[str, str]) -> None:
        self._about: dict[Term, list[tuple[IRI, Term]]] = {}
        for subject, predicate, value in triples:
            self._about.setdefault(subject, []).append((predicate, value))
        named = Counter(value for _, _, value in triples if isinstance(value, BlankNode))
        nested = [node for node, count in named.items() if count == 1] if len(named) <= MOST_NESTED else []
        self._inside = {node for node in nested if not self._circular(node)}
        self._prefixes = sorted(prefixes.items(), key=lambda pair: -len(pair[1]))
        self.used: set[str] = set()

    def _circular(self, start: BlankNode) -> bool:
        """Whether a blank node leads back to itself by blank nodes, so that it must be named."""
        seen: set[Term] = set()
        waiting: list[Term] = [start]
        while waiting:
            for _, value in self._about.get(waiting.pop(), ()):
                if value == start:
                    return True
                if isinstance(value, BlankNode) and value not in seen:
                    seen.add(value)
                    waiting.append(value)
        return False

    def tops(self) -> list[Term]:
        """The subjects that stand by themselves."""
        return [subject for subject in self._about if subject not in self._inside]

    def statement(self, subject: Term) -> str:
        """All that is said of a subject."""
        return f"{self._term(subject, '')} {self._facts(subject, '')} .\n"

    def _facts(self, subject: Term, indent: str) -> str:
        by_predicate: dict[IRI, list[str]] = {}
        for predicate, value in self._about[subject]:
            by_predicate.setdefault(predicate, []).append(self._term(value, indent + "    "))
        ordered = sorted(by_predicate.items(), key=lambda pair: _FIRST.get(pair[0], len(_FIRST)))
        lines = []
        for predicate, values in ordered:
            together = ", ".join(values)
            if len(together) > ONE_LINE or "\n" in together:
                together = f" ,\n{indent}        ".join(values)
            lines.append(f"{'a' if predicate == TYPE else self._name(predicate)} {together}")
        in_one = " ; ".join(lines)
        if indent and len(in_one) <= ONE_LINE and "\n" not in in_one:
            return in_one
        return f" ;\n{indent}    ".join(lines)

    def _term(self, value: Term, indent: str) -> str:
        if isinstance(value, Literal):
            return value.turtle(self._name)
        if value in self._inside:
            if value not in self._about:
                return "[]"
            facts = self._facts(value, indent)
            return f"[ {facts} ]" if "\n" not in facts else f"[\n{indent}    {facts}\n{indent}]"
        return self._name(value) if isinstance(value, IRI) else str(value)

    def _name(self, iri: IRI) -> str:
        for prefix, base in self._prefixes:
            if iri.startswith(base) and is_local_name(iri[len(base) :]):
                self.used.add(prefix)
                return f"{prefix}:{iri[len(base) :]}"
        return f"<{iri}>"
