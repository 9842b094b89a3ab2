"""The processes that a site starts, in simulated time: they begin after a while, and again when they crash."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Urgency
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail
from selfconf.site.component_process import SEEN_BY_ALL
from selfconf.site.component_program import ComponentProgram

if TYPE_CHECKING:
    from tests.faults.histories import History

BEGINNING = 0.3
"""Seconds that a process takes to begin."""
RESTARTS = 3
"""How often a process that crashes is started again."""
CHECK = 0.2
"""Seconds between two looks at a process."""


class SimulatedProcesses:
    """What a site has started, by component; it stands in for `ComponentProcesses`."""

    def __init__(self, history: History, site: MemoryBus, names: dict[IRI, str]) -> None:
        self._history, self._site, self._names = history, site, names
        self._nodes: dict[str, MemoryBus | None] = {}
        """The node of each process that is to run; None while it begins."""
        self._asked_for: set[MemoryBus] = set()
        """The nodes of processes that were asked for while they ran: a task saw no life of them."""
        self._awake_since: dict[MemoryBus, float] = {}
        """When the node of each process that is awake was found so."""
        self._restarts: dict[str, int] = {}
        self.by_component: Mapping[IRI, ComponentProgram] = {}
        """None: a process in simulated time has the ports that are advertised."""

    def start(self, profile: Profile, sharing: Iterable[Profile] = (), after: str = "") -> None:
        """Start the process of a component, unless it runs."""
        name = self._names[profile.component]
        node = self._nodes.get(name)
        if node is not None:
            self._asked_for.add(node)
        elif name not in self._nodes:
            self._restarts[name] = 0
            self._begin(name)

    def end(self, component: IRI, life: str = "", ended: Callable[[], None] = lambda: None) -> None:
        """End the process of a component, if it lives the life that is meant; one that is waited for begins again."""
        name = self._names[component]
        node = self._nodes.get(name)
        if node is not None and node.open:
            (run,) = (one for one in self._history.processes if one.node is node)
            if life and run.runtime.life != life:
                raise PeerError(f"this site has not started the life {life} of {component}")
            seen = run.awake and self._history.network.time - self._awake_since.get(node, math.inf) > SEEN_BY_ALL
            if node not in self._asked_for or seen:
                del self._nodes[name]
            node.close()
        ended()

    def close(self) -> None:
        """End everything."""
        self.ended_with_the_site()

    def ended_with_the_site(self) -> None:
        """A component that a site has started ends when that site is gone."""
        nodes, self._nodes = self._nodes, {}
        for node in nodes.values():
            if node is not None:
                node.close()

    def _begin(self, name: str) -> None:
        self._nodes[name] = None

        def begun() -> None:
            if name in self._nodes:
                self._history.begin_process(name, lambda node: self._watch(name, node))

        self._history.network.after(BEGINNING, begun)

    def _watch(self, name: str, node: MemoryBus | None) -> None:
        """Look at a process until it ends, and start it again; None: it has ended at once, as another one lives."""
        if name not in self._nodes:
            if node is not None:
                node.close()
            return
        self._nodes[name] = node
        if node is not None and node.open:
            if node.paused:
                self._awake_since.pop(node, None)
            else:
                self._awake_since.setdefault(node, self._history.network.time)
            self._history.network.after(CHECK, lambda: self._watch(name, node))
        elif self._restarts[name] < RESTARTS and self._site.open:
            self._restarts[name] += 1
            self._history.network.after(1.0, lambda: self._begin(name) if name in self._nodes else None)
        else:
            self._nodes.pop(name)
            self._give_up(name, node)

    def _give_up(self, name: str, node: MemoryBus | None) -> None:
        """Say that a process has ended and is not started again, as a site does: what waits for it asks once more."""
        keys, component = self._history.lab.keys, self._history.lab.profile(name).component
        life = next((run.runtime.life for run in self._history.processes if run.node is node), "")
        if self._site.open:
            notice = self._site.publisher(keys.fail(component), Urgency.EVENT)
            notice.put(encode(Fail(component, life, 0, Cause.CRASH, "it has crashed too often")))
            notice.undeclare()
