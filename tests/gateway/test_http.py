"""HTTP: what curl and programs do with the robot, and what is refused."""

from __future__ import annotations

import asyncio
import json
import socket
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import httpx
import numpy as np
import pytest

from aionode import image
from aionode.action import CancelResponse, GoalResponse, ServerGoalHandle
from aionode.engine.context import Context
from aionode.gateway import Gateway, Policy
from aionode.gateway.server.http11 import HttpConnection
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image, LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.support.http_client import http_client

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""A request then finds the message, whichever arrives first."""

NodeFactory = Callable[..., Node]


@asynccontextmanager
async def client_of(context: Context, policy: str | Policy) -> AsyncIterator[httpx.AsyncClient]:
    """Yield a client of a gateway with a policy."""
    found = Policy.parse(policy) if isinstance(policy, str) else policy
    async with (
        Node("gateway", context=context) as node,
        Gateway(node, found, port=0) as gateway,
        http_client(gateway.port) as client,
    ):
        yield client


@pytest.fixture
async def client(aionode_context: Context) -> AsyncIterator[httpx.AsyncClient]:
    """A client that may do everything."""
    async with client_of(aionode_context, Policy.default(allow_write=True)) as found:
        yield found


@pytest.fixture
async def robot(node_factory: NodeFactory) -> Node:
    """The node of a robot."""
    return node_factory("robot")


def data_of(lines: list[str]) -> list[Any]:
    """Return the data of server-sent events."""
    return [json.loads(line.removeprefix("data: ")) for line in lines if line.startswith("data: ")]


# The graph


async def test_the_graph_is_listed_as_the_command_line_prints_it(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """One form for programs, whichever way they ask."""
    robot.create_publisher(String, "/chatter", 10)
    robot.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response())

    topics = (await client.get("/topics")).json()
    services = (await client.get("/services")).json()
    nodes = (await client.get("/nodes")).json()
    details = (await client.get("/nodes/robot")).json()

    assert {"name": "/chatter", "types": ["std_msgs/msg/String"]} in topics
    assert {"name": "/add", "types": ["example_interfaces/srv/AddTwoInts"]} in services
    assert "/robot" in nodes
    assert details["publishers"]["/chatter"] == ["std_msgs/msg/String"]


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("/topics/nothing", "not_found"),
        ("/nodes/nobody", "not_found"),
        ("/parameters/nobody/rate", "not_found"),
        ("/nonsense", "not_found"),
    ],
)
async def test_a_name_that_does_not_exist_is_reported_with_a_code(
    client: httpx.AsyncClient, path: str, code: str
) -> None:
    """A program reads the code, and a person the text."""
    answer = await client.get(path)

    assert answer.status_code == 404
    assert answer.json()["code"] == code
    assert answer.json()["error"]


# Topics


async def test_the_next_message_is_json(client: httpx.AsyncClient, robot: Node) -> None:
    """NaN becomes null, since JSON has no NaN."""
    scan = LaserScan(ranges=[1.5, float("nan")])
    robot.create_publisher(LaserScan, "/scan", LATCHED).publish(scan)

    answer = await client.get("/topics/scan")

    assert answer.headers["content-type"] == "application/json"
    assert answer.json()["ranges"] == [1.5, None]


async def test_a_name_may_have_its_slash(client: httpx.AsyncClient, robot: Node) -> None:
    """Programs append the full name of a topic to ``/topics/``."""
    robot.create_publisher(String, "/counter", LATCHED).publish(String(data="1"))

    assert (await client.get("/topics//counter")).json() == {"data": "1"}


async def test_a_topic_without_messages_is_waited_for_in_vain(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """The wait is limited, and the caller may choose the limit."""
    robot.create_publisher(String, "/chatter", 10)

    answer = await client.get("/topics/chatter?timeout_sec=0")

    assert (answer.status_code, answer.json()["code"]) == (504, "timeout")


@pytest.mark.parametrize("query", ["timeout_sec=-1", "timeout_sec=nan", "timeout_sec=soon"])
async def test_a_number_of_the_query_is_checked(
    client: httpx.AsyncClient, robot: Node, query: str
) -> None:
    """A request cannot wait forever."""
    robot.create_publisher(String, "/chatter", 10)

    answer = await client.get(f"/topics/chatter?{query}")

    assert (answer.status_code, answer.json()["code"]) == (400, "bad_request")


async def test_messages_are_a_stream_of_events(client: httpx.AsyncClient, robot: Node) -> None:
    """An EventSource of a page gets each message."""
    publisher = robot.create_publisher(String, "/chatter", 10)
    async with client.stream(
        "GET", "/topics/chatter", headers={"Accept": "text/event-stream"}
    ) as answer:
        lines = answer.aiter_lines()
        assert await anext(lines) == ": alive"  # the subscription is there
        for text in ("one", "two"):
            publisher.publish(String(data=text))
        read = [await anext(lines) for _ in range(5)]

    assert answer.headers["content-type"].startswith("text/event-stream")
    assert data_of(read) == [{"data": "one"}, {"data": "two"}]


async def test_a_slow_stream_of_events_has_the_last_message(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """The first and the last message of a burst are sent, with the requested time between them."""
    publisher = robot.create_publisher(String, "/chatter", 10)
    async with client.stream(
        "GET", "/topics/chatter?min_period_sec=0.05", headers={"Accept": "text/event-stream"}
    ) as answer:
        lines = answer.aiter_lines()
        assert await anext(lines) == ": alive"  # the subscription is there
        for text in "abcde":
            publisher.publish(String(data=text))
        read = [await anext(lines) for _ in range(5)]

    assert data_of(read) == [{"data": "a"}, {"data": "e"}]


async def test_a_closed_stream_leaves_no_subscription(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """Everything that a request began ends with its connection."""
    publisher = robot.create_publisher(String, "/chatter", 10)
    async with client.stream(
        "GET", "/topics/chatter", headers={"Accept": "text/event-stream"}
    ) as answer:
        await anext(answer.aiter_lines())
        assert publisher.get_subscription_count() == 1

    await robot.graph.until(lambda: publisher.get_subscription_count() == 0)


async def test_a_stream_ends_with_the_rights_of_its_caller(
    aionode_context: Context, robot: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """As when the gateway stops: the stream is complete, and the log has no error."""
    robot.create_publisher(String, "/chatter", 10)
    async with (
        Node("gateway", context=aionode_context) as node,
        Gateway(node, port=0) as gateway,
        http_client(gateway.port) as client,
        client.stream("GET", "/topics/chatter", headers={"Accept": "text/event-stream"}) as answer,
    ):
        lines = answer.aiter_lines()
        assert await anext(lines) == ": alive"

        gateway.clients.use_policy(Policy.parse(""))

        assert [line async for line in lines] == [""]
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


async def test_a_message_is_published(client: httpx.AsyncClient, robot: Node) -> None:
    """The robot gets the message, and the caller only a confirmation."""
    subscription = robot.create_subscription(String, "/chatter")

    answer = await client.post("/topics/chatter", json={"data": "hello"})

    assert answer.status_code == 204
    assert (await anext(subscription)).data == "hello"


async def test_bytes_are_base64_in_both_directions(client: httpx.AsyncClient, robot: Node) -> None:
    """A client can send what it reads."""
    subscription = robot.create_subscription(CompressedImage, "/in")
    sent = CompressedImage(format="raw", data=b"\x00\xff")
    robot.create_publisher(CompressedImage, "/out", LATCHED).publish(sent)
    headers = {"Accept": "application/json"}

    read = (await client.get("/topics/out", headers=headers)).json()
    answer = await client.post("/topics/in", json=read)

    assert answer.status_code == 204
    assert bytes((await anext(subscription)).data) == b"\x00\xff"


@pytest.mark.parametrize(
    ("body", "media_type", "status", "code"),
    [
        (b'{"data": 1}', "application/json", 400, "invalid_message"),
        (b'{"text": "a"}', "application/json", 400, "invalid_message"),
        (b"{", "application/json", 400, "bad_request"),
        (b"[" * 100_000, "application/json", 400, "bad_request"),
        (b'{"data": "a"}', "text/plain", 415, "unsupported"),
        (b'"' + b"a" * 10_000_001, "application/json", 413, "too_large"),
    ],
)
async def test_a_body_that_is_no_message_is_refused(
    client: httpx.AsyncClient, robot: Node, body: bytes, media_type: str, status: int, code: str
) -> None:
    """A body that would exhaust the parser's stack or the robot's memory is refused as well."""
    robot.create_subscription(String, "/chatter")

    answer = await client.post(
        "/topics/chatter", content=body, headers={"Content-Type": media_type}
    )

    assert (answer.status_code, answer.json()["code"]) == (status, code)


async def test_a_body_that_is_too_large_need_not_be_sent(aionode_context: Context) -> None:
    """A caller that asks first, as curl does, is refused by the size that it names."""
    async with client_of(aionode_context, Policy.default(allow_write=True)) as client:
        reader, writer = await asyncio.open_connection("127.0.0.1", client.base_url.port)
        host = f"Host: 127.0.0.1:{client.base_url.port}\r\n"
        body = "Expect: 100-continue\r\nContent-Length: 10000001\r\n"
        writer.write(f"POST /topics/chatter HTTP/1.1\r\n{host}{body}\r\n".encode())
        answer = await reader.readline()
        writer.close()

    assert answer.split()[1] == b"413"


async def test_a_body_of_unknown_size_is_refused_once_it_is_too_large(
    client: httpx.AsyncClient,
) -> None:
    """A caller that streams it names no size."""

    async def parts() -> AsyncIterator[bytes]:
        for _ in range(11):
            yield b"a" * 1_000_000

    headers = {"Content-Type": "application/json"}
    answer = await client.post("/topics/chatter", content=parts(), headers=headers)

    assert (answer.status_code, answer.json()["code"]) == (413, "too_large")


async def test_a_body_that_does_not_come_has_an_end(aionode_context: Context) -> None:
    """A caller that sends one byte a minute does not keep a place forever."""
    policy = """
        [[who]]
        name = "local"
        loopback = true
        [[allow]]
        publish = "/**"
        [limits]
        handshake_sec = 0.5
    """
    async with client_of(aionode_context, policy) as client:
        reader, writer = await asyncio.open_connection("127.0.0.1", client.base_url.port)
        host = f"Host: 127.0.0.1:{client.base_url.port}\r\n"
        writer.write(f"POST /topics/chatter HTTP/1.1\r\n{host}Content-Length: 9\r\n\r\n".encode())
        answer = await reader.readline()
        writer.close()

    assert answer.split()[1] == b"408"


# Images


def raw_image() -> Image:
    """Return an image of two by two pixels."""
    return Image(height=2, width=2, encoding="bgra8", step=8, data=bytes(range(16)))


@pytest.mark.parametrize("path", ["/topics/image", "/topics/image.jpeg"])
async def test_an_image_is_a_picture(client: httpx.AsyncClient, robot: Node, path: str) -> None:
    """A page shows it with `<img src>`."""
    robot.create_publisher(Image, "/image", LATCHED).publish(raw_image())

    answer = await client.get(path)

    assert answer.headers["content-type"] == "image/jpeg"
    picture = image.decompress(CompressedImage(data=answer.content))
    assert (picture.width, picture.height) == (2, 2)


async def test_a_compressed_image_passes_through(client: httpx.AsyncClient, robot: Node) -> None:
    """It is not decoded, so it costs nothing, and Pillow is not needed."""
    png = b"\x89PNG\r\n\x1a\nand so on"
    message = CompressedImage(format="png", data=png)
    robot.create_publisher(CompressedImage, "/image", LATCHED).publish(message)

    answer = await client.get("/topics/image")

    assert (answer.headers["content-type"], answer.content) == ("image/png", png)


async def test_images_are_a_stream_of_pictures(client: httpx.AsyncClient, robot: Node) -> None:
    """Browsers show multipart/x-mixed-replace as a video."""
    publisher = robot.create_publisher(Image, "/image", LATCHED)
    publisher.publish(raw_image())

    async with client.stream("GET", "/topics/image.mjpeg") as answer:
        chunks = answer.aiter_bytes()
        read = await anext(chunks)
        publisher.publish(raw_image())
        read += await anext(chunks)

    assert answer.headers["content-type"] == "multipart/x-mixed-replace; boundary=picture"
    assert read.count(b"--picture\r\nContent-Type: image/jpeg\r\n") == 2


@pytest.mark.parametrize(
    ("encoding", "pixels", "shown"),
    [
        ("mono16", np.array([[100, 300]], np.uint16), [[0, 255]]),
        ("16UC1", np.array([[0, 500], [1000, 250]], np.uint16), [[0, 128], [255, 64]]),
        ("16SC1", np.array([[-5, 5]], np.int16), [[0, 255]]),
        ("32FC1", np.array([[1.0, np.nan], [np.inf, 2.0]], np.float32), [[0, 0], [0, 255]]),
        ("32FC1", np.full((1, 2), np.nan, np.float32), [[0, 0]]),
        ("64FC1", np.array([[-1e308, 1e308]]), [[0, 255]]),
        ("8UC1", np.array([[7, 9]], np.uint8), [[7, 9]]),
        ("8UC3", np.array([[[1, 2, 3]]], np.uint8), [[[3, 2, 1]]]),
        ("rgb16", np.array([[[0x100, 0x200, 0x300]]], np.uint16), [[[1, 2, 3]]]),
        ("bayer_rggb8", np.array([[10, 20], [30, 40]], np.uint8), [[[10, 25, 40]] * 2] * 2),
        ("bayer_gbrg8", np.array([[10, 20], [30, 40]], np.uint8), [[[30, 25, 20]] * 2] * 2),
        ("bayer_grbg8", np.array([[10, 20, 30]], np.uint8), [[[20, 15, 10]] * 2 + [[30] * 3]]),
        ("yuv422", np.array([[[128, 50], [128, 60]]], np.uint8), [[[50] * 3, [60] * 3]]),
        (
            "yuv422_yuy2",
            np.array([[[50, 128], [60, 228]]], np.uint8),
            [[[190, 0, 50], [200, 0, 60]]],
        ),
    ],
)
async def test_an_image_of_any_type_is_shown(
    client: httpx.AsyncClient, robot: Node, encoding: str, pixels: Any, shown: Any
) -> None:
    """Depth and raw images do not have eight bits: they are scaled, and NaN is dark."""
    robot.create_publisher(Image, "/image", LATCHED).publish(image.from_numpy(pixels, encoding))

    png = await client.get("/topics/image", headers={"Accept": "image/png"})
    jpeg = await client.get("/topics/image")

    assert (png.headers["content-type"], jpeg.headers["content-type"]) == (
        "image/png",
        "image/jpeg",
    )
    seen = image.to_numpy(image.decompress(CompressedImage(data=png.content)))
    assert seen.tolist() == shown


async def test_channels_that_are_no_colours_are_refused(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """The caller learns which numbers are allowed."""
    flow = image.from_numpy(np.zeros((2, 2, 2), np.float32), "32FC2")
    robot.create_publisher(Image, "/flow", LATCHED).publish(flow)

    answer = await client.get("/topics/flow")

    assert (answer.status_code, answer.json()["code"]) == (422, "unsupported_image")
    assert "use 1, 3 or 4" in answer.json()["error"]


@pytest.mark.parametrize("compressed", [False, True])
async def test_a_picture_has_the_width_and_quality_that_are_asked_for(
    client: httpx.AsyncClient, robot: Node, *, compressed: bool
) -> None:
    """For thumbnails over a slow link; compressed images are made smaller, too."""
    noise = np.random.default_rng(1).integers(0, 255, (60, 100, 3), np.uint8)
    message = image.from_numpy(noise, "rgb8")
    if compressed:
        robot.create_publisher(CompressedImage, "/image", LATCHED).publish(image.compress(message))
    else:
        robot.create_publisher(Image, "/image", LATCHED).publish(message)

    small = image.decompress(
        CompressedImage(data=(await client.get("/topics/image?width=50")).content)
    )
    coarse = await client.get("/topics/image?quality=5")
    fine = await client.get("/topics/image?quality=95")
    png = await client.get("/topics/image.png?width=200")

    assert (small.width, small.height) == (50, 30)
    assert len(coarse.content) < len(fine.content) / 3
    assert png.headers["content-type"] == "image/png"
    assert image.decompress(CompressedImage(data=png.content)).width == 100


async def test_compressed_depth_is_shown(client: httpx.AsyncClient, robot: Node) -> None:
    """Scaled by its range, like uncompressed depth."""
    pixels = np.linspace(500, 2500, 40 * 30).reshape(30, 40).astype(np.uint16)
    file = image.compress(image.from_numpy(pixels, "mono16"), "png")
    depth = CompressedImage(format="16UC1; compressedDepth png", data=bytes(12) + bytes(file.data))
    robot.create_publisher(CompressedImage, "/depth", LATCHED).publish(depth)

    answer = await client.get("/topics/depth.png")

    shown = image.to_numpy(image.decompress(CompressedImage(data=answer.content)))
    assert (shown.min(), shown.max()) == (0, 255)
    assert shown.shape == pixels.shape


@pytest.mark.parametrize("query", ["?width=-1", "?width=x", "?quality=101", ".png?quality=5"])
async def test_a_size_or_quality_that_does_not_fit_is_refused(
    client: httpx.AsyncClient, robot: Node, query: str
) -> None:
    """No requested option is ignored."""
    robot.create_publisher(Image, "/image", LATCHED).publish(raw_image())

    assert (await client.get(f"/topics/image{query}")).status_code == 400


@pytest.mark.parametrize(
    ("accept", "media_type"),
    [
        ("image/png", "image/png"),
        ("image/png;q=0.5, image/jpeg", "image/jpeg"),
        ("image/jpeg;q=0.5, image/png;q=0.9", "image/png"),
        ("image/png, */*;q=0.1", "image/png"),
        ("image/png;q=nonsense, */*", "image/jpeg"),
        ("image/avif,image/webp,image/png,image/svg+xml,image/*;q=0.8,*/*;q=0.5", "image/jpeg"),
        ("*/*", "image/jpeg"),
    ],
)
async def test_the_caller_chooses_the_format_of_a_picture(
    client: httpx.AsyncClient, robot: Node, accept: str, media_type: str
) -> None:
    """A browser's list of formats is not a preference; a PNG from a camera is large."""
    robot.create_publisher(Image, "/image", LATCHED).publish(raw_image())

    answer = await client.get("/topics/image", headers={"Accept": accept})

    assert answer.headers["content-type"] == media_type


async def test_without_pillow_an_image_is_refused(
    client: httpx.AsyncClient, robot: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pillow is not part of the extra: the answer says how to install it."""
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    monkeypatch.setitem(sys.modules, "PIL", None)
    robot.create_publisher(Image, "/image", LATCHED).publish(raw_image())

    answer = await client.get("/topics/image")

    assert (answer.status_code, answer.json()["code"]) == (501, "not_installed")
    assert "pip install pillow" in answer.json()["error"]


async def test_a_topic_without_images_has_no_picture(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """The suffix is the caller's mistake."""
    robot.create_publisher(String, "/chatter", LATCHED).publish(String(data="a"))

    answer = await client.get("/topics/chatter.jpeg")

    assert (answer.status_code, answer.json()["code"]) == (406, "not_acceptable")


# Services


async def test_a_service_is_called(client: httpx.AsyncClient, robot: Node) -> None:
    """The response is the answer."""
    robot.create_service(
        AddTwoInts, "/add", lambda request: AddTwoInts.Response(sum=request.a + request.b)
    )

    answer = await client.post("/services/add", json={"a": 2, "b": 3})

    assert answer.json() == {"sum": 5}


async def test_a_service_that_fails_is_answered_with_its_text(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """It is the robot's failure, not the caller's."""

    def fail(request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise ValueError("the motor is hot")

    robot.create_service(AddTwoInts, "/add", fail)

    answer = await client.post("/services/add", json={})

    assert (answer.status_code, answer.json()["code"]) == (502, "call_failed")
    assert "the motor is hot" in answer.json()["error"]


async def test_a_call_without_an_answer_has_an_end(client: httpx.AsyncClient, robot: Node) -> None:
    """The caller chooses how long it waits."""

    async def wait(request: AddTwoInts.Request) -> AddTwoInts.Response:
        await asyncio.Event().wait()
        return AddTwoInts.Response()

    robot.create_service(AddTwoInts, "/add", wait)

    answer = await client.post("/services/add?timeout_sec=0.01", json={})

    assert (answer.status_code, answer.json()["code"]) == (504, "timeout")


async def test_a_service_that_nobody_knows_is_not_found(client: httpx.AsyncClient) -> None:
    """Its type is unknown as well."""
    answer = await client.post("/services/add", json={})

    assert (answer.status_code, answer.json()["code"]) == (404, "unknown_type")


# Actions


class Counter:
    """An action server that counts up to its order, waits, and records how its goals end."""

    def __init__(self, node: Node) -> None:
        self.ended: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        self.began = asyncio.Event()
        self.go_on = asyncio.Event()
        node.create_action_server(
            Fibonacci,
            "/count",
            self.execute,
            goal_callback=self.accept,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def accept(self, goal: Fibonacci.Goal) -> GoalResponse:
        """Reject negative orders."""
        return GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT

    async def execute(self, goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        """Give feedback once, and succeed when allowed to continue."""
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0]))
        self.began.set()
        try:
            await self.go_on.wait()
        except asyncio.CancelledError:
            self.ended.set_result("cancelled")
            raise
        self.ended.set_result("succeeded")
        goal.succeed()
        return Fibonacci.Result(sequence=[0, goal.request.order])


async def test_a_goal_is_followed_by_events(client: httpx.AsyncClient, robot: Node) -> None:
    """Feedback is sent as it arrives, and the result is the last event."""
    counter = Counter(robot)
    read: list[str] = []

    async with client.stream("POST", "/actions/count", json={"order": 7}) as answer:
        async for line in answer.aiter_lines():
            read.append(line)
            if line == "event: feedback":
                counter.go_on.set()

    assert [line for line in read if line.startswith("event: ")] == [
        "event: accepted",
        "event: feedback",
        "event: result",
    ]
    accepted, feedback, result = data_of(read)
    assert feedback == {"sequence": [0]}
    assert result == {
        "goal_id": accepted["goal_id"],
        "status": "SUCCEEDED",
        "error": "",
        "result": {"sequence": [0, 7]},
    }


async def test_the_feedback_of_all_clients_is_a_topic(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """Its type is not defined in a file: it belongs to the action."""
    feedback = Fibonacci.Impl.FeedbackMessage(feedback=Fibonacci.Feedback(sequence=[0, 1]))
    topic = robot.create_publisher(type(feedback), "/count/_action/feedback", LATCHED)
    topic.publish(feedback)

    answer = await client.get("/topics/count/_action/feedback")

    assert answer.json()["feedback"] == {"sequence": [0, 1]}


async def test_closing_the_stream_cancels_the_goal(client: httpx.AsyncClient, robot: Node) -> None:
    """Motion ends when its client has gone."""
    counter = Counter(robot)

    async with client.stream("POST", "/actions/count", json={"order": 7}) as answer:
        await anext(answer.aiter_lines())

    assert await counter.ended == "cancelled"


async def test_a_goal_without_a_stream_ends_with_its_connection_too(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """A caller that accepts JSON gets only the result, and may leave earlier."""
    counter = Counter(robot)
    headers = {"Accept": "application/json"}
    async with asyncio.TaskGroup() as tasks:
        asking = tasks.create_task(
            client.post("/actions/count", json={"order": 7}, headers=headers)
        )
        await counter.began.wait()
        asking.cancel()

    assert await counter.ended == "cancelled"


async def test_the_result_alone_is_json(client: httpx.AsyncClient, robot: Node) -> None:
    """For a script that does not want events."""
    Counter(robot).go_on.set()

    answer = await client.post(
        "/actions/count", json={"order": 7}, headers={"Accept": "application/json"}
    )

    assert answer.json()["result"] == {"sequence": [0, 7]}


async def test_a_rejected_goal_has_no_stream(client: httpx.AsyncClient, robot: Node) -> None:
    """A program checks the status first."""
    Counter(robot)

    answer = await client.post("/actions/count", json={"order": -1})

    assert (answer.status_code, answer.json()["code"]) == (409, "rejected")


@pytest.mark.skipif(not hasattr(socket, "TCP_USER_TIMEOUT"), reason="needs Linux")
async def test_a_caller_of_a_goal_is_lost_when_its_host_is_silent(
    client: httpx.AsyncClient, robot: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Unplugging a cable does not close a connection: the kernel is told to probe it."""
    Counter(robot)
    limits_ms: list[int] = []

    def lose_after(self: HttpConnection, seconds: float) -> None:
        original(self, seconds)
        connected = self.transport.get_extra_info("socket")
        limits_ms.append(connected.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT))
        limits_ms.append(connected.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE))

    original = HttpConnection.lose_after
    monkeypatch.setattr(HttpConnection, "lose_after", lose_after)

    async with client.stream("POST", "/actions/count", json={"order": 7}) as answer:
        await anext(answer.aiter_lines())

    assert limits_ms == [3000, 1]


# Parameters


async def test_parameters_are_read_and_set(client: httpx.AsyncClient, robot: Node) -> None:
    """A whole number is accepted for a floating-point parameter: JavaScript writes 2.0 as 2."""
    robot.declare_parameter("rate", 1.5)
    robot.declare_parameter("gains", [0.5, 1.0])

    every = (await client.get("/parameters/robot")).json()
    changed = await client.put("/parameters/robot/rate", json=2)
    one = (await client.get("/parameters/robot/rate")).json()
    gains = await client.put("/parameters/robot/gains", json=[1, 2])

    assert every["rate"] == 1.5
    assert every["gains"] == [0.5, 1.0]
    assert (changed.status_code, one) == (204, 2.0)
    assert gains.status_code == 204
    assert list(robot.get_parameter("gains").value) == [1.0, 2.0]


async def test_a_parameter_that_the_node_rejects_is_reported_with_its_reason(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """The node has the last word."""
    robot.declare_parameter("name", "a")

    answer = await client.put("/parameters/robot/name", json=[True])

    assert (answer.status_code, answer.json()["code"]) == (409, "rejected")
    assert "name" in answer.json()["error"]


# Documents


async def test_the_document_has_what_the_caller_may_do(
    aionode_context: Context, robot: Node
) -> None:
    """It is derived from the policy, so it tells a client what it can do."""
    policy = """
        [[who]]
        name = "local"
        loopback = true
        [[allow]]
        see = "/**"
        subscribe = "/scan"
        call = "/add"
    """
    robot.create_publisher(LaserScan, "/scan", 10)
    robot.create_publisher(String, "/secret", 10)
    robot.create_subscription(Twist, "/cmd_vel")
    robot.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response())
    async with client_of(aionode_context, policy) as client:
        document = (await client.get("/openapi.json")).json()

    assert document["openapi"] == "3.1.0"
    paths = {path for path in document["paths"] if path.startswith(("/topics/", "/services/"))}
    assert paths == {"/topics/scan", "/services/add"}
    assert "post" not in document["paths"]["/topics/scan"]


async def test_the_openapi_document_leaves_infrastructure_out_unless_all_is_asked_for(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """For a robot with three nodes, 21 of 23 services would be infrastructure."""
    robot.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response())
    of_user = (await client.get("/openapi.json")).json()["paths"]
    everything = (await client.get("/openapi.json?all=1")).json()["paths"]

    assert "/services/add" in of_user
    assert not {"/services/robot/get_parameters", "/topics/rosout"} & set(of_user)
    assert {"/services/add", "/services/robot/get_parameters", "/topics/rosout"} <= set(everything)
    assert "/parameters/robot/{parameter}" in of_user


async def test_metrics_count_what_the_endpoints_count(
    client: httpx.AsyncClient, robot: Node
) -> None:
    """Prometheus refuses two samples with the same labels, so two publishers are merged."""
    for _ in range(2):
        robot.create_publisher(String, "/chatter", 10).publish(String(data="a"))

    text = (await client.get("/metrics")).text

    labels = '{node="/robot",entity="publisher",name="/chatter"}'
    assert f"aionode_published_total{labels} 2" in text.splitlines()
    assert 'aionode_gateway_sessions{way="http"} 1' in text.splitlines()
    samples = [line.rpartition(" ") for line in text.splitlines() if not line.startswith("#")]
    names = [name for name, _, _ in samples]
    assert len(names) == len(set(names))
    assert all(float(value) >= 0 for _, _, value in samples)
    assert 'aionode_node_running{node="/robot"} 1' in text.splitlines()


async def test_the_health_is_visible_to_everyone(aionode_context: Context) -> None:
    """A process monitor has no token, and the answer reveals nothing else."""
    policy = """
        [[who]]
        name = "operator"
        token = "secret"
        [[allow]]
        see = "/**"
    """
    async with client_of(aionode_context, policy) as client:
        healthy, refused = await client.get("/healthz"), await client.get("/metrics")

    assert (healthy.status_code, healthy.json()) == (200, {"ok": True})
    assert (refused.status_code, refused.json()["code"]) == (401, "unauthorized")
    assert refused.headers["www-authenticate"].startswith("Bearer")
