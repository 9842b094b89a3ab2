"""How near one signal type comes to another, in the degrees of semantic matchmaking.

*Degree*: after Paolucci et al. (2002) and OWLS-MX (Klusch et al., 2006). A signal type that is offered is *exact* if it
is the wanted one or equivalent to it, *plug-in* if it lies below it, *subsumes* if above, *overlap* if both lie below a
third. `likeness` tells within a degree how far apart they are: of all classes above either of them, themselves
included, the share that is above both (semantic cotopy, Maedche and Staab 2002; it is the extended Jaccard coefficient
of their unfolded concepts in OWLS-MX). Each degree has a band of its own: no overlap comes before a subsumption.

Near misses are ranked by this. Whether an output feeds an input does not depend on it: that is `Hierarchy.pairs`.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI


class Degree(str, Enum):
    """How an offered signal type is related to a wanted one."""

    EXACT = "exact"
    PLUG_IN = "plug-in"
    SUBSUMES = "subsumes"
    OVERLAP = "overlap"
    FAIL = "fail"


@immutable
class SignalMatch:
    """A wanted signal type, and the nearest one that is offered for it."""

    wanted: IRI | None
    """None stands for a port without a type."""
    offered: IRI | None
    """None where nothing offered is related to the wanted type."""
    degree: Degree
    likeness: float
    """From 0 to 1; 1 for an exact match."""

    @property
    def exact(self) -> bool:
        """Whether what is offered is what is wanted."""
        return self.degree is Degree.EXACT


EVERYTHING = frozenset(
    map(IRI, ("http://www.w3.org/2002/07/owl#Thing", "http://www.w3.org/2000/01/rdf-schema#Resource"))
)
"""The classes that say nothing, as all others lie below them."""
_BANDS = {
    Degree.EXACT: (1.0, 1.0),
    Degree.PLUG_IN: (0.75, 1.0),
    Degree.SUBSUMES: (0.5, 0.75),
    Degree.OVERLAP: (0.0, 0.5),
}
"""The least and the greatest likeness of each degree."""


class SignalLikeness:
    """How near signal types come to each other in a hierarchy; what was worked out is remembered."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self._hierarchy = hierarchy
        self._above: dict[IRI, frozenset[IRI]] = {}
        self._known: dict[tuple[IRI, IRI], SignalMatch] = {}

    def match(self, offered: IRI, wanted: IRI) -> SignalMatch:
        """How near an offered signal type comes to a wanted one."""
        pair = offered, wanted
        if pair not in self._known:
            self._known[pair] = self._match(offered, wanted)
        return self._known[pair]

    def nearest(self, offered: Iterable[IRI], wanted: Iterable[IRI]) -> SignalMatch:
        """The best match of any offered signal type with any wanted one; the first of several equals."""
        types = list(wanted)
        found = [self.match(one, other) for one in offered for other in types]
        none = SignalMatch(types[0] if types else None, None, Degree.FAIL, 0.0)
        return max(found, key=lambda match: match.likeness, default=none)

    def _match(self, offered: IRI, wanted: IRI) -> SignalMatch:
        below, above = self._superclasses(offered), self._superclasses(wanted)
        common = below & above
        if wanted in below:
            degree = Degree.EXACT if offered in above else Degree.PLUG_IN
        elif offered in above:
            degree = Degree.SUBSUMES
        elif common:
            degree = Degree.OVERLAP
        else:
            return SignalMatch(wanted, None, Degree.FAIL, 0.0)
        least, most = _BANDS[degree]
        return SignalMatch(wanted, offered, degree, least + (most - least) * len(common) / len(below | above))

    def _superclasses(self, signal: IRI) -> frozenset[IRI]:
        if signal not in self._above:
            self._above[signal] = self._hierarchy.superclasses(signal) - EVERYTHING | {signal}
        return self._above[signal]
