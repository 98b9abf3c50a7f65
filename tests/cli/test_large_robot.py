"""Commands beside a robot of ROS 2 with 300 nodes and 1000 topics, while nodes come and go."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from itertools import count
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the robot, without aionode

from aionode.cli._nouns import node as node_verbs
from aionode.cli._nouns import topic as topic_verbs
from aionode.cli._nouns.topic.measure import hz
from aionode.cli._support.session import make_node, wait_until_known
from aionode.engine.context import Context
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire._liveliness import endpoint_token, gid_of, node_token
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import QoSProfile
from tests.support.peers import DOMAIN_ID, isolated_environment, ros_router, ros_session

NODES = 300
TOPICS = 1000
GUESTS = 20
"""The number of nodes that come and go."""

CHANGES_PER_S = 100
QOS = QoSProfile(depth=10).resolved()
STRING = ("std_msgs/msg/String", type_hash(String))
SERVICES = ("describe_parameters", "get_parameters", "list_parameters", "set_parameters")


class Robot:
    """A session that announces as much as that many processes of ROS 2."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self._ids = count()
        self._tokens: list[zenoh.LivelinessToken] = []
        self._endpoints: list[EndpointInfo] = []
        for number in range(NODES):
            self._tokens += self.declare_node(f"node_{number}", number)

    def declare_node(self, name: str, number: int) -> list[zenoh.LivelinessToken]:
        """Declare a node and its endpoints: every 300th topic, and the services of every node."""
        node = NodeInfo(str(self.session.zid()), next(self._ids), name, "/")
        mine = range(number, TOPICS, NODES)
        wanted = [
            *((EndpointKind.PUBLISHER, f"/t{topic}") for topic in mine),
            *((EndpointKind.SUBSCRIPTION, f"/t{(topic + 1) % TOPICS}") for topic in mine),
            *((EndpointKind.SERVER, f"/{name}/{service}") for service in SERVICES),
        ]
        endpoints = [
            EndpointInfo(kind, node, next(self._ids), topic, *STRING, QOS, b"")
            for kind, topic in wanted
        ]
        self._endpoints += endpoints
        return [
            self.session.liveliness().declare_token(token)
            for token in (
                node_token(DOMAIN_ID, node),
                *(endpoint_token(DOMAIN_ID, endpoint) for endpoint in endpoints),
            )
        ]

    def gid_of_publisher(self, name: str) -> bytes:
        """Return the gid of a topic's publisher, as in its token."""
        (publisher,) = (
            endpoint
            for endpoint in self._endpoints
            if (endpoint.kind, endpoint.name) == (EndpointKind.PUBLISHER, name)
        )
        return gid_of(endpoint_token(DOMAIN_ID, publisher))

    def let_guests_come_and_go(self, ended: threading.Event) -> None:
        """Change the graph a hundred times a second, until `ended`; runs in a thread."""
        there: list[zenoh.LivelinessToken] = []
        for number in count():
            node = NodeInfo(str(self.session.zid()), next(self._ids), f"guest_{number}", "/")
            there.append(self.session.liveliness().declare_token(node_token(DOMAIN_ID, node)))
            if len(there) > GUESTS:
                there.pop(0).undeclare()
            if ended.wait(2 / CHANGES_PER_S):
                return


@contextmanager
def in_thread(work: Any) -> Iterator[None]:
    """Run `work` in a thread within the block."""
    ended = threading.Event()
    thread = threading.Thread(target=work, args=(ended,))
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@pytest.fixture(scope="module")
def environment() -> Iterator[None]:
    """The variables of the robot, all of which runs in this process, which may be slow."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("aionode.cli._support.session.QUIET_S", 20.0)
        for name, value in isolated_environment().items():
            patch.setenv(name, value)
        yield


@pytest.fixture(scope="module")
def robot(environment: None) -> Iterator[Robot]:
    """The robot beside its router, with nodes that come and go."""
    with closing(ros_router()), closing(ros_session()) as session:
        robot = Robot(session)
        with in_thread(robot.let_guests_come_and_go):
            yield robot


@pytest.mark.slow
@pytest.mark.one_loop
async def test_lists_beside_a_large_robot_are_complete(robot: Robot, screen: Any) -> None:
    """At the first attempt, although the graph changes a hundred times a second meanwhile."""
    async with asyncio.timeout(60), Context() as context, make_node(context) as node:
        await wait_until_known(node, screen.output)
        await node_verbs.list_nodes(node, output=screen.json_output)
        await topic_verbs.list_topics(node, output=screen.json_output)

    assert "may be incomplete" not in screen.errors
    names = [record["name"] for record in screen.records]
    nodes = [name for name in names if not name.startswith("/t")]
    assert {f"/node_{number}" for number in range(NODES)} <= set(nodes)
    assert len(nodes) == len(set(nodes))
    assert NODES < len(nodes) <= NODES + 2 * GUESTS
    topics = [record for record in screen.records if record["name"].startswith("/t")]
    assert sorted(names[len(nodes) :]) == sorted(f"/t{topic}" for topic in range(TOPICS))
    assert all(record["publishers"] == record["subscriptions"] == 1 for record in topics)


@pytest.mark.slow
@pytest.mark.one_loop
async def test_one_topic_of_a_large_robot_is_shown_with_its_rate(
    robot: Robot, screen: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its endpoints as announced, and each of its messages, while the graph changes."""
    key = data_key(DOMAIN_ID, "/t7", *STRING)
    payload = cdr.encode(String(data="x"))
    gid = robot.gid_of_publisher("/t7")
    printed = asyncio.Event()
    monkeypatch.setattr(screen.stdout, "flush", printed.set)

    def talk(ended: threading.Event) -> None:
        for sequence in count(1):
            extra = attachment.pack(sequence, 0, gid)
            robot.session.put(key, payload, attachment=extra)
            if ended.wait(0.02):
                return

    with in_thread(talk):
        async with asyncio.timeout(60), Context() as context, make_node(context) as node:
            await wait_until_known(node, screen.output)
            await topic_verbs.info(node, "/t7", output=screen.json_output, verbose=True)
            async with asyncio.TaskGroup() as tasks:
                measuring = tasks.create_task(hz(node, ["/t7"], output=screen.json_output))
                while len(screen.text.splitlines()) < 3:
                    printed.clear()
                    await printed.wait()
                measuring.cancel()

    shown, *rates = screen.records
    assert [record["node"] for record in shown["publishers"]] == ["/node_7"]
    assert [record["node"] for record in shown["subscriptions"]] == ["/node_6"]
    assert shown["publishers"][0]["gid"] == gid.hex()
    assert rates[-1]["window"] > rates[0]["window"]
