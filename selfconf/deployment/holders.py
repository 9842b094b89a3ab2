"""Which components the other tasks of an ecology hold, as their configurators say, or what is kept of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set

from selfconf.bus.answers import own_answers
from selfconf.bus.port import Bus, Replies
from selfconf.model.configuration import Wants
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable, replace
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Status

STATUS = 1.0
"""Seconds that the configurators may take to say what they hold; a component itself knows better, when it is asked."""


@immutable
class Holding:
    """What one task holds, each component with what is wanted of it by those that would share it."""

    holder: Holder
    components: Mapping[IRI, Wants]


WithoutConfigurator = Callable[[Set[str]], Sequence[Holding]]
"""Gives what tasks hold whose configurator may have just gone, but for some tasks, given by their identities."""


def ask_holders(
    bus: Bus,
    keys: Keys,
    own: str,
    done: Callable[[Mapping[IRI, Holder]], None],
    without_configurator: WithoutConfigurator = lambda known: (),
) -> None:
    """Ask all configurators but the `own` one what they hold; `done` receives the holder of each component.

    Of several holders of one component the one of the highest priority counts, then the one that began first. What
    tasks hold `without_configurator` counts for those of them for which none has answered.
    """

    def answered(replies: Replies) -> None:
        done(holders_in(replies, keys, own, without_configurator))

    bus.ask(keys.configurator_call("*", "status"), b"", STATUS, answered)


def holders_in(
    replies: Replies,
    keys: Keys,
    own: str = "",
    without_configurator: WithoutConfigurator = lambda known: (),
) -> Mapping[IRI, Holder]:
    """The holder of each component by the answers of configurators, as `ask_holders` counts them.

    An answer that is none is passed over.
    """
    holdings = _holdings(replies, keys, own)
    known = {one.holder.task for one in holdings}
    return _first_holders([*holdings, *without_configurator(known)])


def _holdings(replies: Replies, keys: Keys, own: str) -> list[Holding]:
    found: list[Holding] = []
    statuses, _ = own_answers(replies.samples, Status, lambda one: keys.configurator_call(one.configurator, "status"))
    for status in statuses:
        if status.configurator == own:
            continue
        holder = Holder(status.task, status.priority, status.beginning, status.configurator)
        found.append(Holding(holder, {one: status.wants.get(one, Wants()) for one in status.components}))
    return found


def _first_holders(holdings: Iterable[Holding]) -> Mapping[IRI, Holder]:
    found: dict[IRI, Holder] = {}
    for holding in holdings:
        for component, wants in holding.components.items():
            holder, known = replace(holding.holder, wants=wants), found.get(component)
            if known is None or (-known.priority, known.beginning) > (-holder.priority, holder.beginning):
                found[component] = holder
    return found
