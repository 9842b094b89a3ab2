"""A refusal: why there is no configuration, what nearly fitted, which changes would help. A value, not an exception.

The search records facts; each fact words itself in one sentence for people. `code` is stable, for programs. A
*reason* stands on a set of requirements that cannot hold together; drop any one of them and the rest can.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import field
from typing import ClassVar, Literal

from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable, replace
from selfconf.model.left_out import LeftOut
from selfconf.model.partition import NearMiss
from selfconf.model.profile import CALL_MARK, Placed, WantedSignal, port_in_words
from selfconf.model.relaxation import Relaxation
from selfconf.model.requirement import InputFed, OneRoleEach, OneValue, Requirement, RolePlayed
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.model.wording import counted, listed


@immutable
class Contradiction(Placed):
    """A role asks for more components than it allows."""

    code: ClassVar[str] = "contradictory-count"
    role: IRI
    minimum: int
    maximum: int

    @property
    def requirements(self) -> tuple[Requirement, ...]:
        """The role by itself."""
        return (RolePlayed(self.role),)

    def __str__(self) -> str:
        return (
            f"the role {self.role.short} asks for no fewer than {self.minimum} and no more than {self.maximum} "
            "components; nothing can satisfy both"
        )


@immutable
class ValueUnknown(Placed):
    """A parameter is set on a component, is not bound, and no candidate states a value for it."""

    code: ClassVar[str] = "value-unknown"
    role: IRI
    parameter: str

    @property
    def requirements(self) -> tuple[Requirement, ...]:
        """The parameter by itself."""
        return (OneValue(self.parameter),)

    def __str__(self) -> str:
        return (
            f"the role {self.role.short} sets a parameter to {self.parameter}, which is not bound, and no candidate "
            f"says what it could be; bind {self.parameter}"
        )


@immutable
class TooFewEligible(Placed):
    """A role has fewer eligible components than it asks for."""

    code: ClassVar[str] = "too-few-eligible"
    role: IRI
    wanted: int
    found: int
    held: int = field(default=0, kw_only=True, compare=False)
    """How many more are eligible, but held by other tasks that this one cannot take them from."""

    @property
    def requirements(self) -> tuple[Requirement, ...]:
        """The role by itself."""
        return (RolePlayed(self.role),)

    def __str__(self) -> str:
        if not self.found:
            return f"no component {'that is free ' if self.held else ''}is eligible for the role {self.role.short}"
        among = "of those that are free only" if self.held else "only"
        return f"the role {self.role.short} asks for {self.wanted} components, and {among} {_eligible(self.found)}"


@immutable
class DerivationStep:
    """A step of a derivation: candidates of a role play in no configuration, as one of their inputs is not fed."""

    role: IRI
    component: IRI
    """The first of these candidates."""
    more: int
    """How many others leave for the same cause."""
    input: str
    wanted: WantedSignal
    sources: tuple[IRI, ...]
    optional: tuple[IRI, ...] = ()
    """The sources that ask for no component (`sc:minCount 0`) though a candidate of theirs would feed the input."""
    recruits: bool = False
    """Whether the role recruits, so that components outside of the roles could have fed it."""

    def __str__(self) -> str:
        others = "" if not self.more else " and one other" if self.more == 1 else f" and {self.more} others"
        issues = _issues(self.input, self.wanted)
        none_issues, port = f"no component left in {{}} {issues}", port_in_words(self.input).removeprefix("the ")
        no_role = f"no recruit that can be fed itself {issues}" if self.recruits else f"no interaction feeds its {port}"
        if not self.wanted.signals:
            no_role = f"its {port} states no type, and no sc:Interaction names both ports"
        lack = _lack(self.sources, self.optional, none_issues, no_role, self.recruits)
        return f"{self.component.short}{others} cannot play the role {self.role.short}, as {lack}"


def _issues(port: str, wanted: WantedSignal) -> str:
    """What an output does that feeds an input, or an operation that is needed."""
    return "offers an operation of that name" if port.endswith(CALL_MARK) and not wanted.signals else wanted.issued


def _lack(sources: tuple[IRI, ...], optional: tuple[IRI, ...], none_issues: str, no_role: str, recruits: bool) -> str:
    """Why an input is not fed: `none_issues` is said of the sources that ask for at least one component."""
    asked = [source.short for source in sources if source not in optional]
    said = [none_issues.format(listed(asked))] if asked else [] if optional else [no_role]
    # Where to ask such a role for components made a configuration possible, there would be one.
    said += [f"what could serve it cannot play the optional role {role.short} (sc:minCount 0)" for role in optional]
    return ", and ".join([*said, *(["no recruit that can be fed itself does"] if recruits and sources else [])])


@immutable
class MisnamedPort:
    """A port that an interaction names and no candidate of a role has, with the name that was probably meant."""

    role: IRI
    kind: str
    """Which port it is: `output` or `input`."""
    named: str
    meant: str | None
    """The name that is written much like it; None if none is."""
    known: tuple[str, ...] = ()
    """The names of all ports of the kind that candidates of the role have, in order."""

    def __str__(self) -> str:
        said = f'no candidate of {self.role.short} has the {self.kind} "{self.named}" that an interaction names'
        if self.meant is not None:
            return f'{said} (did you mean "{self.meant}"?)'
        return f"{said} ({self._there_are()})"

    def _there_are(self) -> str:
        """Which ports there are instead."""
        names = listed(f'"{name}"' for name in self.known)
        return f"there {'is' if len(self.known) < 2 else 'are'} {names or 'none'}"


@immutable
class InputUnfed(Placed):
    """Every candidate of a role that matters has an input that no candidate of the roles feeding it can feed."""

    code: ClassVar[str] = "input-unfed"
    role: IRI
    component: IRI
    input: str
    wanted: WantedSignal
    sources: tuple[IRI, ...]
    requirements: tuple[Requirement, ...] = ()
    consequences: tuple[DerivationStep, ...] = ()
    """What follows from it, up to the role that has no candidate left."""
    optional: tuple[IRI, ...] = ()
    """The sources that ask for no component (`sc:minCount 0`) though a candidate of theirs would feed the input."""
    recruits: bool = False
    """Whether the role recruits, so that components outside of the roles could have fed it."""
    nearest: NearMiss | None = field(default=None, kw_only=True, compare=False)
    """The component that comes nearest to being recruited for it, if there is one."""
    misnamed: MisnamedPort | None = field(default=None, kw_only=True)
    """A port of the interactions that feed the role which has another name than they say, if there is one."""

    def __str__(self) -> str:
        issues, called = _issues(self.input, self.wanted), self.input.endswith(CALL_MARK)
        types = f" ({str(self.wanted).removeprefix('operation ')})" if self.wanted.signals or not called else ""
        name = f"{port_in_words(self.input)}{types} {'that' if called else 'of'} {self.component.short}"
        none_issues = f"no candidate of {{}} {issues} for it"
        no_role = f"no interaction feeds it in the role {self.role.short}"
        if self.recruits:
            no_role = f"no recruit that can be fed itself {issues}"
        if not self.wanted.signals:
            no_role = "it states no type, and no sc:Interaction names both ports"
        lack = _lack(self.sources, self.optional, none_issues, no_role, self.recruits)
        if self.nearest is not None:
            lack += f"; the nearest is {self.nearest.component.short}, which {self.nearest.obstacle}"
        if self.misnamed is not None:
            lack += f"; {self.misnamed}"
        verdict = "needs cannot be called" if called else "cannot be fed"
        return "; so ".join([f"{name} {verdict}: {lack}", *map(str, self.consequences)])


@immutable
class TooFewDistinct(Placed):
    """Some roles together ask for more components than are eligible for any of them."""

    code: ClassVar[str] = "too-few-distinct"
    roles: tuple[IRI, ...]
    wanted: int
    found: int

    @property
    def role(self) -> IRI:
        """The first of the roles."""
        return self.roles[0]

    @property
    def requirements(self) -> tuple[Requirement, ...]:
        """The roles, and that no component plays two of them."""
        return (*map(RolePlayed, self.roles), OneRoleEach())

    def __str__(self) -> str:
        names = listed(role.short for role in self.roles)
        return (
            f"the roles {names} together ask for {self.wanted} different components, and only {_eligible(self.found)}"
        )


@immutable
class Conflict(Placed):
    """Each of these roles can be played, but not all of them together."""

    code: ClassVar[str] = "conflict"
    roles: tuple[IRI, ...]
    parameters: tuple[str, ...] = ()
    requirements: tuple[Requirement, ...] = ()

    @property
    def role(self) -> IRI:
        """The first of the roles."""
        return self.roles[0]

    def __str__(self) -> str:
        needs = [str(r) for r in self.requirements if isinstance(r, InputFed)]
        conditions = [f"one {name} for all" for name in self.parameters]
        if any(isinstance(r, OneRoleEach) for r in self.requirements):
            # A role that is named alone is at odds with itself, or with what would be recruited for it.
            conditions.append("a different component for each" if len(self.roles) > 1 else "no component used twice")
        shared = f" with {listed(conditions)}" if conditions else ""
        so_that = f" so that {listed(needs)}" if needs else ""
        if len(self.roles) == 1:
            return f"the role {self.roles[0].short} cannot be played{shared}{so_that}"
        names = listed(role.short for role in self.roles)
        return f"the roles {names} cannot all be played{shared}{so_that}"


Reason = Contradiction | ValueUnknown | TooFewEligible | InputUnfed | TooFewDistinct | Conflict


@immutable
class Refusal:
    """No configuration: the reasons, the most likely cause first, near misses, relaxations, and a hint.

    >>> home = read("examples/clock")
    >>> refusal = configure(template("examples/clock/tell-the-time.ttl").bind(room=":cellar"), home)
    >>> bool(refusal), str(refusal.reasons[0])
    (False, 'no component is eligible for the role screen')
    >>> str(refusal.near_misses[0]), str(refusal.near_misses[0].place)
    ('its place is kitchen, not cellar', 'examples/clock/display.ttl:5')
    """

    template: IRI
    reasons: tuple[Reason, ...]
    """None where no time was left to find any."""
    near_misses: tuple[NearMiss, ...] = ()
    hint: str | None = None
    missing_sites: tuple[str, ...] = field(default=())
    repairs: tuple[Relaxation, ...] = ()
    """The relaxations that were found."""
    held: tuple[tuple[IRI, Holder], ...] = ()
    """The components that the task could use, and which other tasks hold, where there would be a configuration with
    these; sorted."""
    irreducible: bool = True
    """Whether each reason was proved to need all of its requirements; not when the steps for that were used up."""
    smallest: bool = True
    """Whether each reason was proved to have the fewest requirements that cannot hold together."""
    repairs_stopped: bool = False
    """Whether the steps, time or trials for relaxations were used up before all was tried: there may be others then."""
    left_out: tuple[LeftOut, ...] = field(default=(), kw_only=True, repr=False, compare=False)
    """The components that count for nothing, as what they say cannot be judged, or not in time."""

    @property
    def minimality(self) -> str:
        """What is proved of the reasons: they are `smallest`, at least `irreducible`, or `unproved`."""
        return "smallest" if self.smallest else "irreducible" if self.irreducible else "unproved"

    def told_of_held(self, usable: Mapping[IRI, tuple[IRI, ...]]) -> Refusal:
        """The refusal whose reasons count, beside the eligible components, those that other tasks hold.

        `usable` are these, each with the roles that it may play.
        """
        held = Counter(role for roles in usable.values() for role in roles)
        reasons = (
            replace(reason, held=held[reason.role]) if isinstance(reason, TooFewEligible) else reason
            for reason in self.reasons
        )
        return replace(self, reasons=tuple(reasons))

    def __bool__(self) -> Literal[False]:
        return False


@immutable
class Undecided:
    """What was allowed is used up, and there is neither a configuration nor a proof that there is none.

    It has no reasons, near misses or repairs, so that a program can ask whatever is false for them.

    >>> answer = configure(template("examples/watch.ttl"), read("examples/watch"), steps=1)
    >>> isinstance(answer, Undecided), bool(answer), answer.reasons
    (True, False, ())
    """

    code: ClassVar[str] = "undecided"
    reasons: ClassVar[tuple[Reason, ...]] = ()
    near_misses: ClassVar[tuple[NearMiss, ...]] = ()
    repairs: ClassVar[tuple[Relaxation, ...]] = ()
    steps: int = 0
    seconds: float | None = None
    """The time that was allowed, if it was time that ended the search."""
    unaided: bool = False
    """Whether there was no clause-learning solver at hand."""
    left_out: tuple[LeftOut, ...] = field(default=(), kw_only=True, repr=False, compare=False)
    """The components that count for nothing, as what they say cannot be judged, or not in time."""

    def __bool__(self) -> Literal[False]:
        return False

    def __str__(self) -> str:
        if self.seconds is not None:
            return f"not decided within {self.seconds:g} s; allow more by {setting('seconds')}"
        solver = ", or install the extra `solvers`" if self.unaided else ""
        return f"not decided within {counted(self.steps, 'step')}; allow more by {setting('steps')}{solver}"

    def _repr_html_(self) -> str:
        return f"<pre>{self}</pre>"  # words and numbers of selfconf: nothing in it has to be escaped


Outcome = Configuration | Refusal | Undecided
"""What a search can come to."""


def _eligible(number: int) -> str:
    return "one is eligible" if number == 1 else f"{number} are eligible"
