"""Ports that interactions name and no candidate has, with the names that were probably meant.

The name of an operation is mostly written without its `()`, or with a slip.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from selfconf.model.profile import CALL_MARK
from selfconf.model.refusal import MisnamedPort
from selfconf.model.term import IRI
from selfconf.search.problem import Problem

LIKE_A_SLIP = 0.7
"""How alike two names have to be for one to be a slip of the other; 1 is equal."""


def misnamed_port(problem: Problem, sink: IRI) -> MisnamedPort | None:
    """Return the first port of the interactions that feed a role which no candidate has, if one has a name like it."""
    places = {role.iri: number for number, role in enumerate(problem.roles)}
    for interaction in problem.task.template.interactions:
        if interaction.sink != sink:
            continue
        giving, taking = (problem.candidates[places[role]] for role in (interaction.source, sink))
        for role, kind, named, known in (
            (interaction.source, "output", interaction.output, {o.name for c in giving for o in c.profile.outputs}),
            (sink, "input", interaction.input, {i.name for c in taking for i in c.profile.inputs}),
        ):
            meant = None if named is None or named in known else _meant(named, known)
            if named is not None and meant is not None:
                return MisnamedPort(role, kind, named, meant)
    return None


def _meant(named: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most like another one: but for the mark of an operation, or by its letters."""
    names = sorted(known)
    plain = named.removesuffix(CALL_MARK)
    same = [name for name in names if name.removesuffix(CALL_MARK) == plain]
    by_letters = {name.removesuffix(CALL_MARK).lower(): name for name in names}
    close = difflib.get_close_matches(plain.lower(), list(by_letters), n=1, cutoff=LIKE_A_SLIP)
    return next(iter((*same, *(by_letters[one] for one in close))), None)
