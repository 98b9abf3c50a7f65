"""A ROS 2 node with one entity of each kind, for the live tests. It runs in ROS 2's own Python."""

import contextlib
import sys
from typing import Any

from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

KEPT = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD_S = 0.05


class Peer(Node):
    """Publishes, repeats what it receives, serves, and sends the requests that it is asked for."""

    def __init__(self) -> None:
        super().__init__("ros_peer")
        self.declare_parameter("speed", 3)
        group = ReentrantCallbackGroup()
        self.count = 0
        self.counter = self.create_publisher(String, "from_ros", 10)
        self.create_timer(PERIOD_S, self.tick, callback_group=group)
        self.echoed = self.create_publisher(String, "heard_by_ros", 10)
        self.create_subscription(String, "to_ros", self.echoed.publish, 10, callback_group=group)
        self.create_subscription(
            String, "kept_by_aionode", self.echoed.publish, KEPT, callback_group=group
        )
        self.kept = self.create_publisher(String, "kept_by_ros", KEPT)
        for number in range(5):
            self.kept.publish(String(data=f"kept {number}"))
        self.create_service(AddTwoInts, "ros_add", self.add, callback_group=group)
        self.adder = self.create_client(AddTwoInts, "aionode_add", callback_group=group)
        self.server = ActionServer(
            self,
            Fibonacci,
            "ros_fibonacci",
            self.execute,
            goal_callback=lambda goal: GoalResponse.ACCEPT,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            callback_group=group,
        )
        self.client = ActionClient(self, Fibonacci, "aionode_fibonacci", callback_group=group)
        self.create_subscription(String, "ask", self.ask, 10, callback_group=group)

    def tick(self) -> None:
        """Publish the next number, and let a goal that waits look whether it is canceled."""
        self.count += 1
        self.counter.publish(String(data=str(self.count)))

    def add(self, request: Any, response: Any) -> Any:
        """Serve /ros_add."""
        response.sum = request.a + request.b
        return response

    def execute(self, goal: Any) -> Any:
        """Succeed with a short sequence; wait for the cancel request if the order is 0."""
        rate = self.create_rate(20)
        while goal.request.order == 0 and not goal.is_cancel_requested:
            rate.sleep()
        result = Fibonacci.Result()
        if goal.is_cancel_requested:
            goal.canceled()
            return result
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
        goal.succeed()
        result.sequence = [0, 1, 1, 2, 3][: goal.request.order]
        return result

    async def ask(self, message: Any) -> None:
        """Call a service or send a goal of aionode's, and publish the answer."""
        if message.data == "call":
            self.adder.wait_for_service(timeout_sec=10)
            response = await self.adder.call_async(AddTwoInts.Request(a=2, b=40))
            self.echoed.publish(String(data=f"sum {response.sum}"))
            return
        self.client.wait_for_server(timeout_sec=10)
        order = 0 if message.data == "cancel" else 4
        goal = await self.client.send_goal_async(Fibonacci.Goal(order=order))
        if order == 0:
            await goal.cancel_goal_async()
        result = await goal.get_result_async()
        self.echoed.publish(String(data=f"goal {result.status} {list(result.result.sequence)}"))


def main() -> None:
    """Run until Ctrl-C."""
    rclpy.init(args=sys.argv)
    executor = MultiThreadedExecutor(4)
    executor.add_node(Peer())
    print("running", flush=True)  # noqa: T201  # what the tests wait for
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


main()
