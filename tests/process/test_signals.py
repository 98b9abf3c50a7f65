"""Tests of signals that end a program: which count as one, and what a later one still sends."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import threading
import time  # noqa: TID251  # how long a process takes to end is what is tested
from pathlib import Path

import pytest

import aionode
from aionode._process.signals import woken_by_signals
from tests.support.program import Program

pty = pytest.importorskip("pty", reason="pseudo-terminals are of Unix")

SOON = "import aionode._process.signals; aionode._process.signals.SAME_SEC = 0.0"
"""A second signal is one at once, to keep tests short."""

WAITS_FOR_EVER = """
from aionode.endpoints.core import shutdown

shutdown.NOTICE_S = shutdown.CALLBACKS_S  # a busy machine makes the end long enough for a log line

async def callback(msg):
    try:
        print("ready", flush=True)
        await asyncio.Event().wait()
    finally:
        await asyncio.sleep(0.1)
        print("cancelled", flush=True)

def make():
    node = aionode.Node("node", context=context, callback_budget_ms=60_000)
    node.create_subscription(String, "words", callback)
    node.create_publisher(String, "words", 10).publish(String())
    return node

aionode.run(make, args=[])
print("after run", flush=True)
"""

STUBBORN = """
async def callback():
    try:
        print("ready", flush=True)
        await asyncio.Event().wait()
    except asyncio.CancelledError:
        print("no", flush=True)
        await asyncio.Event().wait()

def make():
    node = aionode.Node("node", context=context, callback_budget_ms=60_000)
    node.create_timer(0.0, callback)
    return node

aionode.run(make, args=[])
"""

BLOCKED = """
def callback():
    print("ready", flush=True)
    while True:
        {step}

def make():
    node = aionode.Node("node", context=context, callback_budget_ms=60_000)
    node.create_timer(0.0, callback)
    return node

aionode.run(make, args=[])
"""

SAYS_STOP = """
from aionode._process import sudden_end as _sudden_end
import os
_sudden_end.STOPS.append(lambda: os.write(telling, b"stop;"))
_sudden_end.SENDS.append(lambda ends_ns: os.write(telling, b"sent;"))
telling = {descriptor}
"""

SIGINT, SIGTERM, SIGHUP = signal.SIGINT, signal.SIGTERM, signal.SIGHUP


@pytest.mark.parametrize("number", [SIGINT, SIGTERM, SIGHUP])
def test_a_signal_ends_the_program_cleanly(number: signal.Signals) -> None:
    """Handlers are cancelled, no traceback is printed, and the status is 0."""
    with Program(WAITS_FOR_EVER, fresh=True) as program:
        program.wait_until_ready()
        program.send(number)
        status, out, err = program.end()
    assert (status, out, err) == (0, "cancelled\nafter run\n", "")


@pytest.mark.parametrize(
    ("numbers", "pause_sec"),
    [
        ((SIGINT, SIGINT), 0.002),
        ((SIGTERM, SIGTERM), 0.02),
        ((SIGINT, SIGTERM, SIGHUP), 0.02),
        ((SIGHUP, SIGTERM), 0.002),
    ],
)
def test_signals_within_a_second_are_one(
    numbers: tuple[signal.Signals, ...], pause_sec: float
) -> None:
    """Parents forward a signal that the process group has already received."""
    with Program(WAITS_FOR_EVER) as program:
        program.wait_until_ready()
        program.send(*numbers, pause_sec=pause_sec)
        status, out, err = program.end()
    assert (status, out, err) == (0, "cancelled\nafter run\n", "")


def test_a_parent_that_forwards_the_signal_of_its_group_ends_the_program_cleanly() -> None:
    """GNU timeout does this: Ctrl-C reaches its command twice."""
    before = ("timeout", "--foreground", "60")
    with Program(WAITS_FOR_EVER, before=before, start_new_session=True) as program:
        program.wait_until_ready()
        os.killpg(program.process.pid, SIGINT)
        _, out, err = program.end()
    assert (out, err) == ("cancelled\nafter run\n", "")


@pytest.mark.parametrize("number", [SIGINT, SIGTERM, SIGHUP])
def test_a_signal_after_the_first_second_ends_the_program_at_once(number: signal.Signals) -> None:
    """This holds even if a callback refuses to end."""
    with Program(STUBBORN) as program:
        program.wait_until_ready()
        assert program.process.stdout is not None
        program.send(SIGINT)
        assert program.process.stdout.readline() == "no\n"
        threading.Event().wait(1.1)
        began_s = time.monotonic()
        program.send(number)
        status, _, err = program.end()
        took_s = time.monotonic() - began_s
    assert status == 128 + number
    assert err.endswith(f"aionode: ended at once by a second signal ({number.name})\n")
    assert took_s < 30.0  # a callback that refuses to end would go on forever


@pytest.mark.parametrize("step", ["time.sleep(1)", "pass"])
def test_the_second_signal_works_while_a_callback_blocks_the_loop(step: str) -> None:
    """The handlers do not need the loop."""
    with Program(SOON, BLOCKED.replace("{step}", step)) as program:
        program.wait_until_ready()
        program.send(SIGINT, SIGTERM, pause_sec=0.1)
        status, _, err = program.end()
    assert status == 143
    assert err == "aionode: ended at once by a second signal (SIGTERM)\n"


@pytest.mark.parametrize("step", ["time.sleep(1)", "pass", "await_for_ever"])
def test_a_second_signal_sends_the_stops_of_leases_and_then_what_was_published(step: str) -> None:
    """A robot must not drive on if its program is ended at once, or if nobody reads its output."""
    reading, writing = os.pipe()
    body = STUBBORN if step == "await_for_ever" else BLOCKED.replace("{step}", step)
    told = SAYS_STOP.replace("{descriptor}", str(writing))
    with Program(SOON, told, body, pass_fds=(writing,)) as program:
        program.wait_until_ready()
        assert program.process.stdout is not None
        assert program.process.stderr is not None
        program.process.stdout.close()
        program.process.stderr.close()
        program.send(SIGINT, SIGINT, pause_sec=0.5)
        status = program.process.wait(20)
        program.process.stdout = program.process.stderr = None
    os.close(writing)
    with os.fdopen(reading) as stream:
        assert stream.read() == "stop;sent;"
    assert status == 130


def test_a_stop_that_fails_or_hangs_keeps_no_program_alive() -> None:
    """The others are sent, and the time is limited."""
    hooks = """
    from aionode._process import sudden_end as _sudden_end
    _sudden_end.STOPS.append(lambda: 1 / 0)
    _sudden_end.STOPS.append(lambda: print("stop", flush=True))
    _sudden_end.STOPS.append(lambda: time.sleep(60))
    """
    with Program(SOON, hooks, STUBBORN) as program:
        program.wait_until_ready()
        program.send(SIGINT, SIGINT, pause_sec=0.5)
        status, out, err = program.end()
    assert (status, out) == (130, "no\nstop\n")
    assert "ZeroDivisionError" in err
    assert err.endswith("aionode: ended at once by a second signal (SIGINT)\n")


def test_a_second_signal_within_a_transport_lets_it_finish_its_step() -> None:
    """Otherwise a frame that a socket took in part would be sent again from its beginning."""
    body = """
    import signal
    from aionode._process import sudden_end as _sudden_end
    steps = []
    _sudden_end.STOPS.append(lambda: print(steps[-1], flush=True))

    _sudden_end.mark_sending("made_up")
    names = {"__name__": "made_up.socket", "signal": signal, "steps": steps}
    exec('''
    def send():
        steps.append("sending")
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        steps.append("sent")
    ''', names)

    def callback():
        names["send"]()
        time.sleep(60)

    def make():
        node = aionode.Node("node", context=context, callback_budget_ms=60_000)
        node.create_timer(0.0, callback)
        return node

    aionode.run(make, args=[])
    """
    with Program(SOON, body) as program:
        status, out, _ = program.end()
    assert (status, out) == (130, "sent\n")


def test_the_second_signal_does_not_wait_for_a_reader_of_stderr() -> None:
    """A full pipe would block while the last line is written."""
    full = """
    def callback():
        try:
            while True:
                os.write(2, b"x" * 4096)
        except BlockingIOError:
            os.set_blocking(2, True)
        print("ready", flush=True)
        time.sleep(20)

    import os
    os.set_blocking(2, False)

    def make():
        node = aionode.Node("robot", context=context)
        node.create_timer(0.01, callback)
        return node

    aionode.run(make, args=[])
    """
    with Program(SOON, full) as program:
        program.wait_until_ready()
        program.send(SIGINT, SIGTERM, pause_sec=0.1)
        assert program.process.wait(20) == 143


def test_the_last_line_goes_into_no_file_of_the_program(tmp_path: Path) -> None:
    """Without stderr, its descriptor belongs to the first file that the program opens."""
    file = tmp_path / "file"
    opens = f"file = open({str(file)!r}, 'w'); assert file.fileno() == 2"
    without_stderr = ("sh", "-c", 'exec "$@" 2>&-', "sh")
    with Program(opens, SOON, STUBBORN, before=without_stderr) as program:
        program.wait_until_ready()
        program.send(SIGINT, SIGINT, pause_sec=0.5)
        status, _, _ = program.end()
    assert (status, file.read_text()) == (130, "")


THREAD_AT_WORK = """
import threading
done = threading.Event()

def work():
    print("ready", flush=True)
    done.wait(20)

def make():
    node = aionode.Node("robot", context=context)
    node.create_timer(0.01, work, offload=True)
    return node

aionode.run(make, args=[], loop_factory={loop})
print("after run", flush=True)
"""


@pytest.mark.parametrize("loop", ["asyncio.new_event_loop", "None"])
def test_ctrl_c_names_the_thread_that_it_waits_for_and_a_second_one_ends_at_once(
    loop: str,
) -> None:
    """A thread cannot be cancelled, so the user has to be told, and needs a way to end it."""
    with Program(SOON, THREAD_AT_WORK.replace("{loop}", loop)) as program:
        program.wait_until_ready()
        program.send(SIGINT)
        assert program.process.stderr is not None
        line = program.process.stderr.readline()
        program.send(SIGINT)
        status, out, err = program.end()
    assert "waits up to 5 s for timer of 0.01 s (callback work) in a thread" in line
    assert (status, out) == (130, "")
    assert err == "aionode: ended at once by a second signal (SIGINT)\n"


IN_ANOTHER_THREAD = """
import os, signal, threading, time
import aionode.runner

aionode.runner.STARTED_SEC = 3600.0  # nothing else wakes the loop

def send():
    while open(f"/proc/self/task/{os.getpid()}/stat").read().rsplit(")", 1)[1].split()[0] != "S":
        time.sleep(0.01)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)

async def main():
    asyncio.get_running_loop().call_soon(threading.Thread(target=send, daemon=True).start)
    try:
        await asyncio.Event().wait()
    finally:
        print("cancelled", flush=True)

aionode.run(main, args=[])
"""


@pytest.mark.parametrize("loop", ["asyncio", "uvloop"])
def test_a_signal_that_does_not_interrupt_the_main_thread_wakes_the_loop(loop: str) -> None:
    """One that comes just before the loop sleeps cannot be timed, so a thread gets it."""
    env = {**os.environ, "AIONODE_LOOP": loop}
    with Program(IN_ANOTHER_THREAD, env=env, fresh=True) as program:
        assert program.end() == (0, "cancelled\n", "")


def test_the_wakeup_descriptor_of_a_program_stays_its_own() -> None:
    """As other libraries install one; and there is none after the loop has ended."""

    async def main(loop_wakes: bool) -> None:
        with woken_by_signals(asyncio.get_running_loop()):
            found = signal.set_wakeup_fd(-1)
            signal.set_wakeup_fd(found, warn_on_full_buffer=False)
            assert (found == own.fileno()) is not loop_wakes

    own, other = socket.socketpair()
    with own, other:
        own.setblocking(False)
        asyncio.run(main(loop_wakes=True))
        assert signal.set_wakeup_fd(own.fileno()) == -1
        try:
            asyncio.run(main(loop_wakes=False))
        finally:
            assert signal.set_wakeup_fd(-1) == own.fileno()


POOL_THAT_IS_STOPPED = """
import multiprocessing, os, signal, threading
from concurrent.futures import ProcessPoolExecutor

threading._register_atexit(print, "exits", flush=True)  # after aionode's, and before the pool's

pool = ProcessPoolExecutor(1, multiprocessing.get_context("fork"))

async def main():
    worker = await asyncio.get_running_loop().run_in_executor(pool, os.getpid)
    os.kill(worker, signal.SIGSTOP)
    print("ready", worker, flush=True)
    await asyncio.Event().wait()

aionode.run(main, args=[])
print("after run", flush=True)
"""


def test_a_second_ctrl_c_ends_a_program_whose_process_pool_is_stopped() -> None:
    """After `run`, Python waits for the pool's worker without a limit, and a debugger holds it."""
    with Program(SOON, POOL_THAT_IS_STOPPED, fresh=True) as program:
        assert program.process.stdout is not None
        worker = int(program.process.stdout.readline().removeprefix("ready "))
        try:
            program.send(SIGINT)
            assert program.process.stdout.readline() == "after run\n"
            assert program.process.stdout.readline() == "exits\n"
            program.send(SIGINT)
            assert program.process.wait(20) == 130
        finally:
            os.kill(worker, signal.SIGKILL)


def test_a_program_that_ignores_sighup_goes_on_ignoring_it() -> None:
    """Under nohup it does, since it is meant to outlive the terminal."""
    with Program(WAITS_FOR_EVER, before=("nohup",)) as program:
        program.wait_until_ready()
        program.send(SIGHUP)
        with pytest.raises(subprocess.TimeoutExpired):
            program.process.wait(0.5)
        program.send(SIGTERM)
        status, out, _ = program.end()
    assert (status, out) == (0, "cancelled\nafter run\n")


def test_a_handler_of_the_program_for_sighup_is_left_alone() -> None:
    """Many programs reload their settings on SIGHUP."""
    own = "import signal\nsignal.signal(signal.SIGHUP, lambda *_: print('again', flush=True))"
    with Program(own, WAITS_FOR_EVER) as program:
        program.wait_until_ready()
        assert program.process.stdout is not None
        program.send(SIGHUP)
        assert program.process.stdout.readline() == "again\n"
        program.send(SIGTERM)
        status, out, _ = program.end()
    assert (status, out) == (0, "cancelled\nafter run\n")


FORKS = """
import os, signal

async def main():
    child = os.fork()
    if not child:
        print("ready", flush=True)
        time.sleep(30)
        os._exit(0)
    _, status = await asyncio.to_thread(os.waitpid, child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)

aionode.run(main, args=[])
"""


@pytest.mark.parametrize("number", [SIGTERM, SIGHUP])
def test_a_signal_ends_a_forked_child_as_without_aionode(number: signal.Signals) -> None:
    """`multiprocessing` ends its workers with SIGTERM; nothing of aionode runs in them."""
    with Program(FORKS) as program:
        program.wait_until_ready()
        children = Path(f"/proc/{program.process.pid}/task/{program.process.pid}/children")
        os.kill(int(children.read_text()), number)
        status, out, _ = program.end()
    assert (status, out) == (0, f"{-number}\n")


PRINTS_BEFORE_ITS_LAST_MESSAGE = """
import os

class Robot(aionode.Node):
    def __init__(self):
        super().__init__("robot", context=context)
        self.create_timer(0.0, self.drive)

    async def drive(self):
        try:
            print("ready", flush=True)
            await asyncio.Event().wait()
        finally:
            print("stopping", flush=True)
            self.get_logger().info("stopping")
            await asyncio.sleep(0.05)
            print("stopped", file=sys.stderr, flush=True)
            os.write({descriptor}, b"stop;")
            {end}

try:
    aionode.run(Robot, args=[])
finally:
    os.write({descriptor}, b"after;")
"""


@pytest.mark.parametrize(
    ("end", "status"),
    [("pass", 0), ("1 / 0", 1)],
)
def test_a_lost_terminal_keeps_no_program_from_its_last_message(end: str, status: int) -> None:
    """Each write fails with EIO: that of `print`, of the log, and of the final traceback."""
    master, terminal = pty.openpty()
    reading, writing = os.pipe()
    body = PRINTS_BEFORE_ITS_LAST_MESSAGE.replace("{descriptor}", str(writing))
    streams = dict.fromkeys(("stdin", "stdout", "stderr"), terminal)
    with Program(
        body.replace("{end}", end),
        before=("setsid", "--ctty", "--wait"),  # its terminal, whose end it hears of
        pass_fds=(writing,),
        **streams,
    ) as program:
        os.close(terminal)
        os.close(writing)
        shown = b""
        while b"ready" not in shown:
            shown += os.read(master, 1000)
        os.close(master)
        assert program.process.wait(20) == status
    with os.fdopen(reading) as stream:
        assert stream.read() == "stop;after;"


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_a_pipe_whose_reader_has_ended_keeps_no_program_from_its_last_message(
    number: signal.Signals,
) -> None:
    """Ctrl-C ends the other programs of a pipeline, too."""
    reading, writing = os.pipe()
    body = PRINTS_BEFORE_ITS_LAST_MESSAGE.replace("{descriptor}", str(writing))
    with Program(body.replace("{end}", "pass"), pass_fds=(writing,)) as program:
        os.close(writing)
        program.wait_until_ready()
        assert program.process.stdout is not None
        program.process.stdout.close()
        program.send(number)
        status = program.process.wait(20)
        program.process.stdout = None
    with os.fdopen(reading) as stream:
        assert stream.read() == "stop;after;"
    assert status == 0


def run_in_this_process(main: object) -> None:
    """Run without reading pytest's arguments."""
    aionode.run(main, args=[], loop_factory=asyncio.new_event_loop)  # type: ignore[arg-type]


@pytest.mark.parametrize("number", [SIGINT, SIGTERM, SIGHUP])
def test_signal_handlers_are_restored(number: signal.Signals) -> None:
    """The surrounding program has its own handlers."""
    before = signal.getsignal(number)

    async def main() -> None:
        assert signal.getsignal(number) is not before

    run_in_this_process(main)
    assert signal.getsignal(number) is before


def test_a_handler_that_the_program_has_set_meanwhile_stays() -> None:
    """It does not belong to aionode."""

    def handler(*_: object) -> None: ...

    async def main() -> None:
        signal.signal(SIGTERM, handler)

    before = signal.getsignal(SIGTERM)
    try:
        run_in_this_process(main)
        assert signal.getsignal(SIGTERM) is handler
    finally:
        signal.signal(SIGTERM, before)
