"""Callbacks of rclpy's API have causes, as those of aionode's nodes do."""

from __future__ import annotations

from typing import Any

import pytest

import message_filters
import rclpy
from aionode.engine.causes import CauseLog
from aionode.interfaces.geometry_msgs.msg import PointStamped
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.interfaces.std_srvs.srv import Trigger
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Robot(Node):
    """Sends on what it gets, in several ways, and remembers it."""

    def __init__(self, context: rclpy.context.Context) -> None:
        super().__init__("robot", context=context)
        self.out = {
            name: self.create_publisher(String, name, 10) for name in ("scan", "plan", "drive")
        }
        self.ask = self.create_client(Trigger, "ask", callback_group=ReentrantCallbackGroup())
        self.done: Future[Any] = Future()
        # A group of its own: the callback that waits for the answer keeps the node's.
        group = ReentrantCallbackGroup()
        self.create_service(Trigger, "ask", self.on_ask, callback_group=group)
        self.create_subscription(String, "scan", self.on_scan, 10)
        self.create_subscription(String, "plan", self.on_plan, 10)
        self.ticks = self.create_timer(0.01, self.on_tick)

    def on_tick(self) -> None:
        """Begin."""
        self.ticks.cancel()
        self.out["scan"].publish(String())

    def on_scan(self, message: String) -> None:
        """Send it on."""
        self.out["plan"].publish(message)

    async def on_plan(self, message: String) -> None:
        """Ask before it is sent on."""
        await self.ask.call_async(Trigger.Request())
        self.out["drive"].publish(message)
        self.done.set_result(None)

    def on_ask(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Answer."""
        return response


@pytest.mark.parametrize("executor_type", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_spun_callbacks_have_causes(
    executor_type: type[SingleThreadedExecutor], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Timers, messages, requests and responses, whichever thread calls."""
    monkeypatch.setenv("AIONODE_CAUSES", "1")
    context = rclpy.context.Context()
    rclpy.init(context=context)
    try:
        robot = Robot(context)
        executor = executor_type(context=context)
        executor.add_node(robot)
        executor.spin_until_future_complete(robot.done, 10.0)
        log = robot.handle.bare.context.causes
    finally:
        rclpy.shutdown(context=context)

    assert isinstance(log, CauseLog)
    found = {}
    for sent in log.sent:
        found[sent.kind, sent.party.name] = [
            (run.party.callback().rpartition(".")[2], run.kind) for run in sent.causes
        ]
    assert found["message", "/scan"] == [("on_tick", "timer")]
    assert found["message", "/plan"] == [("on_scan", "message")]
    assert found["request", "/ask"] == [("on_plan", "message")]
    assert found["response", "/ask"] == [("on_ask", "request")]
    assert found["message", "/drive"] == [("on_plan", "message"), ("", "response")]
    assert {"on_tick", "on_scan", "on_ask"} <= {
        run.party.callback().rpartition(".")[2] for run in log.runs
    }


class Pairing(Node):
    """Publishes for each pair of messages, and remembers it."""

    def __init__(self, context: rclpy.context.Context) -> None:
        super().__init__("pairing", context=context)
        self.done: Future[Any] = Future()
        self.both = self.create_publisher(Header, "both", 10)
        self.inputs = [self.create_publisher(PointStamped, name, 10) for name in ("left", "right")]
        filters = [
            message_filters.Subscriber(self, PointStamped, name) for name in ("left", "right")
        ]
        self.pairs = message_filters.TimeSynchronizer(filters, 10)
        self.pairs.registerCallback(self.on_pair)
        self.ticks = self.create_timer(0.01, self.on_tick)

    def on_tick(self) -> None:
        """Send both, one after the other."""
        self.ticks.cancel()
        for publisher in self.inputs:
            publisher.publish(PointStamped())

    def on_pair(self, left: PointStamped, _: PointStamped) -> None:
        """Publish what both have caused."""
        self.both.publish(left.header)
        self.done.set_result(None)


def test_a_pair_has_two_causes(monkeypatch: pytest.MonkeyPatch) -> None:
    """The message that completes a pair is only one of them."""
    monkeypatch.setenv("AIONODE_CAUSES", "1")
    context = rclpy.context.Context()
    rclpy.init(context=context)
    try:
        pairing = Pairing(context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(pairing)
        executor.spin_until_future_complete(pairing.done, 10.0)
        log = pairing.handle.bare.context.causes
    finally:
        rclpy.shutdown(context=context)

    assert isinstance(log, CauseLog)
    (sent,) = [each for each in log.sent if each.party.name == "/both"]
    assert {run.party.name for run in sent.causes} == {"/left", "/right"}
