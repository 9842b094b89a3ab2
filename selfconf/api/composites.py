"""The composites of a site: outside a component, inside a task that the site runs.

A composite is advertised like any other component; its grounding names a template of the same document, whose ports are
its own. Its inside is configured from the components of its site alone, itself left out: so each level is small, and
each site answers for its own. A composite lives while its inside can be configured. When it is activated its inside
becomes a task with the rank of the one that holds it, and it acts once that task runs; what fails inside is repaired
inside, and only a refusal is a FAIL of the composite, with the reason. When it is released its inside comes to rest.

Signals do not pass here. The inputs inside that are those of the composite follow what feeds it, and a configurator
that asks the composite to act is told which outputs stand behind its own (`CallAnswer`, and `Moved` when they change).

Composites that could be inside of each other in a circle never live: what stands behind them would have no end.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from selfconf.api.detached import Aside
from selfconf.api.reading import text_of
from selfconf.bus.port import Bus, Urgency
from selfconf.composition import Composer
from selfconf.deployment import RunRequest, TaskRunner
from selfconf.discovery import Beliefs
from selfconf.errors import AuthorError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.profile import Profile
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import RunEvent, TaskRunning
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys, safe_name
from selfconf.protocol.messages import Apply, Moved, Wire
from selfconf.rdf import tasks, turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.turtle import Document
from selfconf.sdk import Component
from selfconf.sdk.runtime import ComponentRuntime

log = logging.getLogger(__name__)

STARTING_INSIDE = 25.0
"""Seconds that the inside of a composite may take to run: each site may take 15 to start what is dormant."""


class InsideOfComposite:
    """What does as the calls of a configurator say to a composite: it runs the inside as a task."""

    def __init__(self, bus: Bus, ecology: str, profile: Profile, request: RunRequest) -> None:
        """`request` is for the inside; what it reports and who ranks it is said here."""
        self._bus, self._ecology, self.profile = bus, ecology, profile
        self._request = replace(request, outside=profile.component, received=self._received, report=self._report)
        self._wires: Mapping[str, tuple[Wire, ...]] = {}
        """By which outputs each input of the composite is fed."""
        self._runner: TaskRunner | None = None
        self._waiting: list[Callable[[], None]] = []
        """What waits for the inside to run."""
        self.issued: Mapping[str, tuple[Wire, ...]] = {}
        self.settled = False
        self.ending = False
        self.dropped = 0
        self.runtime = ComponentRuntime(bus, Keys(ecology), profile, Component(), secrets.token_hex(4), inputs=self)

    # What the runtime asks for.

    @property
    def patience(self) -> float:
        """How many seconds it may take until the inside runs: its components may have to be started."""
        return 0.0 if self.settled else STARTING_INSIDE

    def follow(self, message: Apply) -> None:
        """Begin with the inside, or tell it what feeds it now."""
        changed, self._wires = self._wires != message.inputs, dict(message.inputs)
        if self._runner is None:
            request = replace(self._request, priority=message.priority, ended=self._ended)
            self._runner = TaskRunner(self._bus, self._ecology, request, beginning=message.beginning)
            self._runner.start()
        elif changed:
            self._runner.rewire()

    def when_settled(self, action: Callable[[], None]) -> None:
        """Do something once the inside runs, or cannot."""
        if self.settled:
            action()
        else:
            self._waiting.append(action)

    def end(self) -> None:
        """Take the inside down; `ending` lasts as long as that takes."""
        if self._runner is not None and not self.ending:
            self.ending = True
            self._runner.stop()

    def close(self) -> None:
        """Live no more, and act no more."""
        self.runtime.close()

    # What the inside reports.

    def _received(self) -> Mapping[str, tuple[Wire, ...]]:
        return self._wires

    def _report(self, event: RunEvent) -> None:
        log.info("%s: %s", self.profile.component.short, event.act)
        if not isinstance(event, TaskRunning) or self._runner is None or self.ending:
            return
        before, self.issued = self.issued, self._runner.issued_outside()
        if not self.settled:
            self._settle(True)
        elif self.issued != before:
            moved = self._bus.publisher(self.runtime.keys.moved(self.profile.component), Urgency.EVENT)
            moved.put(encode(Moved(self.profile.component, self.runtime.life, self.issued)))
            moved.undeclare()

    def _ended(self, refusal: Refusal | Undecided | None) -> None:
        trouble = None if self._runner is None else self._runner.trouble
        self._runner, self.issued = None, {}
        ending, self.ending = self.ending, False
        if ending:
            self._settle(False)
            self.runtime.at_rest()
            return
        self.runtime.fail(f"its inside is refused: {_words(refusal) if trouble is None else trouble}")
        self._settle(False)

    def _settle(self, runs: bool) -> None:
        self.settled = runs
        waiting, self._waiting = self._waiting, []
        for action in waiting:
            action()


class Composites:
    """The composites of one site."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        document_of: Callable[[Advertisement], Document],
        complain: Callable[[str], None],
        aside: Aside = lambda work: work(),
        believed: Beliefs | None = None,
    ) -> None:
        """`document_of` reads the document in which a composite is advertised, and raises SelfconfError.

        `complain` hears why a composite does not live. With keys, `believed` says whose a component is.
        """
        self._bus, self._ecology, self._document_of = bus, ecology, document_of
        self._complain, self._aside, self._believed = complain, aside, believed
        self._advertisements: Mapping[IRI, Advertisement] = {}
        self.living: dict[IRI, InsideOfComposite] = {}
        self._told: dict[IRI, str] = {}

    def refresh(self, advertisements: Mapping[IRI, Advertisement]) -> None:
        """Let those live whose inside can be configured from these advertisements, and no others."""
        known = dict(advertisements)

        def work() -> None:
            found, why = _configurable(known, self._document_of)
            self._bus.wake_up(lambda: self._become(known, found, why))

        self._aside(work)

    def close(self) -> None:
        """Let none live."""
        for composite in self.living.values():
            composite.close()
        self.living.clear()

    def _become(
        self, known: Mapping[IRI, Advertisement], found: Mapping[IRI, Composer], why: Mapping[IRI, str]
    ) -> None:
        self._advertisements = known
        for component in [*self.living]:
            # One that acts finds out by itself what it lacks.
            if component not in known or (component not in found and not self.living[component].runtime.active):
                self.living.pop(component).close()
        for component, composer in found.items():
            if component not in self.living:
                request = self._request(component, composer)
                self.living[component] = InsideOfComposite(self._bus, self._ecology, known[component].profile, request)
        for component, sentence in why.items():
            if self._told.get(component) != sentence:
                self._complain(f"the composite {component} does not live: {sentence}")
        self._told = dict(why)

    def _request(self, component: IRI, composer: Composer) -> RunRequest:
        def compose(found: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Outcome:
            local = {one: a for one, a in found.items() if one in self._advertisements and one != component}
            return composer.compose(local, lost, running)

        return RunRequest(
            task=composer.task.task,
            compose=compose,
            standby=composer.standby,
            not_judged=composer.not_judged,
            passed_over=composer.passed_over,
            name=safe_name(component.short),
            believed=self._believed,
            aside=self._aside,
        )


def insides(
    known: Mapping[IRI, Advertisement], components: Collection[IRI]
) -> Iterator[tuple[IRI, Configuration | str]]:
    """Yield what composites among some components are inside, from given advertisements, or why that is nothing.

    Composites inside of these follow each after the one that holds it.
    """
    found, why = _configurable(known, described_in)
    waiting = list(components)
    while waiting:
        component = waiting.pop(0)
        if component in why:
            yield component, why[component]
        elif component in found:
            others = {one: a for one, a in known.items() if one != component and one not in why}
            inside = found[component].compose(others, frozenset(), None)
            assert isinstance(inside, Configuration)  # otherwise there is a reason
            yield component, inside
            waiting = [*inside.components, *waiting]


def described_in(advertisement: Advertisement) -> Document:
    """The document in which a component is advertised. Raises AuthorError."""
    return turtle.parse(*text_of(Path(advertisement.profile.place.source if advertisement.profile.place else "")))


def _configurable(
    known: Mapping[IRI, Advertisement], document_of: Callable[[Advertisement], Document]
) -> tuple[dict[IRI, Composer], dict[IRI, str]]:
    """The composites whose inside can be configured, and of the others why not."""
    composers: dict[IRI, Composer] = {}
    why: dict[IRI, str] = {}
    for component, advertisement in known.items():
        if advertisement.profile.inside is not None:
            try:
                composers[component] = _composer(advertisement.profile, document_of(advertisement))
            except SelfconfError as error:
                why[component] = str(error)
    why |= _in_circles(composers, known)
    # A composite that does not live cannot be inside of another one: again and again, until all that are left can.
    while lacking := _refused({one: c for one, c in composers.items() if one not in why}, known):
        why |= lacking
    return {one: composer for one, composer in composers.items() if one not in why}, why


def _in_circles(composers: Mapping[IRI, Composer], known: Mapping[IRI, Advertisement]) -> dict[IRI, str]:
    """The composites that could be inside of themselves, each with a sentence."""
    # Itself is left out of the inside of each, so only a way by others leads back.
    within = {one: _may_hold(composer, known) & (composers.keys() - {one}) for one, composer in composers.items()}
    circles = {one: " of ".join(each.short for each in _way_back(one, within)) for one in composers}
    sentence = "it could be inside of itself ({}); a composite of itself has no end"
    return {one: sentence.format(circle) for one, circle in circles.items() if circle}


def _refused(composers: Mapping[IRI, Composer], known: Mapping[IRI, Advertisement]) -> dict[IRI, str]:
    """The composites whose inside cannot be configured beside the others, each with a sentence."""
    able = {one: a for one, a in known.items() if a.profile.inside is None or one in composers}
    found: dict[IRI, str] = {}
    for component, composer in composers.items():
        others = {one: advertisement for one, advertisement in able.items() if one != component}
        outcome = composer.compose(others, frozenset(), None)
        if not isinstance(outcome, Configuration):
            itself = "; it cannot be inside of itself" if component in _may_hold(composer, known) else ""
            found[component] = f"its inside cannot be configured now: {_words(outcome)}{itself}"
    return found


def _composer(profile: Profile, document: Document) -> Composer:
    """What composes the inside of a composite. Raises SelfconfError for what cannot be its inside."""
    inside = tasks.complete(tasks.read_inside(document, profile.component))
    for ports, is_input, word in ((profile.inputs, True, "input"), (profile.outputs, False, "output")):
        own = {port.name for port in inside.task.template.ports if port.is_input is is_input}
        other = sorted({port.name for port in ports} ^ own)
        if other:
            template = inside.task.template.iri.short
            raise AuthorError(f"its {word}s and those of the template {template} differ: {', '.join(other)}")
    if profile.parameters:
        raise AuthorError("a composite has no operational parameters; bind those of its template in its grounding")
    return Composer(inside, outside=profile.component)


def _may_hold(composer: Composer, known: Mapping[IRI, Advertisement]) -> set[IRI]:
    """The components that could be inside of a composite, if it were no matter that one of them is itself."""
    partition = composer.partition(dict(known))
    players = {candidate.profile.component for some in partition.candidates[:-1] for candidate in some}
    return players | {recruit.component for recruit in partition.recruits}


def _way_back(component: IRI, within: Mapping[IRI, set[IRI]]) -> list[IRI]:
    """A way from a composite by what could be inside to itself; nothing if there is none."""
    came: dict[IRI, IRI] = {}
    waiting = [component]
    while waiting:
        one = waiting.pop(0)
        for other in sorted(within.get(one, ())):
            if other == component:
                way = [component, one]
                while way[-1] != component:
                    way.append(came[way[-1]])
                return way
            if other not in came:
                came[other] = one
                waiting.append(other)
    return []


def _words(refusal: Refusal | Undecided | None) -> str:
    """Why there is no configuration, in a sentence."""
    if isinstance(refusal, Refusal) and refusal.reasons:
        return str(refusal.reasons[0])
    return str(refusal) if isinstance(refusal, Undecided) else "it was taken down"
