"""Arc consistency removes each class once, with its cause."""

from __future__ import annotations

from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.template import Interaction, Role, Task, Template
from selfconf.search.budget import Budget
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import pruned
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import numbers
from tests.search.worlds import component, iri


def test_a_class_that_fails_on_two_variables_is_removed_once() -> None:
    template = Template(
        iri("template"), (Role(iri("camera")), Role(iri("tracker"))), (Interaction(iri("camera"), iri("tracker")),)
    )
    odd, even = component("odd", outputs="p:Picture"), component("even", outputs="p:Picture")
    variables = tuple(Variable(iri(name), (iri("one"), iri("two"))) for name in ("robot", "room"))
    partition = Partition(
        ((Candidate(odd, (2, 2)), Candidate(even, (1, 1))), (Candidate(component("eye", "p:Picture"), (1, 1)),)),
        variables,
    )
    given_ = pruned(reduced(Problem(Task(template), partition)))
    assert numbers(first_solution(given_, Budget())) == [1, 0]
    assert len(given_.removals) == 1


def test_a_class_removed_for_want_of_a_need_is_not_removed_again_for_a_value() -> None:
    template = Template(iri("template"), tuple(Role(iri(name)) for name in "abcd"), (Interaction(iri("b"), iri("a")),))
    partition = Partition(
        (
            (Candidate(component("a1", "i:S"), (1, ANY_VALUE)), Candidate(component("a2"), (ANY_VALUE, ANY_VALUE))),
            (Candidate(component("b1", outputs="o:S"), (ANY_VALUE, 1)), Candidate(component("b2"), (ANY_VALUE,) * 2)),
            (Candidate(component("c1"), (3, 1)), Candidate(component("c2"), (2, ANY_VALUE))),
            (Candidate(component("d1"), (ANY_VALUE, 2)),),
        ),
        tuple(Variable(iri(name), (iri("one"), iri("two"))) for name in ("robot", "room")),
    )
    removals = pruned(reduced(Problem(Task(template), partition))).removals
    assert [(removal.kind.role, removal.kind.number) for removal in removals] == [(1, 0), (2, 0), (0, 0)]
