"""A reloaded policy: everything that it no longer allows ends, whatever holds it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.errors import RefusedError
from aionode.gateway import Gateway, Policy, Session
from aionode.gateway.foxglove.client import serve_frames
from aionode.gateway.session.robot import Robot
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import settle
from tests.support.gateway_bench import Bench
from tests.support.http_client import http_client
from tests.support.rosbridge import RosbridgeClient

LOCAL = "[[who]]\nname = 'local'\nloopback = true\n"
LESS = Policy.parse(f"{LOCAL}[[allow]]\nsee = '/**'\nsubscribe = '/numbers'")


async def test_a_client_of_rosbridge_is_told_which_topic_ends(
    client: RosbridgeClient, robot: Robot, node: Node
) -> None:
    """Its messages stop, and other topics continue; subscribing again is refused."""
    words = node.create_publisher(String, "/words", 1)
    numbers = node.create_publisher(String, "/numbers", 1)
    for topic in ("/words", "/numbers"):
        client.send("subscribe", topic=topic)
    await settle()

    robot.policy = LESS
    client.session.check_again()
    assert (await client.receive())["msg"] == "subscribe: the policy has ended /words"
    words.publish(String(data="a"))
    numbers.publish(String(data="1"))
    assert (await client.receive())["topic"] == "/numbers"
    client.send("unsubscribe", topic="/words")
    assert "not subscribed" in (await client.receive())["msg"]
    client.send("subscribe", topic="/words")
    assert "the policy does not allow" in (await client.receive())["msg"]


async def test_a_foxglove_client_is_told_what_ends_and_what_is_hidden(bench: Bench) -> None:
    """Channels, subscriptions, parameter changes, and the nodes of the connection graph."""
    bench.node.create_publisher(String, "/words", 1)
    bench.node.create_publisher(String, "/secret", 1)
    sent: asyncio.Queue[str] = asyncio.Queue()

    async def frames() -> AsyncIterator[str]:
        while True:
            yield await sent.get()

    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        serving = tasks.create_task(serve_frames(session, frames()))
        await bench.advance(1.0)
        ids = {
            channel["topic"]: channel["id"]
            for op in ops(session)
            for channel in op.get("channels", ())
        }
        wishes = [{"id": 1, "channelId": ids["/words"]}, {"id": 2, "channelId": ids["/secret"]}]
        sent.put_nowait(json.dumps({"op": "subscribe", "subscriptions": wishes}))
        sent.put_nowait(json.dumps({"op": "subscribeParameterUpdates", "parameterNames": []}))
        sent.put_nowait(json.dumps({"op": "subscribeConnectionGraph"}))
        await settle()
        assert len(session.dropped()) == 3
        assert "/secret" in json.dumps(ops(session))

        bench.allow("[[allow]]\nsee = '/words'\n[[allow]]\nsubscribe = '/numbers'")
        session.check_again()
        await bench.advance(1.0)
        told = ops(session)
        serving.cancel()
    assert not session.dropped()
    ended = {op["message"].partition(":")[0] for op in told if op["op"] == "status"}
    assert ended == {"/words", "/secret"}
    gone = next(op["channelIds"] for op in told if op["op"] == "unadvertise")
    assert ids["/secret"] in gone
    assert ids["/words"] not in gone
    graph = next(op for op in told if op["op"] == "connectionGraphUpdate")
    assert "/secret" in graph["removedTopics"]


def ops(session: Session) -> list[dict[str, Any]]:
    """Return the text ops that wait for a client."""
    found = []
    while (frame := session.outbox.next_frame()) is not None:
        if isinstance(frame, str):
            found.append(json.loads(frame))
    return found


@pytest.mark.parametrize(
    ("accept", "status", "text"),
    [("text/event-stream", 200, ": alive"), ("application/json", 503, "its policy has changed")],
)
async def test_an_answer_over_http_ends_with_the_right_to_its_topic(
    aionode_context: Context, accept: str, status: int, text: str
) -> None:
    """A stream is completed; a request that waits for a message is answered.

    The caller stays identified.
    """
    path = "/topics/words?timeout_sec=60"
    async with (
        Node("robot", context=aionode_context) as robot,
        Node("gateway", context=aionode_context) as node,
        Gateway(node, port=0) as gateway,
        http_client(gateway.port) as client,
        asyncio.TaskGroup() as tasks,
    ):
        publisher = robot.create_publisher(String, "/words", 1)
        asked = tasks.create_task(client.get(path, headers={"Accept": accept}))
        await robot.graph.until(lambda: publisher.get_subscription_count() == 1)
        await settle()
        gateway.clients.use_policy(LESS)
        answer = await asked
    assert answer.status_code == status
    assert text in answer.text


async def test_a_request_that_arrives_slowly_is_judged_by_the_policy_of_now(
    aionode_context: Context,
) -> None:
    """Its head arrived with a token that is withdrawn before the body arrives."""
    known = "[[who]]\nname = 'operator'\ntoken = '{}'\n[[allow]]\nparameter = '/**'\nsee = '/**'"
    async with (
        Node("gateway", context=aionode_context) as node,
        Gateway(node, Policy.parse(known.format("old")), port=0) as gateway,
    ):
        reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        head = [
            "PUT /parameters/gateway/rate HTTP/1.1",
            "Host: 127.0.0.1",
            "Authorization: Bearer old",
            "Content-Type: application/json",
            "Content-Length: 1",
            "Expect: 100-continue",
        ]
        writer.write("\r\n".join([*head, "", ""]).encode())
        assert b"100 Continue" in await reader.readuntil(b"\r\n\r\n")  # it has been let in
        gateway.clients.use_policy(Policy.parse(known.format("new")))
        writer.write(b"1")
        answer = await reader.readline()
        writer.close()
        assert b" 401 " in answer
        assert gateway.stats.refused == 1  # which is also a line of the audit log


async def test_a_client_that_calls_is_disconnected(bench: Bench) -> None:
    """Even while the call waits for its server or its response."""
    never = asyncio.Event()

    async def handle(_: Any) -> AddTwoInts.Response:
        await never.wait()
        return AddTwoInts.Response()

    bench.node.create_service(AddTwoInts, "/add", handle)
    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        calling = tasks.create_task(session.call("/add", {}, timeout_sec=None))
        await settle()
        session.check_again()
        assert not session.ended.is_set()
        bench.robot.policy = LESS
        session.check_again()
        assert session.ended.is_set()
        calling.cancel()


async def test_a_client_whose_goal_waits_for_its_server_is_disconnected(bench: Bench) -> None:
    """The server may appear, and would get a goal that the policy no longer allows."""

    async def pursue() -> None:
        async with session.goal("/count", {}, type_name="example_interfaces/Fibonacci"):
            pass

    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        pursuing = tasks.create_task(pursue())
        await settle()
        bench.robot.policy = LESS
        session.check_again()
        assert session.ended.is_set()
        pursuing.cancel()


async def test_the_policy_of_now_counts_when_a_person_has_said_yes(bench: Bench) -> None:
    """A person takes a while, during which the rule may be removed."""
    words = bench.node.create_subscription(String, "/words")
    bench.allow("[[allow]]\npublish = '/words'\nask = true")

    async def ask(*_: Any) -> bool:
        await checkpoint()
        bench.robot.policy = LESS
        return True

    bench.robot.ask = ask
    async with bench.session() as session:
        with pytest.raises(RefusedError, match="the policy does not allow guest"):
            await session.publish("/words", {"data": "a"}, "std_msgs/String")
    assert words.stats.received == 0


async def test_commands_are_published_by_the_rule_of_now(bench: Bench) -> None:
    """An open lease ends with its rule: the new one may require a much earlier stop."""
    heard: list[float] = []
    bench.node.create_subscription(Twist, "/cmd_vel", lambda each: heard.append(each.linear.x))
    rule = "[[allow]]\npublish = '/cmd_vel'\nlease = {{ ttl_sec = {} }}"
    bench.allow(rule.format(10.0))
    async with bench.session() as session:
        await session.publish("/cmd_vel", {"linear": {"x": 1.0}}, "geometry_msgs/Twist")
        bench.allow(rule.format(0.2))
        await session.publish("/cmd_vel", {"linear": {"x": 2.0}})
        await settle()
        assert heard == [1.0, 0.0, 2.0]
        await bench.advance(0.3)
        assert heard == [1.0, 0.0, 2.0, 0.0]
