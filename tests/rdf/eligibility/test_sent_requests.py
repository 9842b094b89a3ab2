"""What is sent along with calls is known by all that it is, wherever a partition is made under a hierarchy."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import Candidate, Partition, Recruit
from selfconf.model.profile import Ports, Profile, needed_operation
from selfconf.rdf.eligibility.sent_requests import with_sent_requests
from tests.lab import iri

LOW, HIGH, TEXT = iri("Low"), iri("High"), iri("Text")
ABOVE = Hierarchy([(LOW, HIGH)])
LOOK, RESET = needed_operation("look", LOW, TEXT), needed_operation("reset", None, TEXT)
CALLER = Profile(iri("caller"), ports=Ports((LOOK, RESET)))
SILENT = Profile(iri("silent"), ports=Ports((RESET,)))


def kinds(profile: Profile) -> list[frozenset[str] | None]:
    """What each request of a component is known to be."""
    conditions = [port.condition for port in profile.inputs]
    return [None if one is None or one.sent is None else one.sent.kinds for one in conditions]


def test_a_request_is_all_that_lies_above_it_for_players_and_recruits() -> None:
    partition = Partition(((Candidate(CALLER), Candidate(SILENT)),), recruits=(Recruit(CALLER, frozenset((0,))),))
    raised = with_sent_requests(partition, ABOVE)
    caller, silent = raised.candidates[0]
    assert kinds(caller.profile) == kinds(raised.recruits[0].profile) == [{LOW, HIGH}, frozenset()]
    assert silent is partition.candidates[0][1]


def test_where_nothing_lies_above_or_nothing_is_sent_all_stays_as_it_is() -> None:
    partition = Partition(((Candidate(CALLER),),))
    assert with_sent_requests(partition, NOTHING_ABOVE) is partition
    silent = Partition(((Candidate(SILENT),),))
    assert with_sent_requests(silent, ABOVE) is silent
