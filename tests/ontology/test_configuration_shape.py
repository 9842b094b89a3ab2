"""The shape of a configuration against the definition of a configuration, spelt out in Python."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product

import pyshacl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rdflib import Graph

from selfconf import library
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.pyshacl_corrections.prepared_queries import prepared_queries
from tests.harness.effort import examples

SHAPES = Graph().parse(next(path for path in library.shapes() if path.stem == "configuration"))
PREFIXES = """\
@prefix : <https://example.org/#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:Special rdfs:subClassOf :Audio .
"""
BELOW = {("Audio", "Audio"), ("Text", "Text"), ("Special", "Special"), ("Special", "Audio")}
"""Offered and wanted types that match."""
Port = tuple[str, str]
Connection = tuple[str, str, str, str]


@dataclass(frozen=True)
class World:
    """Two or three roles, who feeds whom, a component for each name, who plays what, and what is connected."""

    feeds: frozenset[tuple[str, str]]
    interactions: tuple[tuple[str, str, str | None, str | None], ...]
    outputs: dict[str, tuple[Port, ...]]
    inputs: dict[str, tuple[Port, ...]]
    counts: dict[str, tuple[int | None, int | None]]
    cast: tuple[tuple[str, str], ...]
    """Role and component."""
    connections: frozenset[Connection] = field(default_factory=frozenset)

    def wanted(self) -> set[Connection]:
        """Every matching pair of ports along the interactions (section 2.3 of the paper)."""
        found: set[Connection] = set()
        for (feeder, source), (fed, sink) in product(self.cast, repeat=2):
            for (output, offered), (input_, asked) in product(self.outputs[source], self.inputs[sink]):
                along = (feeder, fed) in self.feeds or any(
                    (feeder, fed) == (start, end) and left in (None, output) and right in (None, input_)
                    for start, end, left, right in self.interactions
                )
                if along and (offered, asked) in BELOW:
                    found.add((source, output, sink, input_))
        return found

    def is_configuration(self) -> bool:
        components = [component for _, component in self.cast]
        fed = {(sink, input_) for _, _, sink, input_ in self.connections}
        return (
            len(components) == len(set(components))
            and all(self.enough(role) for role in self.counts)
            and self.connections == self.wanted()
            and all((component, name) in fed for component in components for name, _ in self.inputs[component])
        )

    def enough(self, role: str) -> bool:
        least, most = self.counts[role]
        played = sum(role == other for other, _ in self.cast)
        if least is None and most is None:
            least = most = 1
        return (1 if least is None else least) <= played and (most is None or played <= most)

    def turtle(self) -> str:
        lines = [f":t a sc:Template ; sc:roles ( {' '.join(':' + role for role in self.counts)} ) ."]
        for role, (least, most) in self.counts.items():
            lines.append(f":{role} a sc:Role .")
            lines += [f":{role} sc:minCount {least} ."] * (least is not None)
            lines += [f":{role} sc:maxCount {most} ."] * (most is not None)
        lines += [f":{feeder} sc:feeds :{fed} ." for feeder, fed in self.feeds]
        for start, end, left, right in self.interactions:
            ports = (f' ; sc:output "{left}"' if left else "") + (f' ; sc:input "{right}"' if right else "")
            lines.append(f"[] a sc:Interaction ; sc:from :{start} ; sc:to :{end}{ports} .")
        for component, outputs in self.outputs.items():
            lines.append(f":{component} a sc:Component, :Thing .")
            lines += [f':{component} sc:hasOutput [ sc:name "{n}" ; sc:signalType :{s} ] .' for n, s in outputs]
            lines += [f':{component} sc:hasInput [ sc:name "{n}" ; sc:signalType :{s} ] .'
                      for n, s in self.inputs[component]]  # fmt: skip
        lines.append(":now a sc:Configuration ; sc:template :t .")
        lines += [
            f":now sc:assignment [ sc:role :{role} ; sc:component :{component} ] ." for role, component in self.cast
        ]
        lines += [
            f':now sc:connection [ a sc:Connection ; sc:from :{source} ; sc:output "{output}" ; '
            f'sc:to :{sink} ; sc:input "{input_}" ] .'
            for source, output, sink, input_ in self.connections
        ]
        return PREFIXES + "\n".join(lines)


ROLES = ("r", "s", "t2")
COMPONENTS = ("a", "b", "c")
SIGNALS = st.sampled_from(("Audio", "Audio", "Special", "Text"))


def ports(names: tuple[str, ...]) -> st.SearchStrategy[tuple[Port, ...]]:
    return st.lists(st.tuples(st.sampled_from(names), SIGNALS), max_size=2, unique_by=lambda port: port[0]).map(tuple)


@st.composite
def worlds(draw: st.DrawFn) -> World:
    roles = ROLES[: draw(st.integers(1, 3))]
    pairs = st.tuples(st.sampled_from(roles), st.sampled_from(roles))
    counts = st.sampled_from(((None, None), (None, None), (1, 2), (0, 1), (None, 2), (2, None)))
    world = World(
        frozenset(draw(st.lists(pairs, min_size=1, max_size=4))),
        tuple(
            (*draw(pairs), draw(st.sampled_from((None, "x"))), draw(st.sampled_from((None, "i"))))
            for _ in range(draw(st.integers(0, 1)))
        ),
        {component: draw(ports(("x", "y"))) for component in COMPONENTS},
        {component: draw(ports(("i", "j"))) for component in COMPONENTS},
        {role: draw(counts) for role in roles},
        tuple(zip(roles, draw(st.permutations(COMPONENTS)), strict=False))
        if draw(st.booleans())
        else tuple(
            draw(st.lists(st.tuples(st.sampled_from(roles), st.sampled_from(COMPONENTS)), max_size=3, unique=True))
        ),
    )
    connections = set(world.wanted())
    if draw(st.booleans()):  # leave out the inputs that nobody feeds: otherwise hardly any world would do
        fed = {(sink, input_) for _, _, sink, input_ in connections}
        inputs = {one: tuple(port for port in world.inputs[one] if (one, port[0]) in fed) for one in COMPONENTS}
        world = replace(world, inputs=inputs)
    if connections and draw(st.integers(0, 3)) == 0:
        connections.discard(draw(st.sampled_from(sorted(connections))))
    if len(world.cast) > 1 and draw(st.integers(0, 3)) == 0:
        connections.add((world.cast[0][1], "x", world.cast[1][1], "i"))
    return replace(world, connections=frozenset(connections))


@pytest.mark.parametrize(("optional", "conforms"), [("true", True), ("1", True), ("false", False), ("0", False)])
def test_an_optional_input_need_not_be_fed_however_that_is_written(optional: str, conforms: bool) -> None:
    alone = World(frozenset(), (), {"a": ()}, {"a": ()}, {"r": (None, None)}, (("r", "a"),))
    said = f'"{optional}"^^<http://www.w3.org/2001/XMLSchema#boolean>'
    wanting = f'\n:a sc:hasInput [ sc:name "i" ; sc:signalType :Text ; sc:optional {said} ] .'
    data, _ = parse_with_positions(alone.turtle() + wanting, "")
    with prepared_queries():  # the queries of the shape are parsed once, not once for each case
        assert pyshacl.validate(data, shacl_graph=SHAPES)[0] is conforms


@settings(max_examples=examples(40), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(worlds())
def test_the_shape_holds_for_configurations_and_for_nothing_else(world: World) -> None:
    with prepared_queries():  # the queries of the shape are parsed once, not once for each world
        conforms, _, text = pyshacl.validate(Graph().parse(data=world.turtle(), format="turtle"), shacl_graph=SHAPES)
    assert conforms == world.is_configuration(), text
