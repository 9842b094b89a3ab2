"""A refusal is explained apart from its configurator: with near misses and relaxations, without what is lost."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from selfconf.api.tasks.explaining import explained_refusal
from selfconf.protocol.codec import encode
from selfconf.rdf import turtle
from tests.api.tasks.test_role_fits import advertisement, record
from tests.lab import ADVERTISEMENTS, iri

ECOLOGY = {one.component: one for one in map(advertisement, ADVERTISEMENTS.values())}


def test_a_refusal_is_explained_with_its_relaxations() -> None:
    told = explained_refusal(record(), ECOLOGY, {iri("astrid-drive")})
    assert "let the role drive take pippi-drive, although its support is Pippi, not Astrid" in json.dumps(
        told["repairs"]
    )
    assert "no component is eligible for the role drive" in json.dumps(told["reasons"])


def test_where_there_is_a_configuration_it_is_said_that_there_is_no_refusal() -> None:
    assert "has a configuration" in str(explained_refusal(record(), ECOLOGY, set())["detail"])


@pytest.mark.process
def test_a_process_of_its_own_says_it_or_what_is_wrong() -> None:
    texts = [turtle.ntriples(one.triples).decode() for one in ECOLOGY.values()]
    told = []
    for text in (encode(record()).decode(), "{}"):
        asked = {"record": text, "advertisements": texts, "lost": [iri("astrid-drive")]}
        command = [sys.executable, "-m", "selfconf.api.tasks.explaining"]
        done = subprocess.run(command, input=json.dumps(asked), capture_output=True, text=True, check=True)
        told.append(json.loads(done.stdout))
    assert told[0]["reasons"][0]["role"] == iri("drive")
    assert "detail" in told[1]
