"""`pytest -n` on Linux: workers that are forked once the tests are collected.

A worker of pytest-xdist collects all tests itself, which takes the processor time of a thousand
tests. A forked worker has the collected tests already.

Each worker runs the groups of tests that it is given, one after the other, and sends their reports.
Warnings are not sent, as pytest is told to make errors of them.
"""

from __future__ import annotations

import atexit
import os
import signal
import traceback
import warnings
from collections import defaultdict, deque
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe, wait
from typing import TYPE_CHECKING, Any, Final, NoReturn, cast

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["ForkedWorkers"]

Group = list[int]
"""The indices of tests that one worker runs, in this order."""


@dataclass
class Worker:
    """What the first process knows about a worker."""

    pid: int
    number: int
    group: Group
    """The tests that it has not finished yet; it runs the first of them."""


class ForkedWorkers:
    """The plugin of the process that collects the tests.

    Args:
        count: How many workers there are at a time.
        splits_files: Whether the tests of one file may run in several workers.
    """

    def __init__(self, count: int, *, splits_files: bool) -> None:
        self._count: Final = count
        self._splits_files: Final = splits_files
        self._waiting: Final = deque[Group]()
        self._workers: Final[dict[Connection, Worker]] = {}

    @pytest.hookimpl
    def pytest_runtestloop(self, session: pytest.Session) -> bool | None:
        """Run the tests, if pytest itself would."""
        if session.testsfailed or session.config.option.collectonly:
            return None
        self._waiting.extend(self._groups(session.items))
        cast("Any", session.config)._tmp_path_factory.getbasetemp()  # the same for all workers
        try:
            while self._waiting or self._workers:
                while self._waiting and len(self._workers) < self._count:
                    self._fork(session)
                for connection in cast("list[Connection]", wait(list(self._workers))):
                    self._receive(session, connection)
                if session.shouldfail:
                    raise session.Failed(session.shouldfail)
                if session.shouldstop:
                    raise session.Interrupted(session.shouldstop)
        finally:
            for worker in self._workers.values():
                os.kill(worker.pid, signal.SIGTERM)
        return True

    def _groups(self, items: list[pytest.Item]) -> Iterable[Group]:
        """Return the tests of each file or `xdist_group`; or each test, if files may be split."""
        groups = defaultdict[object, Group](list)
        for index, item in enumerate(items):
            mark = item.get_closest_marker("xdist_group")
            together = mark.args[0] if mark else item.path
            groups[index if self._splits_files else together].append(index)
        return groups.values()

    def _fork(self, session: pytest.Session) -> None:
        """Start a worker, and give it the next group."""
        number = min(set(range(self._count)) - {each.number for each in self._workers.values()})
        ours, theirs = Pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the threads of OpenBLAS and jemalloc know about forks
            pid = os.fork()
        if pid == 0:
            for connection in (ours, *self._workers):
                connection.close()
            work(session, theirs, number, self._count)
        theirs.close()
        self._workers[ours] = Worker(pid, number, [])
        self._assign(ours)

    def _assign(self, connection: Connection) -> None:
        """Give a worker the next group, or let it end if there is none."""
        if self._waiting:
            self._workers[connection].group = self._waiting.popleft()
            connection.send(self._workers[connection].group)
        else:
            connection.send(None)
            self._end(connection)

    def _end(self, connection: Connection) -> int:
        """Forget a worker that ends, and return its exit code."""
        worker = self._workers.pop(connection)
        connection.close()
        return os.waitstatus_to_exitcode(os.waitpid(worker.pid, 0)[1])

    def _receive(self, session: pytest.Session, connection: Connection) -> None:
        """Handle what a worker has sent, or its end."""
        worker = self._workers[connection]
        hook = session.config.hook
        try:
            message = connection.recv()
        except EOFError:
            crash = crashed(session.items[worker.group.pop(0)], self._end(connection))
            hook.pytest_runtest_logreport(report=crash)
            if worker.group:
                self._waiting.appendleft(worker.group)
            return
        if message is None:  # a test is over
            del worker.group[0]
            if not worker.group:
                self._assign(connection)
            return
        report = hook.pytest_report_from_serializable(config=session.config, data=message)
        hook.pytest_runtest_logreport(report=report)


def crashed(item: pytest.Item, code: int) -> pytest.TestReport:
    """Return the report of a test during which its worker ended, with this exit code."""
    how = f"by {signal.Signals(-code).name}" if code < 0 else f"with status {code}"
    return pytest.TestReport(
        item.nodeid,
        item.location,
        keywords={},
        outcome="failed",
        longrepr=f"the worker that ran {item.nodeid} was ended {how}",
        when="call",
    )


class Reporter:
    """The plugin of a worker, which sends the reports of its tests."""

    def __init__(self, config: pytest.Config, connection: Connection) -> None:
        self._config: Final = config
        self._connection: Final = connection

    @pytest.hookimpl
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Send a report."""
        hook = self._config.hook
        self._connection.send(
            hook.pytest_report_to_serializable(config=self._config, report=report)
        )


def work(session: pytest.Session, connection: Connection, number: int, count: int) -> NoReturn:
    """Be a worker: run groups of tests until there are no more."""
    # As pytest-xdist names its workers
    os.environ["PYTEST_XDIST_WORKER"] = f"gw{number}"
    os.environ["PYTEST_XDIST_WORKER_COUNT"] = str(count)
    plugins = session.config.pluginmanager
    plugins.unregister(name="terminalreporter")
    plugins.register(Reporter(session.config, connection))
    capturing = cast("Any", plugins.get_plugin("capturemanager"))
    atexit._clear()  # of the first process
    status = 1
    try:
        capturing.stop_global_capturing()  # into files that it shares with all workers
        capturing.start_global_capturing()
        while (group := connection.recv()) is not None:
            items = [session.items[index] for index in group]
            for item, following in zip(items, [*items[1:], None], strict=True):
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
                connection.send(None)
        atexit._run_exitfuncs()
        status = 0
    except BaseException:  # noqa: BLE001  # nothing may continue in the code of the first process
        capturing.stop_global_capturing()
        traceback.print_exc()
    finally:
        os._exit(status)
