"""What an ontology entails under OWL 2 RL: computed in a process of its own, with a time limit, and remembered.

The closure of an ontology takes seconds to minutes in Python, and depends on the ontology and the reasoner alone. So it
is kept in the user's cache folder under a hash of the triples and of the reasoners' versions, and a computation that
takes too long is ended. `python -m selfconf.entailment` is the process: N-Triples in, the entailed hierarchy as
N-Triples out. It reasons by `reasonable`, where that is installed and certain to agree with owlrl, else by owlrl.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from selfconf.atomic_write import write_atomically
from selfconf.errors import AuthorError
from selfconf.model.literal_values import number_of
from selfconf.model.seconds import LIMIT_IN_WORDS, is_limit
from selfconf.model.setting_names import setting
from selfconf.model.term import BlankNode, Term
from selfconf.module_command import module_command
from selfconf.rdf import reasoning, turtle
from selfconf.rdf.turtle import Triple, ntriples
from selfconf.rdf.vocabulary import XSD

T = TypeVar("T", bound=Term)

LIMIT = 120.0
"""Seconds that a closure may take; `SELFCONF_OWL_RL_SECONDS` overrides it."""


def cache_folder() -> Path:
    """Where closures are kept: `$SELFCONF_CACHE_DIR`, or `selfconf` in the user's cache folder.

    Where there is neither, nothing can be written there, nor is anything found.
    """
    given = os.environ.get("SELFCONF_CACHE_DIR")
    if given:
        return Path(given)
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "selfconf"
    except RuntimeError:  # HOME is not set, and the user is in no list, as in a container with a number for a user
        return Path(os.devnull) / "selfconf"


def entailed_hierarchy(triples: Iterable[Triple]) -> Iterator[Triple]:
    """The hierarchy that an ontology entails. Raises AuthorError if it takes longer than the limit."""
    lines = ntriples(_relabelled(triples)).splitlines(keepends=True)
    name = hashlib.blake2s(b"".join((*lines, _reasoners().encode())), digest_size=16).hexdigest()
    kept = cache_folder() / "owl-rl" / f"{name}.nt"
    try:
        entailed = kept.read_bytes()
    except OSError:
        entailed = _computed(b"".join(lines))
        _keep(kept, entailed)
    return turtle.parse(entailed, str(kept)).triples()


def _reasoners() -> str:
    """The reasoners that there are, with their versions."""
    from importlib.metadata import PackageNotFoundError, version  # takes longer to load than most tasks to answer

    found = []
    for name in ("owlrl", "reasonable"):
        with contextlib.suppress(PackageNotFoundError):
            found.append(f"{name} {version(name)}")
    return ", ".join(found)


def _relabelled(triples: Iterable[Triple]) -> Iterator[Triple]:
    """The triples with blank nodes numbered as they come: parsing gives them other labels each time."""
    labels: dict[Term, BlankNode] = {}

    def label(term: T) -> T | BlankNode:
        return labels.setdefault(term, BlankNode(f"_:b{len(labels)}")) if isinstance(term, BlankNode) else term

    for subject, predicate, value in triples:
        yield label(subject), predicate, label(value)


def _limit() -> float:
    """The seconds that a closure may take. Raises AuthorError for a setting that is no limit."""
    given = os.environ.get("SELFCONF_OWL_RL_SECONDS", str(LIMIT))
    seconds = float(
        number_of(given, XSD.double) or 0
    )  # Python's own `float` takes `1_0` and the digits of every script
    if not is_limit(seconds):
        raise AuthorError(f"SELFCONF_OWL_RL_SECONDS is {LIMIT_IN_WORDS}, not {given!r}")
    return seconds


def _computed(lines: bytes) -> bytes:
    seconds = _limit()
    command = module_command("selfconf.entailment")
    try:
        done = subprocess.run(command, input=lines, capture_output=True, timeout=seconds, check=True)
    except subprocess.TimeoutExpired:
        raise AuthorError(
            f"the OWL RL closure of the ontologies takes more than {seconds:g} s; "
            f"use {setting('reasoning', 'subclass')}, or give it longer by SELFCONF_OWL_RL_SECONDS"
        ) from None
    except subprocess.CalledProcessError as error:
        last = error.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no reason given"]
        raise AuthorError(f"the OWL RL closure of the ontologies failed: {last[0]}") from None
    return done.stdout


def _keep(path: Path, entailed: bytes) -> None:
    """Keep a closure for later; do without where that cannot be."""
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, entailed)


def main() -> None:
    """Write the hierarchy that the triples on stdin entail to stdout."""
    triples = list(turtle.parse(sys.stdin.buffer.read(), "stdin").triples())
    entail = reasoning.reasonable_owl_rl if reasoning.suits(triples) else reasoning.owlrl_owl_rl
    entailed = (triple for triple in entail(triples) if triple[1] in reasoning.HIERARCHY)
    sys.stdout.buffer.write(ntriples(entailed))


if __name__ == "__main__":
    main()
