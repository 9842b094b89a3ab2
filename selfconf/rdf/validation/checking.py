"""Validation of many files at once: texts in, a report out.

Two passes. The first reads every file by Oxigraph and learns which terms there are; a file in which
nothing is suspicious has passed then. The second checks the others: places by rdflib's parser,
violations by pySHACL, malformed roles, lints. Each file is judged on its own triples; a configuration also by what
others say of its template and its components (`described_elsewhere`). What the files of a run share besides is only the
knowledge which terms exist, which can make a warning of a term or take it away, which components are described
twice, and which templates in two ways. An ontology is known alike whether it is among the files, given as an
ontology, or ships with selfconf.
"""

from __future__ import annotations

import hashlib
from codecs import BOM_UTF8
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

from selfconf.errors import TurtleError
from selfconf.model.diagnostic import Diagnostic, Report, Severity, report
from selfconf.model.immutable import immutable, replace
from selfconf.rdf import turtle
from selfconf.rdf.validation.prefilter import Prefiltered, SyntaxProblem, prefilter
from selfconf.rdf.validation.term_index import TermIndex, index_of
from selfconf.rdf.validation.text_places import TextPlaces
from selfconf.rdf.validation.undeclared_signals import undeclared_signals

_NOTHING = "There is no component, template, task, configuration or ontology in this file: nothing to validate."
_TO_THE_END = "Line jumps are not allowed"
"""What the parser says of a string without an end, behind which nothing is what it seems."""
MOST_STATEMENTS = 250_000
"""Statements of a file that is checked for the place of each problem, which takes a thousand times as long as reading:
a bound on the work that is known before, and is the same on every machine."""


@immutable
class SourceText:
    """A text with the name to blame it by, and the IRI against which its relative IRIs are resolved."""

    name: str
    octets: bytes
    base: str = "file:///"

    def text(self) -> str:
        """The text without a byte order mark; raises UnicodeDecodeError if it is not UTF-8."""
        return self.octets.removeprefix(BOM_UTF8).decode("utf-8")


@immutable
class UnclearedFile:
    """A file that the prefilter has not cleared."""

    source: SourceText
    elsewhere: dict[str, str] = field(default_factory=dict)
    """Components of it that another file, which is named, describes as well; templates that it describes otherwise."""
    beside: tuple[tuple[SourceText, tuple[str, ...]], ...] = ()
    """The files that describe templates and components of its configurations, each with the IRIs of those."""


@dataclass(frozen=True)
class FileChecker:
    """The check of one file, and all that its outcome depends on besides the file."""

    shapes: tuple[SourceText, ...]
    index: TermIndex

    def __call__(self, uncleared: UnclearedFile) -> list[Diagnostic]:
        """The problems of a file."""
        # rdflib and pySHACL take longer to load than thousands of good files take to pass.
        from selfconf.rdf.validation.file_check import problems_of, shapes_of

        return problems_of(uncleared, shapes_of(*(source.text() for source in self.shapes)), self.index)

    @cached_property
    def knowledge(self) -> bytes:
        """A digest of the shapes and of the terms that are known."""
        ranges = (" ".join((one, *sorted(kinds))) for one, kinds in self.index.ranges.items())
        index = self.index
        known = (index.terms, index.classes, index.properties, index.object_properties, index.covered)
        pairs = (map(" ".join, said) for said in (index.above, index.equal))
        words = "\n\n".join("\n".join(sorted(terms)) for terms in (*known, *pairs, ranges))
        return _digest(*(source.octets for source in self.shapes), words.encode()).digest()

    def key(self, uncleared: UnclearedFile) -> str:
        """A digest of all that the outcome depends on; a memory of outcomes adds the versions of the programs."""
        source = uncleared.source
        elsewhere = repr(sorted(uncleared.elsewhere.items()))
        beside = repr([(other.name, other.base, things) for other, things in uncleared.beside])
        said = (source.name, source.base, elsewhere, beside)
        octets = (source.octets, *(other.octets for other, _ in uncleared.beside))
        return _digest(self.knowledge, *octets, *(text.encode(errors="surrogatepass") for text in said)).hexdigest()


CheckEach = Callable[[FileChecker, Sequence[UnclearedFile]], Iterable[list[Diagnostic]]]
"""Calls a file checker for each uncleared file, in any order and process, or remembers; `map` is one."""


def validate_texts(
    sources: Iterable[SourceText], shapes: Iterable[SourceText], ontologies: Iterable[SourceText], each: CheckEach = map
) -> Report:
    """Every problem of every source; raises TurtleError if an ontology is not Turtle."""
    files = list(sources)
    diagnostics: list[Diagnostic] = []
    seen: dict[str, Prefiltered] = {}
    index = index_of(_loaded(source) for source in ontologies)
    for source in files:
        problems, screened = _read(source)
        diagnostics += problems
        if screened is not None:
            seen[source.name] = screened
            index.learn(screened)
    uncleared = list(_uncleared(files, seen, index))
    sizes = [seen[one.source.name].size for one in uncleared]
    diagnostics += [_too_large(u.source, n) for u, n in zip(uncleared, sizes, strict=True) if n > MOST_STATEMENTS]
    checked = [one for one, size in zip(uncleared, sizes, strict=True) if size <= MOST_STATEMENTS]
    for problems in each(FileChecker(tuple(shapes), index), checked):
        diagnostics += problems
    diagnostics += undeclared_signals(((source.name, source.octets) for source in files), seen, index)
    diagnostics += _irrelevant(seen, {found.file for found in diagnostics})
    return report((source.name for source in files), diagnostics)


def _irrelevant(seen: dict[str, Prefiltered], concerned: set[str]) -> list[Diagnostic]:
    """A warning for each file that says nothing that is validated, and of which nothing else is said."""
    names = [name for name, screened in seen.items() if not screened.relevant and name not in concerned]
    return [Diagnostic(name, 1, 1, "SC-S04", _NOTHING, Severity.WARNING) for name in names]


def described_twice(seen: dict[str, Prefiltered]) -> dict[str, dict[str, str]]:
    """For each file but the first that describes a component: the component, and the file that was first."""
    first: dict[str, str] = {}
    again: dict[str, dict[str, str]] = defaultdict(dict)
    for name in sorted(seen):
        for component in seen[name].components:
            if not component.startswith("_:") and first.setdefault(component, name) != name:
                again[name][component] = first[component]
    return dict(again)


def described_otherwise(seen: dict[str, Prefiltered]) -> dict[str, dict[str, str]]:
    """For each file that describes a template otherwise than the first that does: the template, and that first file.

    Files of tasks and of composites each hold their template, so that copies of one are no mistake.
    """
    first: dict[str, str] = {}
    other: dict[str, dict[str, str]] = defaultdict(dict)
    for name in sorted(seen):
        for template, description in seen[name].templates.items():
            one = first.setdefault(template, name)
            if seen[one].templates[template] != description and not template.startswith("_:"):
                other[name][template] = one
    return dict(other)


def _digest(*parts: bytes) -> hashlib.blake2s:
    """Of some octets, each set off from the next by its length."""
    found = hashlib.blake2s(digest_size=16)
    for part in parts:
        found.update(len(part).to_bytes(8, "big") + part)
    return found


@lru_cache(maxsize=16)  # those that ship and some more: a program that validates again has the same ones
def _loaded(source: SourceText) -> Prefiltered:
    """What an ontology declares, in whatever format it is, to be read only. Raises TurtleError."""
    for fault in _encoding(source):
        raise TurtleError(fault.message, file=source.name, line=fault.line, column=fault.column)
    octets = source.octets.removeprefix(BOM_UTF8)
    found = prefilter(octets, source.base, turtle.format_of(source.name, octets).parser)
    if found.problems or found.too_large:
        turtle.read_ontology(octets, source.name, source.base)  # which raises, and words it
    return found


def _uncleared(files: Iterable[SourceText], seen: dict[str, Prefiltered], index: TermIndex) -> Iterator[UnclearedFile]:
    """The files that the prefilter does not clear, or that describe what another file describes."""
    elsewhere, otherwise = described_twice(seen), described_otherwise(seen)
    by_name = {source.name: source for source in files}
    describing: dict[str, str] = {}
    for name in sorted(seen):
        for thing in (*seen[name].components, *seen[name].templates):
            if not thing.startswith("_:"):
                describing.setdefault(thing, name)
    for name, source in by_name.items():
        found = seen.get(name)
        others = {**otherwise.get(name, {}), **elsewhere.get(name, {})}
        if found is None or (not others and found.clear and index.clear(found)):
            continue
        beside: dict[str, list[str]] = defaultdict(list)
        if found.answers:
            for thing in sorted(found.referred.difference(found.components, found.templates) & describing.keys()):
                beside[describing[thing]].append(thing)
        described = tuple((by_name[other], tuple(things)) for other, things in sorted(beside.items()))
        yield UnclearedFile(source, others, described)


def _read(source: SourceText) -> tuple[list[Diagnostic], Prefiltered | None]:
    """What the prefilter tells of a file, or why it is no Turtle."""
    problems = list(_encoding(source))
    if problems:
        return problems, None
    screened = prefilter(source.octets.removeprefix(BOM_UTF8), source.base)
    problems = list(_syntax(source, screened))
    return problems, None if problems else screened


def _too_large(source: SourceText, size: int) -> Diagnostic:
    message = f"With {size:,} statements this file is too large to be checked in full."
    advice = f"Split it into files of at most {MOST_STATEMENTS:,} statements."
    return TextPlaces(source.name, source.octets).on(1, 1, "SC-S05", message, advice)


def _encoding(source: SourceText) -> Iterator[Diagnostic]:
    found = turtle.first_not_utf_8(source.octets)
    if found is not None:
        line, column, said = found
        message, advice = f"T{said[1:]}.", "Save the file in the encoding UTF-8."
        yield TextPlaces(source.name, source.octets).on(line, column, "SC-S02", message, advice)
        return
    before, nul, _ = source.octets.decode("utf-8-sig").partition("\0")
    if nul:
        message = "This is not Turtle: it holds a NUL, as binary files do."
        yield replace(TextPlaces(source.name, source.octets).at(len(before), "SC-S01", message), source="")


def _syntax(source: SourceText, screened: Prefiltered) -> Iterator[Diagnostic]:
    other = turtle.other_format(source.name, source.octets) if screened.problems else None
    if other is not None:
        message = f"This is {other.name}, and what is validated is Turtle."
        advice = f"Convert it: {turtle.conversion(source.name, other)}"
        yield TextPlaces(source.name, source.octets).on(1, 1, "SC-S01", message, advice)
        return
    if not screened.problems and not screened.too_large:
        return
    text = TextPlaces(source.name, source.octets)
    for problem in _not_of_another(screened.problems):
        message = f"This is not Turtle: {problem.message.rstrip('.')}."
        yield text.on(problem.line, problem.column, "SC-S01", message, turtle.advice(problem.message), problem.width)
    if screened.too_large:
        message = "A string or an IRI here has over 16 MiB, which is more than can be read."
        yield text.at(text.largest_token(), "SC-S05", message)


def _not_of_another(problems: Sequence[SyntaxProblem]) -> Iterator[SyntaxProblem]:
    """The problems, among some, that do not come of another: one for each prefix, and else the first of each line."""
    said: set[str] = set()
    lines: set[int] = set()
    for problem in problems:
        prefix = turtle.undeclared_prefix(problem.message) is not None
        if problem.message in said if prefix else problem.line in lines:
            continue  # one missing declaration is one mistake, however often the prefix is used
        said.add(problem.message)
        yield problem
        if not prefix:
            lines.add(problem.line)
        if problem.message.startswith(_TO_THE_END):
            return
