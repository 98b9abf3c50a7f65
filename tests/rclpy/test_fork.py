"""Children that a program forks while its context is open."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

import pytest

from tests.support.peers import isolated_environment

PATIENCE_S = 40.0

pytestmark = [
    pytest.mark.timeout(60),
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork"),
]

PROGRAM = """
import json, os, signal, sys, threading
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rcl_interfaces.srv import ListParameters
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("parent")
publisher = node.create_publisher(Int32, "numbers", 10)
client = node.create_client(ListParameters, "ask")
heard = []
node.create_subscription(Int32, "numbers", lambda msg: heard.append(msg.data), 10)
executor = SingleThreadedExecutor()
attempts = {
    "publish": lambda: publisher.publish(Int32(data=1)),
    "count": publisher.get_subscription_count,
    "call_async": lambda: client.call_async(ListParameters.Request()),
    "call": lambda: client.call(ListParameters.Request(), timeout_sec=0.1),
    "create": lambda: node.create_publisher(Int32, "others", 10),
    "spin": lambda: rclpy.spin(node),
    "spin_once": lambda: rclpy.spin_once(node, timeout_sec=0.1),
    "executor": lambda: executor.spin_once(timeout_sec=0.1),
    "names": node.get_node_names,
}
reading, writing = os.pipe()
child = os.fork()
if child == 0:
    said = {}
    for name, attempt in attempts.items():
        try:
            said[name] = repr(attempt())
        except BaseException as error:
            said[name] = type(error).__name__
    said["ok"] = rclpy.ok()
    node.destroy_node()
    rclpy.try_shutdown()
    os.write(writing, json.dumps(said).encode())
    sys.exit()
os.close(writing)
said = json.loads(open(reading).read())
os.waitpid(child, 0)
publisher.publish(Int32(data=2))
while not heard:
    rclpy.spin_once(node, timeout_sec=1.0)
said["parent"] = heard
rclpy.shutdown()
print(json.dumps(said), flush=True)
"""


FORKS_IN_A_THREAD = """
import os, signal, threading
from rclpy._impl import uninterrupted

signal.signal(signal.SIGUSR1, lambda *_: None)


def fork():
    child = os.fork()
    if child == 0:
        os._exit(uninterrupted.begin())
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), uninterrupted.begin())


thread = threading.Thread(target=fork)
thread.start()
thread.join()
"""


def run(program: str) -> subprocess.CompletedProcess[str]:
    """Run a program of rclpy."""
    return subprocess.run(
        [sys.executable, "-m", "aionode.rclpy", "/dev/stdin"],
        input=program,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        # From Python 3.12 on, a fork beside threads is deprecated, with a warning.
        env={
            **os.environ,
            **isolated_environment(),
            "PYTHONWARNINGS": "ignore::DeprecationWarning",
        },
        check=False,
    )


def test_signals_interrupt_the_thread_that_forked_the_child() -> None:
    """It is the main thread there, so it may do nothing that a program's handler may not interrupt.

    In the parent, handlers run in another thread.
    """
    process = run(FORKS_IN_A_THREAD)

    assert process.stdout.split() == ["0", "True"], process.stderr


@pytest.mark.slow
def test_a_forked_child_is_told_that_it_cannot_use_the_context() -> None:
    """It has neither the sending thread nor sockets of its own; the parent is not disturbed."""
    process = run(PROGRAM)
    assert process.stdout, process.stderr
    said: dict[str, Any] = json.loads(process.stdout)

    assert said.pop("parent") == [2]
    assert said.pop("ok") is False
    assert said == dict.fromkeys(said, "ForkedProcessError")
    assert process.stderr == ""
