"""The configurator as a program around the machine: it runs effects on a bus and feeds it with events.

A `RunRequest` says which task to run, and how; a `TaskRunner` runs it. Inside, `calls` makes the calls to components,
`liveness` decides when a component is believed to be dead, and `record` answers questions about what is deployed.
"""

from selfconf.deployment.run_request import RunRequest
from selfconf.deployment.runner import TaskRunner

__all__ = ["RunRequest", "TaskRunner"]
