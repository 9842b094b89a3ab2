"""Values as words: IRIs shortened by prefixes, configurations as text, JSON and Mermaid, refusals as one screen."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.optimum import Optimum
from selfconf.model.partition import NearMiss
from selfconf.model.profile import Place
from selfconf.model.refusal import InputUnfed, Reason, Refusal, Undecided
from selfconf.model.relaxation import AcceptNearMiss, Relaxation
from selfconf.model.term import IRI, Literal, Term

Where = Callable[[IRI], Place | None]
"""Where a role or component is spoken of, if that is known."""
_LOCAL = re.compile(r"[A-Za-z0-9_][\w.-]*")


class Names:
    """Shortens IRIs by the prefixes of a document."""

    def __init__(self, prefixes: Mapping[str, str]) -> None:
        self._prefixes = sorted(prefixes.items(), key=lambda item: -len(item[1]))

    def __call__(self, term: Term) -> str:
        """As Turtle writes it: a CURIE where a prefix fits, a number as such, a string in quotes."""
        if isinstance(term, Literal):
            return term.turtle(self)
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


def losses_text(losses: Sequence[Consequence], names: Names) -> str:
    """What would replace each component, for people; single points of failure stand out."""
    width = max((len(names(loss.component)) for loss in losses), default=0)
    lines = ["if it failed"]
    lines += [f"  {names(loss.component):<{width}}  ->  {loss.told(names)}" for loss in losses]
    return "\n".join(lines)


def losses_body(losses: Sequence[Consequence]) -> list[dict[str, Any]]:
    """What would replace each component, as JSON."""
    return [
        {
            "component": loss.component,
            "role": loss.role,
            "single_point_of_failure": loss.fatal,
            "started": list(loss.started),
            "stopped": list(loss.stopped),
            "moved": [{"component": component, "role": role} for component, role in loss.moved],
        }
        for loss in losses
    ]


def cost_text(optimum: Optimum, strangers: Iterable[IRI], names: Names) -> str:
    """What a configuration costs, for people; `strangers` are properties of the cost that nobody in the ecology has."""
    lines = ["cost, compared level by level" if len(optimum.cost) > 1 else "cost"]
    for number, (spent, least) in enumerate(zip(optimum.cost, optimum.bound, strict=True), 1):
        bound = "" if optimum.proved else f"  (bound {_decimal(least)})"
        lines.append(f"  level {number}  {_decimal(spent)}{bound}")
    lines.append("  proved: nothing costs less" if optimum.proved else "  not proved: there may be something better")
    if optimum.missing:
        terms = "1 term is" if optimum.unknown == 1 else f"{optimum.unknown} terms are"
        lines.append(f"  {terms} unknown, and left out of the sums (sc:otherwise would say what to count)")
    nobody = set(strangers)
    lines += [f"    nobody in the ecology has a number for {names(one)}" for one in sorted(nobody)]
    told = dict.fromkeys(pair for pair in optimum.missing if pair[1] not in nobody)
    lines += [f"    {names(component)} has no number for {names(wanted)}" for component, wanted in told]
    return "\n".join(lines)


def cost_body(optimum: Optimum, strangers: Iterable[IRI]) -> dict[str, Any]:
    """What a configuration costs, as JSON."""
    return {
        "levels": [float(amount) for amount in optimum.cost],
        "bound": [float(amount) for amount in optimum.bound],
        "proved": optimum.proved,
        "unknown": optimum.unknown,
        "missing": [{"component": component, "property": wanted} for component, wanted in optimum.missing],
        "nobody_has": sorted(strangers),
    }


def _decimal(amount: Fraction) -> str:
    return f"{float(amount):g}"


def undecided_text(undecided: Undecided, template: IRI, names: Names) -> str:
    """That there is no answer yet, in one sentence."""
    return f"{names(template)} is {undecided}"


def undecided_body(undecided: Undecided) -> dict[str, Any]:
    """The same as JSON."""
    return {"code": undecided.code, "message": str(undecided)}


def nowhere(named: IRI) -> Place | None:
    """The place of what is known from the network alone."""
    return None


def _spoken_of(fact: Reason | Relaxation | NearMiss) -> IRI:
    """The role or component that a reason, a near miss or a repair is about."""
    if isinstance(fact, AcceptNearMiss):
        return fact.near.component
    return fact.component if isinstance(fact, InputUnfed | NearMiss) else fact.role


def refusal_text(refusal: Refusal, names: Names, where: Where = nowhere, most: int = 8) -> str:
    """A refusal on one screen, the most likely cause first, each line with the place it speaks of."""

    def placed(sentence: str, fact: Reason | Relaxation | NearMiss) -> str:
        place = where(_spoken_of(fact))
        return sentence if place is None else f"{sentence}  [{place}]"

    lines = [f"no configuration for {names(refusal.template)}"]
    if not refusal.reasons:
        lines.append("  no time was left to find out why; allow more")
    lines += [placed(f"  because {reason}", reason) for reason in refusal.reasons[:most]]
    if len(refusal.reasons) > most:
        lines.append(f"  and {len(refusal.reasons) - most} more reasons")
    if refusal.near_misses:
        lines.append("near misses")
        lines += [placed(f"  {_missed(miss, names)}", miss) for miss in refusal.near_misses[:most]]
        if len(refusal.near_misses) > most:
            lines.append(f"  and {len(refusal.near_misses) - most} more")
    if refusal.repairs or refusal.hint:
        lines.append("what would mend it")
        lines += [placed(f"  {repair}", repair) for repair in refusal.repairs]
    if refusal.hint:
        lines.append(f"  {refusal.hint}")
    return "\n".join(lines)


def _missed(miss: NearMiss, names: Names) -> str:
    return f"{miss.role.short}: {names(miss.component)} would fit, but {miss}"


def refusal_body(refusal: Refusal, where: Where = nowhere) -> dict[str, Any]:
    """A refusal as JSON; `place` is there where it is known."""

    def place(fact: Reason | Relaxation | NearMiss) -> dict[str, Any]:
        found = where(_spoken_of(fact))
        return {} if found is None else {"place": str(found)}

    repairs: list[dict[str, Any]] = [
        {"code": repair.code, "role": repair.role, "message": str(repair), **place(repair)}
        for repair in refusal.repairs
    ]
    if refusal.hint:
        repairs.append({"code": "reasoning", "message": refusal.hint})
    return {
        "template": refusal.template,
        "reasons": [
            {"code": reason.code, "role": reason.role, "message": str(reason), **place(reason)}
            for reason in refusal.reasons
        ],
        "near_misses": [
            {"role": miss.role, "component": miss.component, "obstacle": str(miss.obstacle), **place(miss)}
            for miss in refusal.near_misses
        ],
        "repairs": repairs,
    }


def plain(value: Term) -> Any:
    """A term in JSON: IRIs and strings as text, numbers and truth values as such; JSON has no INF and no NaN."""
    if isinstance(value, Literal):
        kind = value.datatype.rpartition("#")[2]
        try:
            if kind in ("integer", "int", "long"):
                return int(value.lexical)
            if kind in ("decimal", "double", "float"):
                number = float(value.lexical)
                return number if math.isfinite(number) else value.lexical
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
