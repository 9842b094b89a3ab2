"""What sites tell of who may do what: sorted by site, with what was refused, and nothing of what is no answer."""

from __future__ import annotations

from selfconf.api.living.site_access import site_accesses
from selfconf.bus.port import Replies, Sample
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys, component_chunk
from selfconf.protocol.messages import Access, RefusedAttempt

KEYS = Keys("lab")
READER = Access("read.alice", "may discover, query and watch")
ATTEMPT = RefusedAttempt("comp.x", "Put", "selfconf/lab/c/x/fail", 3, 1795377051.2)


def test_what_sites_tell_is_sorted_and_what_is_no_answer_is_named() -> None:
    said = [("hall", encode(READER)), ("attic", encode(READER)), ("hall", encode(ATTEMPT)), ("attic", b"{}")]
    replies = Replies(tuple(Sample(KEYS.access(site), payload, b"") for site, payload in said))
    lamp = IRI("urn:c:lamp")
    found, complaints = site_accesses(replies, [lamp])
    assert [(one.site, one.accesses, one.refused) for one in found] == [
        ("attic", (READER,), ()),
        ("hall", (READER,), (ATTEMPT,)),
    ]
    assert found[0].components == {component_chunk(lamp): lamp}
    assert len(complaints) == 1
