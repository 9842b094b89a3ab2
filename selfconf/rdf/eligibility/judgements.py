"""What pySHACL has said of components, kept as long as it holds: judging is dear, and ecologies change by a few."""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.term import IRI, Term
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.role_tests import CompiledRole

Violations = tuple[ShapeViolated | NotJudged, ...]
"""What keeps a component from conforming to a shape; nothing if it conforms."""
Values = Mapping[IRI, Term]
"""Values of free parameters, with which a shape is judged."""
_Question = tuple[IRI, frozenset[tuple[IRI, Term]] | None]
"""A shape, and the values of free parameters; None for whatever values."""


class Judgements:
    """The judgements of one task's shapes, by advertisement: the same words are judged once.

    The judgement of a shape that looks at other components too holds for one ecology; that of any other shape, and
    that judging takes too long, hold whatever else there is.
    """

    def __init__(self) -> None:
        self._ecology: AdvertisementIndex | None = None
        self._here = dict[Advertisement, dict[_Question, Violations]]()
        self._anywhere = dict[Advertisement, dict[_Question, Violations]]()

    def look_at(self, ecology: AdvertisementIndex) -> None:
        """Forget what does not hold in an ecology, and what is said of advertisements that it does not have."""
        if ecology is not self._ecology:
            self._ecology, self._here = ecology, {}
            kept = {a: known for a, known in self._anywhere.items() if ecology.get(a.component) == a}
            self._anywhere = kept

    def known(
        self, role: CompiledRole, advertisement: Advertisement, values: Values, ecology: AdvertisementIndex
    ) -> Violations | None:
        """What was said of an advertisement; None if it has to be judged."""
        questions = (role.iri, frozenset(values.items())), (role.iri, None)
        for judgements in (self._anywhere, self._here) if ecology is self._ecology else (self._anywhere,):
            found = judgements.get(advertisement, {})
            for question in questions:
                if question in found:
                    return found[question]
        return None

    def keep(
        self,
        role: CompiledRole,
        advertisement: Advertisement,
        values: Values,
        ecology: AdvertisementIndex,
        violations: Violations,
    ) -> None:
        """Remember what was said of an advertisement in an ecology, where that will be of use."""
        failed = any(isinstance(one, NotJudged) for one in violations)
        question = role.iri, None if failed else frozenset(values.items())
        if failed or role.local:
            self._anywhere.setdefault(advertisement, {})[question] = violations
        elif ecology is self._ecology:
            self._here.setdefault(advertisement, {})[question] = violations
