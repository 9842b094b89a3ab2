"""Which outputs conform to the shapes that inputs ask of them (`sc:accepts`), for the candidates of a partition.

A shape is judged as the shape of a role is: what can be compiled needs no graph, and pySHACL judges the rest, on the
pairs whose types match. Here the node that is looked at is an output, so that a path is walked first, and the tests see
its ends as the values of a property of their own. A shape that cannot be judged, or not in time, keeps out the
component whose input states it; an output that cannot be judged does not conform.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import NamedTuple, TypeVar

from selfconf.errors import AuthorError, TemplateError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.obstacle import NotJudged, Obstacle, ShapeViolated
from selfconf.model.partition import Candidate, Partition, Recruit
from selfconf.model.profile import Input, Output, Ports, Profile, shared_ports
from selfconf.model.template import Template
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf.advertisements import shape_text
from selfconf.rdf.eligibility.compiled_roles import compile_role
from selfconf.rdf.eligibility.node_paths import WalkedStatements
from selfconf.rdf.shacl import PAIRS, misfit
from selfconf.rdf.turtle import Document, Node, Triple, parse
from selfconf.rdf.vocabulary import SC, SH, TYPE

SECONDS = 5.0
"""Processor time that pySHACL may take for the shapes of one partition: they are written by strangers."""
_PORTS, _CONDITION = attrgetter("profile.ports"), attrgetter("condition")
_SHAPE = IRI("urn:selfconf:acceptance:shape")
_OUTPUT = IRI("urn:selfconf:acceptance:output")
_PATH = "urn:selfconf:acceptance:path:"
_C = TypeVar("_C", Candidate, Recruit)
Port = tuple[IRI, str]
"""A component, and the name of an output of it."""
Looks = tuple[tuple[tuple[Term, ...], ...], frozenset[IRI]]
"""What a shape sees of an output: where each of its paths leads, and the types."""
Seen = Callable[[IRI], Sequence[Triple]]
"""For a component what a shape sees of its advertisement."""


class SeenOutputs:
    """The outputs of an ecology as shapes see them; each is looked at once for each path, by however many shapes."""

    def __init__(self, seen: Seen, hierarchy: Hierarchy) -> None:
        self._seen, self._hierarchy = seen, hierarchy
        self._triples: dict[IRI, Sequence[Triple]] = {}
        self._statements: dict[IRI, WalkedStatements] = {}
        self._values: dict[tuple[str, Port], tuple[Term, ...]] = {}
        self._alike: dict[tuple[tuple[str, ...], int], dict[Looks, list[Port]]] = {}

    def triples(self, component: IRI) -> Sequence[Triple]:
        """What a shape sees of an advertisement, with the same blank nodes each time."""
        if component not in self._triples:
            self._triples[component] = self._seen(component)
        return self._triples[component]

    def node(self, port: Port) -> Node:
        """The node of an output."""
        return _node(self.triples(port[0]), *port)

    def alike(self, paths: Sequence[tuple[str, Document, Term]], outputs: Sequence[Port]) -> dict[Looks, list[Port]]:
        """Outputs by what some paths, each with its text, lead to from them, and by their types."""
        key = tuple(text for text, _, _ in paths), id(outputs)
        if key not in self._alike:
            found: dict[Looks, list[Port]] = {}
            for port in outputs:
                ends = tuple(self._ends(text, document, path, port) for text, document, path in paths)
                found.setdefault((ends, self._types(port)), []).append(port)
            self._alike[key] = found
        return self._alike[key]

    def _ends(self, text: str, document: Document, path: Term, port: Port) -> tuple[Term, ...]:
        if (text, port) not in self._values:
            ends = self._walked(port).walked(document, path, self.node(port))
            self._values[text, port] = tuple(sorted(ends, key=sort_key))
        return self._values[text, port]

    def _types(self, port: Port) -> frozenset[IRI]:
        types = self._walked(port).values(self.node(port), TYPE)
        return frozenset(value for value in types if isinstance(value, IRI))

    def _walked(self, port: Port) -> WalkedStatements:
        component = port[0]
        if component not in self._statements:
            self._statements[component] = WalkedStatements(self.triples(component), self._hierarchy)
        return self._statements[component]


class OutputShape:
    """The shape that an input accepts, compiled."""

    def __init__(self, text: str, hierarchy: Hierarchy) -> None:
        """`text` is the shape as Turtle in brackets. Raises AuthorError."""
        self._hierarchy = hierarchy
        self._document = parse(f"<{_SHAPE}> {text[1:-1]} .", "sc:accepts")
        wrong = misfit(self._document, self._document.triples(), frozenset())
        if wrong is not None:
            raise TemplateError(wrong[1], file="sc:accepts")
        self._names: dict[Term, IRI] = {}
        """For each path of the shape, or property that values are compared to, what the tests see in its place."""
        named = {subject: [*map(self._renamed, said)] for subject, said in self._document.statements.items()}
        self._paths = [(shape_text(self._document, path), self._document, path) for path in self._names]
        self._tests = compile_role(Document("sc:accepts", named, {}), _SHAPE, (), frozenset())

    def _renamed(self, statement: tuple[IRI, Term]) -> tuple[IRI, Term]:
        predicate, value = statement
        if predicate != SH.path and predicate not in PAIRS:
            return statement
        # The last segment of the name is how an obstacle calls the property.
        steps = ".".join(step.short for step in _steps(self._document, value))
        return predicate, self._names.setdefault(value, IRI.unchecked(f"{_PATH}{len(self._names)}#{steps}"))

    def conforming(
        self, outputs: Sequence[Port], seen: SeenOutputs, not_judged: dict[Port, NotJudged] | None = None
    ) -> set[Port]:
        """Those of some outputs that conform; those that cannot be judged are noted in `not_judged`.

        Raises TemplateError where none can be judged, as then it is the shape that is at fault.
        """
        passed: list[Port] = []
        for looks, some in seen.alike(self._paths, outputs).items():
            obstacle = self._obstacle(looks)
            if obstacle is None:
                passed += some
            elif isinstance(obstacle, NotJudged) and not_judged is not None:
                not_judged.update(dict.fromkeys(some, obstacle))
        return {*passed} if self._tests.complete or not passed else self._by_pyshacl(passed, seen, not_judged)

    def obstacle(self, output: Port, seen: SeenOutputs) -> Obstacle | None:
        """What keeps an output from conforming, if anything does. Raises TemplateError where that cannot be judged."""
        ((looks, _),) = seen.alike(self._paths, [output]).items()
        found = self._obstacle(looks)
        if found is None and not self._tests.complete and not self._by_pyshacl([output], seen):
            return ShapeViolated("it does not conform")
        return found

    def _obstacle(self, looks: Looks) -> Obstacle | None:
        """The first obstacle that outputs which look alike meet in the tests."""
        ends, types = looks
        pairs = [(name, value) for name, values in zip(self._names.values(), ends, strict=True) for value in values]
        # The tests look at the profile of a component, so that is what an output has to look like.
        return next(self._tests.obstacles(Profile(_OUTPUT, types, tuple(pairs)), self._hierarchy), None)

    def _by_pyshacl(
        self, outputs: Sequence[Port], seen: SeenOutputs, not_judged: dict[Port, NotJudged] | None = None
    ) -> set[Port]:
        from selfconf.rdf.conformance import violations  # most shapes are compiled in full: pySHACL is not loaded
        from selfconf.rdf.rdflib_terms import to_rdflib

        shapes = to_rdflib([*self._document.triples(), (_SHAPE, TYPE, SH.NodeShape)])
        found, reasons = set[Port](), list[object]()
        own: dict[IRI, dict[Port, Node]] = {}
        for port in outputs:
            own.setdefault(port[0], {})[port] = seen.node(port)
        for component, nodes in own.items():
            # What another component says is not seen, so that no shape judges other components.
            data = to_rdflib(seen.triples(component))
            wrong = violations(data, shapes, _SHAPE, list(nodes.values()), "sc:accepts", "the shape")
            found |= {port for port, node in nodes.items() if node not in wrong}
            reasons += [one for some in wrong.values() for one in some]
            for port, node in nodes.items():
                for one in wrong.get(node, ()):
                    if not_judged is not None and isinstance(one, NotJudged):
                        not_judged[port] = one
        if not found and all(isinstance(one, NotJudged) for one in reasons):
            raise TemplateError(str(reasons[0]), file="sc:accepts")  # no output is to blame
        return found


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
        met = self._met(feeding, SeenOutputs(seen, self._hierarchy))
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
                    in_time = time.process_time() - began < SECONDS
                    for one in self._conforming(text, lists[-1], seen, in_time):
                        met.setdefault(one, set()).add(text)
        return met

    def _could_feed(self, output: Output, signals: tuple[IRI, ...]) -> bool:
        """Whether an output could feed an input of some types, by the types or by name alone."""
        return (
            not output.signals
            or not signals
            or any(signal in signals for signal in self._hierarchy.served(output.signals))
        )

    def _conforming(self, text: str, outputs: Sequence[Port], seen: SeenOutputs, in_time: bool) -> set[Port]:
        """Those of some outputs that conform to a shape; none where it cannot be judged, which is noted."""
        shape = self._shape(text)
        if isinstance(shape, OutputShape):
            if not in_time:
                self._shapes[text] = NotJudged("the shapes that inputs accept take too long to be judged")
                return set()
            slow: dict[Port, NotJudged] = {}
            try:
                conforming = shape.conforming(outputs, seen, slow)
                for (component, name), why in slow.items():
                    said = f"its output {name!r} feeds no input that accepts some outputs only: {why.reason}"
                    self.not_judged.setdefault(component, NotJudged(said))
                return conforming
            except AuthorError as error:
                self._shapes[text] = _cannot_be_judged(error)
        return set()

    def _shape(self, text: str) -> OutputShape | NotJudged:
        if text not in self._shapes:
            try:
                self._shapes[text] = OutputShape(text, self._hierarchy)
            except AuthorError as error:
                self._shapes[text] = _cannot_be_judged(error)
        return self._shapes[text]

    def obstacle(self, shape: str, output: Port, seen: Seen) -> Obstacle | None:
        """What keeps an output from being accepted by a shape, if anything does, or that it cannot be judged."""
        known = self._shape(shape)
        try:
            return known if isinstance(known, NotJudged) else known.obstacle(output, SeenOutputs(seen, self._hierarchy))
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


def _steps(document: Document, path: Term) -> Iterator[IRI]:
    """The properties that a path names, in their order."""
    if isinstance(path, IRI):
        yield path
    for item in document.items(path) or [value for _, value in document.about(path)]:
        yield from _steps(document, item)


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


def _node(triples: Sequence[Triple], component: IRI, name: str) -> Node:
    """The node of an output of a component."""
    outputs = {value for subject, link, value in triples if subject == component and link == SC.hasOutput}
    return next(
        subject
        for subject, predicate, value in triples
        if predicate == SC.name and subject in outputs and str(value) == name
    )
