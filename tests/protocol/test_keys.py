"""Keys are built and taken apart in one place, and none that activates is met by a broad question."""

from __future__ import annotations

from urllib.parse import unquote

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from selfconf.bus.memory.key_expressions import intersects
from selfconf.errors import AuthorError, PeerError
from selfconf.model.profile import LONGEST_PORT_NAME
from selfconf.model.term import IRI
from selfconf.protocol import keys
from selfconf.protocol.keys import Keys
from tests.protocol.strategies import iris

HOME = Keys("home")
names = st.from_regex(r"[A-Za-z0-9][A-Za-z0-9._-]{0,20}", fullmatch=True)
ports = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=20)


def every_key(component: IRI, port: str) -> list[str]:
    """One key of each kind."""
    return [
        HOME.site_life("s", "1"),
        HOME.advertisement("s", component),
        HOME.no_advertisements("s"),
        HOME.changed("s"),
        HOME.wake("s"),
        HOME.end("s"),
        HOME.keep("s"),
        HOME.kept_task("s", "tidy~1"),
        HOME.task("tidy~1"),
        HOME.life(component, "1"),
        HOME.output(component, port),
        HOME.fail(component),
        HOME.free(component),
        HOME.call(component, "apply"),
        HOME.configurator_life("c", "1"),
        HOME.configuration("c"),
        HOME.configurator_call("c", "stop"),
    ]


@given(iris, names)
def test_a_life_is_taken_apart_as_it_was_put_together(component: IRI, life: str) -> None:
    key = HOME.life(component, life)
    assert keys.life_of(key) == life
    assert keys.owner_of(key) == keys.component_chunk(component)


@given(names, names)
def test_the_lives_of_sites_and_configurators_name_their_owner(name: str, life: str) -> None:
    for key in (HOME.site_life(name, life), HOME.configurator_life(name, life)):
        assert (keys.owner_of(key), keys.life_of(key)) == (name, life)
    assert keys.site_of(HOME.site_life(name, life)) == name


@given(iris, ports)
def test_a_port_of_any_name_is_one_chunk_and_comes_back(component: IRI, port: str) -> None:
    key = HOME.output(component, port)
    assert unquote(key.rsplit("/", 1)[-1]) == port
    assert key.count("/") == HOME.output(component, "p").count("/")


@given(iris, ports)
def test_zenoh_takes_every_key(component: IRI, port: str) -> None:
    for key in every_key(component, port):
        assert str(zenoh.KeyExpr(key)) == key


def test_no_key_is_longer_than_zenoh_bears() -> None:
    """From 65,535 bytes on it panics, in the program that declares the key and in each that it is declared to."""
    component, port = IRI("urn:c"), "😀" * LONGEST_PORT_NAME
    keys = Keys("e" * 64)
    assert max(len(key) for key in (keys.output(component, port), keys.operation(component, port, component))) < 20_000


@given(iris, ports)
def test_no_two_kinds_of_keys_are_equal(component: IRI, port: str) -> None:
    keys_of_it = every_key(component, port)
    assert len(set(keys_of_it)) == len(keys_of_it)


@given(iris, iris)
def test_two_components_share_no_key(one: IRI, other: IRI) -> None:
    if one != other:
        assert not {key for key in every_key(one, "p") if key.startswith("selfconf/home/c/")} & set(
            every_key(other, "p")
        )


@given(iris)
def test_a_call_is_taken_apart_as_it_was_put_together(component: IRI) -> None:
    assert keys.call_of(HOME.call(component, "apply")) == "apply"


@pytest.mark.parametrize("broad", ["**", "selfconf/**", "selfconf/*/c/**", "selfconf/home/**", "*/**"])
def test_no_broad_question_meets_a_control_call(broad: str) -> None:
    component = IRI("https://example.org/drive")
    calls = (HOME.call(component, "apply"), HOME.wake("s"), HOME.end("s"), HOME.configurator_call("c", "stop"))
    for call in calls:
        assert not zenoh.KeyExpr(broad).intersects(zenoh.KeyExpr(call))
        assert not intersects(broad, call)


def test_the_questions_of_an_ecology_meet_what_they_are_meant_for() -> None:
    component = IRI("https://example.org/drive")
    met = [
        (HOME.any_site_life(), HOME.site_life("s", "1")),
        (HOME.advertisements(), HOME.advertisement("s", component)),
        (HOME.advertisements("s"), HOME.advertisement("s", component)),
        (HOME.changed(), HOME.changed("s")),
        (HOME.any_life(), HOME.life(component, "1")),
        (HOME.lives(component), HOME.life(component, "1")),
        (HOME.keep(), HOME.keep("s")),
        (HOME.kept_tasks(), HOME.kept_task("s", "tidy~1")),
        (HOME.task(), HOME.task("tidy~1")),
        (HOME.any_fail(), HOME.fail(component)),
        (HOME.any_free(), HOME.free(component)),
        (HOME.outputs(component), HOME.output(component, "pose")),
        (HOME.call(component), HOME.call(component, "apply")),
        (HOME.any_configurator_life(), HOME.configurator_life("c", "1")),
        (HOME.configuration(), HOME.configuration("c")),
        (HOME.configurator_call("*"), HOME.configurator_call("c", "stop")),
    ]
    for question, key in met:
        assert zenoh.KeyExpr(question).intersects(zenoh.KeyExpr(key))
        assert intersects(question, key)


@given(st.integers(0, 10**6))
def test_each_life_is_in_one_part_of_all_lives(number: int) -> None:
    life = HOME.life(IRI(f"https://example.org/lamp{number}"), "1")
    parts = HOME.parts_of_lives()
    assert [zenoh.KeyExpr(part).intersects(zenoh.KeyExpr(life)) for part in parts].count(True) == 1
    assert [part for part in parts if intersects(part, life)] == [part for part in parts if intersects(life, part)]
    assert [part for part in parts if zenoh.KeyExpr(part).intersects(zenoh.KeyExpr(life))] == [
        part for part in parts if intersects(part, life)
    ]


def test_all_lives_include_their_parts_so_that_whoever_may_read_them_may_read_these() -> None:
    assert all(zenoh.KeyExpr(HOME.any_life()).includes(zenoh.KeyExpr(part)) for part in HOME.parts_of_lives())


def test_ecologies_do_not_meet() -> None:
    component = IRI("https://example.org/drive")
    other = Keys("other")
    for question in (other.any_life(), other.advertisements(), other.any_site_life(), other.call(component)):
        for key in every_key(component, "p"):
            assert not intersects(question, key)


@pytest.mark.parametrize("name", ["", "a/b", "*", "@ctl", "a b", "x" * 65, "#", "ä", "-x"])
def test_a_name_that_cannot_be_a_chunk_is_refused_with_a_sentence(name: str) -> None:
    with pytest.raises(AuthorError, match=r"cannot name an ecology: begin with an ASCII letter or a digit; after it"):
        Keys(name)


@pytest.mark.parametrize("key", ["", "a/b", "selfconf/home/site/s/ads/x"])
def test_what_is_no_liveliness_key_has_no_owner(key: str) -> None:
    with pytest.raises(PeerError):
        keys.owner_of(key)


@pytest.mark.parametrize("key", ["", "selfconf/home/c/aa/bb", "selfconf/home/site"])
def test_what_is_no_key_of_a_site_names_no_site(key: str) -> None:
    with pytest.raises(PeerError):
        keys.site_of(key)


@given(names)
def test_the_keys_of_a_configurator_name_it(name: str) -> None:
    for key in (HOME.configuration(name), HOME.notices(name), HOME.configurator_call(name, "stop")):
        assert keys.configurator_of(key) == name


@pytest.mark.parametrize(
    "key", ["", "selfconf/home/conf/*/cfg", "selfconf/home/site/s/changed", "selfconf/home/conf/c"]
)
def test_what_is_no_key_of_one_configurator_names_none(key: str) -> None:
    with pytest.raises(PeerError, match="is no key of a configurator"):
        keys.configurator_of(key)


@given(names)
def test_a_site_without_advertisements_replies_to_the_question_for_them(name: str) -> None:
    assert zenoh.KeyExpr(HOME.advertisements(name)).includes(zenoh.KeyExpr(HOME.no_advertisements(name)))


@given(names, names)
def test_the_life_of_a_configurator_is_known_as_such(name: str, life: str) -> None:
    assert HOME.is_configurator_life(HOME.configurator_life(name, life))


@pytest.mark.parametrize(
    "key",
    [
        "",
        "**",
        "selfconf/home/conf/*/live/*",
        "selfconf/*/conf/c/live/1",
        "selfconf/other/conf/c/live/1",
        "selfconf/home/conf//live/1",
        "selfconf/home/conf/c/live",
        "selfconf/home/site/c/live/1",
        "selfconf/home/conf/c/live/1/2",
        "selfconf/home/conf/c/live/a?b",
    ],
)
def test_nothing_else_passes_for_the_life_of_a_configurator(key: str) -> None:
    assert not HOME.is_configurator_life(key)


@given(iris)
def test_a_fail_names_its_component(component: IRI) -> None:
    assert keys.owner_of_fail(HOME.fail(component)) == keys.component_chunk(component)


@pytest.mark.parametrize("key", ["", "selfconf/home/c/aa/bb", "selfconf/home/c/aa/bb/free", "a/b/c/d/e/f/fail"])
def test_what_is_no_fail_key_names_no_component(key: str) -> None:
    with pytest.raises(PeerError):
        keys.owner_of_fail(key)


@pytest.mark.parametrize("key", ["", "a/b", "other/home/site/s/live/1"])
def test_what_is_no_key_of_selfconf_names_no_ecology(key: str) -> None:
    with pytest.raises(PeerError):
        keys.ecology_of(key)


@given(names, names)
def test_a_task_is_known_to_its_user_by_its_name(name: str, token: str) -> None:
    assert keys.task_name(keys.task_identity(name, token)) == name


@given(st.text(max_size=80))
def test_any_text_becomes_a_name_that_a_task_can_have(text: str) -> None:
    name = keys.safe_name(text)
    assert keys.task_name(keys.task_identity(name, "1")) == name


def test_a_name_that_no_key_can_hold_is_no_name_of_a_task() -> None:
    with pytest.raises(AuthorError, match="cannot name a task"):
        keys.task_identity("tidy up", "1")
