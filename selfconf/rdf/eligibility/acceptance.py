"""Which outputs conform to the shapes that inputs ask of them (`sc:accepts`), for the candidates of a partition.

An output is judged by the shapes (`output_shapes`) of the inputs that its types match. A shape that cannot be judged,
or not in time, keeps out the component whose input states it; an output that cannot be judged does not conform.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import attrgetter
from typing import NamedTuple, TypeVar

from selfconf.errors import AuthorError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.obstacle import NotJudged, Obstacle
from selfconf.model.partition import Candidate, Partition, Recruit, Unissuable
from selfconf.model.profile import Input, Output, Ports, Profile, WantedSignal, shared_ports
from selfconf.model.template import Template
from selfconf.model.term import IRI
from selfconf.rdf.deadline import ProcessorTimeUp, processor_limit
from selfconf.rdf.eligibility.output_shapes import OutputShape, Port, Seen, SeenOutputs

SECONDS = 5.0
"""Processor time that pySHACL may take for the shapes of one partition: they are written by strangers."""
_PORTS, _CONDITION = attrgetter("profile.ports"), attrgetter("condition")
_C = TypeVar("_C", Candidate, Recruit)


class _Asked(NamedTuple):
    """An input that asks its source for more than a type, and the shape."""

    input: Input
    shape: str


class Acceptance:
    """The shapes of inputs that were met so far, and what was found of them."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self._hierarchy = hierarchy
        self._shapes: dict[str, OutputShape | NotJudged] = {}
        self.not_judged: dict[IRI, NotJudged] = {}
        """Of the partition looked at last: the components of which an input's shape, or an output, cannot be judged."""

    def judged(self, template: Template, partition: Partition, seen: Seen) -> Partition:
        """A partition in which each output tells to which of the shapes it conforms that inputs ask of it."""
        self.not_judged = {}
        asked = _asked_of(template, partition)
        if asked is None:
            return partition
        roles, supplying = asked
        feeding = [
            *(([c.profile for c in some], wanted) for some, wanted in zip(partition.candidates, roles, strict=True)),
            ([recruit.profile for recruit in partition.recruits], supplying),
        ]
        met = self._met(feeding, SeenOutputs(seen))
        return replace(
            partition,
            candidates=tuple(
                tuple(_told(one, met) for one in some if self._can_be_judged(one.profile))
                for some in partition.candidates
            ),
            recruits=tuple(_told(one, met) for one in partition.recruits if self._can_be_judged(one.profile)),
        )

    def _met(
        self, feeding: Iterable[tuple[Sequence[Profile], Sequence[_Asked]]], seen: SeenOutputs
    ) -> dict[Port, set[str]]:
        """For each output the shapes to which it conforms, of the inputs that it could feed by its types."""
        met: dict[Port, set[str]] = {}
        began = time.process_time()
        lists: list[list[Port]] = []  # kept, since what looks alike is remembered by the identity of these lists
        for profiles, wanted in feeding:
            texts: dict[tuple[IRI, ...], dict[str, None]] = {}
            for port, text in wanted:
                texts.setdefault(port.signals, {})[text] = None
            for signals, some in texts.items():
                lists.append(
                    [(p.component, o.name) for p in profiles for o in p.signal_outputs if self._could_feed(o, signals)]
                )
                for text in some if lists[-1] else ():
                    left = SECONDS - (time.process_time() - began)
                    for one in self._conforming(text, lists[-1], seen, left):
                        met.setdefault(one, set()).add(text)
        return met

    def _could_feed(self, output: Output, signals: tuple[IRI, ...]) -> bool:
        """Whether an output could feed an input of some types, by the types or by name alone."""
        return (
            not output.signals
            or not signals
            or any(signal in signals for signal in self._hierarchy.served(output.signals))
        )

    def _conforming(self, text: str, outputs: Sequence[Port], seen: SeenOutputs, left: float) -> set[Port]:
        """The outputs, among some, that conform to a shape; none where it cannot be judged, which is noted.

        `left` is the processor time that it may take.
        """
        shape = self._shape(text)
        if isinstance(shape, OutputShape):
            slow: dict[Port, NotJudged] = {}
            try:
                if left <= 0:
                    raise ProcessorTimeUp
                with processor_limit(left):
                    conforming = shape.conforming(outputs, seen, slow)
            except ProcessorTimeUp:
                self._shapes[text] = NotJudged("the shapes that inputs accept take too long to be judged")
                return set()
            except AuthorError as error:
                self._shapes[text] = _cannot_be_judged(error)
                return set()
            for (component, name), why in slow.items():
                said = f"its output {name!r} feeds no input whose sc:accepts cannot be judged of it: {why.reason}"
                self.not_judged.setdefault(component, NotJudged(said))
            return conforming
        return set()

    def _shape(self, text: str) -> OutputShape | NotJudged:
        if text not in self._shapes:
            try:
                self._shapes[text] = OutputShape(text, self._hierarchy)
            except AuthorError as error:
                self._shapes[text] = _cannot_be_judged(error)
        return self._shapes[text]

    def unissuable(
        self, template: Template, partition: Partition, looked_at: Callable[[int], frozenset[IRI] | None]
    ) -> frozenset[Unissuable]:
        """What candidates want that is not asked of a component to be added, by role, or to be recruited.

        It could not conform, or not as far as is known: where its component has to be as the shape asks, and as a role
        asks. `looked_at` gives for each role the properties that it looks at, or None where these may be any.
        """
        place = {role.iri: number for number, role in enumerate(template.roles)}
        accepting = [[*dict.fromkeys(_accepting(some))] for some in partition.candidates]
        asked: dict[Unissuable, None] = {}
        for one in template.interactions if any(accepting) else ():
            for port in accepting[place[one.sink]]:
                if one.input in (None, port.name):
                    asked[place[one.source], one.output, port.wanted] = None
        for role, some in zip(template.roles, accepting, strict=True):
            asked.update(dict.fromkeys((None, None, port.wanted) for port in some if role.recruits))
        seen = {source: None if source is None else looked_at(source) for source in {source for source, _, _ in asked}}
        return frozenset(one for one in asked if not self._issuable(*one, seen[one[0]]))

    def _issuable(
        self, source: int | None, name: str | None, wanted: WantedSignal, looked_at: frozenset[IRI] | None
    ) -> bool:
        """Whether a component could be added that issues what is wanted, by an output of a name if that is given."""
        shape = self._shape(wanted.condition.accepts) if wanted.condition and wanted.condition.accepts else None
        if not isinstance(shape, OutputShape):
            return True  # no component that states a shape which cannot be judged is a candidate
        if not shape.possible_for(wanted.output(name or ""), name is not None):
            return False
        asked = shape.of_component
        if asked is None or looked_at is None:
            return asked == frozenset()
        above = self._hierarchy.superproperties
        return not any(one in above(other) or other in above(one) for one in asked for other in looked_at)

    def obstacle(self, shape: str, output: Port, seen: Seen) -> Obstacle | None:
        """What keeps an output from being accepted by a shape, if anything does, or that it cannot be judged."""
        known = self._shape(shape)
        try:
            return known if isinstance(known, NotJudged) else known.obstacle(output, SeenOutputs(seen))
        except AuthorError as error:
            return _cannot_be_judged(error)

    def unjudged(self, profile: Profile) -> NotJudged | None:
        """Why a component is kept out of which an input accepts what cannot be judged; None for any other."""
        shapes = (self._shape(one.shape) for one in _asked(profile.ports))
        return next((shape for shape in shapes if isinstance(shape, NotJudged)), None)

    def _can_be_judged(self, profile: Profile) -> bool:
        """Whether each shape that a component states can be judged; it is kept out otherwise, and named."""
        why = self.unjudged(profile)
        if why is not None:
            self.not_judged[profile.component] = why
        return why is None


def _cannot_be_judged(error: AuthorError) -> NotJudged:
    return NotJudged(f"what its input accepts cannot be judged: {getattr(error, 'message', error)}")


def _asked_of(template: Template, partition: Partition) -> tuple[list[list[_Asked]], list[_Asked]] | None:
    """The inputs that ask for more than a type: for each role those that it may feed, and those that recruits may feed.

    None if there are no such inputs at all.
    """
    stating = [[*_stating(candidates)] for candidates in partition.candidates]
    recruiting = [*_stating(partition.recruits)]
    if not any(stating) and not recruiting:
        return None
    place = {role.iri: number for number, role in enumerate(template.roles)}
    of_recruits = dict.fromkeys(one for ports in recruiting for one in _asked(ports))
    asked = [dict(of_recruits) for _ in template.roles]
    for interaction in template.interactions:
        for ports in stating[place[interaction.sink]]:
            asked[place[interaction.source]].update(dict.fromkeys(_asked(ports)))
    for role, some in zip(template.roles, stating, strict=True):
        of_recruits.update(dict.fromkeys(one for ports in some if role.recruits for one in _asked(ports)))
    return [*map(list, asked)], list(of_recruits)


def _stating(candidates: Sequence[Candidate | Recruit]) -> Iterator[Ports]:
    """The ports, each once, of candidates of which an input asks for more than a type."""
    # One look at each candidate and input in C, since few inputs state a condition.
    for ports in {id(ports): ports for ports in map(_PORTS, candidates)}.values():
        if any(map(_CONDITION, ports.inputs)) and any(_asked(ports)):
            yield ports


def _accepting(candidates: Sequence[Candidate]) -> Iterator[Input]:
    """The required inputs of candidates that ask for more than a type."""
    for ports in _stating(candidates):
        yield from (port for port in ports.inputs if port.condition and port.condition.accepts and not port.optional)


def _asked(ports: Ports) -> Iterator[_Asked]:
    for port in ports.inputs:
        if port.condition is not None and port.condition.accepts is not None:
            yield _Asked(port, port.condition.accepts)


def _told(candidate: _C, met: dict[Port, set[str]]) -> _C:
    """A candidate, or a recruit, whose outputs tell to which shapes they conform."""
    profile = candidate.profile
    outputs = tuple(
        output._replace(conforms=frozenset(met.get((profile.component, output.name), ()))) for output in profile.outputs
    )
    if outputs == profile.outputs:
        return candidate
    return replace(candidate, profile=replace(profile, ports=shared_ports(profile.inputs, outputs)))
