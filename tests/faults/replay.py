"""Play a history again, and say what happened and what was not as it must be.

    python -m tests.faults.replay SEED
    python -m tests.faults.replay SEED --shrink     drop whatever is not needed for it to go wrong
    python -m tests.faults.replay SEED --log        show what sites, components and configurators log

`--ecology composed` plays it where there are operations and a composite, `--busy` with code that is busy while it acts,
`--large` as if the ecology were so large that not all lives are followed, `--upgrades` with tasks that change to what
they would rather have, `--harsh` the script of that number of `tests/faults/harsh.py`, `--kept` with tasks that the
sites keep; `--ecology random-7` is one of `tests/faults/random_ecologies.py`. A test that fails prints the command that
plays its history again.

The exit code is 1 if an invariant was broken.
"""

from __future__ import annotations

import argparse
import logging
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from selfconf.bus.memory import Faults
from tests.faults.ecologies import ECOLOGIES, FaultyEcology
from tests.faults.histories import History
from tests.faults.keeping import KeepingHistory
from tests.faults.random_ecologies import PREFIX, random_ecology
from tests.faults.script import Recipe, Script

PROGRAM = "python -m tests.faults.replay"


def played(script: Script, folder: Path) -> History:
    """A history that was played to its end."""
    history = KeepingHistory(script, folder) if script.kept else History(script, folder)
    history.run()
    return history


def shrink(script: Script, folder: Path) -> Script:
    """Return a script that breaks the same invariants, or some of them, and of which nothing can be left out."""
    wrong = played(script, folder).watch.names
    shorter: Script | None = script
    while shorter is not None and wrong:
        script = shorter
        shorter = next((one for one in _shorter(script) if played(one, folder).watch.names & wrong), None)
    return script


def _shorter(script: Script) -> Iterator[Script]:
    """Every script with something less in it, those that lack most first."""
    count = len(script.actions)
    for part in (2, 4):
        size = count // part
        for begin in range(0, count, size) if size > 1 else ():
            yield replace(script, actions=script.actions[:begin] + script.actions[begin + size :])
    for number in range(count):
        yield replace(script, actions=script.actions[:number] + script.actions[number + 1 :])
    if script.clocks:
        yield replace(script, clocks={})
    if script.startable:
        yield replace(script, startable=frozenset())
    calm = Faults()
    for name in ("loss", "doubling", "most_delay", "most_event_delay"):
        if getattr(script.faults, name) != getattr(calm, name):
            yield replace(script, faults=replace(script.faults, **{name: getattr(calm, name)}))


def account(history: History) -> str:
    """What happened in a history, in order, and what was not as it must be."""
    lines = [str(replace(history.script, actions=())), *history.told]
    return "\n".join([*lines, "", *(history.broken or ["nothing was wrong"])])


def told(recipe: Recipe, history: History) -> str:
    """What a test says of a history that went wrong: the command that plays it again, and what happened."""
    return f"{command(recipe)}\n{account(history)}"


def command(recipe: Recipe) -> str:
    """The command that plays a history again, with what is not needed left out."""
    options = [f"--{name}" for name in ("busy", "large", "upgrades", "harsh", "kept") if getattr(recipe, name)]
    options += [f"--only {recipe.only}"] if recipe.only else []
    return " ".join([PROGRAM, str(recipe.seed), "--ecology", recipe.ecology.name, *options, "--shrink"])


def options() -> argparse.ArgumentParser:
    """The parser of the options of this program."""
    parser = argparse.ArgumentParser(prog=PROGRAM, description=__doc__.partition("\n")[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("--shrink", action="store_true", help="drop whatever is not needed for it to go wrong")
    parser.add_argument("--log", action="store_true", help="show what sites, components and configurators log")
    parser.add_argument("--busy", action="store_true", help="code is also busy while it acts, and hangs on")
    parser.add_argument("--large", action="store_true", help="only selected lives are followed")
    parser.add_argument("--upgrades", action="store_true", help="tasks change to what they would rather have")
    parser.add_argument("--harsh", action="store_true", help="play a script of tests.faults.harsh")
    parser.add_argument("--kept", action="store_true", help="the sites keep the tasks")
    parser.add_argument("--only", default="", metavar="KIND,...", help="of these kinds of harsh actions alone")
    parser.add_argument(
        "--ecology",
        type=ecology_of,
        default="paper",
        metavar="NAME",
        help=f"where it happens: {', '.join(ECOLOGIES)} or {PREFIX}NUMBER (default: %(default)s)",
    )
    return parser


def ecology_of(name: str) -> FaultyEcology:
    """The ecology of a name. Raises ArgumentTypeError if there is none."""
    number = name.removeprefix(PREFIX)
    if name in ECOLOGIES:
        return ECOLOGIES[name]
    if name.startswith(PREFIX) and number.isdecimal():
        return random_ecology(int(number))
    raise argparse.ArgumentTypeError(f"there is no ecology {name!r}")


def recipe_of(given: argparse.Namespace) -> Recipe:
    """The recipe that the options of this program name."""
    how = (given.busy, given.large, given.upgrades, given.harsh, given.kept)
    return Recipe(given.seed, given.ecology, *how, only=given.only)


def main(arguments: Sequence[str] | None = None) -> int:
    """Play the history of a seed; without arguments, with those of the process."""
    given = options().parse_args(arguments)
    logging.basicConfig(level=logging.DEBUG if given.log else logging.CRITICAL, format="%(name)s: %(message)s")
    with tempfile.TemporaryDirectory() as folder:
        script = recipe_of(given).script
        if given.shrink:
            logging.disable(logging.CRITICAL)
            script = shrink(script, Path(folder))
            logging.disable(logging.NOTSET)
        history = played(script, Path(folder))
    print(account(history))
    return 1 if history.broken else 0


if __name__ == "__main__":
    sys.exit(main())
