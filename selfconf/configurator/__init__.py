"""The reactive configurator as a pure machine, with no network, clock or thread in it.

`step(state, event)` returns the next `State` and what is to be done about what the configurator has heard.

*What it hears*, each an `Event`: its task begins (`Accepted`), is taken over as it runs (`Adopted`), is handed over
(`HandedOver`) or ends (`Stopped`); the ecology has answered (`Discovered`), and a search has (`Composed`); a component
has `Answered` a `Call`, or is known not to (`Unanswered`), has `Failed`, is `Freed` by another task, has
`BegunElsewhere`, is still not free (`WaitedLong`), has `Appeared`, or has others behind its outputs (`Rewired`); one
was lost a while ago (`LossLasts`), or for good (`StayedAway`); something better may be had (`Improvable`); the bus is
back (`Reconnected`); the task is `Ranked` otherwise.

*What is to be done*, each an `Effect`: ask the ecology (`Discover`), search (`Compose`); `WakeUp` a component, reserve
it (`ReserveOf`), wait for it (`QueueFor`, `AwaitRelease`, `AwaitReturn`) or not (`Decline`), apply to it (`ApplyTo`),
let go of it (`ReleaseFrom`), follow its life or not (`Watch`, `Unwatch`); tell that the task is `Running`, or over
(`Finish`).

Of a state: its `Phase` (`DEPLOYING` are those of a deployment), its `Policy` after a failure, and why a component is
lost (`Loss`), and whether its site can start it again (`Revival`). Of a configuration: its `Plan` (`plan_of`), which
says of each component which outputs its inputs follow, which values it has, who may call it (a `Caller` by component,
operation by operation in `Callers`), and when it starts.
"""

from selfconf.configurator.deploying import DEPLOYING
from selfconf.configurator.effects import (
    ApplyTo,
    AwaitRelease,
    AwaitReturn,
    Compose,
    Decline,
    Discover,
    Effect,
    Finish,
    QueueFor,
    ReleaseFrom,
    ReserveOf,
    Running,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.configurator.events import (
    Accepted,
    Adopted,
    Answered,
    Appeared,
    BegunElsewhere,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Freed,
    HandedOver,
    Improvable,
    LossLasts,
    Ranked,
    Reconnected,
    Rewired,
    StayedAway,
    Stopped,
    Unanswered,
    WaitedLong,
)
from selfconf.configurator.machine import step
from selfconf.configurator.starting_order import Caller, Callers, Plan, plan_of
from selfconf.configurator.state import Loss, Phase, Policy, Revival, State

__all__ = [
    "DEPLOYING",
    "Accepted",
    "Adopted",
    "Answered",
    "Appeared",
    "ApplyTo",
    "AwaitRelease",
    "AwaitReturn",
    "BegunElsewhere",
    "Call",
    "Caller",
    "Callers",
    "Compose",
    "Composed",
    "Decline",
    "Discover",
    "Discovered",
    "Effect",
    "Event",
    "Failed",
    "Finish",
    "Freed",
    "HandedOver",
    "Improvable",
    "Loss",
    "LossLasts",
    "Phase",
    "Plan",
    "Policy",
    "QueueFor",
    "Ranked",
    "Reconnected",
    "ReleaseFrom",
    "ReserveOf",
    "Revival",
    "Rewired",
    "Running",
    "State",
    "StayedAway",
    "Stopped",
    "Unanswered",
    "Unwatch",
    "WaitedLong",
    "WakeUp",
    "Watch",
    "plan_of",
    "step",
]
