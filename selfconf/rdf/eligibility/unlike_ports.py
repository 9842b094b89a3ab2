"""Components that a role would take if its shape asked nothing of their ports, and what a role asks for in words."""

from __future__ import annotations

from collections.abc import Container, Iterator

from selfconf.model.port_likeness import WantedPorts
from selfconf.model.term import IRI, Literal
from selfconf.model.text_likeness import words
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import EligibleComponent, Partitioner
from selfconf.rdf.eligibility.wanted_signals import wanted_ports, without_port_shapes
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import LABEL, RDFS

_SAID = (LABEL, RDFS.comment)


def ports_asked(partitioner: Partitioner, role: IRI) -> WantedPorts | None:
    """What the shape of a role asks of ports; None if it asks nothing."""
    return wanted_ports(partitioner.document, role)


def kept_out_by_ports(
    partitioner: Partitioner, role: IRI, ecology: AdvertisementIndex, inside: Container[IRI]
) -> Iterator[EligibleComponent]:
    """The components that only what the shape asks of ports keeps out of a role; `inside` are those that it takes."""
    asking_less = partitioner.reading(without_port_shapes(partitioner.document, role), role)
    (found,) = asking_less.eligible(ecology)
    return (one for one in found if one.profile.component not in inside)


def words_of_role(document: Document, role: IRI, wanted: WantedPorts | None) -> list[str]:
    """The words of what a role asks for: its name, labels and comments, and the signals that it wants."""
    texts = [role.short, *(o.lexical for p in _SAID for o in document.values(role, p) if isinstance(o, Literal))]
    types = () if wanted is None else (*(wanted.issued or ()), *(wanted.given or ()))
    return [word for text in (*texts, *(one.short for some in types for one in some)) for word in words(text)]
