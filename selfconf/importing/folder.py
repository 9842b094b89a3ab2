"""The folder that an import writes to: its own files are replaced where they differ, all others are left alone."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from pathlib import Path

from selfconf.errors import AuthorError
from selfconf.importing.turtle_text import MARK
from selfconf.model.setting_names import setting


class FileState(Enum):
    """What an import has done to a file."""

    NEW = "new"
    CHANGED = "changed"
    UNCHANGED = "unchanged"


def write_folder(folder: Path, texts: Mapping[str, str]) -> dict[str, FileState]:
    """Write files, by their names below a folder. A file that stays the same is not touched.

    Raises AuthorError, and writes nothing, if one of them is there and is not from an import; or if writing fails.
    """
    states = {name: _state(folder / name, text) for name, text in texts.items()}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, state in states.items():
            if state is not FileState.UNCHANGED:
                _replace(folder / name, texts[name])
    except OSError as error:
        raise AuthorError(f"cannot write to {folder}: {error.strerror}; {_advice()}") from None
    return states


def _advice() -> str:
    return f"give another folder with {setting('out')}"


def _state(path: Path, text: str) -> FileState:
    try:
        before = path.read_bytes()
    except FileNotFoundError:
        return FileState.NEW
    except OSError as error:
        raise AuthorError(f"cannot write to {path}: {error.strerror}; {_advice()}") from None
    if not before.startswith(MARK.encode()):
        raise AuthorError(f"{path} is not from an import, and is not overwritten; {_advice()}")
    return FileState.UNCHANGED if before == text.encode() else FileState.CHANGED


def _replace(path: Path, text: str) -> None:
    """Write a file whole or not at all: a site may be reading it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    written = path.with_name(f".{path.name}.new")
    try:
        written.write_bytes(text.encode())
        written.replace(path)
    finally:
        written.unlink(missing_ok=True)
