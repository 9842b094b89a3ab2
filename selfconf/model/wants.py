"""What a task wants of a component: several tasks may hold one that can be shared, if they want the same of it."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Term


@immutable
class Wants:
    """What the inputs of a component are to follow, and the values of its parameters; by default neither."""

    inputs: frozenset[tuple[str, IRI, str]] = frozenset()
    """An input, the component that it follows, and the output of that one."""
    values: frozenset[tuple[str, Term]] = frozenset()
    """The name of an operational parameter, and its value."""
