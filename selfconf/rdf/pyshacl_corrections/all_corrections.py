"""All corrections together, as shapes that others write are judged."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from pyshacl.constraints import constraint_component
from pyshacl.errors import ShapeRecursionWarning

from selfconf.rdf.pyshacl_corrections.constraint_lookup import index_constraints
from selfconf.rdf.pyshacl_corrections.library_patches import replaced
from selfconf.rdf.pyshacl_corrections.linear_patterns import linear_patterns
from selfconf.rdf.pyshacl_corrections.ordered_literals import only_ordered
from selfconf.rdf.pyshacl_corrections.prepared_queries import prepared_queries
from selfconf.rdf.pyshacl_corrections.query_validators import query_validators
from selfconf.rdf.pyshacl_corrections.sparql_corrections import sparql_corrections

_LOGS = tuple(map(logging.getLogger, ("pyshacl.validator", "pyshacl-validate")))
"""The logs of pySHACL; the second writes to stderr by itself."""


@contextmanager
def corrected() -> Iterator[None]:
    """In the block, pySHACL and rdflib judge as the recommendations say, in linear time, and print nothing."""
    index_constraints()
    with linear_patterns(), only_ordered(), query_validators(), prepared_queries(), sparql_corrections(), _silent():
        yield


def _unread(graph: object, node: object) -> str:
    """A term in the text of a report."""
    return ""


@contextmanager
def _silent() -> Iterator[None]:
    """No warning that a shape comes back to itself, no errors in the log, which are raised besides, no terms in texts.

    SHACL leaves open what such a shape means (3.4.3); pySHACL takes it to hold where it comes back. The text of a
    report is not read, and to write terms into it takes a quarter of the time.
    """
    before = [log.disabled for log in _LOGS]
    for log in _LOGS:
        log.disabled = True
    try:
        with replaced(((constraint_component, "stringify_node", _unread),)), warnings.catch_warnings():
            warnings.simplefilter("ignore", ShapeRecursionWarning)
            yield
    finally:
        for log, disabled in zip(_LOGS, before, strict=True):
            log.disabled = disabled
