"""Why a component plays a role, or is recruited, in sentences: what a task has reported, read back at a moment.

The events are those of `run --format json`, as a configurator keeps them. Of a stranger they may hold anything: then
`told_why` raises PeerError.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from functools import partial

from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.render.names import short
from selfconf.render.tables import clock_time
from selfconf.render.task_story import NO_CONFIGURATION, EventBody, TaskStory, story, time_of


def told_why(
    task: str, events: Iterable[EventBody], term: str, at: float | None, passed_over: Mapping[str, Sequence[str]]
) -> list[str]:
    """The sentences of `why_sentences` about a task at a moment. Raises PeerError for events that are none of a run."""
    try:
        return why_sentences(story(task, events, at), term, passed_over)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, OSError) as error:
        raise PeerError(f"what {task} tells are no events of a run: {error!r}") from None


def why_sentences(found: TaskStory, term: str, passed_over: Mapping[str, Sequence[str]]) -> list[str]:
    """Why the roles of a task are played as they are, and its recruits, of those that a term means; else none.

    The term is a role, a component, a value that the task is bound to, or its name; an IRI or its local name, without
    brackets and prefix.
    `passed_over` are by role the candidates that go before the chosen ones, as far as that is known.
    """
    if found.refusal is not None:
        return _refused(found, term)
    everything = _means(term, found.task) or any(_means(term, value) for value in found.configuration.bindings)
    sentences = _not_yet(found, term)
    for role, components in found.configuration.roles.items():
        if everything or _means(term, role) or any(_means(term, one) for one in components):
            sentences += _played(found, role, components, passed_over.get(role))
    for component in found.configuration.recruits:
        if everything or _means(term, component):
            sentences += _recruited(found, component)
    return sentences + _without_a_role(found, term, passed_over)


def _without_a_role(found: TaskStory, term: str, passed_over: Mapping[str, Sequence[str]]) -> list[str]:
    """Why a component that a term means plays no role."""
    playing = {component for players in found.configuration.players.values() for component in players}
    lost = {component: event for component, event in found.lost.items() if _means(term, component)}
    sentences = [
        f"{_name(component)} plays no role in {found.task}: {_loss(event)}"
        for component, event in lost.items()
        if component not in playing
    ]
    for role, others in passed_over.items() if not lost else ():
        chosen = ", ".join(map(_name, found.configuration.roles.get(role, [])))
        for one in filter(partial(_means, term), others):
            sentences.append(f"{_name(one)} goes before {chosen} for the role {_name(role)}, and was passed over")
    return sentences


def _played(found: TaskStory, role: str, components: Sequence[str], before: Sequence[str] | None) -> list[str]:
    """Which components play a role and why; `before` are the candidates before those, None if not known."""
    who = ", ".join(map(_name, components)) or "no component"
    sentences = [f"{_name(role)} in {found.task}: {who}, {_while(found, role)}"]
    for component in components:
        sentences += _came_about(found, component)
    recruits = found.configuration.recruits_of(components)
    if recruits:
        sentences.append(f"  fed by recruits: {', '.join(map(_name, recruits))}")
    others = [one for one in before or () if one not in components]
    if before is not None and components and not others:
        sentences.append("  no other candidate went before it in the latest search")
    if others:
        told = {found.replaced.get(one) for one in components}
        sentences.append(f"  passed over, though first in order: {', '.join(map(_name, others))}")
        sentences += _changes(found, others, told)
    return sentences


def _changes(found: TaskStory, passed_over: Sequence[str], told: Container[str | None]) -> Iterator[str]:
    """What would change that candidates were passed over: for one that was never lost only a search can tell that.

    Of those that were lost it is said why, but for those of which that is `told`.
    """
    lost = [one for one in passed_over if one in found.lost]
    yield from (f"  {_name(one)} was {_loss(found.lost[one])}" for one in lost if one not in told)
    if lost:
        names = ", ".join(map(_name, lost))
        again = "free" if all(found.lost[one].get("cause") == "yield" for one in lost) else "able to act"
        yield f"  what would change it: {names} {again} again; without `run --upgrade` a new start as well"
    rest = [one for one in passed_over if one not in lost]
    if rest:
        yield f"  `selfconf partition TEMPLATE --why` says what comes of {', '.join(map(_name, rest))}"


def _recruited(found: TaskStory, component: str) -> list[str]:
    """What a recruit is there for."""
    fed = ", ".join(map(_name, found.configuration.sinks_of(component)))
    return [
        f"{_name(component)} in {found.task}: recruited to feed {fed}, {_while(found, component)}",
        *_came_about(found, component),
    ]


def _came_about(found: TaskStory, component: str) -> Iterator[str]:
    """From which component one took over, and whether it was lost itself: before it played this role, or since then."""
    instead = found.replaced.get(component)
    if instead is not None:
        loss = found.lost.get(instead)
        yield f"  it took over from {_name(instead)}{'' if loss is None else ': ' + _loss(loss)}"
    if component in found.lost:
        loss = found.lost[component]
        yield f"  {_name(component)} was {_loss(loss)}{', and has come back' if time_of(loss) <= found.since else ''}"


def _refused(found: TaskStory, term: str) -> list[str]:
    refusal = found.refusal or {}
    reasons = list(refusal.get("reasons", ()))
    roles = [str(reason.get("role")) for reason in reasons]
    near = list(refusal.get("near_misses", ()))
    told = (found.task, *roles, *(str(miss.get("component")) for miss in near), *found.lost)
    if not any(_means(term, one) for one in (*told, *found.configuration.bindings)):
        return []
    sentences = [f"{found.task} has no configuration, since {clock_time(found.since)}"]
    if "message" in refusal:  # of a search that has ended undecided, which has no reasons
        reasons.append(refusal)
    sentences += [f"  {reason.get('message')}" for reason in reasons]
    sentences += _losses(found)
    sentences += [
        f"  nearly, {'to be recruited for' if miss.get('recruit') else 'as'} {_name(miss.get('role'))}:"
        f" {_name(miss.get('component'))}, but {miss.get('obstacle')}"
        for miss in near
    ]
    sentences += [f"  what would change it: {relaxation.get('message')}" for relaxation in refusal.get("repairs", ())]
    return sentences


def _not_yet(found: TaskStory, term: str) -> list[str]:
    """That a task which a term means is being configured, and what it has lost meanwhile."""
    waits = found.configuration is NO_CONFIGURATION and found.begun and found.ended is None
    return [f"{found.task} has no configuration yet", *_losses(found)] if waits and _means(term, found.task) else []


def _losses(found: TaskStory) -> list[str]:
    """What the task has lost."""
    return [f"  {_name(component)}: {_loss(event)}" for component, event in found.lost.items()]


def _means(term: str, thing: str) -> bool:
    """Whether a term is the IRI or the local name of a thing."""
    return term in (thing, _name(thing))


def _name(thing: object) -> str:
    return short(IRI.unchecked(str(thing))) or str(thing)


def _loss(event: EventBody) -> str:
    detail = f", {event['detail']}" if event.get("detail") else ""
    return f"lost at {clock_time(time_of(event))} ({event.get('cause')}{detail})"


def _while(found: TaskStory, one: str) -> str:
    """Since when a role or a recruit has been what it is, and until when it was."""
    return (
        f"since {clock_time(found.unchanged[one])}{'' if found.ended is None else f', until {clock_time(found.ended)}'}"
    )
