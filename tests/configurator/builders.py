"""Configurations, states and histories for tests of the machine."""

from __future__ import annotations

from dataclasses import replace

from selfconf.configurator.effects import ApplyTo, Effect, ReleaseFrom, ReserveOf
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Stopped,
    Unanswered,
)
from selfconf.configurator.machine import step
from selfconf.configurator.state import Phase, Policy, State
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.model.term import IRI, Literal
from selfconf.protocol.messages import Cause, Verdict

ARM = IRI("urn:c:arm")
TEMPLATE = IRI("urn:t:navigate")
TRACKER, ODOMETRY, CONTROL, DRIVE = (IRI(f"urn:c:{name}") for name in ("tracker", "odometry", "control", "drive"))
EVERYBODY = (TRACKER, ODOMETRY, CONTROL, DRIVE)
REFUSAL = Refusal(TEMPLATE, (TooFewEligible(IRI("urn:r:position"), 1, 0),))
GOAL = Literal("(AT BEDROOM)")
OTHERS = Holder("tidy~2", 0, 5.0, "c2", acting=True)
"""Another task of the same priority, for which a component acts."""
HIGHER, LOWER, RESERVING = replace(OTHERS, priority=1), replace(OTHERS, priority=-1), replace(OTHERS, acting=False)
KEPT = Holder("", acting=False)
"""No task holds a component, but it is kept for one that goes before."""
TASK = State(task="go~1")
PATIENT = State(task="go~1", patient=True)
DISMANTLE = State(task="go~1", policy=Policy.DISMANTLE)


def navigation(position: IRI = TRACKER) -> Configuration:
    """A position sensor feeds a controller, which feeds a drive; the controller is given a goal."""
    return Configuration(
        TEMPLATE,
        (
            Assignment(IRI("urn:r:position"), (position,)),
            Assignment(IRI("urn:r:control"), (CONTROL,)),
            Assignment(IRI("urn:r:drive"), (DRIVE,)),
        ),
        (Connection(position, "pose", CONTROL, "position"), Connection(CONTROL, "set", DRIVE, "velocity")),
        (ParameterSetting(CONTROL, "goal", GOAL),),
    )


def with_arm(configuration: Configuration) -> Configuration:
    """A configuration with another actuator, which the controller does not feed and the first sensor does."""
    sensor = configuration.components[0]
    return replace(
        configuration,
        assignments=(*configuration.assignments, Assignment(IRI("urn:r:arm"), (ARM,))),
        connections=(*configuration.connections, Connection(sensor, "pose", ARM, "target")),
    )


class History:
    """A machine with all that it has wanted done so far."""

    def __init__(self, state: State | None = None) -> None:
        self.state = state or State()
        self.effects: list[Effect] = []

    def hear(self, *events: Event) -> list[Effect]:
        """Let the machine hear events; what it wants done because of the last one."""
        new: list[Effect] = []
        for event in events:
            self.state, effects = step(self.state, event)
            new = list(effects)
            self.effects += new
        return new

    def accepted(self) -> History:
        """The task is accepted, the ecology has answered, and a search is going on."""
        self.hear(Accepted(100), Discovered())
        return self

    def composed(self, outcome: Configuration | Refusal) -> list[Effect]:
        """The search that is going on has this outcome."""
        return self.hear(Composed(self.state.attempt, outcome))

    def answer(
        self,
        component: IRI,
        call: Call,
        verdict: Verdict | Unanswered = Verdict.DONE,
        life: str = "1",
        holder: Holder | None = None,
        shared: bool = False,
        acts: bool = False,
    ) -> list[Effect]:
        """A component answers the call that it is waited for."""
        epoch, life = self.state.epoch, life if isinstance(verdict, Verdict) else ""
        return self.hear(Answered(component, call, epoch, verdict, life, epoch, "", holder, shared, acts))

    def busy(self, component: IRI, holder: Holder = OTHERS, call: Call = Call.RESERVE) -> list[Effect]:
        """A component answers that another task holds it."""
        return self.answer(component, call, Verdict.BUSY, holder=holder)

    def all_answer(self, *calls: Call) -> list[Effect]:
        """Let every component obey its pending call, or those of these kinds only, until none is pending."""
        new: list[Effect] = []
        while pending := [one for one in self.state.pending if not calls or one[1] in calls]:
            new = self.answer(*min(pending))
        return new

    def reserved(self, configuration: Configuration | None = None) -> History:
        """All components of a configuration are reserved, and none has been applied to with success."""
        self.accepted().composed(configuration or navigation())
        self.all_answer(Call.WAKE, Call.RESERVE)
        assert self.state.phase is Phase.DEPLOYING
        return self

    def running(self, configuration: Configuration | None = None) -> History:
        """A configuration is deployed and complete."""
        self.accepted().composed(configuration or navigation())
        self.all_answer()
        assert self.state.phase is Phase.RUNNING
        return self


def state_in(phase: Phase, policy: Policy = Policy.REPAIR, patient: bool = False) -> State:
    """A state in a phase, reached by a plausible history."""
    history = History(State(policy=policy, patient=patient, task="go~1"))
    if phase is Phase.IDLE:
        return history.state
    history.hear(Accepted(100))
    if phase is Phase.DISCOVERING:
        return history.state
    history.hear(Discovered())
    if phase is Phase.COMPOSING:
        return history.state
    if phase is Phase.REFUSED:
        history.composed(REFUSAL)
        return history.state
    history.composed(navigation())
    if phase is Phase.RESERVING:
        history.all_answer(Call.WAKE)
        history.answer(CONTROL, Call.RESERVE)
        return history.state
    history.all_answer(Call.WAKE, Call.RESERVE)
    if phase is Phase.DEPLOYING:
        history.answer(TRACKER, Call.APPLY)
        return history.state
    history.all_answer()
    if phase is Phase.RUNNING:
        return history.state
    history.hear(Stopped())
    if phase is Phase.STOPPED:
        history.all_answer()
    return history.state


def applied(effects: list[Effect]) -> list[IRI]:
    """Who is to be activated or wired anew."""
    return [effect.component for effect in effects if isinstance(effect, ApplyTo)]


def reserved(effects: list[Effect]) -> list[IRI]:
    """Who is to be reserved."""
    return [effect.component for effect in effects if isinstance(effect, ReserveOf)]


def released(effects: list[Effect]) -> list[IRI]:
    """Who is to be turned off."""
    return [effect.component for effect in effects if isinstance(effect, ReleaseFrom)]


def kinds(effects: list[Effect]) -> list[type]:
    """What is to be done, in order."""
    return [type(effect) for effect in effects]


def lost_tracker() -> History:
    """A task that runs loses its tracker, and the search has found odometry instead."""
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    return history
