"""The individual cases of tf2_ros's buffer and listener tests; see also `test_buffer`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from aionode import Node, Time
from aionode.clock import Duration
from aionode.errors import ExtrapolationException, GoalAbortedError
from aionode.interfaces.tf2_msgs.action import LookupTransform
from aionode.interfaces.tf2_msgs.msg import TF2Error
from aionode.testing import settle
from aionode.tf import (
    Buffer,
    BufferCore,
    BufferServer,
    StaticTransformBroadcaster,
    TransformBroadcaster,
)
from tests.support.transforms import transform


def at(seconds: float) -> Time:
    """Return a time."""
    return Time(nanoseconds=round(seconds * 1e9))


@pytest.mark.parametrize("stamps", [range(1, 11), range(10, 0, -1)])
async def test_a_wait_ends_with_the_sample_of_its_time(node: Node, stamps: range) -> None:
    """This holds even if the sample is older than those that arrived before it."""
    buffer = Buffer(node)
    loop = asyncio.get_running_loop()
    task = loop.create_task(buffer.wait_for_transform("a", "b", at(stamps[-1])))
    for stamp in stamps:
        await settle()
        assert not task.done()
        buffer.set_transform(transform("a", "b", stamp), "me")
    assert (await task).header.stamp.sec == stamps[-1]


@pytest.mark.parametrize("full", [False, True])
async def test_what_is_there_is_returned_without_a_turn_of_the_loop(node: Node, full: bool) -> None:
    """This holds for one time and for two, whatever the cache time is."""
    buffer = Buffer(node, cache_time=Duration(seconds=20.0))
    one = transform("foo", "bar", 5.0, (42.0, -3.14, 0.0))
    buffer.set_transform(one, "me")
    wait = (
        buffer.wait_for_transform_full("foo", at(5), "bar", at(5), "foo")
        if full
        else buffer.wait_for_transform("foo", "bar", at(5))
    )
    with pytest.raises(StopIteration) as ended:
        wait.send(None)
    assert ended.value.value == one
    assert buffer.lookup_transform("foo", "bar", at(5)) == one


async def test_what_is_broadcast_is_what_is_looked_up(node_factory: Callable[..., Node]) -> None:
    """Samples may arrive in any order, and static ones are valid at any time."""
    async with node_factory("sender") as sender, node_factory("node") as node:
        buffer = Buffer(node)
        later, earlier = (transform("foo", "bar", t, (42.0, -3.14, 0.0)) for t in (0.3, 0.2))
        broadcaster = TransformBroadcaster(sender)
        broadcaster.sendTransform(later)
        broadcaster.sendTransform(earlier)
        static = transform("bar", "baz", 1.1)
        StaticTransformBroadcaster(sender).sendTransform(static)

        for one in (later, earlier):
            stamp = one.header.stamp
            assert await buffer.wait_for_transform("foo", "bar", stamp, timeout_sec=5.0) == one
            assert buffer.lookup_transform("foo", "bar", stamp) == one
        for seconds, text in ((0.1, "into the past"), (0.4, "into the future")):
            with pytest.raises(ExtrapolationException, match=f"require extrapolation {text}"):
                buffer.lookup_transform("foo", "bar", at(seconds))
        found = await buffer.wait_for_transform("bar", "baz", at(1.5), timeout_sec=5.0)
        assert (found.header.stamp.sec, found.header.stamp.nanosec) == (1, 500_000_000)
        assert found.transform == static.transform
        assert (found.header.frame_id, found.child_frame_id) == ("bar", "baz")


async def test_a_listener_fills_another_buffer_from_then_on(node: Node) -> None:
    """Its attribute may be set, as in tf2_ros."""
    buffer, other = Buffer(node), BufferCore()
    buffer.listener.buffer = other
    TransformBroadcaster(node).sendTransform(transform("foo", "bar", 1.0))
    await settle()

    assert other.can_transform_core("foo", "bar", at(1))[0]
    assert not buffer.can_transform("foo", "bar")


async def test_a_server_succeeds_in_telling_an_error_and_aborts_only_after_its_time(
    node: Node,
) -> None:
    """tf2's server does so, since tf2's C++ client does not read results of aborted goals."""
    buffer = Buffer(node)
    BufferServer(buffer, node)
    client = node.create_action_client(LookupTransform, "tf2_buffer_server")
    await client.wait_for_server()
    goal = LookupTransform.Goal(target_frame="foo", source_frame="bar")
    told = await client.call(goal)
    assert told.error.error == TF2Error.LOOKUP_ERROR
    assert "does not exist" in told.error.error_string
    goal.timeout = Duration(nanoseconds=1_000_000).to_msg()
    with pytest.raises(GoalAbortedError) as aborted:
        await client.call(goal)
    result = aborted.value.result
    assert isinstance(result, LookupTransform.Result)
    assert result.error.error == TF2Error.TIMEOUT_ERROR
