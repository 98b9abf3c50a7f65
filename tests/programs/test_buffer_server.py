"""The program that looks transforms up for others."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aionode import Node
from aionode.programs._tf2.buffer_server import TransformServer
from aionode.testing import settle
from aionode.tf import BufferClient, StaticTransformBroadcaster
from tests.programs.conftest import Start
from tests.support.transforms import transform


async def test_it_looks_up_what_is_published(
    start: Start, node_factory: Callable[..., Any]
) -> None:
    """For a client that has no buffer of its own."""
    start(TransformServer, buffer_size=10.0)
    node: Node = node_factory("client")
    StaticTransformBroadcaster(node).sendTransform(transform("map", "base", 0.0, (1.0, 2.0, 3.0)))
    await settle()

    client = BufferClient(node, "tf2_buffer_server")
    found = await client.lookup_transform("map", "base")

    assert found.transform.translation.y == 2.0
