"""What a command answers, in two parts: its structure, which is to stay, and its sentences, which may be reworded.

The structure of an answer is its exit code, its stdout (JSON with a mark in place of every sentence; Turtle, Mermaid,
SPARQL as they are), and how many lines it says on stderr. The members of `seconds` are kept, their values are not.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import rdflib
from rdflib import compare

from selfconf.cli.main import main
from tests.harness.frozen import nothing_frozen

SENTENCES = frozenset(("message", "obstacle", "hint", "text", "title"))
"""The members of JSON that are for people. `obstacles` is a list of them."""
SENTENCE = "..."
"""What stands for a sentence in the structure."""
VOLATILE = frozenset(("version", "informationUri"))
"""Members that depend on how selfconf was installed."""
_CHOICES = re.compile(r"\(choose from .*\)")


@dataclass(frozen=True)
class Case:
    """A command line with a name of its own, and where it is typed."""

    name: str
    arguments: tuple[str, ...]
    stdin: str | None = None


@dataclass(frozen=True)
class Answer:
    """What a command answers: JSON values both."""

    structure: dict[str, Any]
    sentences: dict[str, Any]


def answered(case: Case) -> Answer:
    """The answer to a case in the current folder, in this process."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            with nothing_frozen():
                code = main(case.arguments)
        except SystemExit as error:
            code = int(error.code or 0)
    return taken_apart(case, code, out.getvalue(), err.getvalue())


def taken_apart(case: Case, code: int, out: str, err: str) -> Answer:
    """The two parts of what a command has said."""
    structure: dict[str, Any] = {"exit": code, "stderr": err.count("\n")}
    sentences: dict[str, Any] = {}
    if err:
        sentences["stderr"] = _CHOICES.sub("(choose from ...)", err)
    asked = _format(case.arguments)
    if "--help" in case.arguments:
        structure["stdout"] = bool(out)
    elif out and asked in ("json", "sarif"):
        said: list[str] = []
        structure["stdout"] = _structure(json.loads(out), said)
        if said:
            sentences["stdout"] = said
    elif asked in ("turtle", "mermaid", "csv", "tsv") and not code:
        structure["stdout"] = out
    elif out and "--show" in case.arguments:
        structure["stdout"] = _shapes(out) if "shape" in case.arguments else out
    elif out:
        structure["stdout"] = SENTENCE
        sentences["stdout"] = out
    return Answer(structure, sentences)


def _shapes(turtle: str) -> list[str]:
    """The triples of Turtle, whatever the names of its blank nodes, which decide on the order in the text."""
    graph = compare.to_canonical_graph(rdflib.Graph().parse(data=turtle, format="turtle"))
    return sorted(graph.serialize(format="nt").splitlines())


def _format(arguments: Sequence[str]) -> str:
    return arguments[arguments.index("--format") + 1] if "--format" in arguments[:-1] else "text"


def _structure(value: Any, said: list[str]) -> Any:
    """A JSON value with its sentences taken out, which are added to a list in the order of the value."""
    if isinstance(value, list):
        return [_structure(each, said) for each in value]
    if not isinstance(value, dict):
        return value
    found: dict[str, Any] = {}
    for name, member in value.items():
        if name == "seconds" and isinstance(member, dict):
            found[name] = sorted(member)
        elif name in SENTENCES and isinstance(member, str):
            found[name] = SENTENCE
            said.append(member)
        elif name == "obstacles":
            found[name] = [SENTENCE] * len(member)
            said += member
        elif name not in VOLATILE:
            found[name] = _structure(member, said)
    return found


@contextlib.contextmanager
def folder(path: Path) -> Iterator[None]:
    """Work in a folder, so that the names of files in answers are short and the same everywhere."""
    before = Path.cwd()
    os.chdir(path)
    try:
        yield
    finally:
        os.chdir(before)


def differences(recorded: Any, found: Any, path: str = "") -> Iterator[str]:
    """Where two JSON values differ, a line each."""
    if isinstance(recorded, dict) and isinstance(found, dict):
        yield from _members(recorded, found, path)
    elif isinstance(recorded, list) and isinstance(found, list) and len(recorded) == len(found):
        for number, pair in enumerate(zip(recorded, found, strict=True)):
            yield from differences(*pair, f"{path}[{number}]")
    elif isinstance(recorded, list) and isinstance(found, list):
        yield from _elements(recorded, found, path)
    elif isinstance(recorded, str) and isinstance(found, str) and recorded != found:
        begins = max(0, _same(recorded, found) - 40) if len(recorded) > 300 else 0
        where = f" from character {begins}" if begins else ""
        was, now = recorded[begins : begins + 160], found[begins : begins + 160]
        yield f"{path}{where}: was {_short(was)}, is {_short(now)}"
    elif recorded != found or type(recorded) is not type(found):
        yield f"{path}: was {_short(recorded)}, is {_short(found)}"


def _members(recorded: dict[str, Any], found: dict[str, Any], path: str) -> Iterator[str]:
    for name in sorted({*recorded, *found}):
        where = f"{path}.{name}" if path else name
        if name not in found:
            yield f"{where}: is gone, was {_short(recorded[name])}"
        elif name not in recorded:
            yield f"{where}: is new, {_short(found[name])}"
        else:
            yield from differences(recorded[name], found[name], where)
    if list(recorded) != list(found) and set(recorded) == set(found):
        yield f"{path}: members in another order, {list(found)} for {list(recorded)}"


def _elements(recorded: list[Any], found: list[Any], path: str) -> Iterator[str]:
    texts = ([json.dumps(one) for one in values] for values in (recorded, found))
    for kind, start, stop, new_start, new_stop in SequenceMatcher(None, *texts, autojunk=False).get_opcodes():
        if kind != "equal":
            for number in range(start, stop):
                yield f"{path}[{number}]: is gone, was {_short(recorded[number])}"
            for number in range(new_start, new_stop):
                yield f"{path}[{number}]: is new, {_short(found[number])}"


def _same(one: str, other: str) -> int:
    """How many characters two different texts begin with alike."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((place for place, (a, b) in pairs if a != b), min(len(one), len(other)))


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 300 else f"{text[:300]}... ({len(text)} characters)"
