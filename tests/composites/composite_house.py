"""A house with a composite that finds positions, from components inside that tests can let fail."""

from __future__ import annotations

from typing import Any

from selfconf.api.task import template
from selfconf.model.run_event import ComponentLost
from selfconf.model.term import IRI
from selfconf.sdk import Component, Signal
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import MemoryRun

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:c:> .
"""
LOCALISE = """
:localise a sc:Template ; sc:parameter :robot ; sc:roles ( :eye :tracker ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :tracker ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker ; sh:property [ sh:path :sees ; sh:in ( :robot ) ] .
:tracker a sc:Role ; sh:class :Tracker .
"""
PORTS = """
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;"""
SERVICE = f"""{PREFIXES}
:service a sc:Component, :Positions ; {PORTS}
    sc:grounding [ sc:template :localise ; sc:binding [ sc:parameter :robot ; sc:value :Astrid ] ] .
{LOCALISE}"""
CAMERA = f"""{PREFIXES}
:NAME a sc:Component, :Camera ; :sees :Astrid ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] ."""
TRACKER = f"""{PREFIXES}
:NAME a sc:Component, :Tracker ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasInput [ sc:name "image" ; sc:signalType :Image ] , [ sc:name "hint" ; sc:signalType :Hint ] ."""
HINTER = f'{PREFIXES}:NAME a sc:Component, :Hinter ; sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] .'
NAVIGATOR = f'{PREFIXES}:nav a sc:Component, :Nav ; sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ] .'
TASK = f"""{PREFIXES}
:task a sc:Template ; sc:roles ( :hints :positions :navigator ) .
:hints a sc:Role ; sh:class :Hinter ; sc:feeds :positions .
:positions a sc:Role ; sh:class :Positions ; sc:feeds :navigator .
:navigator a sc:Role ; sh:class :Nav ."""
SERVED = IRI("urn:c:service")


class Source(Component):
    """Issues its name on one output, ten times a second."""

    def __init__(self, name: str, port: str) -> None:
        self.name, self.port = name, port

    def started(self) -> None:
        self.every(0.1, lambda: self.emit(self.port, self.name))


class Tracker(Component):
    """Issues its name, and what it heard last on its inputs."""

    mute = False

    def __init__(self, name: str) -> None:
        self.name, self.heard = name, {"image": "", "hint": ""}

    def received(self, port: str, signal: Signal) -> None:
        self.heard[port] = signal.value
        if not self.mute:
            self.emit("pose", [self.name, self.heard["image"], self.heard["hint"]])


class Navigator(Component):
    """Keeps the last pose, and who issued it."""

    pose: Any = None
    source = ""

    def received(self, port: str, signal: Signal) -> None:
        self.pose, self.source = signal.value, signal.source.short


class House:
    """An ecology in memory with a composite, what may be inside of it, and a task that needs it."""

    def __init__(
        self,
        *,
        cameras: str = "c1 c2",
        trackers: str = "t1 t2",
        hinters: str = "h1 h2",
        tracker: str = TRACKER,
        navigator: str = NAVIGATOR,
    ) -> None:
        self.ecology = MemoryEcology()
        self.by_name: dict[str, Component] = {}
        for names, kind, text in ((cameras, "image", CAMERA), (hinters, "hint", HINTER)):
            for name in names.split():
                self.by_name[name] = self.ecology.add(Source(name, kind), text.replace("NAME", name))
        for name in trackers.split():
            self.by_name[name] = self.ecology.add(Tracker(name), tracker.replace("NAME", name))
        self.navigator = self.ecology.add(Navigator(), navigator)

    def run(self, *composites: str, task: str = TASK) -> MemoryRun:
        """Run the task with some composites."""
        for text in composites:
            self.ecology.advertise(text)
        self.ecology.advance(2.0)
        run = self.ecology.run(template(task)).started()
        self.ecology.advance(1.0)
        return run

    def crash(self, name: str) -> None:
        """Let a component die, and what follows happen."""
        self.ecology.crash(self.by_name.pop(name))
        self.ecology.advance(3.0)

    def acting(self) -> set[str]:
        """Which components act, of those that have not crashed."""
        return {name for name, component in self.by_name.items() if component.active}


def lost(run: MemoryRun) -> list[IRI]:
    """The components that a task has lost."""
    return [event.component for event in run.events if isinstance(event, ComponentLost)]
