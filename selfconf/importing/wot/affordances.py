"""The properties, events and actions of a thing as ports and operations.

A property that can be read, and an event, is an output; a property that can be written is an input that may stay
unfed, because the thing does not wait until it is written; an action is an operation. The `@type`s of an
affordance are its signal types. One without any is kept: an interaction can name it. What it says in terms of other
vocabularies is said of the port or operation. A property and an event may have one name, two outputs may not
(`event_ports`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from selfconf.importing.imported import ImportedOperation, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument
from selfconf.importing.units import unit_of
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.json_text import one_or_several
from selfconf.importing.wot.other_terms import OtherTerms
from selfconf.importing.wot.own_terms import stated_rate
from selfconf.model.immutable import replace
from selfconf.model.profile import is_port_name
from selfconf.model.term import IRI
from selfconf.rdf.vocabulary import SC, XSD

W3C = "https://www.w3.org/2019/wot/"
"""What the W3C's own classes begin with: they say what kind of affordance it is, not what kind of signal."""
READS, WRITES = frozenset(("readproperty", "observeproperty")), frozenset(("writeproperty",))
_UNUSED = {
    "forms": ("forms", "they say how a thing is reached, an advertisement says what it is"),
    "uriVariables": ("URI variables", "a port has none"),
    "subscription": ("data of subscriptions and cancellations", "an input that follows an output says nothing to it"),
    "cancellation": ("data of subscriptions and cancellations", "an input that follows an output says nothing to it"),
    "dataResponse": ("responses to events", "an output hears no answer"),
    **dict.fromkeys(
        ("observable", "safe", "idempotent", "synchronous"),
        ("marks of affordances, such as observable", "they say how one is used, an advertisement says what it is"),
    ),
}
"""The members of affordances that have no counterpart, in words, and why not."""
_WORDS = ("title", "titles", "description", "descriptions")
_SCHEMA = (
    "type", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "multipleOf", "minLength", "maxLength",
    "pattern", "enum", "const", "default", "oneOf", "items", "minItems", "maxItems", "properties", "required", "format",
    "contentEncoding", "contentMediaType",
)  # fmt: skip
_DATA = {*_SCHEMA, *_WORDS, "unit", "readOnly", "writeOnly"}
"""The members of data schemas, those of properties included."""
_KNOWN = {*_DATA, *_UNUSED, "data", "input", "output"}
"""The members of affordances."""


class AffordanceReader:
    """Reads the affordances of one thing."""

    def __init__(self, meanings: TermMeanings, ledger: ImportLedger, source: SourceDocument) -> None:
        self.meanings, self.ledger, self.source = meanings, ledger, source
        self.other_terms = OtherTerms(meanings, ledger, source)

    def types(self, holder: Any, what: str = "port") -> tuple[IRI, ...]:
        """The IRIs of the `@type` of something, each once; what is unknown is noted."""
        found: dict[IRI, None] = {}
        for term in one_or_several(holder.get("@type") if isinstance(holder, dict) else None):
            if not isinstance(term, str):
                self._leave_out("types that are no strings", "a type is a term of some vocabulary")
                continue
            iri = self.meanings.expanded(term)
            if iri is None:
                self._leave_out(self.meanings.family(term), self.meanings.unknown())
            elif what == "port" and (other := _other_kind(iri)) is not None:
                self._leave_out(*other)
            else:
                found[iri] = None
        return tuple(found)

    def ports(self, thing: dict[str, Any]) -> Iterator[tuple[str, ImportedPort]]:
        """The ports of a thing, each with whether it is an `input` or an `output`."""
        for name, affordance in self._affordances(thing, "properties"):
            others = tuple(self.other_terms.stated(affordance, _KNOWN, (SC.rate,)))
            port = ImportedPort(name, self.types(affordance), self._unit(affordance), properties=others)
            self._note_schema(affordance)
            reads, writes = _operations(affordance)
            if reads:
                rate = stated_rate(affordance, self.meanings)
                if not rate and any(self.meanings.expanded(member) == SC.rate for member in affordance):
                    self._leave_out("rates that promise nothing", "a rate is a number above zero, of unit:HZ")
                yield "output", replace(port, properties=(*rate, *others))
            if writes:
                yield "input", replace(port, optional=True)
            if not reads and not writes:
                self._leave_out("properties that can be neither read nor written", "there is nothing to connect")
        names = event_ports(thing)
        for name, affordance in self._affordances(thing, "events"):
            data = affordance.get("data")
            signal: dict[str, Any] = data if isinstance(data, dict) else {}
            self._note_schema(signal)
            kinds = self.types(affordance) or self.types(signal)
            if SC.Failure in kinds:
                continue  # every component can fail
            others = *self.other_terms.stated(affordance, _KNOWN), *self.other_terms.stated(signal, _DATA)
            yield "output", ImportedPort(names[name], kinds, self._unit(signal), properties=others)

    def operations(self, thing: dict[str, Any]) -> Iterator[ImportedOperation]:
        """The actions of a thing."""
        for name, affordance in self._affordances(thing, "actions"):
            request, response = affordance.get("input"), affordance.get("output")
            for schema in (request, response):
                if isinstance(schema, dict):
                    self._note_schema(schema)
                    if "unit" in schema:
                        self._leave_out("units of actions", "a request or response has no unit")
                    if number := sum(1 for _ in self.other_terms.stated(schema, _DATA)):
                        what = "values of other vocabularies at requests and responses"
                        self._leave_out(what, "an operation states their types alone", number)
            asked = self.types(request) or self.types(affordance)  # a command of that kind is what is asked for
            answered, others = self._one(self.types(response)), tuple(self.other_terms.stated(affordance, _KNOWN))
            yield ImportedOperation(name, self._one(asked), answered, properties=others)

    def _one(self, types: tuple[IRI, ...]) -> IRI | None:
        if len(types) > 1:
            self._leave_out("further types of requests and responses", "an operation has one of each", len(types) - 1)
        return types[0] if types else None

    def _affordances(self, thing: dict[str, Any], kind: str) -> Iterator[tuple[str, dict[str, Any]]]:
        found = thing.get(kind, {})
        if not isinstance(found, dict):
            self._leave_out(f"{kind} that are no object", "a description has them by their names")
            return
        for name, affordance in found.items():
            if not is_port_name(name) or not isinstance(affordance, dict):
                reason = "a port or operation has a name, which has no control characters and does not end in ()"
                self._leave_out(f"{kind} without a name, or that are no object", reason)
                continue
            for member, (what, why) in _UNUSED.items():
                if member in affordance:
                    self._leave_out(what, why, len(one_or_several(affordance[member])))
            if any(member in affordance for member in _WORDS):
                self._leave_out("titles and descriptions of affordances", "their names are kept")
            yield name, affordance

    def _unit(self, schema: dict[str, Any]) -> IRI | None:
        spelling = schema.get("unit")
        if spelling is None:
            return None
        if not isinstance(spelling, str):
            self._leave_out("units that are no strings", "a unit is one word or IRI")
            return None
        found = unit_of(spelling) or unit_of(self.meanings.expanded(spelling) or "")
        if found is None:
            self._leave_out(f"the unit {spelling[:40]!r}", "it is not in the table of spellings; see docs/from-wot.md")
        return found

    def _note_schema(self, schema: dict[str, Any]) -> None:
        if any(member in schema for member in _SCHEMA):
            self._leave_out("data schemas", "a signal type stands for what a signal consists of")

    def _leave_out(self, what: str, reason: str, number: int = 1) -> None:
        self.ledger.leave_out(what, reason, self.source, number)


def event_ports(thing: Mapping[str, Any]) -> dict[str, str]:
    """The name of the output that each event of a thing is: its own, or `event NAME` where a property has that."""
    properties, events = (
        found if isinstance(found := thing.get(kind), dict) else {} for kind in ("properties", "events")
    )
    taken, ports = {*properties, *events}, {}
    for event in events:
        name = event
        if event in properties:
            while name in taken:
                name = f"event {name}"
            taken.add(name)
        ports[event] = name
    return ports


def _other_kind(iri: IRI) -> tuple[str, str] | None:
    """What a type of a port is that is no kind of signal, and why it is left out; None if it may be one."""
    if iri.startswith(W3C):
        return "types of the W3C's vocabulary", "they say what kind of affordance it is, not what kind of signal"
    if iri in XSD:
        return "datatypes as types", "they say how a value is written; by them a current would feed a voltage"
    return None


def _operations(affordance: dict[str, Any]) -> tuple[bool, bool]:
    """Whether a property can be read, and whether it can be written.

    Where each of its forms says for what it is, that counts too: a form without `op` is for both.
    """
    reads, writes = affordance.get("writeOnly") is not True, affordance.get("readOnly") is not True
    forms = [form for form in one_or_several(affordance.get("forms")) if isinstance(form, dict)]
    if forms and all("op" in form for form in forms):
        said = {operation for form in forms for operation in one_or_several(form["op"]) if isinstance(operation, str)}
        reads, writes = reads and bool(said & READS), writes and bool(said & WRITES)
    return reads, writes
