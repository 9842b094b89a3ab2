"""The advertisements of the measured ecology, and its task: two sources, one of which feeds a sink, and bystanders."""

from __future__ import annotations

import os
from pathlib import Path

from selfconf.model.term import IRI

HEAD = """@prefix sc:  <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix sh:  <http://www.w3.org/ns/shacl#> .
@prefix :    <https://example.org/live#> .
"""
ACTORS = {
    "first": ":first a sc:Component, rob:PositionSensor ; sc:preference 10 ; "
    'sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .\n',
    "second": ":second a sc:Component, rob:PositionSensor ; "
    'sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .\n',
    "sink": ":sink a sc:Component, rob:NavigationControl ; "
    'sc:hasInput [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] .\n',
}
TASK = (
    HEAD
    + """:follow a sc:Template ; sc:roles ( :position :control ) .
:position a sc:Role ; sh:class rob:PositionSensor ; sc:feeds :control .
:control  a sc:Role ; sh:class rob:NavigationControl .
"""
)
FOLDER_VARIABLE = "LIVE_BENCHMARK_FOLDER"


PAIR = {
    "source": ":source{0} a sc:Component, :Source{0} ; sc:shareable false ;\n"
    '    sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .\n',
    "sink": ":sink{0} a sc:Component, :Sink{0} ;\n"
    '    sc:hasInput [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] .\n',
    "task": ":follow{0} a sc:Template ; sc:roles ( :position :control ) .\n"
    ":position a sc:Role ; sh:class :Source{0} ; sc:feeds :control .\n"
    ":control  a sc:Role ; sh:class :Sink{0} .\n",
}
"""A source and a sink that no other task wants, and the task for which they are there."""


def bystander(number: int) -> IRI:
    """A component that has nothing to do with the task."""
    return IRI(f"https://example.org/live#bystander{number}")


def written_for(name: str) -> Path:
    """The advertisement of an actor."""
    return Path(os.environ[FOLDER_VARIABLE]) / "site0" / f"{name}.ttl"


def pair_file(kind: str, number: int) -> Path:
    """The file of one of a pair, or of its task."""
    return Path(os.environ[FOLDER_VARIABLE]) / ("tasks" if kind == "task" else "pairs") / f"{kind}{number}.ttl"


def write_pairs(count: int) -> None:
    """Write so many pairs with their tasks."""
    for number in range(count):
        for kind, text in PAIR.items():
            path = pair_file(kind, number)
            path.parent.mkdir(exist_ok=True)
            path.write_text(HEAD + text.format(number))


def write(folder: Path, components: int, sites: int) -> list[Path]:
    """The folders of the sites, with so many advertisements all in all besides those of the actors."""
    folders = [folder / f"site{number}" for number in range(sites)]
    for path in folders:
        path.mkdir()
    for name, text in ACTORS.items():
        (folders[0] / f"{name}.ttl").write_text(HEAD + text)
    for number, path in enumerate(folders):
        with (path / "bystanders.ttl").open("w") as file:
            file.write(HEAD)
            for one in range(number, components, sites):
                file.write(
                    f'<{bystander(one)}> a sc:Component, rob:SonarArray ; rob:place "room {one % 97}" ;\n'
                    '    sc:hasOutput [ sc:name "ranges" ; sc:signalType rob:RangeScan ] .\n'
                )
    (folder / "task.ttl").write_text(TASK)
    return folders
