"""Modules of tests prepared once where pytest-xdist runs them in several processes.

Every process collects every module. In a fresh clone none is compiled, and to write its assertions anew takes pytest
longer than all else of collecting: four processes that begin with the same module do all of it four times. Where each
begins with another share, it finds the rest compiled by the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]


def prepare(arguments: Sequence[str], process: Mapping[str, Any]) -> None:
    """Import a process's share of the modules that the arguments of pytest name, by files or folders.

    What cannot be imported is left out: it is told when it is collected.
    """
    number, processes = int(process["workerid"].removeprefix("gw")), process["workercount"]
    for module in named(arguments)[number % processes :: processes]:
        with suppress(Exception, pytest.skip.Exception):
            import_module(module)


def named(arguments: Sequence[str]) -> list[str]:
    """Return the names of the modules of tests in files and folders, some of whose tests may be named after `::`."""
    places = [Path(argument.partition("::")[0]).absolute() for argument in arguments]
    files = {file for place in places for file in (place.rglob("test_*.py") if place.is_dir() else [place])}
    return [".".join(file.relative_to(ROOT).with_suffix("").parts) for file in sorted(files) if ROOT in file.parents]
