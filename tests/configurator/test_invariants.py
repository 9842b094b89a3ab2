"""What holds in every history of the machine, however the events come."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.configurator.answering import OBEYED
from selfconf.configurator.deploying import DEPLOYING, acting_wires
from selfconf.configurator.effects import (
    ApplyTo,
    AwaitRelease,
    AwaitReturn,
    Compose,
    Decline,
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
from selfconf.configurator.starting_order import parameter_values, wiring
from selfconf.configurator.state import Held, Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, RecordedLoss, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    EVERYBODY,
    ODOMETRY,
    REFUSAL,
    TRACKER,
    navigation,
    state_in,
)

AT_REST = (Phase.IDLE, Phase.REFUSED, Phase.STOPPED)
HOLDERS = [
    Holder("tidy~2", priority, float(priority), "c2", acting) for priority in (-1, 0, 1) for acting in (False, True)
]
SELF = Holder("go~1", 0, 0.0, "c3")
"""Another configurator of the same task."""
ONE_OF_EACH: list[Event] = [
    Accepted(500),
    Adopted(500, navigation()),
    Adopted(500, navigation(), (RecordedLoss(TRACKER, "1", Cause.FAIL), RecordedLoss(ODOMETRY, "1", Cause.HUNG))),
    HandedOver(),
    Discovered(),
    Discovered({TRACKER: HOLDERS[1], CONTROL: HOLDERS[5]}),
    Discovered({}, {CONTROL: replace(HOLDERS[3], wants=navigation(ODOMETRY).wants(CONTROL))}),
    Composed(1, navigation()),
    Composed(1, REFUSAL),
    Composed(2, navigation(ODOMETRY)),
    Composed(0, navigation()),
    *(
        Answered(component, call, epoch, verdict, "1", epoch + 1, holder=holder, shared=shared)
        for component in (TRACKER, CONTROL, ODOMETRY)
        for call in Call
        for epoch in (1, 100, 101, 102, 103)
        for verdict in (*Verdict, *Unanswered)
        for holder in ([None, *HOLDERS, SELF] if verdict is Verdict.BUSY else [None])
        for shared in ((False, True) if holder is not None and call is Call.APPLY else (False,))
    ),
    *(Failed(component, life, cause) for component in EVERYBODY for life in ("", "1", "9") for cause in Cause),
    *(Freed(component) for component in EVERYBODY),
    *(BegunElsewhere(component) for component in EVERYBODY),
    *(WaitedLong(component, epoch) for component in EVERYBODY for epoch in (1, 101, 102)),
    LossLasts(),
    LossLasts(frozenset((DRIVE,))),
    *(StayedAway(attempt) for attempt in range(4)),
    Appeared({}),
    Appeared({TRACKER: "1"}),
    Appeared({TRACKER: "2", ODOMETRY: "1"}),
    Improvable(),
    *(Rewired(component) for component in EVERYBODY),
    Reconnected(),
    *(Ranked(priority) for priority in (-1, 0, 2)),
    Stopped(),
]


def test_every_kind_of_event_is_tried() -> None:
    assert {type(event) for event in ONE_OF_EACH} == set(Event.__args__)


class Ledger:
    """Keeps account of what the machine has wanted done, and checks the invariants after every step."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.watched = set(state.watched)
        self.maybe_active = {*state.held, *state.owed}
        self.finished = 0
        self.awaited: set[int] = set()
        """The numbers of the searches whose wait for what was lost has not ended yet."""
        self.freed: set[IRI] = set()
        """The components that were kept for the task: these are reserved out of turn, while others are woken."""

    def hear(self, event: Event) -> None:
        """One step, with everything that must hold."""
        before, over = self.state, self.state.ended
        if isinstance(event, Adopted) and before.phase is Phase.IDLE:
            self.maybe_active.update(event.configuration.components)
        self.state, effects = step(before, event)
        assert self.state.epoch >= before.epoch
        assert self.state.attempt >= before.attempt
        asked = [effect for effect in effects if isinstance(effect, WakeUp | ReserveOf | ApplyTo)]
        assert len({(type(effect), effect.component) for effect in asked}) == len(asked)
        if isinstance(event, Freed):
            self.freed.add(event.component)
        if isinstance(event, StayedAway):
            self.awaited.discard(event.attempt)
        for effect in effects:
            self._account(effect, before)
        self._order_of_releases(effects, before)
        if isinstance(event, Answered) and event.call is Call.RELEASE and event.verdict in OBEYED:
            taken_down = event.component not in self.state.held or self.state.phase is Phase.DISMANTLING
            if event.component not in self.state.owed and taken_down:
                self.maybe_active.discard(event.component)
        handed_over = isinstance(event, HandedOver) or (isinstance(event, Answered) and event.verdict is Verdict.BUSY)
        if handed_over and Finish() in effects:
            self.maybe_active.clear()  # another configurator goes on with the task
        self._check_state()
        assert self.finished <= 1
        assert not over or all(isinstance(effect, Decline) for effect in effects)

    def _check_state(self) -> None:
        state = self.state
        assert self.maybe_active <= {*state.held, *state.owed}
        assert not set(state.held) & set(state.owed) or state.phase is Phase.DISMANTLING
        assert state.watched == self.watched
        assert set(state.held) <= state.watched or state.phase is Phase.DISMANTLING
        if state.phase in AT_REST:
            assert not state.held
            assert not state.pending
            assert not state.watched
        if state.phase is Phase.RUNNING:
            self._check_running()
        if state.phase in (Phase.RESERVING, Phase.DEPLOYING, Phase.RUNNING, Phase.DISMANTLING):
            assert state.pending or state.phase is Phase.RUNNING
            assert {call for _, call in state.pending} <= {
                Phase.RESERVING: {Call.WAKE, Call.RESERVE},
                Phase.DEPLOYING: {Call.APPLY},
                Phase.RUNNING: {Call.RELEASE},
                Phase.DISMANTLING: {Call.RELEASE},
            }[state.phase]
        else:
            assert not state.pending
        assert state.pending or not state.unreleased
        reserved = [one for one, call in state.pending if call is Call.RESERVE and not state.held[one].is_adopted]
        assert len(set(reserved) - self.freed) <= 1
        assert {component for component, _ in state.pending} <= state.held.keys() | state.owed.keys()
        for held in state.held.values():
            assert held.reserved >= held.acts or state.phase is Phase.DISMANTLING
        assert not any(component in state.lost for component in state.held) or state.phase is Phase.DISMANTLING
        assert not state.ended or not state.queued
        assert state.fallback is None or state.phase in DEPLOYING
        waits = state.phase is Phase.COMPOSING and state.awaits_return
        assert not waits or state.return_awaited_since in self.awaited, "nothing would end the wait"

    def _check_running(self) -> None:
        """All that is wanted is held, and has confirmed that it acts with the wanted inputs and values."""
        state = self.state
        assert not state.queued
        assert state.target is not None
        wires, values = wiring(state.target), parameter_values(state.target)
        assert set(state.held) == set(state.target.components) == set(state.watched)
        for component, held in state.held.items():
            assert held.reserved
            assert held.confirmed
            assert (held.inputs, held.values) == (wires[component], values[component])

    def _account(self, effect: Effect, before: State) -> None:
        state = self.state
        match effect:
            case Watch(component):
                self.watched.add(component)
            case Unwatch(component):
                self.watched.discard(component)
            case WakeUp(component, epoch):
                assert component in self.watched
                assert epoch == state.epoch > before.epoch
                self.maybe_active.add(component)
            case ReserveOf(component, epoch, inputs, values):
                assert state.target is not None
                assert component in self.watched
                assert (epoch, state.phase) == (state.epoch, Phase.RESERVING)
                if state.held[component].is_adopted:  # as it is
                    assert before.held[component].asked
                    assert (inputs, values) == (before.held[component].inputs, before.held[component].values)
                    return
                waking = any(call is Call.WAKE for _, call in state.pending)
                assert not waking or component in before.offered | state.free
                assert inputs == wiring(state.target)[component]
                assert values == parameter_values(state.target)[component]
                free = [c for c in state.target.components if not state.held[c].reserved]
                assert component == min(free) or waking
            case ApplyTo(component):
                assert component in self.watched
                self._check_apply(effect, before)
            case ReleaseFrom(component, epoch):
                assert component not in state.held or state.phase is Phase.DISMANTLING
                assert component in state.owed
                assert epoch <= state.epoch
            case AwaitRelease(component, epoch):
                assert epoch == state.epoch
                assert {(component, Call.RESERVE), (component, Call.APPLY)} & state.pending
            case QueueFor(component, epoch):
                assert (state.phase, state.patient, epoch) == (Phase.REFUSED, True, state.epoch)
                assert component in state.queued - state.owed.keys()
            case Decline(component):
                assert component not in state.held
            case AwaitReturn(attempt):
                assert (state.phase, state.patient, attempt) == (Phase.COMPOSING, False, state.attempt)
                self.awaited.add(attempt)
            case Compose(_, lost, _):
                taken = frozenset() if state.ignores_holders else frozenset(state.taken)
                assert lost == frozenset(state.lost) | taken
            case Running(configuration):
                assert configuration == state.target
                assert state.phase is Phase.RUNNING
            case Finish():
                assert state.ended
                self.finished += 1

    def _check_apply(self, effect: ApplyTo, before: State) -> None:
        """All components are reserved; sources have confirmed, and for an actuator everything else."""
        state = self.state
        assert state.target is not None
        assert state.plan is not None
        component, others = effect.component, [c for c in state.target.components if c != effect.component]
        assert effect.epoch == state.epoch
        assert effect.inputs == wiring(state.target)[component]
        assert effect.values == parameter_values(state.target)[component]
        unreserved = [c for c in state.target.components if not state.held[c].reserved]
        if unreserved:  # the apply is the reservation, in a repair that lacks one component
            assert len(unreserved) == 1
            assert unreserved[0] not in state.plan.order.actuators
            assert all(state.held[c].acts for c in state.target.components if c != unreserved[0])
        earlier = before.held.get(component, Held({}))
        if not state.held[component].acts:
            assert all(state.held[source].confirmed for source in state.plan.order.before[component])
            if component in state.plan.order.actuators:
                assert all(state.held[c].confirmed for c in others if c not in state.plan.order.actuators)
        elif component in before.held and earlier.inputs != effect.inputs:
            followed = {wire.component for wires in earlier.inputs.values() for wire in wires}
            make_before_break = all(state.held[source].confirmed for source in state.plan.order.before[component])
            assert make_before_break or followed - state.held.keys()

    def _order_of_releases(self, effects: tuple[Effect, ...], before: State) -> None:
        """Whatever is turned off because all is, or because it is not needed any more: sinks first."""
        released = [effect.component for effect in effects if isinstance(effect, ReleaseFrom)]
        if self.state.phase in (Phase.RUNNING, Phase.DISMANTLING):
            for component in chain(*self.state.unreleased):
                known = before if self.state.phase is Phase.RUNNING else self.state
                followed = {**known.surplus, **acting_wires(known)}.get(component, {})
                assert not {wire.component for wires in followed.values() for wire in wires} & set(released)


@pytest.mark.parametrize("phase", Phase)
@pytest.mark.parametrize("policy", Policy)
@pytest.mark.parametrize("patient", [False, True])
def test_every_phase_answers_every_event(phase: Phase, policy: Policy, patient: bool) -> None:
    state = state_in(phase, policy=policy, patient=patient)
    assert state.phase is phase
    for event in ONE_OF_EACH:
        if isinstance(event, Composed) and _names_a_loss(state, event):
            continue
        Ledger(state).hear(event)


@st.composite
def histories(draw: st.DrawFn) -> list[tuple[int, ...]]:
    """Random numbers that a history is made of; they are read against the state they meet."""
    return draw(st.lists(st.tuples(*[st.integers(0, 60)] * 5), min_size=5, max_size=80))


def event_of(state: State, numbers: tuple[int, ...]) -> Event:
    """An event that can come in a state: mostly the one that is waited for, often another."""
    kind, who, how, when, which = numbers
    component = EVERYBODY[who % len(EVERYBODY)]
    if state.pending and kind < 28:
        component, call = sorted(state.pending)[who % len(state.pending)]
        verdict = ([Verdict.DONE] * 8 + [*Verdict, *Unanswered])[how % (8 + len(Verdict) + len(Unanswered))]
        holder = [*HOLDERS, SELF, None][when % (2 + len(HOLDERS))] if verdict is Verdict.BUSY else None
        newest = state.epoch + when % 3
        return Answered(component, call, state.epoch, verdict, str(which % 2), newest, holder=holder)
    if kind < 32:
        taken = {component: HOLDERS[when % len(HOLDERS)]} if which % 2 else {}
        choices: list[Event] = [
            Accepted(when),
            Discovered(taken, unseen=bool(who % 2)),
            Composed(state.attempt, _found(state, how)),
            StayedAway(state.return_awaited_since or when),
        ]
        return choices[how % len(choices)]
    if kind < 38:
        return Composed(state.attempt, _found(state, how))
    if kind < 41:
        verdict = [*Verdict, *Unanswered][how % (len(Verdict) + len(Unanswered))]
        calls = list(Call)
        return Answered(component, calls[which % len(calls)], max(0, state.epoch - when % 3), verdict, "1", state.epoch)
    if kind < 46:
        cause = list(Cause)[how % len(Cause)]
        return Failed(component, ["", "0", "1"][which % 3], cause, startable=bool(when % 2))
    if kind < 50:
        return Appeared({component: str(which % 3)} if how % 2 else {})
    if kind < 57:
        others: list[Event] = [
            Freed(component),
            WaitedLong(component, state.epoch - how % 2),
            BegunElsewhere(component),
            Improvable(),
            Rewired(component),
            Ranked(when % 3 - 1),
            Adopted(when, navigation()),
            *([HandedOver()] if how == when else []),
        ]
        return others[which % len(others)]
    return Reconnected() if kind < 59 else Stopped()


def _found(state: State, how: int) -> Configuration | Refusal:
    """What a search may find, with components that are not lost."""
    free = [c for c in (TRACKER, ODOMETRY) if c not in state.lost]
    possible = bool(free) and not {CONTROL, EVERYBODY[3]} & set(state.lost) and how % 7
    return navigation(free[how % len(free)]) if possible else REFUSAL


def _names_a_loss(state: State, event: Composed) -> bool:
    """Whether a search answers with a component that it was told is lost: none does."""
    return isinstance(event.outcome, Configuration) and bool(set(event.outcome.components) & set(state.lost))


@given(histories(), st.sampled_from(Policy), st.booleans(), st.booleans(), st.sets(st.sampled_from((TRACKER, DRIVE))))
def test_the_invariants_hold_in_every_history(
    numbers: list[tuple[int, ...]], policy: Policy, patient: bool, adopted: bool, failed: set[IRI]
) -> None:
    ledger = Ledger(State(policy=policy, patient=patient, task="go~1"))
    lost = tuple(RecordedLoss(component, "1", Cause.FAIL) for component in failed)
    ledger.hear(Adopted(10, navigation(), lost) if adopted else Accepted(10))
    for drawn in numbers:
        event = event_of(ledger.state, drawn)
        if not (isinstance(event, Composed) and _names_a_loss(ledger.state, event)):
            ledger.hear(event)


@given(histories(), st.sampled_from(Policy), st.booleans())
def test_from_every_state_a_stop_ends_once_the_pending_calls_have_ended(
    numbers: list[tuple[int, ...]], policy: Policy, patient: bool
) -> None:
    state, _ = step(State(policy=policy, patient=patient, task="go~1"), Accepted(10))
    for drawn in numbers:
        state, _ = step(state, event_of(state, drawn))
    state, _ = step(state, Stopped())
    for _ in range(2 * len(EVERYBODY)):
        for component, call in sorted(state.pending):
            state, _ = step(state, Answered(component, call, state.epoch, Unanswered.SILENT))
    assert state.phase in (Phase.STOPPED, Phase.REFUSED)
    assert state.ended
    assert not state.held


@given(histories(), st.booleans())
def test_from_every_state_a_search_that_finds_something_and_components_that_obey_lead_to_running(
    numbers: list[tuple[int, ...]], patient: bool
) -> None:
    ledger = Ledger(State(patient=patient, task="go~1"))
    ledger.hear(Accepted(10))
    for drawn in numbers:
        event = event_of(ledger.state, drawn)
        if not isinstance(event, Stopped | HandedOver) and not (
            isinstance(event, Composed) and _names_a_loss(ledger.state, event)
        ):
            ledger.hear(event)
    for _ in range(60):
        state = ledger.state
        if state.ended or state.phase is Phase.RUNNING:
            return
        if state.phase is Phase.REFUSED:
            ledger.hear(Appeared(dict.fromkeys(EVERYBODY, "7")))
        elif state.phase is Phase.DISCOVERING:
            ledger.hear(Discovered())
        elif state.phase is Phase.COMPOSING and state.awaits_return:
            ledger.hear(StayedAway(state.return_awaited_since))
        elif state.phase is Phase.COMPOSING:
            ledger.hear(Composed(state.attempt, _found(state, 1)))
        else:
            component, call = min(state.pending)
            ledger.hear(Answered(component, call, state.epoch, Verdict.DONE, "7", state.epoch))
    raise AssertionError(f"still {ledger.state.phase.value}")


@given(histories())
def test_the_machine_is_a_function(numbers: list[tuple[int, ...]]) -> None:
    one, other = State(), State()
    for drawn in numbers:
        event = event_of(one, drawn)
        (one, effects), (other, again) = step(one, event), step(other, event)
        assert (one, effects) == (other, again)


def test_a_component_that_is_named_lost_was_held_once() -> None:
    state = state_in(Phase.RUNNING)
    after, _ = step(state, Failed(IRI("urn:c:stranger"), "1", Cause.FAIL))
    assert after == state
