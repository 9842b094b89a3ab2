"""What composites are inside: which of them can be configured, as what, and why the others cannot.

The inside of a composite is a task; its template is read from the document that advertises the composite, and its ports
and some of its parameters are those of the composite. It is configured from the components of one site, the composite
itself left out. What feeds it from outside is known once a task holds it: until then its optional inputs are taken to
be fed. Composites that could be inside of each other in a circle have no end, and are refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from selfconf.composition.composer import Composer
from selfconf.errors import AuthorError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable, replace
from selfconf.model.profile import Condition, Input, Output, Profile, port_in_words
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.sharing import agreed
from selfconf.model.term import IRI, Term
from selfconf.model.wording import MANY
from selfconf.rdf import tasks
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.tasks import InsideReader, TaskDocument
from selfconf.rdf.turtle import Document
from selfconf.render import holder_text

DocumentOf = Callable[[Advertisement], Document]
"""Reads the document in which a composite is advertised; raises SelfconfError."""


@immutable
class Inside:
    """What a composite is inside: a task, of which some parameters are operational parameters of the composite."""

    composite: IRI
    task: TaskDocument
    later: frozenset[str]
    """The names of these parameters: they get their values when the composite is activated."""
    optional: frozenset[str]
    """The names of the inputs of the composite that may stay unfed."""
    hierarchy: Hierarchy
    composer: Composer
    """Composes the inside as it is before that, with these parameters left free and all inputs fed."""

    @classmethod
    def of(cls, profile: Profile, reader: InsideReader, hierarchy: Hierarchy) -> Inside:
        """What a component is inside, by the reader of its document. Raises SelfconfError if it cannot be."""
        task = reader.read(profile.component)
        _check_ports(profile, task)
        task = _with_stated(profile, task)
        later = frozenset(parameter.name for parameter in profile.parameters)
        _check_parameters(later, task)
        optional = frozenset(port.name for port in profile.inputs if port.optional)
        composer = Composer(tasks.complete(task, later), hierarchy, outside=profile.component)
        return cls(profile.component, task, later, optional, hierarchy, composer)

    def composer_with(self, values: Mapping[str, Term]) -> Composer:
        """What composes the inside with values for the parameters of the composite, all of its inputs being fed.

        Raises SelfconfError.
        """
        template = self.task.template
        for parameter in template.parameters:
            lacks = parameter.name in self.later and parameter.name not in values and parameter.default is None
            if lacks and parameter.is_set and not parameter.in_shape:
                raise AuthorError(
                    f"the parameter {parameter.name!r} of its template {template.iri.short} needs a value, and the task"
                    " that holds it sets none"
                )
        bound = tasks.bind(self.task, list(values.items()))
        return Composer(tasks.complete(bound), self.hierarchy, outside=self.composite)

    def configured(
        self, ecology: Mapping[IRI, Advertisement], holder: Configuration, held: Mapping[IRI, Holder]
    ) -> Configuration | str:
        """The inside in an ecology, with the values that a configuration sets it to; or why there is none.

        It does without components that are `held`, unless they can be shared by what wants the same of them.
        """
        values = {one.name: one.value for one in holder.settings if one.component == self.composite}
        unfed = self.optional - {one.input for one in holder.connections if one.sink == self.composite}
        try:
            composer = self.composer_with(values)
            composer.leave_unfed(unfed)
            shared = {one: user for one, user in held.items() if ecology[one].profile.is_shareable}
            alone = held.keys() - shared
            outcome, _ = agreed(lambda without: composer.compose(ecology, without | alone, None), shared)
        except SelfconfError as error:
            return str(error)
        if isinstance(outcome, Configuration):
            return outcome
        used = ""
        if isinstance(outcome, Refusal):
            usable = composer.usable(held.keys(), outcome)
            outcome = outcome.told_of_held(usable)
            used = "".join(f"; {one.short} acts for {held[one].name}" for one in sorted(usable)[:MANY])
        unfed_ones = ", ".join(port_in_words(name).removeprefix("the ") for name in sorted(unfed))
        lacking = f"; no component feeds its optional {unfed_ones}" if unfed else ""
        return f"its inside cannot be configured now: {why_none(outcome)}{used}{lacking}"


def insides(
    known: Mapping[IRI, Advertisement],
    document_of: DocumentOf,
    configuration: Configuration,
    hierarchy: Hierarchy = NOTHING_ABOVE,
) -> Iterator[tuple[IRI, Configuration | str]]:
    """Yield what the composites of a configuration are inside, from given advertisements, or why that is nothing.

    Composites inside of these follow each after the one that holds it. The roles of the insides see `hierarchy`. None
    has what the configuration or an inside before it holds, unless that can be shared.
    """
    found, why = configurable(known, document_of, hierarchy)
    held = _held_by(configuration, configuration.template.short)
    waiting = [(component, configuration) for component in configuration.components]
    while waiting:
        component, holder = waiting.pop(0)
        if component in why:
            yield component, why[component]
        elif component in found:
            others = {one: a for one, a in known.items() if one != component and one not in why}
            taken = {one: user for one, user in held.items() if one in others}
            inside = found[component].configured(others, holder, taken)
            yield component, inside
            if isinstance(inside, Configuration):
                held = _held_by(inside, component.short) | held
                waiting = [*((one, inside) for one in inside.components), *waiting]


def _held_by(configuration: Configuration, name: str) -> dict[IRI, Holder]:
    """The components of a configuration, each held by a task of that name."""
    return {one: Holder(name, wants=configuration.wants(one)) for one in configuration.components}


def configurable(
    known: Mapping[IRI, Advertisement],
    document_of: DocumentOf,
    hierarchy: Hierarchy = NOTHING_ABOVE,
    whence: str = "",
) -> tuple[dict[IRI, Inside], dict[IRI, str]]:
    """The composites whose inside can be configured, and of the others why not.

    `whence` says in these sentences where what is advertised comes from, if there may be more elsewhere.
    """
    found: dict[IRI, Inside] = {}
    why: dict[IRI, str] = {}
    readers: dict[int, InsideReader] = {}  # by the identity of the document, of which one may advertise many
    for component, advertisement in known.items():
        if advertisement.profile.inside is not None:
            try:
                document = document_of(advertisement)
                reader = readers.setdefault(id(document), InsideReader(document))
                found[component] = Inside.of(advertisement.profile, reader, hierarchy)
            except SelfconfError as error:
                why[component] = str(error)
    composers = {one: inside.composer for one, inside in found.items()}
    why |= _in_circles(composers, known)
    # A composite that does not live cannot be inside of another one: again and again, until all that are left can.
    while lacking := _refused({one: c for one, c in composers.items() if one not in why}, known, whence):
        why |= lacking
    return {one: inside for one, inside in found.items() if one not in why}, why


def _in_circles(composers: Mapping[IRI, Composer], known: Mapping[IRI, Advertisement]) -> dict[IRI, str]:
    """The composites that could be inside of themselves, each with a sentence."""
    # Itself is left out of the inside of each, so only a way by others leads back.
    within = {one: _may_hold(composer, known) & (composers.keys() - {one}) for one, composer in composers.items()}
    circles = {one: " of ".join(each.short for each in _way_back(one, within)) for one in composers}
    sentence = "it could be inside of itself ({}); a composite of itself has no end"
    return {one: sentence.format(circle) for one, circle in circles.items() if circle}


def _refused(composers: Mapping[IRI, Composer], known: Mapping[IRI, Advertisement], whence: str) -> dict[IRI, str]:
    """The composites whose inside cannot be configured beside the others, each with a sentence."""
    able = {one: a for one, a in known.items() if a.profile.inside is None or one in composers}
    found: dict[IRI, str] = {}
    for component, composer in composers.items():
        others = {one: advertisement for one, advertisement in able.items() if one != component}
        outcome = composer.compose(others, frozenset(), None)
        if not isinstance(outcome, Configuration):
            itself = "; it cannot be inside of itself" if component in _may_hold(composer, known) else ""
            found[component] = f"its inside cannot be configured now{whence}: {why_none(outcome)}{itself}"
    return found


def _may_hold(composer: Composer, known: Mapping[IRI, Advertisement]) -> set[IRI]:
    """The components that could be inside of a composite, if it were no matter that one of them is itself."""
    ecology = dict(known)
    roles = composer.partition(ecology).candidates[:-1]
    return composer.recruitable(ecology).union(candidate.profile.component for some in roles for candidate in some)


def _way_back(component: IRI, within: Mapping[IRI, set[IRI]]) -> list[IRI]:
    """A way from a composite by what could be inside to itself; nothing if there is none."""
    came: dict[IRI, IRI] = {}
    waiting = [component]
    while waiting:
        one = waiting.pop(0)
        for other in sorted(within.get(one, ())):
            if other == component:
                way = [component, one]
                while way[-1] != component:
                    way.append(came[way[-1]])
                return way
            if other not in came:
                came[other] = one
                waiting.append(other)
    return []


def _check_ports(profile: Profile, inside: TaskDocument) -> None:
    """Raise AuthorError where the ports of a composite are not those of its template."""
    template = inside.template
    for ports, is_input, word in ((profile.inputs, True, "input"), (profile.outputs, False, "output")):
        own = {port.name: port.port for port in template.ports if port.is_input is is_input}
        other = sorted({port.name for port in ports} ^ own.keys())
        if other:
            raise AuthorError(f"its {word}s and those of the template {template.iri.short} differ: {', '.join(other)}")
        for port in ports:
            if _carried(port) != _carried(own[port.name]) or not _agree(port, own[port.name]):
                raise AuthorError(
                    f"its {word} {port.name!r} is {_in_words(port)}, and that of the template {template.iri.short} is"
                    f" {_in_words(own[port.name])}"
                )


def _carried(port: Input | Output) -> tuple[object, ...]:
    """What two ports have to have in common of which one stands for the other."""
    return port.signals, port.request


def _agree(one: Input | Output, other: Input | Output) -> bool:
    """Whether two ports have one unit and one frame, as far as both say it."""
    pairs = zip(_unit_and_frame(one), _unit_and_frame(other), strict=True)
    return all(None in pair or pair[0] == pair[1] for pair in pairs)


def _with_stated(profile: Profile, inside: TaskDocument) -> TaskDocument:
    """The inside with the units and frames that the composite states of its ports, where its template states none.

    What stands behind a port is connected with what is outside, which goes by what the composite states.
    """
    template = inside.template
    ports = tuple(replace(one, port=_stated(one.port, profile)) for one in template.ports)
    return replace(inside, task=replace(inside.task, template=replace(template, ports=ports)))


def _stated(port: Input | Output, profile: Profile) -> Input | Output:
    """A port of a template with the unit and the frame that a composite states of it, where itself states none."""
    if port.is_operation:
        return port
    some: Iterable[Input | Output] = profile.inputs if isinstance(port, Input) else profile.outputs
    own, known = _unit_and_frame(port), next(_unit_and_frame(one) for one in some if one.name == port.name)
    unit, frame = own[0] or known[0], own[1] or known[1]
    if isinstance(port, Output):
        return port._replace(unit=unit, frame=frame)
    return port._replace(condition=Condition(unit, frame) if unit or frame else None)


def _unit_and_frame(port: Input | Output) -> tuple[IRI | None, Term | None]:
    unit, frame, *_ = (port.condition or Condition()) if isinstance(port, Input) else (port.unit, port.frame)
    return unit, frame


def _in_words(port: Input | Output) -> str:
    return str(port.wanted if isinstance(port, Input) else port)


def _check_parameters(later: frozenset[str], inside: TaskDocument) -> None:
    """Raise AuthorError where parameters of a composite are none of its template, or have a value already.

    And where a parameter of the template has no value, nor will get one.
    """
    task, template = inside.task, inside.template
    known = {parameter.name: parameter for parameter in template.parameters}
    for name in sorted(later):
        if name not in known:
            raise AuthorError(f"its parameter {name!r} is none of the template {template.iri.short}")
        if known[name].iri in task.bindings:
            raise AuthorError(f"its grounding binds {name!r}, and it has it as an operational parameter as well")
    for name, parameter in known.items():
        lacks = parameter.iri not in task.bindings and parameter.default is None and name not in later
        if lacks and parameter.is_set and not parameter.in_shape:
            raise AuthorError(
                f"the parameter {name!r} of the template {template.iri.short} has no value; bind it in the grounding,"
                " or have it as an operational parameter of the composite"
            )


def why_none(refusal: Refusal | Undecided | None) -> str:
    """Why there is no configuration, in a sentence, and which tasks hold what is lacking."""
    if isinstance(refusal, Refusal) and refusal.reasons:
        held = [f"; {component.short}: {holder_text(holder)}" for component, holder in refusal.held[:MANY]]
        more = f"; and {len(refusal.held) - MANY} more are held" if len(refusal.held) > MANY else ""
        return "".join((str(refusal.reasons[0]), *held, more))
    return str(refusal) if isinstance(refusal, Undecided) else "it was taken down"
