"""What a configuration diagram shows: components with their ports, and the connections between them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Part:
    """A component in a configuration: its name, the role it plays, the names of its ports, and how it fares.

    `failed` marks a component that raised FAIL and left; `fresh` one that has just taken its place.
    """

    name: str
    role: str = ""
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    failed: bool = False
    fresh: bool = False


@dataclass(frozen=True)
class Link:
    """A connection from an output of one component to an input of another, by their names."""

    source: str
    output: str
    sink: str
    input: str


@dataclass(frozen=True)
class Wiring:
    """A configuration: a title, the components and the links; a link that names an unknown port is a ValueError."""

    title: str
    parts: tuple[Part, ...]
    links: tuple[Link, ...] = ()

    def __post_init__(self) -> None:
        """Refuse names that are given twice and links that lead nowhere."""
        names = [part.name for part in self.parts]
        if len(set(names)) < len(names):
            raise ValueError(f"a component is named twice in {self.title!r}")
        outputs = {(part.name, port) for part in self.parts for port in part.outputs}
        inputs = {(part.name, port) for part in self.parts for port in part.inputs}
        for link in self.links:
            if (link.source, link.output) not in outputs or (link.sink, link.input) not in inputs:
                raise ValueError(f"{link} joins ports that the parts of {self.title!r} do not have")
