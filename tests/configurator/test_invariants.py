"""What holds in every history of the machine, however the events come."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.configurator.effects import ApplyTo, Compose, Effect, Finish, ReleaseFrom, SetOn, Unwatch, Watch
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Reconnected,
    Stopped,
)
from selfconf.configurator.machine import OBEYED, step
from selfconf.configurator.state import Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import CONTROL, EVERYBODY, ODOMETRY, REFUSAL, TRACKER, navigation, state_in

AT_REST = (Phase.IDLE, Phase.REFUSED, Phase.STOPPED)
ONE_OF_EACH: list[Event] = [
    Accepted(500),
    Discovered(),
    Composed(1, navigation()),
    Composed(1, REFUSAL),
    Composed(0, navigation()),
    *(
        Answered(component, call, epoch, verdict, "1", epoch + 1)
        for component in (TRACKER, CONTROL, ODOMETRY)
        for call in Call
        for epoch in (1, 100, 101, 102, 103)
        for verdict in (*Verdict, None)
    ),
    *(Failed(component, life, cause) for component in EVERYBODY for life in ("", "1", "9") for cause in Cause),
    Appeared({}),
    Appeared({TRACKER: "1"}),
    Appeared({TRACKER: "2", ODOMETRY: "1"}),
    Reconnected(),
    Stopped(),
]


class Ledger:
    """Keeps account of what the machine has wanted done, and checks the invariants after every step."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.watched = set(state.watched)
        self.maybe_active = {*state.held, *state.owed}
        self.finished = 0

    def hear(self, event: Event) -> None:
        """One step, with everything that must hold."""
        before, over = self.state, bool(self.finished)
        self.state, effects = step(before, event)
        state = self.state
        assert state.epoch >= before.epoch
        assert state.attempt >= before.attempt
        for effect in effects:
            self._account(effect, before)
        if isinstance(event, Answered) and event.call is Call.RELEASE and event.verdict in OBEYED:
            taken_down = event.component not in state.held or state.phase is Phase.DISMANTLING
            if event.component not in state.owed and taken_down:
                self.maybe_active.discard(event.component)
        assert self.maybe_active <= {*state.held, *state.owed}
        assert not set(state.held) & set(state.owed) or state.phase is Phase.DISMANTLING
        assert state.watched == self.watched
        assert set(state.held) <= state.watched or state.phase is Phase.DISMANTLING
        if state.phase in AT_REST:
            assert not state.held
            assert not state.pending
            assert not state.watched
        if state.phase is Phase.RUNNING:
            assert state.target is not None
            assert set(state.held) == set(state.target.components)
            assert all(held.confirmed for held in state.held.values())
            for setting in state.target.settings:
                assert state.held[setting.component].values[setting.name] == setting.value
        if state.phase in (Phase.DEPLOYING, Phase.SETTING, Phase.DISMANTLING):
            assert state.pending
        else:
            assert not state.pending
        assert not any(component in state.lost for component in state.held)
        assert self.finished <= 1
        assert not (over and effects)

    def _account(self, effect: Effect, before: State) -> None:
        match effect:
            case Watch(component):
                self.watched.add(component)
            case Unwatch(component):
                self.watched.discard(component)
            case ApplyTo(component, epoch):
                assert component in self.watched
                assert epoch > before.epoch
                self.maybe_active.add(component)
            case SetOn(component, epoch):
                assert component in self.maybe_active
                assert epoch == self.state.epoch
            case ReleaseFrom(component, epoch):
                assert component not in self.state.held or self.state.phase is Phase.DISMANTLING
                assert epoch <= self.state.epoch
            case Compose(_, lost, _):
                assert lost == set(self.state.lost)
            case Finish():
                self.finished += 1


@pytest.mark.parametrize("phase", Phase)
@pytest.mark.parametrize("policy", Policy)
@pytest.mark.parametrize("patient", [False, True])
def test_every_phase_answers_every_event(phase: Phase, policy: Policy, patient: bool) -> None:
    for event in ONE_OF_EACH:
        state = state_in(phase, policy=policy, patient=patient)
        assert state.phase is phase
        Ledger(state).hear(event)


@st.composite
def histories(draw: st.DrawFn) -> list[tuple[int, ...]]:
    """Random numbers that a history is made of; they are read against the state they meet."""
    return draw(st.lists(st.tuples(*[st.integers(0, 50)] * 5), min_size=5, max_size=80))


def event_of(state: State, numbers: tuple[int, ...]) -> Event:
    """An event that can come in a state: mostly the one that is waited for, often another."""
    kind, who, how, when, which = numbers
    component = EVERYBODY[who % len(EVERYBODY)]
    if state.pending and kind < 25:
        component, call = sorted(state.pending)[who % len(state.pending)]
        verdict = [Verdict.DONE, Verdict.DONE, Verdict.DONE, Verdict.DONE, Verdict.REFUSED, Verdict.STALE, None][
            how % 7
        ]
        return Answered(component, call, state.epoch, verdict, str(which % 2), state.epoch + when)
    if kind < 30:
        choices: list[Event] = [Accepted(when), Discovered(), Composed(state.attempt, navigation())]
        return choices[how % 3]
    if kind < 34:
        free = [c for c in (TRACKER, ODOMETRY) if c not in state.lost]
        possible = bool(free) and not {CONTROL, EVERYBODY[3]} & set(state.lost)
        return Composed(state.attempt, navigation(free[how % len(free)]) if possible else REFUSAL)
    if kind < 38:
        verdict = [*Verdict, None][how % 5]
        return Answered(component, list(Call)[which % 3], max(0, state.epoch - when % 3), verdict, "1", state.epoch)
    if kind < 43:
        return Failed(component, ["", "0", "1"][which % 3], list(Cause)[how % 4])
    if kind < 47:
        return Appeared({component: str(which % 3)} if how % 2 else {})
    if kind < 49:
        return Reconnected()
    return Stopped()


@given(histories(), st.sampled_from(Policy), st.booleans())
def test_the_invariants_hold_in_every_history(numbers: list[tuple[int, ...]], policy: Policy, patient: bool) -> None:
    ledger = Ledger(State(policy=policy, patient=patient))
    ledger.hear(Accepted(10))
    for drawn in numbers:
        event = event_of(ledger.state, drawn)
        found = event.outcome if isinstance(event, Composed) else REFUSAL
        if isinstance(found, Configuration) and set(found.components) & set(ledger.state.lost):
            continue  # no search answers with a component that it was told is lost
        ledger.hear(event)


@given(histories(), st.sampled_from(Policy), st.booleans())
def test_from_every_state_a_stop_ends_once_the_pending_calls_have_ended(
    numbers: list[tuple[int, ...]], policy: Policy, patient: bool
) -> None:
    state, _ = step(State(policy=policy, patient=patient), Accepted(10))
    for drawn in numbers:
        state, _ = step(state, event_of(state, drawn))
    state, _ = step(state, Stopped())
    for component, call in sorted(state.pending):
        state, _ = step(state, Answered(component, call, state.epoch, None))
    assert state.phase in (Phase.STOPPED, Phase.REFUSED)
    assert not state.held


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
