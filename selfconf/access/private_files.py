"""Files and folders that only their owner may read, with the file named in what goes wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from selfconf.errors import AuthorError, PeerError, reason

_Value = TypeVar("_Value")


def make_private_folder(folder: Path) -> None:
    """Make a folder, and those above it that are not there, for its owner alone."""
    for one in (*reversed(folder.parents), folder):
        if not one.is_dir():
            one.mkdir(mode=0o700, exist_ok=True)


def read_file(path: Path) -> bytes:
    """What a file of a folder of keys holds. Raises AuthorError where it is not there or cannot be read."""
    if path.is_fifo():  # it would be waited for
        raise AuthorError(f"{path} is no file")
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise AuthorError(f"there is no {path.name} in {path.parent}; is it a folder of keys?") from None
    except OSError as error:
        raise AuthorError(reason(error)) from None


def content(path: Path) -> bytes:
    """What a file holds; nothing if it is not there, or cannot be read."""
    try:
        return path.read_bytes() if path.is_file() else b""
    except OSError:
        return b""


def check_private(path: Path) -> None:
    """Raise AuthorError for a key that others than its owner may read."""
    if path.is_file() and path.stat().st_mode & 0o077:
        raise AuthorError(f"others may read {path}, so it is no secret; say `chmod 600 {path}`, or make a new one")


def check_unwritable(path: Path) -> None:
    """Raise AuthorError for a folder of keys, or a certificate in it, into which others than its owner may write."""
    if path.exists() and path.stat().st_mode & 0o022:
        raise AuthorError(
            f"others may write into {path}, and so have another authority believed; say `chmod go-w {path}`"
        )


def named_in_errors(path: Path, read: Callable[[], _Value]) -> _Value:
    """What is read from a file; what goes wrong is an AuthorError that names the file."""
    try:
        return read()
    except PeerError as error:
        raise AuthorError(str(error), file=str(path)) from None
    except AuthorError as error:
        if error.file is None and str(path.parent) not in error.message:
            raise AuthorError(error.message, file=str(path)) from None
        raise
