"""A port that an interaction names and no candidate has: what was probably meant, and where that is said."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf
from selfconf.model.refusal import InputUnfed, MisnamedPort
from tests.lab import PREFIXES

CAMERA = """
:camera a sc:Component, :Camera ; sc:hasOutput [ sc:name "picture" ; sc:signalType :Image ] ;
    sc:hasOperation [ sc:name "describe" ; sc:response :Words ] .
"""
SCREEN = ':screen a sc:Component, :Screen ; sc:hasInput [ sc:name "shown" ; sc:signalType :Image ] .'
BELL = ':bell a sc:Component, :Screen ; sc:needsOperation [ sc:name "look" ; sc:response :Words ] .'


def misnamed(folder: Path, sink: str, ports: str) -> MisnamedPort | None:
    """What is said of the ports of the only interaction of a task that is refused."""
    template = (
        ":t a sc:Template ; sc:roles ( :eye :face ) . :eye a sc:Role ; sh:class :Camera ."
        f" :face a sc:Role ; sh:class :Screen . [] a sc:Interaction ; sc:from :eye ; sc:to :face ; {ports} ."
    )
    (folder / "t.ttl").write_text(PREFIXES + template)
    refused = selfconf.configure(selfconf.template(folder / "t.ttl"), selfconf.read(PREFIXES + CAMERA + sink))
    assert isinstance(refused, selfconf.Refusal)
    (reason,) = refused.reasons
    assert isinstance(reason, InputUnfed)
    said = "" if reason.misnamed is None else f"; {reason.misnamed}"
    assert str(reason).endswith(said)
    return reason.misnamed


@pytest.mark.parametrize(
    ("sink", "ports", "kind", "named", "meant"),
    [
        (BELL, 'sc:output "describe"', "output", "describe", "describe()"),
        (BELL, 'sc:output "descibe()"', "output", "descibe()", "describe()"),
        (BELL, 'sc:input "look"', "input", "look", "look()"),
        (SCREEN, 'sc:output "pictrue"', "output", "pictrue", "picture"),
        (SCREEN, 'sc:output "Picture"', "output", "Picture", "picture"),
        (SCREEN, 'sc:output "picture()"', "output", "picture()", "picture"),
        (SCREEN, 'sc:output "picture" ; sc:input "show"', "input", "show", "shown"),
    ],
)
def test_a_name_that_was_probably_meant_is_proposed(
    tmp_path: Path, sink: str, ports: str, kind: str, named: str, meant: str
) -> None:
    found = misnamed(tmp_path, sink, ports)
    assert found is not None
    assert (found.kind, found.named, found.meant) == (kind, named, meant)
    assert str(found) == (
        f'no candidate of {"eye" if kind == "output" else "face"} has the {kind} "{named}" that an interaction names'
        f' (did you mean "{meant}"?)'
    )


@pytest.mark.parametrize("ports", ['sc:output "sound"', 'sc:output "describe()"'], ids=["unlike all", "there, unfit"])
def test_no_other_name_is_proposed_where_none_is_like_it_or_a_candidate_has_it(tmp_path: Path, ports: str) -> None:
    assert misnamed(tmp_path, SCREEN, ports) is None
