"""How near the ports of a component come to those that are wanted."""

from __future__ import annotations

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.port_likeness import PortLikeness, WantedPorts
from selfconf.model.profile import Input, Output, Ports
from selfconf.model.signal_likeness import SignalLikeness
from selfconf.model.term import IRI

CAR, PRICE, TAXED, COLOUR, VEHICLE = (IRI(f"urn:{name}") for name in ("Car", "Price", "Taxed", "Colour", "Vehicle"))
ABOVE = Hierarchy([(TAXED, PRICE), (CAR, VEHICLE)])
KNOWN = SignalLikeness(ABOVE)


def ports(inputs: list[IRI], outputs: list[IRI]) -> Ports:
    return Ports(
        tuple(Input(f"i{n}", (one,)) for n, one in enumerate(inputs)),
        tuple(Output(f"o{n}", (one,)) for n, one in enumerate(outputs)),
    )


def likeness(wanted: WantedPorts, inputs: list[IRI], outputs: list[IRI]) -> float:
    return PortLikeness([wanted], KNOWN).of(ports(inputs, outputs))[0]


BOTH = WantedPorts(((PRICE,),), ((CAR,),))


def test_what_is_wanted_and_nothing_else_is_nearest() -> None:
    assert likeness(BOTH, [CAR], [PRICE]) == 1
    exact = likeness(BOTH, [CAR], [PRICE, COLOUR])
    assert 1 > exact > likeness(BOTH, [CAR], [COLOUR])
    assert 1 > likeness(BOTH, [CAR], [TAXED]) > likeness(BOTH, [CAR], [COLOUR])
    assert likeness(BOTH, [COLOUR], [COLOUR]) == 0


def test_each_wanted_signal_has_an_output_of_its_own() -> None:
    two = WantedPorts(((PRICE,), (TAXED,)))
    assert likeness(two, [], [TAXED]) < likeness(two, [], [TAXED, PRICE]) == 1


def test_an_output_serves_all_that_want_just_its_signal() -> None:
    twice = WantedPorts(((PRICE,), (PRICE, COLOUR)), ((CAR,),))
    found, lacking = PortLikeness([twice], KNOWN).of(ports([CAR, CAR], [PRICE]))
    assert found == 1
    assert all(match.exact for match in (*lacking.issued, *lacking.given))


def test_an_output_serves_all_that_want_what_the_reasoning_mode_sees_above_it() -> None:
    below = WantedPorts(((PRICE,), (TAXED,), (PRICE,)))
    taxed = ports([], [TAXED])
    _, unseen = PortLikeness([below], KNOWN).of(taxed)
    assert str(unseen) == "issues no Price"
    found, lacking = PortLikeness([below], KNOWN, ABOVE).of(taxed)
    assert [match.offered for match in lacking.issued] == [TAXED] * 3
    assert found > PortLikeness([below], KNOWN).of(taxed)[0]


def test_an_input_is_given_what_lies_below_it() -> None:
    assert likeness(BOTH, [VEHICLE], [PRICE]) > likeness(BOTH, [COLOUR], [PRICE])


def test_a_side_of_which_nothing_is_known_does_not_count() -> None:
    assert likeness(WantedPorts(((PRICE,),)), [COLOUR], [PRICE]) == 1
    assert likeness(WantedPorts(None, ((CAR,),)), [CAR], [COLOUR]) == 1


def test_of_several_ways_the_nearest_counts_and_is_told() -> None:
    ways = [WantedPorts(((COLOUR,),)), WantedPorts(((PRICE,),))]
    found, lacking = PortLikeness(ways, KNOWN).of(ports([], [TAXED]))
    assert found > 0.75
    assert str(lacking) == "issues Taxed, which lies below Price"


def test_optional_inputs_need_nothing() -> None:
    only = Ports((Input("i", (COLOUR,), optional=True),), (Output("o", (PRICE,)),))
    assert PortLikeness([WantedPorts(((PRICE,),), ())], KNOWN).of(only)[0] == 1


def test_a_port_without_a_type_is_near_to_nothing() -> None:
    bare = Ports((Input("i", ()),), (Output("o", ()),))
    found, lacking = PortLikeness([BOTH], KNOWN).of(bare)
    assert found == 0
    assert str(lacking) == "issues no Price and needs a signal without a type, which it would not be given"
