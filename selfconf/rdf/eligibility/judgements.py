"""What pySHACL is shown of components and says of them, kept as long as it holds.

A shape that mentions a free parameter is judged once for each value that may make a difference to it.

Judging is dear, and ecologies change by a few components at a time. Most roles are compiled in full; then neither
rdflib nor pySHACL is loaded.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.term import IRI, Term
from selfconf.model.wording import listed
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import free_values
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.compiled_roles import bound_shape, called, left_to_judge
from selfconf.rdf.eligibility.role_tests import CompiledRole
from selfconf.rdf.tasks import mentions
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import RDFS, TYPE

if TYPE_CHECKING:
    import rdflib

Violations = tuple[ShapeViolated | NotJudged, ...]
"""What keeps a component from conforming to a shape; nothing if it conforms."""
Values = Mapping[IRI, Term]
"""Values of free parameters, with which a shape is judged."""
_Question = tuple[IRI, frozenset[tuple[IRI, Term]] | None]
"""A shape, and the values of free parameters; None for whatever values."""


def another_value(parameter: IRI) -> IRI:
    """A value that no component has: what it lets pass, any value lets pass. Words call it what the parameter is."""
    return IRI.unchecked(f"urn:selfconf:another-value#{parameter.short}")


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


class ShapeJudge:
    """Has pySHACL judge components by the shapes of one document, under a hierarchy."""

    def __init__(self, document: Document, hierarchy: Hierarchy, free: Mapping[IRI, str]) -> None:
        """`free` are the free parameters that are left in the shapes, each with its name."""
        self._document, self._hierarchy, self._free = document, hierarchy, free
        self._kept = Judgements()
        self.not_judged: dict[IRI, NotJudged] = {}
        """Of the ecology that was looked at last: the components that cannot be judged, or not in time, and why."""

    def look_at(self, ecology: AdvertisementIndex) -> None:
        """Keep what is said of an ecology from now on, and of what was said before what holds in it."""
        self.not_judged = {}
        self._kept.look_at(ecology)

    def violations(
        self,
        role: CompiledRole,
        focus: Sequence[Advertisement],
        ecology: AdvertisementIndex,
        values: Values,
        subjects: rdflib.Graph | None = None,
    ) -> dict[IRI, Violations]:
        """What pySHACL finds wrong with some components of an ecology, parameters replaced by their values."""
        said = {a: self._kept.known(role, a, values, ecology) for a in focus}
        asked = [advertisement for advertisement, violations in said.items() if violations is None]
        wrong = self._judged(asked, role, ecology, values, subjects)
        for advertisement in asked:
            said[advertisement] = violations = tuple(wrong.get(advertisement.component, ()))
            self._kept.keep(role, advertisement, values, ecology, violations)
        found = {advertisement.component: violations for advertisement, violations in said.items() if violations}
        for component, violations in found.items():
            self.not_judged.update((component, one) for one in violations if isinstance(one, NotJudged))
        return found

    def mentioned(self, role: CompiledRole) -> IRI | None:
        """The free parameter that the shape of a role mentions where pySHACL judges it, if it does."""
        parameters = mentions(left_to_judge(self._document, role), role.iri, frozenset(self._free))
        if len(parameters) > 1:
            names = listed(sorted(self._free[parameter] for parameter in parameters))
            raise TemplateError(
                f"the role {role.iri!r} mentions the free parameters {names} in one shape that is judged by pySHACL; "
                "bind all but one of them",
                file=self._document.source,
            )
        return next(iter(parameters), None)

    def values_of(self, parameter: IRI, role: CompiledRole, shown: Collection[Advertisement]) -> set[Term]:
        """The values of a free parameter that may make a difference where pySHACL judges a role: listed, or seen."""
        asked = left_to_judge(self._document, role)
        seen = free_values.seen(asked, role.iri, self.visible(shown))
        return seen | free_values.enumerated(self._document, parameter)

    def by_value(
        self,
        role: CompiledRole,
        parameter: IRI,
        values: Iterable[Term],
        focus: Sequence[Advertisement],
        ecology: AdvertisementIndex,
    ) -> Iterator[tuple[Term, dict[IRI, Violations]]]:
        """What pySHACL finds wrong with some components for each value of the free parameter that a role mentions.

        First for any other value than these, unless the parameter lists its values.
        """
        subjects = self.subjects(role, focus, ecology)
        others = () if free_values.enumerated(self._document, parameter) else (another_value(parameter),)
        for value in (*others, *values):
            yield value, self.violations(role, focus, ecology, {parameter: value}, subjects)

    def _judged(
        self,
        focus: Sequence[Advertisement],
        role: CompiledRole,
        ecology: AdvertisementIndex,
        values: Values,
        subjects: rdflib.Graph | None,
    ) -> dict[IRI, list[ShapeViolated | NotJudged]]:
        if not focus:
            return {}
        from selfconf.rdf.conformance import violations
        from selfconf.rdf.rdflib_terms import to_rdflib

        shapes = to_rdflib(bound_shape(left_to_judge(self._document, role), values))
        seen = self.subjects(role, focus, ecology) if subjects is None else subjects
        sizes = {advertisement.component: advertisement.breadth for advertisement in focus}
        source = self._document.source
        return violations(seen, shapes, role.iri, list(sizes), source, called(role.iri), sizes)

    def subjects(self, role: CompiledRole, focus: Sequence[Advertisement], ecology: AdvertisementIndex) -> rdflib.Graph:
        """What the shape of a role is shown: no more than the survivors, if it looks at nothing else."""
        from selfconf.rdf.eligibility.lazy_graph import LazyStore
        from selfconf.rdf.rdflib_terms import rdflib_triple

        shown = focus if role.local else ecology.values()
        components = frozenset(advertisement.component for advertisement in shown)
        named = free_values.looked_at(self._document, role.iri)

        def said(advertisement: Advertisement) -> Iterator[Triple]:
            seen = self.visible_of(advertisement, components)
            return seen if named is None else (triple for triple in seen if triple[1] in named)

        store = LazyStore()
        for advertisement in shown:
            if advertisement.self_contained:
                store.defer(advertisement.component, partial(said, advertisement))
            else:
                for triple in said(advertisement):
                    store.graph.add(rdflib_triple(triple))
        return store.graph

    def visible(self, advertisements: Collection[Advertisement]) -> Iterator[Triple]:
        """What the shape sees: the advertisements, and under a hierarchy what follows for types and properties.

        Each speaks for its own component: what it says about another is not seen.
        """
        components = frozenset(advertisement.component for advertisement in advertisements)
        for advertisement in advertisements:
            yield from self.visible_of(advertisement, components)

    def visible_of(self, advertisement: Advertisement, components: Container[IRI]) -> Iterator[Triple]:
        """What the shape sees of one advertisement, which says nothing that counts about others of some components."""
        for subject, predicate, value in advertisement.triples:
            if subject != advertisement.component and subject in components:
                continue
            for above in self._hierarchy.superproperties(predicate):
                yield subject, above, value  # the property itself is one of them
            if not isinstance(value, IRI):
                continue
            for kind in self._hierarchy.superclasses(value):  # of any property: a path may go on from what it leads to
                for above in self._hierarchy.superclasses(kind) - {kind}:
                    yield kind, RDFS.subClassOf, above
                if predicate == TYPE:
                    yield subject, TYPE, kind
