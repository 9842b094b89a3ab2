"""One call of a configurator to a component, and what has become of it.

Every call names the task, and the life of the component that it means. A time-out is not an outcome: after one the
component is asked for its actual state, and that decides. A call is made again if the state shows that it never
arrived.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TypedDict

from selfconf.bus.port import Replies
from selfconf.configurator import Answered, Appeared, Call, Event, State
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.run_request import EventListener, TaskIdentity
from selfconf.discovery import EcologyView
from selfconf.errors import PeerError
from selfconf.model.holder import Holder
from selfconf.model.run_event import (
    CallDeclined,
    ComponentActivated,
    ComponentReleased,
    ComponentUnreachable,
    ParametersSet,
)
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk, owner_of
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, StateOf, Verdict

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


class _ClaimFields(TypedDict):
    """The fields of `selfconf.protocol.messages.Claim`, which every call has."""

    epoch: int
    supervisor: str
    task: str
    life: str
    priority: int
    beginning: float


class Calling:
    """Makes single calls for one configurator, and feeds its machine with what becomes of them."""

    def __init__(
        self,
        ecology: EcologyView,
        identity: TaskIdentity,
        supervisor: str,
        lives: HeldLives,
        state: Callable[[], State],
        step: Callable[[Event], None],
        report: EventListener,
        acts: Callable[[IRI, CallAnswer], None],
    ) -> None:
        """`acts` is called when a component has answered that it acts as it was applied to."""
        self.bus, self.ecology, self.keys, self.identity = ecology.bus, ecology, ecology.keys, identity
        self.supervisor, self._state, self._step, self._report = supervisor, state, step, report
        self._lives, self._acts = lives, acts

    def ask(
        self,
        component: IRI,
        call: Call,
        message: Reserve | Apply | Release,
        answered: Callable[[Replies], None] = lambda replies: None,
    ) -> None:
        """Make a call once, whatever becomes of it."""
        self.bus.ask(self.keys.call(component, call.value), encode(message), CALL, answered)

    def look(self, component: IRI, seen: Callable[[CallAnswer | None], None], attempts: int = CALL_ATTEMPTS) -> None:
        """Ask a component for its actual state; `seen` receives None if it does not answer."""

        def answered(replies: Replies) -> None:
            answer = self.answer_in(replies, self._lives.life(component))
            if answer is None and not replies.complete and attempts > 1:
                self.look(component, seen, attempts - 1)
            else:
                seen(answer)

        self.bus.ask(self.keys.call(component, "state"), encode(StateOf(self.identity.task)), CALL, answered)

    def call(
        self,
        component: IRI,
        call: Call,
        message: Reserve | Apply | Release,
        unanswered: Callable[[Callable[[], None]], None] | None = None,
        attempts: int = CALL_ATTEMPTS,
        first: float | None = None,
    ) -> None:
        """Make a call; what has become of it is stepped, as `Answered`.

        `unanswered` is called where no answer has come in time, with what there is to do then otherwise: to ask for
        the component's state. `first` is when the call was made for the first time.
        """
        began = self.bus.now()
        since = began if first is None else first
        if call is not Call.RELEASE:
            self._lives.called(component)

        def said(replies: Replies) -> CallAnswer | None:
            """What the life that is meant has answered; what another one says does not count while it may answer."""
            answer = self.answer_in(replies, message.life)
            other = answer is not None and message.life not in ("", answer.life) and not replies.complete
            return None if other and self.ecology.lives_on(component, message.life) else answer

        def answered(replies: Replies) -> None:
            answer = said(replies)
            if answer is not None:
                self.answered(component, call, message, answer)
                if answer.verdict is Verdict.OTHER_LIFE and replies.complete:
                    self._outlived(component, message.life, answer)
            elif replies.errors:
                detail = replies.errors[0]
                self._step(Answered(component, call, message.epoch, Verdict.REFUSED, detail=detail))
            elif unanswered is not None and not replies.complete:
                unanswered(inspect)
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
                self.answered(component, call, message, answer)
            elif answer is not None and current and self.bus.now() - began < min(answer.patience, MOST_PATIENCE):
                self.bus.later(PAUSE, inspect)  # its inside is being started
            elif attempts > 1 and answer is not None and current and not hasty:
                self.call(component, call, message, unanswered, attempts - 1, since)
            elif answer is not None and current and not hasty and self._works_on(answer, message, since):
                self.call(component, call, message, unanswered, 1, since)
            elif silent and current and not hasty and self.bus.now() - began < STARTING:
                self.bus.later(PAUSE, inspect)  # it may be in `started`; if its life ends, it is lost at once
            elif current or hasty:
                stopping = answer is not None and answer.stopping
                detail = "its code has not come to rest" if stopping else "it does not answer"
                self._unreachable(component, call, message.epoch, detail)

        self.ask(component, call, message, answered)

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

    def answered(self, component: IRI, call: Call, message: Reserve | Apply | Release, answer: CallAnswer) -> None:
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
        newest, epoch, verdict = answer.epoch, message.epoch, answer.verdict
        self._step(Answered(component, call, epoch, verdict, answer.life, newest, answer.detail, holder, answer.shared))

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

    def claim(self, component: IRI, epoch: int) -> _ClaimFields:
        """What every call says: see `selfconf.protocol.messages.Claim`."""
        return {
            "epoch": epoch,
            "supervisor": self.supervisor,
            "task": self.identity.task,
            "life": self._lives.life(component) or "",
            "priority": self.identity.priority,
            "beginning": self.identity.beginning,
        }

    def answer_in(self, replies: Replies, life: str | None) -> CallAnswer | None:
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
