"""Messages of ROS 2: their types by name and hash, CDR as the bytes that travel, and their fields as an object.

A signal that is a message travels as CDR (XCDR1, as ROS 2 writes it) with the media type `application/cdr`, which says
of which type it is, so that it goes from node to node as it is, and is read only where something else receives it.
Which types there are is known by `rosbags`, the extra `ros2`, for the distributions jazzy, kilted and lyrical; a type
is the one that is meant if its hash is (REP 2011). So it is with services, of which `services` knows some: what
travels is a request or a response, and the hash is that of the service, which says that of both. An action is two
services and a message. Other types, services and actions are known by their definitions (`definitions`), in folders
that a program is given (`learn`) or that SELFCONF_ROS_DEFINITIONS names, separated by colons: so that every component
that is started beside the program reads them too.
"""

from __future__ import annotations

import importlib.util
import keyword
import os
import re
import reprlib
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from selfconf.errors import AuthorError
from selfconf.ros2 import services
from selfconf.ros2.definitions import (
    REQUEST,
    RESPONSE,
    InterfaceDefinition,
    TypesByName,
    complete_types,
    defined_types,
    read_definitions,
)

MEDIA = "application/cdr"
HASH = re.compile(r"RIHS01_[0-9a-f]{64}")
NAME = re.compile(r"[a-z][a-z0-9_]*/(?:msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
_MEDIA = re.compile(rf'{re.escape(MEDIA)}; type="(?P<name>[^"]*)"; hash=(?P<hash>\w+)(?:; topic="(?P<topic>[^"]*)")?')
_STORES = ("ROS2_JAZZY", "ROS2_KILTED", "ROS2_LYRICAL")
_NO_FIELD = "structure_needs_at_least_one_member"
"""What stands in messages that have no fields."""
DEFINITIONS = "SELFCONF_ROS_DEFINITIONS"
"""The variable of the environment that names folders with definitions, separated as those of PATH are."""
_DTYPES = {"octet": "uint8", "byte": "uint8", "char": "uint8"}
"""The elements of arrays that NumPy calls otherwise."""


class MessageError(ValueError):
    """Bytes or an object that are no message of a type; the text is a sentence without its subject."""


class MessageType(NamedTuple):
    """A type of messages, as `sensor_msgs/msg/LaserScan`, and the hash of its definition."""

    name: str
    hash: str

    def media(self, topic: str = "") -> str:
        """The media type of its messages, which may say on which topic of which domain they were published."""
        where = f'; topic="{topic}"' if topic else ""
        return f'{MEDIA}; type="{self.name}"; hash={self.hash}{where}'


class MessageMedia(NamedTuple):
    """What the media type of a message says."""

    type: MessageType
    topic: str
    """Where it was published: the domain, then the topic; empty if it was not said."""


@lru_cache(maxsize=256)
def read_media(media: str) -> MessageMedia | None:
    """What a media type says; None if it is that of no message."""
    found = _MEDIA.fullmatch(media)
    return found and MessageMedia(MessageType(found["name"], found["hash"]), found["topic"] or "")


def load() -> None:
    """Load the types that are known, and what reads and writes them; else the first use of one takes a second."""
    text = usual_type("std_msgs/msg/String")
    if text is not None:
        message_fields(message({}, text), text)


def is_known(kind: MessageType) -> bool:
    """Whether the fields of a type are known, so that it can be read and written here."""
    return _store(kind) is not None


def received(value: Any, media: str) -> Any:
    """A signal as code likes it: a message of a known type as its fields, everything else as it is.

    Raises MessageError.
    """
    said = read_media(media) if media.startswith(MEDIA) and isinstance(value, bytes) else None
    return value if said is None or not is_known(said.type) else message_fields(value, said.type)


def message_fields(payload: bytes, kind: MessageType) -> dict[str, Any]:
    """The fields of a message of a known type, nested ones as objects, arrays of numbers as those of NumPy.

    Raises MessageError.
    """
    found: dict[str, Any] = _plain(_store(kind), _read(payload, kind))
    return found


def check_message(payload: bytes, kind: MessageType) -> None:
    """Raise MessageError if bytes are no message of a known type."""
    _read(payload, kind)


def message(fields: Mapping[str, Any], kind: MessageType) -> bytes:
    """Write a message of a known type; a field that is not given is zero, empty or false. Raises MessageError."""
    store = _store(kind)
    try:
        return bytes(store.serialize_cdr(_built(store, kind.name, fields), kind.name))
    except MessageError:
        raise
    except (_serde_error(), TypeError, ValueError, LookupError, OverflowError, AttributeError, struct.error) as error:
        raise MessageError(f"is no {kind.name}: {error}") from None


class ServiceParts(NamedTuple):
    """The types of what a service is asked and of what it answers."""

    request: MessageType
    response: MessageType


@lru_cache(maxsize=256)
def service_parts(kind: MessageType) -> ServiceParts | None:
    """The types of the parts of a service; None if it is not known."""
    store = _store(kind)
    if store is None or kind.name + REQUEST not in store.fielddefs:
        return None
    names = (kind.name + REQUEST, kind.name + RESPONSE)
    return ServiceParts(*(MessageType(name, store.hash_rihs01(name)) for name in names))


def named_folders() -> list[Path]:
    """The folders with definitions that the environment names."""
    return [Path(folder) for folder in os.environ.get(DEFINITIONS, "").split(os.pathsep) if folder]


def learn(folders: Sequence[Path]) -> list[AuthorError]:
    """Know the types too that are defined below some folders, and no more what was learned before.

    What is left out of them, and why, is returned. It is for the beginning of a program, before others ask for types.
    Raises AuthorError where a folder is not there or has no definition.
    """
    left_out: list[AuthorError] = []
    types: TypesByName = {}
    files: dict[str, str | None] = {}
    for definition in read_definitions(folders, left_out):
        try:
            found = defined_types(definition)
        except AuthorError as error:
            left_out.append(error)
        else:
            types.update(found)
            files.update(dict.fromkeys(found, definition.file))
    for cached in (_stores, _store, _read_fields, service_parts):
        cached.cache_clear()
    stores, missing = _stores_with({**_known_types(), **types}) if types else ((), {})
    _learned[:] = stores
    first = {files[name]: name for name in reversed(missing)}  # what depends on it in the same file is left out as well
    return left_out + [AuthorError(f"left out, as {name} {missing[name]}", file=file) for file, name in first.items()]


def _read(payload: bytes, kind: MessageType) -> Any:
    try:
        return _store(kind).deserialize_cdr(payload, kind.name)
    except (_serde_error(), ValueError, OverflowError, AssertionError, IndexError, MemoryError, struct.error) as error:
        raise MessageError(f"is no {kind.name}: {error}") from None


@cache
def _serde_error() -> type[Exception]:
    from rosbags.serde import SerdeError

    found: type[Exception] = SerdeError
    return found


@lru_cache(maxsize=1024)
def _store(kind: MessageType) -> Any:
    """The types of the distribution in which a type of this name has this hash; None if there is none."""
    for store in _stores():
        if kind.name in store.fielddefs and store.hash_rihs01(kind.name) == kind.hash:
            return store
    return None


_learned: list[Any] = []
"""The types of each distribution together with those that were learned, where there are such."""


@cache
def _stores() -> tuple[Any, ...]:
    """The types of each distribution, the oldest first, and then those with what was learned."""
    if importlib.util.find_spec("rosbags") is None:
        return ()
    if not _learned:
        learn(named_folders())
    return (*_stores_with(_known_types())[0], *_learned)


@cache
def _known_types() -> TypesByName:
    """The types that are known besides those of a distribution, by their definitions."""
    known = (InterfaceDefinition(*each) for each in services.KNOWN_DEFINITIONS.items())
    return {name: fields for each in known for name, fields in defined_types(each).items()}


def _stores_with(types: TypesByName) -> tuple[tuple[Any, ...], dict[str, str]]:
    """The types of each distribution, with others that go before its own; why each is left out that none can have."""
    from rosbags.typesys import Stores, get_typestore

    stores, left_out = [], dict[str, str]()
    for index, name in enumerate(_STORES):
        store = get_typestore(Stores[name])
        found, missing = complete_types(types, store.fielddefs.keys() - types.keys())
        for each in found:
            store.fielddefs.pop(each, None)
            store.types.pop(each, None)
        known = {each: _made[each] for each in found if each in _made and _made[each].said == found[each]}
        store.register({each: said for each, said in found.items() if each not in known})
        for each, made in known.items():
            store.fielddefs[each], store.types[each] = made.definition, made.of_messages
        _made.update((each, _MadeType(found[each], store.fielddefs[each], store.types[each])) for each in found)
        stores.append(store)
        left_out = {name: why for name, why in missing.items() if not index or name in left_out}
    return tuple(stores), left_out


class _MadeType(NamedTuple):
    """What rosbags makes of what is said of a type; most of its time goes into the class of the messages."""

    said: Any
    definition: Any
    of_messages: type


_made: dict[str, _MadeType] = {}
"""What was made of each type at last: the distributions share it, as it names the types of the fields, and no more."""


def usual_type(name: str) -> MessageType | None:
    """The type of a name in the oldest distribution that has it; None if none has."""
    store = next((one for one in _stores() if name in one.fielddefs), None)
    return None if store is None else MessageType(name, store.hash_rihs01(name))


def _plain(store: Any, value: Any) -> Any:
    """A message as an object, with those that it holds; the constants of its type are no fields."""
    if hasattr(value, "__msgtype__"):
        fields = _read_fields(store, value.__msgtype__)
        return {name: plain(store, getattr(value, attribute)) for name, attribute, plain in fields}
    return [_plain(store, each) for each in value] if isinstance(value, list) else value


@lru_cache(maxsize=1024)
def _read_fields(store: Any, name: str) -> Sequence[tuple[str, str, Callable[[Any, Any], Any]]]:
    """The fields of a type that are read, each with its attribute in the class of messages, and what makes it plain."""
    from rosbags.interfaces import Nodetype

    byte = Nodetype.BASE, ("byte", 0)
    found = []
    for field, definition in _definitions(store, name):
        of_bytes = definition == byte or (isinstance(definition[1], tuple) and definition[1][0] == byte)
        if field != _NO_FIELD:
            found.append((field, _attribute(field), _unsigned if of_bytes else _plain))
    return found


def _unsigned(_: Any, value: Any) -> Any:
    """A `byte`, or an array, as ROS 2 means it, from 0 to 255; rosbags reads and writes it with a sign."""
    return value % 256 if isinstance(value, int) else value.view("uint8")


def _attribute(field: str) -> str:
    """What the class of a message calls a field."""
    return f"{field}_" if keyword.iskeyword(field) else field


def _built(store: Any, name: str, fields: Any) -> Any:
    """An object as a message of a type."""
    if not isinstance(fields, Mapping):
        raise MessageError(f"is no object, where {name} has fields")
    definitions = dict(_definitions(store, name))
    unknown = sorted(map(str, fields.keys() - definitions.keys()))
    if unknown:
        raise MessageError(f"has {', '.join(unknown[:5])}, which {name} has not")
    values = {field: _value(store, definition, fields.get(field)) for field, definition in definitions.items()}
    return store.types[name](**{_attribute(field): value for field, value in values.items()})


def _definitions(store: Any, name: str) -> Iterator[tuple[str, Any]]:
    _, fields = store.fielddefs[name]
    yield from fields


def _value(store: Any, definition: Any, given: Any) -> Any:
    """The value of a field; None stands for one that is not given."""
    from rosbags.interfaces import Nodetype

    kind, detail = definition
    if kind == Nodetype.NAME:
        return _built(store, detail, {} if given is None else given)
    if kind == Nodetype.BASE:
        value = _base(detail[0], detail[1], given)
        return value - 256 if detail[0] == "byte" and value in range(128, 256) else value
    element, count = detail
    if given is None:
        given = [None] * (count if kind == Nodetype.ARRAY else 0)
    values = _elements(store, element, given)
    if kind == Nodetype.SEQUENCE and 0 < count < len(values):  # rosbags would write them all
        raise MessageError(f"has {len(values)} elements in a field that takes {count} at most")
    return values


def _elements(store: Any, element: Any, given: Any) -> Any:
    """The elements of an array or sequence: numbers as an array of NumPy, all else as a list."""
    from rosbags.interfaces import Nodetype

    if element[0] == Nodetype.BASE and element[1][0] not in ("string", "wstring"):
        return _numbers(element[1][0], given)
    if isinstance(given, str | bytes | Mapping):  # of a text Python would make its letters
        raise MessageError(f"has a value that is no {element[1] if element[0] == Nodetype.NAME else element[1][0]}[]")
    return [_value(store, element, one) for one in given]


def _numbers(datatype: str, given: Any) -> Any:
    """Numbers as an array of NumPy, which by itself makes 44 of 300 as `uint8`, and 1 of 1.7. Raises MessageError."""
    import numpy

    if isinstance(given, list | tuple):
        given = [0 if one is None else one for one in given]
    numbers = numpy.frombuffer(given, "uint8") if isinstance(given, bytes | bytearray) else numpy.asarray(given)
    wanted = numpy.dtype(_DTYPES.get(datatype, datatype))
    if numbers.ndim == 1 and numbers.dtype.kind in "biuf":
        if numbers.dtype.kind == "f" and wanted.kind in "iu":  # so NumPy has 2**63 beside 1, to the next double
            numbers = numpy.asarray(given, object)
        with numpy.errstate(all="ignore"):
            made = numbers.astype(wanted)
        if numpy.array_equal(*((made, numbers) if wanted.kind != "f" else map(numpy.isfinite, (made, numbers)))):
            return made
    raise MessageError(f"has a value that is no {datatype}[]")


def _base(datatype: str, most: int, given: Any) -> Any:
    """The value of a field that is no message; a text has `most` octets at most, where that is not zero."""
    if given is not None:
        if most and isinstance(given, str) and len(given.encode()) > most:  # rosbags would write it in full
            raise MessageError(f"has a text of {len(given.encode())} octets in a field that takes {most} at most")
        if datatype == "bool" and given not in (True, False):  # of a text Python would make true, whatever it says
            raise MessageError(f"has {reprlib.repr(given)[:40]}, where a bool is true or false")
        return given
    if datatype in ("string", "wstring"):
        return ""
    return False if datatype == "bool" else 0.0 if datatype.startswith("float") else 0
