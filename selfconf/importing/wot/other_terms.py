"""What a thing, or one of its properties, events and actions, says in terms of other vocabularies.

It is kept as far as it is a literal or an IRI: a role looks at what is said of a component, `sc:accepts` at what is
said of an output.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.json_values import terms_of
from selfconf.model.term import IRI, Term
from selfconf.rdf.vocabulary import SC, TYPE


class OtherTerms:
    """Reads what nodes of one document say in terms of other vocabularies, and notes what of it is left out."""

    def __init__(self, meanings: TermMeanings, ledger: ImportLedger, source: SourceDocument) -> None:
        self._meanings, self._ledger, self._source = meanings, ledger, source

    def stated(
        self, node: Mapping[str, Any], known: Collection[str], read: Collection[IRI] = ()
    ) -> Iterator[tuple[IRI, Term]]:
        """The statements of a node; members that are `known`, and terms that are `read`, are those of other readers."""
        for member, value in node.items():
            if member in known or member.startswith("@"):
                continue
            predicate = self._meanings.expanded(member)
            if predicate in read:
                continue
            if predicate is None:
                self._leave_out(self._meanings.family(member), self._meanings.unknown())
            elif predicate in SC or predicate == TYPE:
                self._leave_out("terms of selfconf", "an import states those itself")
            else:
                for term in terms_of(member, value, self._meanings):
                    if isinstance(term, tuple):
                        self._leave_out(*term)
                    else:
                        yield predicate, term

    def _leave_out(self, what: str, reason: str) -> None:
        self._ledger.leave_out(what, reason, self._source)
