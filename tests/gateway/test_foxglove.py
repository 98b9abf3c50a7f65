"""Clients of Foxglove's protocol: their topics, and the refusals of the policy."""

from __future__ import annotations

import asyncio
import json
import socket
import struct
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.clock import Time
from aionode.engine.wire import cdr
from aionode.gateway import Gateway, Identity, Policy, Session
from aionode.gateway.foxglove.client import serve_frames
from aionode.gateway.session.audit import Audit
from aionode.gateway.session.robot import Robot
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import SetBool
from aionode.node import Node
from aionode.parameter import Parameter
from examples.gateway import play_bag

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from aionode.bag import Player
    from aionode.engine.context import Context

WITHOUT_LIMIT = """
[[who]]
name = "local"
loopback = true
[[allow]]
subscribe = "/**"
[limits]
subscriptions = 10000
"""

WRITING = Policy.default(allow_write=True)


class Client:
    """A client whose frames do not pass through a socket."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.frames: asyncio.Queue[bytes | str | None] = asyncio.Queue()
        self.got: list[Any] = []
        self._news = asyncio.Event()

    async def incoming(self) -> AsyncIterator[bytes | str]:
        """Yield what `send` was given."""
        while (frame := await self.frames.get()) is not None:
            yield frame

    async def collect(self) -> None:
        """Collect what is sent to the client: ops as dicts, binary frames as bytes."""
        async for frame in self.session.outbox:
            self.got.append(json.loads(frame) if isinstance(frame, str) else frame)
            self._news.set()

    def send(self, op: str | bytes, **fields: Any) -> None:
        """Send an op with its fields, or a binary frame."""
        frame = op if isinstance(op, bytes) else json.dumps({"op": op, **fields})
        self.frames.put_nowait(frame)

    async def until(self, wanted: Callable[[Any], bool]) -> Any:
        """Wait for a frame, for 20 s at most, and return it."""
        async with asyncio.timeout(20):
            while not (found := [frame for frame in self.got if wanted(frame)]):
                self._news.clear()
                await self._news.wait()
        self.got.remove(found[0])
        return found[0]

    async def op(self, name: str) -> Any:
        """Wait for an op, and return its fields."""
        return await self.until(lambda frame: isinstance(frame, dict) and frame["op"] == name)

    async def binary(self, opcode: int) -> bytes:
        """Wait for a binary frame, and return it."""
        return bytes(
            await self.until(lambda frame: isinstance(frame, bytes) and frame[0] == opcode)
        )

    async def announced(self, op: str, field: str, key: str, name: str) -> Any:
        """Wait until something with this name is announced, and return the announcement."""
        async with asyncio.timeout(20):
            while True:
                for frame in self.got:
                    items = frame[field] if isinstance(frame, dict) and frame["op"] == op else ()
                    for item in items:
                        if item[key] == name:
                            return item
                self._news.clear()
                await self._news.wait()

    async def channel(self, topic: str) -> Any:
        """Wait until a topic is announced, and return its channel."""
        return await self.announced("advertise", "channels", "topic", topic)

    async def service(self, name: str) -> Any:
        """Wait until a service is announced, and return the announcement."""
        return await self.announced("advertiseServices", "services", "name", name)

    def publish(self, channel_id: int, data: bytes) -> None:
        """Publish a message."""
        self.send(struct.pack("<BI", 1, channel_id) + data)

    def call(self, service_id: int, encoding: bytes, data: bytes) -> None:
        """Call a service, with the id 7."""
        head = struct.pack("<BIII", 2, service_id, 7, len(encoding))
        self.send(head + encoding + data)


@asynccontextmanager
async def client_of(
    node: Node, policy: Policy = WRITING, player: Player | None = None
) -> AsyncIterator[Client]:
    """Connect a client to the gateway of a node."""
    async with asyncio.TaskGroup() as tasks:
        audit = Audit(node, "")
        robot = Robot(node, policy, audit, tasks)
        async with Session(robot, Identity("local"), "foxglove") as session:
            client = Client(session)
            serving = tasks.create_task(serve_frames(session, client.incoming(), player))
            collecting = tasks.create_task(client.collect())
            yield client
            client.frames.put_nowait(None)
            await serving
            collecting.cancel()
        robot.close()
        audit.close()


async def test_a_client_is_told_what_the_server_can_do(node: Node) -> None:
    """Before anything else."""
    async with client_of(node) as client:
        info = await client.op("serverInfo")

        assert "clientPublish" in info["capabilities"]
        assert "playbackControl" not in info["capabilities"]
        assert info["supportedEncodings"] == ["cdr", "json"]


async def test_a_topic_is_a_channel_with_its_definition(node: Node) -> None:
    """Later ones are announced, and those that go are withdrawn."""
    async with client_of(node) as client:
        await client.op("serverInfo")
        publisher = node.create_publisher(Twist, "/cmd_vel", 1)
        channel = await client.channel("/cmd_vel")
        publisher.destroy()
        gone = await client.op("unadvertise")

        assert channel["encoding"] == "cdr"
        assert channel["schemaName"] == "geometry_msgs/msg/Twist"
        assert "Vector3 linear" in channel["schema"]
        assert "MSG: geometry_msgs/Vector3" in channel["schema"]
        assert gone["channelIds"] == [channel["id"]]


@pytest.mark.slow
async def test_a_large_system_is_announced_in_few_frames(node: Node) -> None:
    """More frames than may wait for a client would disconnect it, and it may want all channels."""
    for number in range(1100):
        node.create_publisher(String, f"/words_{number}", 1)
    async with client_of(node, Policy.parse(WITHOUT_LIMIT)) as client:
        last = await client.channel("/words_1099")
        frames = [frame for frame in client.got if frame["op"] == "advertise"]
        ids = [each["id"] for frame in frames for each in frame["channels"]][:300]
        client.send("subscribe", subscriptions=[{"id": each, "channelId": each} for each in ids])
        while len(client.session.dropped()) < 300:
            await node.graph.changed()

        assert last["schema"] == "string data\n"
        assert not client.session.outbox.overflowed
        assert not [frame for frame in client.got if frame["op"] == "status"]


async def test_a_subscriber_gets_the_bytes_of_the_message(node: Node) -> None:
    """Nothing is decoded; after unsubscribing nothing arrives."""
    publisher = node.create_publisher(String, "/words", 10)
    async with client_of(node) as client:
        channel = await client.channel("/words")
        client.send("subscribe", subscriptions=[{"id": 5, "channelId": channel["id"]}])
        while not publisher.get_subscription_count():
            await node.graph.changed()
        publisher.publish(String(data="hello"))
        frame = await client.binary(1)
        client.send("unsubscribe", subscriptionIds=[5])
        while publisher.get_subscription_count():
            await node.graph.changed()

        _, subscription_id, time_ns = struct.unpack_from("<BIQ", frame)
        assert subscription_id == 5
        assert abs(time_ns - node.get_clock().now().nanoseconds) < 60e9
        assert frame[13:] == bytes(cdr.encode(String(data="hello")))


@pytest.mark.parametrize(
    ("encoding", "data"),
    [("cdr", bytes(cdr.encode(String(data="hello")))), ("json", b'{"data":"hello"}')],
)
async def test_a_client_publishes(node: Node, encoding: str, data: bytes) -> None:
    """In both encodings; its topic disappears when the client unadvertises it."""
    heard: asyncio.Queue[String] = asyncio.Queue()
    node.create_subscription(String, "/words", heard.put_nowait, 10)
    async with client_of(node) as client:
        topic = {"id": 3, "topic": "/words", "encoding": encoding, "schemaName": "std_msgs/String"}
        client.send("advertise", channels=[topic])
        client.publish(3, data)

        assert (await heard.get()).data == "hello"
        client.send("unadvertise", channelIds=[3])
        client.publish(3, data)
        assert "no channel 3" in (await client.op("status"))["message"]


async def test_a_command_ends_with_its_client(node: Node) -> None:
    """The policy has leases for velocities: the stop is sent when the client leaves."""
    heard: asyncio.Queue[Twist] = asyncio.Queue()
    node.create_subscription(Twist, "/cmd_vel", heard.put_nowait, 10)
    forward = Twist(linear=Vector3(x=0.5))
    async with client_of(node) as client:
        topic = {"topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
        client.send("advertise", channels=[{"id": 1, **topic}])
        client.publish(1, bytes(cdr.encode(forward)))
        assert await heard.get() == forward

    assert await heard.get() == Twist()


def answer(request: SetBool.Request) -> SetBool.Response:
    """Answer, or fail."""
    if not request.data:
        raise ValueError("it cannot be switched off")
    return SetBool.Response(success=True, message="on")


@pytest.mark.parametrize(
    ("encoding", "request_data", "response_data"),
    [
        (
            b"cdr",
            bytes(cdr.encode(SetBool.Request(data=True))),
            bytes(cdr.encode(SetBool.Response(success=True, message="on"))),
        ),
        (b"json", b'{"data":true}', b'{"success":true,"message":"on"}'),
    ],
)
async def test_a_service_answers_in_the_encoding_of_its_request(
    node: Node, encoding: bytes, request_data: bytes, response_data: bytes
) -> None:
    """The answer has the id of the call."""
    node.create_service(SetBool, "/power", answer)
    async with client_of(node) as client:
        service = await client.service("/power")
        client.call(service["id"], encoding, request_data)
        frame = await client.binary(3)

        assert service["request"]["schemaName"] == "std_srvs/srv/SetBool_Request"
        assert "bool data" in service["request"]["schema"]
        head = struct.pack("<BIII", 3, service["id"], 7, len(encoding))
        assert frame == head + encoding + response_data


async def test_a_call_that_waits_holds_up_no_other(node: Node) -> None:
    """Neither calls nor other ops wait for it."""
    may_answer = asyncio.Event()

    async def wait(_: SetBool.Request) -> SetBool.Response:
        await may_answer.wait()
        return SetBool.Response(message="late")

    node.create_service(SetBool, "/slow", wait)
    node.create_service(SetBool, "/power", answer)
    async with client_of(node) as client:
        slow, power = await client.service("/slow"), await client.service("/power")
        client.call(slow["id"], b"json", b'{"data":true}')
        client.call(power["id"], b"json", b'{"data":true}')
        first = await client.binary(3)
        may_answer.set()
        second = await client.binary(3)

    assert b'"on"' in first
    assert b'"late"' in second


async def test_a_call_that_fails_says_why(node: Node) -> None:
    """Whether the handler failed, the request is malformed, or there is no such service."""
    node.create_service(SetBool, "/power", answer, on_error="log")
    async with client_of(node) as client:
        service = await client.service("/power")
        client.call(service["id"], b"json", b'{"data":false}')
        failure = await client.op("serviceCallFailure")
        client.call(service["id"], b"json", b"{")
        malformed = await client.op("serviceCallFailure")
        client.call(1000, b"cdr", b"")
        unknown = await client.op("serviceCallFailure")

    assert failure["callId"] == 7
    assert "cannot be switched off" in failure["message"]
    assert "invalid JSON" in malformed["message"]
    assert "service 1000 does not exist" in unknown["message"]


async def test_parameters_are_read_set_and_followed(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """By the name of the node, a dot, and the name of the parameter."""
    driver = node_factory("driver")
    driver.declare_parameter("speed", 0.5)
    async with client_of(node) as client:
        client.send("getParameters", parameterNames=["/driver.speed"], id="a")
        read = await client.op("parameterValues")
        client.send("subscribeParameterUpdates", parameterNames=["/driver.speed"])
        while not driver.count_subscribers("/parameter_events"):
            await node.graph.changed()
        client.send("setParameters", parameters=[{"name": "/driver.speed", "value": 2}], id="b")
        changed = [await client.op("parameterValues") for _ in range(2)]
        client.send("setParameters", parameters=[{"name": "/driver.speed", "value": "fast"}])
        refused = await client.op("status")
        client.send("getParameters", parameterNames=[])
        everything = await client.op("parameterValues")

        value = {"name": "/driver.speed", "type": "float64"}
        assert read == {"op": "parameterValues", "parameters": [value | {"value": 0.5}], "id": "a"}
        assert all(each["parameters"] == [value | {"value": 2.0}] for each in changed)
        assert {each.get("id") for each in changed} == {"b", None}
        assert "/driver.speed" in refused["message"]
        assert value | {"value": 2.0} in everything["parameters"]


async def test_a_parameter_that_is_refused_leaves_the_others_to_be_set(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """The values always follow: a viewer waits for them, and shows the nodes' values."""
    driver = node_factory("driver")
    driver.declare_parameter("speed", 0.5)
    driver.declare_parameter("name", "left")
    parameters = [
        {"name": "/driver.name", "value": 7},
        {"name": "/nobody.speed", "value": 1.0},
        {"name": "/driver.speed", "value": 2.0},
    ]
    async with client_of(node) as client:
        client.send("setParameters", parameters=parameters, id="a")
        follows = await client.op("parameterValues")
        refused = await client.op("status")

    values = {each["name"]: each["value"] for each in follows["parameters"]}
    assert follows["id"] == "a"
    assert values == {"/driver.name": "left", "/driver.speed": 2.0}
    assert "/driver.name" in refused["message"]
    assert "/nobody" in refused["message"]


@pytest.mark.parametrize("strange", ["speed", "/driver.", ".speed", "/driver.secret"])
async def test_a_parameter_that_cannot_be_named_or_seen_leaves_the_others(
    node: Node, node_factory: Callable[..., Node], strange: str
) -> None:
    """With each request about several names; a status says which one, and why."""
    policy = """
    [[allow]]
    see = "/**"
    parameter = "/**"
    [[refuse]]
    see = "/driver:secret"
    """
    driver = node_factory("driver")
    driver.declare_parameter("speed", 0.5)
    driver.declare_parameter("secret", "x")
    wishes = [{"name": strange, "value": 1.5}, {"name": "/driver.speed", "value": 2.5}]
    async with client_of(node, Policy.parse(policy)) as client:
        client.send("getParameters", parameterNames=[strange, "/driver.speed"], id="a")
        told = [await client.op("parameterValues")]
        refused = [await client.op("status")]
        client.send("setParameters", parameters=wishes, id="b")
        told.append(await client.op("parameterValues"))
        refused.append(await client.op("status"))

    assert [[each["value"] for each in one["parameters"]] for one in told] == [[0.5], [2.5]]
    assert all(strange in one["message"] for one in refused)


async def test_names_that_cannot_be_followed_are_told(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """Their changes would never arrive; those of the others do."""
    driver = node_factory("driver")
    driver.declare_parameter("speed", 0.5)
    async with client_of(node) as client:
        client.send("subscribeParameterUpdates", parameterNames=["speed", "/driver.speed"])
        refused = await client.op("status")
        while not driver.count_subscribers("/parameter_events"):
            await node.graph.changed()
        driver.set_parameters([Parameter("speed", value=1.0)])
        told = await client.op("parameterValues")

    assert "'speed'" in refused["message"]
    assert told["parameters"][0]["value"] == 1.0


async def test_parameters_are_read_though_one_node_does_not_answer(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """All available values are reported."""
    node_factory("driver").declare_parameter("speed", 0.5)
    async with client_of(node) as client:
        names = ["/nobody.speed", "/driver.speed"]
        client.send("getParameters", parameterNames=names, id="a")
        told = await client.op("parameterValues")
        refused = await client.op("status")

    assert [each["name"] for each in told["parameters"]] == ["/driver.speed"]
    assert "/nobody" in refused["message"]


async def test_the_connection_graph_shows_who_talks_with_whom(node: Node) -> None:
    """First all of it, then the changes."""
    publisher = node.create_publisher(String, "/words", 1)
    async with client_of(node) as client:
        client.send("subscribeConnectionGraph")
        first = await client.op("connectionGraphUpdate")
        subscription = node.create_subscription(String, "/words", lambda _: None, 1)
        second = await client.op("connectionGraphUpdate")
        publisher.destroy()
        subscription.destroy()
        third = await client.op("connectionGraphUpdate")
        while "/words" not in third["removedTopics"]:
            third = await client.op("connectionGraphUpdate")

        assert {"name": "/words", "publisherIds": ["/robot_node"]} in first["publishedTopics"]
        assert {"name": "/words", "subscriberIds": ["/robot_node"]} in second["subscribedTopics"]
        assert second["publishedTopics"] == []


async def test_a_client_that_may_only_read_is_told_so(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """Publishing, calling and setting are refused, and nothing reaches the robot."""
    heard: list[String] = []
    node.create_subscription(String, "/words", heard.append, 10)
    node.create_service(SetBool, "/power", answer)
    node_factory("driver").declare_parameter("speed", 0.5)
    async with client_of(node, Policy.default()) as client:
        topic = {"id": 3, "topic": "/words", "encoding": "json", "schemaName": "std_msgs/String"}
        client.send("advertise", channels=[topic])
        publishing = await client.op("status")
        service = await client.service("/power")
        client.call(service["id"], b"json", b'{"data":true}')
        calling = await client.op("serviceCallFailure")
        client.send("setParameters", parameters=[{"name": "/driver.speed", "value": 2.0}])
        setting = await client.op("status")

    for refusal in (publishing, calling, setting):
        assert "the policy" in refusal["message"] or "allow" in refusal["message"]
    assert heard == []


async def test_what_the_policy_hides_is_in_no_list(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """It appears neither as a channel, nor in the graph, nor as a change of a parameter."""
    policy = Policy.parse("""
        [[who]]
        name = "local"
        loopback = true
        [[allow]]
        see = "/robot_node"
        subscribe = ["/open", "/parameter_events"]
    """)
    secret = node_factory("secret")
    secret.declare_parameter("password", "old")
    node.create_publisher(String, "/hidden", 1)
    node.create_publisher(String, "/open", 1)
    async with client_of(node, policy) as client:
        await client.channel("/open")
        client.send("subscribeConnectionGraph")
        graph = await client.op("connectionGraphUpdate")
        client.send("subscribeParameterUpdates", parameterNames=[])
        while not secret.count_subscribers("/parameter_events"):
            await node.graph.changed()
        secret.set_parameters([Parameter("password", value="new")])
        client.send("getParameters", parameterNames=["/secret.password"])
        await client.op("status")
        text = json.dumps([graph, *(each for each in client.got if isinstance(each, dict))])

    assert "/open" in text
    assert "/hidden" not in text
    assert "password" not in text


async def test_garbage_is_refused_and_soon_ends_the_connection(node: Node) -> None:
    """The client is told what is wrong with a frame, but not ten thousand times a second."""
    async with client_of(node) as client:
        client.send(b"\xff")
        assert "frame" in (await client.op("status"))["message"]
        for _ in range(100):
            client.send(b"")
        client.send("subscribeConnectionGraph")
        for _ in range(100):
            await client.op("status")

        assert not [each for each in client.got if isinstance(each, dict) and "published" in each]


async def test_a_player_follows_the_timeline(tmp_path: Path, context: Context) -> None:
    """Pause, rate and seek; the times of messages are those of the recording."""
    with bag.BagWriter(tmp_path / "run") as out:
        number = out.add_topic(topic_info("/words", String, []))
        for at in range(60):
            out.write(number, (100 + at) * 10**9, cdr.encode(String(data=str(at))))
    async with (
        bag.Player(tmp_path / "run", context=context, start_paused=True) as player,
        Node("gateway", context=context) as node,
        client_of(node, player=player) as client,
        asyncio.TaskGroup() as tasks,
    ):
        playing = tasks.create_task(player.play())
        info = await client.op("serverInfo")
        channel = await client.channel("/words")
        client.send("subscribe", subscriptions=[{"id": 5, "channelId": channel["id"]}])
        while not node.count_subscribers("/words"):
            await node.graph.changed()
        seek_ns = 150 * 10**9
        client.send(struct.pack("<BBfBQI", 3, 0, 2.0, 1, seek_ns, 4) + b"seek")
        state = await client.until(lambda frame: isinstance(frame, bytes) and b"seek" in frame)
        message = await client.binary(1)
        told = await client.binary(2)
        client.send(struct.pack("<BBfBQI", 3, 1, 2.0, 0, 0, 5) + b"pause")
        await client.until(lambda frame: isinstance(frame, bytes) and b"pause" in frame)
        paused = player.paused
        player.stop()
        await playing

        assert "playbackControl" in info["capabilities"]
        assert info["dataStartTime"] == {"sec": 100, "nsec": 0}
        assert info["dataEndTime"] == {"sec": 159, "nsec": 0}
        _, status, time_ns, rate, did_seek = struct.unpack_from("<BBQfB", state)
        assert (status, rate, did_seek) == (0, 2.0, 1)
        assert 0 <= time_ns - seek_ns < 5e9
        assert abs(struct.unpack_from("<BIQ", message)[2] - seek_ns) < 5e9
        assert struct.unpack("<BQ", told)[1] >= seek_ns
        assert paused


async def test_a_recording_that_has_ended_is_played_again(tmp_path: Path, context: Context) -> None:
    """The client is told of the end, and seeks where it wants."""
    with bag.BagWriter(tmp_path / "run") as out:
        number = out.add_topic(topic_info("/words", String, []))
        for at in range(3):
            out.write(number, (100 + at) * 10**9, cdr.encode(String(data=str(at))))
    heard: asyncio.Queue[String] = asyncio.Queue()
    async with (
        bag.Player(tmp_path / "run", context=context, rate=1000) as player,
        Node("gateway", context=context) as node,
        client_of(node, player=player) as client,
    ):
        await player.play()
        await client.until(lambda frame: isinstance(frame, bytes) and frame[:2] == b"\x05\x03")
        node.create_subscription(String, "/words", heard.put_nowait, 10)
        client.send(struct.pack("<BBfBQI", 3, 0, 1000.0, 1, 101 * 10**9, 5) + b"again")
        await client.until(lambda frame: isinstance(frame, bytes) and b"again" in frame)

        assert [(await heard.get()).data, (await heard.get()).data] == ["1", "2"]


async def test_a_client_is_informed_of_simulated_time(context: Context) -> None:
    """If the gateway uses it; messages have simulated times as well."""
    async with Node(
        "gateway", context=context, parameter_overrides=[Parameter("use_sim_time", value=True)]
    ) as node:
        clock = node.create_publisher(Clock, "/clock", 1)
        words = node.create_publisher(String, "/words", 1)
        async with client_of(node) as client:
            channel = await client.channel("/words")
            client.send("subscribe", subscriptions=[{"id": 5, "channelId": channel["id"]}])
            while not (words.get_subscription_count() and clock.get_subscription_count() > 1):
                await node.graph.changed()
            clock.publish(Clock(clock=Time(seconds=77).to_msg()))
            told = await client.binary(2)
            words.publish(String())
            message = await client.binary(1)

    assert struct.unpack("<BQ", told) == (2, 77 * 10**9)
    assert struct.unpack_from("<BIQ", message)[2] == 77 * 10**9


async def test_a_client_that_may_call_nothing_does_not_control_the_player(
    tmp_path: Path, context: Context
) -> None:
    """It is controlled through the services of its node, for which the policy is asked."""
    with bag.BagWriter(tmp_path / "run") as out:
        out.write(out.add_topic(topic_info("/words", String, [])), 1, cdr.encode(String()))
    async with (
        bag.Player(tmp_path / "run", context=context) as player,
        Node("gateway", context=context) as node,
        client_of(node, Policy.default(), player) as client,
    ):
        client.send(struct.pack("<BBfBQI", 3, 1, 1.0, 0, 0, 1) + b"x")
        refusal = await client.op("status")

        assert "/rosbag2_player/pause" in refusal["message"]
        assert not player.paused


@pytest.mark.parametrize("protocol", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
async def test_foxglove_connects_by_its_subprotocol(node: Node, protocol: str) -> None:
    """On the port of all other protocols; Lichtblick uses the older name of the protocol."""
    async with (
        Gateway(node, port=0) as gateway,
        connect(f"ws://127.0.0.1:{gateway.port}", subprotocols=[Subprotocol(protocol)]) as socket,
    ):
        first = json.loads(await socket.recv())
        sessions = gateway.stats.sessions

    assert first["op"] == "serverInfo"
    assert sessions == {"foxglove": 1}


async def test_the_example_plays_a_bag_for_foxglove(tmp_path: Path, node: Node) -> None:
    """The timeline is that of the bag, and the policy lets a viewer pause it."""
    with bag.BagWriter(tmp_path / "run") as out:
        number = out.add_topic(topic_info("/words", String, []))
        for at in range(60):
            out.write(number, (100 + at) * 10**9, cdr.encode(String(data=str(at))))
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    async with asyncio.TaskGroup() as tasks:
        playing = tasks.create_task(play_bag.main(str(tmp_path / "run"), port))
        viewer = await connected(port, node)
        info = json.loads(await viewer.recv())
        await viewer.send(struct.pack("<BBfBQI", 3, 1, 1.0, 0, 0, 5) + b"pause")
        while not ((frame := await viewer.recv())[:2] == b"\x05\x01" and b"pause" in frame):
            assert "refused" not in str(frame)
        await viewer.close()
        playing.cancel()

    assert info["dataEndTime"] == {"sec": 159, "nsec": 0}


async def connected(port: int, node: Node) -> ClientConnection:
    """Return a connection to a gateway that is about to listen."""
    while True:
        try:
            return await connect(
                f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol("foxglove.sdk.v1")]
            )
        except OSError:
            await node.get_clock().sleep(0.02)
