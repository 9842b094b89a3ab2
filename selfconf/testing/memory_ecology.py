"""An ecology in memory: a site, living components and tasks on a simulated network, in simulated time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

from selfconf import files, library
from selfconf.api.answer import Answer
from selfconf.api.arguments import Paths, checked_delay, checked_flag, checked_upgrade, listed_paths
from selfconf.api.configuring import refusal_with_places
from selfconf.api.document_texts import text_of
from selfconf.api.method import Method
from selfconf.api.ontologies import hierarchy_of, ontology_texts
from selfconf.api.reading import gathered
from selfconf.api.task import TaskSpecification, completed
from selfconf.api.tasks.run_outcomes import AnsweredEvent, answered, answered_event, composing, searched_ecology
from selfconf.api.tasks.task_options import TaskOptions
from selfconf.bus.memory import Faults, MemoryBus, Network
from selfconf.composites import Composites
from selfconf.composition import TimeLimit
from selfconf.configurator import Phase
from selfconf.deployment import RunRequest, TaskRunner
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import AnyRunEvent, TaskRefused, TaskWaiting
from selfconf.model.term import IRI
from selfconf.model.wording import counted
from selfconf.protocol.keys import Keys
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.turtle import Document, parse
from selfconf.sdk import Component, ComponentRuntime
from selfconf.site import Shelf, Site

ECOLOGY_NAME = "memory"
"""The name of every ecology in memory; no two of them meet."""
UNTIL_SECONDS = 60.0
"""Simulated seconds for which `until` waits, unless told otherwise."""
REPORT_LAG = 0.1
"""Simulated seconds that observers and releases may come after what they are about."""
Kind = TypeVar("Kind", bound=Component)


class _MemoryShelf(Shelf):
    """A shelf that is filled by hand."""

    def __init__(self) -> None:
        super().__init__((), lambda complaint: None)
        self._changed = False

    def put(self, advertisement: Advertisement) -> None:
        """Add an advertisement; the site looks again within a second."""
        self.advertisements[advertisement.component] = advertisement
        self._changed = True

    def refresh(self) -> bool:
        """Whether there is something new."""
        changed, self._changed = self._changed, False
        return changed


class MemoryRun:
    """A task that runs in an ecology in memory, and what has happened so far.

    >>> ecology = MemoryEcology()
    >>> for name in ("clock", "display"):
    ...     _ = ecology.add(Component(), f"examples/clock/{name}.ttl")
    >>> run = ecology.run(template("examples/clock/tell-the-time.ttl")).started()
    >>> run.running, run.events[-1].act
    (True, 'running')
    >>> run.stop()
    >>> run.ended, run.events[-1].act
    (True, 'stopped')
    """

    def __init__(
        self, ecology: MemoryEcology, task: TaskSpecification, method: Method, options: TaskOptions, wait: bool
    ) -> None:
        self._ecology, self._task, self._texts = ecology, task.document, task.texts
        self._events: list[AnsweredEvent] = []
        """What was reported so far: the runner reports a moment after an event, unless it is asked to."""
        self.refusal: Refusal | Undecided | None = None
        """Why the task has ended, where there is no configuration, explained as that of a `Run` is."""
        self.ended = False
        self._method = method
        self._explained: tuple[Refusal, Mapping[IRI, Advertisement], Refusal] | None = None
        """The refusal that was explained last, in which ecology, and its explanation."""
        self._composer = method.composer(task)
        request = replace(
            RunRequest.of(self._composer, composing(self._composer)),
            policy=options.policy,
            priority=options.priority_of(task),
            upgrade=checked_upgrade(options.upgrade),
            patient=wait,
            report=self._report,
            ended=self._ended,
        )
        network, node = ecology.network, ecology._another_node()
        self._runner = TaskRunner(node, ECOLOGY_NAME, request, f"c{len(network.nodes)}", lambda: network.time)
        self._runner.start()

    @property
    def events(self) -> list[AnsweredEvent]:
        """What has happened up to now, in order; the same values as those of `Run.events`."""
        self._runner.reports.tell()
        return self._events

    @property
    def phase(self) -> str:
        """Where the configurator is: `discovering`, `deploying`, `running`, `waiting`, ..."""
        return self._runner.state.phase_in_words

    @property
    def running(self) -> bool:
        """Whether a configuration is complete."""
        return self._runner.state.phase is Phase.RUNNING

    @property
    def configuration(self) -> Answer | None:
        """What is deployed, or being deployed."""
        return answered(self._runner.configuration, self._task)

    def started(self) -> MemoryRun:
        """The run once it is running. Raises ProgrammerError if it does not come to that.

        The error has the refusal, and what was lost on the way.
        """
        self._ecology.until(lambda: self.running or self.ended)
        self._ecology.advance(REPORT_LAG)
        if not self.running:
            waiting = (event.refusal for event in reversed(self.events) if isinstance(event, TaskWaiting))
            refusal = next(waiting, None) if self.refusal is None else self.refusal
            why = ", without a refusal" if refusal is None else f": {refusal}"
            lost = "".join(f"\n{one.short} was lost: {loss}" for one, loss in self._runner.losses.items())
            raise ProgrammerError(f"the task does not run; it is {self.phase}{why}{lost}")
        return self

    def stop(self) -> None:
        """Take the configuration down, and let the time pass that it takes."""
        self._runner.stop()
        self._ecology.until(lambda: self.ended)

    def __repr__(self) -> str:
        return f"<run of {self._task.template.iri.short}: {self.phase}>"

    def _explain(self, refusal: Refusal) -> Refusal:
        """A refusal with all that can be found out: no time passes in the ecology meanwhile."""
        ecology = searched_ecology(refusal)
        if self._explained is None or self._explained[:2] != (refusal, ecology):
            limit, described = TimeLimit(None), self._ecology.advertisements
            texts = (*self._texts, *self._ecology.texts)
            found = refusal_with_places(self._composer, ecology, refusal, self._method, limit, described, texts)
            self._explained = refusal, ecology, found
        return self._explained[2]

    def _report(self, event: AnyRunEvent) -> None:
        if isinstance(event, TaskWaiting | TaskRefused) and isinstance(event.refusal, Refusal):
            event = replace(event, refusal=self._explain(event.refusal))
        self._events.append(answered_event(event, self._task))

    def _ended(self, refusal: Refusal | Undecided | None) -> None:
        self.refusal, self.ended = self._explain(refusal) if isinstance(refusal, Refusal) else refusal, True


class MemoryEcology:
    """An ecology in memory: everything happens in the thread that lets time pass.

    >>> ecology = MemoryEcology()
    >>> clock = ecology.add(Component(), "examples/clock/clock.ttl")
    >>> display = ecology.add(Component(), "examples/clock/display.ttl")
    >>> run = ecology.run(template("examples/clock/tell-the-time.ttl")).started()
    >>> run.configuration["screen"]
    (<https://example.org/my-home#display>,)
    >>> ecology.crash(display)
    >>> ecology.until(lambda: run.ended), str(run.refusal.reasons[0])
    (True, 'no component is eligible for the role screen')
    """

    def __init__(
        self, seed: int = 0, faults: Faults | None = None, ontologies: Paths = (), reasoning: str = "syntactic"
    ) -> None:
        """`seed` decides the delays and losses of the network; without `faults` nothing is lost.

        By `ontologies`, files and folders, it is checked what components emit, as by those of selfconf; the
        insides of composites see them in the mode `reasoning`. Raises ProgrammerError for what is none of these.
        """
        if faults is not None and not isinstance(faults, Faults):
            raise ProgrammerError(f"the faults of a network are Faults(...), not {faults!r}")
        self._ontologies = files.ontology_files(map(Path, listed_paths(ontologies)))
        self.network = Network(seed, faults)
        self._shelf = _MemoryShelf()
        node = self.network.node()
        self._documents: dict[IRI, Document] = {}
        self.texts: list[str] = []
        """The texts of advertisements that are in no file, in which lines are looked up."""
        self.complaints: list[str] = []
        """Why composites do not live."""
        self._composites = Composites(
            node,
            ECOLOGY_NAME,
            lambda one: self._documents[one.component],
            self.complaints.append,
            hierarchy=hierarchy_of(Method.of(reasoning=reasoning).reasoning, ontology_texts(self._ontologies)),
            unable=lambda why: self._site.tell_unable(why),
        )
        self._site = Site(node, ECOLOGY_NAME, "site", self._shelf, changed=self._composites.refresh)
        self._runtimes: list[tuple[ComponentRuntime, MemoryBus]] = []
        """Each life with its node, also several of one component, of which the first acts."""
        self._isolated: list[MemoryBus] = []
        """The nodes that are cut off from every other one, also from those that come later."""

    @property
    def time(self) -> float:
        """Simulated seconds since the beginning."""
        return self.network.time

    @property
    def advertisements(self) -> Mapping[IRI, Advertisement]:
        """What is advertised, by component."""
        return self._shelf.advertisements

    def add(self, component: Kind, advertisement: str | Path | None = None) -> Kind:
        """Let a component live, on a node of its own; returns it.

        Its advertisement is the one of its class, or the one given: Turtle text or a file. Raises AuthorError for one
        that does not conform, and for a document with several components of which the class names none, and
        ProgrammerError for what is no component.
        """
        if not isinstance(component, Component):
            raise ProgrammerError(f"a component is an object of a class of selfconf.sdk.Component, not {component!r}")
        found = self._advertised(component, advertisement)
        self._shelf.put(found)
        bus = self._another_node()
        life = f"life{len(self.network.nodes)}"
        signals = {signal for port in found.profile.outputs for signal in port.signals}
        text = text_of(type(component).advertisement_path() if advertisement is None else advertisement)
        self.texts += text.in_no_file
        fields = files.signal_fields([*self._ontologies, *library.ontologies()], signals, [text]) if signals else {}
        runtime = ComponentRuntime(bus, Keys(ECOLOGY_NAME), found.profile, component, life, fields=fields)
        self._runtimes.append((runtime, bus))
        return component

    def advertise(self, advertisement: str | Path) -> IRI:
        """Advertise a component that no process runs; returns its IRI."""
        found, text = _advertisement(None, advertisement), text_of(advertisement)
        self.texts += text.in_no_file
        if found.profile.inside is not None:
            self._documents[found.component] = parse(*text)
        self._shelf.put(found)
        return found.component

    def run(
        self,
        task: TaskSpecification,
        *,
        policy: str = "repair",
        wait: bool = False,
        strategy: str = "first",
        reasoning: str = "syntactic",
        priority: int | None = None,
        upgrade: float | None = None,
    ) -> MemoryRun:
        """Begin to run a task; `started()` of the result lets time pass until it runs.

        Its roles see the ontologies of selfconf and those of the ecology in the mode `reasoning`. `priority` and
        `upgrade` are as those of a run in the living ecology. Raises BindingError, and ProgrammerError for a task, word
        or number that is none.
        """
        complete, options = completed(task), TaskOptions.of(policy, "", priority, upgrade)
        method = Method.of(strategy, reasoning, self._ontologies)
        self.advance(1.5)  # the site looks at its shelf once a second
        return MemoryRun(self, complete, method, options, checked_flag(wait, "wait"))

    def crash(self, component: Component) -> None:
        """End the process of a component as kill -9 does: it says nothing any more."""
        self._node(component).close()

    def isolate(self, component: Component) -> None:
        """Cut a component off from every other program, also from one that begins later."""
        node = self._node(component)
        if node not in self._isolated:
            self._isolated.append(node)
        for other in self.network.nodes:
            if other is not node:
                self.network.cut(node, other)

    def rejoin(self, component: Component) -> None:
        """Let a component reach every other program again, but for those that are isolated themselves."""
        node = self._node(component)
        if node in self._isolated:
            self._isolated.remove(node)
        for other in self.network.nodes:
            if other is not node and other not in self._isolated:
                self.network.reconnect(node, other)

    def advance(self, seconds: float) -> None:
        """Let simulated time pass. Raises ProgrammerError for what is no number of seconds, from zero on."""
        self.network.run(lambda: False, checked_delay(seconds))

    def until(self, condition: Callable[[], bool], seconds: float = UNTIL_SECONDS) -> bool:
        """Let simulated time pass until something holds, or that many seconds are over; returns whether it holds.

        Raises ProgrammerError for what is no number of seconds, from zero on.
        """
        return self.network.run(condition, checked_delay(seconds))

    def __repr__(self) -> str:
        return f"<ecology in memory of {counted(len(self.advertisements), 'component')} after {self.time:.1f} s>"

    def _advertised(self, component: Component, advertisement: str | Path | None) -> Advertisement:
        """What is advertised of a component that is to live."""
        return _advertisement(component, advertisement)

    def _another_node(self) -> MemoryBus:
        """A node for another program, which no isolated component reaches."""
        node = self.network.node()
        for isolated in self._isolated:
            self.network.cut(isolated, node)
        return node

    def _node(self, component: Component) -> MemoryBus:
        for runtime, bus in reversed(self._runtimes):  # one that was added again begins another life
            if runtime.component is component:
                return bus
        raise ProgrammerError(f"{component!r} does not live in this ecology; add it first")


def _advertisement(component: Component | None, given: str | Path | None) -> Advertisement:
    """The advertisement of a component class, or the one in a document that is given."""
    if component is None or given is not None:
        index, left_out = gathered([text_of(given)])
        found, wrong = list(index.values()), [str(one) for one in left_out]
    else:
        good, bad = files.advertisements(type(component).advertisement_path())
        found, wrong = good, [f"{one.component}: {one.problems[0]}" for one in bad]
    name = "" if component is None else type(component).component
    wanted = [one for one in found if not name or one.component == name]
    if wrong:
        raise AuthorError(wrong[0])
    if len(wanted) != 1:
        raise AuthorError(f"one advertisement is needed, and there are {len(wanted)}; name one by `component`")
    return wanted[0]
