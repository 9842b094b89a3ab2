"""What a bridge does with each affordance of a thing, and the component that the thing therefore is.

A property that can be read is an output: followed where a form offers that, else read at the rate of the bridge, which
the output then promises. An event is an output. A property that can be written is an input. An action is an operation,
and an input too, each signal of which calls it: so what issues signals alone, such as another thing, can command it. An
affordance without a form that can be used is not advertised.

*Values.* A signal, a request or a response is an object with the fields of its type. Where a type has one required
field, and the value of a thing is no object, such as `true` for `rob:Switch`, the value becomes that field, and on the
way back the field the value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

from selfconf import files, library
from selfconf.bridging.wot.forms import FOLLOWED, ThingForm, ThingForms
from selfconf.errors import AuthorError
from selfconf.importing import (
    DescribedThing,
    ImportedComponent,
    ImportedOperation,
    ImportedPort,
    NestedNode,
    event_ports,
)
from selfconf.model.immutable import immutable, replace
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI, Literal
from selfconf.model.wording import listed
from selfconf.rdf.vocabulary import SC, UNIT, XSD

_Imported = TypeVar("_Imported", ImportedPort, ImportedOperation)
_Done = TypeVar("_Done")


@immutable
class ThingOutput:
    """How an output is fed: by following a form, or by reading one at a rate, or both for the first value."""

    name: str
    read: ThingForm | None
    follow: ThingForm | None
    field: str | None
    """The field of a signal that a plain value becomes."""

    @property
    def polled(self) -> bool:
        """Whether the thing is asked again and again."""
        return self.follow is None


@immutable
class ThingInput:
    """Where a signal of an input goes: it writes a property, or calls an action."""

    name: str
    form: ThingForm
    action: bool
    field: str | None
    """The field of a signal that is sent alone."""
    empty: bool = False
    """Whether it is an action that takes nothing: it is called by each signal, whatever that says."""


@immutable
class ThingOperation:
    """How an operation is called: by the form of an action."""

    name: str
    form: ThingForm
    request_field: str | None
    """The field of a request that is sent alone."""
    response_field: str | None
    """The field of a response that a plain answer becomes."""
    empty: bool
    """Whether the action takes nothing, whatever a request says."""
    answers: bool
    """Whether the action answers something; else what comes back is not looked at."""


@immutable
class ThingInteractions:
    """A thing as the component that it is on this side, with what its ports stand for."""

    component: ImportedComponent
    outputs: tuple[ThingOutput, ...]
    inputs: tuple[ThingInput, ...]
    operations: tuple[ThingOperation, ...]
    probe: ThingForm | None
    """What is read, or only reached, to see whether the thing is there."""
    problems: tuple[str, ...] = field(default=())
    """Sentences about what cannot be bridged."""

    @property
    def readable(self) -> bool:
        """Whether the probe can be read; else it is only looked whether something listens there."""
        return any(output.read is self.probe for output in self.outputs)

    def offers(self, other: ThingInteractions) -> bool:
        """Whether everything that can be done with another one can be done with this one, in the same way."""
        mine = (self.component.types, *self._ports(), self.outputs, self.inputs, self.operations)
        others = (other.component.types, *other._ports(), other.outputs, other.inputs, other.operations)
        return all(one in here for here, there in zip(mine, others, strict=True) for one in there)

    def _ports(self) -> tuple[tuple[object, ...], ...]:
        return self.component.outputs, self.component.inputs, self.component.operations


def interactions(
    thing: DescribedThing, forms: ThingForms, rate: float, ontologies: tuple[Path, ...] = ()
) -> ThingInteractions:
    """What a bridge does with a thing; `rate` is how often it reads what it cannot follow, in hertz.

    Some `ontologies`, besides those of selfconf, say of which fields signals consist.
    """
    component, affordances = thing.component, _Affordances(thing.description)
    fields = _fields(component, ontologies, forms)
    left_out: list[str] = []

    def usable(
        kind: str, imported: Iterable[_Imported], interaction: Callable[..., _Done | None]
    ) -> dict[_Imported, _Done]:
        """What is done with each port or operation with which anything can be done."""
        found = {}
        for each in imported:
            tried = forms.tried
            done = interaction(each, affordances, forms, fields)
            if done is not None:
                found[each] = done
            elif forms.tried > tried:
                left_out.append(f"the {kind} {each.name[:80]!r}")
            elif affordances.have(each.name):
                forms.problems[f"no form of {each.name[:80]!r} is by HTTP, plain or by {' or '.join(FOLLOWED)}"] = None
        return found

    outputs = usable("output", component.outputs, _output)
    inputs = usable("input", component.inputs, _write)
    operations = usable("operation", component.operations, _action)
    if left_out:
        forms.problems[f"so {listed(left_out)} {'is' if len(left_out) == 1 else 'are'} left out"] = None
    inputs |= _commands(operations, {port.name for port in inputs})
    bridged = replace(
        component,
        outputs=tuple(_promised(port, rate) if output.polled else port for port, output in outputs.items()),
        inputs=tuple(inputs),
        operations=tuple(operations),
        needs=(),  # what only another ecology's configurator could connect or set
        parameters=(),
    )
    probes = [
        *(output.read for output in outputs.values()),
        *(taken.form for taken in inputs.values()),
        *(output.follow for output in outputs.values()),
    ]
    return ThingInteractions(
        bridged,
        tuple(outputs.values()),
        tuple(inputs.values()),
        tuple(operations.values()),
        next((form for form in probes if form is not None), None),
        tuple(forms.problems),
    )


class _Affordances:
    """The affordances of a description, by the names of their ports and operations."""

    def __init__(self, description: Mapping[str, Any]) -> None:
        self._kinds = {kind: description.get(kind) for kind in ("properties", "events", "actions")}
        self._events = {port: event for event, port in event_ports(description).items()}

    def have(self, name: str) -> bool:
        """Whether there is an affordance of a name; a port or operation may be said in our own terms alone."""
        return any(self.find(kind, name) for kind in self._kinds)

    def find(self, kind: str, name: str) -> Mapping[str, Any]:
        """An affordance; an empty one if there is none."""
        found, called = self._kinds[kind], self._events.get(name) if kind == "events" else name
        affordance = found.get(called) if isinstance(found, dict) else None
        return affordance if isinstance(affordance, dict) else {}


def _output(
    port: ImportedPort, affordances: _Affordances, forms: ThingForms, fields: Mapping[IRI, SignalFields]
) -> ThingOutput | None:
    affordance = affordances.find("properties", port.name)
    if affordance:
        read = forms.find(affordance, "readproperty")
        follow = forms.find(affordance, "observeproperty", FOLLOWED)
        schema: Mapping[str, Any] = affordance
    else:
        affordance, read = affordances.find("events", port.name), None
        follow = forms.find(affordance, "subscribeevent", (*FOLLOWED, ""))
        schema = _schema(affordance, "data")
    if read is None and follow is None:
        return None
    return ThingOutput(port.name, read, follow, _plain_field(schema, port.types, fields))


def _write(
    port: ImportedPort, affordances: _Affordances, forms: ThingForms, fields: Mapping[IRI, SignalFields]
) -> ThingInput | None:
    affordance = affordances.find("properties", port.name)
    form = forms.find(affordance, "writeproperty")
    if form is None:
        return None
    return ThingInput(port.name, form, action=False, field=_plain_field(affordance, port.types, fields))


def _action(
    operation: ImportedOperation, affordances: _Affordances, forms: ThingForms, fields: Mapping[IRI, SignalFields]
) -> ThingOperation | None:
    affordance = affordances.find("actions", operation.name)
    form = forms.find(affordance, "invokeaction")
    if form is None:
        return None
    asked, answered = (
        _plain_field(_schema(affordance, member), () if kind is None else (kind,), fields)
        for member, kind in (("input", operation.request), ("output", operation.response))
    )
    return ThingOperation(operation.name, form, asked, answered, "input" not in affordance, "output" in affordance)


def _commands(
    operations: Mapping[ImportedOperation, ThingOperation], taken: set[str]
) -> dict[ImportedPort, ThingInput]:
    """The actions as inputs; one with the name of a property that can be written too is called `call NAME`."""
    found = {}
    for operation, action in operations.items():
        name = f"call {operation.name}" if operation.name in taken else operation.name
        port = ImportedPort(name, () if operation.request is None else (operation.request,), optional=True)
        found[port] = ThingInput(name, action.form, action=True, field=action.request_field, empty=action.empty)
    return found


def _promised(port: ImportedPort, rate: float) -> ImportedPort:
    """An output that is issued at a rate, whatever rate its description states."""
    hertz = NestedNode(((SC.value, (Literal(f"{rate:g}", XSD.decimal),)), (SC.unit, (UNIT.HZ,))))
    others = (stated for stated in port.properties if stated[0] != SC.rate)
    return replace(port, properties=(*others, (SC.rate, hertz)))


def _schema(affordance: Mapping[str, Any], member: str) -> Mapping[str, Any]:
    found = affordance.get(member)
    return found if isinstance(found, dict) else {}


def _plain_field(schema: Mapping[str, Any], types: tuple[IRI, ...], fields: Mapping[IRI, SignalFields]) -> str | None:
    """The field that a value of a schema stands for, if it is no object, and its type has one required field."""
    if schema.get("type") == "object":
        return None
    for signal in types:
        required = [each for each in fields[signal].fields if each.required] if signal in fields else []
        if len(required) == 1:
            return required[0].name
    return None


def _fields(
    component: ImportedComponent, ontologies: tuple[Path, ...], forms: ThingForms
) -> Mapping[IRI, SignalFields]:
    """The fields of the signal types of a thing, as far as ontologies tell; one that cannot be read is a problem."""
    types = {kind for port in (*component.outputs, *component.inputs) for kind in port.types}
    called = (kind for each in component.operations for kind in (each.request, each.response))
    types |= {kind for kind in called if kind is not None}
    if not types:
        return {}
    try:
        return _known_fields(frozenset(types), ontologies)
    except AuthorError as error:
        forms.problems[str(error)] = None
        return _known_fields(frozenset(types), ())


@lru_cache(maxsize=1024)
def _known_fields(types: frozenset[IRI], ontologies: tuple[Path, ...]) -> Mapping[IRI, SignalFields]:
    """What ontologies say of some types, kept: to read them takes some hundredths of a second. Raises AuthorError."""
    return files.signal_fields([*library.ontologies(), *files.ontology_files(ontologies)], types)
