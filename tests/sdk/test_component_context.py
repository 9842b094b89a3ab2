"""What the parts of a component's runtime are given."""

from __future__ import annotations

from selfconf.bus.memory import Network
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.activation import Activation
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component_context import ComponentContext


def test_what_is_malformed_is_a_fail_of_that_cause() -> None:
    raised: list[tuple[str, Cause]] = []

    def fail(reason: str, cause: Cause = Cause.FAIL) -> None:
        raised.append((reason, cause))

    profile = Profile(IRI("urn:c:clock"))
    context = ComponentContext(
        Network().node(), Keys("home"), profile, "life-1", CodeThread(inline=True), {}, Activation, fail
    )
    context.malformed("it is no time")
    context.fail("it broke")
    assert raised == [("it is no time", Cause.MALFORMED), ("it broke", Cause.FAIL)]
