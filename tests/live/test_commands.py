"""Each command of ros2's against the same one of aionode's, beside nodes of both."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.live.conftest import Run

PROGRAM = """
import aionode
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import qos_profile_sensor_data

class Robot(aionode.Node):
    def __init__(self):
        super().__init__("aionode_robot", namespace="/robot")
        self.declare_parameter("speed", 0.5)
        self.words = self.create_publisher(String, "words", 10)
        self.create_subscription(String, "orders", print, qos_profile_sensor_data)
        self.create_service(AddTwoInts, "add", lambda _, response: response)
        self.create_timer(0.05, lambda: self.words.publish(String(data="word")))

aionode.run(Robot)
"""

SAME = [
    "node list",
    "topic list",
    "topic list -t",
    "topic type /from_ros",
    "topic find std_msgs/msg/String",
    "topic info /robot/words",
    "topic info -v /robot/words",
    "topic info -v /robot/orders",
    "topic info -v /from_ros",
    "service list",
    "service list -t",
    "service type /robot/add",
    "service type /ros_add",
    "service find example_interfaces/srv/AddTwoInts",
    "action list -t",
    "action info /ros_fibonacci",
    "node info /ros_peer",
    "node info /robot/aionode_robot",
    "param list /ros_peer",
    "param list /robot/aionode_robot",
    "param get /ros_peer speed",
    "param get /robot/aionode_robot speed",
    "param describe /robot/aionode_robot speed",
    "param dump /robot/aionode_robot",
    "topic echo --once --field data /robot/words",
    "interface show example_interfaces/srv/AddTwoInts",
]


@pytest.fixture(scope="module")
def robot(peer: subprocess.Popen[str], environment: dict[str, str], aionode: Run) -> Iterator[None]:
    """A node of aionode's beside the one of ROS 2's."""
    with subprocess.Popen([sys.executable, "-c", PROGRAM], env=environment) as program:
        try:
            while "/robot/aionode_robot" not in aionode("node", "list").split():
                assert program.poll() is None
            yield
        finally:
            program.kill()


@pytest.mark.parametrize("command", SAME)
def test_both_print_the_same(robot: None, ros2: Run, aionode: Run, command: str) -> None:
    """They print the same for nodes of either."""
    assert plain(aionode(*command.split())) == plain(ros2(*command.split()))


@pytest.mark.parametrize("node", ["/ros_peer", "/robot/aionode_robot"])
def test_each_sets_parameters_of_the_other(robot: None, ros2: Run, aionode: Run, node: str) -> None:
    """Each reads what the other has set."""
    value = aionode("param", "get", node, "speed").split()[-1]
    for run, other in ((ros2, aionode), (aionode, ros2)):
        assert "successful" in run("param", "set", node, "speed", value)
        assert other("param", "get", node, "speed").split()[-1] == value


def plain(text: str) -> list[str]:
    """Return the lines in order, without what differs each time."""
    own = re.compile(r"^\s*/?_?ros2cli|/_ros2cli|aionode_cli|^WARNING|^$")
    return sorted(line.rstrip() for line in text.splitlines() if not own.search(line))
