"""Statements that are recognised without parsing: by patterns that are made from the table of fields.

Each pattern accepts less than the table allows, never more; what is not recognised is left to the careful reader.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal
from typing import NamedTuple

from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf import turtle
from selfconf.rdf.advertisements.fields import COMPONENT, GROUNDING, NEXT, PORT_NAME, PORTS, Field
from selfconf.rdf.vocabulary import RDF, SC, XSD

SUBJECT = IRI("urn:selfconf:component")
"""The component that a statement is read for: its part of a profile is the same for all."""
_SIMPLE = re.compile(
    r"<(?P<predicate>[^<>]*)> (?:"
    r"<(?P<iri>[^<>]*)>"
    r'|"(?P<lexical>[^"\\]*)"(?:\^\^<(?P<datatype>[^<>]*)>|@(?P<language>[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*))?'
    r"|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<decimal>[+-]?[0-9]*\.[0-9]+)"
    r")"
)
_KINDS = r"a <[^<>]*>(?: , <[^<>]*>)*"
_VALUE = r'(?:<[^<>]*>|"[^"\\]*"(?:\^\^<[^<>]*>|@[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*)?|[+-]?[0-9]+|[+-]?[0-9]*\.[0-9]+)'


class _PortPattern(NamedTuple):
    """What is recognised of the ports, or operational parameters, that one predicate links to."""

    once: tuple[str, ...]
    """How the fields begin in Turtle that have exactly one value."""
    bounded: tuple[tuple[str, int, float], ...]
    """How the other fields begin, and how often they may be there."""
    pattern: re.Pattern[str]
    groups: tuple[int, int, int]
    """Which groups of the pattern are the name, the type, and the number of the rate."""

    @classmethod
    def of(cls, link: Field) -> _PortPattern:
        """The pattern from the table."""
        fields = link.into.fields
        allowed = [field.turtle for field in fields if field.most != 0]
        if not any(field.into.fields for field in fields if field.most != 0):
            allowed.append(f"(?P<{SC.value.short}>(?!))")  # there is no rate: a group that matches nothing
        statement = f"(?:{_KINDS}|{'|'.join(allowed)}|<[^<>]*> {_VALUE})"
        pattern = re.compile(rf"<{link.predicate}> \[ (?:{statement}(?:{NEXT}| (?=\])))+\]")
        (kind,) = (field.predicate for field in fields if field.least and field is not PORT_NAME)
        name, type_, rate = (pattern.groupindex[predicate.short] for predicate in (SC.name, kind, SC.value))
        return cls(
            tuple([f"<{f.predicate}> " for f in fields if (f.least, f.most) == (1, 1)]),
            tuple(
                [
                    (f"<{f.predicate}> ", f.least, math.inf if f.most is None else f.most)
                    for f in fields
                    if (f.least, f.most) != (1, 1)
                ]
            ),
            pattern,
            (name, type_, rate),
        )


_RATED = f"<{SC.rate}> "
_PORTS = {f"<{link.predicate}>": _PortPattern.of(link) for link in PORTS}
_PREFERENCE = re.compile(COMPONENT[SC.preference].turtle)
_COMMAND = re.compile(rf"<{SC.grounding}> \[ (?:{_KINDS}{NEXT})?{GROUNDING[SC.command].turtle} \]")


def port_of(link: str, text: str) -> tuple[str, str, str | None] | None:
    """Name, type and number of the rate of the port in a statement, if it has one port in order and of a common form.

    Each field has to be there as often as the table says, and its value has to be recognised. To count the predicates
    in the text is enough: one in a string or in brackets would count too, and the statement would be read carefully.
    """
    known = _PORTS.get(link)
    if known is None:
        return None
    once, bounded, pattern, groups = known
    for mark in once:
        if text.count(mark) != 1:
            return None
    for mark, least, most in bounded:
        if not least <= text.count(mark) <= most:
            return None
    found = pattern.fullmatch(text)
    if found is None:
        return None
    name, type_, rate = found.group(*groups)
    return None if name is None or type_ is None or (rate is None and _RATED in text) else (name, type_, rate)


def ported(link: str, name: str, kind: str, rate: str | None) -> Profile:
    """The part of a statement with one port."""
    type_ = IRI(kind)
    if link == f"<{SC.hasInput}>":
        return Profile(SUBJECT, ports=Ports(inputs=(Input(name, type_),)))
    if link == f"<{SC.hasOutput}>":
        return Profile(SUBJECT, ports=Ports(outputs=(Output(name, type_, None if rate is None else float(rate)),)))
    return Profile(SUBJECT, parameters=(OperationalParameter(name, type_),))


def setting_of(text: str) -> Profile | None:
    """The part of a statement with a preference or a command, in order and of a common form."""
    command = _COMMAND.fullmatch(text)
    if command is not None:
        return Profile(SUBJECT, command=command["command"])
    preference = _PREFERENCE.fullmatch(text)
    return None if preference is None else Profile(SUBJECT, preference=Decimal(preference["preference"]))


def property_of(text: str) -> tuple[IRI, Term] | None:
    """The property that a statement with one object of a common form states."""
    found = _SIMPLE.fullmatch(text)
    if found is None:
        return None
    predicate, iri, lexical, datatype, language, integer, decimal = found.groups()
    value: Term
    if iri is not None:
        value = turtle.resource(iri)
    elif lexical is None:
        value = Literal(integer, XSD.integer) if integer else Literal(decimal, XSD.decimal)
    elif language:
        value = Literal(lexical, RDF.langString, language)
    else:
        value = Literal(lexical, IRI(datatype) if datatype else STRING)
    return IRI(predicate), value
