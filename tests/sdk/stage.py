"""A component on a simulated network, as a configurator and its neighbours see it."""

from __future__ import annotations

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Fail,
    Message,
    Release,
    SetParameters,
    Wire,
)
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import ComponentRuntime
from tests.lab import Recorder

KEYS = Keys("lab")
US, THEM = KEYS.configurator_life("us", "1"), KEYS.configurator_life("them", "1")
CAP, TRACKER = IRI("urn:c:cap"), IRI("urn:c:tracker")
XSD = "http://www.w3.org/2001/XMLSchema#"
CAP_PROFILE = Profile(
    CAP,
    ports=Ports((Input("position", IRI("urn:s:Pose")),), (Output("velocity", IRI("urn:s:Velocity")),)),
    parameters=(OperationalParameter("goal", IRI("urn:p:Goal")),),
)
TRACKER_PROFILE = Profile(TRACKER, ports=Ports(outputs=(Output("pose", IRI("urn:s:Pose")),)))


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
        self.fails: list[Fail] = []
        self.caller.subscribe(KEYS.any_fail(), lambda sample: self.fails.append(decode(sample.payload, Fail)))
        self.let_pass(0.1)

    def let_pass(self, seconds: float) -> None:
        """Simulated time passes."""
        self.network.run(lambda: False, seconds)

    def ask(self, call: str, payload: bytes) -> Replies:
        """Make a call, whatever it says."""
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(self.profile.component, call), payload, 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return replies[0]

    def call(self, message: Message) -> CallAnswer:
        """Make a call; the answer."""
        name = {Apply: "apply", SetParameters: "set", Release: "release"}[type(message)]
        (sample,) = self.ask(name, encode(message)).samples
        return decode(sample.payload, CallAnswer)

    def state(self) -> CallAnswer:
        """What the component says of itself."""
        (sample,) = self.ask("state", b"").samples
        return decode(sample.payload, CallAnswer)

    def neighbour(self, rate: float | None = None) -> ComponentRuntime:
        """A tracker that is active."""
        profile = Profile(TRACKER, ports=Ports(outputs=(Output("pose", IRI("urn:s:Pose"), rate),)))
        runtime = ComponentRuntime(self.network.node(), KEYS, profile, Component(), "life-t")
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(TRACKER, "apply"), encode(Apply(1, US)), 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return runtime


def follow(epoch: int = 1, period: float | None = None, supervisor: str = US) -> Apply:
    """Be active, and follow the tracker."""
    return Apply(epoch, supervisor, {"position": (Wire(TRACKER, "pose", period),)})
