"""`join`: the living ecology, over Zenoh: what is alive, which tasks run, and tasks of one's own."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from selfconf import rendezvous, this_machine
from selfconf.api.arguments import (
    Endpoints,
    Paths,
    checked_flag,
    checked_moment,
    checked_path,
    checked_text,
    listed_endpoints,
)
from selfconf.api.ecology import Ecology
from selfconf.api.living.component_states import ComponentState, component_states, doubled, told_lives, unadvertised
from selfconf.api.living.component_terms import iri_or_local_name
from selfconf.api.living.configurators import Configurators, Told
from selfconf.api.living.echo import HeardSignal, echo
from selfconf.api.living.output_sources import check_output, follow_output
from selfconf.api.living.restarting import restarted
from selfconf.api.living.site_access import SiteAccess, site_accesses
from selfconf.api.living.site_logs import LogSource, logs_of_other_sites
from selfconf.api.membership import MEMBERS, Membership
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.api.tasks.living_task import LivingTask, RunningTasks
from selfconf.api.tasks.living_tasks import LivingTasks
from selfconf.api.tasks.released_components import STATE_PATIENCE, ReleasedComponents
from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Replies
from selfconf.deployment import holders_in
from selfconf.discovery import Discovery, EcologyView, FoundAdvertisement
from selfconf.errors import AuthorError, NetworkError, SelfconfError
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, task_name
from selfconf.protocol.messages import Status
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.sparql import Dataset
from selfconf.render import html_text

if TYPE_CHECKING:
    from selfconf.api.answer import Answer
    from selfconf.api.task import TaskSpecification
    from selfconf.api.tasks.run import Run
    from selfconf.model.refusal import Refusal, Undecided

PAUSES = (0.0, 0.1, 0.4)
"""Seconds before each call of the sites, until one answers: one that has just begun may not be known to its hub."""
_Found = TypeVar("_Found")


class LivingEcology(Ecology):
    """Everything that is alive under one name, as seen over the network; use it in a `with` statement.

    Several threads may ask it at the same time. A process that is forked from one that has joined cannot.

    >>> with join() as living:
    ...     for component in living.components:
    ...         print(component.short, living.state(component))
    clock dormant
    display dormant
    """

    def __init__(self, name: str, endpoints: Sequence[str], credentials: Credentials | None = None) -> None:
        """Connects, with keys by showing a certificate; raises NetworkError if no site of the ecology answers."""
        self.name, self.endpoints = name, tuple(endpoints)
        self._membership = Membership(name, self.endpoints, credentials)
        self._bus = self._membership.connect()
        suspended = partial(this_machine.suspended_sites, name)
        self._view = EcologyView(self._bus, name, self._membership.beliefs(), selects=True, suspended_sites=suspended)
        self.discovery = Discovery()
        """What the last look at the ecology has found: advertisements with site and source, sites, who is missing."""
        self._synchronous = SynchronousBus(
            self._bus, lives=self._view.keys.any_site_life(), check_own=self._membership.check_certificate
        )
        self._tasks = LivingTasks(self._synchronous, self._view.keys, self.endpoints)
        self._running = RunningTasks()
        """What was found when the configurators were last asked for their tasks."""
        self._released = ReleasedComponents(self._synchronous, self._view.keys)
        self._configurators = Configurators(self._synchronous, self._view.keys)
        try:
            with rendezvous.suspended_sites_named(self.endpoints):
                if not any(self._sites_answer(pause) for pause in PAUSES):
                    raise NetworkError(f"no site of the ecology {name!r} answers; is it the right name?")
            if credentials is not None:
                self._synchronous.attend()  # its certificate is looked at, also where nothing is asked for long
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> LivingEcology:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Leave the ecology; nothing that runs in it is touched. It can be asked nothing any more, nor run a task."""
        self._synchronous.leave()
        self._bus.close()

    def discover(self) -> Discovery:
        """Acts 1 and 2 of the paper: ask everything that is alive what it advertises.

        Raises NetworkError, also where the site is gone by which this program reaches the ecology: to be cut off looks
        like an ecology in which nothing lives.
        """
        found = self._synchronous.while_linked(
            lambda: self._synchronous.wait(self._view.discover), lambda discovery: bool(discovery.found)
        )
        self.discovery = replace(found, missing=self._view.silent_sites(found))
        suspended = {*self.discovery.missing} - {*found.missing}
        missing = (
            f"site {site} {'is suspended' if site in suspended else 'lives, but did not answer in full'};"
            " what it advertises may be missing"
            for site in self.discovery.missing
        )
        self._complaints = (*self.discovery.complaints, *missing)
        return self.discovery

    def advertisements(self) -> Mapping[IRI, Advertisement]:
        """All advertisements by component, as they are now."""
        return {component: found.advertisement for component, found in self.discover().found.items()}

    @property
    def missing_sites(self) -> tuple[str, ...]:
        """The sites that did not answer the last discovery in full, or are suspended on this machine; sorted."""
        return self.discovery.missing

    def holders(self) -> Mapping[IRI, Holder]:
        """The tasks that hold components, by component: of several that share one, the first in rank.

        Raises NetworkError, as `discover` does.
        """
        return holders_in(self._synchronous.ask(self._view.keys.configurator_call("*", "status")), self._view.keys)

    def state(self, component: str) -> str:
        """`alive`; `dormant` if its site can start it; `absent` if it is advertised, but no process runs it.

        As of the last discovery, which is made where there was none; what lives in a large ecology, as of the first
        question after it. What is no IRI is looked up as by `component`, which raises AuthorError.
        """
        one = component if isinstance(component, IRI) else self.component(component).advertisement.component
        found = self._last_discovery().found.get(one)
        if self._life(one) is not None:
            return "alive"
        return "dormant" if found is not None and found.startable else "absent"

    def component_states(self) -> tuple[ComponentState, ...]:
        """How each advertised component is: whether it lives, who holds it, where, since when; sorted by IRI.

        A component that lives and does not answer is named among the `complaints`, as is one that lives and no site
        advertises. A reader (`read.NAME`) learns from configurators alone which task holds it.
        """
        discovery = self.discover()
        asked = self._view.keys.any_call("state")
        # No component would hear the question of a reader.
        replies = Replies() if self._membership.looks_on_only else self._synchronous.ask(asked, seconds=STATE_PATIENCE)
        holders = self.holders() if self._membership.looks_on_only else {}
        found = []
        silent: list[str] = []
        told = told_lives(self._view.keys, replies)
        for one in component_states(discovery, told):
            if one.state != "alive" and self._life(one.component) is not None:
                held_by = holders.get(one.component)
                one = one._replace(state="alive", task=task_name(held_by.task) if held_by is not None else "")
                silent.append(f"{one.component} lives, but does not say how it is")
            found.append(one)
        if silent and self._membership.looks_on_only:
            silent = ["components do not tell readers how they are; that takes keys of conf.NAME"]
        self._complaints = (*self.complaints, *silent, *unadvertised(discovery, told), *doubled(told))
        return tuple(found)

    def out_of_control(self) -> Mapping[IRI, str]:
        """The components that were asked to stop and do not come to rest in time, sorted, and how each of them is.

        That takes some seconds where a component is stopping. A reader (`read.NAME`) sees none.
        """
        return {} if self._membership.looks_on_only else self._released.out_of_control()

    def _life(self, component: IRI) -> str | None:
        """The life of a component; those of a large ecology, which most readers do not need, are called now."""
        if not self._view.knows(component_chunk(component)):
            self._view.called(self._synchronous.living(self._view.keys.any_life()))
        return self._view.life(component)

    def component(self, term: str) -> FoundAdvertisement:
        """The advertised component that a term means: an IRI, with or without brackets, a CURIE, or its local name.

        Raises AuthorError where there is none, or where several have that name, and ProgrammerError for a term that is
        no text.
        """
        checked_text(term, "the name of a component")
        wanted = iri_or_local_name(term)
        known = self.discover().found
        found = [one for component, one in known.items() if wanted in (component, component.short)]
        if len(found) == 1:
            return found[0]
        if found:
            names = ", ".join(str(one.advertisement.component) for one in found)
            raise AuthorError(f"several components are called {term}: {names}")
        perhaps = "".join(f"; {complaint}" for complaint in self._complaints)  # it may be at a site that is silent
        raise AuthorError(f"no component {term} is advertised; `selfconf discover` shows those that are{perhaps}")

    def signals(
        self, component: str, output: str, complain: Callable[[str], None] | None = None
    ) -> Iterator[HeardSignal]:
        """What an output of a component issues, as it comes, without an end. Raises AuthorError for what is not there.

        `complain` hears of what is no signal, and of what is to be known before the first one: that the component is
        dormant, or acts for no task, so that none may come for long. Without it the latest of this is the only one of
        the `complaints`.
        """
        complain = self._complained if complain is None else complain
        if self._membership.looks_on_only:
            raise NetworkError("readers hear no signals; that takes keys of conf.NAME")
        found = self.component(component)
        profile = found.advertisement.profile
        check_output(profile, output)
        state = self.state(profile.component)
        if state != "alive":
            complain(f"{profile.component.short} is {state}: it says nothing before a task has it started")
        elif self._rests(profile.component):
            complain(f"{profile.component.short} acts for no task now, and says nothing before it does")
        return echo(self._synchronous, partial(follow_output, self._bus, self._view.keys, profile, output), complain)

    def _complained(self, sentence: str) -> None:
        self._complaints = (sentence,)

    def _rests(self, component: IRI) -> bool:
        """Whether a component that lives has answered, and acts for no task."""
        replies = self._synchronous.ask(self._view.keys.call(component, "state"), seconds=STATE_PATIENCE)
        lives = told_lives(self._view.keys, replies).get(component, ())
        return bool(lives) and not any(life.active for life in lives)

    def restart(self, component: str) -> ComponentState:
        """Have its site end the process of a component, and start it again; returns how it is once it lives again.

        The other components of the process end with it, and the tasks that hold one of them repair. Raises AuthorError
        for a component that is not there, and NetworkError for what its site cannot or does not do.
        """
        self._membership.check_may_run()
        found = self.component(component)
        life = self._life(found.advertisement.component)
        return restarted(self._synchronous, self._view.keys, found, life, self.component_states)

    def deployed(self) -> dict[str, dict[str, Any]]:
        """What each configurator has deployed, as JSON, by its name: roles, connections, parameters, bindings."""
        return self._told(self._configurators.deployed())

    @property
    def sites(self) -> tuple[str, ...]:
        """The sites that were found by the last discovery, which is made where there was none; sorted."""
        return self._last_discovery().sites

    def _last_discovery(self) -> Discovery:
        """The last discovery, or a first one; where no site was found, it is looked again."""
        return self.discovery if self.discovery.sites else self.discover()

    @property
    def tasks(self) -> tuple[Status, ...]:
        """What each configurator of the ecology says of the task that it runs, sorted by the configurator's name."""
        return self._noted(self._tasks.running(by_components=not self._membership.looks_on_only)).statuses

    def all_tasks(self) -> tuple[LivingTask, ...]:
        """The tasks that run and those that live in the sites, sorted by name."""
        running = self._noted(self._tasks.running(by_components=not self._membership.looks_on_only))
        return self._tasks.all(running)

    @property
    def silent(self) -> tuple[str, ...]:
        """The configurators that live or hold components, but did not answer when asked for their tasks, sorted."""
        return self._running.silent

    @property
    def suspended(self) -> tuple[str, ...]:
        """The names of tasks whose runs on this machine are suspended, so that they were not seen to run, sorted.

        One whose components are still held is known by its configurator, among the `silent`.
        """
        return tuple(task.name for task in self._running.suspended)

    def _noted(self, running: RunningTasks) -> RunningTasks:
        """Keep what configurators have said of their tasks, and what was wrong with it."""
        self._running, self._complaints = running, running.complaints
        return running

    def _told(self, told: Told[_Found]) -> _Found:
        """Return what configurators or sites have told, and keep the complaints."""
        found, self._complaints = told
        return found

    def access(self) -> tuple[SiteAccess, ...]:
        """Who may do what at the hub of each site that has keys, and what was refused there; sorted by site."""
        replies = self._synchronous.ask(self._view.keys.access())
        return self._told(site_accesses(replies, self.discover().found))

    def other_logs(self, known: Collection[str], complain: Callable[[str], None]) -> dict[str, LogSource]:
        """The logs of the sites that live, but for the known ones; `complain` hears once of each that is silent."""
        hint = "that takes keys of conf.NAME" if self._membership.looks_on_only else ""
        return logs_of_other_sites(self._synchronous, self._view.keys, known, complain, hint)

    def links_of(self, task: str) -> dict[IRI, tuple[IRI, ...]] | None:
        """The sources of each component of a deployed task, as its configurator says; None if none answers for it."""
        running = self._noted(self._tasks.running())
        names = {status.configurator for status in running.statuses if status.name == task}
        if not names:
            return None
        components = [one for status in running.statuses if status.configurator in names for one in status.components]
        links, complaints = self._configurators.links(names, components)
        self._complaints = (*running.complaints, *complaints)
        return links

    def dataset(self) -> Dataset:
        """The ecology as RDF: a named graph for each advertisement, and one for each deployed configuration."""
        dataset = super().dataset()
        documents, complaints = self._configurators.documents()
        for name, document in documents:
            dataset.add(IRI.unchecked(f"urn:selfconf:{self._view.keys.configuration(name)}"), document.triples())
        self._complaints = (*self.complaints, *complaints)
        return dataset

    def why(self, term: str, at: float | None = None) -> list[str]:
        """Why components play the roles that a term means, in sentences; at a moment, or now.

        The term is a role, a component, a value that a task is bound to, or a task: an IRI or its local name. A
        configurator remembers its latest events, and none of them when it has ended. Raises ProgrammerError for a term
        that is no text, and for what is no moment.
        """
        checked_text(term, "the term that is asked about")
        return self._told(self._configurators.why(term, checked_moment(at)))

    def configure(
        self,
        task: TaskSpecification,
        *,
        strategy: str = "first",
        reasoning: str = "syntactic",
        ontologies: Paths = (),
        steps: int | None = None,
        seconds: float | None = None,
        what_if: bool = False,
    ) -> Answer | Refusal | Undecided:
        """What `selfconf.configure` answers for this ecology, as it is now. Changes nothing."""
        from selfconf.api.configuring import configure  # here and below: who only looks on needs no search

        return configure(
            task,
            self,
            strategy=strategy,
            reasoning=reasoning,
            ontologies=ontologies,
            steps=steps,
            seconds=seconds,
            what_if=what_if,
        )

    def run(
        self,
        task: TaskSpecification,
        *,
        policy: str = "repair",
        wait: bool = False,
        strategy: str = "first",
        reasoning: str = "syntactic",
        ontologies: Paths = (),
        steps: int | None = None,
        seconds: float | None = None,
        name: str = "",
        priority: int | None = None,
        upgrade: float | None = None,
    ) -> Run:
        """A run of a task: configured, deployed, watched and configured again until it is left; use it in a `with`.

        `policy` says what to do with the rest when a component is lost, `repair` or `dismantle`; `wait` waits for the
        ecology to change where there is no configuration. A task of higher `priority` gets the components that one of
        lower priority holds; it is a whole number from -1,000,000 to 1,000,000, else ProgrammerError is raised.
        `upgrade` are the seconds, zero or more, after which a component that the strategy would rather have is changed
        to; without it, none is.
        """
        from selfconf.api.method import Method
        from selfconf.api.tasks.run import Run
        from selfconf.api.tasks.task_options import TaskOptions

        self._synchronous.check()
        method = Method.of(strategy, reasoning, ontologies, steps, seconds)
        options = TaskOptions.of(policy, name, priority, upgrade)
        return Run(task, method, self._membership, options, checked_flag(wait, "wait"))

    def detach(
        self,
        task: TaskSpecification,
        *,
        policy: str = "repair",
        strategy: str = "first",
        reasoning: str = "syntactic",
        ontologies: Paths = (),
        steps: int | None = None,
        seconds: float | None = None,
        name: str = "",
        priority: int | None = None,
        upgrade: float | None = None,
    ) -> str:
        """Hand a task to the sites of the ecology, one of which runs it until it is stopped; returns its name.

        The arguments are those of `run`; the task waits where there is no configuration. Raises NetworkError if no
        site keeps it, or if a task of that name lives.
        """
        from selfconf.api.method import Method
        from selfconf.api.task import completed
        from selfconf.api.tasks.detached import task_record
        from selfconf.api.tasks.task_options import TaskOptions

        self._membership.check_may_run()
        method = Method.of(strategy, reasoning, ontologies, steps, seconds)
        record = task_record(completed(task), method, TaskOptions.of(policy, name, priority, upgrade))
        return self._tasks.detach(record)

    def stop(self, name: str | None = None) -> tuple[str, ...]:
        """Take down a task, given by its name or that of its configurator, or all of them.

        The inside of a composite, which has the name of the composite, is meant only where no other task has that name.
        Returns the names of the tasks. Raises NetworkError if there is none of that name, if several insides alone have
        it, if one does not answer or does not end in time, or if a component does not obey; of all tasks those are
        taken down first that answer.
        """
        self._membership.check_may_run()
        if name is not None:
            checked_text(name, "the name of a task")
        names, running = self._tasks.stop(name)
        self._noted(running)
        return names

    def _sites_answer(self, pause: float) -> bool:
        """Whether any site of the ecology lives, as it is found after a pause in seconds."""
        self._bus.poll(pause)
        return bool(self._synchronous.living(self._view.keys.any_site_life()))

    def __repr__(self) -> str:
        return f"<living ecology {self.name}>"

    def _repr_html_(self) -> str:
        try:
            return super()._repr_html_()
        except SelfconfError as error:  # it was left, or cannot be heard: a notebook would show where that was raised
            return html_text(f"{self}: {error}")


def join(ecology: str | None = None, *, connect: Endpoints = (), keys: str | Path | None = None) -> LivingEcology:
    """The living ecology of a name; without one, the only one on this machine, or the one behind the endpoints.

    `connect` is an endpoint of a site, such as `tcp/127.0.0.1:7447`, or several; without them the sites on this
    machine. Joining reads; nothing changes before `run`. `keys` is a folder of keys; without it, that of the variable
    SELFCONF_KEYS, if there is one. Raises NetworkError, saying what to try, if there is no such ecology, or if it does
    not let in the holder of the keys, AuthorError for keys that are none, and ProgrammerError for what is no text.

    >>> with join() as living:
    ...     answer = living.configure(template("examples/clock/tell-the-time.ttl"))
    ...     answer["screen"], living.tasks
    ((<https://example.org/my-home#display>,), ())
    """
    if ecology is not None:
        checked_text(ecology, "the name of an ecology")
    shown = rendezvous.credentials(None if keys is None else checked_path(keys), *MEMBERS)
    return LivingEcology(*rendezvous.find(ecology, listed_endpoints(connect), shown), shown)
