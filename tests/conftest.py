"""The surroundings of every test: debug mode, event loops, hypothesis, compiled code."""

from __future__ import annotations

import asyncio
import compileall
import functools
import gc
import inspect
import os
import signal
import sys
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import uvloop
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

import aionode
from aionode import rclpy
from aionode.node import Node
from tests.bytecode import share_bytecode
from tests.shares import Share, Shares
from tests.support.checking_loop import CheckingLoop

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Generator, Iterator

    from aionode.engine.context import Context

# Tests import rclpy, launch and others of ROS's packages; tests.support.without_ros undoes this.
rclpy.install()

# How long an example takes depends on what else runs, such as other workers.
settings.register_profile(
    "tests",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    print_blob=True,
    max_examples=10,
)
settings.load_profile("tests")
# `make stress` uses "thorough", with more examples of each property; `make fuzz`
# uses "fuzz". Tests with a number of examples of their own use a fraction of the profile's.
settings.register_profile("thorough", settings.get_profile("tests"), max_examples=100)
settings.register_profile("fuzz", settings.get_profile("tests"), max_examples=2000)

# Collection creates half a million objects that all stay: garbage collection would double its time.
gc.disable()

# The parent of the tests may ignore SIGHUP, as nohup does, and SIGINT, as a shell's background jobs
# do; every process that the tests start would too.
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

share_bytecode()

# A thread of OpenBLAS, in each process that imports NumPy, first spins for as long as a short test.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
assert "numpy" not in sys.modules, "it would have its threads already"

# Each HTTP client would load the certificates of the system, which takes it 30 ms; tests of TLS
# have certificates of their own.
os.environ.pop("SSL_CERT_FILE", None)
os.environ["SSL_CERT_DIR"] = os.devnull


PROCESSES = (
    "tests/end_to_end/",
    "tests/faults/",
    "tests/attacks/",
    "tests/gateway/test_foreign_page.py",
    "tests/gateway/test_page.py",
    "tests/system/",
    "tests/launch/test_running.py",
    "tests/cli/test_terminal.py",
    "tests/cli/test_ending.py",
    "tests/cli/test_shells.py",
    "tests/cli/test_complete_answers.py",
    "tests/cli/test_distribution.py",
    "tests/process/test_signals.py",
    "tests/rclpy/test_interruptions.py",
    "tests/rclpy/test_stopping.py",
    "tests/rclpy/test_terminals.py",
    "tests/rclpy/test_run.py",
    "tests/rclpy/test_distribution.py",
    "tests/test_examples.py",
    "tests/test_web_robot.py",
    "tests/typing/",
)
"""Files and folders whose tests start processes; they take long, so workers begin with some."""


def starts_processes(nodeid: str) -> bool:
    """Return whether a test or a file of tests is one of `PROCESSES`."""
    return nodeid.startswith(PROCESSES)


BOTH_LOOPS = (
    "tests/clock/",
    "tests/endpoints/core/",
    "tests/endpoints/timer/",
    "tests/node/test_embedding.py",
    "tests/node/test_end.py",
    "tests/node/test_threads.py",
    "tests/end_to_end/",
    "tests/process/test_concurrency.py",
    "tests/programs/test_serial.py",
    "tests/engine/test_context.py",
    "tests/test_runner.py",
    "tests/testing/",
    "tests/engine/transport/link/",
    "tests/engine/transport/rcl/",
    "tests/engine/transport/test_contract.py",
    "tests/engine/transport/test_loop_waker.py",
    "tests/engine/transport/test_send_thread.py",
    "tests/engine/transport/zenoh/test_services.py",
    "tests/engine/transport/zenoh/test_session.py",
    "tests/engine/transport/zenoh/test_sockets.py",
    "tests/engine/transport/zenoh/test_topics.py",
)
"""Files and folders whose tests always run on asyncio and on uvloop.

They test what differs between the two: alarms, sockets, threads, the order of callbacks, and the
start and end of a loop. Zenoh has threads of its own, which wake a loop in the same way for
everything that arrives. On uvloop, tests elsewhere have the mark `second_loop`.
"""

TRANSPORTS = (
    "tests/end_to_end/",
    "tests/engine/transport/link/",
    "tests/engine/transport/rcl/",
    "tests/engine/transport/test_contract.py",
    "tests/engine/transport/zenoh/test_services.py",
    "tests/engine/transport/zenoh/test_topics.py",
)
"""Those of `BOTH_LOOPS` that have the mark `slow` on uvloop: `make test` leaves these variants out.

What they need of a loop, such as being woken from threads, others of `BOTH_LOOPS` test directly.
"""


@pytest.hookimpl(tryfirst=True)  # before pytest-xdist reads its options
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Run each file in one worker, as its tests share what they start, and keep the order."""
    if not config.getoption("numprocesses", None):
        return
    if config.option.dist == "no":
        config.option.dist = "loadfile"
        config.option.loadscopereorder = False
        if config.args == config.getini("testpaths"):
            config.pluginmanager.register(Shares())
    # In a fresh clone or environment, each worker would compile the modules for itself.
    compileall.compile_dir(Path(aionode.__file__).parent, quiet=2)


def pytest_configure(config: pytest.Config) -> None:
    """Let only longer runs try the constants that occur in the code of all modules.

    Hypothesis reads more than a thousand files to find them, which takes each worker two seconds.
    """
    if not config.getoption("--hypothesis-profile") and hasattr(providers, "_get_local_constants"):
        providers._get_local_constants = lambda: providers._local_constants
    workerinput: dict[str, Any] = getattr(config, "workerinput", {})  # of pytest-xdist
    if "share" in workerinput:
        number, count = workerinput["share"]
        config.pluginmanager.register(Share(number, count, starts_processes))
    options = config.option
    if options.verbose < 0 and not options.durations and not options.xmlpath:
        for plugin in config.pluginmanager.get_plugins():
            if type(plugin).__name__ == "WorkerInteractor":  # of pytest-xdist
                plugin.sendevent = without_trifles(plugin.sendevent)


def without_trifles(send: Callable[..., None]) -> Callable[..., None]:
    """Return `send` of a worker, which leaves out what `pytest -q` shows nothing of.

    Each test sends its start, its end and three reports, which keep the process that counts them
    busy for a tenth of the time of all tests.
    """

    def send_what_counts(name: str, **event: Any) -> None:
        if name in {"logstart", "logfinish"}:
            return
        report = event.get("data", {}) if name == "testreport" else {}
        if report.get("outcome") == "passed" and report["when"] != "call":
            return
        send(name, **event)

    return send_what_counts


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist
def pytest_xdist_auto_num_workers() -> int:
    """Use two workers per processor and four more: half of a test's time is spent waiting.

    On two processors, eight are done some seconds before six are, and six before four.
    """
    return 2 * (os.cpu_count() or 1) + 4


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop() -> None:
    """Enable garbage collection again after collecting the tests, excluding what that created."""
    gc.freeze()
    gc.enable()


@pytest.hookimpl(trylast=True)  # after the fixtures of the file
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Exclude what a file of tests leaves, such as modules, from the collections of later ones."""
    if nextitem is None or nextitem.path != item.path:
        gc.collect()
        gc.freeze()


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish() -> None:
    """Collect garbage once: pytest does so ten times, with all objects of the collected tests."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)  # before tests are deselected by their marks
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Limit the time of async tests; mark those of processes, and those that one loop covers."""
    for item in items:
        if starts_processes(item.nodeid):
            item.add_marker("processes")
        if isinstance(item, pytest.Function) and inspect.iscoroutinefunction(item.obj):
            marker = item.get_closest_marker("timeout")
            item.obj = bounded(item.obj, marker.args[0] if marker and marker.args else 60.0)
            if "uvloop" in item.name:
                if item.get_closest_marker("one_loop"):
                    item.add_marker("stress")
                elif not item.nodeid.startswith(BOTH_LOOPS):
                    item.add_marker("second_loop")
                elif item.nodeid.startswith(TRANSPORTS):
                    item.add_marker("slow")
    if hasattr(config, "workerinput"):  # of pytest-xdist
        mix(items)


def mix(items: list[pytest.Item]) -> None:
    """Alternate between files whose tests mostly wait for processes, and others.

    With the former first, all workers would wait for a while, and later compete for the processors.
    """
    places: dict[Path, tuple[int, bool]] = {}
    counts = {True: 0, False: 0}
    for item in items:
        if item.path not in places:
            waits = starts_processes(item.nodeid)
            places[item.path] = (counts[waits], not waits)
            counts[waits] += 1
    items.sort(key=lambda item: places[item.path])


def bounded(test: Callable[..., Awaitable[None]], limit_s: float) -> Callable[..., Awaitable[None]]:
    """Return `test` with a time limit a little below that of pytest-timeout.

    uvloop swallows what pytest-timeout's signal raises.
    """

    @functools.wraps(test)
    async def run(*args: Any, **fixtures: Any) -> None:
        async with asyncio.timeout(limit_s * 0.9):
            await test(*args, **fixtures)

    return run


def pytest_asyncio_loop_factories(
    config: pytest.Config, item: pytest.Item
) -> dict[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Run each async test on asyncio and on uvloop, without creating tests that are deselected.

    With "not first_loop" among the selected marks, tests that do not depend on the loop run on
    uvloop; tests of processes are created for both loops, so that "second_loop" can select some.
    """
    factories: dict[str, Callable[[], asyncio.AbstractEventLoop]] = {
        "asyncio": CheckingLoop,
        "uvloop": uvloop.new_event_loop,
    }
    expression = config.option.markexpr
    if item.get_closest_marker("one_loop"):
        left_out = "uvloop" if "not stress" in expression else ""
    elif item.nodeid.startswith(TRANSPORTS) and "not slow" in expression:
        left_out = "uvloop"
    elif item.nodeid.startswith(BOTH_LOOPS):
        left_out = ""
    elif "not second_loop" in expression:
        left_out = "uvloop"
    elif starts_processes(item.nodeid) or item.get_closest_marker("processes"):
        left_out = ""
    else:
        left_out = "asyncio" if "not first_loop" in expression else ""
    return {name: factory for name, factory in factories.items() if name != left_out}


@pytest.fixture(autouse=True)
def own_imports() -> Iterator[None]:
    """Keep other tests from importing what `install` finds for this one, and from its workspace.

    A command that runs a program in this process gives it its folder and its arguments.
    """
    before, newest = list(sys.meta_path), next(reversed(sys.modules))
    path, arguments = list(sys.path), list(sys.argv)
    yield
    sys.meta_path[:], sys.path[:], sys.argv[:] = before, path, arguments
    if loaded := sys.modules.get("aionode._packages._here"):
        loaded.GIVEN.clear()
    if loaded := sys.modules.get("aionode.idl.named"):
        loaded.NAMED.__init__()
        loaded.SEEN.clear()
        for name in [*takewhile(newest.__ne__, reversed(sys.modules))]:  # all take 1.7 ms
            if isinstance(getattr(sys.modules[name], "__loader__", None), loaded.NamedLoader):
                del sys.modules[name]


@pytest.fixture
async def node(node_factory: Callable[..., Node]) -> Node:
    """A running node in a context without network."""
    return node_factory("node")


@pytest.fixture
async def context(aionode_context: Context) -> Context:
    """An open context without network."""
    return aionode_context


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Escape lone surrogates in captured output: pytest-xdist cannot send them.

    Meanwhile, the time limit of pytest-timeout is suspended: if it struck while a report is made,
    it would end all other tests as well.
    """
    left_s, _ = signal.setitimer(signal.ITIMER_REAL, 0)
    report = yield
    signal.setitimer(signal.ITIMER_REAL, left_s)
    report.sections = [
        (title, text.encode(errors="backslashreplace").decode()) for title, text in report.sections
    ]
    return report
