"""A configuration with its provenance (PROV-O) as RDF: what was chosen for which task, what was passed over, why."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from datetime import datetime, timezone
from types import MappingProxyType

from selfconf.model.configuration import Configuration
from selfconf.model.template import Task
from selfconf.model.term import IRI, STRING, BlankNode, Literal
from selfconf.rdf.turtle import Triple
from selfconf.rdf.vocabulary import PROV, SC, TYPE, XSD


def moment(seconds: float) -> Literal:
    """A time, in seconds of the Unix epoch, as xsd:dateTime."""
    return Literal(datetime.fromtimestamp(seconds, timezone.utc).isoformat(timespec="milliseconds"), XSD.dateTime)


def configuration_iri(configuration: Configuration, epoch: int) -> IRI:
    """A name for a deployed configuration: what it is and when."""
    plain = replace(configuration, bindings=dict(configuration.bindings))  # whatever kind of mapping it holds
    digest = hashlib.blake2s(repr((plain, epoch, *configuration.recruits)).encode(), digest_size=8).hexdigest()
    return IRI.unchecked(f"urn:selfconf:configuration:{digest}")


# complexity: one line for each thing that is stated, in the order in which it is read
def configuration_triples(
    configuration: Configuration,
    name: IRI,
    task: Task,
    *,
    epoch: int | None = None,
    generated: float | None = None,
    revises: tuple[IRI, Configuration] | None = None,
    configurator: str | None = None,
    failures: Iterable[tuple[IRI, str, str, float]] = (),
    passed_over: Mapping[IRI, Iterable[IRI]] = MappingProxyType({}),
    outside: IRI | None = None,
    running_as: tuple[str, int] | None = None,
) -> Iterator[Triple]:
    """A configuration as the ontology describes it: what it is, which task it answers, and how it came about.

    `revises` is the one before it with its name, `failures` are (component, cause, detail, seconds), `passed_over` are
    by role the candidates that came before the chosen ones. `outside` is the composite that it is the inside of,
    `running_as` the name and the priority of the task where it runs.
    """
    yield name, TYPE, SC.Configuration
    yield name, TYPE, PROV.Entity
    yield name, SC.template, configuration.template
    if outside is not None:
        yield name, SC.insideOf, outside
    counter = 0

    def blank() -> BlankNode:
        nonlocal counter
        counter += 1
        return BlankNode(f"_:n{counter}")

    asked = blank() if task.iri is None else task.iri
    yield name, SC.task, asked
    yield asked, TYPE, SC.Task
    yield asked, SC.template, task.template.iri
    if running_as is not None:
        yield asked, SC.name, Literal(running_as[0])
        yield asked, SC.priority, Literal(str(running_as[1]), XSD.integer)
    for parameter in task.template.parameters:
        if parameter.name in configuration.bindings:
            node = blank()
            yield asked, SC.binding, node
            yield node, TYPE, SC.Binding
            yield node, SC.parameter, parameter.iri
            yield node, SC.name, Literal(parameter.name)  # the template, which says so, is not served with it
            yield node, SC.value, configuration.bindings[parameter.name]
    before = {} if revises is None else {a.role: a.components for a in revises[1].assignments}
    for assignment in configuration.assignments:
        gone = [c for c in before.get(assignment.role, ()) if c not in assignment.components]
        come = [c for c in assignment.components if c not in before.get(assignment.role, ())]
        replaced = dict(zip(come, gone, strict=False))
        for component in assignment.components:
            node = blank()
            yield name, SC.assignment, node
            yield node, TYPE, SC.Assignment
            yield node, SC.role, assignment.role
            yield node, SC.component, component
            if component in replaced:
                yield node, SC.replaces, replaced[component]
            for other in passed_over.get(assignment.role, ()):
                yield node, SC.passedOver, other
    for component in configuration.recruits:
        yield name, SC.recruited, component
    for connection in configuration.connections:
        node = blank()
        yield name, SC.connection, node
        yield node, TYPE, SC.Connection
        yield node, SC["from"], connection.source
        yield node, SC.output, Literal(connection.output, STRING)
        yield node, SC.to, connection.sink
        yield node, SC.input, Literal(connection.input, STRING)
    for setting in configuration.settings:
        node = blank()
        yield name, SC.setting, node
        yield node, TYPE, SC.Setting
        yield node, SC.component, setting.component
        yield node, SC.name, Literal(setting.name)
        yield node, SC.value, setting.value
    if epoch is not None:
        yield name, SC.epoch, Literal(str(epoch), XSD.integer)
    if generated is not None:
        yield name, PROV.generatedAtTime, moment(generated)
    if configurator is not None:
        agent = IRI.unchecked(f"urn:selfconf:configurator:{configurator}")
        yield name, PROV.wasAttributedTo, agent
        yield agent, TYPE, PROV.SoftwareAgent
    if revises is not None:
        yield name, PROV.wasRevisionOf, revises[0]
    for component, cause, detail, seconds in failures:
        node = blank()
        yield name, PROV.wasInfluencedBy, node
        yield node, TYPE, SC.Failure
        yield node, SC.component, component
        yield node, SC.cause, Literal(cause)
        if detail:
            yield node, SC.detail, Literal(detail)
        yield node, PROV.atTime, moment(seconds)
