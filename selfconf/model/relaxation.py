"""Relaxations: changes to an ecology or a template, each of which makes a refused task possible.

A refusal has them as its `repairs`. A relaxation is a fact; it words itself as a request. `code` is stable, for
programs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from typing import ClassVar

from selfconf.model.immutable import immutable, replace
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import CALL_MARK, Operation, Output, Placed
from selfconf.model.term import IRI, Term
from selfconf.model.wording import in_words, listed


@immutable
class Addition:
    """Components to be added: so many for a role, each without inputs and with these outputs."""

    role: IRI
    count: int
    outputs: tuple[Output, ...] = ()
    named: frozenset[str] = frozenset()
    """The names of outputs that an interaction asks for; the others may be called anything."""
    values: tuple[tuple[str, Term | None], ...] = ()
    """Of free parameters, by name, the value that each component must admit; None if it must not state any."""
    shared: tuple[str, ...] = ()
    """The free parameters, by name, of which they state the value that other additions state as well."""

    def __str__(self) -> str:
        return self.worded("")

    def worded(self, purpose: str) -> str:
        """The components in words, with what they are for the role for, such as ` to recruit`; players need none."""
        number = "one more component" if self.count == 1 else f"{self.count} more components"
        one = self.count == 1
        clauses = [
            f"{verb}{'s' if one else ''} {self._ports([o for o in self.outputs if _is_operation(o) is called])}"
            for verb, called in (("issue", False), ("offer", True))
            if any(_is_operation(output) is called for output in self.outputs)
        ]
        issuing = f" that {listed(clauses)}" if clauses else ""
        values = "".join(
            f", with no {name}" if value is None else f", with {name} {in_words((value,))}"
            for name, value in self.values
        )
        return f"{number} for the role {self.role.short}{purpose}{issuing}{values}"

    def _ports(self, outputs: Sequence[Output]) -> str:
        signals = listed(dict.fromkeys(_signal(output) for output in outputs if output.name not in self.named))
        by_name = [
            f"{_signal(one)} by the {'name' if one.is_operation else 'output'} {one.name.removesuffix(CALL_MARK)!r}"
            for one in outputs
            if one.name in self.named
        ]
        return listed([*([signals] if signals else []), *by_name])


def _is_operation(output: Output) -> bool:
    # Only where an interaction names it has one that is to be added a name that tells.
    return output.is_operation or any(isinstance(one, Operation) for one in output.signals)


def _signal(output: Output) -> str:
    shape = " as the sc:accepts of its input asks" if output.conforms else ""
    article = "" if output.signals or output.is_operation else "a "
    return f"{article}{output}{shape}"


@immutable
class AddComponents(Placed):
    """Fewest components whose addition makes the task possible."""

    code: ClassVar[str] = "add-components"
    additions: tuple[Addition, ...]
    shared: tuple[str, ...] = ()
    """The free parameters, by name, of which all that share them have to state one value, whichever that is."""

    @property
    def role(self) -> IRI:
        """The first of the roles that get a component."""
        return self.additions[0].role

    def __str__(self) -> str:
        return f"add {listed(map(str, self.additions))}{self._sharing}"

    @property
    def _sharing(self) -> str:
        return "".join(f", with one {name} for {self._those_that_share(name)}" for name in self.shared)

    def _those_that_share(self, name: str) -> str:
        roles = dict.fromkeys(one.role.short for one in self.additions if name in one.shared)
        if roles and len(roles) < len({one.role for one in self.additions}):
            return f"those for the role{'s' if len(roles) > 1 else ''} {listed(roles)}"
        return "both" if sum(one.count for one in self.additions) == 2 else "all"


@immutable
class AddRecruits(AddComponents):
    """Components that make the task possible as recruits; none of their outputs can be spared."""

    code: ClassVar[str] = "add-recruits"

    def __str__(self) -> str:
        alike: dict[str, list[Addition]] = {}
        for addition in self.additions:
            alike.setdefault(str(addition), []).append(addition)
        some = [replace(those[0], count=sum(one.count for one in those)) for those in alike.values()]
        return f"add {listed(addition.worded(' to recruit') for addition in some)}"


@immutable
class AskForFewer(Placed):
    """A role that asks for fewer components, or for none, makes the task possible."""

    code: ClassVar[str] = "ask-for-fewer"
    role: IRI
    minimum: int

    def __str__(self) -> str:
        if not self.minimum:
            return f"let the role {self.role.short} be optional (sc:minCount 0)"
        return f"let the role {self.role.short} ask for {self.minimum} (sc:minCount {self.minimum})"


@immutable
class LetRecruit(Placed):
    """A role that recruits makes the task possible."""

    code: ClassVar[str] = "let-recruit"
    role: IRI
    recruits: tuple[IRI, ...]
    """The components that would be recruited."""

    def __str__(self) -> str:
        would = "it would bring" if self.recruits else "no recruit would be needed"
        names = listed(recruit.short for recruit in self.recruits)
        return f"let the role {self.role.short} recruit (sc:recruits true): {would} {names}".rstrip()


@immutable
class AddInteraction(Placed):
    """One more interaction makes the task possible."""

    code: ClassVar[str] = "add-interaction"
    role: IRI
    """The role that feeds."""
    sink: IRI

    def __str__(self) -> str:
        return f"let the role {self.role.short} feed the role {self.sink.short} (sc:feeds)"


@immutable
class AcceptNearMiss(Placed):
    """A role that takes a component, as it is, which one thing keeps out makes the task possible.

    To change the component instead may not be enough: another constraint of the role may then fail.
    """

    code: ClassVar[str] = "accept-near-miss"
    near: NearMiss
    candidate: Candidate = field(repr=False)

    @property
    def role(self) -> IRI:
        """The role that would take the component."""
        return self.near.role

    def __str__(self) -> str:
        return f"let the role {self.near.role.short} take {self.near.component.short}, although {self.near}"


Relaxation = AddComponents | AddRecruits | AskForFewer | AddInteraction | LetRecruit | AcceptNearMiss
