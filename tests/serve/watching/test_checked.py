"""What strangers tell is of the expected form when it goes on to the page."""

from __future__ import annotations

import json
import math
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from selfconf.render.run_events import event_body
from selfconf.serve.watching.checked import checked_configuration, checked_event, checked_refusal
from tests.lab import Lab

MEMBERS = ["roles", "recruits", "bindings", "role", "components", "connections", "from", "to", "reasons", "message"]
ANYTHING = st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(MEMBERS),
            inner,
            max_size=4,
        )
    ),
    max_leaves=12,
)


@given(st.sampled_from(["running", "waiting", "lost", "odd"]), ANYTHING, ANYTHING)
def test_whatever_is_told_has_the_form_that_the_page_expects(act: str, time: object, told: object) -> None:
    event = checked_event({"act": act, "time": time, "configuration": told, "refusal": told, "component": told})
    assert isinstance(event["time"], int | float)
    assert isinstance(event.get("component", ""), str)
    json.loads(json.dumps(event, allow_nan=False))
    for role in (event.get("configuration") or {}).get("roles", ()):
        assert all(isinstance(one, str) for one in (role["role"], *role["components"]))
    assert all(isinstance(one, str) for one in (event.get("configuration") or {}).get("recruits", ()))
    assert all(isinstance(one, str) for one in (event.get("configuration") or {}).get("bindings", {}).values())
    for reason in (event.get("refusal") or {}).get("reasons", ()):
        assert isinstance(reason["message"], str)


def test_what_a_configurator_tells_goes_on_as_it_is(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    lab.running(lab.agent())
    (running,) = (event_body(event) for event in lab.acts("running"))
    body = checked_configuration(running["configuration"])
    assert body is not None
    assert body["roles"] == running["configuration"]["roles"]
    assert checked_configuration({"roles": ["odd", *body["roles"]], "bindings": {"odd": None}}) == {
        **{member: [] for member in body},
        "template": "",
        "roles": body["roles"],
        "bindings": {},
    }
    assert body["bindings"] == running["configuration"]["bindings"]
    assert body["connections"] == running["configuration"]["connections"]


def test_what_is_no_object_is_none() -> None:
    assert checked_refusal([]) is checked_configuration("x") is None


def test_the_epoch_of_a_configuration_goes_on_to_the_page() -> None:
    epoch = 1_795_487_845_161
    assert checked_event({"act": "running", "time": 1.0, "epoch": epoch})["epoch"] == epoch
    for epoch in (1e300, 10**400, math.inf, math.nan):
        assert checked_event({"act": "running", "time": 1.0, "epoch": epoch})["epoch"] == 0.0
