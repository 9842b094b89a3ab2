"""The configurator as a program around the machine: it runs effects on a bus and feeds it with events.

A `RunRequest` says which task to run, by which `ComposeFunction` and how, and what is `Outside` of it if it is the
inside of a composite; a `TaskRunner` runs it, as a `TaskIdentity` by which others know it; what takes long is done
`Aside`, by default `at_once`. Inside, `components` is a room that deals with the components of the ecology, and
`record` answers questions about what is deployed. A `Keeper` runs the tasks that live in the sites, which keep their
records in a `TaskFolder`. `ask_holders` asks all configurators which components they hold, `holders_in` reads their
answers. Each is loaded when it is first used: a site without tasks, and a command that only looks on, start sooner.
"""

from typing import TYPE_CHECKING

from selfconf.late_names import late_names

if TYPE_CHECKING:
    from selfconf.deployment.holders import ask_holders, holders_in
    from selfconf.deployment.keeper import Keeper
    from selfconf.deployment.run_request import Aside, ComposeFunction, Outside, RunRequest, TaskIdentity, at_once
    from selfconf.deployment.runner import TaskRunner
    from selfconf.deployment.task_folder import TaskFolder

__all__ = [
    "Aside",
    "ComposeFunction",
    "Keeper",
    "Outside",
    "RunRequest",
    "TaskFolder",
    "TaskIdentity",
    "TaskRunner",
    "ask_holders",
    "at_once",
    "holders_in",
]

_HOME = {
    "Aside": "run_request",
    "ComposeFunction": "run_request",
    "Keeper": "keeper",
    "Outside": "run_request",
    "RunRequest": "run_request",
    "TaskFolder": "task_folder",
    "TaskIdentity": "run_request",
    "TaskRunner": "runner",
    "ask_holders": "holders",
    "at_once": "run_request",
    "holders_in": "holders",
}
"""Where each name is defined. It is loaded when it is first used."""

__getattr__ = late_names(__name__, _HOME)
