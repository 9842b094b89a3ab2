"""The project file `selfconf.toml`: what need not be typed with each command in a project.

It is looked for upward from the current folder, as other tools look for theirs. Each key is the option of that name
(`--ecology`, `--ads` and so on); what is typed goes before what the environment says, and that before the file.

A file may name advertisements, and so commands that `selfconf run` starts. In a folder that all may write to, such as
/tmp, it might be a stranger's: one that belongs to neither the user nor the owner of its folder is passed over.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from selfconf.errors import AuthorError
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.immutable import immutable
from selfconf.model.seconds import LIMIT_IN_WORDS, is_limit
from selfconf.protocol.endpoints import is_zenoh_endpoint
from selfconf.protocol.keys import checked_name

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROJECT_FILE = "selfconf.toml"
"""The name of the file."""
LARGEST_PROJECT = 1 << 18
"""A file of more bytes is not read."""
STRATEGIES = ("first", "paper", "best")
REASONING = ("syntactic", "subclass", "owl-rl")
# Both are enumerations of the library, which is not loaded to parse arguments; a test compares them.
BIND = "bind"
"""The key of the table that holds a table of bindings for each template."""


class ProjectKey(NamedTuple):
    """One key of a project file."""

    means: str
    """What it says, for people."""
    wrong: Callable[[Any], str]
    """What is wrong with a value, in words; empty if nothing is."""
    paths: bool = False
    """Whether it names files and folders, relative to the project file."""
    several: bool = False
    """Whether it takes one value or a list of them."""


def _is_text(value: object) -> str:
    return "" if isinstance(value, str) and value else "takes a text in quotes"


def _is_texts(value: object) -> str:
    several = value if isinstance(value, list) else [value]
    right = bool(several) and not any(map(_is_text, several))
    return "" if right else "takes a text in quotes, or a list of them"


def _is_endpoints(value: object) -> str:
    several = value if isinstance(value, list) else [value]
    wrong = [text for text in several if isinstance(text, str) and not is_zenoh_endpoint(text)]
    return _is_texts(value) or (f"takes an endpoint like 'tcp/127.0.0.1:7447', not {wrong[0]!r}" if wrong else "")


def _is_url(value: object) -> str:
    try:
        parts = urlsplit(str(value))
        right = parts.scheme in ("http", "https") and bool(parts.hostname)
    except ValueError:  # the brackets of an address of IPv6
        right = False
    return _is_text(value) or ("" if right else f"takes an http or https URL, not {value!r}")


def _is_name(value: object) -> str:
    try:
        return _is_text(value) or checked_name(str(value), "an ecology")[:0]
    except AuthorError as error:
        return f"takes a name: {error}"


def _is_whole(value: object) -> str:
    right = isinstance(value, int) and not isinstance(value, bool) and value > 0
    return "" if right else "takes a whole number above zero"


def _is_seconds(value: object) -> str:
    return "" if is_limit(value) else f"takes {LIMIT_IN_WORDS}"


def _is_one_of(choices: tuple[str, ...]) -> Callable[[object], str]:
    return lambda value: "" if value in choices else f"takes one of {', '.join(map(repr, choices))}"


def _is_value(value: object) -> str:
    right = isinstance(value, str | int | float)
    return "" if right else "takes a text such as on a command line, a number, or true or false"


PROJECT_KEYS: Mapping[str, ProjectKey] = {
    "ecology": ProjectKey("the name of the living ecology", _is_name),
    "connect": ProjectKey(
        "where its sites listen, such as tcp/10.0.0.2:7447; one or a list", _is_endpoints, several=True
    ),
    "keys": ProjectKey("a folder of keys, as `selfconf keys` makes them", _is_text, paths=True),
    "ads": ProjectKey(
        "files and folders with advertisements, without hidden folders; one or a list",
        _is_texts,
        paths=True,
        several=True,
    ),
    "endpoint": ProjectKey("a SPARQL endpoint that holds the advertisements, in place of ads", _is_url),
    "ontology": ProjectKey(
        "ontologies besides those of selfconf, files and folders; one or a list", _is_texts, paths=True, several=True
    ),
    "reasoning": ProjectKey(f"which triples the roles see: {', '.join(REASONING)}", _is_one_of(REASONING)),
    "strategy": ProjectKey(f"how to search: {', '.join(STRATEGIES)}", _is_one_of(STRATEGIES)),
    "steps": ProjectKey("give up a search after so many steps", _is_whole),
    "seconds": ProjectKey("give up a search after so many seconds", _is_seconds),
}
"""The keys, in the order in which they are explained; besides them there is the table `bind`."""
OTHER_WORDS: Mapping[str, str] = {"ontologies": "ontology", "endpoints": "connect"}
"""Words of the library that may stand for a key, where the file does not have the key itself."""


@immutable
class Project:
    """What a project file says; without a file, nothing."""

    path: Path = Path(PROJECT_FILE)
    """The file, as seen from the current folder."""
    values: Mapping[str, Any] = field(default_factory=dict)
    """By key: texts, numbers, and for `ads`, `ontology` and `connect` lists, the paths as seen from the folder.

    `keys` is one path.
    """
    bound: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """The bindings by template and parameter."""
    lines: Mapping[tuple[str, ...], int] = field(default_factory=dict)
    """The line of each key, counted from one."""

    def place(self, *keys: str) -> str:
        """The file and line of a key, for people."""
        return f"{self.path}:{self.lines.get(keys, 1)}"

    def bindings(self, *names: str) -> tuple[str, Mapping[str, Any]]:
        """The first of these names of a template or task that has a table of bindings, and the table."""
        return next(((name, self.bound[name]) for name in names if name in self.bound), ("", {}))


def project_path(folder: Path, complain: Callable[[str], None] = lambda _: None) -> Path | None:
    """The project file of a folder: its own, or that of the nearest folder above it; None if there is none.

    `complain` receives a sentence about each one that is passed over, because it belongs to a stranger.
    """
    for above in (folder, *folder.parents):
        path = above / PROJECT_FILE
        try:
            if not path.is_file():
                continue
            owner = path.stat().st_uid
            if owner in (os.getuid(), above.stat().st_uid):
                return path
        except OSError:  # it went while it was looked at, or may not be looked at
            continue
        complain(f"{path} is passed over: it belongs to neither you nor the owner of its folder")
    return None


def read_project(path: Path) -> Project:
    """What a project file says. Raises AuthorError, with line and column, for the first thing that is wrong in it."""
    shown = Path(os.path.relpath(path))
    try:
        octets = path.read_bytes()
    except OSError as error:
        raise AuthorError(f"cannot read {shown}: {error.strerror}") from None
    body, lines, problems = _examined(str(shown), octets)
    for problem in problems:
        raise AuthorError(problem.message, file=problem.file, line=problem.line, column=problem.column)
    return Project(shown, dict(_settled(body, path.parent)), body.get(BIND, {}), lines)


def project_problems(name: str, octets: bytes, folder: Path) -> list[Diagnostic]:
    """Everything that is wrong with the text of a project file, also paths in it that lead nowhere from its folder."""
    body, lines, problems = _examined(name, octets)
    for key, setting in PROJECT_KEYS.items():
        if setting.paths and key in body and not setting.wrong(body[key]):
            problems += (
                _problem(name, octets, lines, (key,), "SC-P05", wrong)
                for text in _listed(body[key])
                if (wrong := _unseen(folder, text))
            )
    return problems


def _unseen(folder: Path, text: str) -> str:
    """What keeps the file or folder of a path from being seen, as a sentence; empty if nothing does."""
    try:
        return "" if (folder / text).exists() else f"There is no file or folder {text}."
    except OSError as error:  # a name that is too long, or a folder into which only others may look
        return f"{text} cannot be read: {error.strerror}."


def _examined(name: str, octets: bytes) -> tuple[dict[str, Any], dict[tuple[str, ...], int], list[Diagnostic]]:
    """The tables of a file, the line of each key, and what is wrong."""
    try:
        if len(octets) > LARGEST_PROJECT:
            raise ValueError(f"{len(octets)} bytes are too many")
        text = octets.decode().removeprefix("\ufeff")
        body = tomllib.loads(text)
    except RecursionError:
        return {}, {}, [Diagnostic(name, 1, 1, "SC-P01", "Not TOML that can be read: brackets in brackets.")]
    except UnicodeDecodeError as error:
        before = octets[: error.start].decode().removeprefix("\ufeff").split("\n")
        wrong = f"Not TOML: this is not UTF-8: the byte 0x{octets[error.start]:02X} cannot stand here."
        return {}, {}, [Diagnostic(name, len(before), len(before[-1]) + 1, "SC-P01", wrong)]
    except ValueError as error:
        return {}, {}, [_not_toml(name, octets, str(error))]
    called = {word: key for word, key in OTHER_WORDS.items() if word in body and key not in body}
    body = {called.get(key, key): value for key, value in body.items()}
    lines = {(called.get(keys[0], keys[0]), *keys[1:]): line for keys, line in _lines(text) if keys}
    written = {key: word for word, key in called.items()}
    problems = [_problem(name, octets, lines, *one) for one in _wrong(body, written)]
    return body, lines, sorted(problems, key=lambda one: one.order)


def _not_toml(name: str, octets: bytes, said: str) -> Diagnostic:
    """Why a file is no TOML; the parser says where in words alone (before Python 3.14)."""
    place = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)$", said)
    line, column = 1, 1
    if place is not None and place[1]:
        line, column = int(place[1]), int(place[2])
    elif place is not None:
        last = octets.decode().removeprefix("\ufeff").split("\n")
        line, column = len(last), len(last[-1]) + 1
    problem = said[: place.start()] if place else said
    hint = " Text stands in quotes." if problem == "Invalid value" else ""
    return Diagnostic(name, line, column, "SC-P01", f"Not TOML: {problem}.{hint}")


def _wrong(body: Mapping[str, Any], written: Mapping[str, str]) -> Iterator[tuple[tuple[str, ...], str, str]]:
    """What is wrong with the tables of a file: the key, the code and a sentence for each problem.

    `written` has the words that the file has in place of keys.
    """
    for key, value in body.items():
        if key == BIND:
            yield from _wrong_bindings(value)
        elif key in OTHER_WORDS:
            yield (key,), "SC-P02", f"The key {key!r} is another word for {OTHER_WORDS[key]!r}; give one of them."
        elif key not in PROJECT_KEYS:
            yield (key,), "SC-P02", f"There is no key {key!r}; the keys are {', '.join([*PROJECT_KEYS, BIND])}."
        elif wrong := PROJECT_KEYS[key].wrong(value):
            yield (key,), "SC-P03", f"The key {written.get(key, key)!r} {wrong}."
    if "ads" in body and "endpoint" in body:
        yield ("endpoint",), "SC-P04", "The keys 'ads' and 'endpoint' name two ecologies; give one of them."


def _wrong_bindings(value: object) -> Iterator[tuple[tuple[str, ...], str, str]]:
    if not isinstance(value, dict):
        yield (BIND,), "SC-P03", f"The key {BIND!r} takes a table for each template, such as [bind.navigate]."
        return
    for template, bound in value.items():
        if not isinstance(bound, dict):
            message = f"{template!r} of {BIND} is no table of parameters and values: [{BIND}.TEMPLATE] is one."
            yield (BIND, template), "SC-P03", message
            continue
        for name, given in bound.items():
            if wrong := _is_value(given):
                yield (BIND, template, name), "SC-P03", f"The parameter {name!r} {wrong}."


def _problem(
    name: str, octets: bytes, lines: Mapping[tuple[str, ...], int], keys: tuple[str, ...], code: str, message: str
) -> Diagnostic:
    # A key whose table has no line of its own, as in `bind.navigate = 3`, is where the longest key begins that has it.
    line = lines.get(keys) or min((at for key, at in lines.items() if key[: len(keys)] == keys), default=1)
    source = octets.decode().split("\n")[line - 1].rstrip("\r")  # as TOML counts lines
    column = len(source) - len(source.lstrip()) + 1
    return Diagnostic(name, line, column, code, message, width=len(source.strip()), source=source)


def _lines(text: str) -> Iterator[tuple[tuple[str, ...], int]]:
    """The keys of a TOML document, each with the line on which it begins.

    No part of a value that goes over several lines is TOML by itself, so the lines up to the first at which there is
    some hold one key, or the head of one table.
    """
    table: tuple[str, ...] = ()
    waiting: list[str] = []
    for number, line in enumerate(text.split("\n"), 1):
        if not waiting and not line.split("#")[0].strip():
            continue
        waiting.append(line)
        try:
            said = tomllib.loads("\n".join(waiting))
        except tomllib.TOMLDecodeError:
            continue
        keys = tuple(_path(said))
        if waiting[0].lstrip().startswith("["):
            table = keys
        yield (keys if waiting[0].lstrip().startswith("[") else table + keys), number - len(waiting) + 1
        waiting.clear()


def _path(said: object) -> Iterator[str]:
    """The path to the one value of a document with one key; an inline table is taken for a path as well."""
    while isinstance(said, dict) and len(said) == 1:
        ((key, said),) = said.items()
        yield key


def _settled(body: Mapping[str, Any], folder: Path) -> Iterator[tuple[str, Any]]:
    for key, value in body.items():
        if key in PROJECT_KEYS:
            setting = PROJECT_KEYS[key]
            if setting.paths:
                found = [Path(os.path.relpath(folder / text)) for text in _listed(value)]
                yield key, found if setting.several else found[0]
            else:
                yield key, _listed(value) if setting.several else value


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]
