"""Ends and faults of an rclpy program, each between checks of what else the process has.

``belongings.py`` prints, by the name of each, what was not as before.
"""

from __future__ import annotations

import gc
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from rcl_interfaces.srv import ListParameters
from std_msgs.msg import Int32

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from tests.support.guest import guest, locks

PEER = """
import sys
import rclpy
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("peer")
publisher = node.create_publisher(Int32, "echo", 10)
node.create_subscription(Int32, "numbers", publisher.publish, 10)
rclpy.spin(node)
"""

ENDS: dict[str, Callable[[], object]] = {}


class Failure(Exception):  # noqa: N818  # raised on purpose
    """The exception that a callback or a handler raises."""


def end(work: Callable[[], object]) -> Callable[[], object]:
    """Record one end."""
    ENDS[work.__name__] = work
    return work


def communicate() -> Any:
    """Publish and call in a new context, and receive both; return the node."""
    rclpy.init()
    node = rclpy.create_node("guest")
    heard: list[int] = []
    publisher = node.create_publisher(Int32, "numbers", 10)
    node.create_subscription(Int32, "numbers", lambda msg: heard.append(msg.data), 10)
    node.create_timer(0.01, lambda: publisher.publish(Int32(data=1)))
    node.create_service(ListParameters, "ask", lambda request, response: response)
    client = node.create_client(ListParameters, "ask")
    future = client.call_async(ListParameters.Request())
    while not (heard and future.done()):
        rclpy.spin_once(node, timeout_sec=1.0)
    return node


@end
def shutdown() -> None:
    communicate()
    rclpy.shutdown()


@end
def destroyed_first() -> None:
    communicate().destroy_node()
    rclpy.try_shutdown()


@end
def an_executor_with_threads() -> None:
    node = communicate()
    with MultiThreadedExecutor(2) as executor:
        executor.add_node(node)
        for _ in range(5):
            executor.spin_once(timeout_sec=0.1)
    rclpy.shutdown()


@end
def a_context_that_is_dropped() -> None:
    context = rclpy.Context()
    rclpy.init(context=context)
    rclpy.create_node("dropped", context=context)
    del context
    gc.collect()


@end
def an_init_that_fails() -> None:
    for arguments in (["--ros-args", "--nonsense"], ["--ros-args", "-r", "nonsense"]):
        with suppress(RuntimeError):
            rclpy.init(args=arguments, context=rclpy.Context())


@end
def a_callback_that_raises() -> None:
    node = communicate()

    def fail() -> None:
        raise Failure

    node.create_timer(0.01, fail)
    with suppress(Failure):
        rclpy.spin(node)
    rclpy.shutdown()


def ended_by(number: int) -> None:
    node = communicate()
    threading.Timer(0.05, os.kill, [os.getpid(), number]).start()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    rclpy.shutdown()


@end
def sigint() -> None:
    ended_by(signal.SIGINT)


@end
def sigterm() -> None:
    ended_by(signal.SIGTERM)


@end
def sighup() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    ended_by(signal.SIGHUP)
    signal.signal(signal.SIGHUP, before)


@end
def a_handler_that_raises() -> None:
    def fail(number: int, frame: object) -> None:
        raise Failure

    before = signal.signal(signal.SIGUSR1, fail)
    node = communicate()
    threading.Timer(0.05, os.kill, [os.getpid(), signal.SIGUSR1]).start()
    with suppress(Failure):
        rclpy.spin(node)
    signal.signal(signal.SIGUSR1, before)
    rclpy.shutdown()


@end
def a_child_that_is_forked() -> None:
    node = communicate()
    child = os.fork()
    if child == 0:
        with suppress(RuntimeError):
            rclpy.spin(node)
        rclpy.try_shutdown()
        os._exit(0)
    os.waitpid(child, 0)
    rclpy.spin_once(node, timeout_sec=1.0)
    rclpy.shutdown()


def with_a_peer(fault: Callable[[subprocess.Popen[bytes]], object]) -> None:
    command = [sys.executable, "-m", "aionode.rclpy", "/dev/stdin"]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as peer:
        assert peer.stdin is not None
        peer.stdin.write(PEER.encode())
        peer.stdin.close()
        node = communicate()
        heard: list[int] = []
        node.create_subscription(Int32, "echo", lambda msg: heard.append(msg.data), 10)
        while not heard:
            rclpy.spin_once(node, timeout_sec=1.0)
        fault(peer)
        for _ in range(10):
            rclpy.spin_once(node, timeout_sec=0.1)
        peer.kill()
        rclpy.shutdown()


@end
def a_peer_that_is_killed() -> None:
    with_a_peer(subprocess.Popen.kill)


@end
def a_peer_that_is_frozen() -> None:
    with_a_peer(lambda peer: peer.send_signal(signal.SIGSTOP))


def descriptors() -> dict[int, str]:
    """Return the open descriptors, and their targets."""
    found = {}
    for entry in Path("/proc/self/fd").iterdir():
        with suppress(FileNotFoundError):  # that of the listing itself
            found[int(entry.name)] = str(entry.readlink())
    return found


def main() -> None:
    # One-time objects that stay are created here: the threads of Zenoh, and what they wait with.
    with_a_peer(subprocess.Popen.kill)
    found = {}
    for name, work in ENDS.items():
        try:
            # With its own handlers, the main thread leaves sending and reading to the context's
            # thread; without, it does both itself.
            for hold in (guest, locks):
                with tempfile.TemporaryDirectory() as folder, hold(Path(folder)):
                    before = descriptors()
                    work()
                    gc.collect()
                    changed = descriptors().items() ^ before.items()
                    if changed:
                        raise AssertionError(f"descriptors: {sorted(changed)}")
        except BaseException:  # noqa: BLE001  # whatever it is, it is printed
            found[name] = traceback.format_exc()
        else:
            found[name] = "as before"
    print(json.dumps(found), flush=True)  # noqa: T201  # a program prints


if __name__ == "__main__":
    main()
