"""The warm-up of a program that stands by: it goes through its first call before that comes, in memory, by itself.

What stands by is called when something else has failed, and all that runs on waits for it. The first time that a
program is called, Python makes ready much of what it runs then, and the call takes more than twice as long as any
after it. So a program of which no component is held goes beforehand through what a call has it do, on a bus in memory:
two components of no meaning are reserved, activated and connected there, one fails, and both are released. No code of
the program's own components is run.
"""

from __future__ import annotations

from selfconf.bus.memory import Network
from selfconf.model.profile import Input, Output, Ports, Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, Release, Reserve, Wire
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import ComponentRuntime

STEP = 0.1
"""Simulated seconds in which everything comes of a call that comes of it."""
_SOURCE, _SINK = IRI("urn:selfconf:warm-up:source"), IRI("urn:selfconf:warm-up:sink")
_PORTS = {_SOURCE: Ports(outputs=(Output("out", ()),)), _SINK: Ports(inputs=(Input("in", ()),))}
_FED = {_SOURCE: {}, _SINK: {"in": (Wire(_SOURCE, "out"),)}}


class _Source(Component):
    """Issues a signal when it is started."""

    def started(self) -> None:
        """One signal."""
        self.emit("out", {})


def warm_up_calls() -> None:
    """Have two components in memory reserved, activated and released; one of them fails meanwhile."""
    network, keys = Network(), Keys("warm-up")
    caller, stage = network.node(), network.node()
    supervisor = keys.configurator_life("warm-up", "0")
    caller.announce(supervisor)
    source, sink = _Source(), Component()
    parts = {_SOURCE: source, _SINK: sink}
    lives = [ComponentRuntime(stage, keys, Profile(one, ports=_PORTS[one]), part) for one, part in parts.items()]

    def call(name: str, message: Reserve | Apply | Release, component: IRI) -> None:
        caller.ask(keys.call(component, name), encode(message), STEP, lambda replies: None)
        network.let_pass(STEP)

    for component, inputs in _FED.items():
        call("reserve", Reserve(1, supervisor, "warm-up~0", inputs=inputs), component)
    for component, inputs in _FED.items():
        call("apply", Apply(1, supervisor, "warm-up~0", inputs=inputs), component)
    source.fail("to be released")
    network.let_pass(STEP)
    for component in _FED:
        call("release", Release(2, supervisor, "warm-up~0"), component)
    for life in lives:
        life.close()
