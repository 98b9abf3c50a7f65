"""Shares of the test files: each worker of pytest-xdist collects its own, and not all files.

Collecting all files takes a worker a quarter of the time in which it runs its part of the tests. A
quarter of the files is in all shares, so that workers that are done earlier take those.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from execnet import XSpec
    from xdist.scheduler import Scheduling
    from xdist.workermanage import WorkerController

__all__ = ["Share", "Shares"]

COMMON = 4
"""One of as many files is in all shares."""


class Shares:
    """Gives each worker one file at a time of its share: a plugin of the process that starts them.

    It is the scheduler (`xdist.scheduler.Scheduling`), too.
    """

    def __init__(self) -> None:
        self._workers = 0
        self._started = 0
        self._total = 0
        # The tests of each file that no worker has been given; those in one share come first.
        self._left: dict[str, list[str]] = {}
        self._places: dict[WorkerController, dict[str, int]] = {}
        self._pending: dict[WorkerController, list[str]] = {}

    @pytest.hookimpl(tryfirst=True)  # before pytest-xdist starts the workers
    def pytest_sessionstart(self, session: pytest.Session) -> None:
        """Keep the session, which knows how many tests there are."""
        self._session = session

    def pytest_xdist_setupnodes(self, specs: Sequence[XSpec]) -> None:
        """Make a share for each worker."""
        self._workers = len(specs)

    def pytest_configure_node(self, node: WorkerController) -> None:
        """Tell a worker its share; one that replaces another has the same specification."""
        spec = node.gateway.spec
        if spec.share is None:
            spec.share = self._started
            self._started += 1
        node.workerinput["share"] = (spec.share, self._workers)

    def pytest_xdist_make_scheduler(self) -> Scheduling:
        """Distribute the files in the way of this class."""
        return self

    @property
    def nodes(self) -> list[WorkerController]:
        """The workers."""
        return list(self._pending)

    @property
    def collection_is_completed(self) -> bool:
        """Whether all workers have collected their share."""
        return len(self._places) >= self._workers

    @property
    def tests_finished(self) -> bool:
        """Whether the workers have been given all tests, and finished all but their last."""
        given = self.collection_is_completed and not self._left
        return given and all(len(tests) < 2 for tests in self._pending.values())

    @property
    def has_pending(self) -> bool:
        """Whether tests are left to run."""
        return bool(self._left) or any(self._pending.values())

    def add_node(self, node: WorkerController) -> None:
        """Add a worker that has started."""
        self._pending[node] = []

    def add_node_collection(self, node: WorkerController, collection: Sequence[str]) -> None:
        """Keep what a worker has collected."""
        self._places[node] = {test: place for place, test in enumerate(collection)}

    def schedule(self) -> None:
        """Give the workers their first files, after all have collected theirs."""
        if not self._total:
            shares = Counter(test for places in self._places.values() for test in places)
            self._total = len(shares)
            for test in sorted(shares, key=lambda test: shares[test] > 1):
                self._left.setdefault(file_of(test), []).append(test)
        self._session.testscollected = self._total
        for node in self.nodes:
            self._give(node)

    def _give(self, node: WorkerController) -> None:
        """Give a worker its next files; it knows one test more than the one that it runs."""
        places, pending = self._places[node], self._pending[node]
        while len(pending) <= 2 and not node.shutting_down:
            file = next((file for file, tests in self._left.items() if tests[0] in places), None)
            if file is None:
                node.shutdown()
                return
            tests = self._left.pop(file)
            pending += tests
            node.send_runtest_some([places[test] for test in tests])

    def mark_test_complete(
        self, node: WorkerController, item_index: int, duration: float = 0
    ) -> None:
        """Give a worker another file if this was one of its last tests."""
        del duration
        self._pending[node].pop(0)  # they run in this order
        self._give(node)

    def remove_node(self, node: WorkerController) -> str | None:
        """Remove a worker that has ended, and return the test at which it crashed."""
        pending = self._pending.pop(node)
        for test in pending[1:]:
            self._left.setdefault(file_of(test), []).append(test)
        return pending[0] if pending else None

    def mark_test_pending(self, item: str) -> None:
        """Run a test again, which this distribution does not."""
        raise NotImplementedError

    def remove_pending_tests_from_node(
        self, node: WorkerController, indices: Sequence[int]
    ) -> None:
        """Take tests back, which this distribution does not."""
        raise NotImplementedError


def file_of(test: str) -> str:
    """Return the file of a test."""
    return test.partition("::")[0]


class Share:
    """Leaves out the test files of other shares: a plugin of a worker.

    Args:
        number: The share of this worker.
        count: How many shares there are.
        kind: Tells kinds of files apart, of each of which every share has as many.
    """

    def __init__(self, number: int, count: int, kind: Callable[[str], object]) -> None:
        self._number = number
        self._count = count
        self._kind = kind
        self._files: Counter[object] = Counter()

    def has(self, nodeid: str) -> bool:
        """Return whether the next file, in the order in which all workers find them, is in it."""
        kind = self._kind(nodeid)
        common, place = divmod(self._files[kind], COMMON)
        self._files[kind] += 1
        if place == COMMON - 1:
            return True
        return (common * (COMMON - 1) + place) % self._count == self._number

    @pytest.hookimpl(wrapper=True)
    def pytest_collect_file(
        self,
    ) -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
        """Leave a file out before it is imported."""
        collectors = yield
        return [collector for collector in collectors if self.has(collector.nodeid)]
