"""The warm-up for a failure, while a task runs: the first one is to be answered as quickly as those after it.

The machine is a pure function of values, so it can be asked what it would do. What Python makes ready the first time
that it does so is made ready then, and not while a robot waits.
"""

from __future__ import annotations

from selfconf.configurator import Failed, State, step
from selfconf.model.run_event import ComponentLost
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Cause, Fail

TIMES = 4
"""How often it is gone through: what has run a few times is compiled for what it was run with."""


def warm_up_failure(state: State) -> None:
    """Go through the failure of the first component that is held, as far as nothing is done about it."""
    for component, held in [*state.held.items()][:1] * TIMES:
        said = Fail(component, held.life, state.epoch, Cause.FAIL, "supposed")
        heard = decode(encode(said), Fail)
        step(state, Failed(heard.component, heard.life, heard.cause, heard.detail))
        ComponentLost(component, heard.cause.value, heard.detail)
