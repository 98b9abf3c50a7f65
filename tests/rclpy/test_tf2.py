"""`tf2_ros` and its neighbours, as programs of rclpy use them."""

from __future__ import annotations

import os
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tf2_geometry_msgs as _tf2_geometry_msgs
import tf2_py as _tf2_py
import tf2_ros as _tf2_ros
import tf2_sensor_msgs as _tf2_sensor_msgs
from aionode.errors import LookupException as OwnLookupException
from aionode.tf.waiters import Waiter
from rclpy.duration import Duration
from rclpy.time import Time
from rosidl_generator_py import message_class
from tests.support import fork_server
from tests.support.living import living
from tf2_py import BufferCore, ExtrapolationException, LookupException
from tf2_ros import Buffer, TransformRegistration, TypeException, convert

TransformStamped = message_class("geometry_msgs/msg/TransformStamped")
PointStamped = message_class("geometry_msgs/msg/PointStamped")
Pose = message_class("geometry_msgs/msg/Pose")

PROGRAM = """\
import threading

import rclpy
from geometry_msgs.msg import PointStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import (
    Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformException, TransformListener,
)
import tf2_geometry_msgs

rclpy.action.ActionServer  # tf2_ros has imported that module


def stamped(parent, child, stamp):
    msg = TransformStamped()
    msg.header.frame_id, msg.child_frame_id, msg.header.stamp = parent, child, stamp
    msg.transform.translation.x = 1.0
    return msg


class Program(Node):
    def __init__(self):
        super().__init__("program")
        self.buffer = Buffer(node=self)
        self.listener = TransformListener(self.buffer, self)
        self.broadcaster = TransformBroadcaster(self)
        StaticTransformBroadcaster(self).sendTransform(
            stamped("base", "camera", self.get_clock().now().to_msg()))
        self.create_timer(0.02, self.send)

    def send(self):
        self.broadcaster.sendTransform(stamped("map", "base", self.get_clock().now().to_msg()))


rclpy.init()
node = Program()
try:
    node.buffer.lookup_transform("map", "camera", Time())
except TransformException as error:
    print(type(error).__name__)
executor = MultiThreadedExecutor()
executor.add_node(node)
thread = threading.Thread(target=executor.spin, daemon=True)
thread.start()
found = node.buffer.lookup_transform("map", "camera", Time(), timeout=Duration(seconds=20))
print(found.transform.translation.x, type(found) is TransformStamped)
point = PointStamped()
point.header.frame_id = "camera"
print(node.buffer.transform(point, "map").point.x)
future = node.buffer.wait_for_transform_async("map", "camera", node.get_clock().now())
done = threading.Event()
future.add_done_callback(lambda _: done.set())
print(done.wait(20), future.result().child_frame_id)
executor.shutdown()
rclpy.shutdown()
"""


def stamped(parent: str, child: str, seconds: float = 1.0) -> Any:
    """Return a transform by 1 along x."""
    msg = TransformStamped(child_frame_id=child)
    msg.header.frame_id = parent
    msg.header.stamp = Time(seconds=seconds).to_msg()
    msg.transform.translation.x = 1.0
    return msg


@pytest.mark.processes
def test_a_program_of_tf2_runs_unchanged(tmp_path: Path) -> None:
    """Listener, broadcasters, a wait that blocks its thread, a conversion and a future."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM, encoding="utf-8")
    run = fork_server.run(["-m", "aionode.rclpy", str(program)], env=os.environ, timeout=50)
    assert run.stdout.splitlines() == ["LookupException", "2.0 True", "2.0", "True camera"], (
        run.stderr
    )


def test_the_core_gives_messages_times_and_errors_of_rclpys_kind() -> None:
    """`except tf2_ros.ExtrapolationException` and comparisons of types work."""
    core = BufferCore(Duration(seconds=10))
    one = stamped("a", "b")
    assert core.set_transform(one, "me") is None
    assert core.lookup_transform_core("a", "b", Time()) == one
    assert core.get_latest_common_time("a", "b") == Time(seconds=1)
    with pytest.raises(ExtrapolationException) as caught:
        core.lookup_transform_core("a", "b", Time(seconds=5))
    assert type(caught.value) is ExtrapolationException
    with pytest.raises(LookupException):
        core.lookup_transform_core("a", "c", Time())
    assert LookupException is OwnLookupException
    assert {name for name in _tf2_py.__all__ if name.endswith("Exception")} < set(_tf2_ros.__all__)


def test_a_wait_with_a_limit_ends_as_soon_as_the_transform_is_there() -> None:
    """tf2_ros polls every 20 ms; a limit that passes is not an error by itself."""
    buffer = Buffer()
    assert not buffer.can_transform("a", "b", Time(), timeout=Duration(nanoseconds=1))
    timer = threading.Timer(0.01, lambda: buffer.set_transform(stamped("a", "b"), "me"))
    timer.start()
    try:
        assert buffer.can_transform("a", "b", Time(), timeout=Duration(seconds=30))
    finally:
        timer.join()
    assert buffer.can_transform_full("a", Time(), "b", Time(), "a", return_debug_tuple=True) == (
        True,
        "",
    )


def test_a_future_gets_the_transform_and_is_forgotten_when_it_is_cancelled() -> None:
    """In tf2_ros, each transform asks every future again, even those that nobody waits for."""
    waiters = living(Waiter)
    buffer = Buffer()
    future = buffer.wait_for_transform_async("a", "b", Time(seconds=1))
    full = buffer.wait_for_transform_full_async("a", Time(seconds=1), "b", Time(seconds=1), "a")
    given_up = buffer.wait_for_transform_async("a", "never", Time())
    given_up.cancel()
    coroutine = buffer.lookup_transform_async("a", "b", Time(seconds=1))
    coroutine.send(None)
    buffer.set_transform(stamped("a", "b"), "me")
    assert future.result() == full.result() == stamped("a", "b")
    with pytest.raises(StopIteration) as ended:
        coroutine.send(None)
    assert ended.value.value == stamped("a", "b")
    assert living(Waiter) <= waiters


def test_what_is_there_is_awaited_without_a_turn() -> None:
    """For one time and for two, and with the program's own cache time."""
    buffer = Buffer(cache_time=Duration(seconds=10.0))
    buffer.set_transform(stamped("a", "b"), "me")
    time = Time(seconds=1)
    for coroutine in (
        buffer.lookup_transform_async("a", "b", time),
        buffer.lookup_transform_full_async("a", time, "b", time, "a"),
    ):
        with pytest.raises(StopIteration) as ended:
            coroutine.send(None)
        assert ended.value.value == stamped("a", "b")


def test_a_wait_for_two_times_is_resumed_when_the_transform_is_there() -> None:
    """By the one who has sent the coroutine, like an executor."""
    buffer = Buffer()
    time = Time(seconds=1)
    coroutine = buffer.lookup_transform_full_async("a", time, "b", time, "a")
    coroutine.send(None)
    buffer.set_transform(stamped("a", "b"), "me")
    with pytest.raises(StopIteration) as ended:
        coroutine.send(None)
    assert ended.value.value == stamped("a", "b")


def test_registered_types_are_transformed_and_converted() -> None:
    """Importing tf2_geometry_msgs registers its types."""
    buffer = Buffer()
    buffer.set_transform_static(stamped("a", "b"), "me")
    point = PointStamped()
    point.header.frame_id = "b"
    assert buffer.transform(point, "a").point.x == 1.0
    assert buffer.transform_full(point, "a", Time(), "a", new_type=PointStamped).point.x == 1.0
    assert convert(point, PointStamped) == point
    with pytest.raises(TypeException):
        TransformRegistration().get(int)
    moved = _tf2_geometry_msgs.do_transform_pose(Pose(), stamped("a", "b"))
    assert (moved.position.x, moved.orientation.w) == (1.0, 1.0)
    covariance = _tf2_geometry_msgs.transform_covariance([1.0] * 36, stamped("a", "b"))
    assert list(covariance) == [1.0] * 36


def test_points_are_moved_in_bulk() -> None:
    """By just a Transform."""
    transform = stamped("a", "b").transform
    points = _tf2_sensor_msgs.transform_points(np.array([[1.0, 2.0, 3.0]]), transform)
    assert points.tolist() == [[2.0, 2.0, 3.0]]
