"""What was left out of an ecology when it was read, and why: nothing is dropped in silence."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.profile import Place
from selfconf.model.term import IRI, BlankNode


@immutable
class LeftOut:
    """An advertisement that does not count: it does not conform, or its component is advertised already."""

    place: Place
    component: IRI | BlankNode
    reason: str

    def __str__(self) -> str:
        return f"{self.place}: left out {self.component}: {self.reason}"
