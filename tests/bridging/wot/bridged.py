"""A bridge to things in a test: what lives, what is issued, what fails."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.wot.thing_client import ThingLimits
from selfconf.bridging.wot.thing_watch import ThingSettings
from selfconf.bridging.wot.thing_world import ThingWorld
from selfconf.model.term import IRI
from selfconf.protocol.messages import Reserve, Wire
from selfconf.sdk import Component
from tests.bridging.thing_server import ROB
from tests.sdk.living import LivingStage, until

HASTY = ThingSettings(rate=50.0, look=0.05, reread=0.05, longest_wait=0.2, limits=ThingLimits(answer=20.0))
"""Settings for tests: looks often, and has patience with a busy machine."""


class Bridged:
    """A bridge in an ecology, and what it has complained of."""

    def __init__(self, stage: LivingStage, folder: Path, ontologies: tuple[Path, ...]) -> None:
        self.stage, self.folder = stage, folder
        self.complaints: list[str] = []
        self.bridge = Bridge(folder, self.complaints.append, ontologies)

    def lives(self, name: str) -> bool:
        """Whether a thing lives on this side."""
        return self.bridge.lives(IRI(f"urn:thing:{name}"))

    def complained(self, words: str) -> bool:
        """Whether some words stand in a complaint."""
        return any(words in complaint for complaint in self.complaints)

    def heard(self, name: str, output: str) -> list[object]:
        """The values that an output issues, a list that grows."""
        values: list[object] = []
        key = self.stage.keys.output(IRI(f"urn:thing:{name}"), output)
        self.stage.caller.subscribe(key, lambda sample: values.append(json.loads(sample.payload)))
        return values

    def causes(self) -> list[str]:
        """The reasons of the FAILs so far."""
        return [fail.detail for _, fail in self.stage.fails]


@contextmanager
def bridging(stage: LivingStage, folder: Path, *sources: str, settings: ThingSettings = HASTY) -> Iterator[Bridged]:
    """Bridge the things of some sources inside the `with` block."""
    folder.mkdir(exist_ok=True)
    found = Bridged(stage, folder, settings.ontologies)
    with found.bridge.living(partial(ThingWorld, sources, settings), stage.ecology, stage.node):
        yield found
    assert until(lambda: not stage.hangs)


def written(folder: Path, *descriptions: object) -> str:
    """A file with the description of a thing, or with several."""
    path = folder / "things.td.json"
    path.write_text(json.dumps(descriptions[0] if len(descriptions) == 1 else list(descriptions)))
    return str(path)


class Button(Component):
    """What commands a thing."""


def active(found: Bridged, callers: Mapping[str, tuple[IRI, ...]] | None = None, **inputs: tuple[Wire, ...]) -> None:
    """Activate the lamp, with its inputs fed; `callers` are who may call its operations."""
    assert until(lambda: found.lives("lamp")), found.complaints
    held = found.stage.call("urn:thing:lamp", "reserve", Reserve(1, found.stage.supervisor, "task~1"))
    assert until(lambda: held)
    answers = found.stage.apply("urn:thing:lamp", inputs=inputs, callers=callers or {})
    assert until(lambda: answers)
    assert answers[0].active, answers


def button(stage: LivingStage) -> Button:
    """A button that is active."""
    kind = stage.advertised(
        Button,
        f'<urn:c:button> a sc:Component, :Button ; sc:hasOutput [ sc:name "on" ; sc:signalType <{ROB}Switch> ] .',
    )
    component = stage.component(kind())
    answers = stage.apply("urn:c:button")
    assert until(lambda: answers)
    return component
