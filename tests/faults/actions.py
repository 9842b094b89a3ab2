"""What the actions of scripts do in a history; each says whether it was possible."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from selfconf.bus.memory import MemoryBus
from selfconf.configurator.state import Policy
from selfconf.model.profile import CALL_MARK
from selfconf.sdk.component import Refused
from tests.faults.script import Action

if TYPE_CHECKING:
    from tests.faults.histories import History


class Actions:
    """Does the actions of scripts to a history."""

    def __init__(self, history: History) -> None:
        self._history, self._network = history, history.network

    def perform(self, action: Action) -> bool:
        """Do what an action says, if that is possible; whether it was."""
        done: bool = getattr(self, f"_{action.kind}")(action)
        return done

    def _fail(self, action: Action) -> bool:
        life = self._history.life(action.who)
        if life is None or not life.awake:
            return False
        life.recorder.fail("scripted")
        return True

    def _emit(self, action: Action) -> bool:
        life = self._history.life(action.who)
        if life is None or not life.awake:
            return False
        if self._history.script.ecology.latched:
            life.recorder.say_last()
            return True
        for output in life.runtime.profile.signal_outputs:
            life.recorder.emit(output.name, self._network.time)
        return True

    def _ask(self, action: Action) -> bool:
        life = self._history.life(action.who)
        if life is None or not life.awake:
            return False
        for needed in life.runtime.profile.needed_operations:
            life.recorder.ask(needed.name.removesuffix(CALL_MARK))
        return True

    def _crash(self, action: Action) -> bool:
        lives = self._history.lives_of(action.who)
        for life in lives:
            life.node.close()
        return bool(lives)

    def _start(self, action: Action) -> bool:
        if self._history.life(action.who) is not None or action.who in self._history.script.startable:
            return False
        self._history.try_to_begin(action.who)
        return True

    def _duplicate(self, action: Action) -> bool:
        """A second process of a component that lives is started."""
        if self._history.life(action.who) is None:
            return False
        self._history.try_to_begin(action.who, 1)
        return True

    def _twins(self, action: Action) -> bool:
        """Two processes of a component begin at once."""
        if self._history.life(action.who) is not None:
            return False
        self._history.begin_life(action.who)
        self._history.begin_life(action.who)
        return True

    def _lose_power(self, action: Action) -> bool:
        """Others notice after the lease only."""
        life = self._history.life(action.who)
        if life is None:
            return False
        self._network.pause(life.node)
        self._history.powerless.append(life.node)
        return True

    def _refuse(self, action: Action) -> bool:
        life = self._history.life(action.who)
        if life is None:
            return False
        life.recorder.refusal = None if life.recorder.refusal else Refused("scripted")
        return True

    def _hush(self, action: Action) -> bool:
        """A component issues nothing any more, or again."""
        life = self._history.life(action.who)
        if life is None:
            return False
        life.recorder.hushed = not life.recorder.hushed
        return True

    def _slow(self, action: Action) -> bool:
        life = self._history.life(action.who)
        if life is None:
            return False
        life.recorder.slow = action.seconds
        return True

    def _busy(self, action: Action) -> bool:
        """The code of a component is busy with a timer of its own, if it acts."""
        life = self._history.life(action.who)
        if life is None or not life.awake:
            return False
        life.runtime.code.tick(partial(life.thread.spend, action.seconds))
        return True

    def _crash_site(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is not None:
            node.close()
            processes: Any = self._history.sites[action.who].processes
            self._network.after(0.2, processes.ended_with_the_site)
        return node is not None

    def _start_site(self, action: Action) -> bool:
        if self._history.node(action.who) is not None:
            return False
        self._history.begin_site(action.who)
        return True

    def _begin(self, action: Action) -> bool:
        if self._history.node(action.who) is not None:
            return False
        plan, ecology = self._history.script.tasks[action.who], self._history.script.ecology
        agent = self._history.lab.agent(
            ecology.whole if plan.drives else ecology.part,
            tuple((name, value.format(task=action.who)) for name, value in ecology.bindings),
            policy=Policy.DISMANTLE if plan.dismantles else Policy.REPAIR,
            patient=plan.patient,
            name=action.who,
            priority=plan.priority,
            upgrade=plan.upgrade,
            clock=self._history.script.clocks.get(action.who, 0.0),
        )
        self._history.tasks[action.who] = agent
        self._history.begun.append(agent)
        assert isinstance(agent.bus, MemoryBus)
        self._history.joined(action.who, agent.bus)
        return True

    def _crash_task(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is not None:
            node.close()
        return node is not None

    def _stop_task(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is None or node.paused:
            return False
        self._history.tasks[action.who].stop()
        return True

    def _isolate(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is None or action.who in self._history.isolated:
            return False
        self._history.isolated.add(action.who)
        for other in self._network.nodes:
            if other is not node and other.open:
                self._network.cut(node, other)
        return True

    def _rejoin(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is None or action.who not in self._history.isolated:
            return False
        self._history.isolated.discard(action.who)
        for other in self._network.nodes:
            if other is not node and other.open:
                self._network.reconnect(node, other)
        return True

    def _link(self, action: Action) -> tuple[MemoryBus, MemoryBus] | None:
        left, right = self._history.node(action.who), self._history.node(action.other)
        return (left, right) if left is not None and right is not None else None

    def _cut(self, action: Action) -> bool:
        link = self._link(action)
        if link is not None:
            self._network.cut(*link)
        return link is not None

    def _mute(self, action: Action) -> bool:
        link = self._link(action)
        if link is not None:
            self._network.mute(*link)
        return link is not None

    def _mend(self, action: Action) -> bool:
        link = self._link(action)
        if link is not None:
            self._network.reconnect(*link)
        return link is not None

    def _pause(self, action: Action) -> bool:
        node = self._history.node(action.who)
        if node is None or node.paused:
            return False
        self._network.pause(node)
        self._network.after(
            action.seconds, lambda: None if node in self._history.powerless else self._network.resume(node)
        )
        return True
