"""How the words of a command line are parsed: one sentence for each mistake, an example in each help.

`selfconf.cli.main` makes the parser of the whole of these; a command that has actions makes one for each.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from selfconf.cli.terminal import silence
from selfconf.errors import reason

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

AnyParser = TypeVar("AnyParser", bound=argparse.ArgumentParser)


class Parser(argparse.ArgumentParser):
    """Says in one sentence what is wrong with the arguments; the usage is a question of its own."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.register("type", Path, _path)

    def parse_known_args(  # type: ignore[override]  # of its overloads one is used here
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse the arguments; where a command takes several of a kind, they may stand after its options, too.

        By itself argparse has given them none, or those before the first option, once it comes to an option.
        """
        given, unknown = super().parse_known_args(args, namespace)
        several = next((one.dest for one in self._actions if one.nargs in ("*", "+") and not one.option_strings), "")
        if several and all(word == "-" or not word.startswith("-") for word in unknown):
            setattr(given, several, [*(getattr(given, several) or ()), *unknown])
            unknown = []
        return given, unknown

    def error(self, message: str) -> NoReturn:
        """End with exit code 2."""
        self.exit(2, f"{self.prog}: {message}; see `{self.prog} --help`\n")

    def _print_message(self, message: str, file: SupportsWrite[str] | None = None) -> None:
        """Print what `--help` and `--version` say; argparse by itself passes over what cannot be written."""
        elsewhere = file is not sys.stdout
        if elsewhere:
            super()._print_message(message, file)
            return
        try:
            print(message, end="", flush=True)
        except BrokenPipeError:
            silence(sys.stdout)
        except OSError as error:
            silence(sys.stdout)
            self.exit(2, f"{self.prog}: {reason(error)}\n")


class CommandLine(Parser):
    """Takes a command, whose own parser takes what stands after it."""

    def parse_known_args(  # type: ignore[override]  # of its overloads one is used here
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse the arguments; an option before the command is none, for its value would be taken for the command."""
        if args and args[0].startswith("-") and args[0] not in self._option_string_actions:
            self.error("the first word is the command, and options stand after it")
        return super().parse_known_args(args, namespace)


def add_parser(subparsers: argparse._SubParsersAction[AnyParser], name: str, does: str, example: str) -> AnyParser:
    """Add the parser of a command, or of one of its actions: what it does, begun with a small letter, and an example.

    `example` is lines as they are typed, each after two spaces.
    """
    return subparsers.add_parser(
        name,
        help=does,
        description=f"{does[0].upper()}{does[1:]}.",
        epilog=f"example:\n{example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )


def _path(word: str) -> Path:
    """What an argument of type Path stands for; an empty one, as of a variable that is not set, is a mistake."""
    if not word:
        raise argparse.ArgumentTypeError("an empty text is no path; the current folder is '.'")
    return Path(word)
