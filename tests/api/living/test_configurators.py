"""What configurators tell is read from all of them, and what is wrong with an answer is a complaint."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.living.configurators import Configurators
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.port import Request
from tests.lab import Lab, iri

CONFIGURATION = b"<urn:a> a <https://w3id.org/selfconf#Configuration> ."


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """A laboratory in which a task is deployed whose tracker was lost."""
    lab = Lab(tmp_path)
    lab.repaired()
    return lab


@pytest.fixture
def configurators(lab: Lab) -> Configurators:
    """The configurators of the laboratory, as a program of a user asks them."""
    return Configurators(SynchronousBus(lab.network.node()), lab.keys)


def test_what_is_deployed_is_told_by_configurator(configurators: Configurators) -> None:
    deployed, complaints = configurators.deployed()
    ((name, body),) = deployed.items()
    assert [name] == [known for known, _ in configurators.documents()[0]]
    assert {
        "role": iri("position"),
        "components": [iri("absolute-odometry")],
        "passed_over": [iri("person-tracker")],
    } in (body["roles"])
    assert complaints == ()


def test_components_are_told_with_their_sources_also_those_that_have_none(configurators: Configurators) -> None:
    ((name, _),), _ = configurators.documents()
    links, _ = configurators.links([name], [iri("sonar"), iri("lamp")])
    assert (links[iri("sonar")], links[iri("lamp")]) == ((), ())
    assert iri("absolute-odometry") in links[iri("thinking-cap")]
    assert list(links) == sorted(links)
    assert configurators.links(["another"], []) == ({}, ())


def test_why_names_who_plays_and_who_was_passed_over(configurators: Configurators) -> None:
    sentences, complaints = configurators.why("position", None)
    assert "absolute-odometry" in "\n".join(sentences)
    assert "person-tracker" in "\n".join(sentences)
    assert complaints == ()


@pytest.mark.parametrize(
    ("name", "payload"), [("stranger", b"no Turtle"), ("*", CONFIGURATION)], ids=["no Turtle", "a key of none"]
)
def test_a_configuration_that_cannot_be_read_is_a_complaint(
    lab: Lab, configurators: Configurators, name: str, payload: bytes
) -> None:
    key = lab.keys.configuration(name)

    def answer(request: Request) -> None:
        request.reply(key, payload)
        request.finish()

    lab.network.node().serve(key, answer)
    deployed, (complaint,) = configurators.deployed()
    assert len(deployed) == 1
    assert complaint.startswith("left out a configuration: ")
    sentences, complaints = configurators.why("position", None)
    assert sentences
    assert complaints == (complaint,)
    assert configurators.why("position", 0.0) == ([], ())


def test_a_notice_that_cannot_be_read_is_a_complaint(lab: Lab, configurators: Configurators) -> None:
    key = lab.keys.notices("stranger")

    def answer(request: Request) -> None:
        request.reply(key, b"no notice")
        request.finish()

    lab.network.node().serve(key, answer)
    sentences, (complaint,) = configurators.why("position", None)
    assert sentences
    assert complaint.startswith("left out an answer: ")
