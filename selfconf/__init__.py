"""selfconf: components of a robot ecology that connect themselves.

    import selfconf as sc

    home = sc.read("examples/peis-home")
    task = sc.template("examples/navigate.ttl").bind(robot=":Astrid", goal="(AT BEDROOM)")
    answer = sc.configure(task, home)
    if answer:                                  # a Configuration is true, a Refusal is false
        print(answer["position"], answer.connections)
    else:
        print(answer.reasons, answer.near_misses, answer.repairs)

`read` reads an ecology, `template` a task, `configure` answers it, `partition` shows what is eligible, `validate`
checks files, `join` joins the living ecology, and `sites` lists those of this machine. An `Ecology` is what is read, a
`TaskSpecification` a template with its bindings; the answer is a `Configuration`, a `Refusal` or `Undecided`, of terms
that are an `IRI` or a `Literal`. A `LivingEcology` is what was joined, a `Run` a task that runs in it. What goes wrong
is a `SelfconfError`, of a kind in `selfconf.errors`. `selfconf.values` has the types of what they answer with, as
`PartitionTable` and the events of a run. A component is written with `selfconf.sdk` and tried without a network by
`selfconf.testing`.
"""

from selfconf.late_names import TYPE_CHECKING, late_names

if TYPE_CHECKING:
    from selfconf.api.configuring import configure
    from selfconf.api.ecology import Ecology
    from selfconf.api.living.living_ecology import LivingEcology, join
    from selfconf.api.partition_table import partition
    from selfconf.api.reading import read
    from selfconf.api.sites.local_site import sites
    from selfconf.api.task import TaskSpecification, template
    from selfconf.api.tasks.run import Run
    from selfconf.api.validation import validate
    from selfconf.errors import SelfconfError
    from selfconf.model.configuration import Configuration
    from selfconf.model.refusal import Refusal, Undecided
    from selfconf.model.term import IRI, Literal

__all__ = [
    "IRI",
    "Configuration",
    "Ecology",
    "Literal",
    "LivingEcology",
    "Refusal",
    "Run",
    "SelfconfError",
    "TaskSpecification",
    "Undecided",
    "configure",
    "join",
    "partition",
    "read",
    "sites",
    "template",
    "validate",
]

_HOME = {
    "configure": "api.configuring",
    "Ecology": "api.ecology",
    "LivingEcology": "api.living.living_ecology",
    "join": "api.living.living_ecology",
    "sites": "api.sites.local_site",
    "partition": "api.partition_table",
    "read": "api.reading",
    "Run": "api.tasks.run",
    "TaskSpecification": "api.task",
    "template": "api.task",
    "validate": "api.validation",
    "SelfconfError": "errors",
    "Configuration": "model.configuration",
    "Refusal": "model.refusal",
    "Undecided": "model.refusal",
    "IRI": "model.term",
    "Literal": "model.term",
}
"""Where each name is defined. It is loaded when it is first used, so that a program pays for what it needs alone."""

__getattr__ = late_names(__name__, _HOME)


def __dir__() -> list[str]:
    return sorted((*__all__, *(name for name in globals() if name.startswith("__"))))
