"""`partition`: which components are eligible for each role of a task, and what keeps the others out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field

from selfconf.api.arguments import Paths
from selfconf.api.configuring import Inquiry
from selfconf.api.ecology import Ecology
from selfconf.api.method import Method
from selfconf.api.tables import Tabular
from selfconf.api.task import TaskSpecification
from selfconf.composition import ranked_exclusions
from selfconf.model.holder import Holder
from selfconf.model.immutable import FrozenMapping, immutable
from selfconf.model.left_out import LeftOut
from selfconf.model.obstacle import Obstacle
from selfconf.model.partition import Candidate
from selfconf.model.template import Role
from selfconf.model.term import IRI
from selfconf.model.wording import listed
from selfconf.rdf.eligibility import CompiledRole, Exclusion
from selfconf.render import Names, holder_text


@immutable
class RolePartition(Tabular):
    """The candidates of one role, and what keeps the other components out."""

    _inquiry: Inquiry
    role: Role
    _compiled: CompiledRole = field(compare=False)
    candidates: tuple[Candidate, ...]
    """The eligible components with what they allow the free parameters to be, in the order of trying."""
    _excluded: list[tuple[Exclusion, ...]] = field(default_factory=list, init=False, compare=False)
    """What is excluded, once that was asked for."""

    @property
    def eligible(self) -> tuple[IRI, ...]:
        """The eligible components, in the order in which they are tried."""
        return tuple(candidate.profile.component for candidate in self.candidates)

    @property
    def recruits(self) -> tuple[IRI, ...]:
        """The components that may be recruited for its players, in the order of preference."""
        number = self._inquiry.composer.partitioner.roles.index(self._compiled)
        partition = self._inquiry.composer.partition(self._inquiry.ecology)
        return tuple(recruit.component for recruit in partition.recruits if number in recruit.roles)

    @property
    def held(self) -> Mapping[IRI, Holder]:
        """The eligible components that other tasks hold, as of the same or a higher priority, each with its holder.

        One that can be shared is held where its holder has other values for its parameters than the role sets.
        """
        profiles = [candidate.profile for candidate in self.candidates]
        found = ((profile.component, self._inquiry.holder(self.role, profile)) for profile in profiles)
        return FrozenMapping({component: holder for component, holder in found if holder is not None})

    @property
    def excluded(self) -> tuple[Exclusion, ...]:
        """The components that are not eligible, each with its obstacles; the nearest ones first."""
        if not self._excluded:
            composer = self._inquiry.composer
            known = self._inquiry.method.wider() or composer.hierarchy
            number = composer.partitioner.roles.index(self._compiled)
            self._excluded.append(ranked_exclusions(composer, self._inquiry.ecology, number, known))
        return self._excluded[0]

    def obstacles(self, component: IRI) -> tuple[Obstacle, ...]:
        """What keeps a component out of the role; nothing if it is eligible.

        Raises KeyError for a component that the ecology does not have.
        """
        if component in self.eligible:
            return ()
        for one in self.excluded:
            if one.component == component:
                return one.obstacles
        raise KeyError(f"the ecology has no component {component!r}")

    def __repr__(self) -> str:
        return f"<role {self.role.iri.short}: {listed(one.short for one in self.eligible) or 'no component'}>"

    def _head(self) -> Sequence[str]:
        return "component", "eligible", "what keeps it out"

    def _cells(self) -> Iterator[list[str]]:
        names, held = self._inquiry.task.names, self.held
        for number, component in enumerate(self.eligible, 1):
            yield [names(component), str(number), holder_text(held[component]) if component in held else ""]
        yield from ([names(one.component), "no", ", ".join(map(str, one.obstacles))] for one in self.excluded)


@immutable
class PartitionTable(Tabular, Mapping[str, RolePartition]):
    """F1 ... Fn by the local name, CURIE or IRI of the role, in the order of the roles; prints as a table."""

    inquiry: Inquiry
    roles: tuple[RolePartition, ...]
    __repr__ = Tabular.__repr__

    @classmethod
    def of(cls, inquiry: Inquiry) -> PartitionTable:
        """The partition for a task in an ecology."""
        partition = inquiry.composer.partition(inquiry.ecology)
        roles = zip(inquiry.task.roles, inquiry.composer.partitioner.roles, partition.candidates, strict=True)
        return cls(inquiry, tuple(RolePartition(inquiry, *row) for row in roles))

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The components that are eligible for nothing, as what they say cannot be judged, or not in time."""
        return self.inquiry.left_out

    def __eq__(self, other: object) -> bool:
        return Mapping.__eq__(self, other)  # as any mapping is

    @property
    def names(self) -> Names:
        """Shortens IRIs by the prefixes of the template's document."""
        return self.inquiry.task.names

    @property
    def sufficient(self) -> bool:
        """Whether every role has as many candidates as it asks for."""
        return all(len(one.candidates) - len(one.held) >= one.role.minimum for one in self.roles)

    def __getitem__(self, role: str) -> RolePartition:
        for one in self.roles:
            if self.names.means(role, one.role.iri):
                return one
        raise KeyError(f"there is no role {role!r}; the roles are {', '.join(self)}")

    def __iter__(self) -> Iterator[str]:
        return (one.role.iri.short for one in self.roles)

    def __len__(self) -> int:
        return len(self.roles)

    def _head(self) -> Sequence[str]:
        return "role", "", "eligible, in the order of trying"

    def _cells(self) -> Iterator[list[str]]:
        for one in self.roles:
            name = self.names(one.role.iri)
            yield from ([name, str(number), self.names(found)] for number, found in enumerate(one.eligible, 1))
            if not one.eligible:
                yield [name, "", "no component"]


def partition(
    task: TaskSpecification,
    ecology: Ecology,
    *,
    reasoning: str = "syntactic",
    ontologies: Paths = (),
) -> PartitionTable:
    """The partition of an ecology by the roles of a task: which components are eligible, and why the others are not.

    Raises TemplateError for a shape that cannot be judged, BindingError, NetworkError.

    >>> partition(template("examples/clock/tell-the-time.ttl"), read("examples/clock"))["source"].eligible
    (<https://example.org/my-home#clock>,)
    """
    return PartitionTable.of(Inquiry(task, ecology, Method.of(reasoning=reasoning, ontologies=ontologies)))
