"""Where a command takes its advertisements from: files, a SPARQL endpoint, or else the living ecology."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

from selfconf.cli.endpoint import read_endpoint
from selfconf.cli.inputs import read_advertisements, read_hierarchy
from selfconf.cli.live import advertised, connected, discover
from selfconf.errors import AuthorError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import Partitioner


def one_ecology(given: argparse.Namespace) -> None:
    """Raises AuthorError where the arguments name two."""
    if given.ads is not None and given.endpoint is not None:
        raise AuthorError("--ads and --endpoint are two ecologies; give one of them")


def read_ecology(given: argparse.Namespace, partitioner: Partitioner) -> Mapping[IRI, Advertisement]:
    """The advertisements among which a task looks for components."""
    one_ecology(given)
    if given.ads is not None:
        return read_advertisements(given.ads)
    if given.endpoint is not None:
        syntactic = Reasoning(given.reasoning) is Reasoning.SYNTACTIC
        # A refusal tells whether subclass mode would do, so what that needs is fetched too.
        wide = read_hierarchy(given, Reasoning.SUBCLASS) if syntactic else partitioner.hierarchy
        return read_endpoint(given.endpoint, partitioner.roles, wide)
    with connected(given) as ecology:
        return advertised(discover(ecology))
