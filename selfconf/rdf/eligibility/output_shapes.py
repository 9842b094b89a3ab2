"""The shape that an input asks of outputs (`sc:accepts`), and whether an output conforms to it.

A shape is judged as the shape of a role is: what can be compiled needs no graph, and pySHACL judges the rest. Here the
node that is looked at is an output, so that a path is walked first, and the tests see its ends as the values of a
property of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.obstacle import NotJudged, Obstacle, ShapeViolated
from selfconf.model.profile import Output, Profile
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf.advertisements import shape_text
from selfconf.rdf.eligibility.compiled_roles import compile_role
from selfconf.rdf.eligibility.node_paths import WalkedStatements
from selfconf.rdf.eligibility.supposed_conformance import could_conform
from selfconf.rdf.shacl import PAIRS, misfit
from selfconf.rdf.turtle import Document, Node, Triple, parse
from selfconf.rdf.vocabulary import SC, SH, TYPE

_SHAPE = IRI("urn:selfconf:acceptance:shape")
_OUTPUT = IRI("urn:selfconf:acceptance:output")
"""What an output is called that has no IRI."""
_PATH = "urn:selfconf:acceptance:path:"
Port = tuple[IRI, str]
"""A component, and the name of an output of it."""
Looks = tuple[tuple[tuple[Term, ...], ...], frozenset[IRI], IRI]
"""What a shape sees of an output: where each of its paths leads, the types, and its IRI if it has one."""
Seen = Callable[[IRI], Sequence[Triple]]
"""For a component what a shape sees of its advertisement."""


class SeenOutputs:
    """The outputs of an ecology as shapes see them; each is looked at once for each path, by however many shapes."""

    def __init__(self, seen: Seen) -> None:
        self._seen = seen
        self._triples: dict[IRI, Sequence[Triple]] = {}
        self._statements: dict[IRI, WalkedStatements] = {}
        self._values: dict[tuple[str, Port], tuple[Term, ...]] = {}
        self._alike: dict[tuple[tuple[str, ...], int], dict[Looks, list[Port]]] = {}

    def triples(self, component: IRI) -> Sequence[Triple]:
        """What a shape sees of an advertisement, with the same blank nodes each time."""
        if component not in self._triples:
            self._triples[component] = self._seen(component)
        return self._triples[component]

    def node(self, port: Port) -> Node:
        """The node of an output."""
        return _node(self.triples(port[0]), *port)

    def alike(self, paths: Sequence[tuple[str, Document, Term]], outputs: Sequence[Port]) -> dict[Looks, list[Port]]:
        """Outputs by what some paths, each with its text, lead to from them, and by their types."""
        key = tuple(text for text, _, _ in paths), id(outputs)
        if key not in self._alike:
            found: dict[Looks, list[Port]] = {}
            for port in outputs:
                ends = tuple(self._ends(text, document, path, port) for text, document, path in paths)
                node = self.node(port)
                iri = node if isinstance(node, IRI) else _OUTPUT
                found.setdefault((ends, self._types(port), iri), []).append(port)
            self._alike[key] = found
        return self._alike[key]

    def _ends(self, text: str, document: Document, path: Term, port: Port) -> tuple[Term, ...]:
        if (text, port) not in self._values:
            ends = self._walked(port).walked(document, path, self.node(port))
            self._values[text, port] = tuple(sorted(ends, key=sort_key))
        return self._values[text, port]

    def _types(self, port: Port) -> frozenset[IRI]:
        types = self._walked(port).values(self.node(port), TYPE)
        return frozenset(value for value in types if isinstance(value, IRI))

    def _walked(self, port: Port) -> WalkedStatements:
        component = port[0]
        if component not in self._statements:
            self._statements[component] = WalkedStatements(self.triples(component))
        return self._statements[component]


class OutputShape:
    """The shape that an input accepts, compiled."""

    def __init__(self, text: str, hierarchy: Hierarchy) -> None:
        """`text` is the shape as Turtle in brackets. Raises AuthorError."""
        self._hierarchy = hierarchy
        self._document = parse(f"<{_SHAPE}> {text[1:-1]} .", "sc:accepts")
        wrong = misfit(self._document, self._document.triples(), frozenset())
        if wrong is not None:
            raise TemplateError(wrong[1], file="sc:accepts")
        self._names: dict[Term, IRI] = {}
        """For each path of the shape, or property that values are compared to, what the tests see in its place."""
        named = {subject: [*map(self._renamed, said)] for subject, said in self._document.statements.items()}
        self._paths = [(shape_text(self._document, path), self._document, path) for path in self._names]
        self._tests = compile_role(Document("sc:accepts", named, {}), _SHAPE, (), frozenset())

    def _renamed(self, statement: tuple[IRI, Term]) -> tuple[IRI, Term]:
        predicate, value = statement
        if predicate != SH.path and predicate not in PAIRS:
            return statement
        # The last segment of the name is how an obstacle calls the property.
        steps = ".".join(step.short for step in _steps(self._document, value))
        return predicate, self._names.setdefault(value, IRI.unchecked(f"{_PATH}{len(self._names)}#{steps}"))

    def conforming(
        self, outputs: Sequence[Port], seen: SeenOutputs, not_judged: dict[Port, NotJudged] | None = None
    ) -> set[Port]:
        """The outputs, among some, that conform; those that cannot be judged are noted in `not_judged`.

        Raises TemplateError where none can be judged, as then it is the shape that is at fault.
        """
        passed: list[Port] = []
        obstacles: list[Obstacle | None] = []
        for looks, some in seen.alike(self._paths, outputs).items():
            obstacle = self._obstacle(looks)
            obstacles.append(obstacle)
            if obstacle is None:
                passed += some
            elif isinstance(obstacle, NotJudged) and not_judged is not None:
                not_judged.update(dict.fromkeys(some, obstacle))
        _raise_where_none_is_judged(obstacles)
        if self._tests.complete or not passed:
            return {*passed}
        wrong = self._by_pyshacl(passed, seen)
        if len(wrong) == len(passed):
            _raise_where_none_is_judged([*chain.from_iterable(wrong.values())])
        if not_judged is not None:
            not_judged |= {port: one for port, (one, *_) in wrong.items() if isinstance(one, NotJudged)}
        return {port for port in passed if port not in wrong}

    def possible_for(self, output: Output, named: bool) -> bool:
        """Whether an output could conform that states so much, by the name that it has if it is `named`."""
        names = {path: name for path, name in self._names.items() if isinstance(path, IRI)}
        return could_conform(self._tests.tests, names, output, named, self._hierarchy)

    @property
    def of_component(self) -> frozenset[IRI] | None:
        """The properties of the component of an output that the shape looks at; None if these may be any."""
        found = set[IRI]()
        for path in self._names:
            steps = [*_steps(self._document, path)]
            if SC.hasOutput in steps:
                found.update(steps[steps.index(SC.hasOutput) + 1 :])
                if steps[-1] == SC.hasOutput:
                    return None
        return frozenset(found)

    def obstacle(self, output: Port, seen: SeenOutputs) -> Obstacle | None:
        """What keeps an output from conforming, if anything does. Raises TemplateError where that cannot be judged."""
        (looks,) = seen.alike(self._paths, [output])
        found = self._obstacle(looks)
        if found is None and not self._tests.complete:
            wrong = self._by_pyshacl([output], seen).get(output, [])
            _raise_where_none_is_judged(wrong)
            return next(iter(wrong), None)
        return found

    def _obstacle(self, looks: Looks) -> Obstacle | None:
        """The first obstacle that outputs which look alike meet in the tests."""
        ends, types, iri = looks
        pairs = [(name, value) for name, values in zip(self._names.values(), ends, strict=True) for value in values]
        # The tests look at the profile of a component, so that is what an output has to look like.
        return next(iter(self._tests.obstacles(Profile(iri, types, tuple(pairs)), self._hierarchy)), None)

    def _by_pyshacl(self, outputs: Sequence[Port], seen: SeenOutputs) -> dict[Port, list[ShapeViolated | NotJudged]]:
        """What pySHACL finds to keep outputs from conforming; nothing of those that conform."""
        from selfconf.rdf.conformance import violations  # most shapes are compiled in full: pySHACL is not loaded
        from selfconf.rdf.rdflib_terms import to_rdflib

        shapes = to_rdflib(self._document.triples())
        own: dict[IRI, dict[Port, Node]] = {}
        for port in outputs:
            own.setdefault(port[0], {})[port] = seen.node(port)
        found: dict[Port, list[ShapeViolated | NotJudged]] = {}
        for component, nodes in own.items():
            # What another component says is not seen, so that no shape judges other components.
            data = to_rdflib(seen.triples(component))
            wrong = violations(data, shapes, _SHAPE, list(nodes.values()), "sc:accepts", "the shape")
            found |= {port: wrong[node] for port, node in nodes.items() if node in wrong}
        return found


def _raise_where_none_is_judged(found: Sequence[object]) -> None:
    """Raises TemplateError where no output can be judged by a shape: then no output is to blame, but the shape."""
    reasons = [one.reason for one in found if isinstance(one, NotJudged)]
    if found and len(reasons) == len(found):
        raise TemplateError(reasons[0], file="sc:accepts")


def _steps(document: Document, path: Term) -> Iterator[IRI]:
    """The properties that a path names, in their order."""
    if isinstance(path, IRI):
        yield path
    for item in document.items(path) or [value for _, value in document.about(path)]:
        yield from _steps(document, item)


def _node(triples: Sequence[Triple], component: IRI, name: str) -> Node:
    """The node of an output of a component."""
    outputs = {value for subject, link, value in triples if subject == component and link == SC.hasOutput}
    return next(
        subject
        for subject, predicate, value in triples
        if predicate == SC.name and subject in outputs and str(value) == name
    )
