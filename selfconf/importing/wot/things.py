"""Thing Descriptions and Thing Models as components.

A description has an `id`, or gets a name from its title; a model is imported as the component that it is a model of,
with what `tm:ref` takes from the same document. The two differ in their `@type` only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from itertools import groupby
from typing import Any

from selfconf.errors import AuthorError
from selfconf.importing.imported import ImportedComponent, ImportedDocument
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import absolute, stem
from selfconf.importing.pages import COLLECTION
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.affordances import AffordanceReader
from selfconf.importing.wot.contexts import TermMeanings, spoken
from selfconf.importing.wot.json_text import one_or_several, parse_json
from selfconf.importing.wot.other_terms import OtherTerms
from selfconf.importing.wot.own_terms import OWN_TERMS, OwnTerms
from selfconf.importing.wot.thing_models import ModelReferences
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import RDFS, SC

NO_THINGS = "documents that describe no thing"
"""What is left out where something stands in place of a thing, in words."""
THING = IRI("https://www.w3.org/2019/wot/td#Thing")
AFFORDANCES = ("properties", "events", "actions")
_UNUSED = {
    "forms": ("forms", "they say how a thing is reached, an advertisement says what it is"),
    "security": ("security", "who may do what is not said by an advertisement"),
    "securityDefinitions": ("security", "who may do what is not said by an advertisement"),
    "links": ("links", "an advertisement speaks of its component alone"),
    "schemaDefinitions": ("data schemas", "a signal type stands for what a signal consists of"),
    "uriVariables": ("URI variables", "a port has none"),
    "tm:optional": ("marks of affordances that a thing may lack", "a component has all that it advertises"),
    **dict.fromkeys(
        ("version", "created", "modified", "support", "base", "profile", "tm:required"),
        ("facts about the document, such as its version", "an advertisement has no place for them"),
    ),
}
"""The members of things that have no counterpart, in words, and why not."""
_KNOWN = {"id", "title", "titles", "description", "descriptions", *AFFORDANCES, *_UNUSED}


@immutable
class DescribedThing:
    """A thing: the component that it is, and its description, completed by what its references lead to."""

    component: ImportedComponent
    description: dict[str, Any]
    source: SourceDocument = field(compare=False)
    prefixes: Mapping[str, str]
    """The prefixes that the document declares."""


def import_things(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The things that JSON documents describe: each holds one, or several, as a directory answers with.

    The pages of a directory are one document: a thing may come to another page, or a page be gone, by the next import.
    """
    for _, group in groupby(described_things(sources, ledger), lambda thing: id(thing.source.whole)):
        things = list(group)
        source = things[0].source.whole
        prefixes = {prefix: base for thing in things for prefix, base in thing.prefixes.items()}
        descriptions = tuple(thing.component.described() for thing in things)
        yield ImportedDocument(stem(source), source.name, descriptions, prefixes)


def described_things(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[DescribedThing]:
    """The things that JSON documents describe, one document after the other."""
    parsed: list[tuple[SourceDocument, Any]] = []
    for source in sources:
        try:
            found = parse_json(source)
        except AuthorError as error:
            ledger.unreadable(error)
            continue
        parsed.append((source, found.value))
        for name in found.repeated:
            ledger.leave_out(f"earlier values of {name[:40]!r}", "a JSON object has each name once", source)
    references = ModelReferences({source.name: value for source, value in parsed}, ledger)
    for source, value in parsed:
        yield from _things(value, source, ledger, references)


def _things(
    value: Any, source: SourceDocument, ledger: ImportLedger, references: ModelReferences
) -> Iterator[DescribedThing]:
    things = _listed(value)
    if not things:
        ledger.leave_out("empty documents", "there is no thing in them", source)
    for number, thing in enumerate(things, 1):
        if not isinstance(thing, dict) or not _describes_a_thing(thing):
            ledger.leave_out(NO_THINGS, "they have neither a title nor an affordance", source)
            continue
        meanings = TermMeanings(thing.get("@context"))
        position = (str(number),) if len(things) > 1 else ()
        whole = references.resolved(thing, source)
        component = _ThingReader(whole, meanings, source, ledger).component(position)
        yield DescribedThing(component, whole, source, meanings.prefixes)


def _listed(value: Any) -> list[Any]:
    """The things of a document: those of an array or of a collection, or the one that it describes."""
    if isinstance(value, dict) and COLLECTION in one_or_several(value.get("@type")):
        value = value.get("members", [])
    return value if isinstance(value, list) else [value]


def _describes_a_thing(thing: dict[str, Any]) -> bool:
    return any(member in thing for member in ("title", "titles", "securityDefinitions", *AFFORDANCES))


class _ThingReader:
    """Reads one thing."""

    def __init__(
        self, thing: dict[str, Any], meanings: TermMeanings, source: SourceDocument, ledger: ImportLedger
    ) -> None:
        self.thing, self.meanings, self.source, self.ledger = thing, meanings, source, ledger
        self.own_terms = OwnTerms(thing, meanings)
        self.affordances = AffordanceReader(meanings, ledger, source)
        self.other_terms = OtherTerms(meanings, ledger, source)

    def component(self, position: tuple[str, ...]) -> ImportedComponent:
        ports = list(self.affordances.ports(self.thing))
        types = dict.fromkeys((THING, *self.affordances.types(self.thing, "thing")))
        of_selfconf = [kind for kind in types if kind in SC]
        for kind in of_selfconf:
            del types[kind]
        others = len(of_selfconf) - (SC.Component in of_selfconf)  # every component is said to be one
        self.ledger.leave_out("types of selfconf", "an import states those itself", self.source, others)
        for member, (what, why) in _UNUSED.items():
            if member in self.thing:
                self.ledger.leave_out(what, why, self.source)
        inputs = [port for kind, port in ports if kind == "input"]
        operations = list(self.affordances.operations(self.thing))
        own = self.own_terms
        found = ImportedComponent(
            self.ledger.names.component(self._iri(position), self.source),
            tuple(types),
            labels=self._words("title"),
            properties=(
                *((RDFS.comment, words) for words in self._words("description")),
                *self.other_terms.stated(self.thing, _KNOWN, OWN_TERMS),
            ),
            inputs=(*inputs, *own.inputs({port.name for port in inputs})),
            outputs=tuple(port for kind, port in ports if kind == "output"),
            parameters=tuple(own.parameters()),
            operations=(*operations, *own.operations(SC.hasOperation, {each.name for each in operations})),
            needs=tuple(own.operations(SC.needsOperation)),
        )
        if own.unread:
            what = "what else is said of inputs, operations and parameters in the terms of selfconf"
            reason = "each has a name of its own and types, and an input its unit and whether it is optional"
            self.ledger.leave_out(what, reason, self.source, own.unread)
        return found

    def _iri(self, position: tuple[str, ...]) -> IRI:
        for member in ("id", "@id"):
            said = self.thing.get(member)
            if isinstance(said, str) and (found := absolute(said)) is not None and "{{" not in said:
                return found
            if member in self.thing:
                self.ledger.leave_out("identifiers that are no absolute IRIs", "the thing is named here", self.source)
        return self.ledger.minted(stem(self.source).replace("/", "-"), *position)

    def _words(self, member: str) -> tuple[Literal, ...]:
        """A title or description, in its languages; by itself, unless it is that of one of them."""
        several, words = self.thing.get(f"{member}s"), self.thing.get(member)
        found = several if isinstance(several, dict) else {}
        all_words = (words, *found.values()) if found is several or several is None else (words, several)
        if not_text := sum(not isinstance(one, str) for one in all_words if one is not None):
            self.ledger.leave_out(f"{member}s that are no text", "people are to read them", self.source, not_text)
        said = [spoken(one, language) for language, one in found.items() if isinstance(one, str) and one]
        if isinstance(words, str) and words and all(one.lexical != words for one in said):
            said.insert(0, spoken(words, self.meanings.language))
        return tuple(said)
