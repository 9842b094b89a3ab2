"""What an advertisement is: everything that is said about one component, and nothing about others.

A document may hold several components. The advertisement of one is every statement that can be reached from it,
through blank nodes and through named things that are not themselves components (a place, a robot), but not through
its types: what a class means is for ontologies to say. An advertisement therefore speaks for its own component
alone, and statements that would change what shapes or classes mean are left out of it, whichever site serves it; but
for the shape that an input `sc:accepts`, which judges what feeds its own component and nothing else.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterator

from selfconf.model.immutable import immutable
from selfconf.model.profile import Place, Profile
from selfconf.model.term import IRI, BlankNode, Literal, Term, sort_key
from selfconf.rdf.permitted_fields import PERMITTED_IN_SHAPES
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, SC, SH, TYPE

AXIOMS = frozenset((RDFS.subClassOf, RDFS.subPropertyOf, RDFS.domain, RDFS.range))
_SHAPES_AND_AXIOMS = (OWL.base, SH.base)
LANGUAGES = (*_SHAPES_AND_AXIOMS, RDFS.base)
"""The namespaces of the types that mean something to shapes and reasoners, but for one of RDF itself."""
RDF_PROPERTY = RDF.Property


class Advertisement(ABC):
    """What is said about one component, as a profile and as triples.

    Advertisements are equal if they say the same; blank nodes of different documents are never equal.
    """

    __slots__ = ("component", "types")
    component: IRI
    """The component that it advertises."""
    types: frozenset[IRI]
    """The types of the component."""

    @property
    @abstractmethod
    def profile(self) -> Profile:
        """What it says, as a value."""

    @property
    @abstractmethod
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF."""

    @property
    @abstractmethod
    def place(self) -> Place | None:
        """Where it is written."""

    @property
    @abstractmethod
    def self_contained(self) -> bool:
        """Whether it is known to say nothing of things with names of their own besides its component."""

    @property
    @abstractmethod
    def breadth(self) -> int:
        """A bound on how many values it gives of one property."""

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Advertisement):
            return NotImplemented
        return self is other or (self.profile == other.profile and self.triples == other.triples)

    def __hash__(self) -> int:
        return hash(self.component)

    def __repr__(self) -> str:
        return f"<advertisement of {self.component}>"


class ParsedAdvertisement(Advertisement):
    """An advertisement that has been read in full."""

    __slots__ = ("_profile", "_triples")

    def __init__(self, profile: Profile, triples: tuple[Triple, ...]) -> None:
        self.component, self.types = profile.component, profile.types
        self._profile, self._triples = profile, triples

    @property
    def profile(self) -> Profile:
        """What it says, as a value."""
        return self._profile

    @property
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF."""
        return self._triples

    @property
    def place(self) -> Place | None:
        """Where it is written."""
        return self._profile.place

    @property
    def self_contained(self) -> bool:
        """Whether all that it says is about its component, or about blank nodes."""
        return all(isinstance(subject, BlankNode) or subject == self.component for subject, _, _ in self._triples)

    @property
    def breadth(self) -> int:
        """How many values it gives of the property of which it gives most."""
        counts = Counter(predicate for subject, predicate, _ in self._triples if subject == self.component)
        return max(counts.values(), default=0)


@immutable
class MalformedAdvertisement:
    """An advertisement that does not conform, and why: one sentence for each problem."""

    component: IRI | BlankNode
    place: Place
    problems: tuple[str, ...]


def about(document: Document, component: Node, components: frozenset[Node]) -> Iterator[Triple]:
    """The statements that the advertisement of a component makes."""
    waiting: list[Node] = [component]
    seen: set[Term] = {component}
    shapes: set[Term] = set()
    while waiting:
        subject = waiting.pop()
        in_shape = subject in shapes
        for predicate, value in document.statements.get(subject, ()):
            if not (predicate in PERMITTED_IN_SHAPES if in_shape else allowed(predicate, value)):
                continue
            yield subject, predicate, value
            if in_shape and not isinstance(value, BlankNode):
                continue  # a shape names classes and values, and says nothing of them
            if in_shape or predicate == SC.accepts:
                shapes.add(value)
            if predicate == TYPE or isinstance(value, Literal) or value in seen or value in components:
                continue
            seen.add(value)
            waiting.append(value)


def allowed(predicate: IRI, value: Term) -> bool:
    """Whether an advertisement may make a statement: no axioms, no shapes, no ontology terms of its own."""
    if predicate == TYPE:
        return isinstance(value, Literal) or not (value.startswith(LANGUAGES) or value == RDF_PROPERTY)
    return predicate not in AXIOMS and not predicate.startswith(_SHAPES_AND_AXIOMS)


def property_order(pair: tuple[IRI, Term]) -> tuple[str, tuple[int, str, str, str]]:
    """The order of the properties of a profile: by predicate, then by value."""
    return pair[0], sort_key(pair[1])
