"""Answers as the JSON that commands print: dictionaries, lists, strings and numbers.

`docs/schemas/` describes each of them as a JSON Schema.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from selfconf.model.alternative import Alternative
from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.holder import Holder
from selfconf.model.literal_values import BOOLEAN, TRUTH, plain_number
from selfconf.model.obstacle import Obstacle, UnlikePorts
from selfconf.model.optimum import Optimum
from selfconf.model.partition import NearMiss
from selfconf.model.profile import Operation, Output
from selfconf.model.refusal import Reason, Refusal, Undecided
from selfconf.model.relaxation import AddComponents, Relaxation
from selfconf.model.term import IRI, Literal, Term


def configuration_body(configuration: Configuration) -> dict[str, Any]:
    """A configuration: its roles, connections, bindings and parameters."""
    return {
        "template": configuration.template,
        "bindings": {name: value_body(value) for name, value in configuration.bindings.items()},
        "roles": [{"role": a.role, "components": list(a.components)} for a in configuration.assignments],
        "connections": [
            {"from": {"component": c.source, "output": c.output}, "to": {"component": c.sink, "input": c.input}}
            for c in configuration.connections
        ],
        "parameters": [
            {"component": s.component, "name": s.name, "value": value_body(s.value)} for s in configuration.settings
        ],
        **({"recruits": list(configuration.recruits)} if configuration.recruits else {}),
    }


def consequences_body(consequences: Sequence[Consequence]) -> list[dict[str, Any]]:
    """What would replace each component of a configuration if it failed."""
    return [
        {
            "component": one.component,
            **({} if one.role is None else {"role": one.role}),
            "single_point_of_failure": one.fatal,
            **({"undecided": True} if isinstance(one.after, Undecided) else {}),
            "started": list(one.started),
            "stopped": list(one.stopped),
            "moved": [{"component": moved, **({} if role is None else {"role": role})} for moved, role in one.moved],
        }
        for one in consequences
    ]


def alternative_body(one: Alternative) -> dict[str, Any]:
    """A candidate of a role with what would come of it; costs only where the template states some."""
    costs = {
        "cost": [double(amount) for amount in one.cost],
        "unknown_terms": one.unknown_terms,
        **({"total": [double(amount) for amount in one.total], "total_proved": one.proved} if one.total else {}),
    }
    return {
        "component": one.component,
        "preference": float(one.preference),
        "chosen": one.chosen,
        "outcome": one.outcome,
        **(costs if one.cost else {}),
    }


def double(amount: Fraction) -> float:
    """An amount as a number that JSON can write: of what is larger than any double, the largest or the least one.

    What strangers advertise is no larger, but what is made of it by weights, units and sums may be.
    """
    try:
        return float(amount)
    except OverflowError:
        return sys.float_info.max if amount > 0 else -sys.float_info.max


def cost_body(optimum: Optimum, unknown: Iterable[IRI]) -> dict[str, Any]:
    """What a configuration costs; `unknown` are properties of the cost that no component of the ecology has."""
    return {
        "levels": [double(amount) for amount in optimum.cost],
        "bound": [double(amount) for amount in optimum.bound],
        "proved": optimum.proved,
        "unknown": optimum.unknown_terms,
        "missing": [{"component": component, "property": wanted} for component, wanted in optimum.missing],
        "nobody_has": sorted(unknown),
    }


def undecided_body(undecided: Undecided) -> dict[str, Any]:
    """The words that there is no answer yet, as JSON: a code and a sentence."""
    return {"code": undecided.code, "message": str(undecided)}


def refusal_body(refusal: Refusal) -> dict[str, Any]:
    """A refusal; each fact has its `place` where that is known."""
    relaxations: list[dict[str, Any]] = [
        {"code": one.code, "role": one.role, "message": str(one), **_additions(one), **_place(one)}
        for one in refusal.repairs
    ]
    if refusal.hint:
        relaxations.append({"code": "reasoning", "message": refusal.hint})
    return {
        "template": refusal.template,
        "reasons": [
            {"code": reason.code, "role": reason.role, "message": str(reason), **_place(reason)}
            for reason in refusal.reasons
        ],
        **({} if refusal.smallest else {"minimality": refusal.minimality}),
        "near_misses": [
            {
                "role": miss.role,
                "component": miss.component,
                "obstacle": str(miss.obstacle),
                **likeness_body(miss.obstacle, miss.likeness),
                **({"recruit": True} if miss.recruit else {}),
                **_place(miss),
            }
            for miss in refusal.near_misses
        ],
        "repairs": relaxations,
        **({"repairs_stopped": True} if refusal.repairs_stopped else {}),
        **({"held": [{"component": c, **holder_body(h)} for c, h in refusal.held]} if refusal.held else {}),
        **({"missing_sites": list(refusal.missing_sites)} if refusal.missing_sites else {}),
    }


def likeness_body(obstacle: Obstacle, likeness: float) -> dict[str, float]:
    """How near a component comes to what a role asks for, where that depends on its ports."""
    return {"likeness": round(likeness, 4)} if isinstance(obstacle, UnlikePorts) else {}


def holder_body(holder: Holder) -> dict[str, Any]:
    """The holder of a component, and since when."""
    return {
        "task": holder.name,
        "priority": holder.priority,
        "since": holder.beginning,
        "configurator": holder.configurator,
    }


def _additions(relaxation: Relaxation) -> dict[str, Any]:
    """The components to be added, if it is that: an output has a name where an interaction asks for one."""
    if not isinstance(relaxation, AddComponents):
        return {}
    return {
        "additions": [
            {
                "role": one.role,
                "count": one.count,
                "outputs": [
                    {
                        **({"name": o.name} if o.name in one.named else {}),
                        **_carried(o),
                        **({"unit": o.unit} if o.unit else {}),
                        **({"frame": value_body(o.frame)} if o.frame else {}),
                        **({"accepts": " ".join(sorted(o.conforms))} if o.conforms else {}),
                    }
                    for o in one.outputs
                ],
                "values": {name: None if value is None else value_body(value) for name, value in one.values},
            }
            for one in relaxation.additions
        ],
        **({"shared": list(relaxation.shared)} if relaxation.shared else {}),
    }


def _carried(output: Output) -> dict[str, Any]:
    """The signal type of an output, or the types of request and response of an operation; empty if it has none."""
    if not output.signals:
        return {}
    kind = output.signals[0]
    if not isinstance(kind, Operation):
        return {"signal": kind}
    return {name: one for name, one in (("request", output.request), ("response", output.response)) if one is not None}


def _place(fact: Reason | Relaxation | NearMiss) -> dict[str, Any]:
    return {} if fact.place is None else {"place": str(fact.place)}


def value_body(value: Term) -> Any:
    """A term: IRIs and strings as text, numbers and truth values as such; JSON has no INF and no NaN."""
    if not isinstance(value, Literal):
        return str(value)
    if value.datatype == BOOLEAN:
        return TRUTH.get(value.lexical, value.lexical)
    number = plain_number(value)
    return value.lexical if number is None else number
