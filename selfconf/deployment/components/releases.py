"""How components are turned off: until each has obeyed, has been ended by its site, or acts for no task any more.

A component that does not obey its release may act on without a task. So it is called again, and its site is asked to
end its process. One whose life has ended may only be frozen, or out of sight: it is called all the same, as it may hear
what it cannot answer, and again when that life shows.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Replies
from selfconf.configurator import Answered, Call, ReleaseFrom, Unanswered
from selfconf.deployment.components.calling import CALL, Calling
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.task_context import TaskContext
from selfconf.model.immutable import replace
from selfconf.model.run_event import ComponentReleased
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import End, Release, Verdict

SITE_ENDS = 2.5
"""Seconds for which a site is waited for that ends the process of a component that has not obeyed its release: it kills
a process that takes more than two."""
END_SEEN = 0.1
"""Seconds after which the end of a life is seen whose process its site has ended."""
LET_GO_SINCE = b"let go"
"""What a site replies that finds that a component acts for the task no more, and so has not ended it."""
GONE = 2.5
"""Seconds after which a component whose life has ended has turned itself off, if only the way to it was cut."""
RELEASE_AGAIN = 2.5
"""Seconds after which a component that lives and has not obeyed its release is called again: it may act until then."""


class Releases:
    """Turns the components of one task off."""

    def __init__(self, context: TaskContext, lives: HeldLives, waking: Waking, calling: Calling) -> None:
        self._bus, self._ecology = context.ecology.bus, context.ecology
        self._state, self._step, self._report = context.state, context.step, context.report
        self._lives, self._waking, self._calling = lives, waking, calling
        self._ending: set[IRI] = set()
        """The components whose sites were asked to end their processes, and have not answered yet."""

    def release(self, effect: ReleaseFrom) -> None:
        """Turn a component off; one that lives but does not obey is called again as long as it is owed the release."""
        component = effect.component
        message = Release(**self._calling.claim(component, effect.epoch))
        if not self._lives.lives_on(component):
            self._lives.leave_behind(component)
            never_acted = self._lives.never_acted(component)
            ended = Verdict.OTHER_LIFE if never_acted else Unanswered.ENDED
            off = Answered(component, Call.RELEASE, effect.epoch, ended)
            self._bus.wake_up(lambda: self._step(off))
            if not never_acted:
                self._release_unseen(effect, message)
            return
        self._bus.later(RELEASE_AGAIN, partial(self._release_again, effect))
        self._calling.call(component, message, partial(self._end, component, message))

    def _release_unseen(self, effect: ReleaseFrom, message: Release) -> None:
        """Tell a component whose life seems to have ended that it is released, as it may hear this without being heard.

        It is sent again only if a life was asked and did not answer. One that cannot be reached has lost sight of its
        configurator as well, and turns itself off; one that is frozen is released when its life shows again.
        """
        component = effect.component

        def answered(replies: Replies) -> None:
            answer = self._calling.answer_in(replies, message.life)
            if answer is not None:
                self._calling.answered(component, message, answer)
            elif not replies.complete:
                self._bus.later(CALL, partial(self._release_again, effect))

        self._calling.ask(component, message, answered)
        self.expect_gone(component)

    def expect_gone(self, component: IRI) -> None:
        """A life that has been gone for longer than its grace acts for no task, unless this node is cut off."""

        def gone() -> None:
            if self._bus.link and not self._lives.lives_on(component):
                self._lives.gone(component)

        self._bus.later(GONE, gone)

    def woken(self, component: IRI, life: str) -> None:
        """A component lives; perhaps it was frozen and has not been released."""
        if self._lives.was_left_behind(component, life):
            self._release_left_behind(component, life)

    def _release_left_behind(self, component: IRI, life: str) -> None:
        """Tell a life that was frozen that it is released, whatever other lives of the component have received since.

        Unless it is wanted again: then it hears that.
        """
        left = self._lives.was_left_behind(component, life) and self._ecology.lives_on(component, life)
        if not left or self._state().ended:
            return
        again = partial(self._release_left_behind, component, life)
        wanted = component in self._waking or component in self._state().held
        if wanted and self._lives.life(component) == life:
            self._bus.later(CALL, again)
            return
        message = replace(Release(**self._calling.claim(component, self._state().epoch)), life=life)

        def answered(replies: Replies) -> None:
            answer = self._calling.answer_in(replies, life)
            if answer is not None and answer.life == life:
                self._lives.caught_up(component, life)
            else:
                self._bus.later(CALL, again)

        self._calling.ask(component, message, answered)

    def _release_again(self, effect: ReleaseFrom) -> None:
        if self._state().ended or self._state().owed.get(effect.component) != effect.epoch:
            return
        if effect.component in self._ending:
            self._bus.later(RELEASE_AGAIN, partial(self._release_again, effect))
        else:
            self.release(effect)

    def _end(self, component: IRI, message: Release, otherwise: Callable[[], None]) -> None:
        """Have the site end a life of a component that does not obey its release: it may act on without a task.

        `otherwise` is called if the site cannot do so, or has not within `SITE_ENDS` seconds; it may do so later. But a
        life that has obeyed a newer call is held again, or was released by a newer release.
        """
        if self._lives.has_obeyed_since(component, message.life, message.epoch):
            return
        found = self._ecology.discovery.found.get(component)
        if found is None or not found.startable or not message.life:
            otherwise()
            return

        def answered(replies: Replies) -> None:
            if any(sample.payload == LET_GO_SINCE for sample in replies.samples):
                self._ending.discard(component)
                if self._lives.has_obeyed_since(component, message.life, message.epoch):
                    return
                self._lives.released(component, message.epoch)
                self._report(ComponentReleased(component, Verdict.DONE.value))
                done = Verdict.DONE
                self._step(Answered(component, Call.RELEASE, message.epoch, done, message.life, message.epoch))
            elif replies.samples:
                self._bus.later(END_SEEN, ended)
            else:
                self._ending.discard(component)
                otherwise()

        def ended() -> None:
            self._ending.discard(component)
            if self._ecology.lives_on(component, message.life):
                otherwise()  # it was no process of the site that lives this life
                return
            self._lives.leave_behind_if_ended(component)
            if not self._lives.lives_on(component):
                self._lives.gone(component)
            detail = "its site has ended its process"
            self._report(ComponentReleased(component, detail))
            self._step(Answered(component, Call.RELEASE, message.epoch, Verdict.OTHER_LIFE, detail=detail))
            self._waking.process_ended(component)

        end = End(component, message.life, message.task)
        self._lives.lost(component, message.life)
        self._ending.add(component)
        self._bus.ask(self._ecology.keys.end(found.site), encode(end), SITE_ENDS, answered)
