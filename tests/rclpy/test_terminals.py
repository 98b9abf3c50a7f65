"""rclpy programs in terminals, unchanged: what they print, and how they end.

The programs of the tutorial are not part of the repository; they are run if they are beside it.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from aionode.clock import MachineTime
from tests.support import fork_server
from tests.support.peers import isolated_environment

ROOT = Path(__file__).parents[2]
TUTORIAL = ROOT.parent / "shared" / "tutorial"
EXAMPLES = ROOT / "examples"
PATIENCE_S = 40.0
steady_ns = MachineTime().steady_ns
STAMP = re.compile(r"\[\d+\.\d+\] ")

pytestmark = [
    pytest.mark.timeout(120),
    pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's"),
]
needs_tutorial = pytest.mark.skipif(
    not TUTORIAL.is_dir(), reason="the programs of the tutorial are not beside the repository"
)

WAITING_CLIENT = """\
import rclpy
from example_interfaces.srv import AddTwoInts

rclpy.init()
node = rclpy.create_node("client")
client = node.create_client(AddTwoInts, "add")
node.get_logger().info("Waiting")
while not client.wait_for_service(timeout_sec=0.2):
    pass
future = client.call_async(AddTwoInts.Request(a=1, b=2))
rclpy.spin_until_future_complete(node, future)
node.get_logger().info(f"sum {future.result().sum}")
rclpy.shutdown()
"""

SERVER = """\
import rclpy
from example_interfaces.srv import AddTwoInts

def add(request, response):
    response.sum = request.a + request.b
    node.get_logger().info(f"asked for {request.a} + {request.b}")
    return response

rclpy.init()
node = rclpy.create_node("server")
service = node.create_service(AddTwoInts, "add", add)
node.get_logger().info("Serving")
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
finally:
    node.destroy_node()
    rclpy.try_shutdown()
"""

COUNTS = """\
import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("listener")
node.create_subscription(Int32, "/robot/word_count", lambda msg: print(msg.data, flush=True), 10)
rclpy.spin(node)
"""


class Terminal:
    """A running program, and its output so far."""

    def __init__(self, output: Path, *command: str, environment: dict[str, str]) -> None:
        self._output = output
        with output.open("w", encoding="utf-8") as file:
            self.process = fork_server.start(
                [*command],
                env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
            )

    @property
    def printed(self) -> str:
        """The output without time stamps."""
        return STAMP.sub("", self._output.read_text(encoding="utf-8"))

    def wait_for(self, text: str) -> None:
        """Wait until it has printed a text."""
        ends_ns = steady_ns() + PATIENCE_S * 1e9
        while text not in self.printed:
            assert self.process.poll() is None, self.printed
            assert steady_ns() < ends_ns, self.printed
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(0.02)

    def end(self, number: signal.Signals | None = None) -> int:
        """Send a signal, if one is given, and return the exit status."""
        if number is not None:
            self.process.send_signal(number)
        return self.process.wait(PATIENCE_S)


Start = Callable[..., Terminal]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Start programs that are connected; `rclpy=False` runs one without aionode's rclpy."""
    environment = isolated_environment()
    terminals: list[Terminal] = []

    def started(program: Path | str, *args: str, rclpy: bool = True) -> Terminal:
        if isinstance(program, str):
            path = tmp_path / f"program{len(terminals)}.py"
            path.write_text(program, encoding="utf-8")
            program = path
        runner = ("-m", "aionode.rclpy") if rclpy else ()  # like `aionode run`
        output = tmp_path / f"output{len(terminals)}"
        terminal = Terminal(output, *runner, str(program), *args, environment=environment)
        terminals.append(terminal)
        return terminal

    yield started
    for terminal in terminals:
        terminal.process.kill()
        terminal.process.wait()


@pytest.mark.parametrize(
    ("number", "status", "last_line"),
    [
        (signal.SIGINT, -signal.SIGINT, "KeyboardInterrupt"),
        (
            signal.SIGTERM,
            1,
            "RCLError: failed to check service availability: rcl node's context is invalid",
        ),
    ],
)
def test_a_client_that_waits_for_a_server_ends_by_a_signal(
    start: Start, number: signal.Signals, status: int, last_line: str
) -> None:
    """Its loop asks repeatedly: a plain "no" after the shutdown would keep it there forever."""
    client = start(WAITING_CLIENT)
    client.wait_for("Waiting")

    assert client.end(number) == status
    assert client.printed.rstrip().endswith(last_line)


def test_a_client_that_is_first_gets_its_answer(start: Start) -> None:
    """Programs of a system start in any order; SIGTERM ends a server as in ROS 2."""
    client = start(WAITING_CLIENT)
    client.wait_for("Waiting")
    server = start(SERVER)

    assert client.end() == 0
    assert "[INFO] [client]: sum 3\n" in client.printed
    assert server.end(signal.SIGTERM) == 1
    assert "[INFO] [server]: asked for 1 + 2\n" in server.printed
    assert server.printed.rstrip().endswith("ExternalShutdownException")


@needs_tutorial
@pytest.mark.parametrize(
    "example",
    [
        None,
        pytest.param("simple_publisher.py", marks=pytest.mark.slow),
        pytest.param("simple_subscriber.py", marks=pytest.mark.slow),
    ],
)
def test_the_publisher_and_the_subscriber_of_the_tutorial(
    start: Start, example: str | None
) -> None:
    """Both unchanged, and each with aionode's example in place of the other."""

    def program(name: str) -> Terminal:
        own = name == example
        return start((EXAMPLES if own else TUTORIAL) / name, rclpy=not own)

    publisher = program("simple_publisher.py")
    publisher.wait_for('Publishing: "Hello from ROS 2! Message count: 0"')
    subscriber = program("simple_subscriber.py")
    subscriber.wait_for("Received message #1:")

    assert [subscriber.end(signal.SIGINT), publisher.end(signal.SIGINT)] == [0, 0]
    assert publisher.printed.startswith(
        "[INFO] [simple_publisher]: Simple Publisher started. Publishing to /robot/message\n"
        '[INFO] [simple_publisher]: Publishing: "Hello from ROS 2! Message count: 0"\n'
    )
    assert re.fullmatch(
        r"\[INFO\] \[simple_subscriber\]: Simple Subscriber started. Listening to /robot/message\n"
        r'(\[INFO\] \[simple_subscriber\]: Received message #\d+: "Hello .* count: \d+"\n)+',
        subscriber.printed,
    )


@needs_tutorial
@pytest.mark.parametrize("first", ["client", "server"])
def test_the_service_of_the_tutorial(start: Start, first: str) -> None:
    """In both orders: the client asks once a second until the server is there."""
    modes = {
        "server": ("--ros-args", "-p", "mode:=server"),
        "client": ("--ros-args", "-p", "mode:=client", "-p", "a:=10", "-p", "b:=25"),
    }
    program = TUTORIAL / "service_client_server.py"
    texts = {"client": "Waiting for service /add_two_ints...", "server": "server started"}
    terminals = {first: start(program, *modes[first])}
    terminals[first].wait_for(texts[first])
    other = "server" if first == "client" else "client"
    terminals[other] = start(program, *modes[other])

    assert terminals["client"].end() == 0
    assert "[add_two_ints_client]: Response: 10 + 25 = 35\n" in terminals["client"].printed
    terminals["server"].wait_for("[add_two_ints_server]: Request: a=10, b=25 -> sum=35\n")
    assert terminals["server"].end(signal.SIGINT) == 0
    assert "Traceback" not in terminals["server"].printed


@needs_tutorial
def test_the_word_counter_of_the_tutorial(start: Start) -> None:
    """The solution of its second exercise counts what its publisher says."""
    counter = start(TUTORIAL / "word_counter.py")
    listener = start(COUNTS)
    publisher = start(TUTORIAL / "simple_publisher.py")
    listener.wait_for("\n")

    assert int(listener.printed.split()[0]) % 7 == 0  # "Hello from ROS 2! Message count: 0"
    assert [each.end(signal.SIGINT) for each in (counter, publisher)] == [0, 0]
