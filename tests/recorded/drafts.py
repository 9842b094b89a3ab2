"""Random ecologies in the making: roles, interactions, parameters, and components that can play them, or nearly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tests.recorded.chance import Chance
from tests.recorded.shapes import HEAD, NEEDS_PYSHACL, QUALITIES, SHAPES, Shape

ROBOTS = (":Astrid", ":Pippi", ":Emil")
ROOMS = (":kitchen", ":bedroom")


def statement(subject: str, said: Sequence[str]) -> str:
    """What is said of a subject, a line each."""
    joined = " ;\n    ".join(said)
    return f"{subject} {joined} .\n"


@dataclass
class Component:
    """An advertisement in the making."""

    name: str
    kind: str
    inputs: list[tuple[str, str]] = field(default_factory=list)
    outputs: list[tuple[str, str]] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    """Further predicates with their objects, as Turtle."""

    def turtle(self) -> str:
        """The advertisement."""
        parts = [f"a sc:Component, {self.kind}"]
        for link, ports in (("hasInput", self.inputs), ("hasOutput", self.outputs)):
            parts += [f'sc:{link} [ sc:name "{name}" ; sc:signalType {signal} ]' for name, signal in ports]
        return statement(self.name, [*parts, *self.said])


@dataclass
class Role:
    """A role in the making."""

    name: str
    kind: str
    minimum: int
    maximum: int | None
    shapes: list[Shape]
    feeds: list[str] = field(default_factory=list)
    counted: bool = False
    """Whether the cardinalities are written down."""
    sets: list[str] = field(default_factory=list)

    def turtle(self) -> str:
        """The role, which is a shape."""
        parts = ["a sc:Role", f"sh:class {self.kind}", *(shape.turtle for shape in self.shapes)]
        if self.feeds:
            parts.append(f"sc:feeds {', '.join(self.feeds)}")
        if self.counted:
            parts.append(f"sc:minCount {self.minimum}")
            parts += [] if self.maximum is None else [f"sc:maxCount {self.maximum}"]
        return statement(self.name, [*parts, *self.sets])


class Draft:
    """An ecology while it is being made."""

    def __init__(self, seed: int) -> None:
        self.chance = Chance(seed)
        self.reasoning = self.chance.one(("syntactic",) * 7 + ("subclass",) * 3)
        self.roles: list[Role] = []
        self.components: list[Component] = []
        self.casts: list[list[Component]] = []
        self.edges: list[tuple[int, int, str]] = []
        """Source, sink and signal; the port at either end is named after them."""
        self.named: list[str] = []
        """Interactions in the long form."""
        self.parameters: list[str] = []
        """The parameters, as Turtle."""
        self.bound: list[str] = []
        self.robot = "" if self.chance.often(0.25) else self.chance.one(("free", "free", "free", "bound", "default"))
        """How the parameter `robot` gets its value, if shapes mention it."""
        self.cast_robot = self.chance.one(ROBOTS)
        self._add_roles()
        self._add_interactions()
        for number in range(len(self.roles)):
            self.casts.append([self._player(number, f"a{each}") for each in range(self._asked(number))])
        self._add_rivals()
        self._add_parameters()

    def _asked(self, number: int) -> int:
        role = self.roles[number]
        return max(role.minimum, 1) if self.chance.often(0.8) else role.minimum

    # Roles and what is between them.

    def _add_roles(self) -> None:
        chance = self.chance
        for number in range(2 + chance.below(4)):
            shared = number and chance.often(0.15)
            kind = self.roles[-1].kind if shared else f":K{number}"
            counts = chance.one(((1, 1),) * 12 + ((0, 1), (1, 2), (1, None), (2, 2), (2, 3), (0, None)))
            shapes = chance.some(SHAPES, 0.12)
            if chance.often(0.004):
                shapes.append(chance.one(NEEDS_PYSHACL))
            role = Role(f":r{number}", kind, *counts, shapes, counted=counts != (1, 1) or chance.often(0.1))
            if self.robot and chance.often(0.7):
                role.shapes.append(chance.one(QUALITIES["support"]))
            self.roles.append(role)

    def _add_interactions(self) -> None:
        chance, count = self.chance, len(self.roles)
        for sink in range(1, count):
            for source in sorted({chance.below(sink) for _ in range(chance.one((0, 1, 1, 1, 2)))}):
                self.edges.append((source, sink, f"S{chance.below(6)}"))
        if count > 2 and chance.often(0.05):
            self.edges.append((count - 1, 0, "S5"))  # a cycle, or a longer way back
        for source, sink, signal in self.edges:
            if chance.often(0.8):
                self.roles[source].feeds.append(self.roles[sink].name)
            else:
                ports = [f'sc:output "{output_of(sink, signal)}"', f'sc:input "{input_of(source, signal)}"']
                ends = f"sc:from {self.roles[source].name} ; sc:to {self.roles[sink].name}"
                said = " ; ".join((ends, *chance.some(ports, 0.8)))
                self.named.append(f"[] a sc:Interaction ; {said} .\n")

    # Components.

    def _player(self, number: int, suffix: str) -> Component:
        """A component that can play a role, and gets what its inputs need from any player of the roles before."""
        chance, role = self.chance, self.roles[number]
        made = Component(f":{chance.one('bcdfgh')}{number}-{suffix}", role.kind)
        for source, sink, signal in self.edges:
            if sink == number and (suffix.startswith("a") or chance.often(0.9)):
                made.inputs.append((input_of(source, signal), f":{signal}"))
            if source == number:
                offered = f":Fine{signal}" if self.reasoning == "subclass" and chance.often(0.3) else f":{signal}"
                made.outputs.append((output_of(sink, signal), offered))
        if self.reasoning == "subclass" and chance.often(0.3):
            made.kind = chance.one((f":Better{role.kind[1:]}", f":Best{role.kind[1:]}"))
        for shape in role.shapes:
            made.said += [good.format(robot=self.cast_robot) for good in shape.good]
        made.said += chance.some((f":latency {chance.below(9)}", f":power {chance.below(40) / 2}"), 0.5)
        if chance.often(0.4):
            made.said.append(f"sc:preference {chance.one((1, 2, 5, -3, 2.5))}")
        if chance.often(0.1):
            made.said.append(f'rdfs:label "{made.name[1:]}"@en')
        self.components.append(made)
        return made

    def _add_rivals(self) -> None:
        """Components like those of the cast, most with something else about them."""
        chance = self.chance
        for number in range(len(self.roles)):
            for each in range(chance.one((0, 0, 1, 1, 2, 4))):
                rival = self._player(number, f"z{each}")
                if chance.often(0.6):
                    spoil(rival, chance, self.roles[number])
        for each in range(chance.one((0, 0, 0, 1, 3))):
            self.components.append(Component(f":x{each}", f":Other{chance.below(3)}", [], [("out", ":S0")]))

    # Parameters.

    def _add_parameters(self) -> None:
        chance = self.chance
        if self.robot:
            listed = f" ; sh:in ( {' '.join(ROBOTS)} )" if chance.often(0.2) else ""
            default = f" ; sh:defaultValue {self.cast_robot}" if self.robot == "default" else ""
            self.parameters.append(f':robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI{listed}{default} .\n')
            if self.robot == "bound" or (self.robot == "default" and chance.often(0.3)):
                self.bound.append(f"robot={self.cast_robot}")
        if chance.often(0.3):
            number = chance.below(len(self.roles))
            self.roles[number].sets.append("sc:sets [ sc:parameterType :Goal ; sc:value :goal ]")
            default = ' ; sh:defaultValue "home"' if chance.often(0.3) else ""
            self.parameters.append(f':goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string{default} .\n')
            if not default or chance.often(0.3):
                self.bound.append(chance.one(("goal=(AT BEDROOM)", 'goal="away"', "goal=to the door")))
            for component in self.components:
                if component.kind.endswith(self.roles[number].kind[1:]) and chance.often(0.97):
                    component.said.append('sc:hasParameter [ sc:name "goal" ; sc:parameterType :Goal ]')

    # Files.

    def template(self) -> str:
        """The template as Turtle."""
        names = [line.split(" ", 1)[0] for line in self.parameters]
        said = [f"sc:parameter {', '.join(names)}"] if names else []
        said.append(f"sc:roles ( {' '.join(role.name for role in self.roles)} )")
        said += self.costs
        return "".join(
            (
                HEAD,
                f":task a sc:Template ; {' ; '.join(said)} .\n",
                *self.parameters,
                *(role.turtle() for role in self.roles),
                *self.named,
            )
        )

    costs: tuple[str, ...] = ()


def input_of(source: int, signal: str) -> str:
    """The name of the input that takes a signal from a role."""
    return f"from{source}.{signal}"


def output_of(sink: int, signal: str) -> str:
    """The name of the output that gives a signal to a role."""
    return f"to{sink}.{signal}"


def spoil(component: Component, chance: Chance, role: Role) -> None:
    """Change one thing about a component, by which it often does not fit any more."""
    ways = ["kind", "kind"]
    ways += ["input"] * bool(component.inputs) + ["output"] * 2 * bool(component.outputs)
    ways += ["said"] * 3 * bool(role.shapes) + ["more"]
    way = chance.one(ways)
    if way == "kind":
        bare = role.kind[1:]
        component.kind = chance.one((f":Better{bare}", f":Best{bare}", f":{bare}x", f":{bare.lower()}"))
    elif way == "input":
        name, signal = component.inputs.pop()
        component.inputs.append((name, chance.one((f"{signal}Too", ":Fine" + signal.lstrip(":"), ":S5"))))
    elif way == "output":
        name, signal = component.outputs.pop()
        component.outputs += [(name, f":Fine{signal[1:]}")] if chance.often(0.5) else []
    elif way == "said":
        shape = chance.one(role.shapes)
        for good, bad in zip(shape.good, shape.bad, strict=True):
            component.said = [
                bad.format(robot=chance.one(ROBOTS)) if said.startswith(good.split(" ")[0] + " ") else said
                for said in component.said
            ]
            component.said = [said for said in component.said if said]
    else:
        component.inputs.append(("more", chance.one((":S0", ":Rare"))))
