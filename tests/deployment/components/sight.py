"""Components that are out of sight of all others for a while."""

from __future__ import annotations

from tests.lab import Lab


def out_of_sight(lab: Lab, *components: str, seconds: float) -> None:
    """Cut components off from all others for a while."""
    cut = [
        (lab.runtimes[component].bus, other)
        for component in components
        for other in lab.network.nodes
        if other is not lab.runtimes[component].bus
    ]
    for node, other in cut:
        lab.network.cut(node, other)
    lab.let_pass(seconds)
    for node, other in cut:
        lab.network.reconnect(node, other)
