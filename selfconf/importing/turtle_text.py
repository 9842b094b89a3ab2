"""Descriptions as Turtle for people: a block for each subject, a line for each port, and no prefix that is not used.

The text depends on the descriptions alone, so that what has not changed is written byte for byte as before.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from selfconf.importing.imported import DescribedValue, Description, ImportedDocument, NestedNode, TermList
from selfconf.model.term import IRI, BlankNode, Literal
from selfconf.rdf.vocabulary import PROV, RDFS, ROB, SC, TYPE, UNIT, XSD
from selfconf.render import Names

MARK = "# Imported by `selfconf import"
"""How a file begins that an import has written, and that importing again may replace."""
KNOWN_PREFIXES = {
    "sc": SC.base,
    "rob": ROB.base,
    "ros2": "https://w3id.org/selfconf/ros2#",
    "rdfs": RDFS.base,
    "sh": "http://www.w3.org/ns/shacl#",
    "xsd": XSD.base,
    "prov": PROV.base,
    "unit": UNIT.base,
    "td": "https://www.w3.org/2019/wot/td#",
    "tm": "https://www.w3.org/2019/wot/tm#",
}
WIDTH = 120
_PREFIX = re.compile(r"[A-Za-z](?:[A-Za-z0-9_-]*[A-Za-z0-9])?")
_STEP = "    "


def turtle(document: ImportedDocument, form: str) -> str:
    """The text of a file, with a first line that says what it was made from."""
    source = "".join(letter if letter.isprintable() else "?" for letter in document.source)
    return f"{MARK} {form}` from {source}; importing again replaces this file.\n\n{described_text(document)}"


def described_text(document: ImportedDocument) -> str:
    """The prefixes that a document needs, and the block of each of its descriptions."""
    writer = _Writer(document.prefixes)
    blocks = [writer.block(description) for description in document.descriptions]
    declared = "".join(f"@prefix {prefix}: <{base}> .\n" for prefix, base in writer.used())
    return "\n".join([declared, *blocks] if declared else blocks)


class _Writer:
    """Writes terms, and notes which prefixes they need."""

    def __init__(self, prefixes: Mapping[str, str]) -> None:
        known = set(KNOWN_PREFIXES.values())
        self.prefixes = {**KNOWN_PREFIXES}
        for prefix, base in sorted(prefixes.items()):
            if (not prefix or _PREFIX.fullmatch(prefix)) and base not in known and prefix not in KNOWN_PREFIXES:
                self.prefixes[prefix] = base
                known.add(base)
        self._names = Names(self.prefixes)
        self._used: set[str] = set()
        self._blanks: dict[BlankNode, str] = {}

    def used(self) -> Iterable[tuple[str, str]]:
        """The prefixes that were needed, in their order."""
        return ((prefix, base) for prefix, base in self.prefixes.items() if prefix in self._used)

    def block(self, description: Description) -> str:
        """The statements about one subject."""
        first, *rest = description.statements
        subject = self.flat(description.subject)
        lines = [f"{subject} {self.statement(first, _STEP, len(subject) + 1)}"]
        lines += [f"{_STEP}{self.statement(each, _STEP)}" for each in rest]
        return " ;\n".join(lines) + " .\n"

    def statement(self, statement: tuple[IRI, Sequence[DescribedValue]], indent: str, before: int = 0) -> str:
        """A predicate with its values: on its line if there is room, else each value on a line of its own."""
        predicate, values = statement
        name = "a" if predicate == TYPE else self.flat(predicate)
        flat = f"{name} {', '.join(map(self.flat, values))}"
        several = len(values) > 1 and any(isinstance(value, NestedNode) for value in values)
        if max(len(indent), before) + len(flat) + 2 <= WIDTH and not several:
            return flat
        deeper = indent + _STEP
        return f"{name}\n{deeper}" + f" ,\n{deeper}".join(self.value(value, deeper) for value in values)

    def value(self, value: DescribedValue, indent: str) -> str:
        """A value at the beginning of a line: a node that is too long for the line on several."""
        flat = self.flat(value)
        if not isinstance(value, NestedNode) or len(indent) + len(flat) + 2 <= WIDTH:
            return flat
        deeper = indent + _STEP
        inside = f" ;\n{deeper}".join(self.statement(each, deeper) for each in value.statements)
        return f"[\n{deeper}{inside}\n{indent}]"

    def flat(self, value: DescribedValue) -> str:
        """A value without a line break."""
        if isinstance(value, NestedNode):
            said = (
                (("a" if p == TYPE else self.flat(p)), ", ".join(map(self.flat, each))) for p, each in value.statements
            )
            return (
                f"[ {' ; '.join(f'{predicate} {values}' for predicate, values in said)} ]" if value.statements else "[]"
            )
        if isinstance(value, TermList):
            return f"( {' '.join(map(self.flat, value.members))} )" if value.members else "()"
        if isinstance(value, BlankNode):
            return self._blanks.setdefault(value, f"_:n{len(self._blanks) + 1}")
        return value.turtle(self._iri) if isinstance(value, Literal) else self._iri(value)

    def _iri(self, iri: IRI) -> str:
        name = self._names(iri)
        if name.startswith("<") or not name.isascii():
            return f"<{iri}>"
        self._used.add(name.partition(":")[0])
        return name
