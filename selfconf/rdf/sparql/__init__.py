"""SPARQL over the ecology as a dataset, read only.

`Dataset` holds named graphs and answers queries with a `QueryAnswer`; `QUERY_PREFIXES` are lent to every query.
`only_reads`, `fault`, `says` and `without` tell what a query must not say.
"""

from selfconf.rdf.sparql.dataset import QUERY_PREFIXES, Dataset, QueryAnswer
from selfconf.rdf.sparql.read_only import fault, only_reads, says, without

__all__ = ["QUERY_PREFIXES", "Dataset", "QueryAnswer", "fault", "only_reads", "says", "without"]
