"""The same ecology as different programs write it, for what a file costs to load that nobody wrote by hand.

rdflib and Oxigraph write it themselves. Of programs in Java only the layout is imitated: Apache Jena aligns predicates
and writes a line for each, TopBraid ends each line at its semicolon and each statement on a line of its own.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import pyoxigraph as ox
import rdflib

from benchmarks.scale.worlds import PREFIXES

_DECLARED = dict(re.findall(r"@prefix (\S*): <([^>]*)>", PREFIXES))


def rdflib_turtle(text: str) -> str:
    """As rdflib serialises Turtle."""
    return rdflib.Graph().parse(data=text, format="turtle").serialize(format="turtle")


def longturtle(text: str) -> str:
    """As rdflib's `longturtle`, made for version control: a line for each value."""
    return rdflib.Graph().parse(data=text, format="turtle").serialize(format="longturtle")


def ntriples(text: str) -> str:
    """N-Triples, which is Turtle: a line for each triple, labels for blank nodes."""
    triples = (quad.triple for quad in ox.parse(text, format=ox.RdfFormat.TURTLE))
    return (ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode()


def shuffled(text: str) -> str:
    """N-Triples in any order, as what sorts or merges lines leaves them."""
    lines = ntriples(text).splitlines(keepends=True)
    random.Random(0).shuffle(lines)
    return "".join(lines)


def oxigraph(text: str) -> str:
    """As a store of Oxigraph dumps itself: its own order, labels for blank nodes."""
    store = ox.Store()
    store.bulk_load(text.encode(), format=ox.RdfFormat.TURTLE)
    dumped = store.dump(format=ox.RdfFormat.TURTLE, from_graph=ox.DefaultGraph(), prefixes=_DECLARED)
    return (dumped or b"").decode()


def jena(text: str) -> str:
    """In the layout of Apache Jena."""
    aligned = re.sub(r" ;\n    (\S+) ", lambda found: f" ;\n        {found[1]:<16}  ", text)
    return re.sub(
        r"\[ (\S+) (.*?) \]", lambda found: f"[ {found[1]}  {found[2].replace(' ; ', ' ;' + _INDENT)} ]", aligned
    )


def topbraid(text: str) -> str:
    """In the layout of TopBraid."""
    return re.sub(r" ;\n    ", " ;\n  ", text).replace(" .\n", " ;\n.\n").replace("> ;\n.\n", "> .\n")


_INDENT = "\n" + " " * 28
STYLES: dict[str, Callable[[str], str]] = {
    "rdflib, Turtle": rdflib_turtle,
    "rdflib, longturtle": longturtle,
    "Apache Jena (layout)": jena,
    "TopBraid (layout)": topbraid,
    "Oxigraph, dump of a store": oxigraph,
    "N-Triples": ntriples,
    "N-Triples, shuffled": shuffled,
}
