"""What a bridge does with each affordance of a thing, and the component that the thing therefore is.

A property that can be read is an output: followed where a form offers that, else read at the rate of the bridge, which
the output then promises. An event is an output. A property that can be written is an input, and so is an action: each
signal calls it. An affordance without a form that can be used is not advertised. What the thing says of its operations
is left out, because nothing can call them through a bridge yet.

*Values.* A signal is an object with the fields of its type. Where a type has one required field, and the value of a
thing is no object, such as `true` for `rob:Switch`, the value becomes that field, and on the way back the field the
value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

from selfconf import files, library
from selfconf.bridging.wot.forms import FOLLOWED, ThingForm, ThingForms
from selfconf.importing import DescribedThing, ImportedComponent, ImportedPort, NestedNode
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, UNIT, XSD


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, slots=True)
class ThingInput:
    """Where a signal of an input goes: it writes a property, or calls an action."""

    name: str
    form: ThingForm
    action: bool
    field: str | None
    """The field of a signal that is sent alone."""
    empty: bool = False
    """Whether it is an action that takes nothing: it is called by each signal, whatever that says."""


@dataclass(frozen=True, slots=True)
class ThingInteractions:
    """A thing as the component that it is on this side, with what its ports stand for."""

    component: ImportedComponent
    outputs: tuple[ThingOutput, ...]
    inputs: tuple[ThingInput, ...]
    probe: ThingForm | None
    """What is read, or only reached, to see whether the thing is there."""
    problems: tuple[str, ...] = field(default=())
    """Sentences about what cannot be bridged."""

    @property
    def readable(self) -> bool:
        """Whether the probe can be read; else it is only looked whether something listens there."""
        return any(output.read is self.probe for output in self.outputs)


def interactions(thing: DescribedThing, forms: ThingForms, rate: float) -> ThingInteractions:
    """What a bridge does with a thing; `rate` is how often it reads what it cannot follow, in hertz."""
    component, fields, affordances = thing.component, _fields(thing.component), _Affordances(thing.description)
    fed = {port: _output(port, affordances, forms, fields) for port in component.outputs}
    outputs = {port: output for port, output in fed.items() if output is not None}
    written = {port: _write(port, affordances, forms, fields) for port in component.inputs}
    inputs = {port: taken for port, taken in written.items() if taken is not None}
    inputs |= _calls(component, affordances, forms, fields, {port.name for port in inputs})
    bridged = replace(
        component,
        outputs=tuple(_promised(port, rate) if output.polled else port for port, output in outputs.items()),
        inputs=tuple(inputs),
        operations=(),
    )
    probes = [
        *(output.read for output in outputs.values()),
        *(taken.form for taken in inputs.values()),
        *(output.follow for output in outputs.values()),
    ]
    probe = next((form for form in probes if form is not None), None)
    return ThingInteractions(bridged, tuple(outputs.values()), tuple(inputs.values()), probe, tuple(forms.problems))


class _Affordances:
    """The affordances of a description, by their names."""

    def __init__(self, description: Mapping[str, Any]) -> None:
        self._kinds = {kind: description.get(kind) for kind in ("properties", "events", "actions")}

    def find(self, kind: str, name: str) -> Mapping[str, Any]:
        """An affordance; an empty one if there is none."""
        found = self._kinds[kind]
        affordance = found.get(name) if isinstance(found, dict) else None
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
    return ThingInput(port.name, form, False, _plain_field(affordance, port.types, fields))


def _calls(
    component: ImportedComponent,
    affordances: _Affordances,
    forms: ThingForms,
    fields: Mapping[IRI, SignalFields],
    taken: set[str],
) -> dict[ImportedPort, ThingInput]:
    """The actions as inputs; one with the name of a property that can be written too is called `call NAME`."""
    found = {}
    for operation in component.operations:
        affordance = affordances.find("actions", operation.name)
        form = forms.find(affordance, "invokeaction")
        if form is None:
            continue
        name = f"call {operation.name}" if operation.name in taken else operation.name
        types = () if operation.request is None else (operation.request,)
        one = _plain_field(_schema(affordance, "input"), types, fields)
        port = ImportedPort(name, types, optional=True)
        found[port] = ThingInput(name, form, True, one, empty="input" not in affordance)
    return found


def _promised(port: ImportedPort, rate: float) -> ImportedPort:
    """An output that is issued at a rate."""
    hertz = NestedNode(((SC.value, (Literal(f"{rate:g}", XSD.decimal),)), (SC.unit, (UNIT.HZ,))))
    return replace(port, properties=(*port.properties, (SC.rate, hertz)))


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


def _fields(component: ImportedComponent) -> Mapping[IRI, SignalFields]:
    """The fields of the signal types of a thing, as far as the ontologies of selfconf know them."""
    types = {kind for port in (*component.outputs, *component.inputs) for kind in port.types}
    types |= {operation.request for operation in component.operations if operation.request is not None}
    return _known_fields(frozenset(types)) if types else {}


@lru_cache(maxsize=1024)
def _known_fields(types: frozenset[IRI]) -> Mapping[IRI, SignalFields]:
    """What the ontologies say of some types, kept: to read them takes some hundredths of a second."""
    return files.signal_fields(library.ontologies(), types)
