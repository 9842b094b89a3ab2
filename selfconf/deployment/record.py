"""What a configurator has deployed and lost, and what it answers: `status`, `stop`, `task`, and the configuration."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.answers import answering
from selfconf.bus.port import Request, Urgency
from selfconf.deployment.task_context import TaskContext
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.codec import LARGEST, encode
from selfconf.protocol.keys import call_of
from selfconf.protocol.messages import Status
from selfconf.rdf.provenance import Deployment, configuration_iri, deployment_triples
from selfconf.rdf.turtle import to_turtle

FAILURES_KEPT = 256
"""The newest failures of so many components are kept: where ever new components come and go they have no end."""


class DeploymentRecord:
    """Keeps the record of one task, and serves it on the bus."""

    def __init__(
        self,
        context: TaskContext,
        status: Callable[[], Status],
        stop: Callable[[], None],
    ) -> None:
        self.bus, self._keys, self._name = context.ecology.bus, context.ecology.keys, context.name
        self._identity, self._request = context.identity, context.request
        self._status, self._stop = status, stop
        self._deployed: tuple[IRI, Configuration, int, float] | None = None
        self._revises: tuple[IRI, Configuration] | None = None
        """The configuration before the deployed one, or the last one if none is deployed; earlier ones are not kept."""
        self._failures: dict[IRI, tuple[IRI, str, str, float]] = {}
        """The newest failure of each component, the newest last, of the FAILURES_KEPT that have failed last."""
        self._heard = False
        """Whether an observer wants to receive each configuration: one that asks may ask too late."""
        self._publisher = self.bus.publisher(self._keys.configuration(self._name), Urgency.SIGNAL, self._matched)
        self._served = [
            self.bus.serve(self._keys.configuration(self._name), self._serve_configuration),
            self.bus.serve(self._keys.configurator_call(self._name), self._serve_call),
        ]

    def close(self) -> None:
        """Tell nothing and answer no question any more."""
        for undo in self._served:
            undo()
        self._publisher.undeclare()

    def deployed(self, configuration: Configuration, epoch: int, time: float) -> None:
        """Note a configuration that is complete."""
        self.taken_down()
        self._deployed = configuration_iri(configuration, epoch), configuration, epoch, time
        self._tell()

    def taken_down(self) -> None:
        """Note that what was deployed is deployed no more; what comes after it revises it."""
        if self._deployed is not None:
            self._revises, self._deployed = self._deployed[:2], None

    def lost(self, component: IRI, cause: str, detail: str, time: float) -> None:
        """Note a component that was lost."""
        self._failures.pop(component, None)
        self._failures[component] = component, cause, detail, time
        if len(self._failures) > FAILURES_KEPT:
            del self._failures[next(iter(self._failures))]

    def _matched(self, heard: bool) -> None:
        self._heard = heard
        self._tell()

    def _tell(self) -> None:
        """Send what is deployed to observers."""
        if self._heard and self._deployed is not None:
            self._publisher.put(self.turtle().encode())

    def _serve_configuration(self, request: Request) -> None:
        with answering(request):
            if self._deployed is not None:
                request.reply(self._keys.configuration(self._name), self.turtle().encode())

    def turtle(self) -> str:
        """What is deployed, as Turtle with its provenance."""
        assert self._deployed is not None
        name, configuration, epoch, generated = self._deployed
        identity = self._identity()
        deployment = Deployment(
            epoch,
            generated,
            self._name,
            (identity.name, identity.priority),
            self._revises,
            tuple(self._failures.values()),
            self._request.composer.passed_over(configuration),
            None if self._request.outside is None else self._request.outside.composite,
        )
        return to_turtle(deployment_triples(configuration, name, self._request.task, deployment))

    def _tell_task(self, request: Request) -> None:
        """Reply the task as sites would be asked to keep it, where it is known and not too large."""
        status, record = self._status(), self._request.record
        told = b""
        if record is not None:
            told = encode(replace(record, task=status.task, priority=status.priority, beginning=status.beginning))
        if 0 < len(told) <= LARGEST:
            request.reply(self._keys.configurator_call(self._name, "task"), told)
        else:
            request.refuse("this configurator does not tell which task it runs")

    def _serve_call(self, request: Request) -> None:
        with answering(request):
            call = call_of(request.key)
            if call == "stop":
                request.reply(self._keys.configurator_call(self._name, "stop"), encode(self._status()))
                self.bus.wake_up(self._stop)
            elif call in ("status", "*"):
                request.reply(self._keys.configurator_call(self._name, "status"), encode(self._status()))
            elif call == "task":
                self._tell_task(request)
            else:
                request.refuse(f"there is no call {call!r}")
