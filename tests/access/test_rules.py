"""Who may do what, judged by keys: an own reading of Zenoh's rules says what passes."""

from __future__ import annotations

from typing import Any

import pytest
import zenoh

from selfconf.access import AccessRules, Principal, PrincipalKind, rules_of
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import RefusedAttempt

KEYS = Keys("lab")
CAMERA, DRIVE, LAMP = IRI("urn:camera"), IRI("urn:drive"), IRI("urn:lamp")


def rules() -> AccessRules:
    """The rules of the site `home`, which knows one of each kind."""
    return rules_of(
        "lab",
        "home",
        [(Principal.component(CAMERA),), (Principal.component(DRIVE), Principal.component(LAMP))],
        {"attic": {IRI("urn:bell")}},
        [(Principal(kind, "alice"),) for kind in (PrincipalKind.CONFIGURATOR, PrincipalKind.READER)]
        + [(Principal(PrincipalKind.SITE, "attic"),), (Principal(PrincipalKind.SITE, "home"),)],
    )


def passes(principal: str, flow: str, message: str, key: str, at_uplinks: bool = False) -> bool:
    """Whether a message passes, as Zenoh has it: by default not, and by inclusion of keys."""
    control: dict[str, Any] = rules().access_control(at_uplinks)
    assert (control["enabled"], control["default_permission"]) == (True, "deny")
    subjects = {s["id"] for s in control["subjects"] if s.get("cert_common_names", [principal]) == [principal]}
    allowed = {rule for p in control["policies"] if subjects & set(p["subjects"]) for rule in p["rules"]}
    return any(
        rule["id"] in allowed
        and flow in rule["flows"]
        and message in rule["messages"]
        and any(zenoh.KeyExpr(granted).includes(zenoh.KeyExpr(key)) for granted in rule["key_exprs"])
        for rule in control["rules"]
    )


CAM, DRV = (Principal.component(component).common_name for component in (CAMERA, DRIVE))


def test_all_components_are_asked_at_once_how_they_are_and_for_nothing_else() -> None:
    """A question is delivered only by a grant that includes its whole key, wildcards and all."""
    assert passes("conf.alice", "ingress", "query", KEYS.any_call("state"))
    assert passes(CAM, "egress", "query", KEYS.any_call("state"))
    assert not passes(CAM, "egress", "query", KEYS.any_call("release"))
    assert not passes("read.alice", "ingress", "query", KEYS.any_call("state"))


@pytest.mark.parametrize(
    ("principal", "message", "key", "allowed"),
    [
        (CAM, "put", KEYS.output(CAMERA, "image"), True),
        (CAM, "put", KEYS.output(DRIVE, "image"), False),
        (DRV, "put", KEYS.output(LAMP, "light"), True),
        (CAM, "liveliness_token", KEYS.life(CAMERA, "1"), True),
        (CAM, "liveliness_token", KEYS.life(DRIVE, "1"), False),
        (CAM, "query", KEYS.call(DRIVE, "state"), False),
        (CAM, "declare_subscriber", KEYS.output(DRIVE, "speed"), True),
        (CAM, "query", KEYS.operation(DRIVE, "halt", CAMERA), True),
        (CAM, "query", KEYS.operation(DRIVE, "halt", LAMP), False),
        (DRV, "query", KEYS.operation(CAMERA, "takePhoto", LAMP), True),
        ("conf.alice", "query", KEYS.call(DRIVE, "apply"), True),
        ("conf.alice", "liveliness_token", KEYS.configurator_life("alice-1", "1"), True),
        ("conf.alice", "liveliness_token", KEYS.configurator_life("bob-1", "1"), False),
        ("conf.alice", "liveliness_token", KEYS.configurator_life("alice", "1"), False),
        ("conf.alice", "put", KEYS.fail(DRIVE), False),
        ("read.alice", "query", KEYS.advertisements("*"), True),
        ("read.alice", "query", KEYS.call(DRIVE, "state"), False),
        ("read.alice", "query", KEYS.configurator_call("*", "task"), True),
        ("read.alice", "query", KEYS.configurator_call("*", "status"), True),
        ("read.alice", "query", KEYS.configurator_call("status", "stop"), False),
        ("read.alice", "query", KEYS.configurator_call("*", "stop"), False),
        ("read.alice", "query", KEYS.log("home"), False),
        ("conf.alice", "query", KEYS.log("home"), True),
        ("read.alice", "declare_subscriber", KEYS.output(DRIVE, "speed"), False),
        ("site.attic", "put", KEYS.output(IRI("urn:bell"), "ring"), True),
        ("site.attic", "put", KEYS.output(DRIVE, "speed"), False),
        ("site.attic", "reply", KEYS.advertisement("home", DRIVE), False),
        ("site.attic", "query", KEYS.operation(DRIVE, "halt", IRI("urn:bell")), True),
        ("site.attic", "query", KEYS.operation(DRIVE, "halt", CAMERA), False),
        ("site.attic", "query", KEYS.call(DRIVE, "state"), True),
        ("site.home", "put", KEYS.output(DRIVE, "speed"), True),
        ("conf.unknown", "query", KEYS.advertisements("*"), False),
        ("conf.unknown", "query", KEYS.introduce("*"), True),
    ],
)
def test_each_may_do_what_its_name_says(principal: str, message: str, key: str, allowed: bool) -> None:
    assert passes(principal, "ingress", message, key) is allowed
    tried = RefusedAttempt(principal, message.replace("_", " ").title(), key, 1, 0.0)
    assert rules().allow(tried) is allowed


def test_the_holder_of_a_certificate_is_known_with_the_components_that_it_is_for() -> None:
    camera, drive, lamp = map(Principal.component, (CAMERA, DRIVE, LAMP))
    for known in ((camera,), (drive,), (drive, lamp), (Principal(PrincipalKind.READER, "alice"),)):
        assert rules().knows(known), known
    for unknown in ((lamp,), (camera, lamp), (drive, lamp, camera), (Principal(PrincipalKind.READER, "bob"),)):
        assert not rules().knows(unknown), unknown


def test_only_sites_that_are_known_answer_who_shows_a_certificate() -> None:
    """Else anybody who is let in could have each program that starts wait for an answer that never comes."""
    for message in ("declare_queryable", "reply"):
        assert passes("site.attic", "ingress", message, KEYS.introduce("attic"))
        assert not passes("site.attic", "ingress", message, KEYS.introduce("home"))
        for stranger in ("read.alice", "conf.alice", CAM, "site.unknown"):
            assert not passes(stranger, "ingress", message, KEYS.introduce("home"))
        # A hub that this site has connected to answers before it is known.
        assert passes("site.unknown", "ingress", message, KEYS.introduce("unknown"), at_uplinks=True)
    assert not passes("site.unknown", "ingress", "put", KEYS.changed("unknown"), at_uplinks=True)


def test_a_hub_passes_everything_on_to_another_site_of_its_host() -> None:
    """That is connected to no other hub; sites of other hosts are, and hear from each what is said there."""
    known = [(Principal(PrincipalKind.SITE, name),) for name in ("home", "attic", "cellar")]
    made = rules_of("lab", "home", [], {"attic": {IRI("urn:bell")}}, known, beside=["cellar"])
    told = {access.principal: access.told or access.hears for access in made.accesses}
    third = KEYS.advertisement("attic", IRI("urn:bell"))

    def hears(site: str) -> bool:
        return any(zenoh.KeyExpr(key).includes(zenoh.KeyExpr(third)) for key in told[site])

    assert (hears("site.cellar"), hears("site.attic")) == (True, False)


def test_the_rules_do_not_depend_on_an_order() -> None:
    one = rules_of("lab", "home", [(Principal.component(CAMERA),), (Principal.component(DRIVE),)], {}, [])
    other = rules_of("lab", "home", [(Principal.component(DRIVE),), (Principal.component(CAMERA),)], {}, [])
    assert one == other
