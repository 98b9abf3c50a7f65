"""The main program: signals, exit status, and what a failure prints."""

from __future__ import annotations

import asyncio
import gc
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import aionode
from aionode import runner
from aionode._process import imports
from aionode._process.concurrency import checkpoint
from aionode.errors import AionodeError, ConfigurationError
from aionode.node import Node
from aionode.runner import best_loop_factory, failure_text
from aionode.testing import local_context
from tests.support import fork_server
from tests.support.program import PREAMBLE, Program


def test_a_bug_in_a_callback_is_shown_once_with_its_traceback() -> None:
    """The exit status reports it to the shell; `run` prints it, so the log needs no line."""
    body = """
    def make():
        node = aionode.Node("node", context=context, callback_budget_ms=60_000)
        node.create_timer(0.0, lambda: 1 / 0)
        return node

    aionode.run(make, args=[])
    """
    with Program(body) as program:
        status, _, err = program.end()
    assert status == 1
    assert err.count("ZeroDivisionError") == 1
    assert "Traceback" in err
    assert "callback_runner.py" not in err  # aionode's own lines
    assert "AIONODE_TRACEBACK=1 shows aionode's lines as well" in err


def test_an_error_of_aionode_is_one_line() -> None:
    """A wrong name needs no traceback."""
    body = 'aionode.run(lambda: aionode.Node("1node", context=context), args=[])'
    with Program(body) as program:
        status, _, err = program.end()
    assert status == 1
    assert err.startswith("error: ")
    assert "Traceback" not in err


SPEAKER = """
class Speaker(aionode.Node):
    def __init__(self):
        super().__init__("speaker", namespace="/robot", context=context)
        self.publisher = self.create_publisher(String, "words", 10)
        self.create_timer(0.0, self.speak)

    def speak(self):
        {line}

aionode.run(Speaker, args=[])
"""


@pytest.mark.processes
@pytest.mark.parametrize(
    ("line", "texts"),
    [
        (
            "self.publisher.publish(String(data=5))",
            ["error: std_msgs/msg/String.data: 5", "published by publisher of /robot/words\n"],
        ),
        ("self.get_parameter('speed')", ["undeclared parameter(s): speed"]),
        ("self.create_publisher(String, '1', 10)", ["error: Invalid topic name"]),
    ],
)
def test_an_error_of_aionode_in_a_callback_says_where(
    tmp_path: Path, line: str, texts: list[str]
) -> None:
    """The log names the line of user code; the traceback alone is too long to see it."""
    program = tmp_path / "speaker.py"
    program.write_text(PREAMBLE + SPEAKER.replace("{line}", line))
    at = program.read_text().splitlines().index(f"        {line}") + 1

    def run(environment: dict[str, str]) -> str:
        done = fork_server.run([str(program)], env={**os.environ, **environment}, timeout=20)
        assert done.returncode == 1
        return done.stderr

    err = run({})
    for text in texts:
        assert text in err
    assert "in timer of 0 s (callback Speaker.speak) of node /robot/speaker\n" in err
    assert f'File "{program}", line {at}, in speak: {line}\n' in err
    assert "Traceback" not in err
    assert "Traceback (most recent call last)" in run({"AIONODE_TRACEBACK": "1"})


def test_an_error_in_a_constructor_names_node_and_line() -> None:
    """There is no callback, but the node already has its name."""
    body = """
    class Robot(aionode.Node):
        def __init__(self):
            super().__init__("robot", context=context)
            self.get_parameter("speed")

    aionode.run(Robot, args=[])
    """
    with Program(body) as program:
        status, _, err = program.end()
    assert status == 1
    assert "in node /robot\n" in err
    assert ", in __init__" in err


def test_arguments_that_come_too_late_for_a_node_are_refused() -> None:
    """They would be ignored; the text says what works instead."""
    body = """
    class Robot(aionode.Node):
        def __init__(self):
            super().__init__("robot", context=context)

    aionode.run(Robot(), args=["--ros-args", "-r", "__node:=r2"])
    """
    with Program(body) as program:
        status, _, err = program.end()
    assert status == 1
    assert "'-r __node:=r2': too late for node /robot" in err
    assert "aionode.run(Robot)" in err


def test_arguments_that_no_node_needs_are_fine_for_a_node_made_before() -> None:
    """A log level applies to the process."""
    node = Node("robot", context=local_context())
    node.create_timer(0.0, node.destroy_node)
    arguments = ["--ros-args", "--log-level", "info"]
    aionode.run(node, args=arguments, loop_factory=asyncio.new_event_loop)


def test_arguments_hold_for_nodes_of_every_context_while_run_runs() -> None:
    """They hold in other contexts than the default one, and not after the run."""
    context = local_context()
    names: list[str] = []

    def make() -> Node:
        node = Node("robot", context=context)
        names.append(node.get_name())
        node.create_timer(0.0, node.destroy_node)
        return node

    arguments = ["--ros-args", "-r", "__node:=r2"]
    aionode.run(make, args=arguments, loop_factory=asyncio.new_event_loop)

    assert names == ["r2"]
    assert Node("robot", context=context).get_name() == "robot"


def run_in_this_process(*nodes: Any) -> None:
    """Run without reading the arguments of pytest."""
    aionode.run(*nodes, args=[], loop_factory=asyncio.new_event_loop)


def test_run_returns_when_all_nodes_have_ended() -> None:
    """A program may end by itself."""
    context = local_context()
    ended: list[str] = []

    def ending(name: str) -> Node:
        node = Node(name, context=context)

        def end() -> None:
            ended.append(name)
            node.destroy_node()

        node.create_timer(0.0, end)
        return node

    run_in_this_process(ending("one"), lambda: ending("two"))
    assert sorted(ended) == ["one", "two"]


def test_run_takes_coroutine_functions() -> None:
    """An application beside its nodes, or alone."""
    ran: list[bool] = []

    async def main() -> None:
        ran.append(True)

    run_in_this_process(main)
    assert ran == [True]


@pytest.fixture
def nothing_is_frozen(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Count what tests/conftest.py has frozen as what Python itself freezes at a start.

    To look for garbage in half a million objects would take a second.
    """
    monkeypatch.setattr("aionode._process.imports.FROZEN_BY_PYTHON", gc.get_freeze_count() + 100)
    yield
    gc.freeze()


@pytest.mark.usefixtures("nothing_is_frozen")
@pytest.mark.parametrize("is_frozen_before", [pytest.param(False, marks=pytest.mark.slow), True])
def test_the_search_for_garbage_leaves_out_what_a_running_program_keeps(
    monkeypatch: pytest.MonkeyPatch, *, is_frozen_before: bool
) -> None:
    """A full collection takes 30 ms; a program that freezes by itself is left alone."""
    monkeypatch.setattr("aionode.runner.STARTED_SEC", 0.0)
    counts = []

    async def main() -> None:
        while not is_frozen():
            await checkpoint()
        await checkpoint()
        counts.append(gc.get_freeze_count())

    kept: list[list[int]] = [[] for _ in range(1000)]
    if is_frozen_before:
        gc.freeze()
    before = is_frozen()
    try:
        run_in_this_process(main)
        after = is_frozen()
    finally:
        gc.unfreeze()

    assert counts[0] > imports.FROZEN_BY_PYTHON + len(kept) // 2
    assert before is after is is_frozen_before


@pytest.mark.usefixtures("nothing_is_frozen")
@pytest.mark.parametrize("when", ["first", pytest.param("afterwards", marks=pytest.mark.slow)])
def test_what_the_program_freezes_while_it_runs_stays_frozen(
    monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    """The process may go on after `run`, and the program has its reasons."""
    monkeypatch.setattr("aionode.runner.STARTED_SEC", 0.0)

    async def main() -> None:
        if when == "first":
            gc.freeze()
        while not is_frozen():
            await checkpoint()
        for _ in range(3):
            await checkpoint()
        kept.extend([] for _ in range(5000))
        gc.freeze()

    kept: list[list[int]] = []
    try:
        run_in_this_process(main)
        assert is_frozen()
    finally:
        gc.unfreeze()


def is_frozen() -> bool:
    """Whether more is frozen than Python 3.12 freezes itself."""
    return gc.get_freeze_count() > imports.FROZEN_BY_PYTHON


@pytest.mark.usefixtures("nothing_is_frozen")
async def test_frozen_objects_are_left_out_of_collections() -> None:
    """A full collection looks at all others, and the loop stands still meanwhile."""
    kept: list[list[int]] = [[] for _ in range(1000)]
    before = gc.get_freeze_count()
    try:
        runner.freeze_objects()
        assert gc.get_freeze_count() >= before + len(kept)
        assert not any(each is kept for each in gc.get_objects())
    finally:
        gc.unfreeze()


def test_a_program_without_garbage_collector_is_not_collected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The program has disabled it for a reason."""
    monkeypatch.setattr("aionode.runner.STARTED_SEC", 0.0)
    monkeypatch.setattr("aionode.runner.freeze_objects", pytest.fail)

    async def main() -> None:
        for _ in range(3):
            await checkpoint()

    gc.disable()
    try:
        run_in_this_process(main)
    finally:
        gc.enable()


def test_a_failing_node_ends_the_others() -> None:
    """With the status 1."""
    context = local_context()
    other = Node("other", context=context)
    failing = Node("failing", context=context)
    failing.create_timer(0.0, lambda: 1 / 0)
    with pytest.raises(SystemExit) as caught:
        run_in_this_process(other, failing)
    assert caught.value.code == 1
    assert other.destroyed


def test_a_failure_without_stderr_is_the_status(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python has none if its descriptor was closed at the start, as some daemons do."""
    failing = Node("failing", context=local_context())
    failing.create_timer(0.0, lambda: 1 / 0)
    monkeypatch.setattr(sys, "stderr", None)
    with pytest.raises(SystemExit) as caught:
        run_in_this_process(failing)
    assert caught.value.code == 1


def test_run_works_outside_the_main_thread() -> None:
    """Signals do not arrive there, so no handlers are installed."""
    ran: list[bool] = []

    async def main() -> None:
        ran.append(True)

    thread = threading.Thread(target=run_in_this_process, args=(main,))
    thread.start()
    thread.join()
    assert ran == [True]


def test_running_nothing_is_a_mistake() -> None:
    """It would end at once, without a reason."""
    with pytest.raises(TypeError, match="at least one node"):
        aionode.run()


def test_a_coroutine_in_place_of_its_function_is_a_mistake() -> None:
    """`asyncio.run` takes one, so it is often tried; Python's own error says nothing of that."""

    async def main() -> None:
        raise NotImplementedError

    with pytest.raises(
        TypeError, match=r"main\(\) was called; pass the function itself: run\(main"
    ):
        aionode.run(main())  # type: ignore[arg-type]  # the mistake


def test_a_factory_that_makes_something_else_is_a_mistake(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The error names what was created."""
    with pytest.raises(SystemExit):
        run_in_this_process(lambda: "node")
    assert "neither a node nor a coroutine" in capsys.readouterr().err


def test_failures_in_groups_are_told_one_by_one() -> None:
    """One line each for errors of aionode."""
    group = ExceptionGroup("g", [AionodeError("one"), ExceptionGroup("h", [AionodeError("two")])])
    assert failure_text(group) == "error: one\nerror: two\n"


async def test_inside_a_running_loop_it_says_what_to_use_instead() -> None:
    """A running loop needs no second one, which asyncio's own text does not say."""
    with pytest.raises(RuntimeError, match=r"await node\.run\(\)"):
        aionode.run(lambda: Node("never_made"))


def test_the_environment_names_the_event_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """One member of a system can have another one than the others, without a change of its code."""
    made: Any = "made by uvloop"
    for module, wanted, factory in [
        ("here", "", made),
        ("here", "asyncio", None),
        ("here", "uvloop", made),
        (None, "", None),
    ]:
        uvloop = module and SimpleNamespace(new_event_loop=made)
        monkeypatch.setitem(sys.modules, "uvloop", uvloop)
        monkeypatch.setenv("AIONODE_LOOP", wanted)
        assert best_loop_factory() == factory

    monkeypatch.setenv("AIONODE_LOOP", "uvloop")
    with pytest.raises(ConfigurationError, match=r"not installed: pip install 'aionode\[fast\]'"):
        best_loop_factory()
    monkeypatch.setenv("AIONODE_LOOP", "trio")
    with pytest.raises(ConfigurationError, match="'trio' given; use asyncio or uvloop"):
        best_loop_factory()
