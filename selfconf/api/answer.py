"""What the library answers with: a configuration or a refusal that prints, with the prefixes of its task."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.immutable import FrozenMapping, immutable, recast, replace
from selfconf.model.left_out import LeftOut
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.model.wording import plain
from selfconf.rdf.provenance import configuration_iri, configuration_triples
from selfconf.rdf.tasks import TaskDocument
from selfconf.rdf.turtle import to_turtle
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


@immutable
class Answer(Configuration, Mapping[str, tuple[IRI, ...]]):
    """A configuration as the library answers with it: also what it costs, and what would replace what.

    It is a mapping: `answer["position"]` are the components of a role, by its local name, CURIE or IRI, and
    `dict(answer)` are those of all roles by their local names.
    """

    task: TaskDocument = field(kw_only=True, repr=False, compare=False)
    optimum: Optimum | None = field(default=None, kw_only=True, repr=False, compare=False)
    """The cost with its proof, where the strategy is `best` and the template states a cost."""
    unknown_properties: tuple[IRI, ...] = field(default=(), kw_only=True, repr=False, compare=False)
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
        unknown_properties: tuple[IRI, ...] = (),
        what_if: tuple[Consequence, ...] | None = None,
        left_out: tuple[LeftOut, ...] = (),
    ) -> Answer:
        """A configuration of a task as an answer to it."""
        return recast(
            configuration,
            cls,
            Configuration,
            task=task,
            optimum=optimum,
            unknown_properties=unknown_properties,
            what_if=what_if,
            left_out=left_out,
        )

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
        return any(self.names.means(role, one) for one in self.roles)

    def __getitem__(self, role: str) -> tuple[IRI, ...]:
        for assignment in self.assignments:
            if self.names.means(role, assignment.role):
                return assignment.components
        known = ", ".join(assignment.role.short for assignment in self.assignments)
        raise KeyError(f"there is no role {role!r}; the roles are {known}")

    @property
    def plain(self) -> Configuration:
        """The configuration by itself."""
        return replace(recast(self, Configuration, Configuration), bindings=dict(self.bindings))

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
            parts.append(cost_text(self.optimum, self.unknown_properties, self.names))
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
        return recast(refusal, cls, Refusal, task=task)

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
