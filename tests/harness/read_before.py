"""What each process that runs tests would read and prepare for itself, read once before these are forked.

Much of it is the queries of shapes: rdflib takes half a second to prepare all of these.
"""

from __future__ import annotations

from tests.bad_files import BAD, checked
from tests.shipped import ontology_graphs, shipped_shapes

ASKED = (
    "assignment-component-literal",
    "binding-literal",
    "binding-parameter",
    "cell-two-rests",
    "command-blank",
    "cost-empty",
    "input-named-in-vain",
    "inputs-with-one-name",
)
"""Files of `tests/bad` that most of these queries are asked about."""


def read_what_many_tests_need() -> None:
    """Read what ships with selfconf, and prepare most of the queries by which files are validated."""
    ontology_graphs()
    shipped_shapes()
    for path in BAD:
        if path.stem in ASKED:
            checked(path)
