"""Statements that are recognised without parsing: by patterns that are made from the table of fields.

Each pattern accepts less than the table allows, never more; what is not recognised is left to the careful reader.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf import turtle
from selfconf.rdf.permitted_fields import (
    COMPONENT,
    GROUNDING,
    NEXT,
    OF_COMPONENT,
    PARAMETER_TYPE,
    PORTS,
    SAID_BY,
    SETTINGS,
    SIGNAL_TYPE,
    Field,
)
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
_HAS_INPUT, _HAS_OUTPUT = f"<{SC.hasInput}>", f"<{SC.hasOutput}>"
_RARE = frozenset((SC.unit, SC.frame, SC.optional, SC.accepts))
"""What few ports say of themselves: it is read carefully."""
_KINDS = r"a <[^<>]*>(?: , <[^<>]*>)*"
_VALUE = r'(?:<[^<>]*>|"[^"\\]*"(?:\^\^<[^<>]*>|@[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*)?|[+-]?[0-9]+|[+-]?[0-9]*\.[0-9]+)'


class _PortPattern(NamedTuple):
    """What is recognised of the ports, or operational parameters, that one predicate links to."""

    once: tuple[str, ...]
    """How the fields begin in Turtle that have exactly one value."""
    at_most_once: tuple[str, ...]
    """How the other fields begin that are recognised."""
    pattern: re.Pattern[str]
    groups: tuple[int, int, int, int]
    """Which groups of the pattern are the name, the type, the number of the rate, and the depth."""

    @classmethod
    def of(cls, link: Field) -> _PortPattern:
        """The pattern from the table: with one type, and none of the fields that few ports have."""
        fields = [field for field in link.into.fields if field.most != 0 and field.predicate not in _RARE]
        (kind,) = (field.predicate for field in fields if field in (SIGNAL_TYPE, PARAMETER_TYPE))
        allowed = [field.turtle for field in fields]
        groups = SC.name.short, kind.short, SC.value.short, SC.depth.short
        there = "".join(allowed)  # where there is no rate or no depth, a group for it matches nothing
        allowed += [f"(?P<{group}>(?!))" for group in groups if f"(?P<{group}>" not in there]
        known = sorted(link.into.predicates.union(OF_COMPONENT, SAID_BY))
        others = f"<(?!(?:{'|'.join(known)})>)[^<>]*> {_VALUE}"
        statement = f"(?:{_KINDS}|{'|'.join(allowed)}|{others})"
        pattern = re.compile(rf"<{link.predicate}> \[ (?:{statement}(?:{NEXT}| (?=\])))+\]")
        name, type_, rate, depth = (pattern.groupindex[group] for group in groups)
        once = [f"<{predicate}> " for predicate in (SC.name, kind)]
        begin = [f"<{field.predicate}> " for field in fields]
        return cls(
            tuple(once), tuple([mark for mark in begin if mark not in once]), pattern, (name, type_, rate, depth)
        )


_PORTS = {f"<{link.predicate}>": _PortPattern.of(link) for link in PORTS}
_SETTINGS = {
    f"<{predicate}>": (re.compile(COMPONENT[predicate].turtle), setting) for predicate, setting in SETTINGS.items()
}
"""Of the fields of a component that say one thing: their pattern, and how a profile holds the value."""
_COMMAND = re.compile(rf"<{SC.grounding}> \[ (?:{_KINDS}{NEXT})?{GROUNDING[SC.command].turtle} \]")


class PortText(NamedTuple):
    """What the text of a port says, as text."""

    name: str
    type: str
    rate: str | None
    depth: str | None


def port_of(link: str, text: str) -> PortText | None:
    """What the port in a statement says, if it has one port in order and of a common form.

    Each field has to be there as often as the table says, and its value has to be recognised. To count the predicates
    in the text is enough: one in a string or in brackets would count too, and the statement would be read carefully.
    """
    known = _PORTS.get(link)
    if known is None:
        return None
    once, at_most_once, pattern, groups = known
    # Loops, since this runs for each statement of each file that is not known yet.
    for mark in once:
        if text.count(mark) != 1:
            return None
    for mark in at_most_once:
        if text.count(mark) > 1:
            return None
    found = pattern.fullmatch(text)
    if found is None:
        return None
    name, type_, rate, depth = found.group(*groups)
    if name is None or type_ is None:  # a string says what was counted
        return None
    return PortText(name, type_, rate, depth)


def ported(link: str, port: PortText) -> Profile | Ports:
    """The part of a statement with one port."""
    name, type_ = port.name, IRI.unchecked(port.type)
    if link == _HAS_INPUT:
        return Ports((Input(name, (type_,), None if port.depth is None else int(port.depth)),))
    if link == _HAS_OUTPUT:
        return Ports((), (Output(name, (type_,), None if port.rate is None else float(port.rate)),))
    return Profile(SUBJECT, parameters=(OperationalParameter(name, type_),))


def setting_of(predicate: str, text: str) -> Profile | None:
    """The part of a statement with a preference, a command or another setting, in order and of a common form."""
    if predicate not in _SETTINGS:
        command = _COMMAND.fullmatch(text)
        return None if command is None else Profile(SUBJECT, command=command["command"])
    pattern, setting = _SETTINGS[predicate]
    found = pattern.fullmatch(text)
    if found is None:
        return None
    value: dict[str, Any] = {setting.member: setting.value(found.group(1), XSD.decimal)}
    return Profile(SUBJECT, **value)


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
        value = Literal(lexical, IRI.unchecked(datatype) if datatype else STRING)
    return IRI.unchecked(predicate), value
