"""A plain rclpy program for tests: it serves, echoes, and obeys commands on a topic.

Commands are strings on ``/commands``, such as ``call 7``; the results go to ``/results``.
"""

from __future__ import annotations

import sys
import threading
from contextlib import suppress
from functools import partial
from typing import Any

from std_msgs.msg import String, UInt8MultiArray
from test_msgs.action import Fibonacci
from test_msgs.srv import BasicTypes
from type_description_interfaces.srv import GetTypeDescription

import rclpy  # it plays the other process
from rclpy.action import (  # the same
    ActionClient,
    ActionServer,
    CancelResponse,
)
from rclpy.callback_groups import ReentrantCallbackGroup  # the same
from rclpy.duration import Duration  # the same
from rclpy.event_handler import SubscriptionEventCallbacks  # the same
from rclpy.executors import (  # the same
    ExternalShutdownException,
    MultiThreadedExecutor,
)
from rclpy.node import Node  # the same
from rclpy.parameter import Parameter  # the same
from rclpy.parameter_client import AsyncParameterClient  # the same
from rclpy.qos import (  # the same
    DurabilityPolicy,
    LivelinessPolicy,
    QoSProfile,
)
from rclpy.task import Future  # the same

MOMENT = Duration(nanoseconds=100_000_000)


class Peer(Node):
    """The node ``/peer``."""

    def __init__(self) -> None:
        super().__init__("peer", namespace="")
        self.declare_parameter("speed", 1.5)
        group = ReentrantCallbackGroup()
        self.results = self.create_publisher(String, "results", 100)
        self.create_subscription(String, "commands", self.obey, 100, callback_group=group)
        self.echoed = self.create_publisher(String, "echoed", 100)
        self.create_subscription(String, "to_echo", self.echoed.publish, 100)
        self.large = self.create_publisher(UInt8MultiArray, "large_echoed", 10)
        self.create_subscription(UInt8MultiArray, "large", self.large.publish, 10)
        kept = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.map = self.create_publisher(String, "map", kept)
        for number in range(5):
            self.map.publish(String(data=str(number)))
        chatter = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.05, lambda: chatter.publish(String(data="hello")))
        self.hurried = self.create_publisher(
            String, "hurried", QoSProfile(depth=1, deadline=MOMENT)
        )
        self.watch("ours/beat")
        self.create_service(BasicTypes, "add", add)
        self.create_service(BasicTypes, "silent", never, callback_group=group)
        self.client = self.create_client(BasicTypes, "ours/add", callback_group=group)
        self.server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            self.execute,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            callback_group=group,
        )
        self.goals = ActionClient(self, Fibonacci, "ours/fibonacci", callback_group=group)
        self.parameters = AsyncParameterClient(self, "ours")

    def watch(self, topic: str) -> None:
        """Publish the events of a subscription with strict requirements on ``/events``."""
        events = self.create_publisher(String, "events", 100)

        def tell(event: str) -> None:
            events.publish(String(data=event))

        profile = QoSProfile(
            depth=1,
            deadline=MOMENT,
            liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
            liveliness_lease_duration=MOMENT,
        )
        callbacks = SubscriptionEventCallbacks(
            deadline=lambda event: tell("deadline"),
            liveliness=lambda event: tell(f"alive {event.alive_count}"),
            incompatible_qos=lambda event: tell(f"incompatible {event.last_policy_kind.name}"),
            matched=lambda event: tell(f"matched {event.current_count}"),
        )
        self.create_subscription(
            String, topic, lambda message: tell("message"), profile, event_callbacks=callbacks
        )

    async def obey(self, command: Any) -> None:
        """Execute a command."""
        word, _, value = command.data.partition(" ")
        await getattr(self, word)(value)

    def tell(self, result: object) -> None:
        """Publish a result."""
        self.results.publish(String(data=str(result)))

    async def call(self, value: str) -> None:
        """Call the service of the test."""
        self.client.wait_for_service()
        answer = await self.client.call_async(BasicTypes.Request(int64_value=int(value)))
        self.tell(answer.int64_value)

    async def goal(self, order: str) -> None:
        """Send a goal to the test."""
        self.goals.wait_for_server()
        goal = await self.goals.send_goal_async(Fibonacci.Goal(order=int(order)))
        result = await goal.get_result_async()
        self.tell((result.status, list(result.result.sequence)))

    async def cancel(self, order: str) -> None:
        """Send a goal to the test, and cancel it."""
        self.goals.wait_for_server()
        goal = await self.goals.send_goal_async(Fibonacci.Goal(order=int(order)))
        await goal.cancel_goal_async()
        result = await goal.get_result_async()
        self.tell(result.status)

    async def speed(self, value: str) -> None:
        """Set a parameter of the test's node."""
        self.parameters.wait_for_services()
        parameter = Parameter("speed", value=float(value)).to_parameter_msg()
        answer = await self.parameters.set_parameters([parameter])
        self.tell(answer.results[0].successful)

    async def hurry(self, text: str) -> None:
        """Publish once on a topic with a deadline."""
        self.hurried.publish(String(data=text))
        self.tell(text)

    async def described(self, type_name: str) -> None:
        """Request the description of a type from the test's node."""
        client = self.create_client(GetTypeDescription, "ours/get_type_description")
        client.wait_for_service()
        answer = await client.call_async(GetTypeDescription.Request(type_name=type_name))
        fields = [one.name for one in answer.type_description.type_description.fields]
        self.tell((answer.successful, fields))

    async def knows(self, name: str) -> None:
        """Report when a node has appeared."""
        while name not in self.get_node_names():
            self.create_rate(50).sleep()
        self.tell("known")

    async def leaves(self, name: str) -> None:
        """Report when a node has left."""
        while name in self.get_node_names():
            self.create_rate(50).sleep()
        self.tell("gone")

    async def execute(self, goal: Any) -> Any:
        """Execute a goal; one of order 0 runs until it is cancelled."""
        feedback = Fibonacci.Feedback(sequence=[0, 1])
        goal.publish_feedback(feedback)
        rate = self.create_rate(100)
        while goal.request.order == 0 and not goal.is_cancel_requested:
            rate.sleep()
        if goal.is_cancel_requested:
            goal.canceled()
            return Fibonacci.Result()
        sequence = [0, 1]
        for _ in range(goal.request.order - 2):
            sequence.append(sequence[-1] + sequence[-2])
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


def add(request: Any, response: Any) -> Any:
    """Answer a request."""
    response.int64_value = request.int64_value + 1
    return response


async def never(request: Any, response: Any) -> Any:
    """Receive a request without answering it."""
    await Future()
    return response


def main() -> None:
    """Spin until stdin is closed, and end like an interrupted rclpy program."""
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    peer = Peer()
    executor.add_node(peer)
    executor.create_task(partial(print, "ready", flush=True))
    threading.Thread(target=shut_down_at_end, daemon=True).start()
    with suppress(ExternalShutdownException):
        executor.spin()
    peer.destroy_node()


def shut_down_at_end() -> None:
    """End the executor when stdin is closed."""
    sys.stdin.read()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
