"""A wanted signal type and the nearest that is offered."""

from __future__ import annotations

from selfconf.model.signal_match import Degree, SignalMatch
from selfconf.model.term import IRI


def test_only_what_is_wanted_is_exact() -> None:
    pose = IRI("urn:Pose")
    assert SignalMatch(pose, pose, Degree.EXACT, 1.0).exact
    assert not any(SignalMatch(pose, None, degree, 0.0).exact for degree in Degree if degree is not Degree.EXACT)
