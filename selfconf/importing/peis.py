"""Component descriptions of the PEIS ecology (`.cmp`), which the program peisinit reads, as components.

A description is a sequence of `Key=value`. Its semantics is a list of eight parts: the type of the component, its name,
a description, its properties, two lists that are empty wherever there are any, its inputs and its outputs; the last two
are pairs of the name of a tuple and the type of its data. Many descriptions have a placeholder instead.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from selfconf.errors import AuthorError
from selfconf.importing.imported import ImportedComponent, ImportedDocument, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import absolute, stem
from selfconf.importing.sources import SourceDocument
from selfconf.model.profile import is_port_name
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.vocabulary import RDFS, SC, TYPE

KEYS = ("name", "id", "exec", "extraarguments", "initstate", "spawndelay", "semantics", "proxy")
_TOKEN = re.compile(r"""\s*(?:\#[^\n]*|(?P<single>[=,{}\[\]+])|(?P<quote>["'])|(?P<word>[^\s=,{}\[\]"'+]+))""")
_PART = re.compile(r'\s*(?:(?P<mark>[()])|"(?P<text>[^"]*)"|(?P<word>[^\s()"]+))')
_SEMANTICS = re.compile(r"^[^#\n]*?\b(?=semantics\s*=)", re.IGNORECASE | re.MULTILINE)
PARTS_OF_SEMANTICS = 8
"""The parts of a semantics: type, name, description, properties, two unknown ones, inputs, outputs."""
Part = str | list["Part"]


@dataclass(slots=True)
class _Scanner:
    """The tokens of a description, as peisinit tells them apart."""

    source: SourceDocument
    text: str
    position: int = 0

    def token(self) -> str | None:
        """The next token, or None at the end. A string in double quotes keeps them, one in single quotes loses them."""
        while True:
            found = _TOKEN.match(self.text, self.position)
            if found is None:
                return None
            self.position = found.end()
            if found["quote"]:
                return self._string(found["quote"])
            if found["single"] or found["word"]:
                return found["single"] or found["word"]

    def _string(self, quote: str) -> str:
        """A string up to the next quotation mark of either kind that has no backslash before it."""
        letters = ['"'] if quote == '"' else []
        start = self.position
        while self.position < len(self.text):
            letter = self.text[self.position]
            self.position += 1
            if letter == "\\" and self.position < len(self.text):
                letters.append(self.text[self.position])
                self.position += 1
            elif letter in "\"'":
                return "".join(letters) + ('"' if letter == '"' else "")
            else:
                letters.append(letter)
        raise self.mistake("a string has no end", start)

    def mistake(self, message: str, position: int | None = None) -> AuthorError:
        """An error at a position, or where the scanner is."""
        return self.source.mistake(message, self.position if position is None else position)


def import_peis(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The components that descriptions for peisinit have a semantics of."""
    for source in sources:
        try:
            fields = parse_fields(source)
            parts = parse_semantics(source, fields.get("semantics", ""))
        except AuthorError as error:
            ledger.unreadable(error)
            continue
        others = [key for key in fields if key not in ("name", "semantics")]
        if parts is None:
            reason = "their semantics is a placeholder, so they say nothing of what they are"
            ledger.leave_out("components", reason, source)
            continue
        if others:
            what = "settings of peisinit, such as Exec and SpawnDelay"
            ledger.leave_out(what, "an imported component is not started", source, len(others))
        component = _component(fields.get("name", ""), parts, source, ledger)
        yield ImportedDocument(stem(source), source.name, (component.described(),), _prefixes(component))


def parse_fields(source: SourceDocument) -> dict[str, str]:
    """The values of a description by their keys, in lower case. Raises AuthorError with line and column."""
    scanner, found = _Scanner(source, source.text()), dict[str, str]()
    while (key := scanner.token()) is not None:
        if key.lower() not in KEYS:
            raise scanner.mistake(f"{key[:40]!r} is no key of a PEIS component")
        if scanner.token() != "=":
            raise scanner.mistake(f"the key {key} is followed by '=' and its value")
        value = scanner.token()
        if value == "+":  # an identifier relative to that of peisinit
            value = scanner.token()
        if value is None:
            raise scanner.mistake(f"the key {key} has no value")
        found[key.lower()] = value
    return found


def parse_semantics(source: SourceDocument, text: str) -> list[Part] | None:
    """The parts of a semantics, or None for a placeholder. Raises AuthorError where its brackets do not fit."""
    if not text.strip() or re.fullmatch(r"\(\s*<[^()]*>\s*\)", text.strip()):
        return None
    stack: list[list[Part]] = [[]]
    for found in _PART.finditer(text):
        if found["mark"] == "(":
            inner: list[Part] = []
            stack[-1].append(inner)
            stack.append(inner)
        elif found["mark"] == ")":
            if len(stack) < 2:
                raise _mistake(source, "its semantics has a closing bracket too many")
            stack.pop()
        else:
            stack[-1].append(found["text"] if found["text"] is not None else found["word"])
    whole = stack[0][0] if len(stack) == 1 and len(stack[0]) == 1 else None
    if not isinstance(whole, list) or len(whole) != PARTS_OF_SEMANTICS:
        raise _mistake(source, f"its semantics is not one list of {PARTS_OF_SEMANTICS} parts in brackets")
    return None if whole[0] == "NoType" else whole


def _mistake(source: SourceDocument, message: str) -> AuthorError:
    """An error of the semantics of a source, at its key."""
    key = _SEMANTICS.search(source.text())
    return source.mistake(message, 0 if key is None else key.end())


def _component(name: str, parts: list[Part], source: SourceDocument, ledger: ImportLedger) -> ImportedComponent:
    kind = _kind(parts[0], source, ledger)
    for text in parts[1:3]:
        if isinstance(text, list) and text:
            ledger.leave_out("names and descriptions that are lists", "people are to read them", source)
    title = parts[1] if isinstance(parts[1], str) else ""
    called = name or title or stem(source)
    for unknown in parts[4:6]:
        if unknown:
            reason = "what they mean could not be established"
            ledger.leave_out("the fifth and sixth part of a semantics", reason, source)
    said = [(RDFS.comment, Literal(parts[2]))] if isinstance(parts[2], str) and parts[2] else []
    return ImportedComponent(
        ledger.names.component(ledger.minted(called), source),
        (kind or IRI.unchecked(ledger.namespace + "Component"),),
        labels=(Literal(title or called),),
        properties=(
            *said,
            *_properties(parts[3], source, ledger),
        ),
        inputs=tuple(_ports(parts[6], source, ledger)),
        outputs=tuple(_ports(parts[7], source, ledger)),
    )


def _kind(part: Part, source: SourceDocument, ledger: ImportLedger) -> IRI | None:
    """The type of a component, if it is one that the component may have."""
    found = absolute(part) if isinstance(part, str) else None
    if found is not None and found not in SC:
        return found
    what = "types that are no IRIs" if found is None else "types of selfconf"
    ledger.leave_out(what, "the component is of the class of all PEIS components", source)
    return None


def _pairs(part: Part, source: SourceDocument, ledger: ImportLedger) -> Iterator[tuple[str, str]]:
    for pair in part if isinstance(part, list) else [part] if part else []:
        match pair:
            case [str(first), str(second)] if first:
                yield first, second
            case _:
                ledger.leave_out("parts that are no pairs", "a property or port is a pair of strings", source)


def _properties(part: Part, source: SourceDocument, ledger: ImportLedger) -> Iterator[tuple[IRI, Term]]:
    for name, value in _pairs(part, source, ledger):
        predicate = absolute(name)
        if predicate is None:
            ledger.leave_out("properties that are no IRIs", "a property is an IRI", source)
        elif predicate in SC or predicate == TYPE:
            ledger.leave_out("terms of selfconf", "an import states those itself", source)
        else:
            yield predicate, absolute(value) or Literal(value)


def _ports(part: Part, source: SourceDocument, ledger: ImportLedger) -> Iterator[ImportedPort]:
    seen: set[str] = set()
    for name, kind in _pairs(part, source, ledger):
        iri = absolute(kind)
        if name in seen or not is_port_name(name):
            reason = "another port of the component has their name, or it ends in () or has control characters"
            ledger.leave_out("ports", reason, source)
            continue
        seen.add(name)
        if iri is None:
            ledger.leave_out(f"the type {kind[:40]!r}", "it is no IRI; the port is kept without one", source)
        yield ImportedPort(name, () if iri is None else (iri,))


def _prefixes(component: ImportedComponent) -> dict[str, str]:
    """A prefix for each ontology whose terms occur: `data` for `file:/Data.owl;#`."""
    types = [kind for port in (*component.inputs, *component.outputs) for kind in port.types]
    found = {}
    for iri in (*component.types, *(predicate for predicate, _ in component.properties), *types):
        base, hash_, _ = iri.rpartition("#")
        name = re.search(r"([A-Za-z][A-Za-z0-9]*)\.owl;?$", base)
        if hash_ and name is not None:
            found[name[1].lower()] = f"{base}#"
    return found
