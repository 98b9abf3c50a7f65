"""Tools for testing nodes: no network, time that the test steps, and faults on demand.

With pytest the fixtures `aionode_context`, `node_factory` and `manual_clock` are available as soon
as aionode is installed (see `aionode.pytest_plugin`)::

    async def test_the_heartbeat_comes_once_a_second(node_factory, manual_clock):
        heart = node_factory("heart")
        beats = []
        heart.create_timer(1.0, lambda: beats.append(manual_clock.now()))
        await manual_clock.advance(3.0)
        assert len(beats) == 3
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.context import Context
from aionode.testing._faults import FaultyTransport
from aionode.testing._manual_clock import ManualClock
from aionode.testing._quiescence import settle
from aionode.testing._stepped_loop import SteppedLoop
from aionode.testing._system import system_under_test

if TYPE_CHECKING:
    from aionode.clock import TimeBase

__all__ = [
    "FaultyTransport",
    "ManualClock",
    "SteppedLoop",
    "local_context",
    "settle",
    "system_under_test",
]


def local_context(*, clock: TimeBase | None = None, seed: int | None = None) -> Context:
    """Create a context without network, whose nodes reach only each other.

    Args:
        clock: Its source of time, such as a `ManualClock`; the machine by default.
        seed: Makes the ids of nodes, endpoints and goals the same in every run.
    """
    return Context(transport="local", clock=clock, seed=seed)
