"""Where the options of a command have their values from: the command line, the environment, or the project file.

An option that has a key in the project file is found by its name in the parser (`dest`), so that a command declares it
as any other. What the file says takes the place of the default before anything is parsed, and is filled in afterwards,
because argparse would add what is typed to a default that is a list.
"""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from selfconf.errors import AuthorError
from selfconf.model.wording import listed
from selfconf.project import PROJECT_KEYS, Project, project_path, read_project

VARIABLES: Mapping[str, str] = {
    "ecology": "SELFCONF_ECOLOGY",
    "connect": "SELFCONF_CONNECT",
    "keys": "SELFCONF_KEYS",
}
# Those of `selfconf.rendezvous`, which is not loaded to parse arguments; a test compares them.
NAMING = ("ads", "endpoint", "ecology", "connect")
"""The options that say which ecology is meant: where one of them is given, the file's `ads` and `endpoint` are not."""


class Settings:
    """The values of options that are not typed."""

    def __init__(self, project: Project | None = None, environment: Mapping[str, str] | None = None) -> None:
        """Without a project the project file has no part in it."""
        self.project = project or Project()
        self._environment = {} if environment is None else environment
        self._defaults: dict[str, Any] = {}
        self.concerned = False
        """Whether the command has an option that a project file can have a value for."""

    def declare(self, parser: argparse.ArgumentParser) -> None:
        """Let the options of a command have their values from elsewhere, and their help say from where.

        Those of the commands below it, too.
        """
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                for below in dict.fromkeys(action.choices.values()):
                    self.declare(below)
                continue
            self.concerned |= action.dest in PROJECT_KEYS
            source = self._source(action.dest) if action.option_strings else ""
            if source:
                action.help = _without_default(action.help or "") + f" (now {source})"
            if action.option_strings and action.dest in self.project.values:
                self._defaults[action.dest], action.default = action.default, argparse.SUPPRESS

    def fill(self, given: argparse.Namespace) -> None:
        """Give every option that was not typed its value, and the arguments the project."""
        from_environment = {dest for dest, variable in VARIABLES.items() if self._environment.get(variable)}
        named = (from_environment & set(NAMING)) | {dest for dest in NAMING if getattr(given, dest, None)}
        given.project, given.from_project = self.project, set()
        for dest, default in self._defaults.items():
            if hasattr(given, dest):
                continue
            hidden = dest in from_environment or (dest in ("ads", "endpoint") and named)
            setattr(given, dest, default if hidden else self.project.values[dest])
            if not hidden:
                given.from_project.add(dest)

    def _source(self, dest: str) -> str:
        """Where an option that is not typed has its value from, and the value; empty if it has its own default."""
        variable = VARIABLES.get(dest, "")
        if self._environment.get(variable):
            return f"{self._environment[variable]}, from ${variable}".replace("%", "%%")
        if dest == "bind" and self.project.bound:
            return f"those for {listed(self.project.bound)}, from {self.project.path}".replace("%", "%%")
        if dest not in self.project.values:
            return ""
        value = self.project.values[dest]
        said = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
        return f"{said}, from {self.project.place(dest)}".replace("%", "%%")


def _without_default(text: str) -> str:
    """The help of an option without what it says of its default, which does not count now."""
    return re.sub(r" \(default: [^()]*(\([^()]*\)[^()]*)*\)$", "", text)


def found_settings(complain: Callable[[str], None]) -> tuple[Settings, AuthorError | None]:
    """The settings of the current folder and the environment, and what is wrong with the project file, if anything."""
    try:
        path = project_path(Path.cwd(), complain)
    except OSError:  # the current folder is gone
        return Settings(environment=os.environ), None
    if path is None:
        return Settings(environment=os.environ), None
    try:
        return Settings(read_project(path), os.environ), None
    except AuthorError as error:
        return Settings(Project(Path(os.path.relpath(path))), os.environ), error
