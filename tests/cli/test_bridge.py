"""What the command line shows of nodes on DDS behind a bridge."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

from aionode.cli._nouns import doctor as doctor_verbs
from aionode.cli._nouns import node as node_verbs
from aionode.cli._nouns import service as service_verbs
from aionode.cli._nouns import topic as topic_verbs
from aionode.graph import EndpointKind
from aionode.node import Node
from tests.cli.conftest import Screen
from tests.support.bridge import ADD, CYCLONE, FAST, StandIn, add, stand_in
from tests.support.peers import isolated_environment, quiet_node


@pytest.fixture
async def robot(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[tuple[Node, StandIn]]:
    """The node of a command, and a bridge with a talker that also adds."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with quiet_node("_aionode_cli_1") as node:
        with stand_in() as bridge:
            bridge.nodes["0110" + "0" * 28 + "/talker"] = {
                "publishers": [{"name": "/chatter", "type": "std_msgs/msg/String"}],
                "service_servers": [{"name": "/add", "type": ADD}],
            }
            bridge.publisher("/chatter")
            bridge.serve("/add", ADD, add)
            await node.graph.until(lambda: node.graph.count(EndpointKind.SERVER, "/add") > 0)
            await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/chatter") > 0)
            yield node, bridge
            assert bridge.deaths == []


async def known(node: Node) -> None:
    """Wait like a command before it answers."""
    for transport in node.context.transports:
        await transport.all_known(1.0)


async def test_topics_services_and_nodes_behind_a_bridge_are_listed(
    robot: tuple[Node, StandIn], screen: Screen
) -> None:
    """As if the nodes were on Zenoh; the bridge's own node appears as it does on DDS."""
    node, _ = robot
    await known(node)
    await topic_verbs.list_topics(node, output=screen.output, types=True)
    await node_verbs.list_nodes(node, output=screen.output)
    await topic_verbs.info(node, "/chatter", output=screen.output, verbose=True)
    await service_verbs.info(node, "/add", output=screen.output)

    assert "/chatter [std_msgs/msg/String]" in screen.text
    assert "/talker\n/zenoh_bridge_ros2dds\n" in screen.text
    assert "Node name: talker" in screen.text
    assert "Services count: 1" in screen.text


async def test_a_service_behind_a_bridge_is_called(
    robot: tuple[Node, StandIn], screen: Screen
) -> None:
    """With the type given in the token."""
    node, _ = robot
    await service_verbs.call(
        node, "/add", ADD, output=screen.output, values="{a: 2, b: 3}", timeout=5
    )

    assert "sum: 5" in screen.text.replace("sum=5", "sum: 5")


async def test_doctor_finds_nothing_wrong_with_nodes_on_cyclone(
    robot: tuple[Node, StandIn], screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It accepts this environment's middleware too, which the bridge speaks."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp")
    node, _ = robot
    await known(node)

    assert await doctor_verbs.doctor(node, output=screen.output) == 0
    assert "Bridges to DDS: 1" in screen.text
    assert "RMW_IMPLEMENTATION" not in screen.text


@pytest.mark.parametrize("by", ["history", "participant"])
async def test_doctor_tells_that_services_on_fast_dds_do_not_answer(
    robot: tuple[Node, StandIn], screen: Screen, by: str
) -> None:
    """This is known from the QoS of topics, or else from the ids of participants."""
    node, bridge = robot
    if by == "participant":
        bridge.nodes["010f" + "0" * 28 + "/other"] = {"publishers": []}
    bridge.publisher("/other", qos=FAST if by == "history" else CYCLONE)
    await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/other") > 0)
    await known(node)

    assert await doctor_verbs.doctor(node, output=screen.output) == 1
    assert "problem: zenoh-bridge-ros2dds: there are nodes on Fast DDS behind" in screen.text
    assert "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp" in screen.text
    assert "AIONODE_TRANSPORT=rcl" in screen.text
