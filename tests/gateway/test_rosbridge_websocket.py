"""Rosbridge clients over real WebSockets: slow ones, large frames, many clients, and lost ones."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import logging
from collections.abc import AsyncIterator, Callable
from functools import partial
from pathlib import Path
from typing import Any

import cbor2
import pytest
import websockets

from aionode.gateway import Gateway, Policy
from aionode.gateway.rosbridge.client_list import ConnectedClients
from aionode.interfaces.std_msgs.msg import Int32, String, UInt8MultiArray
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from aionode.testing import settle
from tests.support.waiting import until

Connect = Callable[..., contextlib.AbstractAsyncContextManager[websockets.ClientConnection]]


@pytest.fixture
async def connect(node_factory: Callable[..., Node]) -> AsyncIterator[Connect]:
    """Yield a function that connects to a gateway that allows everything."""
    gateway_node = node_factory("gateway")
    await settle()
    async with Gateway(gateway_node, Policy.default(allow_write=True), port=0) as gateway:
        url = f"ws://127.0.0.1:{gateway.port}/"
        yield partial(websockets.connect, url, max_size=None)


async def send(client: websockets.ClientConnection, op: str, **fields: Any) -> None:
    """Send an op."""
    await client.send(json.dumps({"op": op, **fields}))


async def subscribe(client: websockets.ClientConnection, topic: str, **fields: Any) -> None:
    """Subscribe, and wait until that has happened."""
    await send(client, "subscribe", topic=topic, **fields)
    await send(client, "call_service", service="/rosapi/get_time", id="done")
    await client.recv()


async def test_a_large_message_arrives_by_cbor_in_one_frame(connect: Connect, node: Node) -> None:
    """Rosbridge puts the bytes into a fragment of JSON, which fails: it never arrives."""
    publisher = node.create_publisher(UInt8MultiArray, "/large", 1)
    data = bytes(range(256)) * 12_000
    async with connect() as client:
        for compression in ("cbor", "cbor-raw"):
            await subscribe(
                client, "/large", type="std_msgs/UInt8MultiArray", compression=compression
            )
            publisher.publish(UInt8MultiArray(data=data))
            message = cbor2.loads(await client.recv(decode=False))["msg"]

            assert message.get("data") == data or data in message["bytes"]
            await send(client, "unsubscribe", topic="/large")


async def test_a_client_that_reads_nothing_slows_no_other(connect: Connect, node: Node) -> None:
    """The others get every message; a bounded number waits for it, and it gets the newest later."""
    publisher = node.create_publisher(String, "/words", 100)
    async with connect() as slow, connect() as fast:
        for client in (slow, fast):
            await subscribe(client, "/words", type="std_msgs/String", queue_length=5)
        slow.transport.pause_reading()
        for number in range(200):
            publisher.publish(String(data=f"{number} " + "x" * 200_000))
            got = json.loads(await fast.recv())["msg"]["data"]
            assert got.startswith(f"{number} ")

        slow.transport.resume_reading()
        seen: list[int] = []
        while not seen or seen[-1] != 199:
            seen.append(int(json.loads(await slow.recv())["msg"]["data"].split()[0]))
        assert seen == sorted(seen)
        assert len(seen) < 200


async def test_all_publishers_of_a_topic_are_heard(
    connect: Connect, node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """Reliable or not, latched or not, before or after the subscription, without a warning."""
    best_effort = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    async with connect() as client:
        node.create_publisher(Int32, "/count", latched).publish(Int32(data=1))
        await send(client, "subscribe", topic="/count", type="std_msgs/Int32")
        assert json.loads(await client.recv())["msg"] == {"data": 1}
        await subscribe(client, "/later", type="std_msgs/Int32")
        for number, profile in enumerate((QoSProfile(depth=10), best_effort, latched)):
            for topic in ("/count", "/later"):
                publisher = node.create_publisher(Int32, topic, profile)
                publisher.publish(Int32(data=number))
                message = json.loads(await client.recv())
                assert (message["topic"], message["msg"]) == (topic, {"data": number})

    assert "incompatible" not in caplog.text


async def test_clients_come_and_go_while_messages_flow(connect: Connect, node: Node) -> None:
    """With or without a goodbye, whatever they hold: no node fails, and nothing is left behind."""
    publisher = node.create_publisher(Int32, "/count", 10)

    async def visit(number: int) -> None:
        async with connect() as client:
            await subscribe(client, "/count", type="std_msgs/Int32")
            await send(client, "advertise_service", service=f"/s{number}", type="std_srvs/Trigger")
            await send(client, "publish", topic=f"/t{number}", type="std_msgs/Int32", msg={})
            publisher.publish(Int32(data=number))
            await client.recv()
            if number % 2:
                client.transport.abort()

    for _ in range(3):
        async with asyncio.TaskGroup() as tasks:
            for number in range(10):
                tasks.create_task(visit(number))
    async with connect() as client:
        await subscribe(client, "/count", type="std_msgs/Int32")
        publisher.publish(Int32(data=1))
        assert json.loads(await client.recv())["msg"] == {"data": 1}
    while node.count_subscribers("/count") or node.count_services("/s1"):
        await node.graph.changed()


async def test_a_client_that_sends_garbage_is_disconnected(connect: Connect) -> None:
    """Other clients are not: a browser does not send garbage a hundred times by mistake."""
    async with connect() as good, connect() as bad:
        with contextlib.suppress(websockets.ConnectionClosed):
            for _ in range(120):
                await bad.send("[" * 1000)
        await bad.wait_closed()
        await send(good, "call_service", service="/rosapi/get_ros_version")

        assert bad.close_code == 1008
        assert json.loads(await good.recv())["result"] is True


async def test_no_token_reaches_a_log(
    node_factory: Callable[..., Node],
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Wrong tokens and the lowest level are no exception: logs are kept, and shown to others."""
    policy = tmp_path / "policy.toml"
    known = hashlib.sha256(b"hush").hexdigest()
    policy.write_text(f'[[who]]\nname = "me"\ntoken_sha256 = "{known}"\n')
    caplog.set_level(logging.WARNING, "websockets.client")  # the other end, here in one process
    caplog.set_level(logging.DEBUG)  # last, as it also is the level of what is caught
    gateway_node = node_factory("gateway")
    await settle()
    async with Gateway(gateway_node, Policy.load(policy), port=0) as gateway:
        url = f"ws://127.0.0.1:{gateway.port}/"
        headers = {"Authorization": "Bearer hush"}
        async with websockets.connect(f"{url}?token=hush"):
            pass
        async with websockets.connect(url, additional_headers=headers):
            pass
        with pytest.raises(websockets.InvalidStatus):
            await websockets.connect(f"{url}?token=hushhush")

    assert "hush" not in caplog.text


async def test_topics_tell_how_many_clients_there_are_and_who(connect: Connect, node: Node) -> None:
    """Dashboards of rosbridge read them, including dashboards that connect later."""
    counts: list[int] = []
    addresses: list[list[str]] = []
    await settle()
    async with connect(), connect():
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(Int32, "client_count", lambda m: counts.append(m.data), latched)
        node.create_subscription(
            ConnectedClients,
            "connected_clients",
            lambda message: addresses.append([client.ip_address for client in message.clients]),
            latched,
        )
        await until(lambda: counts and counts[-1] == 2)
    await until(lambda: counts[-1] == 0)

    assert addresses[0] == ["127.0.0.1"] * 2
    assert addresses[-1] == []
