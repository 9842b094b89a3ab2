"""The hierarchy of classes and properties that a reasoning mode adds to what the advertisements say.

*Offered matches wanted* iff wanted is offered itself or lies above it. In OWL-S terms (Paolucci et al., 2002) an
equal pair is *exact* and an offered subclass *plug-in*; *subsumes* and *overlap* are never accepted.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum

from selfconf.model.profile import Input, Operation, Output
from selfconf.model.term import IRI


class Reasoning(str, Enum):
    """Which triples the shape of a role sees: the advertisements alone, or more."""

    SYNTACTIC = "syntactic"
    SUBCLASS = "subclass"
    OWL_RL = "owl-rl"


class Upward:
    """The reflexive and transitive closure of a relation *lies directly below*; cycles are equivalences.

    Closed lazily and remembered per term of the relation: an ecology offers few of those that an ontology has.
    """

    __slots__ = ("_closed", "_parents")

    def __init__(self, edges: Iterable[tuple[IRI, IRI]] = ()) -> None:
        parents: dict[IRI, set[IRI]] = {}
        for below, above in edges:
            parents.setdefault(below, set()).add(above)
        self._parents = parents
        self._closed: dict[IRI, frozenset[IRI]] = {}

    def above(self, term: IRI) -> frozenset[IRI]:
        """`term` and everything above it."""
        if term not in self._parents:
            return frozenset((term,))
        closed = self._closed.get(term)
        if closed is None:
            seen, waiting = {term}, [term]
            while waiting:
                for parent in self._parents.get(waiting.pop(), ()):
                    if parent not in seen:
                        seen.add(parent)
                        waiting.append(parent)
            closed = self._closed[term] = frozenset(seen)
        return closed

    def above_all(self, terms: frozenset[IRI]) -> frozenset[IRI]:
        """Some terms and everything above them."""
        if self._parents.keys().isdisjoint(terms):
            return terms
        return frozenset[IRI]().union(*map(self.above, terms))

    def is_above_others(self, term: IRI) -> bool:
        """Whether something lies below a term, at a cost of the whole relation."""
        return any(term in parents for parents in self._parents.values())

    def __bool__(self) -> bool:
        return bool(self._parents)


class Hierarchy:
    """What lies above a class or a property; with no edges, each term lies below itself only."""

    __slots__ = ("_classes", "_properties", "flat")

    def __init__(self, classes: Iterable[tuple[IRI, IRI]] = (), properties: Iterable[tuple[IRI, IRI]] = ()) -> None:
        """Edges run from the lower term to the higher one, in any order, cycles allowed."""
        self._classes, self._properties = Upward(classes), Upward(properties)
        self.flat = not self._classes
        """Whether no class lies below another."""

    def superclasses(self, offered: IRI) -> frozenset[IRI]:
        """`offered` and every class above it; of the type of an operation, every one where it serves."""
        if not isinstance(offered, Operation):
            return self._classes.above(offered)
        response = offered.response
        return frozenset((offered,) if response is None else map(Operation.of, self._classes.above(response)))

    def classes_of(self, types: frozenset[IRI]) -> frozenset[IRI]:
        """The classes that a component of some types is of: these, and every class above them."""
        return self._classes.above_all(types)

    def superproperties(self, offered: IRI) -> frozenset[IRI]:
        """`offered` and every property above it."""
        return self._properties.above(offered)

    def has_subproperties(self, wanted: IRI) -> bool:
        """Whether a property lies below another one; this looks at the whole hierarchy."""
        return self._properties.is_above_others(wanted)

    def matches(self, offered: IRI, wanted: IRI) -> bool:
        """Whether a class (of components, signals or parameters) that is offered serves where another is wanted."""
        return offered == wanted or (not self.flat and wanted in self.superclasses(offered))

    def served(self, offered: Sequence[IRI]) -> Iterable[IRI]:
        """The classes that something serves which is of all of some classes: these, and every class above them."""
        if self.flat:
            return offered
        if len(offered) == 1:
            return self.superclasses(offered[0])
        return frozenset().union(*map(self.superclasses, offered))

    def pairs(self, output: Output, wanted: Input) -> bool:
        """Whether an output may feed an input: one of its types serves, and the condition of the input is met."""
        served = self.served(output.signals)
        return not frozenset(wanted.signals).isdisjoint(served) and (
            wanted.condition is None or wanted.condition.met_by(output)
        )


NOTHING_ABOVE = Hierarchy()
"""The hierarchy of the syntactic mode: types match iff they are equal (section 2.3 of the paper)."""
