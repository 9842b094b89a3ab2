"""A small ecology in memory for tests: sites, components and a configurator on a simulated network."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, ClassVar

from selfconf import files
from selfconf.api.reading import described_in
from selfconf.bus.memory import Faults, MemoryBus, Network
from selfconf.bus.port import Bus
from selfconf.composites import Composites
from selfconf.composition.composer import Composer
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment import RunRequest, TaskRunner
from selfconf.deployment.notices import AT_LEISURE
from selfconf.model.profile import Profile
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import RunEvent
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.tasks import TaskDocument, bindings, templates
from selfconf.rdf.turtle import document as turtle
from selfconf.sdk.component import Component, Signal
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.site import Shelf, Site

PREFIXES = """@prefix sc:  <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix sh:  <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix :    <https://example.org/peis-home#> .
"""

BOUND = (("robot", ":Astrid"), ("goal", "(AT BEDROOM)"))
"""The parameters of the paper's task."""
NAVIGATE = (
    PREFIXES
    + """
:navigate a sc:Template ;
    sc:parameter :robot, :goal ;
    sc:roles ( :sonar :encoder :position :control :drive ) .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:goal  a sc:Parameter ; sc:name "goal"  ; sh:datatype xsd:string .
:sonar a sc:Role ; sh:class rob:SonarArray ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:encoder a sc:Role ; sh:class rob:Encoder ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:position a sc:Role ; sh:class rob:PositionSensor ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:control a sc:Role ; sh:class rob:NavigationControl ; sc:feeds :drive ;
    sc:sets [ sc:parameterType rob:BehaviouralGoal ; sc:value :goal ] .
:drive a sc:Role ; sh:class rob:MotorDrive ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
"""
)

ADVERTISEMENTS = {
    "sonar": ":sonar-array a sc:Component, rob:SonarArray ; rob:support :Astrid ;"
    ' sc:hasOutput [ sc:name "ranges" ; sc:signalType rob:RangeScan ] .',
    "encoder": ":wheels a sc:Component, rob:Encoder ; rob:support :Astrid ;"
    ' sc:hasOutput [ sc:name "odometry" ; sc:signalType rob:Odometry2D ] .',
    "tracker": ":person-tracker a sc:Component, rob:PositionSensor ; rob:place :living-room ; sc:preference 10 ;"
    ' sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .',
    "odometry": ":absolute-odometry a sc:Component, rob:PositionSensor ;"
    ' sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .',
    "control": ":thinking-cap a sc:Component, rob:NavigationControl ;"
    ' sc:hasInput [ sc:name "sonar" ; sc:signalType rob:RangeScan ] ,'
    ' [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] , [ sc:name "localize" ; sc:signalType rob:Odometry2D ] ;'
    ' sc:hasOutput [ sc:name "set.velocity" ; sc:signalType rob:Velocity2D ] ;'
    ' sc:hasParameter [ sc:name "goal" ; sc:parameterType rob:BehaviouralGoal ] .',
    "drive": ":astrid-drive a sc:Component, rob:MotorDrive ; rob:support :Astrid ;"
    ' sc:hasInput [ sc:name "velocity" ; sc:signalType rob:Velocity2D ] .',
    "pippi": ":pippi-drive a sc:Component, rob:MotorDrive ; rob:support :Pippi ;"
    ' sc:hasInput [ sc:name "velocity" ; sc:signalType rob:Velocity2D ] .',
}


def iri(name: str) -> IRI:
    """A term of the tests' own namespace."""
    return IRI("https://example.org/peis-home#" + name)


def write_advertisements(folder: Path, *names: str, advertisements: Mapping[str, str] = ADVERTISEMENTS) -> Path:
    """The advertisements of those names (all of them by default), a file each."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or advertisements:
        (folder / f"{name}.ttl").write_text(PREFIXES + advertisements[name] + "\n")
    return folder


class Recorder(Component):
    """A component that writes down which of its methods were called."""

    def __init__(self) -> None:
        self.said: list[tuple[Any, ...]] = []
        self.served: Callable[[str, IRI], None] = lambda operation, caller: None
        """Hears which operation is called, and by which component."""
        self.refusal: Exception | None = None
        self.slow = 0.0
        """How many seconds `started` takes."""
        self.spend: Callable[[float], None] = lambda seconds: None
        """Lets that time pass for the code."""

    def started(self) -> None:
        self.said.append(("started",))
        if self.slow:
            self.spend(self.slow)
        if self.refusal is not None:
            raise self.refusal

    def stopped(self) -> None:
        self.said.append(("stopped",))

    def received(self, port: str, signal: Signal) -> None:
        self.said.append((port, signal.value))

    def parameter_set(self, name: str, value: Any) -> None:
        self.said.append((name, value))

    def called(self, operation: str, request: Signal) -> Any:
        self.served(operation, request.source)
        return "done"

    def ask(self, operation: str, seconds: float = 2.0) -> None:
        """Call an operation, and write down what comes of it, and of whom."""
        self.call(
            operation,
            answered=lambda answer: self.said.append((operation, answer.status.value, answer.source)),
            seconds=seconds,
        )


class StillShelf(Shelf):
    """The advertisements in files that stay as they are once they are written: nobody has to look at them again.

    Those that are `held_back`, by the names of their files, are not there yet, or were lost with a newer disk.
    """

    _written: ClassVar[dict[Path, str]] = {}
    """What lies in each file: histories by the hundred write the same."""

    def __init__(self, texts: Mapping[Path, str], held_back: Callable[[], frozenset[str]]) -> None:
        super().__init__([], lambda complaint: None)
        self._texts, self._is_held_back = texts, held_back
        self._known: frozenset[str] | None = None
        """What was held back when the files were read."""

    def refresh(self) -> bool:
        """Read the files, when that is asked for the first time; whether the advertisements are others now."""
        held_back = self._is_held_back()
        if held_back == self._known or not self._texts:
            return False
        self._known, self.advertisements = held_back, {}
        for path, text in sorted(self._texts.items()):
            if path.stem in held_back:
                continue
            if self._written.get(path) != text:
                path.write_text(text)
                self._written[path] = text
            self.advertisements |= {one.component: one for one in _advertisements(path, text)}
        return True


@lru_cache(maxsize=256)
def _advertisements(path: Path, text: str) -> tuple[Advertisement, ...]:
    """What a file advertises that has that text."""
    good, bad = files.advertisements(path)
    assert not bad
    return tuple(good)


@lru_cache(maxsize=256)
def _profile(text: str, name: str) -> Profile:
    (advertisement,), _ = advertisements.read_document(turtle.parse(PREFIXES + text, name))
    return advertisement.profile


@lru_cache(maxsize=64)
def task_of(template: str, bound: tuple[tuple[str, str], ...]) -> TaskDocument:
    """A template whose parameters are bound."""
    return bindings.complete(bindings.bind(templates.read_task(turtle.parse(template, "template.ttl")), bound))


def request_for(record: TaskRecord, template: str = NAVIGATE, bound: tuple[tuple[str, str], ...] = BOUND) -> RunRequest:
    """The request by which a site runs a task that it keeps; by default that is the paper's."""
    return replace(RunRequest.of(Composer(task_of(template, bound))), patient=True, priority=record.priority)


class Lab:
    """Two hosts and a configurator in simulated time; every component is a node of its own."""

    def __init__(
        self,
        folder: Path,
        seed: int = 0,
        faults: Faults | None = None,
        advertised: Mapping[str, str] = ADVERTISEMENTS,
        *,
        still: bool = False,
    ) -> None:
        """`still`: no file changes while the sites live, so that they read what is advertised once."""
        self._still, self._foresees = still, seed % 2 == 1
        self.network = Network(seed, faults)
        self.advertised = advertised
        self.folder = folder
        self.keys = Keys("lab")
        self.components: dict[str, Recorder] = {}
        self.runtimes: dict[str, ComponentRuntime] = {}
        self.complaints: list[str] = []
        self.sites: dict[str, Site] = {}
        self.composites: dict[str, Composites] = {}
        """Those of each site, as far as any of them live."""
        self.events: list[RunEvent] = []
        self.ended: list[Refusal | Undecided | None] = []
        self.held_back: dict[str, frozenset[str]] = {}
        """The advertisements that a site has not, as its disk is that of before, by the name of the site."""
        self.clock_steps: dict[str, float] = {}
        """By how many seconds the clock of a task was set since it began, by its name."""

    def site(self, name: str, *names: str) -> Site:
        """A site with those advertisements, and with whatever else lies in its folder already."""
        shelf = self._shelf(self.folder / name, names)
        node = self.network.node()
        composites = Composites(
            node, "lab", described_in, self.complaints.append, unable=lambda why: site.tell_unable(why)
        )
        site = Site(node, "lab", name, shelf, changed=composites.refresh)
        self.sites[name], self.composites[name] = site, composites
        return site

    def _shelf(self, folder: Path, names: Sequence[str]) -> Shelf:
        if not self._still:
            return Shelf([write_advertisements(folder, *names, advertisements=self.advertised)], self.complaints.append)
        folder.mkdir(parents=True, exist_ok=True)
        texts = {folder / f"{name}.ttl": PREFIXES + self.advertised[name] + "\n" for name in names}
        return StillShelf(texts, lambda: self.held_back.get(folder.name, frozenset()))

    def profile(self, name: str) -> Profile:
        """The profile in one of the advertisements."""
        return _profile(self.advertised[name], name)

    def component(self, name: str, recorder: Recorder | None = None) -> Recorder:
        """A living component with one of the advertisements."""
        recorder = recorder or Recorder()
        life = f"{name}{len(self.network.nodes)}"
        self.runtimes[name] = ComponentRuntime(self.network.node(), self.keys, self.profile(name), recorder, life)
        self.components[name] = recorder
        return recorder

    def navigation(self) -> None:
        """The paper's six components and Pippi's drive, at two sites."""
        self.site("living-room", "tracker")
        self.site("astrid", "sonar", "encoder", "odometry", "control", "drive", "pippi")
        for name in ADVERTISEMENTS:
            self.component(name)

    def agent(
        self,
        template: str = NAVIGATE,
        bound: tuple[tuple[str, str], ...] = BOUND,
        policy: Policy = Policy.REPAIR,
        patient: bool = False,
        clock: float = 0.0,
        **wishes: Any,
    ) -> TaskRunner:
        """A configurator that has begun with act 1; its clock is ahead by `clock` seconds.

        `wishes` are further fields of its `RunRequest`. Where the seed is odd, it finds out beforehand what to do if a
        component is lost.
        """
        wishes.setdefault("at_leisure", (lambda work: work()) if self._foresees else (lambda work: None))
        task = task_of(template, bound)
        order = replace(
            RunRequest.of(Composer(task)),
            policy=policy,
            patient=patient,
            report=self.events.append,
            ended=self.ended.append,
            **wishes,
        )
        agent = TaskRunner(
            self.network.node(clock),
            "lab",
            order,
            f"agent{len(self.network.nodes)}",
            lambda: self.network.time + clock + self.clock_steps.get(order.name, 0.0),
        )
        agent.start()
        return agent

    def repaired(self) -> TaskRunner:
        """The configurator of the paper's task after it has lost the tracker, and odometry has taken over."""
        self.navigation()
        agent = self.agent()
        self.running(agent)
        self.components["tracker"].fail("lost")
        self.let_pass(1.0)
        return agent

    def until(self, condition: Callable[[], bool], seconds: float = 30.0) -> bool:
        """Let simulated time pass until something holds; whether it does."""
        return self.network.run(condition, seconds)

    def running(self, agent: TaskRunner) -> bool:
        """Whether an agent's configuration is complete, after letting time pass."""
        running = self.until(lambda: agent.state.phase is Phase.RUNNING)
        self.until(lambda: False, 2 * AT_LEISURE)  # events are reported when there is time for it
        return running and agent.state.phase is Phase.RUNNING

    def node_of(self, name: str) -> MemoryBus:
        """The node of a component."""
        return _node(self.runtimes[name].bus)

    def crash(self, program: TaskRunner | Site | str) -> None:
        """End a configurator, a site, or the component of that name, as kill -9 does."""
        _node(self.runtimes[program].bus if isinstance(program, str) else program.bus).close()

    def is_open(self, program: TaskRunner | Site) -> bool:
        """Whether a program has not been ended."""
        return _node(program.bus).open

    def isolate(self, program: TaskRunner | Site | str) -> None:
        """Cut a program off from all others."""
        node = _node(self.runtimes[program].bus if isinstance(program, str) else program.bus)
        for other in self.network.nodes:
            if other is not node and self.network.reaches(node, other):
                self.network.cut(node, other)

    def rejoin(self, program: TaskRunner | Site | str) -> None:
        """Let a program reach all others again."""
        node = _node(self.runtimes[program].bus if isinstance(program, str) else program.bus)
        for other in self.network.nodes:
            if other is not node and not self.network.reaches(node, other):
                self.network.reconnect(node, other)

    def let_pass(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.network.let_pass(seconds)

    def active(self) -> set[str]:
        """The names of the components that act, crashed ones left out."""
        return {name for name, runtime in self.runtimes.items() if runtime.active and self.node_of(name).open}

    def acts(self, act: str) -> list[Any]:
        """The events of one kind."""
        return [event for event in self.events if event.act == act]


def _node(bus: Bus) -> MemoryBus:
    assert isinstance(bus, MemoryBus)
    return bus
