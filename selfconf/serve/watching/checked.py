"""What a configurator tells, checked: from any peer, only what is of the expected form goes on to the page."""

from __future__ import annotations

import json
from typing import Any

from selfconf.serve.watching.change import Body

_TEXTS = ("component", "cause", "detail", "reason", "site", "message", "call", "source", "output", "sink", "input")
_FACTS = {
    "reasons": ("code", "role", "message"),
    "near_misses": ("role", "component", "obstacle"),
    "repairs": ("code", "role", "message"),
}
"""The lists of a refusal, and the texts of each of their members."""
LARGEST_EPOCH = 2.0**53
"""Above this a browser does not tell one integer from the next; epochs are milliseconds of the clock, and above."""


def checked_event(event: Any) -> Body:
    """An event of a run with its act, its time, and those facts that are of the expected form."""
    body: Body = {"act": _text(event.get("act")), "time": finite_number(event.get("time"))}
    body |= {fact: event[fact] for fact in _TEXTS if isinstance(event.get(fact), str)}
    if body["act"] == "running":
        body |= {
            "configuration": checked_configuration(event.get("configuration")),
            "epoch": finite_number(event.get("epoch"), LARGEST_EPOCH),
        }
    if body["act"] in ("waiting", "refused"):
        body["refusal"] = checked_refusal(event.get("refusal"))
    return body


def checked_configuration(value: Any) -> Body | None:
    """A configuration with its roles and connections; None for what is none."""
    if not isinstance(value, dict):
        return None
    return {
        "template": _text(value.get("template")),
        "roles": [
            {"role": _text(one.get("role")), "components": list(map(_text, _list(one.get("components"))))}
            for one in _objects(value.get("roles"))
        ],
        "recruits": list(map(_text, _list(value.get("recruits")))),
        "bindings": {
            name: bound if isinstance(bound, str) else json.dumps(bound)
            for name, bound in _object(value.get("bindings")).items()
            if isinstance(bound, str | int | float)
        },
        "connections": [
            {"from": _end(one.get("from"), "output"), "to": _end(one.get("to"), "input")}
            for one in _objects(value.get("connections"))
        ],
    }


def checked_refusal(value: Any) -> Body | None:
    """A refusal with its reasons, near misses and relaxations, or the sentence of a search that has given up."""
    if not isinstance(value, dict):
        return None
    body: Body = {
        name: [{fact: _text(one.get(fact)) for fact in facts} for one in _objects(value.get(name))]
        for name, facts in _FACTS.items()
    }
    return {**body, "message": _text(value.get("message"))}


def _end(value: Any, port: str) -> Body:
    given = _object(value)
    return {"component": _text(given.get("component")), port: _text(given.get(port))}


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def finite_number(value: Any, most: float = 1e12) -> float:
    """A number that can be a time in seconds, or a count up to some limit; zero for what is none."""
    return value if isinstance(value, int | float) and abs(value) < most else 0.0


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []


def _object(value: Any) -> Body:
    return value if isinstance(value, dict) else {}


def _objects(value: Any) -> list[Body]:
    return [one for one in _list(value) if isinstance(one, dict)]
