"""Components that tasks have released: which of them do not come to rest in time, and how they are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.answers import own_answers
from selfconf.bus.port import Replies
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer, StateOf

COMING_TO_REST = 5.0
"""Seconds that components may take to obey after their task has ended: their sites end those that do not meanwhile."""
STATE_PATIENCE = 1.0
"""Seconds that the components may take to say how they are."""
REST_CHECK = 0.1
"""Seconds between two looks at components that have not obeyed yet."""


class ReleasedComponents:
    """Asks the components of an ecology how they are, until those that were released are at rest."""

    def __init__(self, bus: SynchronousBus, keys: Keys) -> None:
        self._bus, self._keys = bus, keys

    def states(self) -> list[CallAnswer]:
        """What all components that live say of themselves, to a question that names no task."""
        return _states(self._bus.ask(self._keys.any_call("state"), seconds=STATE_PATIENCE), self._keys)

    def out_of_control(self) -> Mapping[IRI, str]:
        """The components that were asked to stop and do not come to rest in time, sorted, and how each of them is.

        Whether a task is left that knows of them or not: each component is asked. It takes time where one is stopping.
        """
        stopping = {(one.component, "") for one in self.states() if one.stopping}
        return {component: why for (component, _), why in self.still_acting(stopping).items()}

    def still_acting(self, asked: Iterable[tuple[IRI, str]]) -> dict[tuple[IRI, str], str]:
        """The components that still act once they have had their time to obey, and how they are.

        Each goes with the task that has released it. It takes no longer than until all are at rest.
        """
        deadline = self._bus.now() + COMING_TO_REST
        while (troubles := self._acting(asked)) and self._bus.now() < deadline:
            asked = set(troubles)
            self._bus.pause(REST_CHECK)
        return troubles

    def _acting(self, asked: Iterable[tuple[IRI, str]]) -> dict[tuple[IRI, str], str]:
        """Of components and the tasks that they were released by, those that are not at rest, and how they are."""
        pairs, keys = sorted(asked), self._keys
        questions = [(keys.call(component, "state"), encode(StateOf(task))) for component, task in pairs]
        troubles = {}
        for (component, task), replies in zip(pairs, self._bus.ask_each(questions, STATE_PATIENCE), strict=True):
            answers = _states(replies, keys)
            acting = [one for one in answers if one.stopping or (one.active and one.task == task)]
            if acting:
                what = "its code has not come to rest" if acting[0].stopping else "it acts on"
                troubles[component, task] = f"{what} ({acting[0].place})"
            elif not answers and self._bus.living(keys.lives(component)):
                troubles[component, task] = "it lives, but does not answer"
        return troubles


def _states(replies: Replies, keys: Keys) -> list[CallAnswer]:
    """What the lives of components have answered, each on its own key."""
    return own_answers(replies.samples, CallAnswer, lambda one: keys.call(one.component, "state"))[0]
