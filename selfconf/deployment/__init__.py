"""The configurator as a program around the machine: it runs effects on a bus and feeds it what the bus says."""

from selfconf.deployment.request import RunRequest
from selfconf.deployment.runner import TaskRunner

__all__ = ["RunRequest", "TaskRunner"]
