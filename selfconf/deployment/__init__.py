"""The configurator as a program around the machine: it runs effects on a bus and feeds it with events.

A `RunRequest` says which task to run, and how, and what is `Outside` of it if it is the inside of a composite; a
`TaskRunner` runs it. Inside, `calls` makes the calls to components,
`liveness` decides when a component is believed to be dead, and `record` answers questions about what is deployed.
A `Keeper` runs the tasks that live in the sites, which keep their records in a `TaskFolder`.
"""

from selfconf.deployment.holders import holders_in
from selfconf.deployment.identity import TaskIdentity
from selfconf.deployment.keeper import Keeper
from selfconf.deployment.run_request import Outside, RunRequest
from selfconf.deployment.runner import TaskRunner
from selfconf.deployment.task_folder import TaskFolder

__all__ = ["Keeper", "Outside", "RunRequest", "TaskFolder", "TaskIdentity", "TaskRunner", "holders_in"]
