"""A component on a simulated network, as a configurator and its neighbours see it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, Term
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    Fail,
    Free,
    Release,
    Reserve,
    StateOf,
    Wire,
    Wires,
)
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import ComponentRuntime
from tests.lab import Recorder

KEYS = Keys("lab")
US, THEM = KEYS.configurator_life("us", "1"), KEYS.configurator_life("them", "1")
TASKS = {US: "task~us", THEM: "task~them"}
"""The task of each configurator."""
CAP, DRIVE = IRI("urn:c:cap"), IRI("urn:c:drive")
TRACKER, ODOMETRY = IRI("urn:c:tracker"), IRI("urn:c:odometry")
XSD = "http://www.w3.org/2001/XMLSchema#"
CAP_PROFILE = Profile(
    CAP,
    ports=Ports((Input("position", (IRI("urn:s:Pose"),)),), (Output("velocity", (IRI("urn:s:Velocity"),)),)),
    parameters=(OperationalParameter("goal", IRI("urn:p:Goal")),),
)
DRIVE_PROFILE = Profile(
    DRIVE, ports=Ports((Input("position", (IRI("urn:s:Pose"),)),)), parameters=CAP_PROFILE.parameters
)
"""An actuator: it has no outputs."""
TRACKER_PROFILE = Profile(TRACKER, ports=Ports(outputs=(Output("pose", (IRI("urn:s:Pose"),)),)))


class Watchful(Recorder):
    """Writes down as well when it is blind."""

    def unfed(self, port: str) -> None:
        self.said.append(("unfed", port))

    def fed(self, port: str) -> None:
        self.said.append(("fed", port))


class Stage:
    """A component on a simulated network, with a configurator that is alive and can call it."""

    def __init__(self, component: Component | None = None, profile: Profile = CAP_PROFILE) -> None:
        self.network = Network()
        self.caller = self.network.node()
        self.others = self.network.node()
        self.leave = self.caller.announce(US)
        self.recorder = component if isinstance(component, Recorder) else Recorder()
        self.component = component or self.recorder
        self.profile = profile
        self.runtime = ComponentRuntime(self.network.node(), KEYS, profile, self.component, "life-1")
        self.said: list[Fail] = []
        self.caller.subscribe(KEYS.any_fail(), lambda sample: self.said.append(decode(sample.payload, Fail)))
        self.freed: list[str] = []
        """The tasks to which the component was offered, in order."""
        self.caller.subscribe(KEYS.any_free(), lambda sample: self.freed.append(decode(sample.payload, Free).task))
        self.let_pass(0.1)

    @property
    def fails(self) -> list[Fail]:
        """What configurators heed: that a component has obeyed a release is no FAIL."""
        return [fail for fail in self.said if fail.epoch or fail.cause is not Cause.LET_GO]

    def let_pass(self, seconds: float) -> None:
        """Simulated time passes."""
        self.network.run(lambda: False, seconds)

    def ask(self, call: str, payload: bytes) -> Replies:
        """Make a call, whatever it says."""
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(self.profile.component, call), payload, 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return replies[0]

    def call(self, message: Reserve | Apply | Release) -> CallAnswer:
        """Make a call; the answer."""
        name = {Reserve: "reserve", Apply: "apply", Release: "release"}[type(message)]
        (sample,) = self.ask(name, encode(message)).samples
        return decode(sample.payload, CallAnswer)

    def state(self, task: str = "") -> CallAnswer:
        """What the component says of itself."""
        (sample,) = self.ask("state", encode(StateOf(task)) if task else b"").samples
        return decode(sample.payload, CallAnswer)

    def neighbour(self, rate: float | None = None, life: str = "life-t", component: IRI = TRACKER) -> ComponentRuntime:
        """A tracker, or another component that issues the same, that is active."""
        profile = Profile(component, ports=Ports(outputs=(Output("pose", (IRI("urn:s:Pose"),), rate),)))
        runtime = ComponentRuntime(self.network.node(), KEYS, profile, Component(), life)
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(component, "apply"), encode(apply()), 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return runtime


def other_source(stage: Stage) -> ComponentRuntime:
    """Another component with an output `pose`, which acts."""
    profile = replace(TRACKER_PROFILE, component=ODOMETRY)
    runtime = ComponentRuntime(stage.network.node(), KEYS, profile, Recorder(), "life-o")
    stage.caller.ask(KEYS.call(ODOMETRY, "apply"), encode(apply()), 1.0, lambda _: None)
    stage.let_pass(0.1)
    return runtime


def apply(
    epoch: int = 1,
    supervisor: str = US,
    inputs: Wires | None = None,
    values: Mapping[str, Term] | None = None,
    **claim: Any,
) -> Apply:
    """Be active; by default for the task of the supervisor, without inputs."""
    task = claim.pop("task", TASKS.get(supervisor, "task~1"))
    return Apply(epoch, supervisor, task, inputs=inputs or {}, values=values or {}, **claim)


def reserve(epoch: int = 1, supervisor: str = US, **claim: Any) -> Reserve:
    """Be held; by default for the task of the supervisor."""
    task = claim.pop("task", TASKS.get(supervisor, "task~1"))
    return Reserve(epoch, supervisor, task, **claim)


def release(epoch: int = 1, supervisor: str = US, **claim: Any) -> Release:
    """Be free; by default of the task of the supervisor."""
    task = claim.pop("task", TASKS.get(supervisor, "task~1"))
    return Release(epoch, supervisor, task, **claim)


def follow(epoch: int = 1, period: float | None = None, supervisor: str = US, **claim: Any) -> Apply:
    """Be active, and follow the tracker."""
    return apply(epoch, supervisor, {"position": (Wire(TRACKER, "pose", period),)}, **claim)


def silence(stage: Stage) -> list[tuple[IRI, str]]:
    """Whose silence was reported, and in which life."""
    return [(fail.component, fail.life) for fail in stage.fails if fail.cause is Cause.SILENCE]
