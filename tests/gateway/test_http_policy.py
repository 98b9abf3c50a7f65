"""The rules of a policy over HTTP, each allowed and refused; and who commands a topic."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import httpx
import pytest
from websockets.asyncio.client import connect

from aionode.engine.context import Context
from aionode.gateway import Gateway, Identity, Policy
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.support.http_client import http_client

WHO = """
[[who]]
name = "local"
loopback = true
"""

VERBS = ("see", "subscribe", "publish", "call", "goal", "parameter")
EVERYTHING = "\n".join([WHO, "[[allow]]", *(f'{verb} = "/**"' for verb in VERBS), ""])


class Robot(Node):
    """A node with one of everything."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_publisher(String, "/status", latched).publish(String(data="ready"))
        self.commands = self.create_subscription(Twist, "/cmd_vel")
        self.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response(sum=1))
        self.create_action_server(Fibonacci, "/count", lambda _: Fibonacci.Result())
        self.declare_parameter("rate", 1.0)


@asynccontextmanager
async def robot_and_client(
    context: Context, policy: str
) -> AsyncIterator[tuple[Robot, httpx.AsyncClient]]:
    """Yield a robot, and a client of a gateway with a policy."""
    async with (
        Robot(context) as robot,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(policy), port=0) as gateway,
        http_client(gateway.port) as client,
    ):
        yield robot, client


TWIST = {"linear": {"x": 0.25}}

REQUESTS: dict[str, tuple[str, str, Any]] = {
    "subscribe": ("GET", "/topics/status", None),
    "publish": ("POST", "/topics/cmd_vel", TWIST),
    "call": ("POST", "/services/add", {}),
    "goal": ("POST", "/actions/count", {"order": 1}),
    "parameter": ("PUT", "/parameters/robot/rate", 2),
}
NAMES = {
    "subscribe": "/status",
    "publish": "/cmd_vel",
    "call": "/add",
    "goal": "/count",
    "parameter": "/robot:rate",
}


async def ask(client: httpx.AsyncClient, verb: str) -> httpx.Response:
    """Send one request to the robot."""
    method, path, body = REQUESTS[verb]
    headers = {"Content-Type": "application/json"}
    content = None if body is None else httpx.Request("POST", "http://a", json=body).content
    return await client.request(method, path, content=content, headers=headers)


@pytest.mark.parametrize("verb", REQUESTS)
async def test_what_a_rule_allows_is_done(aionode_context: Context, verb: str) -> None:
    """One rule for one name suffices."""
    policy = f'{WHO}[[allow]]\nsee = "/**"\n{verb} = "{NAMES[verb]}"\n'
    async with robot_and_client(aionode_context, policy) as (_, client):
        answer = await ask(client, verb)

    assert answer.is_success, answer.text


@pytest.mark.parametrize("verb", REQUESTS)
async def test_what_no_rule_allows_is_refused(aionode_context: Context, verb: str) -> None:
    """The robot is not touched, and the caller gets a code."""
    others = "".join(f'{each} = "{NAMES[each]}"\n' for each in NAMES if each != verb)
    policy = f'{WHO}[[allow]]\nsee = "/**"\n{others}'
    async with robot_and_client(aionode_context, policy) as (robot, client):
        answer = await ask(client, verb)
        rate = robot.get_parameter("rate").value

    assert (answer.status_code, answer.json()["code"]) == (403, "not_allowed")
    assert rate == 1.0


@pytest.mark.parametrize("verb", REQUESTS)
async def test_a_refusal_has_precedence(aionode_context: Context, verb: str) -> None:
    """Its reason is told."""
    policy = f'{EVERYTHING}[[refuse]]\n{verb} = "{NAMES[verb]}"\nbecause = "the arm is out"\n'
    async with robot_and_client(aionode_context, policy) as (_, client):
        answer = await ask(client, verb)

    assert (answer.status_code, answer.json()["code"]) == (403, "not_allowed")
    assert "the arm is out" in answer.json()["error"]


async def test_what_is_hidden_is_not_there(aionode_context: Context) -> None:
    """It is neither in the lists, nor found by name, nor in the document."""
    policy = f'{EVERYTHING}[[refuse]]\nsee = ["/status", "/robot"]\n'
    async with robot_and_client(aionode_context, policy) as (_, client):
        topics = (await client.get("/topics")).json()
        nodes = (await client.get("/nodes")).json()
        answer = await client.get("/topics/status")
        parameters = await client.get("/parameters/robot")
        document = (await client.get("/openapi.json")).json()

    assert "/status" not in [topic["name"] for topic in topics]
    assert "/robot" not in nodes
    assert answer.status_code == 404
    assert parameters.status_code == 404
    assert "/topics/status" not in document["paths"]


async def test_a_field_outside_of_its_limits_is_refused_or_clamped(
    aionode_context: Context,
) -> None:
    """As the rule says; a clamped one arrives at its limit."""
    policy = (
        f'{WHO}[[allow]]\npublish = "/cmd_vel"\n[allow.fields."linear.x"]\nmin = -0.5\nmax = 0.5\n'
        '[allow.fields."angular.z"]\nmin = -1.0\nmax = 1.0\noutside = "clamp"\n'
    )
    async with robot_and_client(aionode_context, policy) as (robot, client):
        fast = await client.post("/topics/cmd_vel", json={"linear": {"x": 0.75}})
        unknown = await client.post("/topics/cmd_vel", json={"linear": {"x": None}})
        turning = await client.post("/topics/cmd_vel", json={"angular": {"z": 3.0}})
        command = await anext(robot.commands)

    assert (fast.status_code, fast.json()["code"]) == (422, "out_of_limits")
    assert (unknown.status_code, unknown.json()["code"]) == (400, "invalid_message")
    assert turning.status_code == 204
    assert command.angular.z == 1.0


async def test_a_rate_and_a_size_are_limited(aionode_context: Context) -> None:
    """Each has its code."""
    policy = (
        f'{WHO}[[allow]]\npublish = "/cmd_vel"\nrate_hz = 0.01\n'
        '[[allow]]\npublish = "/text"\nmax_bytes = 100\n'
    )
    async with robot_and_client(aionode_context, policy) as (robot, client):
        robot.create_subscription(String, "/text")
        first, second = [await client.post("/topics/cmd_vel", json=TWIST) for _ in range(2)]
        large = await client.post("/topics/text", json={"data": "a" * 200})

    assert first.status_code == 204
    assert (second.status_code, second.json()["code"]) == (429, "too_fast")
    assert (large.status_code, large.json()["code"]) == (413, "too_large")


async def test_what_needs_a_person_is_refused_without_one(aionode_context: Context) -> None:
    """There is nobody to approve."""
    policy = f'{WHO}[[allow]]\ncall = "/add"\nask = true\n'
    async with robot_and_client(aionode_context, policy) as (_, client):
        answer = await ask(client, "call")

    assert (answer.status_code, answer.json()["code"]) == (403, "not_confirmed")


async def test_what_a_person_has_said_yes_to_is_done(aionode_context: Context) -> None:
    """The person is told who requests what."""
    asked: list[tuple[str, str, str]] = []

    async def ask_person(identity: Identity, verb: str, name: str, message: object) -> bool:
        asked.append((identity.name, verb, name))
        return True

    policy = Policy.parse(f'{WHO}[[allow]]\ncall = "/add"\nask = true\n')
    async with (
        Robot(aionode_context),
        Node("gateway", context=aionode_context) as node,
        Gateway(node, policy, port=0, ask=ask_person) as gateway,
        http_client(gateway.port) as client,
    ):
        answer = await ask(client, "call")

    assert answer.json() == {"sum": 1}
    assert asked == [("local", "call", "/add")]


COMMANDS = f"""
{WHO}
[[who]]
name = "pilot"
token = "secret"
[[allow]]
publish = "/cmd_vel"
lease = {{ ttl_sec = 1.0 }}
"""

SLOWLY = COMMANDS.replace("ttl_sec = 1.0", "ttl_sec = 60.0")


async def test_commands_that_stop_coming_are_followed_by_the_stop(aionode_context: Context) -> None:
    """A script that is killed, or a cable that is cut: nobody has to report it."""
    async with robot_and_client(aionode_context, COMMANDS) as (robot, client):
        for _ in range(2):  # each request is a session of its own, but there is one holder
            assert (await command(client)).status_code == 204
        while (await anext(robot.commands)).linear.x:
            pass


async def command(client: httpx.AsyncClient, **options: Any) -> httpx.Response:
    """Return the answer to a command.

    On a busy computer a command may have waited in a stalled gateway: that answer says to send it
    again.
    """
    while True:
        answer = await client.post("/topics/cmd_vel", json=TWIST, **options)
        if answer.status_code != 409 or answer.json()["code"] != "too_old":
            return answer


async def test_a_topic_that_another_client_commands_is_held(aionode_context: Context) -> None:
    """The other one learns who holds it."""
    async with robot_and_client(aionode_context, SLOWLY) as (_, client):
        await command(client)
        answer = await command(client, headers={"Authorization": "Bearer secret"})

    assert (answer.status_code, answer.json()["code"]) == (409, "held")
    assert "local" in answer.json()["error"]


async def post(url: Any, client: str = "", **headers: str) -> httpx.Response:
    """Return the answer to a command over its own connection."""
    async with http_client(url.port) as other:
        query = {"client": client} if client else {}
        return await command(other, params=query, headers=headers)


async def test_two_programs_with_one_identity_do_not_drive_at_once(
    aionode_context: Context,
) -> None:
    """The second learns who holds the topic, and how to use several connections as one client."""
    async with robot_and_client(aionode_context, SLOWLY) as (robot, client):
        for _ in range(2):
            assert (await command(client)).status_code == 204
        answer = await post(client.base_url)
        got = [(await anext(robot.commands)).linear.x for _ in range(2)]

    assert (answer.status_code, answer.json()["code"]) == (409, "held")
    assert "local commands it now, by another connection of http from 127.0.0.1" in answer.text
    assert "?client=NAME" in answer.text
    assert got == [0.25, 0.25]


async def test_a_named_client_is_one_over_all_its_connections(aionode_context: Context) -> None:
    """`curl` in a loop is such a client; another name, or none, is another client."""
    async with robot_and_client(aionode_context, SLOWLY) as (_, client):
        url = client.base_url
        codes = [(await post(url, name)).status_code for name in ("pad", "pad", "arm", "", "pad")]
        answer = await post(url, "arm")

    assert codes == [204, 204, 409, 409, 204]
    assert "by http as client 'pad'" in answer.json()["error"]
    assert "?client=" not in answer.json()["error"]


async def test_behind_a_proxy_a_connection_is_no_holder(aionode_context: Context) -> None:
    """It sends the requests of several programs over one connection; names tell them apart."""
    async with robot_and_client(aionode_context, SLOWLY) as (_, client):
        forwarded = {"X-Forwarded-For": "10.0.0.7", "Authorization": "Bearer secret"}
        codes = [
            (await command(client, headers=forwarded, params={"client": name})).status_code
            for name in ("", "", "pad")
        ]

    assert codes == [204, 409, 409]


async def test_the_name_of_a_client_is_short_and_shown_escaped(aionode_context: Context) -> None:
    """It is kept while the client commands, and shown to others."""
    async with robot_and_client(aionode_context, SLOWLY) as (_, client):
        long = await post(client.base_url, "x" * 101)
        await post(client.base_url, "pad\n\x1b[2J")
        held = await post(client.base_url)

    assert (long.status_code, long.json()["code"]) == (400, "bad_request")
    assert r"'pad\n\x1b[2J'" in held.json()["error"]


async def test_a_websocket_and_a_request_of_one_identity_are_two(aionode_context: Context) -> None:
    """Each protocol has its own holders, whoever the client is."""
    async with robot_and_client(aionode_context, SLOWLY) as (_, client):
        await command(client)
        async with connect(f"ws://127.0.0.1:{client.base_url.port}", proxy=None) as page:
            await page.send('{"op": "set_level", "level": "error"}')
            await page.send(
                '{"op": "publish", "topic": "/cmd_vel", "type": "geometry_msgs/Twist", "msg": {}}'
            )
            async with asyncio.timeout(20):
                told = await page.recv()

    assert "local commands it now" in told


ROUTES = [
    ("GET", "/topics"),
    ("GET", "/services"),
    ("GET", "/actions"),
    ("GET", "/nodes"),
    ("GET", "/nodes/robot"),
    ("GET", "/topics/status"),
    ("POST", "/topics/cmd_vel"),
    ("POST", "/services/add"),
    ("POST", "/actions/count"),
    ("GET", "/parameters/robot"),
    ("PUT", "/parameters/robot/rate"),
    ("GET", "/openapi.json"),
    ("GET", "/metrics"),
    ("GET", "/healthz"),
]


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Host": "evil.example"},
        {"Authorization": "Bearer wrong"},
    ],
    ids=lambda headers: "-".join(headers.values()),
)
async def test_a_page_of_another_origin_and_a_wrong_token_are_refused(
    aionode_context: Context, headers: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On every route, before it runs."""
    monkeypatch.setattr("aionode.gateway.server.door.MAX_WRONG", 100)
    async with robot_and_client(aionode_context, EVERYTHING) as (_, client):
        answers = {
            (method, path): await client.request(method, path, headers=headers)
            for method, path in ROUTES
        }

    public = {("GET", "/healthz")} if "Authorization" in headers else set()
    assert {route for route, answer in answers.items() if answer.status_code != 401} == public
    assert all(
        answer.headers["cross-origin-resource-policy"] == "same-origin"
        for answer in answers.values()
    )


async def test_what_is_hidden_by_its_type_is_not_counted_for_the_caller(
    aionode_context: Context,
) -> None:
    """The metrics name all topics that clients receive; a rule may hide all topics of a type."""
    policy = f"{EVERYTHING}[[refuse]]\nsee = '/**'\ntype = 'std_msgs/msg/String'\nwho = 'local'"
    policy += "\n[[who]]\nname = 'other'\ntoken = 'secret'"
    async with (
        Robot(aionode_context),
        Node("gateway", context=aionode_context) as node,
        Gateway(node, Policy.parse(policy), port=0) as gateway,
        gateway.clients.session(Identity("other"), "test") as session,
        http_client(gateway.port) as client,
    ):
        for topic in ("/status", "/cmd_vel"):
            await session.subscribe(topic, frame=lambda _: None, key=topic)
        text = (await client.get("/metrics")).text
    assert 'aionode_gateway_received{topic="/cmd_vel"}' in text
    assert "/status" not in text
