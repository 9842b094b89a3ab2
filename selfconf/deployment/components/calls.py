"""The calls that a configurator makes to components: reserve, activate and connect, turn off, stand by.

Every call names the task, and the life of the component that it means. A time-out is not an outcome: after one the
component is asked for its actual state, and that decides. A call is made again if the state shows that it never
arrived.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TypedDict

from selfconf.bus.port import Replies
from selfconf.configurator import (
    Answered,
    Appeared,
    ApplyTo,
    AwaitRelease,
    Call,
    Decline,
    Event,
    Failed,
    QueueFor,
    ReleaseFrom,
    ReserveOf,
    Rewired,
    State,
    WaitedLong,
    callers,
    parameter_values,
    wiring,
)
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.run_request import EventListener, Standby, TaskIdentity
from selfconf.discovery import EcologyView
from selfconf.errors import PeerError
from selfconf.model.configuration import Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.run_event import (
    ActivationSent,
    CallDeclined,
    ComponentActivated,
    ComponentAwaited,
    ComponentReleased,
    ComponentUnreachable,
    InputConnected,
    ParametersSet,
)
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk, owner_of
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    End,
    Release,
    Reserve,
    StateOf,
    Verdict,
)

log = logging.getLogger(__name__)

CALL = 2.0
"""Seconds that a component may take to answer a call before it is asked for its state."""
STARTING = 8.0
"""Seconds that a component that lives, but does not answer, may take to obey a call: it may be in `started`."""
MOST_PATIENCE = 60.0
"""Seconds that a composite may ask for at most, until its inside runs."""
PAUSE = 0.1
"""Seconds after which a component that has not answered a question for its state is asked again."""
CALL_ATTEMPTS = 3
"""How often a call is made to a component that answers, but has not obeyed: the call may have been lost."""
SITE_ENDS = 1.0
"""Seconds for which a site is waited for that ends the process of a component that has not obeyed its release."""
END_SEEN = 0.1
"""Seconds after which the end of a life is seen whose process its site has ended."""
GONE = 2.5
"""Seconds after which a component whose life has ended has turned itself off, if only the way to it was cut."""
HELD_BACK = 0.3
"""Seconds for which a component that was adopted waits at most for a composite to say what stands behind it."""
RESERVE_AGAIN = 0.5
"""Seconds after which a component that another task holds is asked again: what it says when it is free may be lost."""


class _ClaimFields(TypedDict):
    """The fields of `selfconf.protocol.messages.Claim`, which every call has."""

    epoch: int
    supervisor: str
    task: str
    life: str
    priority: int
    beginning: float


class Calls:
    """Makes the calls of one configurator, and feeds its machine with what becomes of them."""

    def __init__(
        self,
        ecology: EcologyView,
        identity: TaskIdentity,
        supervisor: str,
        lives: HeldLives,
        waking: Waking,
        ends: PortEnds,
        state: Callable[[], State],
        step: Callable[[Event], None],
        report: EventListener,
    ) -> None:
        self.bus, self.ecology, self.keys, self.identity = ecology.bus, ecology, ecology.keys, identity
        self.supervisor, self._state, self._step, self._report = supervisor, state, step, report
        self._lives, self._waking, self._ends = lives, waking, ends
        self._connections: dict[IRI, tuple[str, frozenset[Connection]]] = {}
        """The connections that each component was given, in which life, so that only new ones are reported."""
        self._held_back: list[ApplyTo] = []
        """What is applied to once it is known what stands behind the composites that it is connected to."""
        self._awaited: set[IRI] = set()
        """The components that another task holds, and that are waited for: reported once."""

    # Reserving.

    def reserve(self, effect: ReserveOf) -> None:
        """Have a component held for this task."""
        component = effect.component
        message = Reserve(
            **self._claim(component, effect.epoch),
            inputs=self._ends.wires(effect.inputs),
            values=dict(effect.values),
        )
        self._call(component, Call.RESERVE, message)

    def queue(self, effect: QueueFor) -> None:
        """Have a component remember that this task waits; nothing waits for its answer, but it may be in vain."""
        component = effect.component
        message = Reserve(**self._claim(component, effect.epoch), waits=True)

        def answered(replies: Replies) -> None:
            answer = self._answer_in(replies, message.life)
            if answer is not None:
                self._answered(component, Call.RESERVE, message, answer)

        self.bus.ask(self.keys.call(component, Call.RESERVE.value), encode(message), CALL, answered)

    def decline(self, effect: Decline) -> None:
        """Let a component that is kept for this task go to the next that waits; nothing depends on the answer."""
        message = Release(**self._claim(effect.component, effect.epoch))
        self.bus.ask(self.keys.call(effect.component, Call.RELEASE.value), encode(message), CALL, lambda replies: None)

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
        life = self._lives.life(effect.component)
        if life is None or not self.ecology.lives_on(effect.component, life):
            self._ended(effect.component, life or "")
            return
        inputs = self._ends.wires(effect.inputs)
        claim = self._claim(effect.component, effect.epoch)
        calling = self._ends.callers(effect.callers)
        message = Apply(**claim, inputs=inputs, values=dict(effect.values), callers=calling, gently=effect.gently)
        message = replace(message, rests=effect.rests)
        self._call(effect.component, Call.APPLY, message)
        connections = {Connection(w.component, w.output, effect.component, p) for p, ws in inputs.items() for w in ws}
        known, before = self._connections.get(effect.component, (life, frozenset()))
        for c in sorted(connections - before if known == life else connections):
            self._report(InputConnected(c.source, c.output, c.sink, c.input))
        self._connections[effect.component] = life, frozenset(connections)
        self._report(ActivationSent(effect.component))

    def _acts(self, component: IRI, answer: CallAnswer) -> None:
        """A component acts: connect others to what stands behind it, if that was not known before."""
        if self._ends.moved(component, answer.outputs, answer.callers):
            self._step(Rewired(component))  # before the answer: those that it calls hear of it, then all is complete
        if not any(map(self._is_to_wait, self._held_back)):
            self._apply_held_back()

    def _ended(self, component: IRI, life: str) -> None:
        """A component that is to act has ended without a FAIL: its site may start it again."""
        detail, now = "it does not live any more", self.ecology.life(component)
        self._report(ComponentUnreachable(component, Call.APPLY.value, detail))
        self._step(Failed(component, life, Cause.CRASH, detail))
        if now is not None:
            self._step(Appeared({component: now}))

    def forget_connections(self) -> None:
        """Components may have turned themselves off: all that is applied to from now on is connected anew."""
        self._connections.clear()

    def stand_by(self, configuration: Configuration, standby: Standby) -> None:
        """Let the inputs listen to what may come next, now that there is time; the answers are not waited for."""
        wires, values, calling = wiring(configuration), parameter_values(configuration), callers(configuration)
        for component, outputs in standby.items():
            claim = self._claim(component, self._state().epoch)
            inputs, spare = self._ends.wires(wires[component]), self._ends.wires(outputs)
            who = self._ends.callers(calling[component])
            message = Apply(**claim, inputs=inputs, standby=spare, values=values[component], callers=who)
            self.bus.ask(self.keys.call(component, Call.APPLY.value), encode(message), CALL, lambda replies: None)

    # Turning off.

    def release(self, effect: ReleaseFrom) -> None:
        """Turn a component off; one that lives but does not obey is called again as long as it is owed the release."""
        component = effect.component
        self._connections.pop(component, None)
        self._awaited.discard(component)
        message = Release(**self._claim(component, effect.epoch))
        if not self._lives.lives_on(component):
            self._lives.leave_behind(component)
            never_acted = self._lives.never_acted(component)
            off = Answered(component, Call.RELEASE, effect.epoch, Verdict.OTHER_LIFE if never_acted else None)
            self.bus.wake_up(lambda: self._step(off))
            if not never_acted:
                self._release_unseen(effect, message)
            return
        self.bus.later(2 * CALL, partial(self._release_again, effect))
        self._call(component, Call.RELEASE, message)

    def _release_unseen(self, effect: ReleaseFrom, message: Release) -> None:
        """Tell a component whose life seems to have ended that it is released, as it may hear this without being heard.

        It is sent again only if a life was asked and did not answer. One that cannot be reached has lost sight of its
        configurator as well, and turns itself off; one that is frozen is released when its life shows again.
        """
        component = effect.component

        def answered(replies: Replies) -> None:
            answer = self._answer_in(replies, message.life)
            if answer is not None:
                self._answered(component, Call.RELEASE, message, answer)
            elif not replies.complete:
                self.bus.later(CALL, partial(self._release_again, effect))

        self.bus.ask(self.keys.call(component, Call.RELEASE.value), encode(message), CALL, answered)

        def gone() -> None:
            """A life that has been gone for longer than its grace acts for no task, unless this node is cut off."""
            if self.bus.link and not self._lives.lives_on(component):
                self._lives.gone(component)

        self.bus.later(GONE, gone)

    def woken(self, component: IRI, life: str) -> None:
        """A component lives; perhaps it was frozen and has not been released."""
        if self._lives.was_left_behind(component, life):
            self._release_left_behind(component, life)

    def _release_left_behind(self, component: IRI, life: str) -> None:
        """Tell a life that was frozen that it is released, whatever other lives of the component have received since.

        Unless it is wanted again: then it hears that.
        """
        left = self._lives.was_left_behind(component, life) and self.ecology.lives_on(component, life)
        if not left or self._state().ended:
            return
        again = partial(self._release_left_behind, component, life)
        wanted = component in self._waking or component in self._state().held
        if wanted and self._lives.life(component) == life:
            self.bus.later(CALL, again)
            return
        message = replace(Release(**self._claim(component, self._state().epoch)), life=life)

        def answered(replies: Replies) -> None:
            answer = self._answer_in(replies, life)
            if answer is not None and answer.life == life:
                self._lives.caught_up(component, life)
            else:
                self.bus.later(CALL, again)

        self.bus.ask(self.keys.call(component, Call.RELEASE.value), encode(message), CALL, answered)

    def _release_again(self, effect: ReleaseFrom) -> None:
        if not self._state().ended and self._state().owed.get(effect.component) == effect.epoch:
            self.release(effect)

    def _end(self, component: IRI, message: Release, otherwise: Callable[[], None]) -> None:
        """Have the site end a life of a component that does not obey its release: it may act on without a task.

        `otherwise` is called if the site cannot do so, or has not within `SITE_ENDS` seconds; it may do so later.
        """
        found = self.ecology.discovery.found.get(component)
        if found is None or not found.startable or not message.life:
            otherwise()
            return

        def answered(replies: Replies) -> None:
            if replies.samples:
                self.bus.later(END_SEEN, ended)
            else:
                otherwise()

        def ended() -> None:
            if self.ecology.lives_on(component, message.life):
                otherwise()  # it was no process of the site that lives this life
                return
            self._lives.leave_behind_if_ended(component)
            if not self._lives.lives_on(component):
                self._lives.gone(component)
            detail = "its site has ended its process"
            self._report(ComponentReleased(component, detail))
            self._step(Answered(component, Call.RELEASE, message.epoch, Verdict.OTHER_LIFE, detail=detail))

        self._lives.lost(component, message.life)
        self.bus.ask(self.keys.end(found.site), encode(End(component, message.life)), SITE_ENDS, answered)

    # Looking.

    def look(self, component: IRI, seen: Callable[[CallAnswer | None], None], attempts: int = CALL_ATTEMPTS) -> None:
        """Ask a component for its actual state; `seen` receives None if it does not answer."""

        def answered(replies: Replies) -> None:
            answer = self._answer_in(replies, self._lives.life(component))
            if answer is None and not replies.complete and attempts > 1:
                self.look(component, seen, attempts - 1)
            else:
                seen(answer)

        self.bus.ask(self.keys.call(component, "state"), encode(StateOf(self.identity.task)), CALL, answered)

    # One call.

    def _call(
        self,
        component: IRI,
        call: Call,
        message: Reserve | Apply | Release,
        attempts: int = CALL_ATTEMPTS,
        first: float | None = None,
    ) -> None:
        """`first` is when the call was made for the first time."""
        began = self.bus.now()
        since = began if first is None else first
        if call is not Call.RELEASE:
            self._lives.called(component)

        def said(replies: Replies) -> CallAnswer | None:
            """What the life that is meant has answered; what another one says does not count while it may answer."""
            answer = self._answer_in(replies, message.life)
            other = answer is not None and message.life not in ("", answer.life) and not replies.complete
            return None if other and self.ecology.lives_on(component, message.life) else answer

        def answered(replies: Replies) -> None:
            answer = said(replies)
            if answer is not None:
                self._answered(component, call, message, answer)
                if answer.verdict is Verdict.OTHER_LIFE and replies.complete:
                    self._outlived(component, message.life, answer)
            elif replies.errors:
                detail = replies.errors[0]
                self._step(Answered(component, call, message.epoch, Verdict.REFUSED, detail=detail))
            elif isinstance(message, Release) and not replies.complete:
                self._end(component, message, inspect)
            else:
                inspect()

        def inspect() -> None:
            """A time-out is not an outcome: ask for the actual state, then decide."""
            question = encode(StateOf(self.identity.task))
            self.bus.ask(self.keys.call(component, "state"), question, PAUSE if hasty else CALL, seen)

        hasty = call is Call.RELEASE

        def seen(replies: Replies) -> None:
            answer = said(replies)
            current = message.epoch == self._state().epoch
            silent = answer is None and not replies.errors
            if answer is not None and self._obeyed(answer, call, message):
                self._answered(component, call, message, answer)
            elif answer is not None and current and self.bus.now() - began < min(answer.patience, MOST_PATIENCE):
                self.bus.later(PAUSE, inspect)  # its inside is being started
            elif attempts > 1 and answer is not None and current and not hasty:
                self._call(component, call, message, attempts - 1, since)
            elif answer is not None and current and not hasty and self._works_on(answer, message, since):
                self._call(component, call, message, 1, since)
            elif silent and current and not hasty and self.bus.now() - began < STARTING:
                self.bus.later(PAUSE, inspect)  # it may be in `started`; if its life ends, it is lost at once
            elif current or hasty:
                stopping = answer is not None and answer.stopping
                detail = "its code has not come to rest" if stopping else "it does not answer"
                self._unreachable(component, call, message.epoch, detail)

        self.bus.ask(self.keys.call(component, call.value), encode(message), CALL, answered)

    def _obeyed(self, answer: CallAnswer, call: Call, message: Reserve | Apply | Release) -> bool:
        """Whether a component's state shows that it has obeyed a call of this configurator."""
        if answer.epoch != message.epoch:
            return False
        mine = answer.task == message.task and answer.supervisor == message.supervisor
        if call is Call.RELEASE:
            return not mine and not answer.stopping
        if call is Call.APPLY and answer.patience:
            return False  # it acts, but follows what it followed before
        return mine and answer.active == (call is Call.APPLY)

    def _works_on(self, answer: CallAnswer, message: Reserve | Apply | Release, since: float) -> bool:
        """Whether a component that has not obeyed a call may do so yet: its code starts, or has not come to rest.

        Code that takes longer than it may is a failure, of which the component speaks itself.
        """
        found = self.ecology.discovery.found.get(answer.component)
        deadline = found.advertisement.profile.deadline if found is not None else None
        came = answer.epoch == message.epoch and answer.task == message.task
        return (came or answer.stopping) and self.bus.now() - since < max(STARTING, deadline or 0.0) + CALL

    def _answered(self, component: IRI, call: Call, message: Reserve | Apply | Release, answer: CallAnswer) -> None:
        detail = answer.detail or answer.verdict.value
        if answer.verdict is not Verdict.DONE:
            if call is Call.APPLY:
                self._report(CallDeclined(component, detail))
        elif call is Call.RELEASE:
            if self._lives.has_obeyed(component, answer.life):  # else this task has only waited for it
                self._report(ComponentReleased(component, detail))
            self._lives.released(component)
        elif isinstance(message, Apply):
            if message.values:
                self._report(ParametersSet(component, detail))
            self._report(ComponentActivated(component, detail))
        if answer.verdict is Verdict.DONE and call is not Call.RELEASE:
            self._lives.obeyed(component, answer.life)
        if answer.verdict is Verdict.DONE and call is Call.APPLY:
            self._acts(component, answer)
        holder = None
        if answer.verdict is Verdict.BUSY:
            holder = Holder(answer.task, answer.priority, answer.beginning, _configurator(answer), answer.active)
        newest, epoch = answer.epoch, message.epoch
        self._step(Answered(component, call, epoch, answer.verdict, answer.life, newest, answer.detail, holder))

    def _outlived(self, component: IRI, life: str, answer: CallAnswer) -> None:
        """Believe that a life has ended, as all were asked, and only another one has answered.

        The notices of its end, and of the beginning of the other, may have come before, or be lost with a link.
        """
        self.ecology.ended(component_chunk(component), life)
        if self.ecology.lives_on(component, answer.life):
            self._step(Appeared({component: answer.life}))

    def _unreachable(self, component: IRI, call: Call, epoch: int, detail: str) -> None:
        self._report(ComponentUnreachable(component, call.value, detail))
        answer = Answered(component, call, epoch, None, detail=detail)
        self.bus.wake_up(lambda: self._step(answer))

    def _claim(self, component: IRI, epoch: int) -> _ClaimFields:
        """What every call says: see `selfconf.protocol.messages.Claim`."""
        return {
            "epoch": epoch,
            "supervisor": self.supervisor,
            "task": self.identity.task,
            "life": self._lives.life(component) or "",
            "priority": self.identity.priority,
            "beginning": self.identity.beginning,
        }

    def _answer_in(self, replies: Replies, life: str | None) -> CallAnswer | None:
        """The answer of the life that was meant, if it has answered; else that of another."""
        answers: list[CallAnswer] = []
        for sample in replies.samples:
            try:
                answers.append(decode(sample.payload, CallAnswer))
            except PeerError as error:
                log.warning("passed over an answer on %s: %s", sample.key, error)
        return min(answers, key=lambda answer: answer.life != life, default=None)


def _configurator(answer: CallAnswer) -> str:
    try:
        return owner_of(answer.supervisor)
    except PeerError:
        return ""
