"""Ecologies of any size, and the paper's template over them."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator

from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import UNIT

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix : <https://example.org/scale#> .
"""
ROLES = {
    "sonar": ((), ("RangeScan",)),
    "encoder": ((), ("Odometry2D",)),
    "position": ((), ("PlanarPose2D",)),
    "control": (("RangeScan", "Odometry2D", "PlanarPose2D"), ("Velocity2D",)),
    "drive": (("Velocity2D",), ()),
}
KINDS = 200
ROBOTS = 5
_PORT = re.compile(r'sc:has(?P<link>Input|Output) \[ sc:name "(?P<name>\w+)" ; sc:signalType (?P<type>\S+) \]')


def ecology(size: int, seed: int = 0, wanted: bool = True) -> Iterator[str]:
    """The advertisements; without `wanted`, of kinds that no role asks for."""
    rng = random.Random(seed)
    names = list(ROLES)
    yield PREFIXES
    for number in range(size):
        kind = rng.randrange(KINDS) if wanted else rng.randrange(len(ROLES), KINDS)
        kind = number if wanted and number < len(ROLES) else kind
        inputs, outputs = ROLES[names[kind]] if kind < len(ROLES) else _ports(rng)
        said = [f":c{'' if wanted else 'x'}{number:07} a sc:Component, :Kind{kind}"]
        said += [f'sc:hasInput [ sc:name "in{k}" ; sc:signalType rob:{s} ]' for k, s in enumerate(inputs)]
        said += [f'sc:hasOutput [ sc:name "out{k}" ; sc:signalType rob:{s} ]' for k, s in enumerate(outputs)]
        said.append(f'sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode{kind % 7} ]')
        robot = 0 if number < len(ROLES) else rng.randrange(ROBOTS)
        said.append(f"rob:support :robot{robot} ; rob:place :room{rng.randrange(20)}")
        said.append(f":latency {rng.random():.3f} ; :accuracy {rng.random():.2f} ; sc:preference {rng.randrange(10)}")
        yield " ;\n    ".join(said) + " .\n"


def _ports(rng: random.Random) -> tuple[list[str], list[str]]:
    return [f"Signal{rng.randrange(50)}" for _ in range(2)], [f"Signal{rng.randrange(50)}" for _ in range(2)]


def template() -> str:
    """The paper's template over the generated kinds, as Turtle."""
    edges = {"sonar": "control", "encoder": "control", "position": "control", "control": "drive"}
    roles = [
        f":{name} a sc:Role ; sh:class :Kind{kind} ; sh:property [ sh:path rob:support ; sh:in ( :robot ) ]"
        + (f" ; sc:feeds :{edges[name]} ." if name in edges else " .")
        for kind, name in enumerate(ROLES)
    ]
    text = f"{PREFIXES}:t a sc:Template ; sc:parameter :robot ; sc:roles ( {' '.join(f':{r}' for r in ROLES)} ) .\n"
    return text + ':robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .\n' + "\n".join(roles)


def task(robot: str) -> TaskDocument:
    """The paper's template over the generated kinds, on a robot."""
    given = templates.read_task(turtle.parse(template(), "scale.ttl"))
    return bindings.complete(bindings.bind(given, [("robot", f":{robot}")]))


def labelled(text: str, number: int) -> str:
    """The same advertisement with a label, a comment and a serial number that no other has."""
    own = f'rdfs:label "Component {number}"@en ; rdfs:comment "Bought as number {number}" ; :serial "S-{number:09}"'
    return f"{text[: -len(' .' + chr(10))]} ;\n    {own} .\n"


def unlike(text: str, number: int) -> str:
    """The same advertisement with types, signals and values that occur in no other."""
    return re.sub(r"(:Kind|:Mode|Signal|:robot|:room)\d+", rf"\g<1>{number}x", text)


def linked(text: str, number: int) -> str:
    """The same advertisement with ports that have names, and are described in statements of their own."""
    ports: list[str] = []

    def described(port: re.Match[str]) -> str:
        name = f":c{number}-{port['name']}"
        ports.append(f'{name} sc:name "{port["name"]}" ; sc:signalType {port["type"]} .\n')
        return f"sc:has{port['link']} {name}"

    return _PORT.sub(described, text) + "".join(ports)


def topical(text: str, number: int) -> str:
    """The same advertisement with ports that are called after its robot, and outputs that promise a rate."""
    rate = f" ; sc:rate [ sc:value 10.0 ; sc:unit <{UNIT.HZ}> ]"

    def topic(port: re.Match[str]) -> str:
        said = f'sc:name "/robot{number}/{port["name"]}" ; sc:signalType {port["type"]}'
        return f"sc:has{port['link']} [ {said}{rate if port['link'] == 'Output' else ''} ]"

    return _PORT.sub(topic, text)
