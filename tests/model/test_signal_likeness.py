"""How near signal types come to each other: the degree of a match, and the likeness within it."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.signal_likeness import EVERYTHING, Degree, SignalLikeness, SignalMatch
from selfconf.model.term import IRI


def test_only_what_is_wanted_is_exact() -> None:
    pose = IRI("urn:Pose")
    assert SignalMatch(pose, pose, Degree.EXACT, 1.0).exact
    assert not any(SignalMatch(pose, None, degree, 0.0).exact for degree in Degree if degree is not Degree.EXACT)


def iri(name: str) -> IRI:
    return IRI(f"urn:{name}")


CHAIN = [("laser", "scan"), ("scan", "range"), ("range", "sensing"), ("sonar", "range"), ("pose", "state")]
KNOWN = SignalLikeness(
    Hierarchy(
        [(iri(a), iri(b)) for a, b in CHAIN] + [(iri(top), one) for top in ("sensing", "state") for one in EVERYTHING]
    )
)


def degree(offered: str, wanted: str) -> Degree:
    return KNOWN.match(iri(offered), iri(wanted)).degree


def test_degrees_are_those_of_matchmaking() -> None:
    assert degree("scan", "scan") is Degree.EXACT
    assert degree("laser", "range") is Degree.PLUG_IN
    assert degree("range", "laser") is Degree.SUBSUMES
    assert degree("sonar", "scan") is Degree.OVERLAP
    assert degree("pose", "scan") is Degree.FAIL  # that all is a thing says nothing


def test_nearer_in_the_hierarchy_is_more_alike_and_no_degree_passes_a_better_one() -> None:
    wanted = "scan"
    order = ["scan", "laser", "range", "sensing", "sonar", "pose"]
    found = [KNOWN.match(iri(one), iri(wanted)).likeness for one in order]
    assert found == sorted(found, reverse=True)
    assert len(set(found)) == len(found)
    assert found[0] == 1
    assert found[-1] == 0


def test_equivalent_types_are_exact() -> None:
    both = SignalLikeness(Hierarchy([(iri("a"), iri("b")), (iri("b"), iri("a"))]))
    assert both.match(iri("a"), iri("b")).degree is Degree.EXACT


def test_without_a_hierarchy_only_equal_types_match() -> None:
    flat = SignalLikeness(NOTHING_ABOVE)
    assert flat.match(iri("a"), iri("a")).likeness == 1
    assert flat.match(iri("a"), iri("b")).degree is Degree.FAIL


def test_the_nearest_of_several_is_found_and_of_none_that_there_is_none() -> None:
    best = KNOWN.nearest([iri("pose"), iri("laser")], [iri("state"), iri("scan")])
    assert (best.offered, best.wanted, best.degree) == (iri("laser"), iri("scan"), Degree.PLUG_IN)
    assert KNOWN.nearest([], [iri("scan")]).wanted == iri("scan")
    assert KNOWN.nearest([iri("scan")], []).degree is Degree.FAIL


_TYPES = st.sampled_from("abcdef")


@given(st.lists(st.tuples(_TYPES, _TYPES)), _TYPES, _TYPES)
def test_likeness_is_in_the_band_of_its_degree(edges: list[tuple[str, str]], offered: str, wanted: str) -> None:
    found = SignalLikeness(Hierarchy([(iri(a), iri(b)) for a, b in edges])).match(iri(offered), iri(wanted))
    least, most = {
        Degree.EXACT: (1.0, 1.0),
        Degree.PLUG_IN: (0.75, 1.0),
        Degree.SUBSUMES: (0.5, 0.75),
        Degree.OVERLAP: (0.0, 0.5),
        Degree.FAIL: (0.0, 0.0),
    }[found.degree]
    assert least <= found.likeness <= most
