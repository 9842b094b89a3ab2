"""Events of runs, as configurators keep them."""

from __future__ import annotations

from typing import Any

HOME = "https://example.org/peis-home#"


def running(time: float, position: str) -> dict[str, Any]:
    """A configuration with that component as position."""
    roles = [{"role": HOME + "position", "components": [HOME + position]}]
    roles.append({"role": HOME + "drive", "components": [HOME + "astrid-drive"]})
    body = {"template": HOME + "navigate", "bindings": {"robot": HOME + "Astrid"}, "roles": roles}
    return {"act": "running", "time": time, "configuration": body}


def recruiting(time: float, *chain: str) -> dict[str, Any]:
    """A configuration in which a locator is fed by a chain of recruits, the last of which has no inputs."""
    ends = zip(chain, ("locator", *chain), strict=False)
    connections = [
        {"from": {"component": HOME + source, "output": "o"}, "to": {"component": HOME + sink, "input": "i"}}
        for source, sink in ends
    ]
    roles = [{"role": HOME + "place", "components": [HOME + "locator"]}]
    recruits = [HOME + one for one in sorted(chain)]
    body = {"template": HOME + "locate", "roles": roles, "connections": connections, "recruits": recruits}
    return {"act": "running", "time": time, "configuration": body}


LOST = {"act": "lost", "time": 20.0, "component": HOME + "tracker", "cause": "fail", "detail": "out of view"}
EVENTS = [running(10.0, "tracker"), LOST, running(21.0, "odometry")]
