"""Templates and tasks: read from RDF, with values bound to their parameters.

`TaskDocument` is a task with the document in which its shapes stand; `read_task` makes one, `InsideReader` those that
a composite is inside, and `placed` finds the line and column of an error that they raise. `bind`, `complete` and
`read_term` give parameters their values, `suitable` and `misfits` tell which values a parameter can and cannot have,
and `free_parameters` which ones are left. `mentions`, `shape_statements`, `substituted` and
`ROLE_STRUCTURE` are for readers of the roles' shapes.
"""

from selfconf.rdf.tasks.bindings import bind, complete, free_parameters, read_term
from selfconf.rdf.tasks.mistakes import placed
from selfconf.rdf.tasks.parameters import misfits, suitable
from selfconf.rdf.tasks.roles import ROLE_STRUCTURE, mentions, shape_statements, substituted
from selfconf.rdf.tasks.templates import InsideReader, TaskDocument, read_task

__all__ = [
    "ROLE_STRUCTURE",
    "InsideReader",
    "TaskDocument",
    "bind",
    "complete",
    "free_parameters",
    "mentions",
    "misfits",
    "placed",
    "read_task",
    "read_term",
    "shape_statements",
    "substituted",
    "suitable",
]
