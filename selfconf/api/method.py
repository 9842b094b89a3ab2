"""How a task is composed, as its user says: by which strategy and reasoning, and how long the search may take."""

from __future__ import annotations

from pathlib import Path

from selfconf.api.arguments import Paths, checked_choice, checked_seconds_limit, checked_steps, listed_paths
from selfconf.api.document_texts import DocumentText
from selfconf.api.ontologies import hierarchy_of, ontology_texts
from selfconf.api.task import TaskSpecification
from selfconf.composition import Composer, Strategy, TimeLimit
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.immutable import immutable

EXPLAINING = 2.0
"""For how many seconds at most a refusal is explained to a task that waits, which may soon come to another one."""


@immutable
class Method:
    """How a task is composed: the strategy, what the roles see, and how long the search may take."""

    strategy: Strategy = Strategy.FIRST
    reasoning: Reasoning = Reasoning.SYNTACTIC
    ontologies: tuple[DocumentText, ...] = ()
    """What is in the ontologies: the files may change or go, and standard input can be read once."""
    steps: int | None = None
    seconds: float | None = None

    @classmethod
    def of(
        cls,
        strategy: str = "first",
        reasoning: str = "syntactic",
        ontologies: Paths = (),
        steps: int | None = None,
        seconds: float | None = None,
    ) -> Method:
        """A method by the words of the command line. Raises ProgrammerError for what is none.

        The limits, if there are any, are numbers above zero. Raises AuthorError for ontologies that are not there.
        """
        chosen, mode = checked_choice(Strategy, "strategy", strategy), checked_choice(Reasoning, "reasoning", reasoning)
        limits = checked_steps(steps), checked_seconds_limit(seconds)
        return cls(chosen, mode, ontology_texts(map(Path, listed_paths(ontologies))), *limits)

    def composer(self, task: TaskSpecification) -> Composer:
        """The composer of a task, which has to be complete."""
        hierarchy = hierarchy_of(self.reasoning, self.ontologies)
        return Composer(task.document, hierarchy, self.strategy, self.steps)

    def explaining(self) -> TimeLimit:
        """The time in which a refusal is explained to a task that waits."""
        return TimeLimit(min(EXPLAINING, self.seconds or EXPLAINING))

    def wider(self) -> Hierarchy | None:
        """The hierarchy of the mode `subclass`, for explanations, where the method sees none; else None."""
        return hierarchy_of(Reasoning.SUBCLASS, self.ontologies) if self.reasoning is Reasoning.SYNTACTIC else None
