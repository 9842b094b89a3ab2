"""The parameters of a template: their names, their defaults, and where they stand for a value."""

from __future__ import annotations

import re

from selfconf.model.template import Parameter, Role
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.tasks.role_shapes import mentions
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC, SH

_WORD = re.compile(r"\S+")
_KINDS_OF_VALUE: dict[Term, type] = {SH.IRI: IRI, SH.Literal: Literal}


def parameters_of(document: Document, template: IRI, roles: tuple[Role, ...]) -> tuple[Parameter, ...]:
    """The parameters of a template with some roles, sorted by name. Raises TemplateError."""
    return _ParameterReader(document).parameters(template, roles)


class _ParameterReader(DocumentReader):
    """Reads the parameters of a template; every method raises TemplateError with a sentence for the author."""

    def parameters(self, template: IRI, roles: tuple[Role, ...]) -> tuple[Parameter, ...]:
        listed = self.document.values(template, SC.parameter)
        iris = frozenset(value for value in listed if isinstance(value, IRI))
        in_shapes: set[IRI] = set()
        for role in roles:
            in_shapes |= mentions(self.document, role.iri, iris)
        is_set = {setting.value for role in roles for setting in role.settings}
        parameters: list[Parameter] = []
        named: set[str] = set()
        for value in listed:
            if not isinstance(value, IRI):
                raise self.mistake("a parameter of a template needs an IRI", template, SC.parameter, value)
            name = self.only(value, SC.name, f"the parameter {worded(value)} needs exactly one sc:name")
            if not isinstance(name, Literal) or name.datatype != STRING or not _WORD.fullmatch(name.lexical):
                problem = f"the sc:name of the parameter {worded(value)} is one word, a string"
                raise self.mistake(problem, value, SC.name, name)
            if name.lexical in named:
                raise self.mistake(f"two parameters have the name {name.lexical!r}", value, SC.name, name)
            named.add(name.lexical)
            parameters.append(Parameter(value, name.lexical, self._default(value), value in in_shapes, value in is_set))
        return tuple(sorted(parameters, key=lambda parameter: parameter.name))

    def _default(self, parameter: IRI) -> Term | None:
        defaults = self.document.values(parameter, SH.defaultValue)
        if len(defaults) > 1:
            problem = f"the parameter {worded(parameter)} has several defaults"
            raise self.mistake(problem, parameter, SH.defaultValue, defaults[1])
        default = defaults[0] if defaults else None
        if default is not None and not self._allows(parameter, default):
            problem = f"the default of the parameter {worded(parameter)} is not of its sh:datatype or sh:nodeKind"
            raise self.mistake(problem, parameter, SH.defaultValue, default)
        return default

    def _allows(self, parameter: IRI, value: Term) -> bool:
        """Whether a parameter can have a value, by its datatype and its kind."""
        kinds = [_KINDS_OF_VALUE.get(kind, object) for kind in self.document.values(parameter, SH.nodeKind)]
        datatypes = self.document.values(parameter, SH.datatype)
        datatype = value.datatype if isinstance(value, Literal) else None
        return all(isinstance(value, kind) for kind in kinds) and all(datatype == wanted for wanted in datatypes)
