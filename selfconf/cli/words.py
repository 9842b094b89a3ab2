"""Values as words: IRIs shortened by prefixes, configurations as text, JSON and Mermaid, refusals as one screen."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI, Literal, Term
from selfconf.search.whatif import Loss

_LOCAL = re.compile(r"[A-Za-z0-9_][\w.-]*")


class Names:
    """Shortens IRIs by the prefixes of a document."""

    def __init__(self, prefixes: Mapping[str, str]) -> None:
        self._prefixes = sorted(prefixes.items(), key=lambda item: -len(item[1]))

    def __call__(self, term: Term) -> str:
        """A CURIE where a prefix fits, else the term in full."""
        if isinstance(term, Literal):
            return f'"{term.lexical}"'
        for prefix, base in self._prefixes:
            if term.startswith(base) and _LOCAL.fullmatch(term[len(base) :]):
                return f"{prefix}:{term[len(base) :]}"
        return f"<{term}>" if isinstance(term, IRI) else str(term)


def configuration_text(configuration: Configuration, names: Names) -> str:
    """A configuration for people: who plays what, who feeds whom, what is set."""
    roles = [names(a.role) for a in configuration.assignments]
    width = max(map(len, roles), default=0)
    lines = [f"configured {names(configuration.template)}"]
    for role, assignment in zip(roles, configuration.assignments, strict=True):
        lines.append(f"  {role:<{width}}  {', '.join(map(names, assignment.components)) or '(nobody)'}")
    if configuration.connections:
        lines.append("connections")
        ends = [(f"{names(c.source)} {c.output}", f"{names(c.sink)} {c.input}") for c in configuration.connections]
        width = max(len(left) for left, _ in ends)
        lines += [f"  {left:<{width}}  ->  {right}" for left, right in ends]
    if configuration.bindings:
        lines.append("bindings")
        lines += [f"  {name} = {names(value)}" for name, value in configuration.bindings.items()]
    if configuration.settings:
        lines.append("parameters")
        lines += [f"  {names(s.component)} {s.name} = {names(s.value)}" for s in configuration.settings]
    return "\n".join(lines)


def configuration_body(configuration: Configuration) -> dict[str, Any]:
    """A configuration as JSON."""
    return {
        "template": configuration.template,
        "bindings": {name: plain(value) for name, value in configuration.bindings.items()},
        "roles": [{"role": a.role, "components": list(a.components)} for a in configuration.assignments],
        "connections": [
            {
                "from": {"component": c.source, "output": c.output},
                "to": {"component": c.sink, "input": c.input},
            }
            for c in configuration.connections
        ],
        "parameters": [
            {"component": s.component, "name": s.name, "value": plain(s.value)} for s in configuration.settings
        ],
    }


def mermaid(configuration: Configuration, names: Names) -> str:
    """A configuration as a Mermaid flow chart."""
    nodes = {component: f"c{number}" for number, component in enumerate(configuration.components)}
    lines = ["flowchart LR"]
    for component, node in nodes.items():
        role = configuration.role_of(component)
        lines.append(f'    {node}["{_quoted(names(component))}<br/><i>{_quoted(role.short if role else "")}</i>"]')
    for c in configuration.connections:
        label = _quoted(f"{c.output} → {c.input}")
        lines.append(f'    {nodes[c.source]} -->|"{label}"| {nodes[c.sink]}')
    return "\n".join(lines)


def _quoted(text: str) -> str:
    return text.replace("&", "&amp;").replace('"', "#quot;").replace("<", "&lt;").replace(">", "&gt;")


def losses_text(losses: Sequence[Loss], names: Names) -> str:
    """What would replace each component, for people; single points of failure stand out."""
    width = max((len(names(loss.component)) for loss in losses), default=0)
    lines = ["if it failed"]
    for loss in losses:
        instead = ", ".join(map(names, loss.started)) or "nobody needed"
        also = f", and {', '.join(map(names, loss.stopped))} would stop" if loss.stopped else ""
        fate = "NONE, a single point of failure" if loss.fatal else f"{instead}{also}"
        lines.append(f"  {names(loss.component):<{width}}  ->  {fate}")
    return "\n".join(lines)


def losses_body(losses: Sequence[Loss]) -> list[dict[str, Any]]:
    """What would replace each component, as JSON."""
    return [
        {
            "component": loss.component,
            "role": loss.role,
            "single_point_of_failure": loss.fatal,
            "started": list(loss.started),
            "stopped": list(loss.stopped),
        }
        for loss in losses
    ]


def refusal_text(refusal: Refusal, names: Names, most: int = 8) -> str:
    """A refusal on one screen, the most likely cause first."""
    lines = [f"no configuration for {names(refusal.template)}"]
    lines += [f"  because {reason}" for reason in refusal.reasons]
    if refusal.near_misses:
        lines.append("near misses")
        lines += [
            f"  {miss.role.short}: {names(miss.component)} would fit, but its {miss.obstacle}"
            if not miss.obstacle.startswith(("has ", "is ", "declares "))
            else f"  {miss.role.short}: {names(miss.component)} would fit, but it {miss.obstacle}"
            for miss in refusal.near_misses[:most]
        ]
        if len(refusal.near_misses) > most:
            lines.append(f"  and {len(refusal.near_misses) - most} more")
    repairs = repairs_of(refusal)
    if repairs:
        lines.append("what would mend it")
        lines += [f"  {repair['message']}" for repair in repairs]
    return "\n".join(lines)


def refusal_body(refusal: Refusal) -> dict[str, Any]:
    """A refusal as JSON."""
    return {
        "template": refusal.template,
        "reasons": [{"code": reason.code, "role": reason.role, "message": str(reason)} for reason in refusal.reasons],
        "near_misses": [
            {"role": miss.role, "component": miss.component, "obstacle": miss.obstacle} for miss in refusal.near_misses
        ],
        "repairs": repairs_of(refusal),
    }


def repairs_of(refusal: Refusal) -> list[dict[str, Any]]:
    """What would make the task feasible, as JSON objects with a code and a message."""
    repairs: list[dict[str, Any]] = [
        {"code": repair.code, "role": repair.role, "message": str(repair)} for repair in refusal.repairs
    ]
    if refusal.hint:
        repairs.append({"code": "reasoning", "message": refusal.hint})
    return repairs


def plain(value: Term) -> Any:
    """A term in JSON: IRIs and strings as text, numbers and truth values as such."""
    if isinstance(value, Literal):
        kind = value.datatype.rpartition("#")[2]
        try:
            if kind in ("integer", "int", "long"):
                return int(value.lexical)
            if kind in ("decimal", "double", "float"):
                return float(value.lexical)
        except ValueError:
            return value.lexical
        if kind == "boolean":
            return value.lexical in ("true", "1")
        return value.lexical
    return str(value)


def count(number: int, thing: str) -> str:
    """A number of things: `1 site`, `2 sites`."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table with aligned columns."""
    widths = [max(len(row[column]) for row in (head, *rows)) for column in range(len(head))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in (head, *rows)
    ]
    return "\n".join((lines[0], "  ".join("-" * width for width in widths), *lines[1:]))
