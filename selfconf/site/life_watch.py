"""Whether a component whose process runs takes part in the ecology: the watchdog of its site.

A component that runs announces its life, and answers a question for its `state` even while it waits. One that has been
frozen (SIGSTOP), that hangs before it announces itself, or whose whole process hangs can say nothing of it; its site
can see it. The site asks rarely: the component's own watchdog notices a hung callback much sooner.
"""

from __future__ import annotations

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys, life_of
from selfconf.protocol.messages import CallAnswer

FROZEN = 3.0
"""Seconds that a process may be frozen while its component has no life."""
WITHOUT_LIFE = 15.0
"""Seconds that a process may take until its component has a life, as long as a configurator waits for it."""
BEYOND_DEADLINE = 2.0
"""Seconds beyond the deadline after which a component that does not answer counts as hung."""
QUESTION_ACTIVE, QUESTION_IDLE = 1.0, 5.0
"""Seconds between two questions for the state of a component that is active, and of one that is not."""


class LifeWatch:
    """Follows one component of a process, from the start of the process on."""

    def __init__(self, bus: Bus, keys: Keys, profile: Profile, life: str) -> None:
        """`life` is the name that the component was given for its life; it may choose another one."""
        self._bus, self._profile, self._life = bus, profile, life
        self._state = keys.call(profile.component, "state")
        self._lives: set[str] = set()
        self._had: set[str] = set()
        """The lives that the component has had since the process began."""
        self._lifeless_since = self._living_since = bus.now()
        self._unanswered_since: float | None = None
        self._closed = False
        self._unwatch = bus.watch(keys.lives(profile.component), self._life_changed)
        self._bus.later(QUESTION_ACTIVE, self._ask)

    def close(self) -> None:
        """Watch no more."""
        self._closed = True
        self._unwatch()

    @property
    def alive(self) -> bool:
        """Whether the component has a life."""
        return bool(self._lives)

    @property
    def lives_for(self) -> float:
        """For how many seconds the component has had a life; zero if it has none."""
        return self._bus.now() - self._living_since if self._lives else 0.0

    @property
    def lived(self) -> bool:
        """Whether the component has had a life since the process began."""
        return bool(self._had)

    @property
    def last_life(self) -> str:
        """The life that the component has, or had last; empty if it had none, or it is not known which was the last."""
        if self._life in self._had:
            return self._life
        return next(iter(self._had)) if len(self._had) == 1 else ""

    def is_life(self, life: str) -> bool:
        """Whether a life of the component is that of the process, as far as is known."""
        return life == self._life or (life in self._lives and self._life not in self._lives)

    def was_life(self, life: str) -> bool:
        """Whether a life that may have ended was that of the process, as far as is known."""
        return life == self._life or (life in self._had and self._life not in self._had)

    def lifeless(self, frozen: bool) -> str | None:
        """Why a process without a living component has to be ended, in words. `frozen`: it is stopped by a signal."""
        lifeless = self._bus.now() - self._lifeless_since
        if frozen and lifeless > FROZEN:
            return f"has had no life for {lifeless:.0f} s and is frozen (SIGSTOP)"
        return f"has had no life for {lifeless:.0f} s" if lifeless > WITHOUT_LIFE else None

    def hanging(self) -> str | None:
        """Why the process of a living component has to be ended, in words."""
        if self._unanswered_since is None:
            return None
        unanswered = self._bus.now() - self._unanswered_since
        if unanswered <= self._profile.start_deadline + BEYOND_DEADLINE:
            return None
        return f"has not answered for {unanswered:.0f} s: it hangs"

    def _life_changed(self, key: str, alive: bool) -> None:
        if alive:
            self._living_since = self._living_since if self._lives else self._bus.now()
            self._lives.add(life_of(key))
            self._had.add(life_of(key))
        else:
            self._lives.discard(life_of(key))
            self._lifeless_since = self._bus.now()
        self._unanswered_since = None

    def _ask(self) -> None:
        if self._closed:
            return
        if not self._lives:
            self._bus.later(QUESTION_ACTIVE, self._ask)
            return
        asked = self._bus.now()

        def answered(replies: Replies) -> None:
            own = [answer for answer in map(_answer, replies.samples) if answer and self.is_life(answer.life)]
            if own:
                self._unanswered_since = None
                self._bus.later(QUESTION_ACTIVE if any(answer.active for answer in own) else QUESTION_IDLE, self._ask)
            else:
                self._unanswered_since = asked if self._unanswered_since is None else self._unanswered_since
                self._bus.later(max(0.0, asked + QUESTION_ACTIVE - self._bus.now()), self._ask)

        self._bus.ask(self._state, b"", QUESTION_ACTIVE, answered)


def _answer(sample: Sample) -> CallAnswer | None:
    try:
        return decode(sample.payload, CallAnswer)
    except PeerError:
        return None
