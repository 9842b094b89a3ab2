"""SHACL without pySHACL: constraints on single values as compiled tests, and the syntax of shapes.

`ValueTest` is a constraint on one value, `PairTest` one on the values of two properties, by one of `PAIRS`; `compiled`
makes tests of the constraints that can be; two `exclude` each other if no value passes both, and one may be
`passed_by_none` at all. `passes_all` asks for a value that passes several. `misfit`, `unfit`, `no_pattern`,
`of_values`, `said_twice`, `said_alone`, `LISTS`, `DESCRIBED`, `LITERAL`, `ONLY_WITH_A_PATH`, `STATED_ONCE`, `BESIDES`,
`COUNTS` and `ILL_FORMED` say what may stand as a value of SHACL's own properties, `PATH_FORMS` are those of paths.
`component_parameters` are the predicates by which a document constrains by components of its own, `shapes_behind` are
the shapes to which a statement leads, and `refused_queries` the queries of a constraint that are not asked. `pattern`
is a regular expression that a text cannot make expensive (`Pattern`); where that cannot be, it is `MatchTooCostly`.
`shacl_pattern` is one with the flags of SHACL, `sparql_expression` what an expression of SPARQL is to `re`, and
`pattern_fault` why a text is none. Judging by pySHACL is `selfconf.rdf.conformance`, which loads it.
"""

from selfconf.rdf.shacl.patterns import (
    MatchTooCostly,
    Pattern,
    pattern,
    pattern_fault,
    shacl_pattern,
    sparql_expression,
)
from selfconf.rdf.shacl.shape_queries import refused_queries
from selfconf.rdf.shacl.shape_syntax import (
    BESIDES,
    COUNTS,
    DESCRIBED,
    ILL_FORMED,
    LISTS,
    LITERAL,
    ONLY_WITH_A_PATH,
    PATH_FORMS,
    STATED_ONCE,
    component_parameters,
    misfit,
    no_pattern,
    of_values,
    said_alone,
    said_twice,
    shapes_behind,
    unfit,
)
from selfconf.rdf.shacl.value_tests import PAIRS, PairTest, ValueTest, compiled, exclude, passed_by_none, passes_all

__all__ = [
    "BESIDES",
    "COUNTS",
    "DESCRIBED",
    "ILL_FORMED",
    "LISTS",
    "LITERAL",
    "ONLY_WITH_A_PATH",
    "PAIRS",
    "PATH_FORMS",
    "STATED_ONCE",
    "MatchTooCostly",
    "PairTest",
    "Pattern",
    "ValueTest",
    "compiled",
    "component_parameters",
    "exclude",
    "misfit",
    "no_pattern",
    "of_values",
    "passed_by_none",
    "passes_all",
    "pattern",
    "pattern_fault",
    "refused_queries",
    "said_alone",
    "said_twice",
    "shacl_pattern",
    "shapes_behind",
    "sparql_expression",
    "unfit",
]
