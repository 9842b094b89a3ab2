"""Which roles of a task one component could play, and what keeps it out of those that it nearly fits.

`python -m selfconf.api.tasks.role_fits` judges it in a process of its own, which can be ended: a template that a
stranger has written may ask what takes forever. It reads a JSON object with the texts `record` (a message of the kind
`task`) and `advertisement` (Turtle) from stdin, and writes a list of `RoleFit.body`, or an object with the `detail` of
a failure.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from selfconf.api.tasks.detached import recorded_task
from selfconf.api.tasks.judging import answer_question
from selfconf.composition import ranked_exclusions
from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.rdf.eligibility import near_misses_by_type


class RoleFit(NamedTuple):
    """What one role says of one component."""

    role: IRI
    obstacles: tuple[str, ...]
    """What keeps the component out, each as a predicate of it; nothing if it is eligible."""
    near: bool
    """Whether it is of the class that the role asks for, or of one that is related to it or has such a name."""

    def body(self) -> dict[str, object]:
        """The verdict as JSON."""
        return {"role": self.role, "eligible": not self.obstacles, "near": self.near, "obstacles": list(self.obstacles)}


def role_fits(record: TaskRecord, advertisement: Advertisement) -> list[RoleFit]:
    """What each role of a task says of a component, in the order of the roles. Raises SelfconfError."""
    _, method, composer = recorded_task(record)
    known = method.wider() or composer.hierarchy
    alone = {advertisement.profile.component: advertisement}  # no role sees more than the advertisement of a candidate
    found = []
    for number, role in enumerate(composer.partitioner.roles):
        excluded = ranked_exclusions(composer, alone, number, known)
        slips = near_misses_by_type(role, composer.partitioner, composer.gathered(alone), known)
        related = [miss.obstacle for miss in slips]
        obstacles = related or [obstacle for one in excluded for obstacle in one.obstacles]
        near = bool(related) or all(one.akin for one in excluded)
        found.append(RoleFit(role.iri, tuple(map(str, obstacles)), near))
    return found


def _answer(question: Mapping[str, Any]) -> list[dict[str, object]]:
    """The verdicts that a question asks for, in its form as JSON. Raises SelfconfError."""
    good, bad = read_advertisements(question["advertisement"].encode(), "")
    if not good:
        raise PeerError(f"no advertisement: {bad}")
    return [fit.body() for fit in role_fits(decode(question["record"].encode(), TaskRecord), good[0])]


if __name__ == "__main__":
    answer_question(_answer)
