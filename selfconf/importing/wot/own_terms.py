"""What a description says in the terms of selfconf, as those of `selfconf serve` do: inputs, operations, parameters.

A description of the W3C has no member for these; for what it has one, its own member is read.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from selfconf.importing.imported import DescribedValue, ImportedOperation, ImportedPort, NestedNode
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.json_text import one_or_several
from selfconf.importing.wot.json_values import terms_of
from selfconf.model.profile import is_port_name
from selfconf.model.term import IRI, Term
from selfconf.rdf.permitted_fields import RATE
from selfconf.rdf.vocabulary import SC

_SAID = {
    SC.hasInput: frozenset((SC.name, SC.signalType, SC.unit, SC.optional)),
    SC.hasOperation: frozenset((SC.name, SC.request, SC.response)),
    SC.needsOperation: frozenset((SC.name, SC.request, SC.response, SC.optional)),
    SC.hasParameter: frozenset((SC.name, SC.parameterType)),
}
"""The terms of selfconf that are read of a thing, and what is read of the values of each."""
OWN_TERMS = frozenset(_SAID)


class OwnTerms:
    """What one thing says in the terms of selfconf."""

    def __init__(self, thing: Mapping[str, Any], meanings: TermMeanings) -> None:
        self._meanings, self._members = meanings, _by_meaning(thing, meanings)
        self.unread = 0
        """How many values, or members of values, were passed over so far."""

    def inputs(self, taken: Collection[str] = ()) -> Iterator[ImportedPort]:
        """The inputs; those of names that are taken are passed over."""
        for name, said in self._named(SC.hasInput, taken):
            types = tuple(one for one in self._terms(said, SC.signalType) if isinstance(one, IRI))
            yield ImportedPort(name, types, self._iri(said, SC.unit), optional=said.get(SC.optional) is True)

    def operations(self, member: IRI, taken: Collection[str] = ()) -> Iterator[ImportedOperation]:
        """The operations that are offered (`sc:hasOperation`) or needed (`sc:needsOperation`), by names not taken."""
        for name, said in self._named(member, taken):
            types = self._iri(said, SC.request), self._iri(said, SC.response)
            yield ImportedOperation(name, *types, optional=said.get(SC.optional) is True)

    def parameters(self) -> Iterator[tuple[str, IRI]]:
        """The name and type of each operational parameter."""
        for name, said in self._named(SC.hasParameter):
            kind = self._iri(said, SC.parameterType)
            if kind is None:
                self.unread += 1
            else:
                yield name, kind

    def _named(self, member: IRI, others: Collection[str] = ()) -> Iterator[tuple[str, dict[IRI, Any]]]:
        """Each value of a member that has a name of its own, as a port may have it, with what is said of it."""
        taken = set(others)
        for node in one_or_several(self._members.get(member)):
            said = _by_meaning(node, self._meanings) if isinstance(node, dict) else {}
            name = said.get(SC.name)
            if not isinstance(name, str) or not is_port_name(name) or name in taken:
                self.unread += 1
                continue
            taken.add(name)
            known = {meaning: value for meaning, value in said.items() if meaning in _SAID[member]}
            self.unread += len(node) - len(known)
            yield name, known

    def _terms(self, said: Mapping[IRI, Any], member: IRI) -> list[Term]:
        return _terms(said, member, self._meanings)

    def _iri(self, said: Mapping[IRI, Any], member: IRI) -> IRI | None:
        return next((one for one in self._terms(said, member) if isinstance(one, IRI)), None)


def stated_rate(affordance: Mapping[str, Any], meanings: TermMeanings) -> tuple[tuple[IRI, DescribedValue], ...]:
    """The rate (`sc:rate`) of a property, as a statement about its output; nothing if none is stated that is one."""
    (said, *_) = one_or_several(_by_meaning(affordance, meanings).get(SC.rate)) or (None,)
    members = _by_meaning(said, meanings) if isinstance(said, dict) else {}
    found = [(part.predicate, tuple(_terms(members, part.predicate, meanings)[:1])) for part in RATE.fields]
    if not all(part.kind.allows(one) for part, (_, some) in zip(RATE.fields, found, strict=True) for one in some):
        return ()
    return ((SC.rate, NestedNode(tuple(found))),) if all(some for _, some in found) else ()


def _by_meaning(node: Mapping[str, Any], meanings: TermMeanings) -> dict[IRI, Any]:
    """The members of a node that are terms of selfconf, by what they mean."""
    found = ((meanings.expanded(member), value) for member, value in node.items())
    return {meaning: value for meaning, value in found if meaning is not None and meaning in SC}


def _terms(said: Mapping[IRI, Any], member: IRI, meanings: TermMeanings) -> list[Term]:
    return [one for one in terms_of(member, said.get(member), meanings) if not isinstance(one, tuple)]
