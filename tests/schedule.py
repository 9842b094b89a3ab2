"""Which tests run in one process where pytest-xdist spreads them over several.

The mark `xdist_group` cannot say it: pytest-xdist 3.8 adds the group to a node's name by an attribute that pytest 9.2
no longer reads. So the scheduler is told the group of a test by its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

INHABITED = {
    "tests/cli/test_discover.py",
    "tests/cli/test_echo.py",
    "tests/cli/test_query.py",
    "tests/cli/test_run.py",
    "tests/cli/test_run_trouble.py",
    "tests/cli/test_site.py",
    "tests/cli/test_status.py",
    "tests/cli/test_stop.py",
    "tests/cli/test_top.py",
}
"""Modules with tests that use the fixture `inhabited`, which starts a site and seven components: once is enough."""
WHOLE = {
    "tests/api/test_ecology.py",
    "tests/api/test_living.py",
    "tests/api/test_run.py",
    "tests/api/test_typed_programs.py",
    "tests/cli/test_untrusted.py",
    "tests/query/test_endpoint.py",
    "tests/serve/test_page.py",
    "tests/serve/test_w3c_protocol.py",
    "tests/sim/test_pictures.py",
    "tests/sim/test_rehearsal.py",
    "tests/test_ci_for_users.py",
    "tests/test_house.py",
    "tests/test_notebook.py",
}
"""Modules whose tests share something that takes seconds to make: an ecology, an endpoint, an album, a type check."""
BAD_FILES = ("test_a_bad_file_", "test_the_log_of_every_bad_file_", "test_every_constraint_is_broken_by_a_bad_file")
"""How the names of tests begin that share the reports about all files of `tests/bad`."""
RECORDED = "tests/recorded/test_recorded.py"
"""A module whose tests share the answers to a group of cases, which is their parameter."""


def group_of(test: str) -> str:
    """Return the name of a test's group; a test that may run in any process is a group by itself."""
    module, _, name = test.partition("::")
    if module in INHABITED:
        return "inhabited"
    if module in WHOLE:
        return module
    if name.startswith(BAD_FILES):
        return "bad files"
    if module == RECORDED and "_as_recorded[" in name:
        return module + name.partition("[")[2]
    return test


def scheduler(config: Any, log: Any) -> Any:
    """Make a scheduler of pytest-xdist that keeps each group in one process, and all processors busy.

    The tests come as `tests/conftest.py` has put them: those that wait for programs first, those that compute for long
    last. One process in three takes them from the end and the others from the beginning, so that some compute while
    others wait; they meet among the short ones, and all end together.
    """
    from xdist.scheduler import LoadScopeScheduling

    class Grouped(LoadScopeScheduling):
        places: Mapping[str, int] = {}
        """Where each test stands in the order of all, which every process has."""

        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

        def _assign_work_unit(self, node: Any) -> None:
            from_the_end = self.nodes.index(node) % 3 == 2
            group, tests = self.workqueue.popitem(last=from_the_end)
            self.assigned_work[node][group] = tests
            if not self.places:
                self.places = {test: place for place, test in enumerate(self.registered_collections[node])}
            node.send_runtest_some([self.places[test] for test, done in tests.items() if not done])

        def mark_test_complete(self, node: Any, item_index: int, duration: float = 0) -> None:
            """Note that a test is over, and forget its group with the last: what is assigned is counted each time."""
            test = self.registered_collections[node][item_index]
            tests = self.assigned_work[node][group_of(test)]
            tests[test] = True
            if all(tests.values()):
                del self.assigned_work[node][group_of(test)]
            self._reschedule(node)

        def remove_node(self, node: Any) -> str | None:
            """Return the test in which a process has died, which is not run again; others take over what is left."""
            groups = self.assigned_work.pop(node)
            left = [test for tests in groups.values() for test, done in tests.items() if not done]
            if not left:
                return None
            for group, tests in groups.items():
                if left[0] in tests:
                    tests[left[0]] = True
                if not all(tests.values()):
                    self.workqueue[group] = tests
            for other in self.assigned_work:
                self._reschedule(other)
            return left[0]

        def _reschedule(self, node: Any) -> None:
            if node not in self.registered_collections:
                return  # it takes the place of one that has died, and does not know the tests yet
            super()._reschedule(node)
            if not self.workqueue and not node.shutting_down:
                node.shutdown()  # else it keeps its last test for a further one to come after, which never does

    return Grouped(config, log)
