"""`configure`: the answer to a task in an ecology, explained where there is none."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, fields, replace
from pathlib import Path

from selfconf.api.arguments import Paths, checked_flag, listed_paths, option, seconds_limit, steps_limit
from selfconf.api.collector import collector_at_rest, collector_looking_at_new
from selfconf.api.ecology import Ecology, LoadedEcology
from selfconf.api.ontologies import hierarchy_of, ontology_texts
from selfconf.api.places import Places, with_lines
from selfconf.api.reading import Text, described_in
from selfconf.api.task import TaskSpecification, completed
from selfconf.composition import Composer, Inside, Strategy, TimeLimit, composed, explained, insides
from selfconf.errors import ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.holder import Holder
from selfconf.model.immutable import FrozenMapping, immutable
from selfconf.model.left_out import LeftOut
from selfconf.model.literal_values import number
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Partition
from selfconf.model.profile import Place, Profile
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.sharing import agreed
from selfconf.model.template import Role
from selfconf.model.term import IRI
from selfconf.model.wording import plain
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.provenance import configuration_iri, configuration_triples
from selfconf.rdf.tasks import TaskDocument
from selfconf.rdf.turtle import Document, to_turtle
from selfconf.render import (
    Names,
    configuration_text,
    consequences_text,
    cost_text,
    diagram,
    html_sections,
    html_text,
    mermaid,
    refusal_text,
)

EXPLAINING = 2.0
"""For how many seconds at most a refusal is explained to a task that waits, which may soon come to another one."""


@immutable
class Method:
    """How a task is composed: the strategy, what the roles see, and how long the search may take."""

    strategy: Strategy = Strategy.FIRST
    reasoning: Reasoning = Reasoning.SYNTACTIC
    ontologies: tuple[Text, ...] = ()
    """What is in the ontologies: the files may change or go, and standard input can be read once."""
    steps: int | None = None
    seconds: float | None = None

    @classmethod
    def of(
        cls,
        strategy: str = "first",
        reasoning: str = "syntactic",
        ontologies: Paths = (),
        steps: int | None = None,
        seconds: float | None = None,
    ) -> Method:
        """A method by the words of the command line. Raises ProgrammerError for what is none.

        The limits, if there are any, are numbers above zero. Raises AuthorError for ontologies that are not there.
        """
        chosen, mode = option(Strategy, "strategy", strategy), option(Reasoning, "reasoning", reasoning)
        limits = steps_limit(steps), seconds_limit(seconds)
        return cls(chosen, mode, ontology_texts(map(Path, listed_paths(ontologies))), *limits)

    def composer(self, task: TaskSpecification) -> Composer:
        """The composer of a task, which has to be complete."""
        hierarchy = hierarchy_of(self.reasoning, self.ontologies)
        return Composer(task.document, hierarchy, self.strategy, self.steps)

    def explaining(self) -> TimeLimit:
        """The time in which a refusal is explained to a task that waits."""
        return TimeLimit(min(EXPLAINING, self.seconds or EXPLAINING))

    def wider(self) -> Hierarchy | None:
        """The hierarchy of the mode `subclass`, for explanations, where the method sees none; else None."""
        return hierarchy_of(Reasoning.SUBCLASS, self.ontologies) if self.reasoning is Reasoning.SYNTACTIC else None


@immutable
class Answer(Configuration, Mapping[str, tuple[IRI, ...]]):
    """A configuration as the library answers with it: also what it costs, and what would replace what.

    It is a mapping: `answer["position"]` are the components of a role, by its local name, CURIE or IRI, and
    `dict(answer)` are those of all roles by their local names.
    """

    task: TaskDocument = field(kw_only=True, repr=False, compare=False)
    optimum: Optimum | None = field(default=None, kw_only=True, repr=False, compare=False)
    """The cost with its proof, where the strategy is `best` and the template states a cost."""
    unknown: tuple[IRI, ...] = field(default=(), kw_only=True, repr=False, compare=False)
    """The properties of the cost for which no component of the ecology has a number."""
    what_if: tuple[Consequence, ...] | None = field(default=None, kw_only=True, repr=False, compare=False)
    """What would replace each component if it failed, where that was asked for and there was time."""
    left_out: tuple[LeftOut, ...] = field(default=(), kw_only=True, repr=False, compare=False)
    """The components that count for nothing, as what they say cannot be judged, or not in time."""

    @classmethod
    def of(
        cls,
        configuration: Configuration,
        task: TaskDocument,
        optimum: Optimum | None = None,
        unknown: tuple[IRI, ...] = (),
        what_if: tuple[Consequence, ...] | None = None,
        left_out: tuple[LeftOut, ...] = (),
    ) -> Answer:
        """A configuration of a task as an answer to it."""
        facts = {one.name: getattr(configuration, one.name) for one in fields(Configuration)}
        return cls(**facts, task=task, optimum=optimum, unknown=unknown, what_if=what_if, left_out=left_out)

    def __post_init__(self) -> None:
        object.__setattr__(self, "bindings", FrozenMapping(self.bindings))

    @property
    def names(self) -> Names:
        """Shortens IRIs by the prefixes of the template's document."""
        return Names(self.task.document.prefixes)

    @property
    def roles(self) -> tuple[IRI, ...]:
        """The roles, in the order of the template."""
        return tuple(assignment.role for assignment in self.assignments)

    def __iter__(self) -> Iterator[str]:
        """The roles by their local names, as a dictionary gives its keys."""
        return (role.short for role in self.roles)

    def __len__(self) -> int:
        return len(self.assignments)

    def __contains__(self, role: object) -> bool:
        return any(role in (one, one.short, self.names(one)) for one in self.roles)

    def __getitem__(self, role: str) -> tuple[IRI, ...]:
        for assignment in self.assignments:
            if role in (assignment.role, assignment.role.short, self.names(assignment.role)):
                return assignment.components
        known = ", ".join(assignment.role.short for assignment in self.assignments)
        raise KeyError(f"there is no role {role!r}; the roles are {known}")

    @property
    def plain(self) -> Configuration:
        """The configuration by itself."""
        return Configuration(
            self.template, self.assignments, self.connections, self.settings, dict(self.bindings), self.recruits
        )

    def to_turtle(self) -> str:
        """The configuration in RDF, as Turtle."""
        plain = self.plain
        triples = configuration_triples(plain, configuration_iri(plain, 0), self.task.task)
        return to_turtle(triples, self.task.document.prefixes).rstrip()

    def to_mermaid(self) -> str:
        """The configuration as a Mermaid flow chart."""
        return mermaid(self, self.names)

    def __str__(self) -> str:
        parts = [configuration_text(self, self.names)]
        if self.optimum is not None:
            parts.append(cost_text(self.optimum, self.unknown, self.names))
        if self.what_if is not None:
            parts.append(consequences_text(self.what_if, self.names))
        return "\n".join(parts)

    def __repr__(self) -> str:
        return plain(f"<{self}>")

    def _repr_html_(self) -> str:
        sections = {f"configured {self.names(self.template)}": diagram(self, self.names)}
        return html_sections(sections) + html_text(plain(str(self)))


@immutable
class ExplainedRefusal(Refusal):
    """A refusal as the library answers with it: it prints on one screen, with the place of each fact."""

    task: TaskDocument = field(kw_only=True, repr=False, compare=False)

    @classmethod
    def of(cls, refusal: Refusal, task: TaskDocument) -> ExplainedRefusal:
        """A refusal of a task with the prefixes of its document."""
        return cls(**{one.name: getattr(refusal, one.name) for one in fields(Refusal)}, task=task)

    @property
    def names(self) -> Names:
        """Shortens IRIs by the prefixes of the template's document."""
        return Names(self.task.document.prefixes)

    def __str__(self) -> str:
        return refusal_text(self, self.names)

    def __repr__(self) -> str:
        return plain(f"<{self}>")

    def _repr_html_(self) -> str:
        return html_text(plain(str(self)))


class Inquiry:
    """One question, answered: a task in an ecology by a method, with the figures of how it was answered."""

    def __init__(self, task: TaskSpecification, ecology: Ecology, method: Method) -> None:
        """Reads what the task may want of the ecology. Raises AuthorError, ProgrammerError and NetworkError."""
        self.task, self.method = completed(task), method
        if not isinstance(ecology, Ecology):
            raise ProgrammerError(
                f"an ecology is what selfconf.read() or selfconf.join() gives, not {type(ecology).__name__}"
            )
        self._texts = (self.task.text, *ecology.texts)
        self.seconds: dict[str, float] = {}
        """How long each part took: load, partition, search."""
        began = time.perf_counter()
        self.composer = method.composer(self.task)
        partitioner = self.composer.partitioner
        wider = (method.wider() if ecology.remote else None) or partitioner.hierarchy
        self.ecology, not_read = ecology.for_task(partitioner, wider)
        priority = self.task.document.task.priority
        held = {c: holder for c, holder in ecology.holders().items() if holder.priority >= priority}
        self._sharers = {c: held[c] for c in held if c in self.ecology and self.ecology[c].profile.is_shareable}
        self.holders = {c: holder for c, holder in held.items() if c not in self._sharers}
        """Who holds components that this task cannot have: tasks of the same or a higher priority.

        Those that can be shared count from when an answer would want something else of them than their holders.
        """
        self.seconds["load"] = ecology.read_seconds + time.perf_counter() - began
        began = time.perf_counter()
        with collector_at_rest():
            partition = self.composer.partition(self.ecology)
            if isinstance(ecology, LoadedEcology):
                partition, not_read = self._without_never_acting(partition, not_read)
        self.seconds["partition"] = time.perf_counter() - began
        self.eligible: Mapping[str, int] = {
            str(role.iri): len(candidates)
            for role, candidates in zip(self.task.roles, partition.candidates, strict=True)
        }
        """How many components are eligible for each role."""
        not_judged = sorted(self.composer.not_judged().items())
        left_out = (
            *not_read,
            *(LeftOut(self._place(component), component, why.reason) for component, why in not_judged),
        )
        self.left_out: tuple[LeftOut, ...] = tuple(with_lines(left_out, ecology.texts)) if left_out else ()
        """The components that play no role, or feed nothing, as what they say cannot be judged, or not in time."""

    def holder(self, role: Role, profile: Profile) -> Holder | None:
        """Who holds a component so that it cannot play a role; what its inputs would follow is not known beforehand."""
        sharer = self._sharers.get(profile.component)
        if sharer is None:
            return self.holders.get(profile.component)
        bindings, hierarchy = self.task.document.task.bindings, self.composer.hierarchy
        values = {
            (parameter.name, bindings.get(wanted, wanted) if isinstance(wanted, IRI) else wanted)
            for setting in role.settings
            for wanted in (setting.value,)
            for parameter in profile.parameters
            if hierarchy.matches(setting.type, parameter.type)
        }
        return None if sharer.wants.values == values else sharer

    def _without_never_acting(
        self, partition: Partition, left_out: tuple[LeftOut, ...]
    ) -> tuple[Partition, tuple[LeftOut, ...]]:
        """The partition of the ecology without composites that can never act, and what is left out, with these."""
        never = tuple(self._never_acting(partition))
        if never:
            left = {one.component for one in never}
            self.ecology = {one: a for one, a in self.ecology.items() if one not in left}
            partition = self.composer.partition(self.ecology)
        return partition, (*left_out, *never)

    def _never_acting(self, partition: Partition) -> Iterator[LeftOut]:
        """The composites that might play but can be nothing inside, whatever is advertised beside them, as at a site.

        Where the document that says what is inside is not at hand, as of a text, nothing is known of that.
        """
        documents: dict[str, Document | None] = {}
        eligible = {candidate.profile.component for some in partition.candidates for candidate in some}
        for component in sorted(eligible.union(one.component for one in partition.recruits)):
            advertisement = self.ecology[component]
            if advertisement.profile.inside is None:
                continue
            source = self._place(component).source
            if source not in documents:  # one file may advertise many
                with suppress(SelfconfError):
                    documents[source] = described_in(advertisement)
            document = documents.setdefault(source, None)
            if document is None:
                continue
            try:
                Inside.of(advertisement.profile, document, self.composer.hierarchy)
            except SelfconfError as error:
                yield LeftOut(self._place(component), component, str(error))

    def _place(self, component: IRI) -> Place:
        """Where a component is described."""
        return self.ecology[component].place or Place("the ecology")

    def insides(self, answer: Answer) -> list[tuple[IRI, Configuration | str]]:
        """What the composites of an answer would be inside, if their sites had this ecology, or why that is nothing.

        Composites inside of these follow each after the one that holds it.
        """
        if not any(self.ecology[component].profile.inside for component in answer.components):
            return []
        return list(insides(self.ecology, described_in, answer.plain, self.composer.hierarchy))

    def answer(self, what_if: bool = False) -> Answer | Refusal | Undecided:
        """The configuration, or why there is none, within the time of the method."""
        limit = TimeLimit(self.method.seconds)
        began = time.perf_counter()
        with collector_looking_at_new(len(self.ecology)):
            found = self._composed(limit)
        self.seconds["search"] = time.perf_counter() - began
        if isinstance(found, Undecided):
            return replace(found, left_out=self.left_out)
        if isinstance(found, Refusal):
            free = {c: one for c, one in self.ecology.items() if c not in self.holders}
            usable = self.composer.usable(self.holders.keys(), found)
            found = replace(found.told_of_held(usable), held=self._held(usable, limit), left_out=self.left_out)
            able = free if self.holders else self.ecology
            return refusal_with_places(self.composer, able, found, self.method, limit, texts=self._texts)
        optimum = found if isinstance(found, Optimum) else None
        plain = found.configuration if isinstance(found, Optimum) else found
        consequences = limit.within(lambda: self.composer.what_if(self.ecology, plain), None) if what_if else None
        return Answer.of(
            plain,
            self.task.document,
            optimum,
            unknown=() if optimum is None else self._unknown(optimum),
            what_if=None if consequences is None else tuple(consequences),
            left_out=self.left_out,
        )

    def _composed(self, limit: TimeLimit) -> Optimum | Outcome:
        """What is found among the components that this task can have."""
        held = frozenset(self.holders)
        found, taken = agreed(
            lambda left_out: composed(self.composer, self.ecology, held | left_out, None, limit),
            self._sharers,
            lambda one: one.configuration if isinstance(one, Optimum) else one,
        )
        self.holders |= taken
        self._sharers = {component: one for component, one in self._sharers.items() if component not in taken}
        return found

    def _held(self, usable: Collection[IRI], limit: TimeLimit) -> tuple[tuple[IRI, Holder], ...]:
        """The usable components of other tasks, if there would be a configuration with them."""
        if not self.holders:
            return ()
        found = composed(self.composer, self.ecology, frozenset(), None, limit)
        wanted = found.configuration if isinstance(found, Optimum) else found
        if not isinstance(wanted, Configuration):
            return ()
        named = usable or self.holders.keys() & set(wanted.components)
        return tuple((component, self.holders[component]) for component in sorted(named))

    def _unknown(self, optimum: Optimum) -> tuple[IRI, ...]:
        """The properties of unknown terms that no component in the ecology has a number for."""
        wanted = {one for _, one in optimum.missing}
        for advertisement in self.ecology.values():
            for predicate, value in advertisement.profile.properties:
                if number(value) is not None:
                    wanted -= self.composer.hierarchy.superproperties(predicate)
            if not wanted:
                break
        return tuple(sorted(wanted))


def refusal_with_places(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    refusal: Refusal,
    method: Method,
    limit: TimeLimit,
    described: Mapping[IRI, Advertisement] | None = None,
    texts: Sequence[str | None] = (),
) -> Refusal:
    """A refusal with all that the time allows to find out, and the place of each of its facts.

    `described` are the advertisements as files of this machine have them, where the ecology's come from elsewhere;
    `texts` are those that the task and the ecology were read from and that are in no file.
    """
    refusal = explained(composer, ecology, refusal, method.wider(), limit)
    placed = Places(composer.task.task.template, ecology if described is None else described, texts).placed(refusal)
    return ExplainedRefusal.of(placed, composer.task)


def configure(
    task: TaskSpecification,
    ecology: Ecology,
    *,
    strategy: str = "first",
    reasoning: str = "syntactic",
    ontologies: Paths = (),
    steps: int | None = None,
    seconds: float | None = None,
    what_if: bool = False,
) -> Answer | Refusal | Undecided:
    """The configuration of a task in an ecology, which is true; or a refusal, or that it is not decided: both false.

    `strategy` is `first`, `best` or `paper`, `reasoning` is `syntactic`, `subclass` or `owl-rl`, as on the command
    line. `steps` and `seconds` limit the search; `seconds` holds in the main thread. `what_if` also tells what would
    replace each component.

    Raises BindingError where a parameter needs a value, TemplateError for a shape that cannot be judged, NetworkError,
    and ProgrammerError for arguments of another kind.

    >>> answer = configure(template("examples/clock/tell-the-time.ttl"), read("examples/clock"))
    >>> answer["screen"]
    (<https://example.org/my-home#display>,)
    """
    method = Method.of(strategy, reasoning, ontologies, steps, seconds)
    checked_flag(what_if, "what_if")
    return Inquiry(task, ecology, method).answer(what_if)
