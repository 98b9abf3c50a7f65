"""Large requests and responses over links: copied once, into the memory that both ends share."""

from __future__ import annotations

import tracemalloc
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.nav_msgs.srv import GetMap, SetMap
from tests.support.links import Counting, folder, two_nodes

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["folder"]  # a fixture

SIZE = 6_000_000
CELLS: Any = np.arange(SIZE, dtype=np.int64).astype(np.int8)
MAP = OccupancyGrid(data=CELLS)


def is_whole(data: Any) -> bool:
    """Return whether these are all cells; it takes no memory."""
    return memoryview(data).cast("B") == memoryview(CELLS).cast("B")


CALLS: list[tuple[Any, Callable[[Any], Any], Any]] = [
    (GetMap, lambda _: GetMap.Response(map=MAP), GetMap.Request()),
    (
        SetMap,
        lambda request: SetMap.Response(success=is_whole(request.map.data)),
        SetMap.Request(map=MAP),
    ),
]


@pytest.mark.parametrize(("service", "answer", "request_"), CALLS, ids=["response", "request"])
async def test_a_large_map_is_not_copied_into_memory_of_a_process(
    service: Any, answer: Callable[[Any], Any], request_: Any
) -> None:
    """Each copy would block both event loops for milliseconds; it arrives as it was sent."""
    async with two_nodes() as nodes:
        await Counting(nodes).until_linked()
        nodes.b.create_service(service, "map", answer)
        client: Any = nodes.a.create_client(service, "map")
        await client.wait_for_service()
        await client.call(request_)  # # what comes with the first one stays
        tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            response = await client.call(request_)
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert response.success if service is SetMap else is_whole(response.map.data)
    assert peak - before < SIZE // 2
