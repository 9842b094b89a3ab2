"""Which roles a component could play, and what keeps it out of those that it nearly fits."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.method import Method
from selfconf.api.tasks.detached import task_record
from selfconf.api.tasks.role_fits import role_fits
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf import advertisements, turtle
from selfconf.rdf.advertisements import Advertisement
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES

MISSPELT = ":old a sc:Component, rob:PositonSensor ."


def record(text: str = NAVIGATE) -> TaskRecord:
    """The task of the tests."""
    task = sc.template(text).bind(robot=":Astrid", goal="(AT BEDROOM)")
    return task_record(task.complete(), Method.of())


def advertisement(text: str) -> Advertisement:
    good, _ = advertisements.read_advertisements((PREFIXES + text).encode(), "test")
    return good[0]


@pytest.mark.parametrize(
    ("text", "near"),
    [
        (ADVERTISEMENTS["tracker"], {"position": ()}),
        (ADVERTISEMENTS["pippi"], {"drive": ("support is Pippi, not Astrid",)}),
        (MISSPELT, {"position": ("is no PositionSensor but a PositonSensor (is one of them misspelt?)",)}),
        (":lamp a sc:Component, rob:Lamp .", {}),
    ],
)
def test_it_is_said_what_a_component_fits_nearly_and_why(text: str, near: dict[str, tuple[str, ...]]) -> None:
    fits = role_fits(record(), advertisement(text))
    assert len(fits) == 5
    assert {fit.role.short: fit.obstacles for fit in fits if fit.near} == near
    assert all(fit.obstacles for fit in fits if fit.role.short not in near)


@pytest.mark.process
def test_a_process_of_its_own_says_it_or_what_is_wrong(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "selfconf.api.tasks.role_fits"]
    asked = {"advertisement": turtle.ntriples(advertisement(ADVERTISEMENTS["drive"]).triples).decode()}
    told = []
    for text in (encode(record()).decode(), "{}"):
        done = subprocess.run(
            command, input=json.dumps({**asked, "record": text}), capture_output=True, text=True, check=True
        )
        told.append(json.loads(done.stdout))
    fits, refused = told
    assert [one["role"].partition("#")[2] for one in fits if one["eligible"]] == ["drive"]
    assert refused == {"detail": "not a message of kind 'task'"}
