"""Files of RDF as every program of selfconf reads them: which there are, what is in them, and what that means.

A mark of the byte order is no part of the text, and a relative IRI counts from the file (RFC 3986, section 5.1.3). So a
file has one meaning, whether a command, a site or a component reads it.
"""

from __future__ import annotations

import errno
import os
import stat
import sys
from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from selfconf.errors import AuthorError, TurtleError, UnreadableError

if TYPE_CHECKING:
    from selfconf.model.signal_fields import SignalFields
    from selfconf.model.term import IRI
    from selfconf.rdf.advertisements import Advertisement, MalformedAdvertisement, SegmentCache

STDIN = Path("-")
"""What stands for standard input where a file can be given."""
MOST_READ = 1 << 30
"""The most bytes that are read of a file, or of standard input: 1 GiB. More of it cannot be meant."""
_CHUNK = 1 << 20
_NO_FILES = ((stat.S_ISFIFO, "a named pipe"), (stat.S_ISSOCK, "a socket"), (stat.S_ISCHR, "a device"))
TURTLE = (".ttl",)
"""The ending of the files that stand for a folder."""
ONTOLOGY = (".ttl", ".rdf", ".owl", ".nt", ".nq", ".trig", ".jsonld")
"""The endings of the files that stand for a folder of ontologies, which come in every format of RDF."""


def within(
    path: Path, left_out: Callable[[AuthorError], None] | None = None, endings: tuple[str, ...] = TURTLE
) -> list[Path]:
    """The files that a path stands for, sorted: all below a folder that end so, or else itself.

    Links to files are among them, also those that lead nowhere, but for the locks of editors (`.#name`). Hidden folders
    below it are passed over: `.venv`, `.git` and `.ipynb_checkpoints` hold what others wrote, or copies. A folder that
    cannot be read raises AuthorError, unless `left_out` is given, which receives the error instead.
    """
    return sorted(map(Path, stamps(path, left_out, endings))) if _is_folder(_status(path)) else [path]


FileStamp = tuple[int, ...]
"""Which file it is (device, inode), its size, and when it and what is said of it were changed last, in nanoseconds.

As long as all of these stay, so does what is in the file. Size and time alone do not tell: what unpacks or copies a
version sets the time to that of another file, and a link may lead to the file of another folder.
"""


def stamps(
    path: Path, left_out: Callable[[UnreadableError], None] | None = None, endings: tuple[str, ...] = TURTLE
) -> dict[str, FileStamp]:
    """The files that a path stands for, if they are there, as `within` finds them, in no order, with their stamps.

    It takes 4 microseconds for each file, so that a site may look at ten thousand files from time to time.
    """
    status = _status(path)
    if not _is_folder(status):
        return {} if status is None else {str(path): _stamp_of(status)}
    found: dict[str, FileStamp] = {}
    waiting = [str(path)]
    while waiting:
        folder = waiting.pop()
        try:
            with os.scandir(folder) as entries:
                for entry in entries:
                    if entry.is_dir(follow_symlinks=False):
                        if not entry.name.startswith("."):
                            waiting.append(entry.path)
                    elif entry.name.endswith(endings) and (entry.name not in endings or entry.name[0] != "."):
                        stamp = _stamp(entry)
                        if stamp is not None:
                            found[entry.path] = stamp
        except FileNotFoundError:
            continue  # it has gone since it was listed, as a file may have
        except OSError as error:
            wrong = UnreadableError(f"the folder {folder}", folder, error.strerror or str(error))
            if left_out is None:
                raise wrong from None
            left_out(wrong)
    return found


def stamp(path: Path) -> FileStamp:
    """The stamp of a file, or of a folder, which changes as files come into it and go; empty if nothing is there."""
    status = _status(path)
    return () if status is None else _stamp_of(status)


_LEADS_NOWHERE: FileStamp = ()
"""The stamp of a link to what is not there."""
_LOCK = ".#"
"""What the names of the links begin with by which editors lock files; they lead nowhere on purpose."""


def _stamp(entry: os.DirEntry[str]) -> FileStamp | None:
    """The stamp of a file in a folder; None if it is no file or has gone."""
    status = _status(entry)
    if status is not None:
        return _stamp_of(status) if stat.S_ISREG(status.st_mode) else None
    # A link that leads nowhere counts as a file, so that it is named when it is read.
    return _LEADS_NOWHERE if Path(entry.path).is_symlink() and not entry.name.startswith(_LOCK) else None


def _is_folder(status: os.stat_result | None) -> bool:
    return status is not None and stat.S_ISDIR(status.st_mode)


def _stamp_of(status: os.stat_result) -> FileStamp:
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def _status(entry: Path | os.DirEntry[str]) -> os.stat_result | None:
    """What the system knows of a file; None if it has gone."""
    try:
        return entry.stat()
    except OSError:
        return None


def is_same(one: str, other: str) -> bool:
    """Whether two paths that differ lead to one file; the names of texts that are in no file do not."""
    try:
        return one != other and Path(one).samefile(other)
    except OSError:
        return False


def listed_files(paths: Iterable[Path], endings: tuple[str, ...] = TURTLE) -> list[Path]:
    """The files, and all below the folders that end so, each once, sorted. Raises AuthorError for what is not there."""
    found: set[Path] = set()
    for path in paths:
        if path != STDIN:
            existing(path)
        found.update(within(path, endings=endings))
    return sorted(found, key=Path.absolute)


def ontology_files(paths: Iterable[Path]) -> list[Path]:
    """The ontologies that paths stand for: files in any format of RDF, all below a folder; each once, sorted.

    Raises AuthorError for what is not there.
    """
    return listed_files(paths, ONTOLOGY)


def existing(path: Path) -> Path:
    """The path, if there is something. Raises AuthorError, and UnreadableError where that cannot be seen."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        raise AuthorError(f"there is no file or folder {path}") from None
    except OSError as error:
        raise UnreadableError(str(path), str(path), error.strerror or str(error)) from None
    return path


def advertisements(
    path: Path, segments: SegmentCache | None = None
) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
    """The advertisements in a Turtle file, and those that do not conform; files may share their segments.

    Raises AuthorError for what is not there, cannot be read, or is not Turtle.
    """
    from selfconf.rdf.advertisements import read_advertisements  # loads a parser, which a list of files does not need

    return read_advertisements(text(octets(path), str(path)), str(path), base(path), segments)


def signal_fields(
    ontologies: Iterable[Path], signals: Iterable[IRI], texts: Iterable[tuple[bytes, str, str | None]] = ()
) -> dict[IRI, SignalFields]:
    """The fields of those kinds of signals of which some ontologies, or texts in Turtle, say what they consist of.

    A text goes with its name, and with the IRI that relative IRIs in it are relative to.

    Raises AuthorError for what is not there, cannot be read, or is not in the format that it seems.
    """
    from selfconf.rdf.signal_fields import SAYING, fields_of  # loads a parser
    from selfconf.rdf.turtle import parse, read_ontology

    documents = [read_ontology(text(octets(path), str(path)), str(path), base(path), SAYING) for path in ontologies]
    documents += (parse(text(found, name), name, base_iri, SAYING) for found, name, base_iri in texts)
    found = {signal: fields_of(documents, signal) for signal in signals}
    return {signal: fields for signal, fields in found.items() if fields is not None}


def octets(path: Path) -> bytes:
    """The bytes of a file. Raises AuthorError if it cannot be read."""
    try:
        return read_bounded(path)
    except IsADirectoryError:
        raise AuthorError(f"{path} is a folder; a file is needed here") from None
    except FileNotFoundError:
        if path.is_symlink():
            raise AuthorError(f"cannot read {path}: it is a link to {path.readlink()}, which is not there") from None
        raise AuthorError(f"there is no file or folder {path}") from None
    except OSError as error:
        raise UnreadableError(str(path), str(path), error.strerror or str(error)) from None


def standard_input() -> bytes:
    """What comes in on standard input, to its end. Raises AuthorError where it is closed or cannot be read."""
    if sys.stdin is None:  # so Python says that the file descriptor was closed when it began
        raise AuthorError("standard input is closed")
    try:
        return bounded(sys.stdin.buffer)
    except OSError as error:
        raise AuthorError(f"cannot read standard input: {error.strerror}") from None


def read_bounded(path: Path) -> bytes:
    """The bytes of a file. Raises OSError, also for what has no end or too much in it."""
    status = path.stat()
    _check_kind(path, status.st_mode)
    if status.st_size > MOST_READ:
        raise _too_large()
    with path.open("rb") as file:
        return bounded(file)


def bounded(stream: BinaryIO) -> bytes:
    """All that comes on a stream. Raises OSError if it is too much."""
    found: list[bytes] = []
    size = 0
    while chunk := stream.read(_CHUNK):
        found.append(chunk)
        size += len(chunk)
        if size > MOST_READ:
            raise _too_large()
    return b"".join(found)


def check_kind(path: Path) -> None:
    """Raises AuthorError for what is there and is neither file nor folder: to read it might never end."""
    status = _status(path)
    try:
        _check_kind(path, 0 if status is None else status.st_mode)
    except OSError as error:
        raise AuthorError(f"cannot read {path}: {error.strerror}") from None


def _check_kind(path: Path, mode: int) -> None:
    """Raises OSError for what is neither file nor folder, unless this program was given it open."""
    kind = next((kind for is_so, kind in _NO_FILES if is_so(mode)), None)
    if kind is not None and not _is_open_already(path):
        raise OSError(errno.EINVAL, f"it is {kind} and no file")


def _is_open_already(path: Path) -> bool:
    """Whether a path names a stream that this program has from the one that started it, as `<(command)` of a shell."""
    return path == Path("/dev/stdin") or os.path.realpath(path.parent) in ("/dev/fd", f"/proc/{os.getpid()}/fd")


def _too_large() -> OSError:
    return OSError(errno.EFBIG, f"it is larger than {MOST_READ >> 20} MiB, which cannot be meant")


def text(found: bytes, name: str) -> bytes:
    """What is to be parsed of the bytes of a source. Raises TurtleError where that cannot be text."""
    if found.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
        raise TurtleError("not Turtle: this is UTF-16, and Turtle is UTF-8; save it as that", file=name)
    if b"\0" in found:
        raise TurtleError("not Turtle: this is a binary file", file=name)
    if not found.isascii():
        from selfconf.rdf.turtle import check_utf_8  # loads a parser

        check_utf_8(found, name)
    return found.removeprefix(BOM_UTF8)


def base(path: Path) -> str:
    """The IRI that relative IRIs in a file are relative to."""
    folder = path.parent.absolute()
    whole = _resolved(folder, stamp(folder)) / path.name
    return (whole.resolve() if whole.is_symlink() else whole).as_uri()


@lru_cache(maxsize=64)
def _resolved(folder: Path, stamp: FileStamp) -> Path:
    """A folder without symbolic links, remembered: a thousand files have it in common.

    It is another one where a link to it leads elsewhere than before, as its stamp says.
    """
    return folder.resolve()
