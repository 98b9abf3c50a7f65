"""Movers and wheels as a plain rclpy program, for aionode's rclpy or a real ROS 2.

``rclpy_program.py ROLE``; lines on stdin cause trouble, as for `tests.faults.motion.mover`.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from contextlib import suppress
from typing import Any

import msgspec
from geometry_msgs.msg import Twist
from test_msgs.action import Fibonacci

import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from tests.faults.motion.words import Handed, Mover, What, Wheel
from tests.faults.roles import REPORTS_VARIABLE, Report, Role

__all__: list[str] = []

REPORT_S = 0.1


class Program:
    """The node of such a program, and its reports."""

    def __init__(self, role: Role, node: Any) -> None:
        self.node = node
        self.handed: list[Handed] = []
        self.telling = threading.Lock()
        self.group = ReentrantCallbackGroup()
        self.troubles: list[tuple[str, float]] = []
        for wheel in role.wheels:
            (self.serve if wheel.action else self.subscribe)(wheel)
        if role.mover is not None:
            (self.send_goal if role.mover.asks == "goal" else self.publish)(role.mover)
            node.create_timer(0.01, self.run_into_trouble)
        for work in (self.report, self.obey):
            threading.Thread(target=work, daemon=True).start()

    # Reports and troubles

    def tell(self) -> None:
        """Report what the wheels have received since the last report."""
        with self.telling:
            handed, self.handed = self.handed, []
            report = Report(time_s=time.monotonic(), ready=True, handed=handed)
            os.write(int(os.environ[REPORTS_VARIABLE]), msgspec.json.encode(report) + b"\n")

    def report(self) -> None:
        """Report repeatedly."""
        while True:
            self.tell()
            time.sleep(REPORT_S)

    def note(self, topic: str, what: What, by: int = 0, sent_s: float = 0.0) -> None:
        """Record what the wheels have received."""
        with self.telling:
            self.handed.append(Handed(topic, what, time.monotonic(), by, sent_s))
        if what != "move":
            self.tell()

    def obey(self) -> None:
        """Read lines that cause trouble."""
        for line in sys.stdin:
            word, _, seconds = line.strip().partition(" ")
            self.troubles.append((word, float(seconds or 0.0)))

    def run_into_trouble(self) -> None:
        """Cause, in a callback, the trouble named on stdin."""
        if not self.troubles:
            return
        word, seconds = self.troubles.pop()
        if word == "fail":
            raise RuntimeError("the sensor is broken")
        if word == "exit":
            os._exit(3)
        if word == "sleep":
            time.sleep(seconds)

    # Movers

    def publish(self, mover: Mover) -> None:
        """Publish commands, from now on."""
        publisher = self.node.create_publisher(Twist, mover.topic, 10)

        def command() -> None:
            msg = Twist()
            msg.linear.x, msg.linear.y = 1.0, time.monotonic()
            msg.angular.x = float(os.getpid())
            publisher.publish(msg)

        self.node.create_timer(mover.period_s, command)

    def send_goal(self, mover: Mover) -> None:
        """Send a goal when there is a server."""
        client: Any = ActionClient(self.node, Fibonacci, mover.topic)

        def send() -> None:
            if client.server_is_ready():
                timer.cancel()
                client.send_goal_async(Fibonacci.Goal(order=os.getpid()))

        timer = self.node.create_timer(0.1, send)

    # Wheels

    def subscribe(self, wheel: Wheel) -> None:
        """Obey messages."""

        def take(msg: Any) -> None:
            what: What = "stop" if msg.linear.x == 0.0 else "move"
            self.note(wheel.topic, what, int(msg.angular.x), msg.linear.y)

        self.node.create_subscription(Twist, wheel.topic, take, 10)

    def serve(self, wheel: Wheel) -> None:
        """Obey goals."""

        def drive(goal: Any) -> Any:
            by = goal.request.order
            while not goal.is_cancel_requested and rclpy.ok():
                self.note(wheel.topic, "move", by, time.monotonic())
                time.sleep(0.05)
            self.note(wheel.topic, "stop", by)
            goal.canceled()
            return Fibonacci.Result()

        self.servers: Any = ActionServer(
            self.node,
            Fibonacci,
            wheel.topic,
            drive,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=self.group,
        )


def main() -> None:
    """Run until a signal or a failure."""
    role = msgspec.json.decode(sys.argv[1], type=Role)
    rclpy.init(args=[])
    node = rclpy.create_node(role.name, enable_rosout=False, start_parameter_services=False)
    Program(role, node)
    executor = MultiThreadedExecutor(16) if role.wheels else None
    try:
        rclpy.spin(node, executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        with suppress(Exception):
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
