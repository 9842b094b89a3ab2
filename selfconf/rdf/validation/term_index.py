"""Which terms are known: those that the loaded ontologies declare, and what a file may use without a second
look.

An ontology covers the namespaces in which it declares classes or properties. A term of a covered
namespace that no ontology declares is most probably misspelt, and RDF would pass over it in silence.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain

from selfconf.model.literal_values import of_range
from selfconf.model.strong_components import strong_components
from selfconf.rdf.validation.prefilter import Prefiltered
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, XSD

_USUAL = frozenset(
    (
        *(RDF[name] for name in ("type", "first", "rest", "nil", "value", "langString")),
        *(RDFS[name] for name in ("label", "comment", "seeAlso", "isDefinedBy")),
        *(XSD[name] for name in ("string", "integer", "decimal", "double", "float", "boolean", "date", "dateTime")),
    )
)
STANDARD = tuple(namespace.base for namespace in (RDF, RDFS, OWL, XSD, SH))
"""Namespaces whose words are fixed by W3C recommendations."""
OWN = SC.base.rstrip("#")
"""What all namespaces begin with that come with selfconf, and that no one else declares."""


def namespace(iri: str) -> str:
    """An IRI up to its last # or /."""
    return iri[: max(iri.rfind("#"), iri.rfind("/")) + 1]


def skeleton(iri: str) -> str:
    """A namespace without scheme and last character: equal for two that are easily confused."""
    return iri.partition("://")[2].rstrip("#/").removeprefix("www.").lower()


def one_slip_apart(one: str, other: str) -> bool:
    """Whether one text becomes another by inserting, deleting or replacing one character, or swapping neighbours."""
    start = next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))
    a, b = one[start:], other[start:]
    return a[1:] == b[1:] or a[1:] == b or a == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:])


def _adjacent(pairs: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for lower, upper in pairs:
        found.setdefault(lower, []).append(upper)
    return found


@dataclass
class TermIndex:
    """The terms that are known in one run."""

    terms: set[str] = field(default_factory=set)
    object_properties: set[str] = field(default_factory=set)
    ranges: dict[str, set[str]] = field(default_factory=dict)
    """The datatypes of the values of properties, as far as they are stated."""
    covered: set[str] = field(default_factory=lambda: {SC.base})
    classes: set[str] = field(default_factory=set)
    properties: set[str] = field(default_factory=set)
    above: set[tuple[str, str]] = field(default_factory=set)
    """What the files say of the hierarchies of classes and properties: one of them, and one right above it."""
    equal: set[tuple[str, str]] = field(default_factory=set)
    """The pairs of `above` that are said to be equal."""
    _upper: dict[str, list[str]] = field(default_factory=dict)
    """By `above`: what is right above a class or property."""
    _circles: tuple[dict[str, str], dict[str, str]] = ({}, {})
    """The strongly connected components of `above` and of `equal`."""
    _strange: dict[str, bool] = field(default_factory=dict)
    _confused: dict[str, str | None] = field(default_factory=dict)
    _above: dict[str, set[str]] = field(default_factory=dict)

    def learn(self, seen: Prefiltered) -> None:
        """Take up what a file declares; of one that declares classes or properties, everything that it speaks of.

        So it does not matter whether an ontology is given as such, or is validated beside what uses it.
        """
        self.object_properties |= seen.object_properties
        for one, datatype in seen.ranges:
            self.ranges.setdefault(one, set()).add(datatype)
        self.classes |= seen.classes
        self.properties |= seen.properties
        self.above |= seen.above
        self.equal |= seen.equal
        self.terms |= seen.placed
        if seen.terms:
            self.terms |= seen.terms | seen.subjects
            self.covered |= {namespace(term) for term in seen.terms} - {""}  # as of urn:x
        self._strange.clear()
        self._confused.clear()
        self._upper.clear()
        self._above.clear()

    def strange(self, iri: str) -> bool:
        """Whether an IRI lies in a covered or standard namespace, but is not known there at first sight."""
        known = self._strange.get(iri)
        if known is None:
            home = namespace(iri)
            known = self._strange[iri] = iri not in self.terms and (
                home in self.covered or (home in STANDARD and iri not in _USUAL)
            )
        return known

    def undeclared(self, signal: str) -> bool:
        """Whether a signal type is one that no loaded ontology speaks of."""
        return signal not in self.terms

    def foreign(self, signal: str) -> bool:
        """Whether a signal type lies in a namespace of which nothing is known, and which is not easily confused."""
        return self.undeclared(signal) and not self.strange(signal) and self.confused(namespace(signal)) is None

    def unfit(self, predicate: str, datatype: str, lexical: str) -> bool:
        """Whether a literal is none of those that the loaded ontologies state as the values of a property."""
        wanted = self.ranges.get(predicate)
        return wanted is not None and not any(of_range(lexical, datatype, one) for one in wanted)

    def serves(self, offered: str, wanted: str) -> bool:
        """Whether a class is another or lies below it, by what the loaded ontologies say."""
        return wanted in self.at_or_above(offered)

    def classes_signals(self, kind: str) -> bool:
        """Whether a class is one of signals, and not of components as well."""
        return self._is_of(kind, ROB.Signal, SC.Component)

    def classes_components(self, kind: str) -> bool:
        """Whether a class is one of components, and not of signals as well."""
        return self._is_of(kind, SC.Component, ROB.Signal)

    def _is_of(self, kind: str, one: str, other: str) -> bool:
        above = self._above.get(kind)
        if above is None:
            above = self._above[kind] = self.at_or_above(kind)
        return one in above and other not in above

    def at_or_above(self, offered: str) -> set[str]:
        """A class or property with all that the loaded ontologies put above it."""
        upper = self._hierarchy()
        found, waiting = {offered}, [offered]
        while waiting:
            higher = set(upper.get(waiting.pop(), ())) - found
            found |= higher
            waiting += higher
        return found

    def circle(self, lower: str, upper: str) -> str | None:
        """A name for the circle in which one lies above another as well as below it; None where there is none.

        What is said to be equal is in no circle because of that.
        """
        self._hierarchy()
        placed, equal = self._circles
        if placed.get(lower) is None or placed[lower] != placed.get(upper):
            return None
        return None if lower in equal and equal[lower] == equal.get(upper) else placed[lower]

    def in_circle(self, circle: str) -> list[str]:
        """All that lie in a circle."""
        return [term for term, name in self._circles[0].items() if name == circle]

    def _hierarchy(self) -> dict[str, list[str]]:
        """By `above`: what is right above a class or property."""
        if not self._upper:
            self._upper, equal = _adjacent(self.above), _adjacent(self.equal)
            self._circles = strong_components(self._upper), strong_components(equal)
        return self._upper

    def confused(self, iri: str) -> str | None:
        """The known namespace that this one is easily confused with, if it is another.

        Of the standard ones and of those that come with selfconf also one that is written with a slip.
        """
        if iri in self.covered or iri in STANDARD:
            return None
        if iri not in self._confused:
            key = skeleton(iri)
            known = (*sorted(self.covered), *STANDARD)
            same = (one for one in known if skeleton(one) == key)
            slips = (one for one in known if one.startswith(OWN) or one in STANDARD)
            self._confused[iri] = next(chain(same, (one for one in slips if one_slip_apart(skeleton(one), key))), None)
        return self._confused[iri]

    def clear(self, seen: Prefiltered) -> bool:
        """Whether nothing in a file needs a second look."""
        prefixes = [prefix for prefix, _ in seen.prefixes]
        return not (
            any(self.strange(iri) for iri in seen.used)
            or any(one in self.object_properties or self.unfit(one, kind, text) for one, kind, text in seen.literals)
            or len(prefixes) != len(set(prefixes))
            or any(self.confused(iri) for _, iri in seen.prefixes)
            or any(self.confused(home) for home in set(map(namespace, seen.used)))
            or any(component.startswith("file:") for component in seen.components)
            or any(map(self.classes_signals, seen.component_types))
            or any(map(self.classes_components, seen.port_types))
        )


def index_of(ontologies: Iterable[Prefiltered]) -> TermIndex:
    """What a run knows from its ontologies."""
    index = TermIndex()
    for seen in ontologies:
        index.learn(seen)
    return index
