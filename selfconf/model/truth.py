"""Truth values: which literals stand for one, and for which.

A literal is a truth value here if its datatype is xsd:boolean and its text is in the lexical space of that datatype
(XSD 1.1 part 2, section 3.3.2.2): `true`, `false`, `1` or `0`. The shapes say the same by `sh:datatype xsd:boolean`.
"""

from __future__ import annotations

from selfconf.model.term import XSD_NAMESPACE, Literal, Term

BOOLEAN = XSD_NAMESPACE + "boolean"
TRUTH = {"true": True, "1": True, "false": False, "0": False}
"""The texts of a truth value, each with what it stands for."""


def truth(term: Term | None) -> bool | None:
    """What a literal of xsd:boolean stands for; None for anything else."""
    return TRUTH.get(term.lexical) if isinstance(term, Literal) and term.datatype == BOOLEAN else None
