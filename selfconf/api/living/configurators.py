"""What the configurators of a living ecology tell of themselves: what they have deployed, and why."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, TypeVar

from selfconf.api.living.component_terms import iri_or_local_name
from selfconf.api.living.deployed import connected, deployed_body, passed_over
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.answers import own_answers
from selfconf.errors import PeerError, TurtleError
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, configurator_of, task_name
from selfconf.protocol.messages import Notice
from selfconf.rdf import turtle
from selfconf.rdf.turtle import Document
from selfconf.render.why import told_why

_Found = TypeVar("_Found")
Told = tuple[_Found, tuple[str, ...]]
"""What configurators have told, and a complaint for each answer that was left out, as something was wrong with it."""


class Configurators:
    """Asks the configurators of an ecology."""

    def __init__(self, bus: SynchronousBus, keys: Keys) -> None:
        self._bus, self._keys = bus, keys

    def documents(self) -> Told[list[tuple[str, Document]]]:
        """What each configurator has deployed, with its name."""
        found: list[tuple[str, Document]] = []
        complaints: list[str] = []
        for sample in self._bus.ask(self._keys.configuration()).samples:
            try:
                name = configurator_of(sample.key)
                if sample.key != self._keys.configuration(name):
                    raise PeerError(f"{sample.key!r} is not the key of the configuration of {name!r}")
                found.append((name, turtle.parse(sample.payload, sample.key)))
            except (PeerError, TurtleError) as error:
                complaints.append(f"left out a configuration: {error}")
        return found, tuple(complaints)

    def deployed(self) -> Told[dict[str, dict[str, Any]]]:
        """What each configurator has deployed, as JSON, by its name: roles, connections, parameters, bindings."""
        documents, complaints = self.documents()
        bodies = [(name, deployed_body(document)) for name, document in documents]
        return {name: body for name, body in bodies if body is not None}, complaints

    def links(self, names: Collection[str], components: Iterable[IRI]) -> Told[dict[IRI, tuple[IRI, ...]]]:
        """The sources of each component, of those given and of those that some configurators have connected; sorted."""
        heard: dict[IRI, set[IRI]] = {component: set() for component in components}
        documents, complaints = self.documents()
        for name, document in documents:
            if name in names:
                for source, sink in connected(document):
                    heard.setdefault(sink, set()).add(source)
        return {component: tuple(sorted(sources)) for component, sources in sorted(heard.items())}, complaints

    def why(self, term: str, at: float | None) -> Told[list[str]]:
        """Why components play the roles that a term means, in sentences; at a moment, or now."""
        meant = iri_or_local_name(term)
        told: dict[str, list[Notice]] = {}
        samples = self._bus.ask(self._keys.notices()).samples
        answers, rejected = own_answers(samples, Notice, lambda one: self._keys.notices(one.configurator))
        for notice in answers:
            told.setdefault(notice.configurator, []).append(notice)
        deployed: dict[str, dict[str, Any]] = {}
        if at is None:
            deployed, complaints = self.deployed()
            rejected += complaints
        sentences: list[str] = []
        for configurator, notices in sorted(told.items()):
            events = [notice.event for notice in sorted(notices, key=lambda notice: notice.sequence)]
            try:
                passed = passed_over(deployed[configurator]) if configurator in deployed else {}
                sentences += told_why(task_name(notices[0].task), events, meant, at, passed)
            except PeerError as error:
                rejected.append(f"left out an answer: {error}")
        return sentences, tuple(rejected)
