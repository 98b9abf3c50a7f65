"""Commands whose output is not read or cannot be written, and exits that are blocked."""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
import termios
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from aionode.cli import main
from tests.support import fork_server
from tests.support.peers import isolated_environment

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="pipes whose size can be set")

AIONODE = [sys.executable, "-m", "aionode"]
ROOT = Path(__file__).parents[2]
PIPE_BYTES = 4096
ENDS_S = 30.0
"""Generous for a busy machine; without the fixes these commands never ended."""

CHATTERBOX = """
from aionode import Node

class Chatterbox(Node):
    def __init__(self):
        super().__init__("chatterbox")
        self.create_timer(0.001, lambda: self.get_logger().info("and another thing " * 5))
"""


@pytest.fixture(scope="module")
def env() -> dict[str, str]:
    """An environment isolated from all other processes on the machine."""
    return {**os.environ, **isolated_environment()}


@contextmanager
def unread() -> Iterator[int]:
    """Yield the write end of a small pipe without a reader."""
    reading, writing = os.pipe()
    fcntl.fcntl(writing, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    try:
        yield writing
    finally:
        os.close(reading)
        os.close(writing)


def wait_until_full(pipe: int) -> None:
    """Return when a pipe is almost full."""
    waiting = threading.Event()
    held = 0
    while held < PIPE_BYTES - 200:
        waiting.wait(0.01)
        held = int.from_bytes(fcntl.ioctl(pipe, termios.FIONREAD, bytes(4)), sys.byteorder)
    waiting.wait(0.1)  # for the write that does not fit


PUB = ["topic", "pub", "-r", "1000", "/out", "std_msgs/msg/String"]
RUN = ["run", "chatterbox.py:Chatterbox"]


@pytest.mark.parametrize(
    ("number", "stream", "arguments"),
    [
        (signal.SIGINT, "stdout", PUB),
        (signal.SIGTERM, "stdout", [*PUB, "--json"]),
        (signal.SIGTERM, "stderr", RUN),
        pytest.param(signal.SIGTERM, "stdout", PUB, marks=pytest.mark.stress),
        pytest.param(signal.SIGINT, "stdout", [*PUB, "--json"], marks=pytest.mark.stress),
        pytest.param(signal.SIGINT, "stderr", RUN, marks=pytest.mark.stress),
    ],
)
def test_a_signal_ends_a_command_whose_output_is_not_read(
    number: signal.Signals,
    stream: str,
    arguments: list[str],
    env: dict[str, str],
    tmp_path: Path,
) -> None:
    """The write that waits for a reader would otherwise block the loop, and with it the exit."""
    (tmp_path / "chatterbox.py").write_text(CHATTERBOX)
    with (
        unread() as pipe,
        fork_server.start(
            ["-m", "aionode", *arguments],
            env=env | {"PYTHONPATH": str(ROOT)},
            cwd=tmp_path,
            stdin=subprocess.DEVNULL,
            stdout=pipe if stream == "stdout" else subprocess.DEVNULL,
            stderr=pipe if stream == "stderr" else subprocess.PIPE,
        ) as child,
    ):
        try:
            wait_until_full(pipe)
            child.send_signal(number)
            child.wait(ENDS_S)
        finally:
            child.kill()
        errors = child.stderr.read() if child.stderr is not None else ""

    assert (child.returncode, errors) == (0, "")


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["interface", "list"], ["topic", "list", "-c"], ["completion", "bash"]],
)
def test_a_full_disk_is_one_line(arguments: list[str], env: dict[str, str]) -> None:
    """Instead of 45 lines of traceback, and with a status that says that output is missing."""
    with Path("/dev/full").open("w") as full:
        done = fork_server.run(["-m", "aionode", *arguments], env=env, stdout=full, timeout=50)

    assert done.stderr == (
        "cannot write to stdout: No space left on device; the output is incomplete\n"
    )
    assert done.returncode == 1


@pytest.mark.parametrize(
    ("shell", "status", "printed"),
    [
        (">&-", 0, ""),
        (">&- 2>&-", 0, ""),
        ("<&- >&- 2>&-", 0, ""),
        ("2>&-", 0, "0\n"),
        ("2>/dev/full", 0, "0\n"),
    ],
)
def test_streams_that_are_not_there_are_no_error(
    shell: str, status: int, printed: str, env: dict[str, str]
) -> None:
    """A service manager may start a command with its standard streams closed."""
    done = subprocess.run(
        ["bash", "-c", f"'{sys.executable}' -m aionode topic list -c {shell}"],
        env=env,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert (done.returncode, done.stdout, done.stderr) == (status, printed, "")


@pytest.mark.parametrize("shell", ["2>&-", "2>/dev/full", ">&- 2>/dev/full"])
def test_an_error_that_cannot_be_printed_is_a_status(shell: str, env: dict[str, str]) -> None:
    """The exit status is the only place left for it."""
    done = subprocess.run(
        ["bash", "-c", f"'{sys.executable}' -m aionode topic info /nope {shell}"],
        env=env,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")


def test_what_a_stream_cannot_encode_is_escaped(env: dict[str, str]) -> None:
    """An ASCII stream must not end the command."""
    done = subprocess.run(
        [*AIONODE, "topic", "pub", "-1", "-w", "0", "/a", "std_msgs/msg/String", "data: \u00e9"],
        env=env | {"PYTHONIOENCODING": "ascii"},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert "publishing #1: std_msgs.msg.String(data='\\xe9')" in done.stdout
    assert (done.returncode, done.stderr) == (0, "")


THREADED = """
import threading
from aionode import Node

class Threaded(Node):
    def __init__(self):
        super().__init__("threaded", callback_budget_ms=1e6)  # on a busy machine it is exceeded
        self.create_timer(0.01, self.destroy_node)
        threading.Thread(target=self.finish).start()

    def finish(self):
        threading.Event().wait(0.5)
        print("finished")
"""


def test_threads_of_a_node_that_was_run_are_waited_for(env: dict[str, str], tmp_path: Path) -> None:
    """They belong to the user, as in any Python program."""
    (tmp_path / "threaded.py").write_text(THREADED)

    done = fork_server.run(
        ["-m", "aionode", "run", "threaded.py:Threaded"],
        env=env | {"PYTHONPATH": str(ROOT)},
        cwd=tmp_path,
        timeout=50,
    )

    assert (done.returncode, done.stdout, done.stderr) == (0, "finished\n", "")


HANGING_LOOP = """
import threading
from aionode.engine.transport.zenoh._session_state import Declaration
Declaration.undeclare = lambda _: threading.Event().wait()
"""
HANGING_THREAD = """
import threading
from aionode.engine.transport.zenoh import _transport as transport
async def close_session(session):
    threading.Thread(target=threading.Event().wait).start()
transport.close_session = close_session
"""
HANGING_EXIT = """
import atexit, threading
atexit.register(threading.Event().wait)
"""


@pytest.mark.parametrize("hanging", [HANGING_LOOP, HANGING_THREAD, HANGING_EXIT])
@pytest.mark.parametrize(
    ("arguments", "status", "stdout", "stderr"),
    [
        ("'topic', 'list', '-c'", 0, "0\n", ""),
        (
            "'param', 'get', '/nope', 'name', '--timeout', '0.01'",
            1,
            "",
            "Node not found: '/nope'. `aionode node list` lists those available\n",
        ),
    ],
)
def test_a_command_that_has_answered_ends(
    hanging: str, arguments: str, status: int, stdout: str, stderr: str, env: dict[str, str]
) -> None:
    """Closing waits for Zenoh, which may wait for a peer that is frozen or overloaded."""
    program = f"{hanging}\nimport sys\nfrom aionode.cli import main\n"
    program += "from aionode.cli._support import session; session.CLOSE_S = 0.1\n"
    program += f"sys.argv = ['aionode', {arguments}]\nsys.exit(main())"

    done = fork_server.run(["-c", program], env=env, timeout=ENDS_S)

    assert (done.returncode, done.stdout, done.stderr) == (status, stdout, stderr)


GUEST = """
import asyncio, sys
from pathlib import Path
from aionode.cli import main
from aionode.cli._support import session
from aionode.engine.transport.zenoh import _transport as transport

session.CLOSE_S = 0.01
close = transport.close_session
async def close_session(session):
    await asyncio.sleep(0.3)
    await close(session)
transport.close_session = close_session

statuses = [main(["topic", "list", "-c"])]
Path("program.py").write_text("import rclpy; raise SystemExit(3)")
statuses.append(main(["run", "program.py"]))
print("still here", statuses)
"""


def test_a_program_that_runs_a_command_keeps_its_process(
    env: dict[str, str], tmp_path: Path
) -> None:
    """Neither a close that exceeds its deadline ends it, nor does another program replace it.

    A library is a guest in its process: only a process started by the shell may end this way.
    """
    done = fork_server.run(
        ["-c", GUEST], env=env | {"PYTHONPATH": str(ROOT)}, cwd=tmp_path, timeout=ENDS_S
    )

    assert (done.returncode, done.stdout, done.stderr) == (0, "0\nstill here [0, 3]\n", "")


def test_a_command_leaves_the_environment_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program may open contexts of its own afterwards."""
    monkeypatch.delenv("AIONODE_TRANSPORT", raising=False)

    assert main(["--transport", "rcl", "completion", "bash"]) == 0

    assert "AIONODE_TRANSPORT" not in os.environ


INSIDE_START = """
import threading
from aionode.cli._support.deadline import Deadline

with threading._active_limbo_lock:
    Deadline(armed=True).set(0.01, 7)
    threading.Event().wait(30)
"""


def test_a_signal_that_interrupts_the_start_of_a_thread_sets_a_deadline(
    env: dict[str, str], tmp_path: Path
) -> None:
    """The handler runs while the interrupted thread holds the lock needed to start threads."""
    done = fork_server.run(
        ["-c", INSIDE_START], env=env | {"PYTHONPATH": str(ROOT)}, cwd=tmp_path, timeout=ENDS_S
    )

    assert done.returncode == 7


CANCELLED = """
import threading
from aionode.cli._support.deadline import Deadline

deadline = Deadline(armed=True)
deadline.set(0.2, 7)
deadline.set(0.1, 8)
deadline.cancel()
threading.Event().wait(0.5)
"""


def test_a_deadline_that_is_cancelled_ends_nothing(env: dict[str, str], tmp_path: Path) -> None:
    """A command that ends in time leaves its process to others, as to a test that runs several."""
    done = fork_server.run(
        ["-c", CANCELLED], env=env | {"PYTHONPATH": str(ROOT)}, cwd=tmp_path, timeout=ENDS_S
    )

    assert done.returncode == 0
