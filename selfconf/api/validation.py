"""`validate`: every problem of some files with file, line, column and code, before a task meets them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import overload

from selfconf import files, library
from selfconf.api.arguments import Paths, checked_flag, checked_path, listed_paths
from selfconf.api.file_checks import Remembered, shared
from selfconf.api.tables import Tabular
from selfconf.errors import AuthorError
from selfconf.model.diagnostic import UNREADABLE, Diagnostic, Report, Severity, report
from selfconf.model.immutable import immutable
from selfconf.model.wording import counted
from selfconf.project import PROJECT_FILE, project_problems
from selfconf.rdf import validation
from selfconf.rdf.validation import CheckEach, SourceText

CHECKED = (*files.TURTLE, PROJECT_FILE)
"""The endings of the files that stand for a folder."""
LARGEST_FILE = 64 << 20
"""A file of more bytes is not read."""


@immutable
class ValidationReport(Tabular, Report, Sequence[Diagnostic]):
    """A report as the library answers with it: true if all conforms, and a sequence of its problems in order.

    It prints a line for each problem, as the command does; in a notebook it is a table.
    """

    def __bool__(self) -> bool:
        return self.conforms

    def __len__(self) -> int:
        return len(self.diagnostics)

    @overload
    def __getitem__(self, number: int) -> Diagnostic: ...

    @overload
    def __getitem__(self, number: slice) -> Sequence[Diagnostic]: ...

    def __getitem__(self, number: int | slice) -> Diagnostic | Sequence[Diagnostic]:
        return self.diagnostics[number]

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self.diagnostics)

    def _head(self) -> Sequence[str]:
        return "file", "line", "severity", "code", "message"

    def _cells(self) -> Iterator[list[str]]:
        for found in self.diagnostics:
            yield [found.file, str(found.line), found.severity.value, found.code, found.message]

    def __str__(self) -> str:
        return "\n".join(map(str, self.diagnostics)) or repr(self)

    def __repr__(self) -> str:
        problems = f"{counted(self.errors, 'error')} and {counted(self.warnings, 'warning')}"
        said = f"<{problems} in {counted(len(self.files), 'file')}>"
        return f"{said}\n{Tabular.__repr__(self)}" if self.diagnostics else said

    def _repr_html_(self) -> str:
        from selfconf.render import html_text

        return Tabular._repr_html_(self) if self.diagnostics else html_text(repr(self))


def validate(paths: Paths, *, ontologies: Paths = (), cache: bool = False) -> ValidationReport:
    """The problems of files and folders, as the command `validate` reports them; `-` is standard input.

    `cache` remembers what was found, and checks only what has changed since the last run over the same paths.
    Raises AuthorError for an ontology that cannot be read and an empty path, and ProgrammerError for what is no path; a
    file that cannot be read is a diagnostic.

    >>> validate(["examples/clock"]).conforms
    True
    """
    return validated(paths, ontologies, checked_flag(cache, "cache"), shared)


def validated(paths: Paths, ontologies: Paths, cache: bool, each: CheckEach) -> ValidationReport:
    """What `validate` answers; `each` spreads the work."""
    names = [str(path) for path in listed_paths(paths)]
    found = check(names, map(str, listed_paths(ontologies)), _remembered(names, each) if cache else each)
    return ValidationReport(found.files, found.diagnostics)


def check(paths: Iterable[str], ontologies: Iterable[str] = (), each: CheckEach = map) -> Report:
    """The problems of files and folders by the shapes that ship with selfconf; `each` spreads or remembers the work."""
    sources: dict[Path, SourceText] = {}
    found: list[Diagnostic] = []
    projects: set[str] = set()
    for path in paths:
        unread: list[AuthorError] = []
        names = list(_files(path, left_out=unread.append))
        found += (Diagnostic(path, 1, 1, "SC-S03", f"Not all in this folder is checked: {one}.") for one in unread)
        if not names and not unread:
            message = "There is no Turtle file (*.ttl) in this folder: nothing to validate."
            found.append(Diagnostic(path, 1, 1, "SC-S04", message, Severity.WARNING))
        for name in names:
            try:
                if name != "-" and Path(name).stat().st_size > LARGEST_FILE:
                    message = f"This file is larger than {LARGEST_FILE >> 20} MiB: that cannot be meant."
                    found.append(Diagnostic(name, 1, 1, "SC-S05", message))
                elif Path(name).name == PROJECT_FILE:
                    found += project_problems(name, files.read_bounded(Path(name)), Path(name).parent)
                    projects.add(name)
                else:
                    sources.setdefault(Path(name).resolve(), _read(name))
            except OSError as error:
                message = f"This file cannot be read: {error.strerror or error}."
                found.append(Diagnostic(name, 1, 1, "SC-S03", message))
    result = _validated(sources.values(), ontologies, each)
    concerned = {*result.files, *projects, *(problem.file for problem in found if problem.code in UNREADABLE)}
    return report(sorted(concerned), (*result.diagnostics, *found))


def _validated(sources: Iterable[SourceText], ontologies: Iterable[str], each: CheckEach) -> Report:
    shapes = [_load(path) for path in library.shapes()]
    known = [*map(_load, library.ontologies()), *_ontologies(ontologies)]
    return validation.validate_texts(sources, shapes, known, each)


def _remembered(paths: Iterable[str], each: CheckEach) -> CheckEach:
    from selfconf.entailment import cache_folder  # loads a parser, which a run without a memory may not need

    return Remembered(cache_folder(), paths, each)


def _ontologies(given: Iterable[str]) -> Iterator[SourceText]:
    for name in (name for path in given for name in _files(path, files.ONTOLOGY)):
        try:
            yield _read(name)
        except OSError as error:
            raise AuthorError(f"the ontology cannot be read: {error.strerror or error}", file=name) from None


def _files(
    given: str, endings: tuple[str, ...] = CHECKED, left_out: Callable[[AuthorError], None] | None = None
) -> Iterator[str]:
    """The files that a path stands for: those of a folder that end so, by name, or itself.

    Raises AuthorError for a text that names no path, and for a folder that cannot be read, unless `left_out` is given,
    which receives the error instead.
    """
    path = checked_path(given)
    if given == "-" or not path.is_dir():
        yield given
    else:
        found = files.within(path, left_out, endings)
        yield from (str(file) for file in found if file.suffix != ".toml" or file.name == PROJECT_FILE)


def _read(name: str) -> SourceText:
    if name == "-":
        return SourceText("<stdin>", files.standard_input())
    return _load(Path(name))


def _load(path: Path) -> SourceText:
    return SourceText(str(path), files.read_bounded(path), files.base(path))
