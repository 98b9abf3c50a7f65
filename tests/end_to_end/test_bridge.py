"""A bridge in a process of its own that is killed and restarted."""

from __future__ import annotations

import signal

import pytest

from aionode.graph import EndpointKind
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from tests.end_to_end.process import Process
from tests.support.peers import isolated_environment, quiet_node


@pytest.mark.one_loop
async def test_topics_and_services_come_back_with_a_killed_bridge(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its nodes leave the graph at once, and a restart needs no action here."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with quiet_node("ours") as node:
        subscription = node.create_subscription(String, "/chatter", None, 10)
        client = node.create_client(AddTwoInts, "/add_two_ints")
        for _ in range(2):
            with Process("-m", "tests.support.bridge") as bridge:
                await client.wait_for_service()
                assert (await client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=10)).sum == 5
                await subscription.receive()
                bridge.send(signal.SIGKILL)
                await node.graph.until(lambda: not client.service_is_ready())
                await node.graph.until(
                    lambda: not node.graph.count(EndpointKind.PUBLISHER, "/chatter")
                )
