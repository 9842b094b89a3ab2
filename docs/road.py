"""How much of selfconf a task goes through: the files of which functions run, by room.

    python -m docs.road                    the roads of `configure` and of a run with a repair
    python -m docs.road configure --files  the files of one of them, with the functions that run in each

A function counts that is called once its module is loaded; what only loads is no part of the road. A room is a folder,
or a file beside the folders. Each road is measured in a process of its own, as caches would hide what ran before.
"""

from __future__ import annotations

import argparse
import inspect
import io
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from types import FrameType
from typing import Any

import selfconf
from selfconf.model.profile import Input, Output, Ports, Profile
from selfconf.rdf.advertisements import Advertisement

PACKAGE = Path(selfconf.__file__).parent
EXAMPLES = PACKAGE.parent / "examples"
HANDED = (Advertisement, Profile, Ports, Input, Output)
"""What an advertisement is in the hands of a function."""


class Road:
    """The functions of selfconf that have run, each once, by file."""

    def __init__(self) -> None:
        self.functions: dict[str, set[int]] = {}
        """By file below the package, the first lines of the functions that have run."""
        self.handed: set[str] = set()
        """The files with a function that was given an advertisement, a profile or ports."""
        self._loading = 0

    def travel(self, act: Callable[[], object]) -> Road:
        """Note what runs while something is done, in every thread that it starts; returns the road."""
        threading.setprofile(self._note)
        sys.setprofile(self._note)
        try:
            act()
        finally:
            sys.setprofile(None)
            threading.setprofile(None)
        return self

    @property
    def rooms(self) -> Counter[str]:
        """How many files have a part in each room."""
        return Counter(file.rpartition("/")[0] or file for file in self.functions)

    def _note(self, frame: FrameType, event: str, _: Any) -> None:
        code = frame.f_code
        if code.co_name == "<module>":
            self._loading += (event == "call") - (event == "return")
        elif (
            event == "call" and not self._loading and code.co_flags & inspect.CO_OPTIMIZED
        ):  # a function, no class body
            path = Path(code.co_filename)
            if path.is_relative_to(PACKAGE):
                file = path.relative_to(PACKAGE).as_posix()
                self.functions.setdefault(file, set()).add(code.co_firstlineno)
                if file not in self.handed and any(map(_is_handed, frame.f_locals.values())):
                    self.handed.add(file)


def _is_handed(value: object) -> bool:
    """Whether an argument is an advertisement or a part of one, or is a collection that begins with one."""
    if isinstance(value, dict):
        value = next(iter(value.values()), None)
    elif isinstance(value, list | tuple) and not isinstance(value, HANDED):
        value = next(iter(value), None)
    return isinstance(value, HANDED)


def configure() -> None:
    """The paper's configuration, from files, on the command line."""
    from selfconf.cli.main import main

    task = [str(EXAMPLES / "navigate.ttl"), "--ads", str(EXAMPLES / "peis-home")]
    with redirect_stdout(io.StringIO()):
        assert main(["configure", *task, "--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)"]) == 0


def run() -> None:
    """A task that is deployed, loses a component, is repaired and stopped: configurator, site and components."""
    from selfconf import template
    from selfconf.sdk import Component
    from selfconf.testing import MemoryEcology

    ecology = MemoryEcology()
    text = (EXAMPLES / "clock" / "display.ttl").read_text("utf-8")
    ecology.add(Component(), EXAMPLES / "clock" / "clock.ttl")
    first = ecology.add(Component(), text)
    ecology.add(Component(), text.replace(":display", ":other-display"))
    task = ecology.run(template(EXAMPLES / "clock" / "tell-the-time.ttl")).started()
    before = task.configuration
    ecology.crash(first)
    ecology.until(lambda: task.running and task.configuration != before)
    assert before is not None
    assert task.configuration is not None
    assert task.configuration["screen"] != before["screen"]
    task.stop()


ROADS = {"configure": configure, "run": run}


def main() -> None:
    """Print the measures."""
    parser = argparse.ArgumentParser(prog="python -m docs.road", description=__doc__.partition("\n")[0])
    parser.add_argument("road", nargs="?", choices=sorted(ROADS))
    parser.add_argument("--files", action="store_true", help="name the files; * was handed an advertisement")
    given = parser.parse_args()
    if given.road is None:
        for name in sorted(ROADS):
            more = ["--files"] if given.files else []
            subprocess.run([sys.executable, "-m", "docs.road", name, *more], check=True, cwd=PACKAGE.parent)
        return
    road = Road().travel(ROADS[given.road])
    files = len(road.functions)
    functions = sum(map(len, road.functions.values()))
    print(f"{given.road}: {files} files in {len(road.rooms)} rooms, {functions} functions; ", end="")
    print(f"{len(road.handed)} files are handed an advertisement")
    print(", ".join(f"{room} {number}" for room, number in road.rooms.most_common()))
    for file in sorted(road.functions) if given.files else ():
        print(f"{len(road.functions[file]):4} {file}{' *' if file in road.handed else ''}")


if __name__ == "__main__":
    main()
