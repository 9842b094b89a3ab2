"""`selfconf validate`: checks advertisements, templates, tasks, configurations and ontologies before anyone
runs them.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.cli.progress import ProgressLine
from selfconf.cli.terminal import complain, display
from selfconf.errors import AuthorError
from selfconf.model.wording import one_line

if TYPE_CHECKING:
    from selfconf.project import Project

REPORT_FORMATS = ("text", "json", "github", "sarif", "junit")
# Those of `selfconf.cli.reports`, which is not loaded to parse arguments; a test compares them.
EXAMPLE = """  selfconf validate examples/navigate.ttl examples/peis-home --ontology ontology/peis-home.ttl"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "paths",
        nargs="*",
        metavar="PATH",
        help="a Turtle file, a project file selfconf.toml, a folder (all of them below it), or - for standard input"
        " (default: the project file and its `ads`)",
    )
    parser.add_argument(
        "--format",
        choices=REPORT_FORMATS,
        default="text",
        help="how problems are written (default: %(default)s)",
    )
    parser.add_argument(
        "--ontology",
        action="append",
        default=[],
        metavar="PATH",
        help="an ontology whose terms the files use, besides those of selfconf, or a folder of them; repeatable",
    )
    parser.add_argument(
        "--warnings-as-errors",
        action="store_true",
        help="the exit code is 1 also if there are only warnings",
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


def run(given: argparse.Namespace) -> int:
    """Validate, print the report, and return 0 (all conform), 1 (some do not) or 2 (some cannot be read)."""
    if given.explain is not None:
        if given.format != "text":
            raise AuthorError("--explain is for people and writes text; leave out --format")
        sys.stdout.write(explanation(given.explain))
        return 0
    paths = given.paths or _project_paths(given.project)
    if not paths:
        raise AuthorError("there is nothing to validate; name a Turtle file or a folder, or write a selfconf.toml")
    from selfconf.api.file_checks import shared
    from selfconf.api.validation import validated
    from selfconf.cli.reports import RENDERERS, text

    with ProgressLine() as shown:
        shown.begin("validating")
        each = partial(shared, forking=shown.paused)
        result = validated(paths, _ontologies(given, paths), given.cache, each)
    illustrated = given.format == "text" and sys.stdout.isatty()
    display(text.illustrate(result) if illustrated else RENDERERS[given.format](result), end="")
    complain(text.summary(result))
    if result.unreadable:
        names = ", ".join(map(one_line, sorted(result.unreadable)))
        complain(f"selfconf validate: cannot read {names}; correct the path or the syntax.")
        return 2
    return 0 if result.conforms and not (given.warnings_as_errors and result.warnings) else 1


def _project_paths(project: Project) -> list[Path]:
    """What there is to validate in a project: its file, and its advertisements; nothing where there is no project.

    An advertisement that is not there is a mistake in the project file, which names it.
    """
    ads = (path for path in project.values.get("ads", ()) if path.exists())
    return [project.path, *ads] if project.path.is_file() else []


def _ontologies(given: argparse.Namespace, paths: Iterable[str | Path]) -> list[str | Path]:
    """The ontologies that are given, without those that are not there of a project file that is checked itself."""
    ontologies: list[str | Path] = given.ontology
    if "ontology" not in given.from_project:
        return ontologies
    # Path.resolve raises RuntimeError for a loop of links; that such a path cannot be read is said where it is read.
    project = Path(os.path.realpath(given.project.path))
    checked = any(project.is_relative_to(os.path.realpath(path)) for path in paths)
    return [path for path in ontologies if not checked or Path(path).exists()]


def explanation(code: str) -> str:
    """What a code means, as text; raises AuthorError if there is no such code."""
    from selfconf.model.codes import BY_CODE, CODES

    entry = BY_CODE.get(code.upper())
    if entry is None:
        raise AuthorError(f"there is no code {code}; the codes are {', '.join(known.code for known in CODES)}")
    parts = [f"{entry.code} ({entry.severity.value}): {entry.title}", entry.why]
    if entry.bad:
        parts += ["Not so:", _indented(entry.bad), "But so:", _indented(entry.good)]
    return "\n\n".join(parts) + "\n"


def _indented(snippet: str) -> str:
    return "\n".join(f"    {line}" for line in snippet.splitlines())
