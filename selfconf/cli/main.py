"""`selfconf COMMAND`: finds the command, runs it, and turns what went wrong into one sentence and an exit code.

0 yes; 1 an honest no; 2 misuse, or input that cannot be read. Results go to stdout, everything else to stderr.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import sys
import traceback
from collections.abc import Sequence
from types import ModuleType
from typing import NoReturn

from selfconf.cli.terminal import for_programs, guard, show, silence
from selfconf.errors import SelfconfError, reason

COMMANDS = ("new", "validate", "partition", "configure", "query", "site", "discover", "run", "status", "stop", "demo")
INTERRUPTED = 130
FOR_PEOPLE = ("text", "table")
"""The formats that no program reads."""


class Parser(argparse.ArgumentParser):
    """Says in one sentence what is wrong with the arguments; the usage is a question of its own."""

    def error(self, message: str) -> NoReturn:
        """End with exit code 2."""
        self.exit(2, f"{self.prog}: {message}; see `{self.prog} --help`\n")


def command(name: str) -> ModuleType:
    """The module of a command: NAME, HELP, EXAMPLE, add_arguments, run."""
    return importlib.import_module(f"selfconf.cli.{name}")


def parser_of(name: str, module: ModuleType, subparsers: argparse._SubParsersAction[Parser]) -> None:
    """Add the parser of one command."""
    parser = subparsers.add_parser(
        name,
        help=module.HELP,
        description=module.HELP[0].upper() + module.HELP[1:] + ".",
        epilog=f"example:\n{module.EXAMPLE}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    module.add_arguments(parser)
    parser.add_argument("--debug", action="store_true", help="show tracebacks and what happens inside")
    parser.set_defaults(run=module.run, misused=parser.error)


def parser(names: Sequence[str] = COMMANDS) -> Parser:
    """The parser of the command line, or of some commands of it: those that are not asked for are not loaded."""
    top = Parser(
        prog="selfconf",
        description="Robots, sensors and home devices that wire themselves.",
        epilog="example:\n  selfconf configure examples/navigate.ttl --ads examples/peis-home"
        " --bind robot=:Astrid --bind goal='(AT BEDROOM)'",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"selfconf {_version()}")
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name in names:
        parser_of(name, command(name), subparsers)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit code."""
    guard()
    typed = sys.argv[1:] if arguments is None else arguments
    given, unknown = parser([name for name in typed[:1] if name in COMMANDS] or COMMANDS).parse_known_args(typed)
    if unknown:
        given.misused(f"unrecognized arguments: {' '.join(unknown)}")
    if getattr(given, "format", "text") not in FOR_PEOPLE:
        for_programs()
    logging.basicConfig(format="%(name)s: %(message)s", level=logging.DEBUG if given.debug else logging.ERROR)
    code: int = 0
    try:
        code = given.run(given)
        sys.stdout.flush()
        return code
    except SelfconfError as error:
        if given.debug:
            traceback.print_exc()
        show(f"selfconf {given.command}: {error}", sys.stderr)
        return 2
    except BrokenPipeError:
        silence(sys.stdout)
        return code
    except OSError as error:
        if given.debug:
            traceback.print_exc()
        show(f"selfconf {given.command}: {reason(error)}", sys.stderr)
        silence(sys.stdout)
        return 2
    except KeyboardInterrupt:
        show(f"selfconf {given.command}: interrupted", sys.stderr)
        return INTERRUPTED


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("selfconf")
    except PackageNotFoundError:
        return "from a checkout that is not installed"
