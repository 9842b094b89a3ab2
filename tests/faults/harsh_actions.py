"""What the actions of harsh scripts do in a history; each says whether it was possible."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import partial

from selfconf.bus.memory import MemoryBus, MemoryRequest
from tests.faults import harsh
from tests.faults.histories import History
from tests.faults.script import Action

POWER_IS_MISSED = 1.2
"""Seconds after which a host that has lost its power is gone for all others."""
CUTS = (0.001, 0.02, 0.2, 0.7)
"""For how many seconds a link that flaps is cut, and for how many it is there."""


class HarshActions:
    """Does the actions of harsh scripts to a history, and ends what is still the matter when the faults cease."""

    def __init__(self, history: History) -> None:
        self._history, self._network = history, history.network
        self._one_way: dict[MemoryBus, bool] = {}
        """The nodes that are deaf (True), or mute."""
        self._answering: dict[MemoryBus, Callable[[MemoryRequest], None]] = {}
        """What becomes of the answers of a node."""
        self._ends: list[Callable[[], None]] = []
        self._over = False

    def perform(self, action: Action) -> bool:
        """Do what an action says, if that is possible; whether it was."""
        done: bool = getattr(self, f"_{action.kind}")(action)
        return done

    def joined(self, node: MemoryBus) -> None:
        """A node has come: those that are deaf do not hear it either."""
        for other, deaf in self._one_way.items():
            if other is not node:
                self._network.mute(*((node, other) if deaf else (other, node)))

    def cease(self) -> None:
        """End what is still the matter."""
        self._over = True
        while self._ends:
            self._ends[0]()
        self._one_way.clear()

    def _for_a_while(self, seconds: float, end: Callable[[], None]) -> None:
        """Have something end after a while, or when the faults cease."""

        def once() -> None:
            if once in self._ends:
                self._ends.remove(once)
                end()

        self._ends.append(once)
        self._network.after(seconds, once)

    def _others(self, node: MemoryBus) -> Iterator[MemoryBus]:
        yield from (other for other in self._network.nodes if other is not node and other.open)

    # Links.

    def _flap(self, action: Action) -> bool:
        left, right = self._history.node(action.who), self._history.node(action.other)
        return left is not None and right is not None and self._flapping(action, [(left, right)])

    def _flap_all(self, action: Action) -> bool:
        """All links of a node are cut again and again."""
        node = self._history.node(action.who)
        return node is not None and self._flapping(action, [(node, other) for other in self._others(node)])

    def _flapping(self, action: Action, links: list[tuple[MemoryBus, MemoryBus]]) -> bool:
        chance, network = random.Random(f"{self._history.script.seed} {action}"), self._network
        end = network.time + action.seconds
        mine: list[tuple[MemoryBus, MemoryBus]] = []

        def mend() -> None:
            for link in mine:
                network.reconnect(*link)
            mine.clear()

        def cut() -> None:
            if network.time < end and not self._over:
                mine.extend(link for link in links if network.reaches(*link) and network.reaches(*reversed(link)))
                for link in mine:
                    network.cut(*link)
                network.after(chance.choice(CUTS), heal)

        def heal() -> None:
            mend()
            network.after(chance.choice(CUTS), cut)

        cut()
        return bool(mine)

    def _deafen(self, action: Action) -> bool:
        return self._is_one_way(action, True)

    def _silence(self, action: Action) -> bool:
        """Nothing of a node reaches any other."""
        return self._is_one_way(action, False)

    def _is_one_way(self, action: Action, deaf: bool) -> bool:
        node = self._history.node(action.who)
        if node is None or node in self._one_way:
            return False
        self._one_way[node] = deaf
        for other in self._others(node):
            self._network.mute(*((other, node) if deaf else (node, other)))
        self._for_a_while(action.seconds, partial(self._hear, node))
        return True

    def _hear(self, node: MemoryBus) -> None:
        del self._one_way[node]
        for other in self._others(node):
            if other not in self._one_way:
                self._network.reconnect(node, other)

    def _storm(self, action: Action) -> bool:
        """Messages are lost, come twice and overtake each other for a while, and not before and after that."""
        network, script = self._network, self._history.script
        if not script.stormy or network.faults is script.faults:
            return False
        network.faults = script.faults
        self._for_a_while(action.seconds, lambda: setattr(network, "faults", harsh.calm(script.faults)))
        return True

    # Processes, hosts and clocks that stand still, or are set.

    def _stall(self, action: Action) -> bool:
        return self._history.perform(Action(action.time, "pause", action.who, seconds=action.seconds))

    def _stall_machine(self, action: Action) -> bool:
        self._for_a_while(action.seconds, self._network.stall())
        return True

    def _freeze_host(self, action: Action) -> bool:
        nodes = [node for node in self._on_host(action.who) if not node.paused]
        self._network.pause(*nodes)
        self._for_a_while(action.seconds, lambda: [self._network.resume(node) for node in nodes])
        return bool(nodes)

    def _on_host(self, site: str) -> list[MemoryBus]:
        """The nodes of a host: of the site, of its components, and of the tasks that were begun there."""
        history = self._history
        ecology = history.script.ecology
        begun = [
            task for number, task in enumerate(ecology.tasks) if [*ecology.sites][number % len(ecology.sites)] == site
        ]
        lone = (history.node(name) for name in (site, *begun))
        lives = (life.node for name in ecology.sites[site] for life in history.lives_of(name))
        return [node for node in (*lone, *lives) if node is not None]

    def _lose_host(self, action: Action) -> bool:
        """A host loses its power, and begins again after a while, with its site and its components."""
        history, network = self._history, self._network
        nodes = self._on_host(action.who)
        if history.node(action.who) is None:
            return False
        network.pause(*nodes)

        def power_is_back() -> None:
            for node in nodes:
                if node.open:
                    node.close()
            history.perform(Action(network.time, "start_site", action.who))
            for name in history.script.ecology.sites[action.who]:
                if name in history.script.ecology.processes:
                    history.perform(Action(network.time, "start", name))

        self._for_a_while(max(action.seconds, POWER_IS_MISSED), power_is_back)
        return True

    def _set_clock(self, action: Action) -> bool:
        steps = self._history.lab.clock_steps
        steps[action.who] = steps.get(action.who, 0.0) + action.seconds
        return self._history.node(action.who) is not None

    def _roll_back(self, action: Action) -> bool:
        """A site begins again with the disk of before one of its components was advertised; later that is again."""
        history, held_back = self._history, self._history.lab.held_back
        name = random.Random(f"{history.script.seed} {action}").choice(history.script.ecology.sites[action.who])
        history.perform(Action(action.time, "crash_site", action.who))
        held_back[action.who] = held_back.get(action.who, frozenset()) | {name}
        self._for_a_while(action.seconds, lambda: held_back.pop(action.who, None))
        return history.perform(Action(action.time, "start_site", action.who))

    # Answers.

    def _answer_late(self, action: Action) -> bool:
        return self._answer_otherwise(action, partial(self._late, action.seconds))

    def _answer_twice(self, action: Action) -> bool:
        return self._answer_otherwise(action, _twice)

    def _end_before_answer(self, action: Action) -> bool:
        """A component ends while its answers are on their way; these arrive all the same."""
        life = self._history.life(action.who)
        if not self._answer_otherwise(action, partial(self._late, action.seconds)) or life is None:
            return False
        self._network.after(action.seconds / 2, lambda: life.node.close() if life.node.open else None)
        return True

    def _answer_otherwise(self, action: Action, change: Callable[[MemoryRequest], None]) -> bool:
        life = self._history.life(action.who)
        if life is None or life.node in self._answering:
            return False
        node, network = life.node, self._network
        self._answering[node] = change
        usual = node.answering

        def answering(key: str) -> list[Callable[[MemoryRequest], None]]:
            return [partial(_changed, change, answer) for answer in usual(key)]

        def end() -> None:
            self._answering.pop(node, None)
            node.answering = usual  # type: ignore[method-assign]
            network.forget_serving()

        node.answering = answering  # type: ignore[method-assign]
        network.forget_serving()
        self._for_a_while(max(5.0, 3 * action.seconds), end)
        return True

    def _late(self, seconds: float, request: MemoryRequest) -> None:
        """Have each part of an answer arrive later, whatever has become of what gives it."""
        asking = request._question.bus

        def back(action: Callable[[], None]) -> None:
            self._network.after(seconds, lambda: asking.take(action) if asking.open else None)

        request._back = back  # type: ignore[method-assign]

    # Tasks.

    def _begin_again(self, action: Action) -> bool:
        """An author stops a task, and begins it again at once, or soon."""
        history = self._history
        node = history.node(action.who)
        if node is None or node.paused or not history.perform(Action(action.time, "stop_task", action.who)):
            return False

        def begin() -> None:
            if history.node(action.who) is node:
                history.leave(action.who)
                history.perform(Action(self._network.time, "begin", action.who))

        self._for_a_while(action.seconds, begin)
        return True

    def _begin_namesake(self, action: Action) -> bool:
        """Another task of the same name is begun."""
        node = self._history.node(action.who)
        if node is None:
            return False
        self._history.leave(action.who)
        return self._history.perform(Action(action.time, "begin", action.who))


def _changed(
    change: Callable[[MemoryRequest], None], answer: Callable[[MemoryRequest], None], request: MemoryRequest
) -> None:
    change(request)
    answer(request)


def _twice(request: MemoryRequest) -> None:
    """Have each reply arrive twice."""
    usual = request.reply

    def reply(key: str, payload: bytes, attachment: bytes = b"") -> None:
        usual(key, payload, attachment)
        usual(key, payload, attachment)

    request.reply = reply  # type: ignore[method-assign]
