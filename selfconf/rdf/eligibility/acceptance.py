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

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.obstacle import NotJudged
from selfconf.model.partition import Candidate, Partition, Recruit
from selfconf.model.profile import Input, Output, Ports, Profile, shared_ports
from selfconf.model.template import Template
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf.eligibility.compiler import compile_role
from selfconf.rdf.eligibility.node_paths import WalkedStatements
from selfconf.rdf.shacl import misfit
from selfconf.rdf.turtle import Document, Node, Triple, parse
from selfconf.rdf.vocabulary import SC, SH, TYPE

SECONDS = 5.0
"""Processor time that pySHACL may take for the shapes of one partition: they are written by strangers."""
_PORTS = attrgetter("profile.ports")
_SHAPE = IRI("urn:selfconf:acceptance:shape")
_OUTPUT = IRI("urn:selfconf:acceptance:output")
_PATH = "urn:selfconf:acceptance:path:"
_C = TypeVar("_C", Candidate, Recruit)
Port = tuple[IRI, str]
"""A component, and the name of an output of it."""
Seen = Callable[[IRI], Sequence[Triple]]
"""For a component what a shape sees of its advertisement."""


class OutputShape:
    """The shape that an input accepts, compiled."""

    def __init__(self, text: str, hierarchy: Hierarchy) -> None:
        """`text` is the shape as Turtle in brackets. Raises TemplateError."""
        self._hierarchy = hierarchy
        self._document = parse(f"<{_SHAPE}> {text[1:-1]} .", "sc:accepts")
        wrong = misfit(self._document, self._document.triples(), frozenset())
        if wrong is not None:
            raise TemplateError(wrong[1], file="sc:accepts")
        self._paths: dict[Term, IRI] = {}
        """For each path of the shape the property that the tests see in its place."""
        named = {subject: [*map(self._renamed, said)] for subject, said in self._document.statements.items()}
        self._tests = compile_role(Document("sc:accepts", named, {}), _SHAPE, (), {}, frozenset())

    def _renamed(self, statement: tuple[IRI, Term]) -> tuple[IRI, Term]:
        predicate, value = statement
        if predicate != SH.path:
            return statement
        return predicate, self._paths.setdefault(value, IRI(f"{_PATH}{len(self._paths)}"))

    def conforming(self, outputs: dict[Port, Node], seen: Seen) -> set[Port]:
        """Those of some outputs, each with its node, that conform. Raises TemplateError where that cannot be judged."""
        passed = {port: node for port, node in outputs.items() if self._passes(seen(port[0]), node)}
        return {*passed} if self._tests.complete or not passed else self._by_pyshacl(passed, seen)

    def _passes(self, triples: Sequence[Triple], output: Node) -> bool:
        """Whether an output passes the tests that were compiled, given what is said in its advertisement."""
        statements = WalkedStatements(triples, self._hierarchy)
        types = frozenset(value for value in statements.values(output, TYPE) if isinstance(value, IRI))
        pairs = [
            (name, value)
            for path, name in self._paths.items()
            for value in sorted(statements.walked(self._document, path, output), key=sort_key)
        ]
        # The tests look at the profile of a component, so that is what the output has to look like.
        profile = Profile(output if isinstance(output, IRI) else _OUTPUT, types, tuple(pairs))
        return next(self._tests.obstacles(profile, self._hierarchy), None) is None

    def _by_pyshacl(self, outputs: dict[Port, Node], seen: Seen) -> set[Port]:
        from selfconf.rdf.conformance import violations  # most shapes are compiled in full: pySHACL is not loaded
        from selfconf.rdf.rdflib_terms import to_rdflib

        data = to_rdflib(dict.fromkeys(triple for component, _ in outputs for triple in seen(component)))
        shapes = to_rdflib([*self._document.triples(), (_SHAPE, TYPE, SH.NodeShape)])
        wrong = violations(data, shapes, _SHAPE, list(outputs.values()), "sc:accepts", detailed=False)
        reasons = [one for some in wrong.values() for one in some]
        if len(wrong) == len(outputs) and all(isinstance(one, NotJudged) for one in reasons):
            raise TemplateError(str(reasons[0]), file="sc:accepts")  # no output is to blame
        return {port for port, node in outputs.items() if node not in wrong}


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
        """Of the partition that was looked at last: the components whose inputs state a shape that cannot be judged."""

    def judged(self, template: Template, partition: Partition, seen: Seen) -> Partition:
        """A partition in which each output tells to which of the shapes it conforms that inputs ask of it."""
        self.not_judged = {}
        asked = _asked_of(template, partition)
        if asked is None:
            return partition
        known: dict[IRI, Sequence[Triple]] = {}

        def remembered(component: IRI) -> Sequence[Triple]:
            if component not in known:
                known[component] = seen(component)
            return known[component]

        roles, supplying = asked
        outputs = [
            *((c.profile, wanted) for some, wanted in zip(partition.candidates, roles, strict=True) for c in some),
            *((recruit.profile, supplying) for recruit in partition.recruits),
        ]
        met = self._met(outputs, remembered)
        return replace(
            partition,
            candidates=tuple(
                tuple(_told(one, met) for one in some if self._can_be_judged(one.profile))
                for some in partition.candidates
            ),
            recruits=tuple(_told(one, met) for one in partition.recruits if self._can_be_judged(one.profile)),
        )

    def _met(self, profiles: Iterable[tuple[Profile, Sequence[_Asked]]], seen: Seen) -> dict[Port, set[str]]:
        """For each output the shapes to which it conforms, of the inputs that it could feed by its types."""
        pairs: dict[str, dict[Port, Node]] = {}
        for profile, wanted in profiles:
            for output in profile.outputs if wanted else ():
                for text in self._could_feed(output, wanted):
                    node = _node(seen(profile.component), profile.component, output.name)
                    pairs.setdefault(text, {})[profile.component, output.name] = node
        met: dict[Port, set[str]] = {}
        began = time.process_time()
        for text, outputs in pairs.items():
            for port in self._conforming(text, outputs, seen, in_time=time.process_time() - began < SECONDS):
                met.setdefault(port, set()).add(text)
        return met

    def _could_feed(self, output: Output, wanted: Sequence[_Asked]) -> set[str]:
        return {
            text
            for port, text in wanted
            if not output.signals or not port.signals or self._hierarchy.pairs(output, port._replace(condition=None))
        }

    def _conforming(self, text: str, outputs: dict[Port, Node], seen: Seen, in_time: bool) -> set[Port]:
        """Those of some outputs that conform to a shape; none where it cannot be judged, which is noted."""
        shape = self._shape(text) if in_time else NotJudged("the shapes that inputs accept take too long to be judged")
        if isinstance(shape, OutputShape):
            try:
                return shape.conforming(outputs, seen)
            except TemplateError as error:
                self._shapes[text] = _cannot_be_judged(error)
        return set()

    def _shape(self, text: str) -> OutputShape | NotJudged:
        if text not in self._shapes:
            try:
                self._shapes[text] = OutputShape(text, self._hierarchy)
            except TemplateError as error:
                self._shapes[text] = _cannot_be_judged(error)
        return self._shapes[text]

    def _can_be_judged(self, profile: Profile) -> bool:
        """Whether each shape that a component states can be judged; it is kept out otherwise, and named."""
        for one in _asked(profile.ports):
            shape = self._shape(one.shape)
            if isinstance(shape, NotJudged):
                self.not_judged[profile.component] = shape
                return False
        return True


def _cannot_be_judged(error: TemplateError) -> NotJudged:
    return NotJudged(f"what its input accepts cannot be judged: {error.message}")


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
    # One look at each candidate in C, then one at each choice of ports that they share.
    for ports in {id(ports): ports for ports in map(_PORTS, candidates)}.values():
        if any(True for _ in _asked(ports)):
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
