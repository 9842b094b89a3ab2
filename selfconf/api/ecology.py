"""An ecology: what it holds, and the questions that can be put to it, wherever its advertisements are."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, overload

from selfconf.api.arguments import checked_rows, checked_seconds
from selfconf.api.places import with_lines
from selfconf.api.tables import Tabular
from selfconf.errors import ProgrammerError
from selfconf.http_origin import check_without_user
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.holder import Holder
from selfconf.model.immutable import FrozenMapping, immutable, replace
from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.model.wording import counted, plain
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import AdvertisementIndex, Partitioner
from selfconf.rdf.sparql import Dataset
from selfconf.rdf.vocabulary import RDF, SC
from selfconf.render import html_table, short

if TYPE_CHECKING:
    from selfconf.query import Question, Shown


@immutable
class Components(Tabular, Mapping[IRI, Profile]):
    """The components of an ecology by IRI, each with its profile; prints as a table."""

    _advertisements: Mapping[IRI, Advertisement]
    __repr__ = Tabular.__repr__

    def __eq__(self, other: object) -> bool:
        return Mapping.__eq__(self, other)  # as any mapping is

    def __getitem__(self, component: IRI) -> Profile:
        return self._advertisements[component].profile

    def __iter__(self) -> Iterator[IRI]:
        return iter(self._advertisements)

    def __len__(self) -> int:
        return len(self._advertisements)

    def _head(self) -> Sequence[str]:
        return "component", "types", "inputs", "outputs"

    def _cells(self) -> Iterator[list[str]]:
        for profile in (self[component] for component in sorted(self)):
            yield [
                short(profile.component),
                ", ".join(sorted(short(kind) for kind in profile.types - {SC.Component})),
                ", ".join(port.name for port in profile.inputs),
                ", ".join(port.name for port in profile.outputs),
            ]


@immutable
class Solutions(Tabular, Sequence[Mapping[str, Term]]):
    """The solutions of a SELECT query, each the values of its variables by name; prints as a table.

    A value is an `IRI`, which is a string, a `BlankNode`, or a `Literal`, whose text is `lexical`, also that of a
    number. A variable that has no value in a solution is left out there.

    >>> (solution,) = read("examples/clock").query("SELECT (COUNT(?c) AS ?n) WHERE { ?c a sc:Component }")
    >>> int(solution["n"].lexical)
    2
    """

    variables: tuple[str, ...]
    _rows: tuple[Mapping[str, Term], ...]
    cut: bool = False
    """Whether there are more solutions than were asked for."""

    @overload
    def __getitem__(self, number: int) -> Mapping[str, Term]: ...

    @overload
    def __getitem__(self, number: slice) -> Sequence[Mapping[str, Term]]: ...

    def __getitem__(self, number: int | slice) -> Mapping[str, Term] | Sequence[Mapping[str, Term]]:
        return self._rows[number]

    def __len__(self) -> int:
        return len(self._rows)

    def _head(self) -> Sequence[str]:
        return self.variables

    def _cells(self) -> Iterator[list[str]]:
        return ([short(row[name]) if name in row else "" for name in self.variables] for row in self._rows)

    def __repr__(self) -> str:
        return Tabular.__repr__(self) if self.variables else counted(len(self), "solution")


class Ecology(ABC):
    """Components that can play in a configuration, wherever their advertisements are: loaded, remote or living.

    >>> home = read("examples/clock")
    >>> home.components
    component  types    inputs  outputs
    ---------  -------  ------  -------
    clock      Clock            time
    display    Display  text
    """

    _left_out: tuple[LeftOut, ...] = ()
    _complaints: tuple[str, ...] = ()
    remote: ClassVar[bool] = False
    """Whether only what a task may want is fetched."""
    read_seconds: float = 0.0
    """How long its advertisements took to be read, where that was before any task."""
    texts: tuple[str, ...] = ()
    """The texts that it was read from and that are in no file, in which lines are looked up."""

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The advertisements that do not count, and why; an answer has those that its question could not judge.

        Each has its line where the file or text can be read again.
        """
        return tuple(with_lines(self._left_out, self.texts)) if self._left_out else ()

    @property
    def complaints(self) -> tuple[str, ...]:
        """What else was left out of the answers of a living ecology, a sentence each."""
        return self._complaints

    @property
    def missing_sites(self) -> tuple[str, ...]:
        """The sites of a living ecology that did not answer the last discovery in full, sorted."""
        return ()

    def close(self) -> None:
        """Leave the ecology, where that means something."""
        return

    @property
    def components(self) -> Components:
        """The components, each with its profile."""
        return Components(self.advertisements())

    def holders(self) -> Mapping[IRI, Holder]:
        """The tasks that hold components, by component; none where nothing runs."""
        return {}

    @abstractmethod
    def advertisements(self) -> Mapping[IRI, Advertisement]:
        """All advertisements by component."""

    def for_task(
        self, partitioner: Partitioner, wider: Hierarchy
    ) -> tuple[Mapping[IRI, Advertisement], tuple[LeftOut, ...]]:
        """The advertisements among which a task looks for components, and those of its question that do not count.

        `wider` is the widest hierarchy that the task may see.
        """
        return self.advertisements(), ()

    def dataset(self) -> Dataset:
        """The ecology as RDF, one named graph for each advertisement."""
        dataset = Dataset()
        dataset.add_advertisements(self.advertisements().values())
        return dataset

    def query(self, sparql: str, *, seconds: float = 60.0, rows: int = 100_000) -> Solutions | bool | str:
        """The answer to a SPARQL 1.1 query: solutions, a truth value, or for CONSTRUCT and DESCRIBE Turtle.

        Runs in a process of its own, which is ended after `seconds`; there are `rows` solutions or triples at most.
        Raises QueryError, and ProgrammerError for what is no text, no time and no number of rows.

        >>> home = read("examples/clock")
        >>> home.query("ASK { ?c a rob:Display }")
        True
        """
        from selfconf.query import Question  # loads what a configuration does not need

        if not isinstance(sparql, str):
            raise ProgrammerError(f"a query is the text of one, not {type(sparql).__name__}")
        question = Question(sparql, "json", checked_rows(rows), seconds=checked_seconds(seconds))
        shown = self.asked(question)
        body = json.loads(shown.text)
        if not isinstance(body, dict) or "head" not in body:  # the JSON-LD of triples
            return self.asked(replace(question, form="turtle")).text
        if "boolean" in body:
            return bool(body["boolean"])
        found = ({name: _term(cell) for name, cell in row.items()} for row in body["results"]["bindings"])
        return Solutions(tuple(body["head"]["vars"]), tuple(map(FrozenMapping, found)), shown.cut)

    def asked(self, question: Question) -> Shown:
        """The answer to a question as text, in the format that it asks for."""
        from selfconf.query import answer

        return answer(self.dataset(), question)

    def __len__(self) -> int:
        return len(self.advertisements())

    def __bool__(self) -> bool:
        return True

    def __repr__(self) -> str:
        return f"<ecology of {counted(len(self), 'component')}>"

    def _repr_html_(self) -> str:
        return self.components._repr_html_()


@immutable
class LoadedEcology(Ecology):
    """An ecology whose advertisements were read from files, text or graphs."""

    _index: AdvertisementIndex
    _left_out: tuple[LeftOut, ...] = ()
    names: tuple[str, ...] = ()
    """What it was read from."""
    read_seconds: float = 0.0
    texts: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def advertisements(self) -> AdvertisementIndex:
        """All advertisements by component, and by the types of the components."""
        return self._index

    def __repr__(self) -> str:
        origin = f" from {', '.join(self.names)}" if self.names else ""
        return plain(f"<ecology of {counted(len(self), 'component')}{origin}>")


@immutable
class EndpointEcology(Ecology):
    """An ecology behind a SPARQL endpoint: it is asked for what a task may want, and for nothing else."""

    url: str
    remote: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Raises AuthorError for a URL with a user name or a password in it."""
        check_without_user(self.url)

    def advertisements(self) -> Mapping[IRI, Advertisement]:
        """Raises ProgrammerError: an endpoint may hold a million of them; ask it by `query`."""
        raise ProgrammerError(f"the ecology at {self.url} is not loaded as a whole; ask it by query()")

    def for_task(
        self, partitioner: Partitioner, wider: Hierarchy
    ) -> tuple[Mapping[IRI, Advertisement], tuple[LeftOut, ...]]:
        """The advertisements of the components that some role of a task may want. Raises NetworkError."""
        from selfconf.query import read_endpoint

        found, left_out = read_endpoint(self.url, (*partitioner.roles, *partitioner.suppliers.values()), wider)
        return found, tuple(left_out)

    def asked(self, question: Question) -> Shown:
        """The answer of the endpoint as text."""
        from selfconf.query import answer

        return answer(Dataset(), replace(question, endpoint=self.url))

    def __len__(self) -> int:
        raise TypeError(f"how many components there are at {self.url} is a question for query()")

    def __repr__(self) -> str:
        return f"<ecology at {self.url}>"

    def _repr_html_(self) -> str:
        return html_table(["endpoint"], [[self.url]])


def _term(cell: Mapping[str, str]) -> Term:
    """A term of SPARQL 1.1 Query Results JSON."""
    if cell["type"] == "uri":
        return IRI.unchecked(cell["value"])
    if cell["type"] == "bnode":
        return BlankNode(f"_:{cell['value']}")
    if "xml:lang" in cell:
        return Literal(cell["value"], RDF.langString, cell["xml:lang"])
    return Literal(cell["value"], IRI.unchecked(cell["datatype"])) if "datatype" in cell else Literal(cell["value"])
