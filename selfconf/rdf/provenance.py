"""A configuration with its provenance (PROV-O) as RDF: what was chosen for which task, what was passed over, why."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from datetime import datetime, timezone
from itertools import count

from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.immutable import immutable, replace
from selfconf.model.template import Task
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.rdf.turtle import Triple
from selfconf.rdf.vocabulary import PROV, SC, TYPE, XSD

CONFIGURATION = "urn:selfconf:configuration:"
"""What the names of deployed configurations begin with."""


def moment(seconds: float) -> Literal:
    """A time, in seconds of the Unix epoch, as xsd:dateTime."""
    return Literal(datetime.fromtimestamp(seconds, timezone.utc).isoformat(timespec="milliseconds"), XSD.dateTime)


def configuration_iri(configuration: Configuration, epoch: int) -> IRI:
    """A name for a deployed configuration: what it is and when."""
    plain = replace(configuration, bindings=dict(configuration.bindings))  # whatever kind of mapping it holds
    digest = hashlib.blake2s(repr((plain, epoch, *configuration.recruits)).encode(), digest_size=8).hexdigest()
    return IRI.unchecked(CONFIGURATION + digest)


@immutable
class Deployment:
    """What is known of a configuration as it runs: since when, as which task, by which configurator, after what."""

    epoch: int
    generated: float
    """When it was complete, in seconds of the Unix epoch."""
    configurator: str
    running_as: tuple[str, int]
    """The name and the priority of the task where it runs."""
    revises: tuple[IRI, Configuration] | None = None
    """The configuration before it, with its name."""
    failures: tuple[tuple[IRI, str, str, float], ...] = ()
    """The components that were lost before: each with the cause, the detail, and when, in seconds of the Unix epoch."""
    passed_over: Mapping[IRI, Sequence[IRI]] = field(default_factory=dict)
    """By role, the candidates that came before the chosen ones."""
    outside: IRI | None = None
    """The composite that it is the inside of."""


def configuration_triples(configuration: Configuration, name: IRI, task: Task) -> Iterator[Triple]:
    """A configuration as the ontology describes it: what it is, and which task it answers."""
    return _stated(configuration, name, task, None, _blank_nodes())


def deployment_triples(configuration: Configuration, name: IRI, task: Task, deployment: Deployment) -> Iterator[Triple]:
    """A configuration that runs, as the ontology describes it: what it is, which task it answers, how it came about."""
    nodes = _blank_nodes()
    yield from _stated(configuration, name, task, deployment, nodes)
    yield name, SC.epoch, Literal(str(deployment.epoch), XSD.integer)
    yield name, PROV.generatedAtTime, moment(deployment.generated)
    agent = IRI.unchecked(f"urn:selfconf:configurator:{deployment.configurator}")
    yield name, PROV.wasAttributedTo, agent
    yield agent, TYPE, PROV.SoftwareAgent
    if deployment.revises is not None:
        yield name, PROV.wasRevisionOf, deployment.revises[0]
    for component, cause, detail, seconds in deployment.failures:
        node = next(nodes)
        yield name, PROV.wasInfluencedBy, node
        for predicate, value in failure_triples(component, cause, detail, seconds):
            yield node, predicate, value


def failure_triples(component: IRI, cause: str, detail: str, seconds: float) -> Iterator[tuple[IRI, Term]]:
    """What is said of a failure: each predicate with its value; when it was in seconds of the Unix epoch."""
    yield TYPE, SC.Failure
    yield SC.component, component
    yield SC.cause, Literal(cause)
    if detail:
        yield SC.detail, Literal(detail)
    yield PROV.atTime, moment(seconds)


def _blank_nodes() -> Iterator[BlankNode]:
    return (BlankNode(f"_:n{number}") for number in count(1))


def _stated(
    configuration: Configuration, name: IRI, task: Task, deployment: Deployment | None, nodes: Iterator[BlankNode]
) -> Iterator[Triple]:
    """What a configuration states, in the order in which it is read, each fact of its deployment at its place."""
    yield name, TYPE, SC.Configuration
    yield name, TYPE, PROV.Entity
    yield name, SC.template, configuration.template
    if deployment is not None and deployment.outside is not None:
        yield name, SC.insideOf, deployment.outside
    asked = next(nodes) if task.iri is None else task.iri
    yield name, SC.task, asked
    yield asked, TYPE, SC.Task
    yield asked, SC.template, task.template.iri
    if deployment is not None:
        yield asked, SC.name, Literal(deployment.running_as[0])
        yield asked, SC.priority, Literal(str(deployment.running_as[1]), XSD.integer)
    for parameter in task.template.parameters:
        if parameter.name in configuration.bindings:
            node = next(nodes)
            yield asked, SC.binding, node
            yield node, TYPE, SC.Binding
            yield node, SC.parameter, parameter.iri
            yield node, SC.name, Literal(parameter.name)  # the template, which says so, is not served with it
            yield node, SC.value, configuration.bindings[parameter.name]
    for assignment in configuration.assignments:
        replaced = {} if deployment is None else _replaced(assignment, deployment.revises)
        passed_over = () if deployment is None else deployment.passed_over.get(assignment.role, ())
        for component in assignment.components:
            node = next(nodes)
            yield name, SC.assignment, node
            yield node, TYPE, SC.Assignment
            yield node, SC.role, assignment.role
            yield node, SC.component, component
            if component in replaced:
                yield node, SC.replaces, replaced[component]
            for other in passed_over:
                yield node, SC.passedOver, other
    for component in configuration.recruits:
        yield name, SC.recruited, component
    yield from _wiring(configuration, name, nodes)


def _replaced(assignment: Assignment, revises: tuple[IRI, Configuration] | None) -> dict[IRI, IRI]:
    """Which component of the configuration before each one of an assignment takes the place of."""
    before = {} if revises is None else {one.role: one.components for one in revises[1].assignments}
    played = before.get(assignment.role, ())
    gone = [component for component in played if component not in assignment.components]
    come = [component for component in assignment.components if component not in played]
    return dict(zip(come, gone, strict=False))


def _wiring(configuration: Configuration, name: IRI, nodes: Iterator[BlankNode]) -> Iterator[Triple]:
    """The connections and the settings of a configuration."""
    for connection in configuration.connections:
        node = next(nodes)
        yield name, SC.connection, node
        yield node, TYPE, SC.Connection
        yield node, SC["from"], connection.source
        yield node, SC.output, Literal(connection.output, STRING)
        yield node, SC.to, connection.sink
        yield node, SC.input, Literal(connection.input, STRING)
    for setting in configuration.settings:
        node = next(nodes)
        yield name, SC.setting, node
        yield node, TYPE, SC.Setting
        yield node, SC.component, setting.component
        yield node, SC.name, Literal(setting.name)
        yield node, SC.value, setting.value
