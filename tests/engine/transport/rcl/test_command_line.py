"""What the command line prints about the graph of a process of real rclpy, over DDS."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from tests.support.ros import ros_domain, ros_missing, ros_peer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Answers = dict[str, Future[str]]

pytestmark = pytest.mark.skipif(bool(ros_missing()), reason=ros_missing() or "there is a ROS 2")

DOMAIN_OFFSET = 30
LIMIT_S = 100.0  # of one command: all of them wait for two processors

COMMANDS = {
    "topic list -t": r"/chatter \[std_msgs/msg/String\]",
    "topic info -v /map": r"Node name: peer\n(.*\n)*  Durability: TRANSIENT_LOCAL",
    "topic type /chatter": r"^std_msgs/msg/String",
    "topic find std_msgs/msg/UInt8MultiArray": r"^/large\n/large_echoed",
    "topic echo --once /chatter": r"^data: hello\n---",
    "topic echo --once /map": r"^data: '[234]'",
    "topic echo --once --qos-durability transient_local /map": r"^data: '[234]'",
    "topic pub --once /to_echo std_msgs/msg/String 'data: x'": r"publishing #1: .*data='x'",
    "node list": r"^/peer$",
    "node info /peer": r"Service Servers:\n    /add: test_msgs/srv/BasicTypes",
    "service list -t": r"/add \[test_msgs/srv/BasicTypes\]",
    "service type /add": r"^test_msgs/srv/BasicTypes",
    "service info /add": r"Services count: 1",
    "service call /add test_msgs/srv/BasicTypes 'int64_value: 3'": r"response:\n.*int64_value=4",
    "param list /peer": r"^  speed$",
    "param get /peer speed": r"^Double value is: 1.5",
    "param set /peer speed 1.5": r"^Set parameter successful",
    "param describe /peer speed": r"Type: double",
    "param dump /peer": r"^/peer:\n  ros__parameters:\n(.*\n)*    speed: 1.5",
    "action list -t": r"^/fibonacci \[test_msgs/action/Fibonacci\]",
    "action info /fibonacci": r"Action servers: 1\n    /peer",
    "action send_goal -f /fibonacci test_msgs/action/Fibonacci 'order: 4'": (
        r"Feedback:\n(.*\n)*Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n(.*\n)*"
        r"Goal finished with status: SUCCEEDED"
    ),
    "doctor": r"^Middleware: rmw_fastrtps_cpp \(transport rcl\)\n(.*\n)*Nodes: 1",
}
"""The commands, each with its expected output."""


def environment() -> dict[str, str]:
    """Return the environment of the commands."""
    return {
        **os.environ,
        "AIONODE_TRANSPORT": "rcl",
        "ROS_DOMAIN_ID": str(ros_domain(DOMAIN_OFFSET)),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "COLUMNS": "200",
    }


def command(text: str) -> list[str]:
    """Return the arguments of a process."""
    parts = [one.strip("'") for one in re.findall(r"'[^']*'|\S+", text)]
    return [sys.executable, "-W", "ignore", "-m", "aionode", *parts]


def run(text: str) -> str:
    """Return what a command prints to both streams."""
    found = subprocess.run(
        command(text),
        env=environment(),
        text=True,
        check=False,
        timeout=LIMIT_S,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    return found.stdout


@pytest.fixture(scope="module")
def answers() -> Iterator[Answers]:
    """Return the outputs of all commands, which run in parallel."""
    with ros_peer(ros_domain(DOMAIN_OFFSET)), ThreadPoolExecutor(4) as threads:
        yield {text: threads.submit(run, text) for text in COMMANDS}


@pytest.mark.timeout(200)
@pytest.mark.parametrize("text", COMMANDS)
def test_a_command_answers(answers: Answers, text: str) -> None:
    """The output is the same as over Zenoh."""
    printed = answers[text].result()
    assert re.search(COMMANDS[text], printed, re.MULTILINE), printed


@pytest.mark.timeout(200)
def test_the_rate_of_a_topic_is_measured(answers: Answers) -> None:
    """The command runs until it is interrupted."""
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command("topic hz /chatter"), env=environment(), stdout=pipe, text=True
    ) as process:
        try:
            assert process.stdout is not None
            lines: Callable[[], str] = process.stdout.readline
            assert any("average rate" in line for line in iter(lines, ""))
        finally:
            process.terminate()


@pytest.mark.timeout(200)
def test_a_parameter_that_was_set_is_read_back(answers: Answers) -> None:
    """Another process reads it back."""
    answers["param dump /peer"].result()
    assert "successful" in run("param set /peer use_sim_time false")
    assert "False" in run("param get /peer use_sim_time")
