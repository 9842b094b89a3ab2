"""`selfconf COMMAND`: finds the command, runs it, and turns what went wrong into one sentence and an exit code.

0 yes; 1 an honest no; 2 misuse, or input that cannot be read. Results go to stdout, everything else to stderr.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import sys
import traceback
from collections.abc import Collection, Sequence
from keyword import iskeyword
from types import ModuleType

from selfconf.aside_writer import AsideHandler
from selfconf.cli.parsing import CommandLine, Parser, add_parser
from selfconf.cli.settings import Settings, found_settings
from selfconf.cli.terminal import complain, for_programs, guard, silence
from selfconf.errors import SelfconfError, SiteMisusedError, reason
from selfconf.model.setting_names import options_named

COMMANDS = {
    "new": "write commented first files for a component, a template or an ontology",
    "import": "write advertisements from Thing Descriptions and other descriptions of components",
    "validate": "check advertisements, templates, tasks and ontologies",
    "partition": "show which components could play each role of a template, and what keeps the others out",
    "configure": "compute a configuration for a template, or say why there is none; changes nothing",
    "query": "query files, a SPARQL endpoint or the living ecology",
    "site": "serve the advertisements of this host to an ecology, and watch their files; or restart a component",
    "bridge": "let Things and ROS 2 nodes take part in an ecology as components, without changes",
    "discover": "list every advertised component, with its state, its site, and the task that holds it",
    "run": "configure, deploy, monitor and configure again, until Ctrl-C takes everything down",
    "status": "show what is deployed, by which configurator, and since when",
    "tasks": "list the tasks: which ones run, with which priority, and which live in the sites",
    "stop": "take down what is deployed; components are turned off, not ended",
    "keys": "make an authority for an ecology, and issue, renew, show and revoke certificates",
    "access": "show who may do what in an ecology with keys, and which attempts were refused",
    "why": "say why a component plays a role: what failed, what was passed over, what would change it",
    "echo": "show the signals of an output as they come, with their rate",
    "log": "show what components have printed, as their sites have kept it",
    "top": "show each living component with the task that holds it, its rates and its memory",
    "serve": "show the ecology in a browser, and answer SPARQL and the W3C directory of Things over HTTP",
    "demo": "run the paper's experiment: Astrid goes to the bedroom, the tracker loses her, odometry takes over",
}
"""Each command with what it does. Its module, `selfconf.cli.NAME`, is loaded when it is asked for."""
INTERRUPTED = 130
NO_THREAD = "can't start new thread"
"""What Python says where the system lets a program begin no further thread."""
FOR_PEOPLE = ("text", "table")
"""The formats that no program reads."""


class Version(argparse.Action):
    """`--version`, which looks the version up only when it is asked for: that takes as long as all other arguments."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print the version and end."""
        parser._print_message(f"selfconf {_version()}\n", sys.stdout)
        parser.exit()


def command(name: str) -> ModuleType:
    """The module of a command: EXAMPLE, add_arguments, run."""
    return importlib.import_module(f"selfconf.cli.{name}{'_' if iskeyword(name) else ''}")


def command_parser(name: str, subparsers: argparse._SubParsersAction[Parser], settings: Settings) -> None:
    """Add the parser of one command with its options, which have their values from the settings where not typed."""
    module = command(name)
    parser = add_parser(subparsers, name, COMMANDS[name], module.EXAMPLE)
    module.add_arguments(parser)
    settings.declare(parser)
    parser.add_argument("--debug", action="store_true", help="show tracebacks and what happens inside")
    parser.set_defaults(run=module.run, misused=parser.error)


def parser(names: Collection[str] = tuple(COMMANDS), settings: Settings | None = None) -> Parser:
    """The parser of the command line; commands that are not among the names are listed, but not loaded."""
    settings = settings or Settings()
    top = CommandLine(
        prog="selfconf",
        description="Robots, sensors and home devices that connect themselves.",
        epilog="example:\n  selfconf configure examples/navigate.ttl --ads examples/peis-home"
        " --bind robot=:Astrid --bind goal='(AT BEDROOM)'",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    top.add_argument("--version", action=Version, nargs=0, help="show the version and exit")
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", required=True, parser_class=Parser)
    listed = Parser(prog="selfconf")  # of what is not loaded: a parser for each takes longer than to parse
    for name, does in COMMANDS.items():
        if name in names:
            command_parser(name, subparsers, settings)
        else:
            subparsers._choices_actions.append(subparsers._ChoicesPseudoAction(name, (), does))
            subparsers._name_parser_map[name] = listed
    return top


@options_named()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit code."""
    guard()
    typed = sys.argv[1:] if arguments is None else arguments
    settings, broken = found_settings(complain)
    given, unknown = parser(typed[:1], settings).parse_known_args(typed)
    if unknown:
        given.misused(f"unrecognized arguments: {' '.join(unknown)}{_advice(typed, unknown)}")
    if getattr(given, "format", "text") not in FOR_PEOPLE:
        for_programs()
    told = AsideHandler("%(name)s: %(message)s")
    logging.basicConfig(level=logging.DEBUG if given.debug else logging.ERROR, handlers=[told])
    return _exit_code(given, settings, broken)


def _exit_code(given: argparse.Namespace, settings: Settings, broken: SelfconfError | None) -> int:
    """Run a command, and say in one sentence what goes wrong; the exit code. `broken` is the project file, if it is."""
    code: int = 0
    try:
        if broken is not None and settings.concerned and given.command != "validate":  # which reports it
            raise broken
        settings.fill(given)
        code = given.run(given)
        sys.stdout.flush()
        return code
    except SiteMisusedError:
        return 2  # its site has said why, to the same reader
    except SelfconfError as error:
        if given.debug:
            traceback.print_exc()
        complain(f"selfconf {given.command}: {error}")
        return 2
    except BrokenPipeError:
        silence(sys.stdout)
        return code
    except OSError as error:
        if given.debug:
            traceback.print_exc()
        complain(f"selfconf {given.command}: {reason(error)}")
        silence(sys.stdout)
        return 2
    except RuntimeError as error:
        if given.debug or str(error) != NO_THREAD:
            raise
        limits = "`ulimit -u`, TasksMax= of systemd or `ulimit -v`"
        complain(f"selfconf {given.command}: the system lets it begin no further thread; allow more by {limits}")
        return 2
    except KeyboardInterrupt:
        complain(f"selfconf {given.command}: interrupted")
        return INTERRUPTED


def _advice(typed: Sequence[str], unknown: Sequence[str]) -> str:
    """What to try where words are left over that are no options, and some option may have been given them."""
    left_over = all(not word.startswith("-") for word in unknown) and any(word.startswith("--") for word in typed)
    return "; an option takes one value, repeat it for each: --ads A --ads B" if left_over else ""


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("selfconf")
    except PackageNotFoundError:
        return "from a checkout that is not installed"
