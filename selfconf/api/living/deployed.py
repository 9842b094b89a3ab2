"""A deployed configuration, read from the Turtle that its configurator serves: also what was passed over, replaced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC
from selfconf.render import value_body


def deployed_body(document: Document) -> dict[str, Any] | None:
    """The configuration of a document as JSON, with role, component and port names; None if it holds none."""
    name = next(iter(document.instances(SC.Configuration)), None)
    if name is None:
        return None
    roles: dict[str, list[str]] = {}
    passed_over: dict[str, list[str]] = {}
    replaced: dict[str, str] = {}
    for node in document.values(name, SC.assignment):
        role, component = str(document.value(node, SC.role)), str(document.value(node, SC.component))
        roles.setdefault(role, []).append(component)
        passed_over[role] = [str(other) for other in document.values(node, SC.passedOver)]
        before = document.value(node, SC.replaces)
        if before is not None:
            replaced[component] = str(before)
    return {
        "template": str(document.value(name, SC.template)),
        "inside_of": _text(document, name, SC.insideOf) or None,
        "roles": [
            {"role": role, "components": components, "passed_over": passed_over[role]}
            for role, components in roles.items()
        ],
        "recruits": [str(component) for component in document.values(name, SC.recruited)],
        "connections": [
            {
                "from": {"component": _text(document, node, SC["from"]), "output": _text(document, node, SC.output)},
                "to": {"component": _text(document, node, SC.to), "input": _text(document, node, SC.input)},
            }
            for node in document.values(name, SC.connection)
        ],
        "bindings": {
            _parameter_name(document, node): _value(document.value(node, SC.value))
            for asked in document.values(name, SC.task)
            for node in document.values(asked, SC.binding)
        },
        "parameters": [
            {
                "component": _text(document, node, SC.component),
                "name": _text(document, node, SC.name),
                "value": _value(document.value(node, SC.value)),
            }
            for node in document.values(name, SC.setting)
        ],
        "replaced": replaced,
    }


def passed_over(body: Mapping[str, Any]) -> dict[str, list[str]]:
    """By role of a configuration as JSON, the candidates that go before those that were chosen."""
    return {role["role"]: role["passed_over"] for role in body["roles"]}


def _text(document: Document, node: Term, predicate: IRI) -> str:
    value = document.value(node, predicate)
    return "" if value is None else value.lexical if isinstance(value, Literal) else str(value)


def _parameter_name(document: Document, binding: Term) -> str:
    """The name of the parameter of a binding; of a record that does not state it, the local name of its IRI."""
    parameter = document.value(binding, SC.parameter)
    return _text(document, binding, SC.name) or (parameter.short if isinstance(parameter, IRI) else "")


def _value(value: Term | None) -> object:
    return None if value is None else value_body(value)


def connected(document: Document) -> Iterator[tuple[IRI, IRI]]:
    """Yield which component feeds which in the configuration of a document."""
    for node in document.instances(SC.Connection):
        for source in document.values(node, SC["from"]):
            for sink in document.values(node, SC.to):
                if isinstance(source, IRI) and isinstance(sink, IRI):
                    yield source, sink
