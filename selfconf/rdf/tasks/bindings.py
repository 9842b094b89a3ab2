"""Values for the parameters of a template: reading them from a command line, checking them, filling in defaults."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain

import pyoxigraph as ox

from selfconf.errors import BindingError
from selfconf.model.curie import SCHEMES, is_local_name, is_prefix, suggested_local_name
from selfconf.model.immutable import replace
from selfconf.model.literal_values import in_lexical_space, number_of, truth
from selfconf.model.setting_names import binding
from selfconf.model.template import Parameter, Template
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.model.wording import in_full
from selfconf.rdf import turtle
from selfconf.rdf.shacl import LITERAL, misfit
from selfconf.rdf.tasks.parameters import misfits
from selfconf.rdf.tasks.roles import mentions, shape_statements, shape_triples, substituted
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import RDF, SC, SH, XSD

_LOCAL_PART = re.compile(r"[^\s\"'<>()]*")
_PATHS = frozenset((SH.path, SH.inversePath, SH.alternativePath, SH.zeroOrMorePath, SH.oneOrMorePath, SH.zeroOrOnePath))
_LISTS = frozenset((SH.languageIn, SH.ignoredProperties))
_NAMING = frozenset((SH.equals, SH.disjoint, SH.lessThan, SH.lessThanOrEquals, SH.datatype, SH.nodeKind))
"""What has the name of a property, a datatype or a kind of node as its value, which no component states as one."""
_LATER = IRI("urn:selfconf:later")
"""What stands for a value that is set later."""
_NUMBERS = frozenset((XSD.integer, XSD.decimal, XSD.double, XSD.float))
"""The datatypes of a number as Turtle, Python and NumPy write it, of which nothing more is meant."""
_NUMBER_OR_BOOLEAN = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?|true|false")


def read_term(text: str, prefixes: Mapping[str, str]) -> Term:
    """A CURIE in those prefixes, an `<IRI>` or a Turtle literal; plain words are a string. Raises BindingError."""
    words = text.strip()
    if _NUMBER_OR_BOOLEAN.fullmatch(words) or words[:1] in ("<", '"', "'"):
        return _turtle_term(words, prefixes)
    prefix, colon, name = words.partition(":")
    if colon and is_prefix(prefix) and _LOCAL_PART.fullmatch(name):
        if prefix in prefixes:
            return _turtle_term(words, prefixes)
        if prefix in SCHEMES:
            raise BindingError(f"{words} looks like an IRI; write it in angle brackets: '<{words}>'")
        known = ", ".join(f"{name}:" for name in sorted(prefixes)) or "none"
        string = Literal(words).turtle(str)
        raise BindingError(f"the template declares no prefix {prefix}: (it has {known}); for a string write '{string}'")
    return Literal(text)


def _turtle_term(words: str, prefixes: Mapping[str, str]) -> Term:
    head = "".join(f"@prefix {name}: <{iri}> .\n" for name, iri in prefixes.items())
    try:
        quads = list(ox.parse(f"{head}<urn:s> <urn:p> {words} .", format=ox.RdfFormat.TURTLE))
    except SyntaxError:
        quads = []
    if len(quads) != 1 or isinstance(quads[0].object, ox.Triple):
        raise BindingError(f"{words} is no Turtle term; write a CURIE, an <IRI>, a literal or plain words")
    return turtle.term(quads[0].object)


def bind(given: TaskDocument, assignments: Iterable[tuple[str, str | Term]]) -> TaskDocument:
    """The task with values for its parameters by name, as text or as terms.

    A number takes the datatype of numbers that its parameter asks for: `0.5` is a decimal in Turtle and a double in
    Python and TOML, and stands for a parameter of either. Raises BindingError for what cannot be bound.
    """
    task, document = given.task, given.document
    by_name = {parameter.name: parameter for parameter in task.template.parameters}
    bindings = dict(task.bindings)
    for name, value in assignments:
        parameter = by_name.get(name)
        if parameter is None:
            known = ", ".join(sorted(by_name)) or "none"
            raise BindingError(f"the template has no parameter {name!r}; it has: {known}", parameter=name)
        if parameter.iri in bindings:
            raise BindingError(f"the parameter {name!r} is bound twice", parameter=name)
        _writable(name, value)
        term = value if isinstance(value, IRI | Literal | BlankNode) else read_term(value, document.prefixes)
        _well_typed(name, term)
        bindings[parameter.iri] = _as_asked(term, document.value(parameter.iri, SH.datatype))
    return TaskDocument(replace(task, bindings=bindings), document)


def _as_asked(value: Term, datatype: Term | None) -> Term:
    """A number in the datatype of numbers that is asked for, if it can be written in that; any other value as it is."""
    if not isinstance(value, Literal) or value.datatype not in _NUMBERS or not isinstance(datatype, IRI):
        return value
    return value if number_of(value.lexical, datatype) is None else _written_as(value, datatype)


def _written_as(value: Literal, datatype: IRI) -> Literal:
    """The literal of a datatype that is written like another literal; Turtle has a point in each decimal."""
    whole = datatype == XSD.decimal and value.datatype == XSD.integer
    return Literal(f"{value.lexical}.0" if whole else value.lexical, datatype)


def _writable(name: str, value: str | Term) -> None:
    """Raises BindingError for the value of a parameter that cannot be written in UTF-8.

    What was typed in another encoding, as `$'\\xff'`, arrives as half a character, which no other program takes.
    """
    try:
        str(value).encode()
    except UnicodeEncodeError:
        raise BindingError(f"the value of {name!r} is no text in UTF-8: {str(value)!r}", parameter=name) from None


def _well_typed(name: str, value: Term) -> None:
    """Raises BindingError for a literal that is none of its datatype, as `"abc"^^xsd:integer`."""
    if not isinstance(value, Literal) or _is_plain(value):
        return
    from selfconf.rdf import literal_comparison  # loads rdflib, which few values need

    if not literal_comparison.well_typed(value):
        said = in_full([value])
        problem = f"it is no {value.datatype.short}"
        raise BindingError(f"{said} cannot stand for the parameter {name!r}: {problem}", parameter=name)


def _is_plain(value: Literal) -> bool:
    """Whether a literal is certainly one of its datatype, as most are."""
    if value.datatype in _NUMBERS:
        return in_lexical_space(value.lexical, value.datatype)
    return value.datatype == STRING or truth(value) is not None


def complete(given: TaskDocument, later: Container[str] = ()) -> TaskDocument:
    """The task with defaults filled in and every value checked against its parameter. Raises BindingError.

    In what roles set and in the cost of the template, the types of parameters and the properties that are parameters
    themselves are replaced by their values; those in shapes are replaced by the readers of the shapes.

    The parameters that are named in `later` get their values when the task begins. Until then those stay free that
    stand in shapes, though roles may set something to them as well, those that are only set stand for their values
    themselves, and those that cannot be free have defaults.
    """
    task, document = given.task, given.document
    bindings = dict(task.bindings)
    rigid = _RigidPlaces(given)
    for parameter in task.template.parameters:
        if parameter.iri not in bindings:
            if parameter.name in later and rigid.first(parameter) is None:
                bindings |= {} if parameter.in_shape else {parameter.iri: parameter.iri}
                continue
            if parameter.default is not None:
                bindings[parameter.iri] = parameter.default
            elif parameter.is_set and not parameter.in_shape:
                raise BindingError(
                    f"the parameter {parameter.name!r} needs a value; give it with {binding(parameter.name)}",
                    parameter=parameter.name,
                )
            elif place := rigid.first(parameter):
                raise BindingError(
                    f"the parameter {parameter.name!r} cannot be left free, for it stands in {place}; "
                    f"give it a value with {binding(parameter.name)}",
                    parameter=parameter.name,
                )
        if parameter.iri in bindings:
            _check(parameter, bindings[parameter.iri], document)
    _check_shapes(task.template, bindings, document)
    template = _with_values(task.template, bindings)
    free = {one.iri for one in template.parameters if one.name in later and one.iri not in bindings}
    return TaskDocument(replace(task, template=_set_later(template, free), bindings=bindings), document)


def _set_later(template: Template, parameters: Container[Term]) -> Template:
    """A template in which roles that set something to one of some parameters need no value for it yet."""
    return replace(
        template,
        roles=tuple(
            replace(
                role,
                settings=tuple(replace(one, value=_LATER) if one.value in parameters else one for one in role.settings),
            )
            for role in template.roles
        ),
        parameters=tuple(replace(one, is_set=False) if one.iri in parameters else one for one in template.parameters),
    )


def _check_shapes(template: Template, bindings: Mapping[IRI, Term], document: Document) -> None:
    """Raises BindingError where a shape of a template would be none with the values of its parameters."""
    values = {one.iri: bindings[one.iri] for one in template.parameters if one.iri in bindings}
    names = {one.iri: one.name for one in template.parameters}
    free = frozenset[Term](names.keys() - values.keys())
    for node, whose in _shapes(template, document) if values else ():
        if not mentions(document, node, frozenset(values)):
            continue
        shape: dict[Node, list[tuple[IRI, Term]]] = {}
        for subject, predicate, value in shape_triples(document, node):
            shape.setdefault(subject, []).append((predicate, value))
        bound = substituted(replace(document, statements=shape), values)
        wrong = misfit(bound, bound.triples(), free)
        if wrong is not None:
            raise BindingError(_misfit_in_words(wrong, shape, names, whose))


def _shapes(template: Template, document: Document) -> Iterator[tuple[Node, str]]:
    """Yield the shapes of a template, of its roles and of what these recruit, each with words for whose it is."""
    for role in template.roles:
        yield role.iri, f"the role {role.iri!r}"
        for shape in document.values(role.iri, SC.recruits):
            if not isinstance(shape, Literal):
                yield shape, f"what the role {role.iri!r} recruits"


def _misfit_in_words(
    wrong: tuple[Triple, str], shape: Mapping[Node, list[tuple[IRI, Term]]], names: Mapping[IRI, str], whose: str
) -> str:
    """A sentence about a statement of a shape that is none with the values of parameters."""
    (subject, predicate, value), problem = wrong
    named = [name for iri, name in names.items() if (predicate, iri) in shape[subject]]
    if named:
        what = f"{in_full([value])} cannot stand for the parameter {named[0]!r} in the shape of {whose}"
    else:
        what = f"with these values the shape of {whose} is not well-formed"
    return f"{what}: {_plain(problem)}"


def _with_values(template: Template, bindings: Mapping[IRI, Term]) -> Template:
    """A template with parameters replaced that stand for a type that a role sets or a property that a cost counts.

    Raises BindingError where a value is no IRI, or where a role would set the parameters of one type to two values.
    """
    names = {parameter.iri: parameter.name for parameter in template.parameters}

    def value_of(iri: IRI, predicate: IRI) -> IRI:
        value = bindings.get(iri, iri)
        if not isinstance(value, IRI):
            problem = f"it stands for a sc:{predicate.short}, which is an IRI"
            raise BindingError(f"{in_full([value])} cannot stand for the parameter {names[iri]!r}: {problem}")
        return value

    roles = []
    for role in template.roles:
        replaced = (replace(one, type=value_of(one.type, SC.parameterType)) for one in role.settings)
        settings = tuple(dict.fromkeys(replaced))
        for kind, times in Counter(one.type for one in settings).items():
            if times > 1:
                raise BindingError(f"with these values the role {role.iri!r} sets {kind!r} to {times} different values")
        roles.append(replace(role, settings=settings))
    cost = tuple(
        tuple(replace(term, property=value_of(term.property, SC.property)) for term in level) for level in template.cost
    )
    return replace(template, roles=tuple(roles), cost=cost)


class _RigidPlaces:
    """Where the parameters of a task stand that no value is searched for, gathered once for all of them.

    These are those properties of a role's shape that ask for a literal, paths, lists of languages and of properties,
    `sc:recruits`, the types of what roles set, and the properties that a cost counts; and those that ask for a name,
    where the parameter lists no values.
    """

    def __init__(self, given: TaskDocument) -> None:
        self._given = given

    def first(self, parameter: Parameter) -> str | None:
        """Return the first property by which a parameter stands so, as it is written; None if there is none."""
        listed = bool(self._given.document.values(parameter.iri, SH["in"]))
        places = self._places.get(parameter.iri, ())
        return next((f"{prefix}:{one.short}" for prefix, one in places if not (listed and one in _NAMING)), None)

    @cached_property
    def _places(self) -> Mapping[Term, Sequence[tuple[str, IRI]]]:
        """For each parameter the properties by which it stands so, in order, each with its prefix."""
        document, template = self._given.document, self._given.template
        found: dict[Term, list[tuple[str, IRI]]] = {parameter.iri: [] for parameter in template.parameters}

        def note(value: Term, prefix: str, place: IRI) -> None:
            if value in found:
                found[value].append((prefix, place))

        for term in chain.from_iterable(template.cost):
            note(term.property, "sc", SC.property)
        for role in template.roles:
            for setting in role.settings:
                note(setting.type, "sc", SC.parameterType)
            for predicate, value in shape_statements(document, role.iri):
                if predicate in LITERAL | _NAMING:
                    note(value, "sh", predicate)
                for step in _steps(document, value) if predicate in _PATHS | _LISTS else ():
                    note(step, "sh", predicate)
            for shape in document.values(role.iri, SC.recruits):
                for _, value in () if isinstance(shape, Literal) else shape_statements(document, shape):
                    note(value, "sc", SC.recruits)
        return found


def _steps(document: Document, path: Term) -> set[Term]:
    """A path, and the paths that it has in a row or as alternatives, in lists."""
    found, waiting = set[Term](), [path]
    while waiting:
        step = waiting.pop()
        if step not in found:
            found.add(step)
            waiting += document.items(step)
    return found


def _check(parameter: Parameter, value: Term, document: Document) -> None:
    for problem in misfits(parameter, (value,), document).values():
        name = partial(_curie, prefixes=document.prefixes)
        said = value.turtle(name) if isinstance(value, Literal) else in_full([value])
        hint = ""
        if isinstance(value, Literal) and "IRI" in problem:
            local = value.lexical if is_local_name(value.lexical) else suggested_local_name(value.lexical)
            home = parameter.iri[: max(parameter.iri.rfind("#"), parameter.iri.rfind("/")) + 1]
            named = name(IRI.unchecked(f"{home}{local or 'kitchen'}"))
            hint = "; write an <IRI>" if named.startswith("<") else f"; write a CURIE such as {named}, or an <IRI>"
        elif (meant := _meant(parameter, value, document)) is not None:
            hint = f"; write {binding(parameter.name, meant.turtle(name))}"
        raise BindingError(
            f"{said} cannot stand for the parameter {parameter.name!r}: {_plain(problem)}{hint}",
            parameter=parameter.name,
        )


def _meant(parameter: Parameter, value: Term, document: Document) -> Literal | None:
    """The literal of the datatype that a parameter asks for, if it would do instead of one of another.

    What asks for a language is shown English.
    """
    datatype = document.value(parameter.iri, SH.datatype)
    if not isinstance(value, Literal) or not isinstance(datatype, IRI) or value.datatype in (datatype, XSD.double):
        return None
    meant = Literal(value.lexical, datatype, "en") if datatype == RDF.langString else _written_as(value, datatype)
    return None if misfits(parameter, (meant,), document) else meant


def _curie(iri: IRI, prefixes: Mapping[str, str]) -> str:
    """An IRI as the command line takes it."""
    for name, base in prefixes.items():
        if iri.startswith(base) and is_local_name(iri[len(base) :]):
            return f"{name}:{iri[len(base) :]}"
    return f"<{iri}>"


def _plain(message: str) -> str:
    return message[0].lower() + message[1:] if message else "it does not conform"


def free_parameters(template: Template, bindings: Mapping[IRI, Term]) -> frozenset[IRI]:
    """The parameters that are left unbound: the variables of the search."""
    return frozenset(parameter.iri for parameter in template.parameters if parameter.iri not in bindings)
