"""The calls that a configurator makes to components: reserve, activate and connect, turn off, stand by.

How one call is made, and what becomes of it, is in `calling`, what follows where a component does not obey its release
in `releases`.
"""

from __future__ import annotations

from functools import partial

from selfconf.bus.port import Replies
from selfconf.configurator import (
    Appeared,
    ApplyTo,
    AwaitRelease,
    Call,
    Decline,
    Failed,
    QueueFor,
    ReleaseFrom,
    ReserveOf,
    Rewired,
    WaitedLong,
    plan_of,
)
from selfconf.deployment.components.calling import Calling
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.components.releases import Releases
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.run_request import Standby
from selfconf.deployment.task_context import TaskContext
from selfconf.model.configuration import Configuration, Connection
from selfconf.model.run_event import (
    ActivationSent,
    ComponentAwaited,
    ComponentUnreachable,
    InputConnected,
)
from selfconf.model.term import IRI
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    Release,
    Reserve,
)

HELD_BACK = 0.3
"""Seconds for which a component that was adopted waits at most for a composite to say what stands behind it."""
RESERVE_AGAIN = 0.5
"""Seconds after which a component that another task holds is asked again: what it says when it is free may be lost."""


class Calls:
    """Makes the calls of one configurator, and feeds its machine with what becomes of them."""

    def __init__(
        self,
        context: TaskContext,
        lives: HeldLives,
        waking: Waking,
        ends: PortEnds,
    ) -> None:
        self.bus, self.ecology, self.keys = context.ecology.bus, context.ecology, context.ecology.keys
        self._state, self._step, self._report = context.state, context.step, context.report
        self._lives, self._ends = lives, ends
        self._calling = Calling(context, lives, self._acts)
        self._releases = Releases(context, lives, waking, self._calling)
        self.look = self._calling.look
        self._connections: dict[IRI, tuple[str, frozenset[Connection]]] = {}
        """The connections that each component was given, in which life, so that only new ones are reported."""
        self._stood_by: dict[IRI, Apply] = {}
        """By which call each component listens to what may come next, until it is applied to anew."""
        self._held_back: list[ApplyTo] = []
        """What is applied to once it is known what stands behind the composites that it is connected to."""
        self._awaited: set[IRI] = set()
        """The components that another task holds, and that are waited for: reported once."""

    # Reserving.

    def reserve(self, effect: ReserveOf) -> None:
        """Have a component held for this task: one that can be shared, once it is known what really feeds it.

        Tasks share a component that is to follow the same outputs for all of them. Behind a composite that acts for
        another task stand outputs inside, of which this task has not heard.
        """
        held = self._state().held
        shareable = self.ecology.may_be_shared(effect.component)
        feeding = self._ends.feeding(effect.inputs) if shareable else set()
        unheard = {one for one in feeding if not (one in held and held[one].acts)}
        if not unheard:
            self._reserve(effect)

        def seen(composite: IRI, answer: CallAnswer | None) -> None:
            if answer is not None and answer.active:
                self._ends.moved(composite, answer.outputs, answer.callers)
            unheard.discard(composite)
            if not unheard and effect.epoch == self._state().epoch and not self._state().ended:
                self._reserve(effect)

        for one in tuple(unheard):
            self._calling.look(one, partial(seen, one), 1)

    def _reserve(self, effect: ReserveOf) -> None:
        component = effect.component
        if self._fails_as_ended(component, Call.RESERVE):
            return
        message = Reserve(
            **self._calling.claim(component, effect.epoch),
            inputs=self._ends.wires(effect.inputs),
            values=dict(effect.values),
        )
        self._calling.call(component, message)

    def queue(self, effect: QueueFor) -> None:
        """Have a component remember that this task waits; nothing waits for its answer, but it may be in vain."""
        component = effect.component
        message = Reserve(**self._calling.claim(component, effect.epoch), waits=True)

        def answered(replies: Replies) -> None:
            answer = self._calling.answer_in(replies, message.life)
            if answer is not None:
                self._calling.answered(component, message, answer)

        self._calling.ask(component, message, answered)

    def decline(self, effect: Decline) -> None:
        """Let a component that is kept for this task, and does not act for it, go; nothing depends on the answer."""
        message = Release(**self._calling.claim(effect.component, effect.epoch))
        self._calling.ask(effect.component, message)

    def await_release(self, effect: AwaitRelease) -> None:
        """Ask again after a while for a component that another task holds."""
        if effect.component not in self._awaited:
            self._awaited.add(effect.component)
            self._report(ComponentAwaited(effect.component))
        self.bus.later(RESERVE_AGAIN, lambda: self._step(WaitedLong(effect.component, effect.epoch)))

    # Activating.

    def apply(self, effect: ApplyTo) -> None:
        """Activate a component with its parameters, and connect its inputs.

        One that was adopted is connected already: what stands behind a composite is asked before it hears of it anew.
        """
        if effect.adopted and self._is_to_wait(effect):
            self._held_back.append(effect)
            self.bus.later(HELD_BACK, self._apply_held_back)
        else:
            self._apply(effect)

    def _is_to_wait(self, effect: ApplyTo) -> bool:
        """Whether a composite that it is connected to acts already, and so is about to say what stands behind it.

        A composite itself does not wait: those of a circle would wait for each other.
        """
        held, unknown = self._state().held, self._ends.unknown(effect.inputs, effect.callers)
        acts = any(one in held and held[one].acts for one in unknown)
        return acts and not self._ends.is_composite(effect.component)

    def _apply_held_back(self) -> None:
        """Apply to those that were held back, whatever is known by now: a component waits for a second at most."""
        held_back, self._held_back = self._held_back, []
        for effect in held_back:
            if effect.epoch == self._state().epoch and not self._state().ended:
                self._apply(effect)

    def _apply(self, effect: ApplyTo) -> None:
        if self._fails_as_ended(effect.component, Call.APPLY):
            return
        inputs = self._ends.wires(effect.inputs)
        claim = self._calling.claim(effect.component, effect.epoch)
        calling = self._ends.callers(effect.callers)
        values, gently, rests = dict(effect.values), effect.gently, effect.rests
        message = Apply(**claim, inputs=inputs, values=values, callers=calling, gently=gently, rests=rests)
        self._stood_by.pop(effect.component, None)
        self._calling.call(effect.component, message)
        connections = {Connection(w.component, w.output, effect.component, p) for p, ws in inputs.items() for w in ws}
        life = message.life
        known, before = self._connections.get(effect.component, (life, frozenset()))
        for c in sorted(connections - before if known == life else connections):
            self._report(InputConnected(c.source, c.output, c.sink, c.input))
        self._connections[effect.component] = life, frozenset(connections)
        self._report(ActivationSent(effect.component))

    def _acts(self, component: IRI, answer: CallAnswer) -> None:
        """A component acts: connect others to what stands behind it."""
        self.heed_ends(component, answer)  # before the answer: those that it calls hear of it, then all is complete
        if not any(map(self._is_to_wait, self._held_back)):
            self._apply_held_back()

    def heed_ends(self, component: IRI, answer: CallAnswer) -> None:
        """Connect others to what stands behind a component by an answer of it, if that was not known before."""
        if self._ends.moved(component, answer.outputs, answer.callers):
            self._step(Rewired(component))

    def _fails_as_ended(self, component: IRI, call: Call) -> bool:
        """Whether a component that is to be called has ended; then it fails, and its site may start it again."""
        life = self._lives.life(component)
        if life is not None and self.ecology.lives_on(component, life):
            return False
        detail, now = "it does not live any more", self.ecology.life(component)
        self._report(ComponentUnreachable(component, call.value, detail))
        self._step(Failed(component, life or "", Cause.CRASH, detail))
        if now is not None:
            self._step(Appeared({component: now}))
        return True

    def forget_connections(self) -> None:
        """Components may have turned themselves off: all that is applied to from now on is connected anew."""
        self._connections.clear()

    def stand_by(self, configuration: Configuration, standby: Standby) -> None:
        """Let the inputs listen to what may come next, now that there is time; the answers are not waited for.

        Only those are called for which that is other than before.
        """
        plan = plan_of(configuration)
        for component, outputs in standby.items():
            claim = self._calling.claim(component, self._state().epoch)
            inputs, spare = self._ends.wires(plan.inputs[component]), self._ends.wires(outputs)
            who = self._ends.callers(plan.callers[component])
            rests = self._state().held[component].rests
            message = Apply(
                **claim, inputs=inputs, standby=spare, values=plan.values[component], callers=who, rests=rests
            )
            if self._stood_by.get(component) != message:
                self._stood_by[component] = message
                self._calling.ask(component, message)

    # Turning off.

    def release(self, effect: ReleaseFrom) -> None:
        """Turn a component off."""
        self._connections.pop(effect.component, None)
        self._awaited.discard(effect.component)
        self._releases.release(effect)

    def expect_gone(self, component: IRI) -> None:
        """A component seems to have ended: if it has no life either when it has turned itself off, it is gone."""
        self._releases.expect_gone(component)

    def woken(self, component: IRI, life: str) -> None:
        """A component lives; perhaps it was frozen and has not been released."""
        self._releases.woken(component, life)
