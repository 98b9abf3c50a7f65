"""Transforms between a program of tf2 and a node of aionode, both ways."""

from __future__ import annotations

import asyncio

import pytest

from aionode import Node
from aionode.clock import Time
from aionode.errors import LookupException
from aionode.tf import Buffer, BufferServer, StaticTransformBroadcaster, TransformBroadcaster
from rclpy.duration import Duration
from rclpy.node import Node as RclpyNode
from rclpy.time import Time as RclpyTime
from rosidl_generator_py import from_aionode
from tests.rclpy.test_interoperation import Side, alone, native, side
from tests.support.transforms import senders, transform
from tf2_ros import (
    Buffer as ProgramsBuffer,
)
from tf2_ros import BufferClient as ProgramsClient
from tf2_ros import (
    StaticTransformBroadcaster as ProgramsStaticBroadcaster,
)
from tf2_ros import TransformBroadcaster as ProgramsBroadcaster
from tf2_ros import TransformListener as ProgramsListener

__all__ = ["alone", "native", "side"]  # the fixtures

PATIENCE_S = 20.0

pytestmark = pytest.mark.one_loop


async def test_a_node_has_the_transforms_of_a_program(native: Node, side: Side) -> None:
    """Including static ones, although it starts late; the program is named as their sender."""
    program = side.add(RclpyNode("program", context=side.context))
    ProgramsStaticBroadcaster(program).sendTransform(from_aionode(transform("base", "camera")))
    moving = ProgramsBroadcaster(program)
    buffer = Buffer(native)
    await buffer.wait_for_transform("base", "camera", timeout_sec=PATIENCE_S)

    def send() -> None:
        for stamp in (1.0, 2.0):
            moving.sendTransform(from_aionode(transform("odom", "base", stamp)))

    program.create_timer(0.1, send)
    at = Time(nanoseconds=1_500_000_000)
    found = await buffer.wait_for_transform("odom", "camera", at, timeout_sec=PATIENCE_S)
    assert found.transform.translation.x == 2.0
    assert senders(buffer) == {"/program"}


async def test_a_program_has_the_transforms_of_a_node(native: Node, side: Side) -> None:
    """By its listener, in a waiting thread, and by the server of the node."""
    StaticTransformBroadcaster(native).sendTransform(transform("base", "camera"))
    moving = TransformBroadcaster(native)
    buffer = Buffer(native)
    BufferServer(buffer, native)
    program = side.add(RclpyNode("program", context=side.context))
    known = ProgramsBuffer()
    listener = ProgramsListener(known, program)
    native.create_timer(0.1, lambda: moving.sendTransform(transform("odom", "base", 1.0)))
    found = await asyncio.to_thread(
        known.lookup_transform, "odom", "camera", RclpyTime(), Duration(seconds=PATIENCE_S)
    )
    assert found.transform.translation.x == 2.0

    client = ProgramsClient(program, "tf2_buffer_server")
    assert await asyncio.to_thread(client.action_client.wait_for_server, PATIENCE_S)
    asked = await asyncio.to_thread(
        client.lookup_transform, "odom", "camera", RclpyTime(), Duration(seconds=1)
    )
    assert asked.transform.translation.x == 2.0
    with pytest.raises(LookupException):
        await asyncio.to_thread(client.lookup_transform, "odom", "nobody", RclpyTime())
    listener.unregister()
    client.destroy()
