"""Acts 1 and 2 of a running task: what the sites advertise, and what the other tasks hold."""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.configurator import Appeared, Discovered
from selfconf.deployment.components import Liveness
from selfconf.deployment.holders import WithoutConfigurator, ask_holders
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import Discovery
from selfconf.model.holder import Holder
from selfconf.model.run_event import AnswerRejected, AnyRunEvent, EcologyAsked, EcologyDiscovered
from selfconf.model.term import IRI


class TaskDiscovery:
    """Asks the ecology for one task, and feeds its machine with what was found."""

    def __init__(
        self,
        task: TaskContext,
        name: str,
        liveness: Liveness,
        without_configurator: WithoutConfigurator = lambda known: (),
    ) -> None:
        """`name` is that of the configurator; `without_configurator` that of the `RunRequest`."""
        self._bus, self._ecology, self._name, self._liveness = task.ecology.bus, task.ecology, name, liveness
        self._without_configurator = without_configurator
        self._state, self._step, self._report = task.state, task.step, task.report
        self._asked = 0
        """How often the ecology was asked."""
        self._told: tuple[AnyRunEvent, ...] = ()
        """What was reported of the last answers."""

    def begin(self) -> None:
        """Ask the sites what they advertise, and meanwhile the other tasks what they hold.

        One question counts at a time: where an earlier one is not answered yet, its answer is older than this question.
        A task that runs looks again and again whether there is something better: that is reported once it comes to
        something else than before.
        """
        if not self._state().improving:
            self._told = ()
            self._report(EcologyAsked())
        self._asked += 1
        number = self._asked
        found: list[Discovery] = []
        held: list[Mapping[IRI, Holder]] = []

        def both() -> None:
            if found and held and number == self._asked:
                self._discovered(found[0], held[0])

        def discovered(discovery: Discovery) -> None:
            found.append(discovery)
            both()

        def answered(holders: Mapping[IRI, Holder]) -> None:
            held.append(holders)
            both()

        ask_holders(self._bus, self._ecology.keys, self._name, answered, self._without_configurator)
        self._ecology.discover(discovered)

    def _tell(self, discovery: Discovery) -> None:
        """Report what the ecology has answered, unless a task that looks again has heard the same before."""
        told: list[AnyRunEvent] = [AnswerRejected(complaint) for complaint in discovery.complaints]
        told.append(EcologyDiscovered(len(discovery.found), discovery.sites, self._ecology.silent_sites(discovery)))
        if self._told == tuple(told):
            return
        if self._told:
            self._report(EcologyAsked())
        for event in told:
            self._report(event)
        self._told = tuple(told)

    def _discovered(self, discovery: Discovery, holders: Mapping[IRI, Holder]) -> None:
        if self._state().ended:
            return
        self._ecology.discovery = discovery
        first = not self._ecology.followed
        self._liveness.discovered(discovery)
        self._tell(discovery)
        number = self._asked
        shared = {component: holder for component, holder in holders.items() if self.shareable(component)}
        held = Discovered({c: holder for c, holder in holders.items() if c not in shared}, shared)

        def known() -> None:
            if first:
                self._heed_new_lives()
            if number == self._asked:
                self._step(held)

        state = self._state()
        self._liveness.select((*state.held, *state.lost) if first else state.held, known)

    def _heed_new_lives(self) -> None:
        """What the configurator before this one has lost may have begun another life before this one followed it."""
        lives = {one: life for one in self._state().lost if (life := self._ecology.life(one)) is not None}
        if lives:
            self._step(Appeared(lives))

    def shareable(self, component: IRI) -> bool:
        found = self._ecology.discovery.found.get(component)
        return found is not None and found.advertisement.profile.is_shareable
