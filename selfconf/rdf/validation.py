"""Validation of many files at once: texts in, a report out.

Two passes. The first reads every file by Oxigraph and learns which terms there are; a file in which
nothing is suspicious has passed then. The second looks closely at the others: places by rdflib's parser,
violations by pySHACL, malformed roles, lints. Each file is judged on its own triples. What the files of a
run share is only the knowledge which terms exist, which can at most take away a warning, and which
components are described twice.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from selfconf.errors import TurtleError
from selfconf.model.diagnostic import Diagnostic, Report, Severity, report
from selfconf.rdf.familiar import Familiar, learned
from selfconf.rdf.screening import Screened, screen

_NOTHING = "There is no component, template, task, configuration or ontology in this file: nothing to validate."
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


@dataclass(frozen=True, slots=True)
class Source:
    """A text with the name to blame it by, and the IRI against which its relative IRIs are resolved."""

    name: str
    octets: bytes
    base: str = "file:///"

    def text(self) -> str:
        """The text without a byte order mark; raises UnicodeDecodeError if it is not UTF-8."""
        return self.octets.removeprefix(_BYTE_ORDER_MARK).decode("utf-8")

    def line(self, number: int) -> str:
        """One line of the text, as far as it is UTF-8."""
        lines = self.octets.removeprefix(_BYTE_ORDER_MARK).decode("utf-8", "replace").split("\n")
        return lines[number - 1].rstrip("\r") if number <= len(lines) else ""


def validate(sources: Iterable[Source], shapes: Iterable[Source], ontologies: Iterable[Source]) -> Report:
    """Every problem of every source; raises TurtleError if an ontology is not Turtle."""
    files = list(sources)
    diagnostics: list[Diagnostic] = []
    seen: dict[str, Screened] = {}
    familiar = learned(_loaded(source) for source in ontologies)
    for source in files:
        problems = list(_encoding(source))
        if not problems:
            screened = screen(source.octets.removeprefix(_BYTE_ORDER_MARK), source.base)
            problems = list(_syntax(source, screened))
            if not problems:
                seen[source.name] = screened
                familiar.learn(screened)
        diagnostics += problems
    elsewhere = described_twice(seen)
    suspects = [
        source
        for source in files
        if source.name in seen
        and (source.name in elsewhere or not (seen[source.name].clear and familiar.clear(seen[source.name])))
    ]
    diagnostics += scrutinise(suspects, list(shapes), familiar, elsewhere)
    concerned = {found.file for found in diagnostics}
    for name, screened in seen.items():
        if not screened.relevant and name not in concerned:
            diagnostics.append(Diagnostic(name, 1, 1, "SC-S04", _NOTHING, Severity.WARNING))
    return report((source.name for source in files), diagnostics)


def scrutinise(
    suspects: list[Source], shapes: list[Source], familiar: Familiar, elsewhere: dict[str, dict[str, str]]
) -> Iterator[Diagnostic]:
    """The problems of files that did not pass at first sight."""
    if suspects:
        # rdflib and pySHACL take longer to load than thousands of good files take to pass.
        from selfconf.rdf import scrutiny

        judge = scrutiny.Scrutiny(scrutiny.shapes_of(*(source.text() for source in shapes)), familiar)
        for source in suspects:
            yield from judge.of(source.text(), source.name, source.base, elsewhere.get(source.name, {}))


def described_twice(seen: dict[str, Screened]) -> dict[str, dict[str, str]]:
    """For each file but the first that describes a component: the component, and the file that was first."""
    first: dict[str, str] = {}
    again: dict[str, dict[str, str]] = defaultdict(dict)
    for name in sorted(seen):
        for component in seen[name].components:
            if not component.startswith("_:") and first.setdefault(component, name) != name:
                again[name][component] = first[component]
    return dict(again)


def _loaded(source: Source) -> Screened:
    for fault in _encoding(source):
        raise TurtleError(fault.message, file=source.name, line=fault.line, column=fault.column)
    screened = screen(source.octets.removeprefix(_BYTE_ORDER_MARK), source.base)
    if screened.problems:
        problem = screened.problems[0]
        raise TurtleError(problem.message, file=source.name, line=problem.line, column=problem.column)
    return screened


def _encoding(source: Source) -> Iterator[Diagnostic]:
    try:
        source.octets.decode("utf-8")
    except UnicodeDecodeError as error:
        before = source.octets[: error.start].decode("utf-8").removeprefix("\ufeff")
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        octet = source.octets[error.start]
        message = f"This is not UTF-8: the byte 0x{octet:02X} cannot stand here."
        hint = "Save the file in the encoding UTF-8."
        yield Diagnostic(source.name, line, column, "SC-S02", message, hint=hint, source=source.line(line))


def _syntax(source: Source, screened: Screened) -> Iterator[Diagnostic]:
    said: set[str] = set()
    for problem in screened.problems:
        if "has not been declared" in problem.message and problem.message in said:
            continue  # one missing declaration is one mistake, however often the prefix is used
        said.add(problem.message)
        message = f"This is not Turtle: {problem.message.rstrip('.')}."
        yield Diagnostic(
            source.name,
            problem.line,
            problem.column,
            "SC-S01",
            message,
            width=problem.width,
            source=source.line(problem.line),
        )
