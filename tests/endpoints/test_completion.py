"""Completion on each object of a node offers the names for users, and no others."""

from __future__ import annotations

import inspect
import re
from enum import Enum
from typing import TYPE_CHECKING, Any

import pytest

import aionode
from aionode.action import CancelResponse, GoalResponse
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String

if TYPE_CHECKING:
    from aionode.node import Node

ENTITY = {"destroy", "destroyed"}
OFFERED = {
    "Publisher": ENTITY
    | {
        "drain",
        "get_subscription_count",
        "lease",
        "msg_type",
        "publish",
        "qos_profile",
        "stats",
        "topic",
    }
    | {"assert_liveliness", "events", "topic_name", "wait_for_subscribers"},
    "Subscription": ENTITY
    | {
        "callback",
        "events",
        "get_content_filter",
        "get_publisher_count",
        "is_cft_enabled",
        "msg_type",
        "qos_profile",
        "raw",
        "receive",
        "set_content_filter",
        "stats",
    }
    | {"topic", "topic_name"},
    "Service": ENTITY
    | {"callback", "configure_introspection", "qos_profile", "service_name", "srv_name", "srv_type"}
    | {"stats"},
    "Client": ENTITY
    | {"call", "call_async", "qos_profile", "service_is_ready", "service_name", "srv_name"}
    | {"configure_introspection", "srv_type", "stats", "wait_for_service"},
    "Timer": ENTITY
    | {"callback", "cancel", "clock", "is_canceled", "is_ready", "reset", "stats"}
    | {"time_since_last_call", "time_until_next_call", "timer_period_ns"},
    "Rate": ENTITY | {"sleep"},
    "ActionServer": ENTITY
    | {"action_name", "action_type", "configure_introspection"}
    | {"register_cancel_callback", "register_execute_callback"}
    | {"register_goal_callback", "register_handle_accepted_callback", "stats"},
    "ActionClient": ENTITY
    | {"action_name", "action_type", "call", "send_goal", "send_goal_async", "server_is_ready"}
    | {"configure_introspection", "wait_for_server"},
    "ServerGoalHandle": {"abort", "canceled", "execute", "goal_id", "info", "is_active"}
    | {"is_cancel_requested", "publish_feedback", "request", "status", "succeed", "text"},
    "ClientGoalHandle": {"accepted", "cancel", "cancel_goal_async", "done", "get_result_async"}
    | {"goal_id", "reason", "result", "stamp", "status", "text"},
    "ActionResult": {"error_text", "result", "status"},
    "TimerInfo": {"actual_call_time", "expected_call_time"},
    "CallbackContext": {"entity", "node", "subject"},
}
"""The names on a node's objects, including attributes of instances."""

CLASSES = [
    name
    for name in sorted(aionode.__all__)
    if inspect.isclass(owner := getattr(aionode, name)) and not issubclass(owner, Enum)
]


@pytest.fixture
async def objects(node: Node) -> dict[str, Any]:
    """One object of each class, of a node that runs."""
    made: dict[str, Any] = {}

    def execute(goal: Any) -> Fibonacci.Result:
        made["ServerGoalHandle"] = goal
        goal.succeed()
        return Fibonacci.Result()

    made["Publisher"] = node.create_publisher(String, "chatter", 10)
    made["Subscription"] = node.create_subscription(String, "chatter", print)
    made["Service"] = node.create_service(AddTwoInts, "add", lambda _, response: response)
    made["Client"] = node.create_client(AddTwoInts, "add")
    made["Timer"] = node.create_timer(100, print)
    made["Rate"] = node.create_rate(1)
    made["ActionServer"] = node.create_action_server(
        Fibonacci,
        "fibonacci",
        execute,
        goal_callback=lambda _: GoalResponse.ACCEPT,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
    )
    made["ActionClient"] = node.create_action_client(Fibonacci, "fibonacci")
    made["ClientGoalHandle"] = await made["ActionClient"].send_goal(Fibonacci.Goal())
    made["ActionResult"] = await made["ClientGoalHandle"].result()
    made["TimerInfo"] = aionode.TimerInfo(
        expected_call_time=0, actual_call_time=0, clock_type=node.get_clock().clock_type
    )
    made["CallbackContext"] = aionode.CallbackContext("/node", "timer of 1 s", made["Timer"])
    return made


@pytest.mark.parametrize("name", OFFERED)
async def test_completion_offers_what_is_for_users(name: str, objects: dict[str, Any]) -> None:
    """The rest begins with an underscore, so that no program comes to depend on it."""
    found = {each for each in dir(objects[name]) if not each.startswith("_")}

    assert found == OFFERED[name]


def test_what_completion_offers_is_documented() -> None:
    """The reference shows every class whole, without a list of exceptions."""
    bare = []
    for name in CLASSES:
        owner = getattr(aionode, name)
        offered = OFFERED.get(name, {each for each in dir(owner) if not each.startswith("_")})
        bare += [f"{name}.{each}" for each in sorted(offered) if not is_documented(owner, each)]

    assert bare == []


def is_documented(owner: type, name: str) -> bool:
    """Return whether a member has a docstring, or its class or a base describes it as a field.

    What every exception has is Python's.
    """
    if issubclass(owner, BaseException) and hasattr(BaseException, name):
        return True
    member = inspect.getattr_static(owner, name, None)
    is_described = inspect.isroutine(member) or inspect.isclass(member)
    if (is_described or isinstance(member, property)) and inspect.getdoc(member):
        return True
    listed = rf"^\s+{name}: "
    return any(re.search(listed, each.__doc__ or "", re.MULTILINE) for each in owner.__mro__)
