"""A template: its roles, which role feeds which, and the parameters that tailor it (section 3.1 of the paper).

A role is a SHACL node shape, and a component is eligible for it iff it conforms. The shape itself stays in RDF;
what is here is all that a search needs to know of a role.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from selfconf.model.cost import CostLevel
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.profile import Input, OperationalParameter, Output, Place
from selfconf.model.term import IRI, Term

MOST_PRIORITY = 1_000_000
"""The highest priority of a task; the lowest is the same below zero. It travels as a whole number of 64 bits."""


@immutable
class Setting:
    """A role sets an operational parameter, known by its type, to a value or to that of a template parameter."""

    type: IRI
    value: Term


@immutable
class Role:
    """A part to be played by `minimum` to `maximum` distinct components; no maximum means as many as fit."""

    iri: IRI
    minimum: int = 1
    maximum: int | None = 1
    settings: tuple[Setting, ...] = ()
    types: tuple[IRI, ...] = ()
    """The component types that the shape asks for by `sh:class`, for people to read."""
    recruits: bool = False
    """Whether components outside of the roles may feed the inputs of its players that no role feeds."""
    place: Place | None = field(default=None, compare=False)

    def setting_of(self, parameter: OperationalParameter, hierarchy: Hierarchy) -> Setting | None:
        """The setting from which an operational parameter has its value, if any: it has one value at a time.

        Of several that match its type it is the one of just that type, else the first.
        """
        matching = [one for one in self.settings if hierarchy.matches(one.type, parameter.type)]
        return next((one for one in matching if one.type == parameter.type), matching[0] if matching else None)


@immutable
class Interaction:
    """One role feeds another; ports are paired by type, and by name too where a name is given."""

    source: IRI
    sink: IRI
    output: str | None = None
    input: str | None = None


@immutable
class TemplatePort:
    """A port that a template has itself: one that the players of a role have, for those outside of the template."""

    role: IRI
    port: Input | Output
    """The port as a component has it that is a task of the template."""

    @property
    def name(self) -> str:
        """The name of the port."""
        return self.port.name

    @property
    def is_input(self) -> bool:
        """Whether it is an input, or an operation that is needed."""
        return isinstance(self.port, Input)


@immutable
class Parameter:
    """A parameter of a template; `in_shape` tells that some role's shape mentions it, so that it may stay free."""

    iri: IRI
    name: str
    default: Term | None = None
    in_shape: bool = False
    is_set: bool = False


@immutable
class Template:
    """A task-level specification: roles in their order, interactions in theirs, parameters by IRI."""

    iri: IRI
    roles: tuple[Role, ...]
    interactions: tuple[Interaction, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    label: str | None = None
    cost: tuple[CostLevel, ...] = ()
    """What the strategy `best` minimises, the most important level first; nothing if the template states none."""
    priority: int = 0
    """The priority of its tasks that state none of their own."""
    ports: tuple[TemplatePort, ...] = ()
    """What a task of it receives from outside, and gives: the ports of a component that is such a task."""

    def role(self, iri: IRI) -> Role:
        """The role of that IRI; KeyError if the template has none."""
        for role in self.roles:
            if role.iri == iri:
                return role
        raise KeyError(iri)


@immutable
class Task:
    """A template with values for some of its parameters, by parameter IRI; the rest stays free."""

    template: Template
    bindings: Mapping[IRI, Term] = field(default_factory=dict)
    iri: IRI | None = None
    stated_priority: int | None = None
    """The priority that the task states itself; `priority` is what holds."""

    @property
    def priority(self) -> int:
        """Of tasks that want the same component, the one with the highest goes first; zero if nothing is said."""
        return self.template.priority if self.stated_priority is None else self.stated_priority

    def by_name(self) -> dict[str, Term]:
        """The bindings by the parameters' names."""
        names = {parameter.iri: parameter.name for parameter in self.template.parameters}
        return {names[iri]: value for iri, value in self.bindings.items()}
