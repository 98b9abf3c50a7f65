"""The checks of ros-mcp as agents use it, against robot.py: ``python ros_mcp_checks.py PORT``.

It runs in its own environment, which has ros-mcp but not aionode. Each tool is called as an agent
calls it; the answer has to contain the robot's data and no error.
"""

from __future__ import annotations

import asyncio
import sys
from typing import Any

from fastmcp import Client  # type: ignore[import-not-found]  # of its own environment
from ros_mcp.main import mcp  # type: ignore[import-not-found]

TYPE = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"
SPEED = "/add_two_ints_server:speed"

CALLS: list[tuple[str, dict[str, Any], str]] = [
    ("detect_ros_version", {}, "2"),
    ("get_topics", {}, "/listener"),
    ("get_topic_type", {"topic": "/listener"}, TYPE),
    ("get_topic_details", {"topic": "/listener"}, "/add_two_ints_server"),
    ("get_message_details", {"message_type": "geometry_msgs/msg/Twist"}, "linear"),
    ("subscribe_once", {"topic": "/listener", "msg_type": TYPE}, "Hello,World"),
    ("subscribe_for_duration", {"topic": "/listener", "msg_type": TYPE, "duration": 1}, "Hello"),
    ("publish_once", {"topic": "/chatter", "msg_type": TYPE, "msg": {"data": "hi"}}, "true"),
    ("get_nodes", {}, "/add_two_ints_server"),
    ("get_node_details", {"node": "/add_two_ints_server"}, "/listener"),
    ("get_services", {}, "/add_two_ints"),
    ("get_service_type", {"service": "/add_two_ints"}, ADD),
    ("get_service_details", {"service": "/add_two_ints"}, "sum"),
    (
        "call_service",
        {"service_name": "/add_two_ints", "service_type": ADD, "request": {"a": 1, "b": 2}},
        '"sum":3',
    ),
    ("get_actions", {}, "/fibonacci"),
    ("get_action_details", {"action": "/fibonacci", "action_type": FIBONACCI}, "order"),
    (
        "send_action_goal",
        {"action_name": "/fibonacci", "action_type": FIBONACCI, "goal": {"order": 3}},
        "[0,1,1,2]",
    ),
    ("get_parameters", {"node_name": "/add_two_ints_server"}, "speed"),
    ("get_parameter", {"name": SPEED}, "1.5"),
    ("has_parameter", {"name": SPEED}, "true"),
    ("set_parameter", {"name": SPEED, "value": "2.5"}, "true"),
    ("get_parameter_details", {"name": SPEED}, "2.5"),
]
"""A tool, its arguments, and a part of its answer as JSON without spaces."""


async def main(port: int) -> int:
    """Call each tool, and return how many failed."""
    failed = 0
    robot = {"ip": "127.0.0.1", "port": port}
    async with Client(mcp) as agent:
        await agent.call_tool("connect_to_robot", robot)  # which also calls the system's ping
        for name, arguments, expected in CALLS:
            answer = await agent.call_tool(name, arguments, raise_on_error=False)
            texts = (str(getattr(each, "text", "")) for each in answer.content)
            told = "".join(" ".join(texts).split())
            if answer.is_error or '"error":' in told or expected not in told:
                failed += 1
                sys.stderr.write(f"{name}: {told}\n")
    return failed


if __name__ == "__main__":
    sys.exit(asyncio.run(main(int(sys.argv[1]))))
