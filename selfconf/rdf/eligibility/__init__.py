"""Which components are eligible for the roles of a task, and what keeps the others out.

`Partitioner` compiles the roles of a task (`CompiledRole`) and partitions an `AdvertisementIndex`. `near_misses` and
`near_misses_by_type` find the components that one obstacle keeps out, `exclusions` everything that keeps the others out
(`Exclusion`). `kept_out_by_ports` finds those that only the ports keep out that a shape asks for (`ports_asked`),
`words_of_role` the words of what a role asks for. A `RoleTest` is a `ClassTest`, `SelfTest`, `PropertyTest`,
`ParameterTest` or a `Count` of others. Of an endpoint `ANY_COMPONENT` asks whether it has a component, and `TYPES` of
which types they are; `wanted` are those of these that a task may need, `statements` asks for what components of some
types say, and `prefaced` puts the prefixes before a query. `bound_shape` is the shape of a role with its parameters
replaced.
"""

from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.compiled_roles import bound_shape
from selfconf.rdf.eligibility.near_types_and_ports import (
    kept_out_by_ports,
    near_misses_by_type,
    ports_asked,
    words_of_role,
)
from selfconf.rdf.eligibility.nearly_eligible import Exclusion, exclusions, near_misses
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.remote import ANY_COMPONENT, TYPES, prefaced, statements, wanted
from selfconf.rdf.eligibility.role_tests import (
    ClassTest,
    CompiledRole,
    Count,
    ParameterTest,
    PropertyTest,
    RoleTest,
    SelfTest,
)

__all__ = [
    "ANY_COMPONENT",
    "TYPES",
    "AdvertisementIndex",
    "ClassTest",
    "CompiledRole",
    "Count",
    "Exclusion",
    "ParameterTest",
    "Partitioner",
    "PropertyTest",
    "RoleTest",
    "SelfTest",
    "bound_shape",
    "exclusions",
    "kept_out_by_ports",
    "near_misses",
    "near_misses_by_type",
    "ports_asked",
    "prefaced",
    "statements",
    "wanted",
    "words_of_role",
]
