"""Every example program: its output, its end, and its reaction to Ctrl-C."""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import signal
import socket
import subprocess
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import httpx
import pytest
import uvicorn

from aionode.examples.quality_of_service.incompatible_qos import POLICIES
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from examples.fastapi_app import make_app
from tests.support.fork_server import run, start
from tests.support.peers import isolated_environment
from tests.system.left import MARK, left

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterator

    from aionode import Context, Node

ROOT = Path(__file__).parent.parent
ENDING = ["fibonacci", "overload", "pubsub", "service", "timers"]
ENDLESS = sorted(
    path.name
    for path in (ROOT / "examples").glob("*.py")
    if not path.name.endswith(".launch.py")  # no program: tests/launch/test_running.py starts it
    and path.name
    not in {"call_service.py", "fastapi_app.py", "lifecycle_manager.py", "robot_system.py"}
)
STAMP = r"\[INFO\] \[\d+\.\d{9}\]"


class Program:
    """A program of this repository in a process of its own."""

    def __init__(self, *arguments: str, env: dict[str, str]) -> None:
        reading, writing = os.pipe()
        self._running = os.fdopen(reading, "rb", buffering=0)
        self.process = start(
            ["tests/support/announcing.py", str(writing), *arguments],
            cwd=ROOT,
            env=os.environ | env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            pass_fds=[writing],
        )
        os.close(writing)

    def wait_until_running(self) -> None:
        """Return when a node of the program runs."""
        if not self._running.read(1):
            pytest.fail(f"no node ran:\n{self.rest()}")

    def line_with(self, pattern: str) -> str:
        """Return the next line of output that matches; fail at the end of the output."""
        assert self.process.stdout is not None
        seen = []
        for line in self.process.stdout:
            if re.search(pattern, line):
                return line.rstrip("\n")
            seen.append(line)
        pytest.fail(f"no line with {pattern!r} in:\n{''.join(seen)}")

    def rest(self) -> str:
        """Return what the program still prints until its end."""
        return self.process.communicate(timeout=30)[0]

    def end_with(self, number: signal.Signals) -> tuple[int, str]:
        """Send a signal; return the exit status and what was printed since."""
        self.process.send_signal(number)
        text = self.rest()
        return self.process.returncode, text

    def close(self) -> None:
        """End the program if it still runs."""
        self.process.kill()
        self.process.communicate()
        self._running.close()


@contextmanager
def running(*arguments: str, domain: int | None = None) -> Iterator[Program]:
    """Run a program; alone, or in a domain where it finds the others of the same test."""
    if domain is None:
        env = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    else:
        env = {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    program = Program(*arguments, env=env)
    try:
        yield program
    finally:
        program.close()


@pytest.fixture
def domain(monkeypatch: pytest.MonkeyPatch) -> int:
    """The ROS domain of a test whose programs hear each other, and nothing else."""
    environment = isolated_environment()
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    return int(environment["ROS_DOMAIN_ID"])


def test_the_first_example_tells_its_story() -> None:
    """Each message is published, then received; statistics come last."""
    with running("-m", "aionode.examples.pubsub") as program:
        text = program.rest()

    said = re.findall(r'Publishing: "(.*)"', text)
    heard = re.findall(r'I heard: "(.*)"', text)
    assert said == heard == [f"Hello {number}" for number in range(1, 6)]
    assert program.process.returncode == 0
    assert "5 messages heard, 0 dropped" in text


def test_a_service_answers_together_what_is_asked_together() -> None:
    """Ten calls at once, a refused one, and one without a server."""
    with running("-m", "aionode.examples.service") as program:
        text = program.rest()

    assert "10 + 25 = 35" in text
    assert str(list(range(0, 20, 2))) in text
    assert "ValueError: only counts, please" in text
    assert "no server is matched" in text
    assert "Traceback" not in text
    assert program.process.returncode == 0


def test_a_goal_is_awaited_watched_and_cancelled() -> None:
    """Await a goal, watch its feedback, cancel it."""
    with running("-m", "aionode.examples.fibonacci") as program:
        text = program.rest()

    assert "called:    [0, 1, 1, 2, 3, 5]" in text
    assert text.count("feedback:") == 4
    assert "result:    [0, 1, 1, 2, 3, 5], SUCCEEDED" in text
    assert "cancelled: CANCELED" in text
    assert program.process.returncode == 0


def test_a_managed_node_fails_is_canceled_and_goes_up_and_down() -> None:
    """Each ending of a transition leaves a state from which the next one begins."""
    with running("-m", "aionode.examples.lifecycle") as program:
        text = program.rest()

    assert "on_error:   after unconfigured: no device at /dev/voice" in text
    assert "canceled:   the talker is unconfigured [1]" in text
    assert "up:         the talker is active [3]" in text
    assert text.count("heard:") == 3
    assert "down:       the talker is unconfigured [1]" in text
    assert program.process.returncode == 0


@pytest.mark.slow
def test_the_lifecycle_demo_of_ros_in_three_programs(domain: int) -> None:
    """Talker, listener and manager: what is said while active, and each transition."""
    with (
        running("examples/lifecycle_talker.py", domain=domain) as talker,
        running("examples/lifecycle_listener.py", domain=domain) as listener,
    ):
        listener.wait_until_running()
        talker.wait_until_running()
        manager = ("examples/lifecycle_manager.py", "--ros-args", "-p", "pause:=0.25")
        with running(*manager, domain=domain) as program:
            managed = program.rest()
        status, said = talker.end_with(signal.SIGINT)
        heard = listener.end_with(signal.SIGINT)[1]

    assert program.process.returncode == status == 0
    states = re.findall(r"has current state (\w+)\.", managed)
    assert states == [
        *("inactive", "active", "inactive", "active", "inactive", "unconfigured"),
        *("inactive", "active", "finalized"),
    ]
    assert "As expected: /lc_talker: cannot activate" in managed
    published = re.findall(r"Publishing: \[(.*)\]", said)
    assert re.findall(r"data_callback: (.*)", heard) == published
    assert len(published) >= 3
    assert "Lifecycle publisher is inactive" in said
    assert "on_shutdown() is called from state active." in said
    goals = re.findall(r"Transition from state \w+ to (\w+)", heard)
    assert len(goals) == 18
    assert goals[:4] == ["configuring", "inactive", "activating", "active"]
    assert goals[-2:] == ["shuttingdown", "finalized"]


@pytest.mark.slow
def test_a_pause_misses_the_deadline_at_both_ends() -> None:
    """In the pause and not before."""
    with running("-m", "aionode.examples.quality_of_service.deadline") as program:
        text = program.rest()

    before, _, after = text.partition("deadline missed")
    assert "I heard: Talker says 2" in before
    assert "Offered deadline missed 2 times" in after
    assert "Requested deadline missed 2 times" in after
    assert program.process.returncode == 0


@pytest.mark.slow
def test_a_late_subscription_gets_what_is_still_valid() -> None:
    """The newest messages, and no older ones."""
    with running("-m", "aionode.examples.quality_of_service.lifespan") as program:
        text = program.rest()

    heard = [int(number) for number in re.findall(r"I heard: Talker says (\d)", text)]
    assert heard == list(range(heard[0], 8))
    counted = re.search(r"(\d) were valid, (\d) had expired", text)
    assert counted is not None
    assert int(counted[1]) == len(heard)
    # The publisher has dropped some of them itself, as it published newer ones.
    assert 0 < int(counted[2]) <= 8 - len(heard)
    assert 0 < len(heard) < 8
    assert program.process.returncode == 0


def test_liveliness_is_lost_regained_and_ends() -> None:
    """By topic; both ends learn of it."""
    with running("-m", "aionode.examples.quality_of_service.liveliness") as program:
        text = program.rest()

    assert re.findall(r"listener: (.*)", text) == [
        "alive 1 (+1), not alive 0 (+0)",
        "alive 0 (-1), not alive 1 (+1)",
        "alive 1 (+1), not alive 0 (-1)",
        "alive 0 (-1), not alive 0 (+0)",
    ]
    assert "talker:   liveliness lost, 1 times so far" in text
    assert program.process.returncode == 0


@pytest.mark.stress
def test_automatic_liveliness_lasts_until_the_end() -> None:
    """The event loop asserts it."""
    name = "aionode.examples.quality_of_service.liveliness"
    with running("-m", name, "1500", "--policy", "automatic") as program:
        text = program.rest()

    assert re.findall(r"listener: (.*)", text) == [
        "alive 1 (+1), not alive 0 (+0)",
        "alive 0 (-1), not alive 0 (+0)",
    ]
    assert "lost" not in text


@pytest.mark.parametrize(
    "policy",
    [
        pytest.param(policy, marks=[pytest.mark.stress] * (number > 1))
        for number, policy in enumerate(POLICIES)
    ],
)
def test_an_incompatible_policy_is_named_at_both_ends(policy: str) -> None:
    """No message is heard."""
    with running("-m", "aionode.examples.quality_of_service.incompatible_qos", policy) as program:
        text = program.rest()

    named = policy.removesuffix("_policy").removesuffix("_lease_duration").upper()
    assert f"A publisher offers less than is requested: {named}" in text
    assert f"A subscription requests more than is offered: {named}" in text
    assert "I heard" not in text
    assert program.process.returncode == 0


def test_lost_messages_are_all_told(domain: int) -> None:
    """Each published message is received or counted as lost."""
    name = "aionode.examples.quality_of_service.message_lost"
    with running("-m", name, domain=domain) as program:
        text = program.rest()

    told = [int(count) for count in re.findall(r"lost: +(\d+) messages", text)]
    published, received, lost = (
        int(re.search(rf"^{word}: +(\d+)$", text, re.MULTILINE)[1])  # type: ignore[index]  # is there
        for word in ("published", "received", "lost")
    )
    assert sum(told) == lost > 0
    assert received + lost == published
    assert program.process.returncode == 0


@pytest.mark.slow
def test_timers_keep_their_grid() -> None:
    """The fast timer ticks while the slow one works; a busy machine may take a tick or two."""
    with running("-m", "aionode.examples.timers") as program:
        text = program.rest()

    came = re.search(r"(\d+) of 15 fast ticks came\.", text)
    assert came is not None
    assert 10 < int(came[1]) <= 15
    assert program.process.returncode == 0


def test_overload_counts_every_message() -> None:
    """Each sent message is received, dropped or waiting."""
    with running("-m", "aionode.examples.overload", "--seconds", "1") as program:
        line = program.line_with("sent = ")
        program.rest()

    sent, received, dropped, waiting = (
        int(number) for number in re.findall(r"(\d+) (?:sent|received|dropped|waiting)", line)
    )
    assert sent == received + dropped + waiting
    assert dropped > 0
    assert 0 <= waiting <= 10
    assert program.process.returncode == 0


def ends_by_signal() -> list[Any]:
    """Return each example with each signal; most of them are left to `make stress`.

    `.ci/run` presses Ctrl-C at each endless one, and nearly all end by `aionode.run`.
    """
    pairs = []
    programs = [
        *[(name, ("-m", f"aionode.examples.{name}")) for name in ENDING],
        *[(name, (f"examples/{name}",)) for name in [*ENDLESS, "fastapi_app.py"]],
    ]
    for place, (name, arguments) in enumerate(programs):
        usual, other = (signal.SIGINT, signal.SIGTERM)[:: 1 if place % 2 else -1]
        pressed = name in ENDLESS and (usual == signal.SIGINT or place % 8 > 0)
        pairs += [
            pytest.param(
                arguments,
                usual,
                id=f"{name}-{usual.name}",
                marks=[pytest.mark.stress] * pressed,
            ),
            pytest.param(arguments, other, id=f"{name}-{other.name}", marks=pytest.mark.stress),
        ]
    return pairs


@pytest.mark.parametrize(("arguments", "number"), ends_by_signal())
def test_a_signal_ends_an_example_cleanly(
    arguments: tuple[str, ...], number: signal.Signals
) -> None:
    """Ctrl-C and SIGTERM: no traceback, exit status 0."""
    with running(*arguments) as program:
        program.wait_until_running()
        status, text = program.end_with(number)

    assert status == 0, text
    assert "Traceback" not in text
    assert "Error" not in text


def test_the_subscriber_hears_the_publisher_in_another_process(domain: int) -> None:
    """Without configuration; both print the tutorial's lines: severity, time, name, text."""
    with (
        running("examples/simple_subscriber.py", domain=domain) as subscriber,
        running("examples/simple_publisher.py", domain=domain) as publisher,
    ):
        said = [publisher.line_with("Publishing") for _ in range(2)]
        heard = [subscriber.line_with("simple_subscriber") for _ in range(3)]

    texts = {
        "simple_publisher": [
            "Simple Publisher started. Publishing to /robot/message",
            'Publishing: "Hello from ROS 2! Message count: 0"',
        ],
        "simple_subscriber": [
            "Simple Subscriber started. Listening to /robot/message",
            r'Received message #1: "Hello from ROS 2! Message count: \d+"',
            r'Received message #2: "Hello from ROS 2! Message count: \d+"',
        ],
    }
    for lines, (name, wanted) in zip((said, heard), texts.items(), strict=True):
        for line, text in zip(lines, wanted, strict=True):
            assert re.fullmatch(rf"{STAMP} \[{name}\]: {text}", line)


def test_the_service_answers_a_client_in_another_process(domain: int) -> None:
    """The tutorial's request and response, on both sides, and the sum of the README's program."""
    program = "examples/service_client_server.py"
    with running(program, "--ros-args", "-p", "mode:=server", domain=domain) as server:
        server.wait_until_running()
        asking = ["-p", "mode:=client", "-p", "a:=10", "-p", "b:=25"]
        with running(program, "--ros-args", *asking, domain=domain) as client:
            told = client.rest().splitlines()
        served = [server.line_with("add_two_ints_server") for _ in range(2)]
        with running("examples/call_service.py", domain=domain) as program_of_the_readme:
            summed = program_of_the_readme.rest()

    assert [line.partition("] [add_two_ints_client]: ")[2] for line in told][-3:] == [
        "Service client ready. Request: a=10, b=25",
        "Calling service with a=10, b=25",
        "Response: 10 + 25 = 35",
    ]
    assert client.process.returncode == 0
    assert [line.partition("] [add_two_ints_server]: ")[2] for line in served] == [
        "AddTwoInts service server started at /add_two_ints",
        "Request: a=10, b=25 -> sum=35",
    ]
    assert summed.splitlines()[-1] == "35"


def test_a_client_without_a_server_says_that_it_waits() -> None:
    """Once a second, in the tutorial's words."""
    asking = ["--ros-args", "-p", "mode:=client"]
    with running("examples/service_client_server.py", *asking) as client:
        line = client.line_with("Waiting")

    text = "Waiting for service /add_two_ints..."
    assert re.fullmatch(rf"{STAMP} \[add_two_ints_client\]: {re.escape(text)}", line)


def test_the_example_of_services_uses_no_server_of_others(domain: int) -> None:
    """Beside the tutorial's server its answers would come from either of the two."""
    with running("examples/service_client_server.py", domain=domain) as server:
        server.wait_until_running()
        with running("-m", "aionode.examples.service", domain=domain) as example:
            text = example.rest()
        status, told = server.end_with(signal.SIGINT)

    assert "ValueError: only counts, please" in text
    assert "Request:" not in told
    assert status == 0


@pytest.mark.parametrize(
    "name",
    [
        "simple_publisher",
        "simple_subscriber",
        "service_client_server",
        "timestamp_publisher",
        "word_counter",
        "reverse_string_service",
    ],
)
def test_a_program_of_the_tutorial_can_be_executed(name: str) -> None:
    """As ``./simple_publisher.py``, which the tutorial's readers try."""
    path = ROOT / "examples" / f"{name}.py"

    assert path.read_text(encoding="utf-8").startswith("#!/usr/bin/env python3\n")
    assert os.access(path, os.X_OK)


def test_a_call_without_a_server_says_what_is_missing(domain: int) -> None:
    """The first thing that a reader of the README forgets is the server."""
    with running("examples/call_service.py", domain=domain) as client:
        text = client.rest()

    assert text.splitlines()[-1] == (
        "error: /add_two_ints: no reply in 2 s; no server is matched: is it running, with this "
        "name and type?"
    )
    assert "Traceback" not in text
    assert client.process.returncode == 1


def test_a_service_of_a_type_of_its_own_reverses_a_string(domain: int) -> None:
    """A type written as a class works between processes, and no warning tells of two nodes."""
    program = "examples/reverse_string_service.py"
    with running(program, domain=domain) as server:
        server.wait_until_running()
        asking = ["-p", "mode:=client", "-p", "text:=robot"]
        with running(program, "--ros-args", *asking, domain=domain) as client:
            asked = client.rest()
        _, answered = server.end_with(signal.SIGINT)

    assert 'Response: "tobor"' in asked
    assert "tobor" in answered
    assert "two nodes" not in asked + answered


def test_the_word_counter_counts_what_the_publisher_says(domain: int) -> None:
    """One topic in, another one out."""
    with (
        running("examples/word_counter.py", domain=domain) as counter,
        running("examples/simple_publisher.py", domain=domain),
    ):
        lines = [counter.line_with("Words so far") for _ in range(2)]

    assert [line.rpartition(" ")[2] for line in lines] == ["7", "14"]


@pytest.mark.slow
def test_the_arm_says_where_its_gripper_is(domain: int) -> None:
    """In the map, and the cup in the gripper; the tree is seen from another process."""
    with running("examples/arm.py", domain=domain) as arm:
        place = [float(word) for word in arm.line_with("gripper in the map").split()[-3:]]
        arm.line_with("cup in the gripper")
        arm.line_with("height of the gripper")
        command = ["-m", "aionode", "tf", "tree"]
        tree = run(command, env={**os.environ, "ROS_DOMAIN_ID": str(domain)}, timeout=40)

    assert tree.returncode == 0, tree.stderr
    assert abs(place[0] - 2) < 1.3
    assert tree.stdout.splitlines()[0] == "map"
    assert "gripper" in tree.stdout


def test_the_parameters_of_another_node_are_read_and_set(domain: int) -> None:
    """The speed doubles until the limit refuses it, with a reason."""
    program = "examples/parameter_client.py"
    fast = ("--ros-args", "-p", "speed:=1.0")
    with running("examples/driver.py", *fast, domain=domain) as driver:
        driver.wait_until_running()
        texts = []
        for _ in range(2):
            with running(program, domain=domain) as client:
                texts.append(client.rest())

    assert "speed: 1.0 -> 2.0" in texts[0]
    assert "speed is still 2.0" in texts[1]


def test_the_last_message_of_a_program_is_that_the_wheels_stop(domain: int) -> None:
    """Ctrl-C cancels the callback, whose `finally` may still publish."""
    typed = ["/cmd_vel", "geometry_msgs/msg/Twist"]  # the program may start later
    with (
        running(
            "-m", "aionode", "topic", "echo", *typed, "--field", "linear.x", domain=domain
        ) as echo,
        running("examples/last_message.py", domain=domain) as robot,
    ):
        echo.line_with(r"^0\.2")
        status, text = robot.end_with(signal.SIGINT)
        echo.line_with(r"^0\.0")

    assert status == 0, text
    assert "Error" not in text


def test_the_wheels_stop_when_their_driver_is_killed_and_obey_an_emergency_stop(
    domain: int,
) -> None:
    """Between processes, and by the commands of docs/howto/stopping.md."""
    with running("examples/wheels.py", domain=domain) as wheels:
        wheels.line_with("Motors: 0.0")
        with running("examples/leased_driver.py", domain=domain) as driver:
            wheels.line_with("Motors: 0.2")
            driver.process.kill()
            wheels.line_with("Motors: 0.0")
        with running("examples/leased_driver.py", domain=domain) as driver:
            wheels.line_with("Motors: 0.2")
            stop = ("topic", "pub", "-r", "10", "/emergency_stop", "std_msgs/msg/Empty")
            with running("-m", "aionode", *stop, domain=domain):
                wheels.line_with("Motors: 0.0")
            release = ("service", "call", "/wheels/release", "std_srvs/srv/Trigger")
            with running("-m", "aionode", *release, domain=domain) as person:
                assert "obey commands again" in person.rest()
            wheels.line_with("Motors: 0.2")
            status, text = driver.end_with(signal.SIGINT)
            assert status == 0, text
            wheels.line_with("Motors: 0.0")
        status, text = wheels.end_with(signal.SIGINT)

    assert status == 0, text


@pytest.mark.slow
def test_a_robot_of_four_processes_shows_its_table_and_ctrl_c_leaves_nothing(
    domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The wheels hear that they stop before they are stopped."""
    mark = uuid4().hex
    monkeypatch.setenv(MARK, mark)
    with running("examples/robot_system.py", domain=domain) as robot:
        for name in ("wheels", "battery", "watch", "driver"):
            robot.line_with(rf"^ *{name} +running +pid \d+$")
        robot.line_with(r"wheels \| .*Motors: 0\.2")
        status, text = robot.end_with(signal.SIGINT)

    assert status == 0, text
    assert "Motors: 0.0" in text
    assert "failed" not in text
    assert left(mark) == {}


def test_the_robot_drives_where_a_client_in_another_process_tells_it(domain: int) -> None:
    """Feedback comes on the way, the result at the end; no warning tells of two nodes."""
    program = "examples/navigate.py"
    with running(program, domain=domain) as robot:
        robot.wait_until_running()
        asking = ["-p", "mode:=client", "-p", "x:=0.3", "-p", "y:=0.4"]
        with running(program, "--ros-args", *asking, domain=domain) as client:
            text = client.rest()
        told = robot.end_with(signal.SIGINT)[1]

    assert [float(left) for left in re.findall(r"Feedback: (.*) m left", text)] == [0.3, 0.1, 0.0]
    assert "[navigate_client]: Result: 0.5 m travelled" in text
    assert client.process.returncode == 0
    warnings = [line for line in (text + told).splitlines() if "WARN" in line]
    assert [line for line in warnings if "[aionode.load]" not in line] == []


@pytest.mark.slow
def test_the_web_application_runs_where_it_is_copied_to(
    tmp_path: Path,
) -> None:
    """A reader takes one file, and has no package `examples`."""
    copied = shutil.copy(ROOT / "examples" / "web_control.py", tmp_path)
    script = "import runpy, sys; sys.modules['examples'] = None; runpy.run_path(sys.argv[1])"
    done = run(["-c", script, str(copied)], env=os.environ, timeout=50, cwd=tmp_path)

    assert (done.returncode, done.stderr) == (0, "")


def test_ctrl_c_at_the_client_stops_the_robot(domain: int) -> None:
    """A client that stops waiting cancels its goal, so the robot does not drive on."""
    program = "examples/navigate.py"
    with running(program, domain=domain) as robot:
        asking = ["--ros-args", "-p", "mode:=client", "-p", "x:=1000.0"]
        with running(program, *asking, domain=domain) as client:
            client.line_with("Feedback")
            status, text = client.end_with(signal.SIGINT)
        robot.line_with("Stopped")

    assert status == 0
    assert "Traceback" not in text


def test_ctrl_c_while_a_goal_is_worked_on_ends_cleanly(domain: int) -> None:
    """The goal is aborted, and no traceback is printed."""
    program = "examples/navigate.py"
    with running(program, domain=domain) as robot:
        asking = ["--ros-args", "-p", "mode:=client", "-p", "x:=1000.0"]
        with running(program, *asking, domain=domain) as client:
            client.line_with("Feedback")
            status, text = robot.end_with(signal.SIGINT)

    assert status == 0
    assert "Traceback" not in text


def test_a_wrong_mode_is_one_line_and_status_1() -> None:
    """The error for a mistyped parameter names the expected values."""
    with running("examples/service_client_server.py", "--ros-args", "-p", "mode:=sever") as program:
        text = program.rest()

    assert "mode: 'sever' given; expected 'server' or 'client'" in text
    assert program.process.returncode == 1


def test_ci_runs_every_example() -> None:
    """A new example cannot be merged untested."""
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")

    programs = {
        path.parent if (path.parent / "__main__.py").exists() else path.with_suffix("")
        for path in (ROOT / "aionode/examples").rglob("*.py")
        if path.stem != "__init__"
    }
    modules = [".".join(program.relative_to(ROOT).parts) for program in programs]
    files = [f"examples/{path.name}" for path in (ROOT / "examples").glob("*.py")]

    assert [each for each in modules + files if each not in script] == []


@pytest.fixture
async def web(aionode_context: Context) -> AsyncIterator[httpx.AsyncClient]:
    """An HTTP client of the web application."""
    listening = socket.create_server(("127.0.0.1", 0))
    # asyncio does not take it for one of TCP: answers in two parts would wait 40 ms each.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    config = uvicorn.Config(make_app(aionode_context), log_level="warning", loop="none")
    server = uvicorn.Server(config)
    port = listening.getsockname()[1]
    async with (
        asyncio.TaskGroup() as tasks,
        httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}") as client,
    ):
        tasks.create_task(server.serve(sockets=[listening]))
        yield client
        server.should_exit = True
    listening.close()


async def test_the_web_application_awaits_a_service(
    web: httpx.AsyncClient, node_factory: Callable[..., Node]
) -> None:
    """A web request becomes a service call, and the answer a web response."""

    def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    node_factory("adder").create_service(AddTwoInts, "/add_two_ints", add)

    response = await web.get("/add", params={"a": 10, "b": 25})

    assert response.json() == {"sum": 35}


async def test_the_web_application_streams_a_topic(
    web: httpx.AsyncClient, node_factory: Callable[..., Node]
) -> None:
    """Each message becomes an event in the browser."""
    publisher = node_factory("robot").create_publisher(String, "/robot/message", 10)

    async with web.stream("GET", "/messages") as response:
        lines = response.aiter_lines()
        assert await anext(lines) == ": listening"
        publisher.publish(String(data="hello"))
        events = [await anext(lines) for _ in range(2)]

    assert events == ["", 'data: {"data":"hello"}']


async def test_the_page_shows_the_stream(web: httpx.AsyncClient) -> None:
    """The page that a browser opens reads the events."""
    response = await web.get("/")

    assert 'EventSource("/messages")' in response.text


def test_a_driver_says_how_it_is(domain: int) -> None:
    """Its temperature, and how its scans are, on /diagnostics."""
    waits = ("--once", "--filter", "len(m.status) > 1")
    topic = ("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
    with (
        running("examples/diagnostics.py", domain=domain),
        running("-m", "aionode", "topic", "echo", *waits, *topic, domain=domain) as echo,
    ):
        text = echo.rest()

    assert "lidar: temperature" in text
    assert "as warm as it should be" in text
    assert "lidar: /scan topic status" in text
