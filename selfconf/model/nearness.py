"""Components by how near they come to what a role asks for: their ports, then the likeness of names and descriptions.

The hybrid of OWLS-MX (Klusch et al., 2006): ports are compared by signal types, texts by their words, and the two are
weighed. Where a role asks nothing of ports, texts alone decide; where both are silent, the IRI does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from selfconf.model.obstacle import UnlikePorts
from selfconf.model.port_likeness import PortLikeness
from selfconf.model.profile import Input, Output, Profile
from selfconf.model.term import IRI, STRING, Literal
from selfconf.model.text_likeness import TextLikeness, words

TEXT_WEIGHT = 0.3
"""What texts weigh, beside the ports."""
TEXTS_COMPARED = 5_000
"""Of how many components at most the texts are compared: those whose ports come nearest."""
_LANGUAGE = IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString")


class Near(NamedTuple):
    """A component and how near it comes."""

    profile: Profile
    likeness: float
    """From 0 to 1."""
    lacking: UnlikePorts | None
    """What its ports lack; None where nothing is asked of ports."""


def ranked(profiles: Iterable[Profile], ports: PortLikeness | None, question: Sequence[str]) -> list[Near]:
    """Components, the nearest first; `question` are the words of what is asked for."""
    near = [Near(one, *(ports.of(one.ports) if ports else (0.0, None))) for one in profiles]
    near.sort(key=_order)
    compared, others = near[:TEXTS_COMPARED], near[TEXTS_COMPARED:]
    text = TextLikeness(question, [words_of(one.profile) for one in compared])
    weight = TEXT_WEIGHT if ports else 1.0
    found = [
        one._replace(likeness=(1 - weight) * one.likeness + weight * text.of(number))
        for number, one in enumerate(compared)
    ]
    found += [one._replace(likeness=(1 - weight) * one.likeness) for one in others]
    return sorted(found, key=_order)


def _order(near: Near) -> tuple[float, IRI]:
    # Sums in another order may differ in the last digits, which should not decide.
    return -round(near.likeness, 9), near.profile.component


def words_of(profile: Profile) -> list[str]:
    """The words of a component: of its name, its types, its ports and their signal types, and all its strings."""
    ports: list[Input | Output] = [*profile.inputs, *profile.outputs]
    names = [profile.component.short, *(kind.short for kind in sorted(profile.types))]
    names += [name for port in ports for name in (port.name, *(signal.short for signal in port.signals))]
    texts = [
        value.lexical
        for _, value in profile.properties
        if isinstance(value, Literal) and value.datatype in (STRING, _LANGUAGE)
    ]
    return [word for text in (*names, *texts) for word in words(text)]
