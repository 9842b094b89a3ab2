"""`configure`: the answer to a task in an ecology, explained where there is none."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress

from selfconf.api.answer import Answer, ExplainedRefusal
from selfconf.api.arguments import Paths, checked_flag
from selfconf.api.ecology import Ecology, LoadedEcology
from selfconf.api.garbage_collection import collector_at_rest, collector_looking_at_new
from selfconf.api.method import Method
from selfconf.api.places import Places, with_lines
from selfconf.api.reading import described_in
from selfconf.api.task import TaskSpecification, completed
from selfconf.composition import Composer, Inside, TimeLimit, composed, explained, insides
from selfconf.errors import ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.left_out import LeftOut
from selfconf.model.literal_values import number
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import Partition
from selfconf.model.profile import Place, Profile
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.sharing import agreed
from selfconf.model.template import Role
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.tasks import InsideReader, free_parameters
from selfconf.rdf.turtle import Document


class Inquiry:
    """One question, answered: a task in an ecology by a method, with the figures of how it was answered."""

    def __init__(self, task: TaskSpecification, ecology: Ecology, method: Method) -> None:
        """Reads what the task may want of the ecology. Raises AuthorError, ProgrammerError and NetworkError."""
        self.task, self.method = completed(task), method
        if not isinstance(ecology, Ecology):
            raise ProgrammerError(
                f"an ecology is what selfconf.read() or selfconf.join() gives, not {type(ecology).__name__}"
            )
        self._texts = (*self.task.texts, *ecology.texts)
        self.seconds: dict[str, float] = {}
        """How long each part took: load, partition, search."""
        self._limit = TimeLimit(None)
        """The time for the answer and for what is found out about it."""
        began = time.perf_counter()
        self.composer = method.composer(self.task)
        partitioner = self.composer.partitioner
        wider = (method.wider() if ecology.remote else None) or partitioner.hierarchy
        self.ecology, not_read = ecology.for_task(partitioner, wider)
        self._missing_sites = ecology.missing_sites
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
        """Who holds a component so that it cannot play a role; what its inputs would follow is not known beforehand.

        Nor is the value of a parameter that is left free.
        """
        sharer = self._sharers.get(profile.component)
        if sharer is None:
            return self.holders.get(profile.component)
        task = self.task.document.task
        free = free_parameters(task.template, task.bindings)
        found = ((one.name, role.setting_of(one, self.composer.hierarchy)) for one in profile.parameters)
        values = {
            name: task.bindings.get(setting.value, setting.value) if isinstance(setting.value, IRI) else setting.value
            for name, setting in found
            if setting is not None
        }
        known = dict(sharer.wants.values)
        agree = known.keys() == values.keys() and all(values[one] in (*free, known[one]) for one in known)
        return None if agree else sharer

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
        readers: dict[str, InsideReader | None] = {}
        eligible = {candidate.profile.component for some in partition.candidates for candidate in some}
        for component in sorted(eligible.union(one.component for one in partition.recruits)):
            advertisement = self.ecology[component]
            if advertisement.profile.inside is None:
                continue
            source = self._place(component).source
            if source not in readers:  # one file may advertise many
                with suppress(SelfconfError):
                    readers[source] = InsideReader(described_in(advertisement))
            reader = readers.setdefault(source, None)
            if reader is None:
                continue
            try:
                Inside.of(advertisement.profile, reader, self.composer.hierarchy)
            except SelfconfError as error:
                yield LeftOut(self._place(component), component, str(error))

    def _place(self, component: IRI) -> Place:
        """Where a component is described."""
        return self.ecology[component].place or Place("the ecology")

    def insides(self, answer: Answer) -> list[tuple[IRI, Configuration | Undecided | str]]:
        """What the composites of an answer would be inside, if their sites had this ecology, or why that is nothing.

        Composites inside of these follow each after the one that holds it. Those are left out whose document, which
        says what is inside, is not at hand: of a text, an endpoint or the living ecology. It takes no longer than the
        answer has left of the time of the method.
        """
        if not any(self.ecology[component].profile.inside for component in answer.components):
            return []
        documents: dict[Place | None, Document] = {}  # one file may advertise many
        unknown: set[IRI] = set()

        def document_of(advertisement: Advertisement) -> Document:
            place = advertisement.place
            if place not in documents:
                try:
                    documents[place] = described_in(advertisement)
                except SelfconfError:
                    unknown.add(advertisement.component)
                    raise
            return documents[place]

        found: list[tuple[IRI, Configuration | Undecided | str]] = []

        def gather() -> bool:
            found.extend(insides(self.ecology, document_of, answer.plain, self.composer.hierarchy))
            return True

        if not self._limit.within(gather, False):
            told = {component for component, _ in found}
            composites = (one for one in answer.components if self.ecology[one].profile.inside)
            late = Undecided(seconds=self._limit.seconds)
            found += [(component, late) for component in composites if component not in told]
        return [(component, inside) for component, inside in found if component not in unknown]

    def answer(self, what_if: bool = False) -> Answer | Refusal | Undecided:
        """The configuration, or why there is none, within the time of the method."""
        limit = self._limit = TimeLimit(self.method.seconds)
        began = time.perf_counter()
        with collector_looking_at_new(len(self.ecology)):
            found = self._composed(limit)
        self.seconds["search"] = time.perf_counter() - began
        if isinstance(found, Undecided):
            return replace(found, left_out=self.left_out)
        if isinstance(found, Refusal):
            free = {c: one for c, one in self.ecology.items() if c not in self.holders}
            usable = self.composer.usable(self.holders.keys(), found)
            found = replace(
                found.told_of_held(usable),
                held=self._held(usable, limit),
                missing_sites=self._missing_sites,
                left_out=self.left_out,
            )
            able = free if self.holders else self.ecology
            return refusal_with_places(self.composer, able, found, self.method, limit, texts=self._texts)
        optimum = found if isinstance(found, Optimum) else None
        plain = found.configuration if isinstance(found, Optimum) else found
        held = frozenset(self.holders)
        consequences = limit.within(lambda: self.composer.what_if(self.ecology, held, plain), None) if what_if else None
        return Answer.of(
            plain,
            self.task.document,
            optimum,
            unknown_properties=() if optimum is None else self._unknown_properties(optimum),
            what_if=None if consequences is None else tuple(consequences),
            left_out=self.left_out,
        )

    def _composed(self, limit: TimeLimit) -> Optimum | Outcome:
        """What is found among the components that this task can have."""
        held = frozenset(self.holders)
        found, taken = agreed(
            lambda left_out: composed(self.composer, self.ecology, held | left_out, None, limit),
            self._sharers,
        )
        self.holders |= taken
        self._sharers = {component: one for component, one in self._sharers.items() if component not in taken}
        return found

    def _held(self, usable: Collection[IRI], limit: TimeLimit) -> tuple[tuple[IRI, Holder], ...]:
        """The usable components of other tasks, if there would be a configuration with them."""
        if not self.holders:
            return ()
        found = composed(self.composer, self.ecology, frozenset(), None, limit)
        wanted = outcome_of(found)
        if not isinstance(wanted, Configuration):
            return ()
        named = usable or self.holders.keys() & set(wanted.components)
        return tuple((component, self.holders[component]) for component in sorted(named))

    def _unknown_properties(self, optimum: Optimum) -> tuple[IRI, ...]:
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
    texts: Sequence[str] = (),
) -> Refusal:
    """A refusal with all that the time allows to find out, and the place of each of its facts.

    `described` are the advertisements as files of this machine have them, where the ecology's come from elsewhere;
    `texts` are those that the task and the ecology were read from and that are in no file.
    """
    refusal = explained(composer, ecology, refusal, method.wider(), limit)
    placed = Places(composer.task.template, ecology if described is None else described, texts).placed(refusal)
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
