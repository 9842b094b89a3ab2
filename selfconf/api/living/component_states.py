"""How each component of a living ecology is: whether it lives, who holds it, where, since when, and what it issues.

Each living component is asked for its `state`, which it answers from its control thread whatever its code does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from selfconf.bus.answers import own_answers
from selfconf.bus.port import Replies
from selfconf.discovery import Discovery
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, task_name
from selfconf.protocol.messages import CallAnswer, Wire
from selfconf.rdf.vocabulary import SC


class ComponentState(NamedTuple):
    """How a component is; what only a living component can say is empty for one that does not live or answer."""

    component: IRI
    types: tuple[IRI, ...]
    site: str
    """The site of the component; where several have one name, with the life of the site."""
    state: str
    """`alive`, `dormant` or `absent`, as `LivingEcology.state` says it."""
    active: bool = False
    task: str = ""
    """The name of the task that holds it; of several the first in rank."""
    place: str = ""
    """The process and the host of the component, for people."""
    age: float = 0.0
    """For how long it has lived, in seconds."""
    memory: int = 0
    """The resident memory of its process in bytes."""
    issued: Mapping[str, int] = {}
    """How many signals each output has issued since it lives; those of a composite issue nothing themselves."""
    issued_inside: Mapping[str, tuple[Wire, ...]] = {}
    """Of a composite that acts: which outputs of others issue the signals of each of its own."""
    life: str = ""
    reason: str = ""
    """Why it cannot act now, where its site says so: of a composite whose inside cannot be configured."""
    stopping: bool = False
    """Whether it was asked to stop and has not come to rest; where that lasts, it is out of control."""

    @property
    def shown(self) -> str:
        """The state for people: `stopping` of one that lives and does not come to rest."""
        return "stopping" if self.stopping else self.state

    def body(self) -> dict[str, object]:
        """The state as JSON."""
        return {
            "component": self.component,
            "types": list(self.types),
            "site": self.site,
            "state": self.state,
            "active": self.active,
            "task": self.task,
            "place": self.place,
            "age": round(self.age, 3),
            "memory": self.memory,
            "issued": dict(self.issued),
            "reason": self.reason,
            "stopping": self.stopping,
        }


def told_lives(keys: Keys, replies: Replies) -> Mapping[IRI, Sequence[CallAnswer]]:
    """What the lives of each component say of themselves, the least first: that is the one which stays."""
    answers: dict[IRI, dict[str, CallAnswer]] = {}
    for answer in own_answers(replies.samples, CallAnswer, lambda one: keys.call(one.component, "state"))[0]:
        answers.setdefault(answer.component, {})[answer.life] = answer
    return {component: [lives[life] for life in sorted(lives)] for component, lives in answers.items()}


def doubled(told: Mapping[IRI, Sequence[CallAnswer]]) -> Iterator[str]:
    """A sentence for each component that several processes are."""
    for component, (first, *others) in sorted(told.items()):
        if others:
            places = " and ".join(other.place or f"life {other.life}" for other in others)
            yield (
                f"{component} is {first.place or f'life {first.life}'}, and {places} as well; tasks take the first one:"
                " end what is not meant to be it"
            )


def component_states(discovery: Discovery, told: Mapping[IRI, Sequence[CallAnswer]]) -> Iterator[ComponentState]:
    """The state of each advertised component, sorted by IRI; what strangers have told is passed over.

    The state is `dormant` or `absent` for a component that has not answered; a caller that knows its life corrects it.
    """
    for component, found in sorted(discovery.found.items()):
        types = tuple(sorted(found.advertisement.profile.types - {SC.Component}))
        state = "dormant" if found.startable else "absent"
        site = discovery.name_of_site(found)
        one = ComponentState(component, types, site, state, reason=found.unable)
        for heard in told.get(component, ())[:1]:
            task = task_name(heard.task)
            what = heard.active, task, heard.place, heard.age, heard.memory, heard.issued, heard.outputs, heard.life
            one = ComponentState(component, types, site, "alive", *what, stopping=heard.stopping)
        yield one


def unadvertised(discovery: Discovery, told: Mapping[IRI, Sequence[CallAnswer]]) -> Iterator[str]:
    """A sentence for each component that lives and no site advertises, so that no task finds it.

    It was started by hand without a site that has its file, or its file is gone since a task began to hold it. None
    where a site has not answered, which may advertise it.
    """
    for component, (answer, *_) in sorted(told.items()) if not discovery.missing else ():
        if component not in discovery.found:
            holder = f", and the task {task_name(answer.task)} holds it" if answer.task else ""
            yield f"{component} lives{holder}, but no site advertises it"


def issue_rates(
    before: Iterable[ComponentState], now: Iterable[ComponentState], seconds: float
) -> dict[IRI, dict[str, float]]:
    """The signals a second of each output of each component between two looks; none where another life has begun.

    Signals flow past a composite, so the rate of its output is that of the outputs which issue for it now.
    """
    known, states = {one.component: one for one in before}, tuple(now)
    rates = {one.component: _own_rates(known.get(one.component), one, seconds) for one in states}
    for composite in states:
        for port, wires in composite.issued_inside.items():
            if port in rates[composite.component]:
                inside = (rates.get(wire.component, {}).get(wire.output, 0.0) for wire in wires)
                rates[composite.component][port] += sum(inside)
    return rates


def _own_rates(before: ComponentState | None, now: ComponentState, seconds: float) -> dict[str, float]:
    if before is None or now.state != "alive" or before.life != now.life or seconds <= 0:
        return {}
    return {port: (count - before.issued.get(port, 0)) / seconds for port, count in now.issued.items()}
