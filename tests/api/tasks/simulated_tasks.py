"""Configurators, components and sites on a simulated network, for tests of the tasks of an ecology."""

from __future__ import annotations

from dataclasses import replace

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.api.tasks.living_tasks import LivingTasks
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Request, Urgency
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer, Notice, Status, TaskRecord, Verdict

KEYS = Keys("lab")
HERE = "tcp/127.0.0.1:7001"
TEMPLATE = IRI("urn:t:navigate")
DRIVE = IRI("urn:c#drive")
AT_REST = CallAnswer(Verdict.DONE, DRIVE, "l1", place="process 7 on lab")
PATROL, TIDY = TaskRecord("patrol~1", 1, beginning=5.0, wanted=TEMPLATE), TaskRecord("tidy~2", 1, wanted=TEMPLATE)


class Tasks:
    """Configurators that run tasks, and sites that keep them, on a network of their own."""

    def __init__(self) -> None:
        self.network = Network()
        self.asked = LivingTasks(SynchronousBus(self.network.node()), KEYS, [HERE])
        self.kept: list[TaskRecord] = []

    def configurator(
        self,
        name: str,
        task: str,
        *components: IRI,
        answers: bool = True,
        speaks_of: str = "",
        outside: IRI | None = None,
        phase: str = "running",
        beginning: float = 0.0,
        since: float = 1.5,
        owed: tuple[IRI, ...] = (),
    ) -> MemoryBus:
        """A configurator that runs a task, perhaps the inside of a composite, until it is stopped.

        Then some components are `owed` their release, which it says as it ends.
        """
        node = self.network.node()
        node.announce(KEYS.configurator_life(name, "1"))
        last_words = node.publisher(KEYS.notices(name), Urgency.EVENT)
        speaker = speaks_of or name
        status = Status(speaker, phase, TEMPLATE, 3, since, components=components, task=task, outside=outside)
        status = replace(status, beginning=beginning)

        def answer(request: Request) -> None:
            if answers:
                request.reply(KEYS.configurator_call(name, "status"), encode(status))
            request.finish()

        def stop(request: Request) -> None:
            request.reply(KEYS.configurator_call(name, "stop"), encode(status))
            request.finish()
            node.later(0.1, end)

        def end() -> None:
            last_words.put(encode(Notice(name, 1, task, {"act": "stopped", "owed": list(owed)})))
            node.close()

        node.serve(KEYS.configurator_call(name, "status"), answer)
        node.serve(KEYS.configurator_call(name, "stop"), stop)
        return node

    def component(self, component: IRI, *states: CallAnswer, answers: bool = True) -> MemoryBus:
        """A component that is in one state after the other whenever it is asked; in the last one it stays."""
        node, left = self.network.node(), list(states)
        node.announce(KEYS.life(component, "l1"))

        def tell(request: Request) -> None:
            state = left.pop(0) if len(left) > 1 else left[0]
            request.reply(KEYS.call(component, "state"), encode(state))
            request.finish()

        node.serve(KEYS.call(component, "state"), tell if answers else lambda request: None)
        return node

    def site(self, *records: TaskRecord, keeps: bool = True) -> None:
        """A site that keeps tasks, or says that it cannot."""
        node = self.network.node()

        def tell(request: Request) -> None:
            for record in records:
                request.reply(KEYS.kept_tasks(), encode(record))
            request.finish()

        def keep(request: Request) -> None:
            if keeps:
                self.kept.append(decode(request.payload, TaskRecord))
                request.reply(request.key, b"")
            else:
                request.refuse("the disk is full")
            request.finish()

        node.serve(KEYS.kept_tasks(), tell)
        node.serve(KEYS.keep(), keep)
