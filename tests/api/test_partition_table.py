"""The partition as a table: who is eligible for each role, in order, and what keeps the others out."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf import partition, read, template
from selfconf.api.partition_table import PartitionTable
from selfconf.errors import BindingError, TemplateError
from selfconf.model.configuration import Wants
from selfconf.model.holder import Holder
from selfconf.model.obstacle import PropertyUnmet, WrongType
from selfconf.rdf.vocabulary import XSD
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri


def short(components: tuple[sc.IRI, ...]) -> list[str]:
    """The local names of components."""
    return [component.short for component in components]


def test_roles_are_found_by_local_name_curie_and_iri(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    found = sc.partition(task, home)
    assert list(found) == ["sonar", "encoder", "position", "control", "drive"]
    for name in ("position", ":position", "https://w3id.org/selfconf/peis-home#position"):
        assert short(found[name].eligible) == ["person-tracker", "absolute-odometry"]
    with pytest.raises(KeyError, match="the roles are sonar"):
        found["pilot"]
    assert found.sufficient


def test_a_partition_cannot_be_changed(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    found = sc.partition(task, home)
    for value, name in ((found, "roles"), (found["drive"], "candidates"), (found["drive"], "excluded")):
        with pytest.raises(AttributeError):
            setattr(value, name, ())
    with pytest.raises(TypeError):
        found["drive"].held[found["drive"].eligible[0]] = None  # type: ignore[index]  # that is what is tested
    assert found["drive"].excluded is found["drive"].excluded


@pytest.mark.parametrize(
    ("priority", "goal", "held"), [(0, "(AT KITCHEN)", True), (0, "(AT BEDROOM)", False), (-1, "x", False)]
)
def test_what_can_be_shared_is_held_where_its_holder_has_set_it_to_something_else(
    task: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch, priority: int, goal: str, held: bool
) -> None:
    cap = sc.IRI("https://w3id.org/selfconf/peis-home#thinking-cap")
    text = Path("examples/peis-home/thinking-cap.ttl").read_text()
    shared = text.replace("rob:NavigationControl ;", "rob:NavigationControl ; sc:shareable true ;")
    others = [path for path in Path("examples/peis-home").iterdir() if path.stem != "thinking-cap"]
    holder = Holder("watch~1", priority, wants=Wants(values=frozenset({("goal", sc.Literal(goal))})))
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: {cap: holder})
    found = sc.partition(task, sc.read(*others, shared))
    assert dict(found["control"].held) == ({cap: holder} if held else {})
    assert found.sufficient is not held


SHARED = f"""{PREFIXES}
:t a sc:Template ; sc:roles ( :r :s ) ; sc:parameter :v .
:v a sc:Parameter ; sc:name "v" .
:r a sc:Role ; sh:class :A ;
    sc:sets [ sc:parameterType :Limit ; sc:value 1 ] , [ sc:parameterType :HardLimit ; sc:value 2 ] .
:s a sc:Role ; sh:class :B ; sh:property [ sh:path :of ; sh:in ( :v ) ] ;
    sc:sets [ sc:parameterType :Whose ; sc:value :v ] .
"""
SHARERS = f"""{PREFIXES}
:a a sc:Component, :A ; sc:shareable true ;
    sc:hasParameter [ sc:name "low" ; sc:parameterType :Limit ] , [ sc:name "high" ; sc:parameterType :HardLimit ] .
:b a sc:Component, :B ; :of :Emil ; sc:shareable true ; sc:hasParameter [ sc:name "of" ; sc:parameterType :Whose ] .
"""


@pytest.mark.parametrize(
    ("low", "whose", "held"), [("1", "of", []), ("2", "of", ["a"]), ("1", "whose", ["b"]), ("2", "whose", ["a", "b"])]
)
def test_a_sharer_is_asked_for_the_one_value_of_each_parameter_that_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, low: str, whose: str, held: list[str]
) -> None:
    """Of two settings that match a parameter that of its own type counts; what is left free may become its value."""
    ontology = tmp_path / "limits.ttl"
    ontology.write_text(f"{PREFIXES} :HardLimit rdfs:subClassOf :Limit .")
    one, two = sc.Literal(low, XSD.integer), sc.Literal("2", XSD.integer)
    wants = {"a": Wants(values=frozenset({("low", one), ("high", two)}))}
    wants["b"] = Wants(values=frozenset({(whose, iri("Emil"))}))
    holders = {iri(name): Holder("watch~1", wants=some) for name, some in wants.items()}
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: holders)
    task, ecology = sc.template(SHARED), sc.read(SHARERS)
    found = sc.partition(task, ecology, reasoning="subclass", ontologies=ontology)
    assert [one.short for role in ("r", "s") for one in found[role].held] == held
    assert bool(sc.configure(task, ecology, reasoning="subclass", ontologies=ontology)) is not bool(held)


def test_each_excluded_component_has_its_obstacles(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    drive = sc.partition(task, home)["drive"]
    assert len(drive.eligible) + len(drive.excluded) == len(home)
    sonar = next(one for one in home.components if one.short == "sonar-array")
    (obstacle,) = drive.obstacles(sonar)
    assert isinstance(obstacle, WrongType)
    assert str(obstacle) == "is no MotorDrive"
    assert drive.obstacles(drive.eligible[0]) == ()
    with pytest.raises(KeyError, match="no component"):
        drive.obstacles(sc.IRI("x:nowhere"))


def test_a_partition_prints_as_a_table_and_so_does_a_role(clock: sc.TaskSpecification) -> None:
    found = sc.partition(clock.bind(room=":cellar"), sc.read("examples/clock"))
    assert not found.sufficient
    assert [line.split() for line in repr(found).splitlines()[2:]] == [
        [":source", "1", ":clock"],
        [":screen", "no", "component"],
    ]
    assert "place is kitchen, not cellar" in repr(found["screen"]._repr_html_())
    assert repr(found["screen"]) == "<role screen: no component>"
    assert found._repr_html_().count("<tr>") == 3
    assert found["source"]._repr_html_().count("<tr>") == 3


EVERYTHING = PREFIXES + "\n".join(ADVERTISEMENTS.values())


def table(ads: str = EVERYTHING) -> PartitionTable:
    """The partition of the paper's task."""
    return partition(template(NAVIGATE).bind(robot=":Astrid", goal="x"), read(ads))


def test_the_eligible_components_are_in_the_order_of_trying() -> None:
    assert table()["position"].eligible == (iri("person-tracker"), iri("absolute-odometry"))
    assert [candidate.profile.preference for candidate in table()["position"].candidates] == [10, 0]


def test_what_keeps_a_component_out_is_a_value() -> None:
    drive = table()["drive"]
    (obstacle,) = drive.obstacles(iri("pippi-drive"))
    assert isinstance(obstacle, PropertyUnmet)
    assert str(obstacle) == "support is Pippi, not Astrid"
    assert isinstance(drive.obstacles(iri("wheels"))[0], WrongType)
    assert drive.obstacles(iri("astrid-drive")) == ()
    assert drive.excluded[0].component == iri("pippi-drive")
    assert len(drive.excluded) == len(ADVERTISEMENTS) - 1


def test_a_partition_suffices_where_every_role_has_as_many_as_it_asks_for() -> None:
    assert table().sufficient
    poor = table(EVERYTHING.replace("rob:Encoder", "rob:Lamp"))
    assert not poor.sufficient
    assert poor["encoder"].eligible == ()
    assert "no component" in repr(poor["encoder"])


def test_a_partition_prints_as_a_table() -> None:
    text = repr(table())
    head, _, *rows = text.splitlines()
    assert head.startswith("role")
    assert len(rows) == 6
    assert [":position", "1", ":person-tracker"] in [row.split() for row in rows]
    assert ":person-tracker" in table()._repr_html_()


def test_what_cannot_be_partitioned_is_said() -> None:
    with pytest.raises(BindingError, match="needs a value"):
        partition(template(NAVIGATE), read(EVERYTHING))
    bad = PREFIXES + ':t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:pattern "(" .'
    with pytest.raises(TemplateError, match="not well-formed"):
        partition(template(bad), read(EVERYTHING))
