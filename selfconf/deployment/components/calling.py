"""One call of a configurator to a component, and what has become of it.

Every call names the task, and the life of the component that it means. A time-out is not an outcome: after one the
component is asked for its actual state, and that decides. A call is made again if the state shows that it never
arrived.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import TypedDict

from selfconf.bus.port import Replies
from selfconf.configurator import Answered, Appeared, Call, Unanswered
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.task_context import TaskContext
from selfconf.errors import PeerError
from selfconf.model.holder import Holder
from selfconf.model.profile import START_DEADLINE
from selfconf.model.run_event import (
    CallDeclined,
    ComponentActivated,
    ComponentReleased,
    ComponentUnreachable,
    ParametersSet,
)
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk, owner_of, task_name
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, StateOf, Verdict

log = logging.getLogger(__name__)

CALL = 2.0
"""Seconds that a component may take to answer a call before it is asked for its state."""
STARTING = START_DEADLINE
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


CallMessage = Reserve | Apply | Release
"""What goes with a call to a component, and says which call it is."""
_CALL_OF: dict[type[CallMessage], Call] = {Reserve: Call.RESERVE, Apply: Call.APPLY, Release: Call.RELEASE}
LastResort = Callable[[Callable[[], None]], None]
"""What is done where a call has not been answered in time; it is given what there is to do otherwise."""


class Calling:
    """Makes single calls for one configurator, and feeds its machine with what becomes of them."""

    def __init__(
        self,
        context: TaskContext,
        lives: HeldLives,
        acts: Callable[[IRI, CallAnswer], None],
    ) -> None:
        """`acts` is called when a component has answered that it acts as it was applied to."""
        self.bus, self.ecology, self.keys = context.ecology.bus, context.ecology, context.ecology.keys
        self._identity, self._supervisor = context.identity, context.supervisor
        self.state, self.step, self._report = context.state, context.step, context.report
        self.lives, self._acts = lives, acts
        self._latest: dict[IRI, CallMessage] = {}
        """The last call that was made to each component."""

    def ask(
        self,
        component: IRI,
        message: CallMessage,
        answered: Callable[[Replies], None] = lambda replies: None,
    ) -> None:
        """Make a call once, whatever becomes of it."""
        self.bus.ask(self.keys.call(component, _CALL_OF[type(message)].value), encode(message), CALL, answered)

    def look(self, component: IRI, seen: Callable[[CallAnswer | None], None], attempts: int = CALL_ATTEMPTS) -> None:
        """Ask a component for its actual state; `seen` receives None if it does not answer."""

        def answered(replies: Replies) -> None:
            answer = self.answer_in(replies, self.lives.life(component))
            if answer is None and not replies.complete and attempts > 1:
                self.look(component, seen, attempts - 1)
            else:
                seen(answer)

        self.ask_for_state(component, CALL, answered)

    def ask_for_state(self, component: IRI, seconds: float, answered: Callable[[Replies], None]) -> None:
        """Ask a component once for its actual state, for which it may take so many seconds."""
        question = encode(StateOf(self._identity().task))
        self.bus.ask(self.keys.call(component, "state"), question, seconds, answered)

    def call(self, component: IRI, message: CallMessage, last_resort: LastResort | None = None) -> None:
        """Make a call; what has become of it is stepped, as `Answered`.

        `last_resort` is called once, where no answer has come in time, or none to the question for the component's
        state, with what there is to do otherwise: to ask for the state, or to give up.
        """
        self._latest[component] = message
        _PendingCall(self, component, message, last_resort).make()

    def stands(self, component: IRI, message: CallMessage) -> bool:
        """Whether a call holds in later epochs as well: it brings to rest what is held, and is the last one to that."""
        rests = isinstance(message, Apply) and message.rests
        return rests and self._latest.get(component) is message and component in self.state().held

    def answered(self, component: IRI, message: CallMessage, answer: CallAnswer) -> None:
        """A component has answered a call, or its state shows that it has obeyed: report it, and step."""
        self._tell(component, message, answer)
        if answer.verdict is Verdict.DONE and isinstance(message, Release):
            self.lives.released(component, message.epoch)
        if answer.verdict is Verdict.DONE and not isinstance(message, Release):
            self.lives.obeyed(component, answer.life, message.epoch, late=message.epoch != self.state().epoch)
        if answer.verdict is Verdict.DONE and isinstance(message, Apply):
            self._acts(component, answer)
        holder = None
        if answer.verdict is Verdict.BUSY:
            holder = Holder(answer.task, answer.priority, answer.beginning, _configurator(answer), answer.active)
        acts = answer.verdict is Verdict.DONE and answer.active
        call, newest, epoch, verdict = _CALL_OF[type(message)], answer.epoch, message.epoch, answer.verdict
        said = answer.detail, holder, answer.shared, acts
        self.step(Answered(component, call, epoch, verdict, answer.life, newest, *said))

    def _tell(self, component: IRI, message: CallMessage, answer: CallAnswer) -> None:
        """Report what a component has done by its answer.

        One that is to rest has its parameters, and does not act. What one says that was given up meanwhile is over.
        """
        detail = answer.detail or answer.verdict.value
        if answer.verdict is not Verdict.DONE:
            if isinstance(message, Apply):
                self._report(CallDeclined(component, detail))
        elif isinstance(message, Release):
            if self.lives.has_obeyed(component, answer.life):  # else this task has only waited for it
                goes_on_for = task_name(answer.task) if answer.active else ""
                self._report(ComponentReleased(component, detail, goes_on_for))
        elif isinstance(message, Apply) and component in self.state().held:
            if message.values:
                self._report(ParametersSet(component, detail))
            if not message.rests:
                self._report(ComponentActivated(component, detail))

    def outlived(self, component: IRI, life: str, answer: CallAnswer) -> None:
        """Believe that a life has ended, as all were asked, and only another one has answered.

        The notices of its end, and of the beginning of the other, may have come before, or be lost with a link.
        """
        self.ecology.ended(component_chunk(component), life)
        if self.ecology.lives_on(component, answer.life):
            self.step(Appeared({component: answer.life}))

    def unreachable(self, component: IRI, message: CallMessage, detail: str) -> None:
        """It is not known what has become of a call, and nothing more is tried: report it, and step soon."""
        call = _CALL_OF[type(message)]
        self._report(ComponentUnreachable(component, call.value, detail))
        answer = Answered(component, call, message.epoch, Unanswered.SILENT, detail=detail)
        self.bus.wake_up(lambda: self.step(answer))

    def claim(self, component: IRI, epoch: int) -> _ClaimFields:
        """What every call says: see `selfconf.protocol.messages.Claim`."""
        identity = self._identity()
        return {
            "epoch": epoch,
            "supervisor": self._supervisor,
            "task": identity.task,
            "life": self.lives.life(component) or "",
            "priority": identity.priority,
            "beginning": identity.beginning,
        }

    def answer_in(self, replies: Replies, life: str | None) -> CallAnswer | None:
        """The answer of the life that was meant, if it has answered; else that of another."""
        answers, problems = _read(replies)
        for key, problem in problems.items():
            log.warning("passed over an answer on %s: %s", key, problem)
        return min(answers, key=lambda answer: answer.life != life, default=None)


class _PendingCall:
    """One call to one component, made once or several times, until it is known what has become of it."""

    def __init__(self, calling: Calling, component: IRI, message: CallMessage, last_resort: LastResort | None) -> None:
        self._calling, self._component, self._message = calling, component, message
        self._last_resort = last_resort
        self._made = 0
        """How often the call was made."""
        self._first = self._last = calling.bus.now()
        """When it was made for the first time, and for the last."""

    def make(self) -> None:
        """Make the call, once more where it was made before."""
        self._made += 1
        self._last = self._calling.bus.now()
        if not isinstance(self._message, Release):
            self._calling.lives.called(self._component)
        self._calling.ask(self._component, self._message, self._answered)

    def _answered(self, replies: Replies) -> None:
        answer = self._said(replies)
        if answer is not None:
            self._calling.answered(self._component, self._message, answer)
            if answer.verdict is Verdict.OTHER_LIFE and replies.complete:
                self._calling.outlived(self._component, self._message.life, answer)
        elif replies.errors:
            call, epoch = _CALL_OF[type(self._message)], self._message.epoch
            self._calling.step(Answered(self._component, call, epoch, Verdict.REFUSED, detail=replies.errors[0]))
        elif not replies.complete:
            self._do_unanswered(self._inspect)
        else:
            self._inspect()

    def _do_unanswered(self, otherwise: Callable[[], None]) -> None:
        """Do once what the caller does where no answer comes; it is given what there is to do otherwise."""
        last_resort, self._last_resort = self._last_resort, None
        if last_resort is not None:
            last_resort(otherwise)
        else:
            otherwise()

    def _said(self, replies: Replies) -> CallAnswer | None:
        """What the life that is meant has answered; what another one says does not count while it may answer."""
        answer = self._calling.answer_in(replies, self._message.life)
        other = answer is not None and self._message.life not in ("", answer.life) and not replies.complete
        waits = other and self._calling.ecology.lives_on(self._component, self._message.life)
        return None if waits else answer

    def _inspect(self) -> None:
        """A time-out is not an outcome: ask for the actual state, then decide."""
        self._calling.ask_for_state(self._component, PAUSE if self._hasty else CALL, self._seen)

    @property
    def _hasty(self) -> bool:
        """Whether nothing is waited for: a release is made again later as long as it is owed."""
        return isinstance(self._message, Release)

    def _seen(self, replies: Replies) -> None:
        """Decide by the state of the component.

        A call of an older epoch is made again only if none has been made since, and nothing depends on its answer: it
        may have brought an actuator to rest.
        """
        answer = self._said(replies)
        if answer is not None and self._has_obeyed(answer):
            self._calling.answered(self._component, self._message, answer)
            return
        current = self._message.epoch == self._calling.state().epoch
        counts = current or self._calling.stands(self._component, self._message)
        if counts and self._takes_longer(answer, replies):
            self._calling.bus.later(PAUSE, self._inspect)
        elif counts and self._is_made_again(answer):
            self.make()
        elif current or self._hasty:
            detail = _what_is_wrong(answer, replies)
            give_up = partial(self._calling.unreachable, self._component, self._message, detail)
            if answer is None:
                self._do_unanswered(give_up)  # its process may have ended while it was to answer
            else:
                give_up()

    def _takes_longer(self, answer: CallAnswer | None, replies: Replies) -> bool:
        """Whether to ask once more in a moment: its inside is being started, or itself, for all that is known."""
        elapsed = self._calling.bus.now() - self._last
        if answer is not None:
            return elapsed < min(answer.patience, MOST_PATIENCE)
        # It may be in `started`; if its life ends, it is lost at once.
        return not replies.errors and not self._hasty and elapsed < STARTING

    def _is_made_again(self, answer: CallAnswer | None) -> bool:
        """Whether to make the call once more, to a component that answers but has not obeyed."""
        return answer is not None and not self._hasty and (self._made < CALL_ATTEMPTS or self._works_on(answer))

    def _has_obeyed(self, answer: CallAnswer) -> bool:
        """Whether a component's state shows that it has obeyed the call of this configurator."""
        message = self._message
        if answer.epoch != message.epoch:
            return False
        mine = answer.task == message.task and answer.supervisor == message.supervisor
        if isinstance(message, Release):
            return not mine and not answer.stopping
        if isinstance(message, Apply) and answer.patience:
            return False  # it acts, but follows what it followed before
        return mine and answer.active == isinstance(message, Apply)

    def _works_on(self, answer: CallAnswer) -> bool:
        """Whether a component that has not obeyed may do so yet: its code starts, or has not come to rest.

        Code that takes longer than it may is a failure, of which the component speaks itself.
        """
        found = self._calling.ecology.discovery.found.get(answer.component)
        deadline = found.advertisement.profile.deadline if found is not None else None
        came = answer.epoch == self._message.epoch and answer.task == self._message.task
        elapsed = self._calling.bus.now() - self._first
        return (came or answer.stopping) and elapsed < max(STARTING, deadline or 0.0) + CALL


def _read(replies: Replies) -> tuple[list[CallAnswer], dict[str, str]]:
    """The answers among some replies, and by its key what is wrong with each that is none."""
    answers: list[CallAnswer] = []
    problems: dict[str, str] = {}
    for sample in replies.samples:
        try:
            answers.append(decode(sample.payload, CallAnswer))
        except PeerError as error:
            problems[sample.key] = str(error)
    return answers, problems


def _what_is_wrong(answer: CallAnswer | None, replies: Replies) -> str:
    """Why a component counts as out of reach, in words."""
    if answer is not None and answer.stopping:
        return "its code has not come to rest"
    _, problems = _read(replies)  # a program in another language may answer what is no answer: its author needs to know
    return next((f"its answer cannot be read: {problem}" for problem in problems.values()), "it does not answer")


def _configurator(answer: CallAnswer) -> str:
    try:
        return owner_of(answer.supervisor)
    except PeerError:
        return ""
