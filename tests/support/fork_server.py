"""Python programs whose processes a fork server makes, with aionode already imported.

Starting Python with aionode and Zenoh takes 0.3 s of processor time, and tests do so hundreds of
times. A process of the fork server differs from `python program.py` in the modules already
imported, in the command line and environment that the system shows, and in its end: exit handlers
run and output is flushed, but the interpreter is not finalized. Tests about these start Python
themselves (`fresh`).
"""

from __future__ import annotations

import atexit
import ctypes
import fcntl
import functools
import gc
import importlib
import json
import os
import pkgutil
import runpy
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, Final

__all__ = ["run", "start"]

ROOT: Final = Path(__file__).parent.parent.parent
REQUEST_BYTES: Final = 1 << 17
MAX_STREAMS: Final = 8
FIRST_FREE: Final = 256
"""Descriptors from here on are used by nobody else."""
PR_SET_CHILD_SUBREAPER: Final = 36

PRELOADED: Final = (
    "asyncio",
    "concurrent.futures.thread",
    "encodings.ascii",
    "resource",
    "termios",
    "aionode",
    "aionode.action",
    "aionode.rclpy",
    "aionode.runner",
    "aionode.node",
    "aionode.interfaces.action_msgs.msg",
    "aionode.interfaces.action_msgs.srv",
    "aionode.interfaces.action_tutorials_interfaces.action",
    "aionode.interfaces.example_interfaces.action",
    "aionode.interfaces.example_interfaces.srv",
    "aionode.interfaces.geometry_msgs.msg",
    "aionode.interfaces.std_msgs.msg",
    "aionode.interfaces.std_srvs.srv",
    "numpy",
    "uvloop",
    "zenoh",
)
"""What most programs of the tests import, beside `PRELOADED_PACKAGES`."""

PRELOADED_PACKAGES: Final = (
    "aionode.cli",
    "aionode.clock",
    "aionode.endpoints",
    "aionode.lifecycle",
    "aionode.logging",
    "aionode.parameter",
    "aionode.testing",
    "aionode.transport.link",
    "aionode.transport.zenoh",
    "aionode.wire",
)
"""Packages of which each module is imported: programs import parts of them when they run."""

OF_RCLPY: Final[dict[str, ModuleType]] = {}
"""The modules that programs of rclpy import, which others must not find."""


def start(
    arguments: list[str], *, env: Mapping[str, str], fresh: bool = False, **options: Any
) -> subprocess.Popen[str]:
    """Start a Python program, by a fork server if that has the same effect.

    Args:
        arguments: What follows `python` on the command line.
        env: Its environment, to which `PYTHONUNBUFFERED` is added.
        fresh: Whether to start Python itself, for tests about its start or its finalization.
        options: Options of `subprocess.Popen`. Each of the standard streams has to be given.
    """
    whole = {**env, "PYTHONUNBUFFERED": "1"}
    is_forked = not fresh and can_fork(arguments, whole)
    kind = ForkedProgram if is_forked else subprocess.Popen
    return kind([sys.executable, *arguments], env=whole, text=True, **options)


def run(
    arguments: list[str], *, env: Mapping[str, str], timeout: float, **options: Any
) -> subprocess.CompletedProcess[str]:
    """Run a program as `start` starts it, without input, and return what it wrote.

    Raises:
        subprocess.TimeoutExpired: it ran for longer than `timeout` seconds; it is killed then.
    """
    streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with start(arguments, env=env, **streams | options) as process:
        try:
            out, errors = process.communicate(timeout=timeout)
        except BaseException:
            process.kill()
            raise
    return subprocess.CompletedProcess(arguments, process.returncode, out, errors)


def can_fork(arguments: list[str], env: Mapping[str, str]) -> bool:
    """Return whether a fork server would start a program with the same effect.

    It would not if lines of child processes are counted, an environment variable changes how Python
    starts, or the program would inherit an ignored signal.
    """
    inherited = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)
    settings = {name for name in env if name.startswith("PYTHON")}
    return (
        sys.platform == "linux"
        and settings <= {"PYTHONPATH", "PYTHONUNBUFFERED", "PYTHONPYCACHEPREFIX"}
        and not any(signal.getsignal(number) is signal.SIG_IGN for number in inherited)
        and not any(name.startswith(("COV_CORE", "COVERAGE_")) for name in env)
        and (arguments[0].endswith(".py") or arguments[0] in {"-c", "-m"})
    )


class ForkedProgram(subprocess.Popen[str]):
    """A Python program, as if started by `subprocess.Popen`.

    Its standard streams must not be those of the test.
    """

    def _execute_child(  # as Popen calls it
        self,
        args: list[str],
        executable: str | None,
        preexec_fn: None,
        close_fds: bool,
        pass_fds: tuple[int, ...],
        cwd: str | None,
        env: dict[str, str],
        startupinfo: None,
        creationflags: int,
        shell: bool,
        *descriptors: Any,
    ) -> None:
        p2cread, p2cwrite, c2pread, c2pwrite, errread, errwrite, *_, process_group = descriptors
        program = {
            "arguments": args[1:],
            "cwd": os.fspath(cwd or Path.cwd()),
            "env": env,
            "numbers": [0, 1, 2, *pass_fds],
            "process_group": process_group,
        }
        self.pid = server().start(program, [p2cread, c2pwrite, errwrite, *pass_fds])
        self._child_created = True
        self._close_pipe_fds(p2cread, p2cwrite, c2pread, c2pwrite, errread, errwrite)  # type: ignore[attr-defined]  # of Popen


class Server:
    """The fork server of this process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._connection, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 2 * REQUEST_BYTES)
        environment = {name: text for name, text in os.environ.items() if name[:6] != "PYTHON"}
        with other:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tests.support.fork_server", str(other.fileno())],
                pass_fds=[other.fileno()],
                stdin=subprocess.PIPE,  # cannot seek, as those of the programs
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                process_group=0,
                cwd=ROOT,
                env=environment | kept() | {"OPENBLAS_NUM_THREADS": "1"},
            )
        atexit.register(self.close)

    def start(self, program: dict[str, Any], streams: list[int]) -> int:
        """Start a program with these descriptors as its streams; return its process id.

        It is a child of this process, which has to wait for it.
        """
        with self._lock:
            set_subreaper(is_one=True)
            try:
                socket.send_fds(self._connection, [json.dumps(program).encode()], streams)
                return int(self._connection.recv(64))
            except (OSError, ValueError) as error:
                raise RuntimeError(self._process.communicate()[0].decode()) from error
            finally:
                set_subreaper(is_one=False)

    def close(self) -> None:
        """End it."""
        self._connection.close()
        self._process.communicate()


@functools.cache
def server() -> Server:
    """Return the fork server of this process, which starts with the first program."""
    return Server()


def kept() -> dict[str, str]:
    """Return the Python settings that the server shares with all its programs."""
    prefix = os.environ.get("PYTHONPYCACHEPREFIX")
    cache = {"PYTHONPYCACHEPREFIX": prefix} if prefix else {}
    return {"PYTHONUNBUFFERED": "1", **cache}


def set_subreaper(*, is_one: bool) -> None:
    """Set whether this process adopts descendants whose own parent has ended."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, int(is_one), 0, 0, 0)


# In the fork server


def preload() -> None:
    """Import what programs use; none of it may start a thread, which a fork would lose."""
    gc.disable()
    for name in PRELOADED:
        importlib.import_module(name)
    for name in PRELOADED_PACKAGES:
        import_all(name)
    importlib.import_module("aionode.rclpy").install()
    finder = importlib.import_module("aionode.rclpy._finder")
    import_all("rclpy._impl")
    sys.meta_path.remove(finder.FINDER)
    for name in [name for name in sys.modules if name.partition(".")[0] in finder.SUPPLIED]:
        OF_RCLPY[name] = sys.modules.pop(name)
    gc.collect()
    gc.freeze()  # a program that looks for garbage there would copy all of the server's memory
    threads = len(list(Path("/proc/self/task").iterdir()))
    assert threads == 1, f"{threads} threads: a forked program would have one of them"


def import_all(name: str) -> None:
    """Import a package and each of its modules."""
    package = importlib.import_module(name)
    for module in pkgutil.walk_packages(getattr(package, "__path__", ()), f"{name}."):
        importlib.import_module(module.name)


def serve(connection: socket.socket) -> dict[str, Any] | None:
    """Fork for each request, and return the request in the child; None at the end."""
    while True:
        data, streams, _, _ = socket.recv_fds(connection, REQUEST_BYTES, MAX_STREAMS)
        if not data:
            return None
        # The process between ends at once, so that the program becomes a child of the test.
        may_begin, begin = os.pipe()
        told_pid, tell_pid = os.pipe()
        between = os.fork()
        if between == 0:
            pid = os.fork()
            if pid == 0:
                os.close(begin)
                os.read(may_begin, 1)  # ends when the server has closed its end
                program: dict[str, Any] = json.loads(data)
                become(program, streams)
                return program
            os.write(tell_pid, b"%d" % pid)
            os._exit(0)
        os.waitpid(between, 0)
        answer = os.read(told_pid, 64)
        for descriptor in (may_begin, begin, told_pid, tell_pid, *streams):
            os.close(descriptor)
        connection.send(answer)


def become(program: dict[str, Any], streams: list[int]) -> None:
    """Put this process into the state of Python before the first line of a program."""
    if program["process_group"] >= 0:
        os.setpgid(0, program["process_group"])
    kept = [fcntl.fcntl(stream, fcntl.F_DUPFD, FIRST_FREE) for stream in streams]
    os.closerange(3, FIRST_FREE)
    for number, stream in zip(program["numbers"], kept, strict=True):
        os.dup2(stream, number)
        os.close(stream)
    os.environ.clear()
    os.environ.update(program["env"])
    os.chdir(program["cwd"])
    sys.path[1:1] = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    gc.enable()


def run_here(arguments: list[str]) -> None:
    """Run a program like `python` with these arguments."""
    first, *rest = arguments
    if first == "-m":
        sys.argv[:] = rest
        sys.path[0] = str(Path.cwd())
        if rest[0] == "aionode.rclpy":
            sys.modules.update(OF_RCLPY)
        runpy.run_module(rest[0], run_name="__main__", alter_sys=True)
        return
    main = ModuleType("__main__")
    if first == "-c":
        text, name, sys.argv[:] = rest[0], "<string>", ["-c", *rest[1:]]
        sys.path[0] = ""
    else:
        text, name, sys.argv[:] = Path(first).read_text(), first, arguments
        sys.path[0] = str(Path(first).parent.resolve())
        main.__file__ = first
    sys.modules["__main__"] = main
    exec(compile(text, name, "exec"), main.__dict__)  # noqa: S102  # the tests' own programs


def end_here(status: int) -> None:
    """End this process as Python does, but without tearing down the modules.

    Tearing them down is half of a short program's processor time: the system copies each page of
    the fork server's memory in which a reference count changes. If there are threads to wait for,
    or output that nobody reads, the function returns, and Python ends the program itself.
    """
    if any(not thread.daemon for thread in threading.enumerate()[1:]):
        return
    atexit._run_exitfuncs()
    if (main := vars(sys.modules["__main__"])) is not globals():
        main.clear()
    gc.collect()  # a finalizer may say something
    try:
        for stream in filter(None, (sys.stdout, sys.stderr)):
            stream.flush()
    except (OSError, ValueError):
        return
    os._exit(status & 0xFF)


def run_to_the_end(arguments: list[str]) -> None:
    """Run a program, and end this process with its status."""
    status = 0
    try:
        run_here(arguments)
    except SystemExit as end:
        if not isinstance(end.code, int | None):
            raise
        status = end.code or 0
    end_here(status)
    sys.exit(status)


if __name__ == "__main__":
    preload()
    requests = socket.socket(fileno=int(sys.argv[1]))
    work = serve(requests)
    requests.detach()  # closed already, in a program
    if work is not None:
        run_to_the_end(work["arguments"])
