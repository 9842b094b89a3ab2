"""Whether the inside of a composite that was refused can be configured again.

A task that has ended hears nothing: that what other tasks held is free, or that what was lost lives a new life. So
that is asked, and searched for again only where it is other than before, among what the site advertises by then. What
has raised FAIL and could go on by now tells nothing: that is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from selfconf.bus.port import Bus
from selfconf.configurator import Loss, State
from selfconf.deployment import RunRequest, ask_holders
from selfconf.errors import SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.sharing import agreed
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, life_of
from selfconf.protocol.messages import Cause
from selfconf.rdf.advertisements import Advertisement

SPENT_CALL = 1.0
"""Seconds for which the lives of a component that was lost are asked."""


class InsideProspect:
    """What may come of an inside that was refused."""

    def __init__(self, bus: Bus, ecology: str, request: RunRequest, state: State) -> None:
        """`request` and `state` are those of the task that was refused."""
        self._bus, self._keys, self._request, self._priority = bus, Keys(ecology), request, state.priority
        self._spent = {one: _spent(loss) for one, loss in state.lost.items() if not loss.busy}
        """The lives of each component that was lost in which it cannot act: where none was named, those that it lives
        now; until these are known one without a name."""
        self._failed = frozenset(one for one in self._spent if state.lost[one].cause is Cause.FAIL)
        """The components that have raised FAIL, and may have recovered in the life that they live."""
        self._searched: object = None
        """Among what, and without what, a search has found nothing."""
        for component in [one for one, spent in self._spent.items() if "" in spent]:
            self._bus.roll_call(self._keys.lives(component), SPENT_CALL, partial(self._note_spent, component))

    def _note_spent(self, component: IRI, keys: tuple[str, ...]) -> None:
        self._spent[component] = frozenset(map(life_of, keys))

    def look(self, known: Mapping[IRI, Advertisement], able: Callable[[], None], *, recovered: bool) -> None:
        """Call `able` if the inside can be configured from what is advertised, in the rank that it had.

        With `recovered`, what has raised FAIL and lives on counts as able to act; a composite does in another life.
        """
        lives: dict[IRI, frozenset[str]] = {}

        def called(component: IRI, keys: tuple[str, ...]) -> None:
            lives[component] = frozenset(map(life_of, keys))
            if len(lives) == len(self._spent):
                ask()

        def ask() -> None:
            tried = {one for one in self._failed if lives[one] and one in known and known[one].profile.inside is None}
            lost = self._lost(lives) - tried if recovered else self._lost(lives)
            ask_holders(self._bus, self._keys, "", partial(self._search, known, lost, able))

        for component in self._spent:
            self._bus.roll_call(self._keys.lives(component), SPENT_CALL, partial(called, component))
        if not self._spent:
            ask()

    def _lost(self, lives: Mapping[IRI, frozenset[str]]) -> frozenset[IRI]:
        """The components that were lost and live no life yet in which they may be able to act."""
        spent = self._spent.items()
        return frozenset(one for one, without in spent if "" in without or not lives[one] - without)

    def _search(
        self,
        known: Mapping[IRI, Advertisement],
        lost: frozenset[IRI],
        able: Callable[[], None],
        holders: Mapping[IRI, Holder],
    ) -> None:
        held = {one: holder for one, holder in holders.items() if one in known and holder.priority >= self._priority}
        searched = known, lost, held
        if searched == self._searched:
            return

        def work() -> None:
            if self._is_configurable(known, lost, held):
                self._bus.wake_up(able)
            else:
                self._searched = searched

        self._request.aside(work)

    def _is_configurable(
        self, known: Mapping[IRI, Advertisement], lost: frozenset[IRI], held: Mapping[IRI, Holder]
    ) -> bool:
        shared = {one: held[one] for one in held if known[one].profile.is_shareable}
        without = lost | (held.keys() - shared)
        try:
            outcome, _ = agreed(lambda left_out: self._request.compose(known, left_out | without, None), shared)
        except SelfconfError:
            return False
        return isinstance(outcome, Configuration)


def _spent(loss: Loss) -> frozenset[str]:
    """The life in which a component was lost, perhaps without a name.

    None where a life seemed to end: one that is seen again was only cut off.
    """
    return frozenset() if loss.cause is Cause.CRASH else frozenset((loss.life,))
