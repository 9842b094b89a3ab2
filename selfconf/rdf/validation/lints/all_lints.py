"""All lints, and which of them run when.

A lint tells what reads well and is probably not what was meant: it is a function from one file to what it finds there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.lints.descriptions import local_components, repeated_descriptions
from selfconf.rdf.validation.lints.flow import idle_loops, starving_inputs
from selfconf.rdf.validation.lints.hierarchies import circular_hierarchies, mixed_hierarchies, unlisted_members
from selfconf.rdf.validation.lints.impossible_shapes import (
    impossible_inputs,
    impossible_roles,
    lone_alternatives,
    nameless_values,
    queries_about_nothing,
)
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.literals import literals_for_iris, literals_for_terms, unfit_literals
from selfconf.rdf.validation.lints.misplaced_terms import misplaced_terms, templates_as_groundings
from selfconf.rdf.validation.lints.parameters import (
    borrowed_parameters,
    queried_parameters,
    unlisted_parameters,
    unused_parameters,
)
from selfconf.rdf.validation.lints.ports import ownerless_ports, typed_operations, untyped_ports
from selfconf.rdf.validation.lints.prefixes import prefixes, prefixes_of_queries, undeclared_prefixes
from selfconf.rdf.validation.lints.roles import (
    idle_words,
    paths_from_components,
    properties_of_roles,
    signals_for_components,
    typed_roles,
    undescribed_shapes,
    unjoined_optional_roles,
    unlisted_roles,
    unselective_roles,
)
from selfconf.rdf.validation.lints.signal_classes import (
    components_as_signals,
    misplaced_classes_in_shapes,
    signals_among_types,
)
from selfconf.rdf.validation.lints.sources import (
    incommensurable_units,
    misnamed_units,
    paths_from_outputs,
    units_by_other_words,
    unmet_shapes,
)
from selfconf.rdf.validation.lints.terms import (
    classes_as_properties,
    imported_ontologies,
    properties_as_classes,
    unknown_terms,
)


def lint(file: LintedFile, conforms: bool) -> list[Diagnostic]:
    """Everything that the lints find in a file; about the make-up of a template only if it `conforms`."""
    checks = (*WORDS, *TEMPLATES) if conforms else WORDS
    return [found for check in checks for found in check(file)]


WORDS: tuple[Callable[[LintedFile], Iterator[Diagnostic]], ...] = (
    unknown_terms,
    properties_as_classes,
    classes_as_properties,
    imported_ontologies,
    repeated_descriptions,
    prefixes,
    undeclared_prefixes,
    prefixes_of_queries,
    ownerless_ports,
    untyped_ports,
    typed_operations,
    misplaced_terms,
    templates_as_groundings,
    literals_for_iris,
    literals_for_terms,
    unfit_literals,
    local_components,
    misnamed_units,
    units_by_other_words,
    signals_among_types,
    components_as_signals,
    circular_hierarchies,
    mixed_hierarchies,
    unlisted_members,
)
"""The lints that run on every file."""
TEMPLATES: tuple[Callable[[LintedFile], Iterator[Diagnostic]], ...] = (
    unlisted_roles,
    typed_roles,
    undescribed_shapes,
    unselective_roles,
    signals_for_components,
    misplaced_classes_in_shapes,
    paths_from_components,
    unused_parameters,
    unlisted_parameters,
    borrowed_parameters,
    idle_words,
    properties_of_roles,
    queried_parameters,
    queries_about_nothing,
    lone_alternatives,
    impossible_roles,
    nameless_values,
    impossible_inputs,
    idle_loops,
    starving_inputs,
    unjoined_optional_roles,
    incommensurable_units,
    paths_from_outputs,
    unmet_shapes,
)
"""The lints that run on a file only where its templates conform: the others would say what SHACL has said."""
