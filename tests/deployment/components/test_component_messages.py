"""The FAIL of a component that is watched counts, and that of a stranger does not."""

from __future__ import annotations

from selfconf.bus.port import Urgency
from selfconf.configurator.state import Phase
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri


def test_the_fail_of_a_component_that_was_activated_anew_counts(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["odometry"].fail("idle, so nobody hears")
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("now it does")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED


def test_a_stranger_cannot_make_a_component_fail(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    mallory = lab.network.node()
    forged = encode(Fail(iri("person-tracker"), "", 1, Cause.FAIL, "says who"))
    for key in (lab.keys.fail(iri("pippi-drive")), lab.keys.fail(iri("thinking-cap"))):
        mallory.publisher(key, Urgency.EVENT).put(forged)
    mallory.publisher(lab.keys.fail(iri("person-tracker")), Urgency.EVENT).put(b"not a message")
    silent = encode(Fail(iri("person-tracker"), "", 1, Cause.SILENCE, "says a stranger"))
    mallory.publisher(lab.keys.fail(iri("pippi-drive")), Urgency.EVENT).put(silent)
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
