"""Who holds a component, in words."""

from __future__ import annotations

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.term import IRI


def test_a_holder_is_known_by_the_name_of_its_task() -> None:
    holder = Holder("patrol~c1f0", 2, 10.0, "c1f0")
    assert holder.name == "patrol"
    assert str(holder) == "the task patrol (priority 2, configurator c1f0) holds it"


def test_a_holder_disagrees_with_a_configuration_that_feeds_the_component_by_another() -> None:
    eye, mind = IRI("urn:test:eye"), IRI("urn:test:mind")
    roles = (Assignment(IRI("urn:test:role"), (eye, mind)),)
    fed = Configuration(IRI("urn:test:t"), roles, (Connection(eye, "out", mind, "in"),))
    holder = Holder("patrol~c1f0", wants=fed.wants(mind))
    assert not holder.disagrees(mind, fed)
    assert holder.disagrees(mind, Configuration(fed.template, roles))
    assert holder.disagrees(eye, fed)
