"""Topics over rosbridge: a client in the gateway's process, in a context without network."""

from __future__ import annotations

import asyncio
import base64
import json

import pytest

from aionode.engine.wire import cdr
from aionode.gateway.session.robot import Robot
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.geometry_msgs.msg import Vector3
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.message import to_builtins
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import settle
from tests.support.rosbridge import RosbridgeClient, rosbridge_client

# Subscriptions


async def test_a_subscriber_gets_messages_as_json(client: RosbridgeClient, node: Node) -> None:
    """By the name that it has used, with or without a slash."""
    publisher = node.create_publisher(String, "/words", 10)
    client.send("subscribe", topic="words", type="std_msgs/String")
    await settle()

    publisher.publish(String(data="hi"))

    assert await client.receive() == {"op": "publish", "topic": "words", "msg": {"data": "hi"}}


async def test_the_type_of_a_topic_need_not_be_given(client: RosbridgeClient, node: Node) -> None:
    """The graph knows it; an unknown topic is an error, which rosbridge does not report."""
    publisher = node.create_publisher(String, "/words", 10)
    client.send("subscribe", topic="/words")
    await settle()
    publisher.publish(String(data="hi"))
    assert (await client.receive())["msg"] == {"data": "hi"}

    client.send("subscribe", topic="/nothing", id="s1")

    status = await client.receive()
    assert (status["op"], status["level"], status["id"]) == ("status", "error", "s1")
    assert "/nothing" in status["msg"]


@pytest.mark.parametrize(
    "given", [{}, {"type": "example_interfaces/action/Fibonacci_FeedbackMessage"}]
)
async def test_the_feedback_of_an_action_is_a_topic(
    client: RosbridgeClient, node: Node, given: dict[str, str]
) -> None:
    """A page shows goals that others have sent; the type belongs to the action."""
    message = Fibonacci.Impl.FeedbackMessage
    publisher = node.create_publisher(message, "/fibonacci/_action/feedback", 10)
    client.send("subscribe", topic="/fibonacci/_action/feedback", **given)
    await settle()

    publisher.publish(message(feedback=Fibonacci.Feedback(sequence=[0, 1])))

    assert (await client.receive())["msg"]["feedback"] == {"sequence": [0, 1]}


async def test_a_service_is_no_topic_though_it_belongs_to_an_action(
    client: RosbridgeClient,
) -> None:
    """Its name looks like that of a message."""
    name = "example_interfaces/action/Fibonacci_SendGoal"
    client.send("subscribe", topic="/x", type=name)

    assert "not the name of a type of msg" in (await client.receive())["msg"]


async def test_each_compression_has_its_form(robot: Robot, node: Node) -> None:
    """Clients of one topic may request different ones: the first does not decide for all."""
    publisher = node.create_publisher(Image, "/image", 10)
    image = Image(data=b"\x01\x02", width=2)
    got = {}
    for compression in ("none", "cbor", "cbor-raw", "png"):
        async with rosbridge_client(robot) as client:
            client.send("subscribe", topic="/image", compression=compression)
            await settle()
            publisher.publish(image)
            got[compression] = await client.receive()

    assert got["none"]["msg"]["data"] == base64.b64encode(b"\x01\x02").decode()
    assert got["cbor"]["msg"]["data"] == b"\x01\x02"
    assert cdr.decode(Image, got["cbor-raw"]["msg"]["bytes"]) == image
    assert got["png"]["op"] == "png"


async def test_ids_of_one_client_share_a_subscription(client: RosbridgeClient, node: Node) -> None:
    """A client gets each message once while one of its ids is subscribed."""
    publisher = node.create_publisher(Int32, "/count", 10)
    client.send("subscribe", topic="/count", id="a")
    client.send("subscribe", topic="/count", id="b")
    client.send("unsubscribe", topic="/count", id="a")
    await settle()
    publisher.publish(Int32(data=1))
    client.send("unsubscribe", topic="/count", id="b")
    assert (await client.receive())["msg"] == {"data": 1}
    await settle()
    publisher.publish(Int32(data=2))
    client.send("unsubscribe", topic="/count")

    status = await client.receive()
    assert "not subscribed" in status["msg"]


async def test_the_strongest_compression_of_a_client_counts(
    client: RosbridgeClient, node: Node
) -> None:
    """As in rosbridge: a page has one decoder for each topic."""
    publisher = node.create_publisher(Int32, "/count", 10)
    client.send("subscribe", topic="/count", id="a", compression="cbor")
    client.send("subscribe", topic="/count", id="b")
    await settle()
    publisher.publish(Int32(data=1))
    assert isinstance(await client.frame(), bytes)

    client.send("unsubscribe", topic="/count", id="a")
    await settle()
    publisher.publish(Int32(data=1))
    assert isinstance(await client.frame(), str)


async def test_a_late_subscription_gets_what_is_latched(
    client: RosbridgeClient, node: Node
) -> None:
    """Including a client's second one, whenever the publisher appeared: maps, descriptions."""
    client.send("subscribe", topic="/map", type="std_msgs/String", id="early")
    await settle()
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "/map", profile).publish(String(data="m"))
    assert (await client.receive())["msg"] == {"data": "m"}

    client.send("subscribe", topic="/map", type="std_msgs/String", id="late")

    assert (await client.receive())["msg"] == {"data": "m"}


async def test_the_queue_of_a_client_keeps_the_newest(client: RosbridgeClient, node: Node) -> None:
    """A slow client gets the current state, with a delay that does not grow."""
    publisher = node.create_publisher(Int32, "/count", 100)
    client.send("subscribe", topic="/count", queue_length=2)
    await settle()
    for number in range(50):
        publisher.publish(Int32(data=number))
    await settle()

    assert [(await client.receive())["msg"]["data"] for _ in range(2)] == [48, 49]


async def test_a_client_may_ask_for_fewer_messages(client: RosbridgeClient, node: Node) -> None:
    """The fastest of its ids decides: ``throttle_rate`` is the least time between two, in ms."""
    publisher = node.create_publisher(Int32, "/count", 100)
    client.send("subscribe", topic="/count", id="slow", throttle_rate=10_000_000)
    await settle()
    for number in range(5):
        publisher.publish(Int32(data=number))
    assert (await client.receive())["msg"] == {"data": 0}
    client.send("subscribe", topic="/count", id="all")
    await settle()
    publisher.publish(Int32(data=7))

    assert (await client.receive())["msg"] == {"data": 7}


@pytest.mark.parametrize(
    ("given", "read"), [({}, [0, 4]), ({"queue_length": 1}, [0, 4]), ({"queue_length": 2}, [0, 3])]
)
async def test_a_client_that_asks_for_fewer_messages_gets_the_last(
    client: RosbridgeClient, node: Node, given: dict[str, int], read: list[int]
) -> None:
    """It shows a state, and no further message may ever come."""
    publisher = node.create_publisher(Int32, "/count", 100)
    client.send("subscribe", topic="/count", throttle_rate=50, **given)
    await settle()
    for number in range(5):
        publisher.publish(Int32(data=number))

    assert [(await client.receive())["msg"]["data"] for _ in read] == read


async def test_a_message_is_in_fragments_only_if_the_client_asks(
    client: RosbridgeClient, node: Node
) -> None:
    """Many clients cannot read them; rosbridge sends them unasked."""
    publisher = node.create_publisher(String, "/words", 10)
    client.send("subscribe", topic="/words", fragment_size=30)
    await settle()
    publisher.publish(String(data="x" * 50))

    parts = await client.receive()

    whole = json.loads("".join(part["data"] for part in parts))
    assert whole["msg"] == {"data": "x" * 50}
    assert {len(part["data"]) for part in parts[:-1]} == {30}


async def test_a_message_is_encoded_once_for_all_clients(robot: Robot, node: Node) -> None:
    """The first client that needs a kind of frame creates it."""
    publisher = node.create_publisher(String, "/words", 10)
    async with rosbridge_client(robot) as first, rosbridge_client(robot) as second:
        for client in (first, second):
            client.send("subscribe", topic="/words")
        await settle()
        publisher.publish(String(data="hi"))

        assert await first.frame() is await second.frame()


# Publishers


async def test_a_message_of_a_client_reaches_the_robot(client: RosbridgeClient, node: Node) -> None:
    """If it was not advertised, the type is that of the message, or of the topic."""
    reader = node.create_subscription(Vector3, "/cmd", qos_profile=10)
    client.send("advertise", topic="/cmd", type="geometry_msgs/Vector3", queue_size=9, latch=False)
    client.send("publish", topic="/cmd", msg={"x": 1}, latch=False)
    client.send("unadvertise", topic="/cmd")
    client.send("publish", topic="/cmd", msg={"x": 2})

    assert [(await reader.receive()).x for _ in range(2)] == [1.0, 2.0]


async def test_a_page_that_publishes_at_once_reaches_the_subscriptions(
    client: RosbridgeClient, node: Node
) -> None:
    """A latched message also reaches later ones."""
    client.send("advertise", topic="/a", type="std_msgs/String", latch=True, id="a")
    client.send("publish", topic="/a", msg={"data": "1"})
    await settle()
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    reader = node.create_subscription(String, "/a", qos_profile=profile)

    assert (await reader.receive()).data == "1"


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"topic": "/t", "type": "std_msgs/String", "msg": {"dat": "x"}}, "did you mean 'data'"),
        (
            {"topic": "/t", "type": "std_msgs/String", "msg": {"data": 5}},
            "std_msgs/msg/String.data",
        ),
        ({"topic": "/t", "type": "std_msgs/Strin", "msg": {}}, "std_msgs/msg/Strin"),
        ({"topic": "/t", "msg": {}}, "/t"),
        ({"topic": 5, "msg": {}}, "publish.topic: 5 (int); use text"),
        ({"msg": {}}, "publish.topic: missing"),
        ({"topic": "a b", "type": "std_msgs/String"}, "a b"),
        ({"topic": "/t", "type": "std_msgs/String", "msg": "text"}, "publish.msg"),
        ({"topic": "/t", "type": "std_msgs/String", "msg": None}, "publish.msg: None (NoneType)"),
    ],
)
async def test_a_mistake_is_reported(
    client: RosbridgeClient, fields: dict[str, object], told: str
) -> None:
    """Rosbridge only writes it to its own log, where the author of a page never looks."""
    client.send("publish", id="p1", **fields)

    status = await client.receive()

    assert (status["op"], status["level"], status["id"]) == ("status", "error", "p1")
    assert told in status["msg"]


async def test_no_status_is_sent_to_those_who_have_not_asked(robot: Robot) -> None:
    """Many clients do not know the op; they next get the answer to the call after the mistake."""
    async with rosbridge_client(robot) as client:
        client.send("publish", topic="/t", msg={})
        client.send("nonsense")
        client.send_frame("{")

        assert (await client.call("/rosapi/get_ros_version"))["values"]["version"] == 2


async def test_a_client_that_sends_no_ops_is_disconnected(robot: Robot) -> None:
    """After a hundred frames of garbage; rosbridge searches each for brackets, forever."""
    async with rosbridge_client(robot) as client:
        for _ in range(150):
            client.send_frame("}")
        client.send("subscribe", topic="/words", type="std_msgs/String")
        await settle()

        assert not robot.node.get_subscriptions_info_by_topic("/words")


@pytest.mark.parametrize("op", [{"op": "nonsense"}, {"op": "publish"}, {"op": "subscribe"}])
async def test_ops_that_come_to_nothing_are_counted(robot: Robot, op: dict[str, str]) -> None:
    """The gateway reads more slowly from a client that sends many of them."""
    async with rosbridge_client(robot) as client:
        for _ in range(3):
            client.send(**op)
        await settle()

        assert client.session.rights.refused == 3


async def test_a_frame_may_be_bytes_of_json(client: RosbridgeClient) -> None:
    """Some clients send text this way, and rosbridge accepts it."""
    client.send_frame(b'{"op": "call_service", "service": "rosapi/get_ros_version"}')

    assert (await client.receive())["values"]["version"] == 2


async def test_fragments_of_a_client_are_put_together(client: RosbridgeClient) -> None:
    """Separately for each client: in rosbridge, two clients with one id mix their messages."""
    whole = json.dumps({"op": "call_service", "service": "/rosapi/get_ros_version", "id": "c"})
    for num, data in enumerate((whole[:20], whole[20:])):
        client.send("fragment", id="1", data=data, num=num, total=2)

    assert (await client.receive())["id"] == "c"


async def test_what_a_client_holds_ends_with_it(robot: Robot, node: Node) -> None:
    """Its subscriptions and, a while later, its publishers."""
    async with rosbridge_client(robot) as client:
        client.send("subscribe", topic="/a", type="std_msgs/String")
        await settle()
        assert node.count_subscribers("/a") == 1

    await settle()
    assert node.count_subscribers("/a") == 0


async def test_one_op_that_waits_does_not_hold_up_another(
    client: RosbridgeClient, node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The description of an unknown type may take seconds; a command does not wait for it."""
    never = asyncio.Event()

    async def wait(*_: object, **__: object) -> None:
        await never.wait()

    monkeypatch.setattr(client.session, "subscribe", wait)
    reader = node.create_subscription(String, "/words", qos_profile=10)
    client.send("subscribe", topic="/slow")
    client.send("publish", topic="/words", type="std_msgs/String", msg={"data": "now"})

    assert (await reader.receive()).data == "now"


async def test_a_burst_of_messages_is_published_whole_and_in_order(
    client: RosbridgeClient, node: Node
) -> None:
    """A frame is not refused because earlier ones have not been processed yet."""
    reader = node.create_subscription(Int32, "/count", qos_profile=1000)
    client.send("advertise", topic="/count", type="std_msgs/Int32")
    for number in range(500):
        client.send("publish", topic="/count", msg={"data": number})

    got = [to_builtins(await reader.receive())["data"] for _ in range(500)]

    assert got == list(range(500))


async def test_a_page_may_subscribe_to_very_many_topics_at_once(
    client: RosbridgeClient, node: Node
) -> None:
    """When it is loaded, all its ops arrive in one burst, which is not an attack."""
    for number in range(60):
        for op in ("advertise", "subscribe"):
            client.send(op, topic=f"/t{number}", type="std_msgs/String")
    client.send("call_service", service="/rosapi/topics", id="end")

    topics = (await client.receive())["values"]["topics"]

    assert len([topic for topic in topics if topic.startswith("/t")]) == 60


@pytest.mark.parametrize("op", ["advertise", "subscribe"])
async def test_the_ids_of_one_topic_are_bounded(client: RosbridgeClient, op: str) -> None:
    """Otherwise a client could make the gateway keep, and combine, any number of them."""
    for number in range(65):
        client.send(op, topic="/a", type="std_msgs/String", id=str(number))

    refused = await client.receive()

    assert (refused["op"], refused["id"]) == ("status", "64")
    assert "64 ids" in refused["msg"]


@pytest.mark.parametrize("op", ["advertise", "publish"])
async def test_a_publisher_of_another_type_is_refused(
    client: RosbridgeClient, node: Node, op: str
) -> None:
    """No subscription would receive it, and its author would look for the reason in vain."""
    node.create_subscription(Int32, "/count", print)
    client.send(op, topic="/count", type="std_msgs/String", id="a", msg={})

    status = await client.receive()

    assert "/count has the type std_msgs/msg/Int32" in status["msg"]


async def test_a_command_is_as_old_as_its_frame(
    client: RosbridgeClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even if it then waits for an earlier op, and whatever the client claims."""
    seen: list[int] = []

    async def publish(*_: object, arrived_ns: int) -> None:
        seen.append(arrived_ns)

    monkeypatch.setattr(client.session, "publish", publish)
    monkeypatch.setattr(client.session.arrivals, "arrival_ns", lambda: 42)
    client.send("publish", topic="/words", type="std_msgs/String", arrived_ns=10**30)
    await settle()

    assert seen == [42]
