"""SPARQL over the ecology as a dataset, read only.

`Dataset` holds named graphs and answers queries with a `QueryAnswer`; `QUERY_PREFIXES` are lent to every query,
`declared_prefixes` are those that a query declares itself. `only_reads`, `fault`, `says` and `without` tell what a
query must not say, and `why_not_asked` what keeps the query of a shape from being asked; `hidden` is a query with
blanks for its strings.
"""

from selfconf.rdf.sparql.dataset import QUERY_PREFIXES, Dataset, QueryAnswer
from selfconf.rdf.sparql.mistakes import why_not_asked
from selfconf.rdf.sparql.prologue import declared_prefixes
from selfconf.rdf.sparql.read_only import fault, hidden, only_reads, says, without

__all__ = [
    "QUERY_PREFIXES",
    "Dataset",
    "QueryAnswer",
    "declared_prefixes",
    "fault",
    "hidden",
    "only_reads",
    "says",
    "why_not_asked",
    "without",
]
