"""`selfconf validate`: checks advertisements, templates, tasks, configurations and ontologies before anyone
runs them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from selfconf import files, library
from selfconf.cli.close_looks import Remembered, shared
from selfconf.cli.reports import FORMATS, text
from selfconf.cli.terminal import show
from selfconf.errors import AuthorError
from selfconf.model.codes import BY_CODE, CODES, Code
from selfconf.model.diagnostic import UNREADABLE, Diagnostic, Report, Severity, report
from selfconf.rdf.validation import CheckEach, SourceText, validate

LARGEST = 64 << 20
"""A file of more bytes is not read."""
NAME = "validate"
HELP = "check advertisements, templates, tasks and ontologies"
EXAMPLE = """  selfconf validate examples/navigate.ttl examples/peis-home --ontology ontology/peis-home.ttl"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "paths",
        nargs="*",
        metavar="PATH",
        help="a Turtle file, a folder (all *.ttl below it), or - for standard input",
    )
    parser.add_argument(
        "--format",
        choices=tuple(FORMATS),
        default="text",
        help="how problems are written (default: %(default)s)",
    )
    parser.add_argument(
        "--ontology",
        action="append",
        default=[],
        metavar="FILE",
        help="an ontology whose terms the files use, besides those of selfconf; may be repeated",
    )
    parser.add_argument(
        "--cache",
        action="store_true",
        help="remember what was found, and look only at what has changed since the last run over the same paths",
    )
    parser.add_argument(
        "--explain",
        metavar="CODE",
        help="say what a code means, with a bad and a good example, and do nothing else",
    )


def run(arguments: argparse.Namespace) -> int:
    """Validate, print the report, and return 0 (all conform), 1 (some do not) or 2 (some cannot be read)."""
    if arguments.explain is not None:
        sys.stdout.write(explanation(arguments.explain))
        return 0
    if not arguments.paths:
        raise AuthorError("there is nothing to validate; name a Turtle file or a folder")
    result = check(arguments.paths, arguments.ontology, _remembered(arguments.paths) if arguments.cache else shared)
    illustrated = arguments.format == "text" and sys.stdout.isatty()
    show(text.illustrate(result) if illustrated else FORMATS[arguments.format](result), end="")
    show(text.summary(result), sys.stderr)
    if result.unreadable:
        names = ", ".join(sorted(result.unreadable))
        show(f"selfconf validate: cannot read {names}; correct the path or the syntax.", sys.stderr)
        return 2
    return 0 if result.conforms else 1


def check(paths: Iterable[str], ontologies: Iterable[str] = (), each: CheckEach = map) -> Report:
    """Validate files and folders against the shapes that selfconf brings along."""
    sources: dict[Path, SourceText] = {}
    found: list[Diagnostic] = []
    for path in paths:
        names = list(_files(path))
        if not names:
            message = "There is no Turtle file (*.ttl) in this folder: nothing to validate."
            found.append(Diagnostic(path, 1, 1, "SC-S04", message, Severity.WARNING))
        for name in names:
            try:
                if name != "-" and Path(name).stat().st_size > LARGEST:
                    message = f"This file is larger than {LARGEST >> 20} MiB: that cannot be meant."
                    found.append(Diagnostic(name, 1, 1, "SC-S05", message))
                else:
                    sources.setdefault(Path(name).resolve(), _read(name))
            except OSError as error:
                message = f"This file cannot be read: {error.strerror or error}."
                found.append(Diagnostic(name, 1, 1, "SC-S03", message))
    shapes = [_load(path) for path in library.shapes()]
    known = [*map(_load, library.ontologies()), *_ontologies(ontologies)]
    result = validate(sources.values(), shapes, known, each)
    concerned = {*result.files, *(problem.file for problem in found if problem.code in UNREADABLE)}
    return report(sorted(concerned), (*result.diagnostics, *found))


def explanation(code: str) -> str:
    """What a code means, as text; raises AuthorError if there is no such code."""
    entry = BY_CODE.get(code.upper())
    if entry is None:
        raise AuthorError(f"there is no code {code}; the codes are {', '.join(known.code for known in CODES)}")
    parts = [f"{entry.code} ({entry.severity.value}): {entry.title}", entry.why]
    if entry.bad:
        parts += ["Not so:", _indented(entry.bad), "But so:", _indented(entry.good)]
    return "\n\n".join(parts) + "\n"


def reference(codes: Iterable[Code] = CODES) -> str:
    """The page of the manual that lists all codes, in Markdown."""
    sections = ["# Codes of `selfconf validate`\n\nGenerated from `selfconf/model/codes.py`.\n"]
    for entry in codes:
        lines = [f"## {entry.code}: {entry.title}\n", f"*{entry.severity.value}* · {entry.why}\n"]
        if entry.bad:
            lines += [
                "Not so:\n",
                f"```turtle\n{entry.bad}\n```\n",
                "But so:\n",
                f"```turtle\n{entry.good}\n```\n",
            ]
        sections.append("\n".join(lines))
    return "\n".join(sections)


def _remembered(paths: Iterable[str]) -> CheckEach:
    from selfconf.entailment import cache_folder  # loads rdflib, which a run without a memory may not need

    return Remembered(cache_folder(), paths)


def _indented(snippet: str) -> str:
    return "\n".join(f"    {line}" for line in snippet.splitlines())


def _ontologies(given: Iterable[str]) -> Iterator[SourceText]:
    for name in (name for path in given for name in _files(path)):
        try:
            yield _read(name)
        except OSError as error:
            raise AuthorError(f"the ontology cannot be read: {error.strerror or error}", file=name) from None


def _files(given: str) -> Iterator[str]:
    """The files that a path stands for: those of a folder by name, or itself."""
    path = Path(given)
    if given == "-" or not path.is_dir():
        yield given
    else:
        yield from map(str, files.within(path))


def _read(name: str) -> SourceText:
    if name == "-":
        return SourceText("<stdin>", sys.stdin.buffer.read())
    return _load(Path(name))


def _load(path: Path) -> SourceText:
    return SourceText(str(path), path.read_bytes(), path.resolve().as_uri())
