"""Services of OWL-S, versions 1.1 and 1.2, as components: what the profile says goes in and out, by type.

The inputs and outputs of a service are ports, typed by their `process:parameterType`; a service whose profile lists
none has those of its process. What is said of services, profiles and parameters in other vocabularies is said of
components and ports. How a service works inside, what has to hold before it, and how it is reached is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from selfconf.importing.imported import ImportedComponent, ImportedDocument, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import NumberedNames, absolute, stem
from selfconf.importing.rdf_documents import rdf_documents
from selfconf.importing.sources import SourceDocument
from selfconf.model.profile import CALL_MARK, is_port_name
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import RDFS, SC, TYPE, Namespace

VERSIONS = ("1.1", "1.2")
PARTS_OF_OWL_S = ("Service", "Profile", "Process")
_BASES = {
    (version, part): Namespace(f"http://www.daml.org/services/owl-s/{version}/{part}.owl#")
    for version in VERSIONS
    for part in PARTS_OF_OWL_S
}
_PREFIXES = {f"{part.lower()}{version.replace('.', '')}": base.base for (version, part), base in _BASES.items()}
_UNUSED = {
    "hasPrecondition": ("preconditions", "an advertisement says what a component is, not when it may act"),
    "hasResult": ("results and effects", "an advertisement says what a component gives, not what it brings about"),
    "serviceCategory": ("categories", "the types of a component say what kind it is"),
    "contactInformation": ("contacts", "an advertisement has no place for them"),
    "qualityRating": ("ratings", "an advertisement has no place for them"),
}
"""Properties of profiles without a counterpart, in words, and why not."""
OWL_S = "http://www.daml.org/services/owl-s/"
"""What the terms of all versions begin with."""
_READ = frozenset(
    base[name]
    for (_, part), base in _BASES.items()
    for name in {
        "Service": ("presents", "presentedBy", "describedBy", "describes", "supports", "supportedBy"),
        "Profile": ("serviceName", "textDescription", "hasInput", "hasOutput", "hasParameter", "has_process", *_UNUSED),
        "Process": ("parameterType",),
    }[part]
)
"""The terms of OWL-S that are read, lead to what is read, or are named as left out."""


def import_services(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The services that documents of RDF describe, one after the other."""
    for source, document in rdf_documents(sources, ledger):
        components = [
            component
            for version in VERSIONS
            for component in _ServiceReader(document, version, source, ledger).components()
        ]
        if components:
            described = tuple(component.described() for component in components)
            yield ImportedDocument(stem(source), source.name, described, {**_PREFIXES, **document.prefixes})
        else:
            reason = "what a service of OWL-S 1.1 or 1.2 takes and gives stands in its profile"
            ledger.leave_out("documents without a profile", reason, source)


class _ServiceReader:
    """Reads the services of one document in one version."""

    def __init__(self, document: Document, version: str, source: SourceDocument, ledger: ImportLedger) -> None:
        self.document, self.source, self.ledger = document, source, ledger
        self.service, self.profile, self.process = (_BASES[version, part] for part in PARTS_OF_OWL_S)
        self._presenting: dict[Term, Node] = {}
        self._describing: dict[Term, list[Term]] = {}
        for subject, predicate, value in document.triples():
            if predicate == self.service.presents:
                self._presenting.setdefault(value, subject)
            elif predicate == self.service.describes:
                self._describing.setdefault(value, []).append(subject)

    def components(self) -> Iterator[ImportedComponent]:
        services: dict[Term, None] = dict.fromkeys(self.document.instances(self.service.Service))
        for profile in self._profiles():
            service = self._service(profile)
            services.pop(service, None)
            if isinstance(service, IRI):
                yield self._component(service, profile)
            else:
                self.ledger.leave_out("services without an IRI", "a component has an IRI", self.source)
        reason = "what they take and give stands in a profile, in the same document"
        self.ledger.leave_out("services without a profile", reason, self.source, len(services))

    def _profiles(self) -> list[Node]:
        """What is of the class of profiles, is presented, or has what a profile has; often it is of a class below."""
        speaks = {self.profile[name] for name in ("hasInput", "hasOutput", "serviceName")} | {self.service.presentedBy}
        found = dict.fromkeys(self.document.instances(self.profile.Profile))
        for subject, statements in self.document.statements.items():
            if subject in self._presenting or any(predicate in speaks for predicate, _ in statements):
                found[subject] = None
        return list(found)

    def _service(self, profile: Node) -> Term:
        """The service that presents a profile, or else the profile itself."""
        said = self.document.value(profile, self.service.presentedBy)
        return said or self._presenting.get(profile, profile)

    def _component(self, service: IRI, profile: Node) -> ImportedComponent:
        for name, (what, why) in _UNUSED.items():
            number = len(self.document.values(profile, self.profile[name]))
            if number:
                self.ledger.leave_out(what, why, self.source, number)
        if self.document.values(service, self.service.supports):
            reason = "they say how a service is reached, an advertisement says what it is"
            self.ledger.leave_out("groundings", reason, self.source)
        inputs, outputs = (self._parameters(service, profile, link) for link in ("hasInput", "hasOutput"))
        known = {*inputs, *outputs}
        further = [each for each in self.document.values(profile, self.profile.hasParameter) if each not in known]
        comments = ((RDFS.comment, words) for words in self._words(profile, self.profile.textDescription))
        others = (said for subject in dict.fromkeys((service, profile)) for said in self._other_terms(subject))
        return ImportedComponent(
            self.ledger.names.component(service, self.source),
            tuple(dict.fromkeys((self.service.Service, *self._kinds(profile)))),
            labels=tuple(self._words(profile, self.profile.serviceName)),
            properties=(*comments, *others),
            inputs=tuple(self._ports(inputs)),
            outputs=tuple(self._ports(outputs)),
            parameters=tuple(self._operational(further)),
        )

    def _kinds(self, profile: Node) -> list[IRI]:
        """The types of a profile that say what kind of service it is."""
        own = [
            kind for kind in self.document.values(profile, TYPE) if isinstance(kind, IRI) and kind not in self.profile
        ]
        kinds = [kind for kind in own if kind not in SC]
        self.ledger.leave_out("types of selfconf", "an import states those itself", self.source, len(own) - len(kinds))
        return [kind for kind in kinds if not kind.startswith("http://www.w3.org/")]

    def _words(self, subject: Node, predicate: IRI) -> Iterator[Literal]:
        """Texts with their languages; that a text is typed as xsd:string makes no difference."""
        for value in self.document.values(subject, predicate):
            if isinstance(value, Literal) and value.lexical.strip():
                yield Literal(" ".join(value.lexical.split()), value.datatype, value.language)

    def _parameters(self, service: IRI, profile: Node, link: str) -> list[Term]:
        """The parameters of a profile, or else of the process of its service."""
        found = self.document.values(profile, self.profile[link])
        if found:
            return found
        processes = dict.fromkeys(
            (
                *self.document.values(service, self.service.describedBy),
                *self._describing.get(service, ()),
                *self.document.values(profile, self.profile.has_process),
            )
        )
        return [each for process in processes for each in self.document.values(process, self.process[link])]

    def _other_terms(self, subject: Node) -> Iterator[tuple[IRI, Term]]:
        """What is said of something in other vocabularies, as far as it is a literal or an IRI."""
        for predicate, value in self.document.about(subject):
            if predicate == TYPE or predicate in _READ or (isinstance(value, Literal) and not value.lexical.strip()):
                continue
            if predicate.startswith(OWL_S):
                self.ledger.leave_out("further terms of OWL-S", "an advertisement has no counterpart", self.source)
            elif predicate in SC:
                self.ledger.leave_out("terms of selfconf", "an import states those itself", self.source)
            elif isinstance(value, IRI | Literal):
                yield predicate, value
            else:
                reason = "only plain values are kept"
                self.ledger.leave_out("nested values of other vocabularies", reason, self.source)

    def _typed(self, parameters: Iterable[Term]) -> Iterator[tuple[str, IRI | None, Term]]:
        """The name and the type of each parameter, and itself; a name that is taken gets a number."""
        names = NumberedNames()
        for parameter in parameters:
            name = parameter.short.rstrip(CALL_MARK) if isinstance(parameter, IRI) else ""
            said, *further = self.document.values(parameter, self.process.parameterType) or (None,)
            reason = "a parameter is of one type, the first"
            self.ledger.leave_out("further types of parameters", reason, self.source, len(further))
            kind = absolute(said.lexical.strip()) if isinstance(said, Literal) else said
            if said is not None and not isinstance(kind, IRI):
                self.ledger.leave_out("types that are no IRIs", "the parameter is kept without one", self.source)
            yield (
                names.free(name if is_port_name(name) else "parameter"),
                kind if isinstance(kind, IRI) else None,
                parameter,
            )

    def _ports(self, parameters: Iterable[Term]) -> Iterator[ImportedPort]:
        for name, kind, said in self._typed(parameters):
            others = () if isinstance(said, Literal) else tuple(self._other_terms(said))
            yield ImportedPort(name, () if kind is None else (kind,), properties=others)

    def _operational(self, parameters: Iterable[Term]) -> Iterator[tuple[str, IRI]]:
        for name, kind, said in self._typed(parameters):
            if not isinstance(said, Literal) and (number := sum(1 for _ in self._other_terms(said))):
                reason = "an operational parameter has a name and a type"
                self.ledger.leave_out("what else is said of operational parameters", reason, self.source, number)
            if kind is None:
                self.ledger.leave_out("parameters without a type", "an operational parameter has one", self.source)
            else:
                yield name, kind
