"""What to ask a SPARQL 1.1 endpoint that holds a large ecology: simple positive questions, the rest is finished here.

A task has two questions: which types there are, and what the components of some types say. Nothing that a role forbids
is asked, as there is no spelling of it that is fast on every engine. The advertisements may lie in the default graph or
in named ones. A query of a user goes there as it is, with the prefixes that selfconf lends to every query.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf.eligibility.role_tests import CompiledRole
from selfconf.rdf.permitted_fields import PERMITTED_IN_SHAPES
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.turtle import ox_term
from selfconf.rdf.vocabulary import RDFS, REST, SC, TYPE

_COMPONENT = str(ox_term(SC.Component))
BLANK_NODE_DEPTH = 3
"""How deep blank nodes in an advertisement are asked for: a port is one, its rate another."""
TYPES = f"""SELECT DISTINCT ?type WHERE {{
  {{ ?component a {_COMPONENT} , ?type }} UNION {{ GRAPH ?graph {{ ?component a {_COMPONENT} , ?type }} }}
}}"""
"""The types that the components of an endpoint have."""

# Not rdfs:seeAlso and its like, which lead from the classes of a shape to anything.
_STEPS = sorted(step for step in PERMITTED_IN_SHAPES - {TYPE} if step not in RDFS)
_ACCEPTED = (
    f"?component <{SC.hasInput}>/<{SC.accepts}> ?shape . "
    f"?shape ({'|'.join(f'<{step}>' for step in _STEPS)})* ?subject . "
    "?subject ?predicate ?object FILTER ( isBlank(?subject) )"
)
"""The statements of the shapes that the inputs of a component accept, which are blank nodes at any depth."""
_LISTED = (
    f"?component ?link ?list . ?list <{REST}>/<{REST}>/<{REST}>* ?subject . "
    "?subject ?predicate ?object FILTER ( isBlank(?list) && isBlank(?subject) )"
)
"""The statements of a list that is the value of a property, from its third member on."""
ANY_COMPONENT = f"ASK {{ ?component a {_COMPONENT} }}"
"""Whether the default graph of an endpoint has a component at all."""


def prefaced(text: str) -> str:
    """A query with the prefixes of selfconf that it uses and does not declare, on its first line."""
    own = set(re.findall(r"(?i)\bprefix\s+([\w-]*)\s*:", text))
    used = [name for name in QUERY_PREFIXES if f"{name}:" in text and name not in own]
    return "".join(f"PREFIX {name}: <{QUERY_PREFIXES[name]}> " for name in used) + text


def wanted(types: Iterable[IRI], roles: Sequence[CompiledRole], hierarchy: Hierarchy) -> list[IRI]:
    """Of the types there are, those that a component needs one of if it is to play any of some roles."""
    offered = sorted(types)
    found: set[IRI] = set()
    for role in roles:
        if not role.classes:
            return offered
        found.update(kind for kind in offered if role.classes[0].admits((kind,), hierarchy))
    return sorted(found)


def statements(types: Iterable[IRI]) -> str:
    """The query for everything that the components of some types say."""
    values = " ".join(str(ox_term(kind)) for kind in types)
    branches = [f"{{ {_level(depth)} }}" for depth in range(BLANK_NODE_DEPTH)]
    branches += [f"{{ {_ACCEPTED} }}", f"{{ {_LISTED} }}"]
    inside = f"VALUES ?type {{ {values} }} ?component a ?type , {_COMPONENT} . {' UNION '.join(branches)}"
    return (
        "CONSTRUCT { ?subject ?predicate ?object } WHERE {\n"
        f"  {{ {inside} }} UNION {{ GRAPH ?graph {{ {inside} }} }}\n}}"
    )


def _level(depth: int) -> str:
    """The statements about a component, or about a blank node so many steps away."""
    if depth == 0:
        return "?component ?predicate ?object BIND ( ?component AS ?subject )"
    nodes = ["?component", *(f"?node{k}" for k in range(1, depth)), "?subject"]
    steps = " . ".join(f"{a} ?link{k} {b}" for k, (a, b) in enumerate(itertools.pairwise(nodes)))
    blank = " && ".join(f"isBlank({node})" for node in nodes[1:])
    return f"{steps} . ?subject ?predicate ?object FILTER ( {blank} )"
