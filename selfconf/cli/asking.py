"""A SPARQL query in a process of its own, which can be ended: whoever asks may ask for more than there is time for.

`python -m selfconf.cli.asking` is the process: a line of JSON with the question and the dataset as N-Quads come in on
stdin, the answer goes out on stdout. Time, rows and memory are limited; a query that brings the engine down (Oxigraph
0.5 overflows its stack on braces nested some ten thousand deep) brings down nothing else.
"""

from __future__ import annotations

import contextlib
import json
import resource
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from selfconf.cli import words
from selfconf.cli.answers import shown
from selfconf.errors import AuthorError, QueryError
from selfconf.rdf.dataset import PREFIXES, Dataset

SECONDS = 60.0
"""How long an answer may take by default, loading the dataset included."""
ROWS = 100_000
"""How many rows are shown by default."""
MEMORY = 4 << 30
"""How many bytes of address space the process may take."""
_REFUSED, _CUT = 2, 3


@dataclass(frozen=True, slots=True)
class Question:
    """A query, and how its answer is to be written."""

    text: str
    form: str = "table"
    rows: int = ROWS
    prefixes: Mapping[str, str] | None = None
    memory: int = MEMORY


def answer(dataset: Dataset, question: Question, seconds: float = SECONDS) -> tuple[str, bool]:
    """The answer as text, and whether rows were left out. Raises QueryError, also when a limit is reached."""
    command = [sys.executable, "-m", "selfconf.cli.asking"]
    given = json.dumps(asdict(question)).encode() + b"\n" + dataset.dump()
    try:
        done = subprocess.run(command, input=given, capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        raise QueryError(
            f"the query takes more than {seconds:g} s; ask for less, or give it longer by --seconds"
        ) from None
    if done.returncode in (0, _CUT):
        return done.stdout.decode(), done.returncode == _CUT
    if done.returncode == _REFUSED:
        raise QueryError(done.stderr.decode().strip())
    if done.returncode == -signal.SIGSEGV:
        raise QueryError("the query is nested too deeply")
    raise QueryError(f"the query takes more than {question.memory / (1 << 30):.1f} GiB of memory; ask for less")


def main() -> int:
    """Answer the question that comes in on stdin."""
    question = Question(**json.loads(sys.stdin.buffer.readline()))
    with contextlib.suppress(ValueError, OSError):  # some systems have no such limit
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (question.memory, question.memory))
    dataset = Dataset()
    dataset.load(sys.stdin.buffer.read())
    try:
        found = dataset.query(question.text, question.prefixes)
        text, cut = shown(found, question.form, words.Names({**(question.prefixes or {}), **PREFIXES}), question.rows)
    except AuthorError as error:
        sys.stderr.write(str(error))
        return _REFUSED
    sys.stdout.buffer.write(text.encode())
    return _CUT if cut else 0


if __name__ == "__main__":
    sys.exit(main())
