"""Who holds a component, in words."""

from __future__ import annotations

from selfconf.model.holder import Holder


def test_a_holder_is_known_by_the_name_of_its_task() -> None:
    holder = Holder("patrol~c1f0", 2, 10.0, "c1f0")
    assert holder.name == "patrol"
    assert str(holder) == "the task patrol (priority 2, configurator c1f0) holds it"
