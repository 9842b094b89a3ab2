"""A wanted signal type and the nearest that is offered.

The degrees are those of semantic matchmaking (Paolucci et al., 2002; OWLS-MX, Klusch et al., 2006).
"""

from __future__ import annotations

from enum import Enum

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
