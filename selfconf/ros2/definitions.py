"""Definitions of messages, services and actions of ROS 2: read from files, and made into the types that travel.

A file `PACKAGE/msg/NAME.msg`, `PACKAGE/srv/NAME.srv` or `PACKAGE/action/NAME.action` says the fields, line by line
(`TYPE NAME`); a line of three dashes separates request from response, or goal, result and feedback. Constants and
defaults are passed over: neither the bytes nor the hash of a type (REP 2011) has them.

What is defined so is several types. A service is a request, a response, and what the hash of the service is computed
of. An action is two services more, which send a goal and ask for its result, and a message with its feedback; all of
them name the goal by a UUID (the design "Actions" of ROS 2).
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from selfconf.errors import AuthorError
from selfconf.ros2.services import EVENT_INFO

REQUEST, RESPONSE, EVENT = "_Request", "_Response", "_Event"
"""What the names of the parts of a service end in."""
GOAL, RESULT, FEEDBACK = "_Goal", "_Result", "_Feedback"
"""What the names of the parts of an action end in."""
SEND_GOAL, GET_RESULT, FEEDBACK_MESSAGE = "_SendGoal", "_GetResult", "_FeedbackMessage"
"""What the names of the services and of the messages end in that an action is made of."""
MOST_FILES, MOST_OCTETS = 20_000, 1_000_000
"""How many files are read below the folders that are named, and how long one may be."""
_SECTIONS = {"msg": 1, "srv": 2, "action": 3}
"""How many parts a definition has, by its folder and the ending of its file."""
_PACKAGE, _NAME = re.compile(r"[a-z][a-z0-9_]*"), re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_CONSTANT = re.compile(r"\S+\s+[A-Za-z]\w*\s*=")
_FIELD = re.compile(r"(?P<type>\S+)\s+(?P<name>[A-Za-z]\w*)(?:\s|$)")
_WIDE = re.compile(r"wstring\b")

FieldTypes = list[tuple[str, Any]]
"""The names of fields, with their types as `rosbags` says them."""
TypesByName = dict[str, tuple[list[Any], FieldTypes]]
"""Constants, of which there are none here, and fields, by the names of types: what `rosbags` registers."""


class InterfaceDefinition(NamedTuple):
    """A message, a service or an action, as its definition says it."""

    name: str
    """Such as `nav_msgs/msg/Path` or `example_interfaces/action/Fibonacci`."""
    text: str
    file: str | None = None
    """Where it was read, for errors."""


def read_definitions(folders: Iterable[Path], leave_out: list[AuthorError]) -> list[InterfaceDefinition]:
    """Read the definitions below some folders, which may be the `share` folder of an installation or of a workspace.

    What cannot be read is added to `leave_out`. Of two definitions of one name the first counts. Raises AuthorError if
    a folder is not there, has no definition below it, or if there are more than 20,000.
    """
    found: dict[str, InterfaceDefinition] = {}
    number = 0
    for folder in folders:
        if not folder.is_dir():
            raise AuthorError(f"there is no folder {folder} with definitions of ROS 2")
        before = number
        for path in _files(folder.resolve()):
            number += 1
            if number > MOST_FILES:
                raise AuthorError(f"there are more than {MOST_FILES} definitions of ROS 2 below {folder}; name less")
            try:
                definition = _read(path)
            except AuthorError as error:
                leave_out.append(error)
            else:
                found.setdefault(definition.name, definition)
        if number == before:
            raise AuthorError(f"there is no definition of ROS 2 below {folder}, such as lab_msgs/msg/Mood.msg")
    return list(found.values())


def _files(folder: Path) -> Iterator[Path]:
    """The definitions below a folder in a fixed order; one that lies elsewhere than in a folder of its kind is none."""
    paths = itertools.chain.from_iterable(folder.rglob(f"*.{kind}") for kind in _SECTIONS)
    yield from sorted(path for path in paths if path.parent.name == path.suffix[1:])


def _read(path: Path) -> InterfaceDefinition:
    """Read a file. Raises AuthorError."""
    package, kind, name = path.parent.parent.name, path.parent.name, path.stem
    if not (_PACKAGE.fullmatch(package) and _NAME.fullmatch(name)):
        raise AuthorError(f"{package}/{kind}/{name} is no name of a type of ROS 2", file=str(path))
    try:
        if path.stat().st_size > MOST_OCTETS:
            raise AuthorError(f"is longer than {MOST_OCTETS} octets, as no definition is", file=str(path))
        return InterfaceDefinition(f"{package}/{kind}/{name}", path.read_text("utf-8-sig"), str(path))
    except (OSError, UnicodeDecodeError) as error:
        raise AuthorError(f"cannot be read: {error}", file=str(path)) from None


def defined_types(definition: InterfaceDefinition) -> TypesByName:
    """The types that a definition makes. Raises AuthorError with file and line."""
    package, kind, _ = definition.name.split("/")
    parts = [_parsed(definition.file, package, lines) for lines in _parts(definition, _SECTIONS[kind])]
    if kind == "srv":
        found = _service(definition.name, *parts)
    elif kind == "action":
        found = _action(definition.name, *parts)
    else:
        found = {definition.name: parts[0]}
    return {name: ([], fields) for name, fields in found.items()}


def _parts(definition: InterfaceDefinition, number: int) -> list[list[tuple[int, str]]]:
    """The lines of each part of a definition, with their numbers. Raises AuthorError if there are not so many parts."""
    parts: list[list[tuple[int, str]]] = [[]]
    for line, text in enumerate(definition.text.splitlines(), 1):
        if text.rstrip() == "---":
            parts.append([])
            if len(parts) > number:
                raise AuthorError(f"this begins part {len(parts)} of {number}", file=definition.file, line=line)
        else:
            parts[-1].append((line, text))
    if len(parts) < number:
        wanted = "the request from the response" if number == 2 else "goal, result and feedback"
        raise AuthorError(
            f"the file ends before part {number}; lines of three dashes separate {wanted}",
            file=definition.file,
            line=max(1, len(definition.text.splitlines())),
        )
    return parts


def _parsed(file: str | None, package: str, lines: Sequence[tuple[int, str]]) -> FieldTypes:
    """The fields that some lines say. Raises AuthorError."""
    from rosbags.typesys import TypesysError, get_types_from_msg

    found: FieldTypes = []
    for number, line in lines:
        text = line.strip()
        if not text or text.startswith("#") or _CONSTANT.match(text):
            continue
        said = _FIELD.match(text.partition("#")[0])
        if _WIDE.match(text):
            raise AuthorError("wstring is a type that rosbags does not read", file=file, line=number)
        try:
            if said is None:
                raise TypesysError
            types = get_types_from_msg(f"{said['type']} {said['name']}\n", f"{package}/msg/_")
        except TypesysError:
            raise AuthorError(f"{text[:80]!r} is neither a field nor a constant", file=file, line=number) from None
        (((_, fields),),) = (types.values(),)
        if any(fields[0][0].lower() == name.lower() for name, _ in found):
            raise AuthorError(f"there is a field {fields[0][0]} already", file=file, line=number)
        found.append((fields[0][0], _as_hashed(fields[0][1])))
    return found


def _as_hashed(kind: Any) -> Any:
    """A type as it stands in hashes: a `char` of ROS 2 is an uint8, while rosbags takes it for the one of IDL."""
    from rosbags.interfaces import Nodetype

    tag, detail = kind
    if tag in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        return tag, (_as_hashed(detail[0]), detail[1])
    return (tag, ("uint8", 0)) if tag == Nodetype.BASE and detail[0] == "char" else kind


def _named(name: str) -> Any:
    from rosbags.interfaces import Nodetype

    return Nodetype.NAME, name


def _base(name: str) -> Any:
    from rosbags.interfaces import Nodetype

    return Nodetype.BASE, (name, 0)


def _service(name: str, request: FieldTypes, response: FieldTypes) -> dict[str, FieldTypes]:
    from rosbags.interfaces import Nodetype

    ends = (REQUEST, RESPONSE)
    once = [(end[1:].lower(), (Nodetype.SEQUENCE, (_named(name + end), 1))) for end in ends]
    return {
        name + REQUEST: request,
        name + RESPONSE: response,
        name + EVENT: [("info", _named(EVENT_INFO)), *once],
        name: [(f"{end[1:].lower()}_message", _named(name + end)) for end in (*ends, EVENT)],
    }


def _action(name: str, goal: FieldTypes, result: FieldTypes, feedback: FieldTypes) -> dict[str, FieldTypes]:
    identifier = ("goal_id", _named("unique_identifier_msgs/msg/UUID"))
    accepted = [("accepted", _base("bool")), ("stamp", _named("builtin_interfaces/msg/Time"))]
    ended = [("status", _base("int8")), ("result", _named(name + RESULT))]
    return {
        name + GOAL: goal,
        name + RESULT: result,
        name + FEEDBACK: feedback,
        name + FEEDBACK_MESSAGE: [identifier, ("feedback", _named(name + FEEDBACK))],
        **_service(name + SEND_GOAL, [identifier, ("goal", _named(name + GOAL))], accepted),
        **_service(name + GET_RESULT, [identifier], ended),
    }


def complete_types(types: TypesByName, known: Iterable[str]) -> tuple[TypesByName, dict[str, str]]:
    """The types, among some, whose parts are all known or among them, and why each of the others is left out.

    A type that is made of itself is never complete.
    """
    complete = dict.fromkeys(known)
    needed = {name: _parts_of(fields) for name, (_, fields) in types.items()}
    found: TypesByName = {}
    while ready := [name for name in types if name not in found and needed[name] <= complete.keys()]:
        found.update((name, types[name]) for name in ready)
        complete.update(dict.fromkeys(ready))
    return found, {name: _missing(needed[name], complete) for name in types if name not in found}


def _parts_of(fields: FieldTypes) -> set[str]:
    """The names of the types that some fields have."""
    from rosbags.interfaces import Nodetype

    inner = (detail[0] if tag in (Nodetype.ARRAY, Nodetype.SEQUENCE) else (tag, detail) for _, (tag, detail) in fields)
    return {detail for tag, detail in inner if tag == Nodetype.NAME}


def _missing(needed: set[str], complete: Mapping[str, object]) -> str:
    return f"has {', '.join(sorted(needed - complete.keys())[:5])}, of which the fields are not known"
