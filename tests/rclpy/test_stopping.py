"""rclpy programs that publish a stop message at their end: it is the last message received."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import rclpy
from aionode.clock import MachineTime
from aionode.interfaces.std_msgs.msg import Int32
from aionode.interfaces.std_srvs.srv import Trigger
from tests.support import fork_server
from tests.support.peers import isolated_environment

PATIENCE_S = 30.0
steady_ns = MachineTime().steady_ns

pytestmark = [
    pytest.mark.timeout(60),
    pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's"),
]

PROGRAM = """
import sys, time
import rclpy
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

rclpy.init(args=[])
node = rclpy.create_node("mover")
stops = node.create_client(Trigger, "stop")
commands = node.create_publisher(Int32, "commands", 10)
move = lambda: commands.publish(Int32(data=1))
while not commands.get_subscription_count():
    time.sleep(0.01)
try:
    if sys.argv[1] == "spin":
        node.create_timer(0.01, move)
        rclpy.spin(node)
    elif sys.argv[1] == "ok":
        while rclpy.ok():
            move()
            time.sleep(0.01)
    elif sys.argv[1] == "loop":
        while True:
            move()
            time.sleep(0.01)
    elif sys.argv[1] == "thread":
        import threading
        def work():
            while True:
                move()
                time.sleep(0.01)
        threading.Thread(target=work, daemon=True).start()
        rclpy.spin(node)
    elif sys.argv[1] == "rate":
        import threading
        threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
        rate = node.create_rate(0.001)  # its tick does not end the sleep
        while rclpy.ok():
            move()
            rate.sleep()
    elif sys.argv[1] == "call":
        node.create_service(Trigger, "unanswered", None)  # nobody spins
        unanswered = node.create_client(Trigger, "unanswered")
        unanswered.wait_for_service()
        move()
        unanswered.call(Trigger.Request())
finally:
    time.sleep(0.1)
    if sys.argv[2] == "call":
        stops.call(Trigger.Request())
    else:
        commands.publish(Int32(data=0))
    if sys.argv[2] == "shutdown":
        node.destroy_node()
        rclpy.try_shutdown()
"""


class Wheels:
    """Receives the commands, in a separate context."""

    def __init__(self) -> None:
        self.context = rclpy.Context()
        rclpy.init(args=[], context=self.context)
        self.node = rclpy.create_node("wheels", context=self.context)
        self.executor = rclpy.executors.SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.heard: list[int] = []
        self.node.create_subscription(
            Int32, "commands", lambda msg: self.heard.append(msg.data), 1000
        )
        self.node.create_service(Trigger, "stop", self.stop)

    def stop(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Stop at the request of a program."""
        self.heard.append(0)
        return response

    def listen_until_stopped(self) -> None:
        """Listen until a stop arrives, and for half a second after it."""
        ends_ns = steady_ns() + PATIENCE_S * 1e9
        while 0 not in self.heard and steady_ns() < ends_ns:
            self.executor.spin_once(timeout_sec=0.1)
        for _ in range(5):
            self.executor.spin_once(timeout_sec=0.1)

    def listen_until_moved(self) -> None:
        """Listen until a command arrives."""
        while not self.heard:
            self.executor.spin_once(timeout_sec=1.0)


@pytest.fixture
def wheels(monkeypatch: pytest.MonkeyPatch) -> Iterator[Wheels]:
    """Wheels that only receive from the programs of this test."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    wheels = Wheels()
    yield wheels
    wheels.context.try_shutdown()


def start(tmp_path: Path, *arguments: str) -> subprocess.Popen[str]:
    """Start the program that moves."""
    program = tmp_path / "mover.py"
    program.write_text(PROGRAM, encoding="utf-8")
    return fork_server.start(
        ["-m", "aionode.rclpy", str(program), *arguments],  # like `aionode run`
        env=os.environ,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@pytest.mark.parametrize(
    ("way", "number"),
    [
        ("spin", signal.SIGINT),
        pytest.param("ok", signal.SIGINT, marks=pytest.mark.stress),
        pytest.param("thread", signal.SIGINT, marks=pytest.mark.stress),
        pytest.param("spin", signal.SIGTERM, marks=pytest.mark.stress),
        ("loop", signal.SIGTERM),
        ("thread", signal.SIGTERM),
        ("rate", signal.SIGTERM),
        ("call", signal.SIGTERM),
        ("spin", signal.SIGHUP),
    ],
)
def test_the_stop_of_a_program_that_a_signal_ends_gets_out(
    wheels: Wheels, tmp_path: Path, way: str, number: signal.Signals
) -> None:
    """The signal has already shut the context down; and no thread moves on after the stop."""
    with start(tmp_path, way, "shutdown") as mover:
        wheels.listen_until_moved()
        mover.send_signal(number)
        wheels.listen_until_stopped()
        mover.kill()

    assert wheels.heard.count(0) == 1
    assert wheels.heard[-1] == 0


def test_a_program_that_a_signal_ends_may_call_the_service_that_stops(
    wheels: Wheels, tmp_path: Path
) -> None:
    """With rclpy nobody would take the response, and the program would not end."""
    with start(tmp_path, "spin", "call") as mover:
        wheels.listen_until_moved()
        mover.send_signal(signal.SIGTERM)
        wheels.listen_until_stopped()

    assert wheels.heard.count(0) == 1


@pytest.mark.parametrize(
    ("first", "second", "delay_s"),
    [
        pytest.param(signal.SIGINT, signal.SIGINT, 0.002, marks=pytest.mark.stress),
        (signal.SIGINT, signal.SIGINT, 0.05),
        pytest.param(signal.SIGINT, signal.SIGTERM, 0.02, marks=pytest.mark.stress),
        (signal.SIGTERM, signal.SIGINT, 0.02),
    ],
)
def test_a_signal_that_is_forwarded_does_not_end_the_cleanup(
    wheels: Wheels, tmp_path: Path, first: signal.Signals, second: signal.Signals, delay_s: float
) -> None:
    """The process group has received it: ``timeout``, ``ros2 launch`` and wrappers do that."""
    with start(tmp_path, "spin", "leave") as mover:
        wheels.listen_until_moved()
        mover.send_signal(first)
        threading.Timer(delay_s, mover.send_signal, [second]).start()
        wheels.listen_until_stopped()
        mover.kill()

    assert wheels.heard[-1] == 0


@pytest.mark.slow
def test_a_hangup_that_is_ignored_stays_ignored(wheels: Wheels, tmp_path: Path) -> None:
    """``nohup`` starts programs this way, which should continue when the terminal is lost."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        mover = start(tmp_path, "spin", "leave")
    finally:
        signal.signal(signal.SIGHUP, before)
    with mover:
        wheels.listen_until_moved()
        mover.send_signal(signal.SIGHUP)
        for _ in range(20):
            wheels.executor.spin_once(timeout_sec=0.1)
        assert 0 not in wheels.heard
        os.kill(mover.pid, signal.SIGTERM)
        wheels.listen_until_stopped()

    assert wheels.heard[-1] == 0
