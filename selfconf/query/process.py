"""A SPARQL query in a process of its own, which can be ended: a question may ask for more than there is time for.

`python -m selfconf.query` is the process: a line of JSON with the question and the dataset as N-Quads come in on
stdin, the answer goes out on stdout. Time, rows and memory are limited; a query that brings the engine down (Oxigraph
0.5 overflows its stack on braces nested some ten thousand deep) brings down nothing else. A question for an endpoint
goes out from there as well, so that a server which never ends, or sends without end, meets the same limits.
"""

from __future__ import annotations

import contextlib
import json
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import NamedTuple

import pyoxigraph as ox

from selfconf.errors import NetworkError, ProgrammerError, QueryError, SelfconfError
from selfconf.model.immutable import immutable
from selfconf.model.setting_names import in_command, options_named, setting
from selfconf.module_command import module_command
from selfconf.query.limits import ENGINE_DOWN, too_large, too_slow
from selfconf.query.results import shown
from selfconf.rdf.sparql import QUERY_PREFIXES, Dataset, QueryAnswer, declared_prefixes, only_reads, says
from selfconf.render import Names

ANSWER_SECONDS = 60.0
"""How long an answer may take by default, loading the dataset included."""
MOST_ROWS = 100_000
"""How many rows are shown by default."""
MEMORY = 4 << 30
"""How many bytes of address space the process may take."""
_REFUSED, _CUT, _UNREACHED, _EXHAUSTED = 2, 3, 4, 5


@immutable
class Question:
    """A query, and how its answer is to be written."""

    text: str
    form: str = "table"
    rows: int = MOST_ROWS
    prefixes: Mapping[str, str] | None = None
    memory: int = MEMORY
    seconds: float = ANSWER_SECONDS
    endpoint: str | None = None
    """The endpoint that is asked; without it the dataset."""


class Shown(NamedTuple):
    """An answer as text, whether rows were left out of it, and what there is to say about it."""

    text: str
    cut: bool
    remark: str


def answer(dataset: Dataset, question: Question) -> Shown:
    """The answer as text. Raises QueryError, also when a limit is reached, and NetworkError."""
    command = module_command("selfconf.query")
    given = json.dumps([asdict(question), in_command()]).encode() + b"\n" + dataset.dump()
    try:
        done = subprocess.run(command, input=given, capture_output=True, timeout=question.seconds, check=False)
    except subprocess.TimeoutExpired:
        raise QueryError(f"{too_slow(question.seconds)}, or give it longer by {setting('seconds')}") from None
    said = done.stderr.decode().strip()
    if done.returncode in (0, _CUT):
        return Shown(done.stdout.decode(), done.returncode == _CUT, said)
    if done.returncode == _REFUSED:
        raise QueryError(said)
    if done.returncode == _UNREACHED:
        raise NetworkError(said)
    if done.returncode == -signal.SIGSEGV:
        raise QueryError(ENGINE_DOWN)
    if done.returncode in (_EXHAUSTED, -signal.SIGABRT, -signal.SIGKILL):
        raise QueryError(too_large(question.memory))
    raise ProgrammerError(
        f"the process that answers queries has broken: {said.splitlines()[-1] if said else 'no word'}"
    )


def main() -> int:
    """Answer the question that comes in on stdin, in the words of the process that asks."""
    asked_for, of_command = json.loads(sys.stdin.buffer.readline())
    with options_named(of_command):
        return _answered(Question(**asked_for))


def _answered(question: Question) -> int:
    """Answer a question on stdout, and what there is to say about the answer on stderr; return the exit code."""
    with contextlib.suppress(ValueError, OSError):  # some systems have no such limit
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (question.memory, question.memory))
    own = declared_prefixes(question.text)
    # A table shortens by the first prefix of a namespace: that of the query goes before the one that is lent for it.
    names = Names({**own, **(question.prefixes or {}), **QUERY_PREFIXES, **own})
    try:
        with _answering(question) as found:
            text, cut = shown(found, question.form, names, question.rows)
        _say(_remark(question))
    except SelfconfError as error:
        _say(str(error))
        return _UNREACHED if isinstance(error, NetworkError) else _REFUSED
    except MemoryError:
        return _EXHAUSTED
    sys.stdout.buffer.write(text.encode())
    return _CUT if cut else 0


def _say(sentence: str) -> None:
    sys.stderr.buffer.write(sentence.encode(errors="backslashreplace"))


@contextlib.contextmanager
def _answering(question: Question) -> Iterator[QueryAnswer | Iterator[ox.Triple]]:
    if question.endpoint is None:
        dataset = Dataset()
        dataset.load(sys.stdin.buffer.read())
        yield dataset.query(question.text, question.prefixes)
    else:
        from selfconf.query.endpoint import asked  # loads HTTP, which an answer from a dataset does not need
        from selfconf.rdf.eligibility import prefaced

        only_reads(question.text)
        with asked(question.endpoint, prefaced(question.text), patience=question.seconds) as found:
            yield found


def _remark(question: Question) -> str:
    """What explains an answer that is emptier than expected: an endpoint has its own idea of the default graph."""
    if question.endpoint is None or any(says(question.text, word) for word in ("GRAPH", "FROM")):
        return ""
    from selfconf.query.endpoint import asked
    from selfconf.rdf.eligibility import ANY_COMPONENT

    with contextlib.suppress(NetworkError), asked(question.endpoint, ANY_COMPONENT, patience=1.0) as found:
        if isinstance(found, ox.QueryBoolean) and not found:
            return (
                f"the default graph of {question.endpoint} holds no component; if each advertisement is a graph of its "
                "own there, ask for GRAPH ?g { ... }, or give a URL that makes the default graph their union"
            )
    return ""
