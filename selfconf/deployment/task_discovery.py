"""Acts 1 and 2 of a running task: what the sites advertise, and what the other tasks hold."""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.bus.port import Replies
from selfconf.configurator import Appeared, Discovered, Failed, Loss
from selfconf.deployment.components import Liveness
from selfconf.deployment.holders import ask_holders, holders_in
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import Discovery
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.run_event import AnswerRejected, AnyRunEvent, EcologyAsked, EcologyDiscovered
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, owner_of
from selfconf.protocol.messages import Cause


class TaskDiscovery:
    """Asks the ecology for one task, and feeds its machine with what was found."""

    def __init__(self, context: TaskContext, liveness: Liveness) -> None:
        self._bus, self._ecology, self._name = context.ecology.bus, context.ecology, context.name
        self._liveness = liveness
        self._without_configurator = context.request.without_configurator
        self._state, self._step, self._report = context.state, context.step, context.report
        self._asked = 0
        """How often the ecology was asked."""
        self._told: tuple[AnyRunEvent, ...] = ()
        """What was reported of the last answers."""
        self.just_answered: Replies | None = None
        """What the other configurators have just answered, if they have: they are not asked again the next time."""

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

        replies, self.just_answered = self.just_answered, None
        if replies is None:
            ask_holders(self._bus, self._ecology.keys, self._name, answered, self._without_configurator)
        else:
            answered(holders_in(replies, self._ecology.keys, self._name, self._without_configurator))
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
        self._ecology.discovery = self._with_held(discovery)
        first = not self._ecology.followed
        self._liveness.discovered(discovery)
        self._tell(discovery)
        number = self._asked
        shared = {component: holder for component, holder in holders.items() if self._ecology.may_be_shared(component)}
        unseen = any(component not in discovery.found for component in self._state().held)
        held = Discovered({c: holder for c, holder in holders.items() if c not in shared}, shared, unseen)

        def known() -> None:
            self._heed_ended_lives()
            if number == self._asked:
                self._step(held)

        state = self._state()
        self._liveness.select((*state.held, *state.lost) if first else state.held, known)

    def _with_held(self, discovery: Discovery) -> Discovery:
        """What was found, and, for a task that looks for something better, what it holds of sites that were not heard.

        That a site has not answered in full is no reason to let go of a component that runs.
        """
        state, known = self._state(), self._ecology.discovery.found
        heard = {owner_of(key) for key in discovery.answered}
        held = state.held.keys() & known.keys() if state.improving else ()
        unheard = {component: known[component] for component in held if known[component].site not in heard}
        return replace(discovery, found={**unheard, **discovery.found}) if unheard else discovery

    def _heed_ended_lives(self) -> None:
        """Lives of lost components may have ended before this configurator followed them, or their sites were away."""
        ended = {one: loss.life for one, loss in self._state().lost.items() if self._has_ended(one, loss)}
        for component, life in ended.items():
            self._step(Failed(component, life, Cause.CRASH, "its life has ended"))
        now = {component: self._ecology.life(component) for component in ended}
        lives = {component: life for component, life in now.items() if life is not None}
        if lives:
            self._step(Appeared(lives))

    def _has_ended(self, component: IRI, loss: Loss) -> bool:
        """Whether the life has ended in which a component was lost, as far as is known, and that is news."""
        if loss.cause is Cause.CRASH:
            return not loss.startable
        known = loss.lasts and self._ecology.knows(component_chunk(component))
        return known and not self._ecology.lives_on(component, loss.life)
