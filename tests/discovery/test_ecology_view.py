"""The lives of an ecology as they are followed: all of them, or those that were selected."""

from __future__ import annotations

import pytest

from selfconf.discovery import Discovery, EcologyView, ecology_view
from selfconf.site import Shelf, Site
from tests.discovery.field import KEYS, TRACKER, Field
from tests.lab import iri, write_advertisements


def test_the_lives_of_components_are_known_after_a_discovery(field: Field) -> None:
    node = field.network.node()
    node.announce(KEYS.life(TRACKER, "abc"))
    field.discover()
    assert field.ecology.life(TRACKER) == "abc"
    assert field.ecology.life(iri("astrid-drive")) is None


def test_another_ecology_is_not_found(field: Field) -> None:
    write_advertisements(field.folder / "other", "tracker")
    Site(field.network.node(), "other", "other", Shelf([field.folder / "other"], print))
    assert field.discover() == Discovery()


# Sites of one name, and sites that were asked before.


@pytest.mark.parametrize("many", [0, 1_000], ids=["in parts", "all together"])
def test_each_life_is_told_once_however_it_is_followed(
    field: Field, monkeypatch: pytest.MonkeyPatch, many: int
) -> None:
    monkeypatch.setattr(ecology_view, "MANY_LIVES", many)
    lamps = field.network.node()
    undos = [lamps.announce(KEYS.life(iri(f"lamp{number}"), "1")) for number in range(100)]
    field.discover()
    told: list[tuple[str, bool]] = []
    field.ecology.follow(lambda key, alive: told.append((key, alive)), lambda key, alive: None)
    assert field.network.run(lambda: len(told) >= len(undos), 1.0)
    undos.append(lamps.announce(KEYS.life(iri("lamp100"), "1")))
    undos[0]()
    assert field.network.run(lambda: len(told) >= len(undos) + 1, 1.0)
    begun = sorted(KEYS.life(iri(f"lamp{number}"), "1") for number in range(101))
    assert sorted(key for key, alive in told if alive) == begun
    assert [key for key, alive in told if not alive] == [KEYS.life(iri("lamp0"), "1")]
    field.ecology.unfollow()
    undos[1]()
    field.network.run(lambda: False, 1.0)
    assert len(told) == 102


def selecting(field: Field, monkeypatch: pytest.MonkeyPatch, many: int = 0) -> list[tuple[str, bool]]:
    """Have the observer of a field select lives, discover and follow; what it is told of lives from then on."""
    monkeypatch.setattr(ecology_view, "MANY_LIVES", many)
    field.ecology = EcologyView(field.network.node(), "lab", selects=True)
    field.site("living-room", "tracker")
    field.discover()
    told: list[tuple[str, bool]] = []
    field.ecology.follow(lambda key, alive: told.append((key, alive)), lambda key, alive: None)
    field.network.run(lambda: False, 0.1)
    return told


def test_in_a_large_ecology_only_selected_lives_are_known_and_of_the_others_only_news(
    field: Field, monkeypatch: pytest.MonkeyPatch
) -> None:
    lamps, tracker = field.network.node(), field.network.node()
    undo = lamps.announce(KEYS.life(iri("lamp1"), "1"))
    tracker.announce(KEYS.life(TRACKER, "7"))
    told = selecting(field, monkeypatch)
    assert (field.ecology.lives, told) == ({}, [])
    answers: list[object] = []
    field.ecology.select([TRACKER, iri("nobody")], answers.append)
    field.network.run(lambda: False, 0.1)
    assert answers == [[KEYS.life(TRACKER, "7")]]
    assert (field.ecology.life(TRACKER), field.ecology.life(iri("nobody"))) == ("7", None)
    assert told == [(KEYS.life(TRACKER, "7"), True)]
    field.ecology.select([TRACKER], answers.append)
    assert answers[1:] == [()]
    lamps.announce(KEYS.life(iri("lamp2"), "1"))
    undo()
    tracker.close()
    field.network.node().announce(KEYS.life(iri("nobody"), "8"))
    field.network.run(lambda: False, 0.1)
    news = [
        (KEYS.life(iri("lamp2"), "1"), True),
        (KEYS.life(TRACKER, "7"), False),
        (KEYS.life(iri("nobody"), "8"), True),
    ]
    assert told[1:] == news


def test_lives_that_are_selected_twice_at_once_are_called_once_and_told_once(
    field: Field, monkeypatch: pytest.MonkeyPatch
) -> None:
    field.network.node().announce(KEYS.life(TRACKER, "7"))
    told = selecting(field, monkeypatch)
    answers: list[object] = []
    for _ in range(2):
        field.ecology.select([TRACKER], answers.append)
    field.network.run(lambda: False, 0.1)
    assert answers == [[KEYS.life(TRACKER, "7")], []]
    assert told == [(KEYS.life(TRACKER, "7"), True)]


def test_in_a_small_ecology_all_lives_are_known_to_who_selects(field: Field, monkeypatch: pytest.MonkeyPatch) -> None:
    field.network.node().announce(KEYS.life(TRACKER, "7"))
    told = selecting(field, monkeypatch, many=1)
    assert (field.ecology.life(TRACKER), told) == ("7", [(KEYS.life(TRACKER, "7"), True)])
    answers: list[object] = []
    field.ecology.select([TRACKER, iri("nobody")], answers.append)
    assert answers == [()]


def test_a_view_that_is_left_follows_nothing_that_is_selected_late(
    field: Field, monkeypatch: pytest.MonkeyPatch
) -> None:
    tracker = field.network.node()
    tracker.announce(KEYS.life(TRACKER, "7"))
    told = selecting(field, monkeypatch)
    field.ecology.select([TRACKER], lambda keys: None)
    field.ecology.unfollow()
    field.network.run(lambda: False, 0.1)
    tracker.close()
    field.network.run(lambda: False, 0.1)
    assert told == []
