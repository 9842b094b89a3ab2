"""Obstacles: what keeps a component out of a role, as values. Each words itself as a predicate of the component.

`str(obstacle)` follows the name of the component, or of its property: `is no SonarArray`, `support is Pippi, not
Astrid`; `clause` is a whole clause: `it is no SonarArray`, `its support is Pippi, not Astrid`. `code` is stable, for
programs.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from typing import ClassVar

from selfconf.model.immutable import immutable
from selfconf.model.profile import CALL_MARK, Operation, WantedSignal, port_in_words
from selfconf.model.property_fault import Fault, subject_of
from selfconf.model.setting_names import setting
from selfconf.model.signal_likeness import Degree, SignalMatch
from selfconf.model.term import IRI, Term
from selfconf.model.unit_dimension import differ_in_dimension
from selfconf.model.wording import in_words, listed, one_line, with_article


class _Predicate:
    """An obstacle that speaks of the component itself."""

    __slots__ = ()

    @property
    def clause(self) -> str:
        """The obstacle as a clause with the component as its subject."""
        return f"it {self}"


class TypeRelation(str, Enum):
    """How the type of a component is related to the one that a role asks for."""

    SIMILAR = "similar"
    """The names are alike, so that one of them is probably misspelt."""
    BELOW = "below"
    """An ontology places it below the wanted one, which the reasoning mode does not see."""
    ABOVE = "above"
    """An ontology places it above the wanted one."""


@immutable
class WrongType(_Predicate):
    """The component is not of a class that the role asks for (`sh:class`)."""

    code: ClassVar[str] = "wrong-type"
    wanted: IRI
    offered: IRI | None = None
    """The type of the component that is related to the wanted one, if one is."""
    relation: TypeRelation | None = None

    def __str__(self) -> str:
        if self.offered is None:
            return f"is no {self.wanted.short}"
        wanted, offered = self.wanted.short, self.offered.short
        if wanted == offered:
            wanted, offered = repr(self.wanted), repr(self.offered)
        said = f"is no {wanted} but a {offered}"
        if self.relation is TypeRelation.SIMILAR:
            return f"{said} (is one of them misspelt?)"
        if self.relation is TypeRelation.BELOW:
            return f"{said}, which lies below it (see {setting('reasoning', 'subclass')})"
        return f"{said}, which lies above it"


@immutable
class WrongComponent(_Predicate):
    """The role asks for one of some components by name (`sh:in` or `sh:hasValue` on the node)."""

    code: ClassVar[str] = "wrong-component"
    members: frozenset[Term]

    def __str__(self) -> str:
        return f"is not {in_words(self.members)}"


@immutable
class PropertyUnmet:
    """All that is wrong with one property: one obstacle, as one change of the property mends it."""

    code: ClassVar[str] = "property-unmet"
    path: IRI
    faults: tuple[Fault, ...]
    message: str = ""
    """What the author of the shape says of that (`sh:message`)."""

    @property
    def clause(self) -> str:
        """The obstacle as clauses: about the component where it lacks the property, else about the property."""
        return self._with_message(f"{subject_of(fault)} {fault.said(self.path.short)}" for fault in self.faults)

    def __str__(self) -> str:
        return self._with_message(fault.said(self.path.short) for fault in self.faults)

    def _with_message(self, clauses: Iterable[str]) -> str:
        said = "; ".join(clauses)
        return f"{said} ({one_line(self.message)})" if self.message else said


@immutable
class ParameterUndeclared(_Predicate):
    """The role sets an operational parameter of a type that the component does not declare (`sc:hasParameter`)."""

    code: ClassVar[str] = "parameter-undeclared"
    type: IRI

    def __str__(self) -> str:
        return f"declares no parameter of type {self.type.short}"


@immutable
class NoAlternative:
    """The component meets too few of several alternatives (`sh:or`, `sh:xone`, `sh:and`): what each of them lacks."""

    code: ClassVar[str] = "no-alternative"
    obstacles: tuple[Obstacle, ...]

    @property
    def clause(self) -> str:
        """The obstacles as clauses."""
        return " and ".join(dict.fromkeys(obstacle.clause for obstacle in self.obstacles))

    def __str__(self) -> str:
        return " and ".join(dict.fromkeys(map(str, self.obstacles)))


@immutable
class Excluded(_Predicate):
    """The component meets what it must not meet (`sh:not`), or several of which it may meet one (`sh:xone`)."""

    code: ClassVar[str] = "excluded"
    several: bool = False
    classes: tuple[IRI, ...] = ()
    paths: tuple[IRI, ...] = ()
    """The classes and properties by which it meets that."""

    def __str__(self) -> str:
        said = "is several things of which it must be one" if self.several else "is what it must not be"
        what = f": {listed(with_article(kind.short) for kind in self.classes)}" if self.classes else ""
        return f"{said}{what}, by its {listed(path.short for path in self.paths)}" if self.paths else f"{said}{what}"


@immutable
class ShapeViolated(_Predicate):
    """pySHACL finds a constraint violated that is not compiled; `path` is the property, if it is about one."""

    code: ClassVar[str] = "shape-violated"
    message: str
    path: IRI | None = None

    def __str__(self) -> str:
        return f"violates: {self.message}"


@immutable
class NoCommonValue(_Predicate):
    """What the component states leaves a free parameter of the role no value at all."""

    code: ClassVar[str] = "no-common-value"

    def __str__(self) -> str:
        return "leaves no value for a free parameter that its statements agree on"


@immutable
class ParameterForbids(_Predicate):
    """What the component states would be the value of a free parameter, which may not have it."""

    code: ClassVar[str] = "parameter-forbids"
    parameter: IRI
    values: frozenset[Term]

    def __str__(self) -> str:
        return f"wants {self.parameter.short} to be {in_words(self.values)}, which it may not be"


_RELATIONS = {
    Degree.PLUG_IN: "which lies below",
    Degree.SUBSUMES: "which lies above",
    Degree.OVERLAP: "which is akin to",
}
"""In words how an offered signal type is related to the one that is wanted."""


@immutable
class UnlikePorts(_Predicate):
    """The component would fit but for its ports: what it should issue or take, and what comes nearest."""

    code: ClassVar[str] = "unlike-ports"
    issued: tuple[SignalMatch, ...] = ()
    """For each signal that it should issue the nearest that it does."""
    given: tuple[SignalMatch, ...] = ()
    """For each signal that it requires the nearest that it would be given."""
    unfit: tuple[UnfitOutput, ...] = ()
    """The operations among the nearest that do not take what would be sent, either."""

    def __str__(self) -> str:
        issued = [_issuing(one) for one in self.issued if not one.exact]
        given = [_taking(one) for one in self.given if not one.exact]
        return " and ".join(dict.fromkeys((*issued, *map(str, self.unfit), *given))) or "has other ports"


@immutable
class UnfitOutput(_Predicate):
    """The component issues the signal that an input wants, but in another unit or frame, or of another shape.

    Or it offers the operation that is needed, but takes another request than the one that would be sent.
    """

    code: ClassVar[str] = "unfit-output"
    output: str
    units: tuple[IRI, IRI] | None = None
    """The unit that it issues and the one that is wanted, where they differ."""
    frames: tuple[Term, Term] | None = None
    """The frame that it refers to and the one that is wanted, where they differ."""
    unaccepted: Obstacle | None = None
    """What keeps the output from conforming to the shape of the input."""
    requests: tuple[IRI | None, IRI | None] | None = None
    """The request that the operation takes and the one that would be sent, where they do not match; None is nothing."""

    @property
    def hopeless(self) -> bool:
        """Whether no conversion helps, as what it issues is of another dimension."""
        return self.units is not None and differ_in_dimension(*self.units) is True

    def __str__(self) -> str:
        said = []
        if self.units is not None:
            found, wanted = self.units
            differ = differ_in_dimension(found, wanted)
            note = "" if differ is None else f", a unit of {'another' if differ else 'the same'} dimension"
            said.append(f"is in {found.short}, not in {wanted.short}{note}")
        if self.frames is not None:
            said.append(f"is in the frame {in_words(self.frames[:1])}, not in {in_words(self.frames[1:])}")
        if self.unaccepted is not None:
            said.append(f"is not accepted: {self.unaccepted.clause}")
        if self.requests is not None:
            taken, sent = ("nothing" if one is None else one.short for one in self.requests)
            said.append(f"takes {taken} and would be sent {sent}")
        if self.output.endswith(CALL_MARK):
            return f"offers what {' and '.join(said)} ({port_in_words(self.output).removeprefix('the ')})"
        return f"issues what {' and '.join(said)} (output {self.output!r})"


@immutable
class NotFedItself(_Predicate):
    """The component issues what an input wants, but could not be recruited: an input of its own stays unfed."""

    code: ClassVar[str] = "not-fed-itself"
    input: str
    signals: tuple[IRI, ...]
    feeders: tuple[IRI, ...] = ()
    """What could feed that input, what could feed this one, and so on."""
    in_circle: bool = False

    def __str__(self) -> str:
        issues = WantedSignal(self.signals).issued
        port = port_in_words(self.input).removeprefix("the ")
        if self.in_circle:
            return f"is fed only in a circle: its {port} by {' by '.join(c.short for c in self.feeders)}"
        if self.feeders:
            return f"is not fed itself: {self.feeders[0].short}, which {issues} for its {port}, is not fed either"
        return f"is not fed itself: no component that can be recruited {issues} for its {port}"


def _issuing(match: SignalMatch) -> str:
    verb, sort = ("offers", "operation ") if isinstance(match.wanted, Operation) else ("issues", "")
    wanted = match.wanted.short if match.wanted else "signal without a type"
    if match.offered is None:
        return f"{verb} no {sort}{wanted}"
    return f"{verb} {sort}{match.offered.short}, {_RELATIONS[match.degree]} {sort}{wanted}"


def _taking(match: SignalMatch) -> str:
    wanted = match.wanted.short if match.wanted else "a signal without a type"
    if match.offered is None:
        return f"needs {wanted}, which it would not be given"
    return f"needs {wanted} and would be given {match.offered.short}, {_RELATIONS[match.degree]} it"


@immutable
class NotJudged(_Predicate):
    """What the component says would take too long to judge, or cannot be judged at all; so it plays no role."""

    code: ClassVar[str] = "not-judged"
    reason: str

    def __str__(self) -> str:
        return f"is not judged: {self.reason}"


Obstacle = (
    WrongType
    | WrongComponent
    | PropertyUnmet
    | ParameterUndeclared
    | NoAlternative
    | Excluded
    | ShapeViolated
    | NoCommonValue
    | ParameterForbids
    | UnlikePorts
    | UnfitOutput
    | NotFedItself
    | NotJudged
)
