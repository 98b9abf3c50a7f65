"""A client of a gateway for each protocol, which makes one request and reports its outcome."""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any, Final, NamedTuple, Protocol

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from tests.support import waiting
from tests.support.http_client import http_client

__all__ = ["WAYS", "Answer", "Ask", "Way", "until", "way_in"]

PATIENCE_SEC: Final = 20.0
"""How long something may take that has to happen, on a machine that is busy."""


class Ask(NamedTuple):
    """What a client asks for.

    Attributes:
        verb: What it wants to do, as in a policy.
        name: The name; for a parameter, ``/node:parameter``.
        type_name: The name of the type; empty for a parameter.
        values: The values that it sends.
        is_done: Returns whether the robot did it, for ops without an answer.
    """

    verb: str
    name: str
    type_name: str
    values: Any
    is_done: Callable[[], bool]


class Answer(NamedTuple):
    """The answer to the client.

    Attributes:
        refusal: Why it was refused; empty if it was not.
        code: The code for programs, if the protocol has one.
    """

    refusal: str = ""
    code: str = ""


DONE: Final = Answer()


class Way(Protocol):
    """A client of one protocol."""

    async def do(self, asked: Ask) -> Answer:
        """Make a request, and wait until it is done or refused."""

    async def names(self) -> set[str]:
        """Return all names shown to the client: topics, services, actions, nodes, parameters."""


async def until(condition: Callable[[], Any]) -> Any:
    """Wait until a condition holds, and return its value.

    Raises:
        TimeoutError: it does not hold in time.
    """
    async with asyncio.timeout(PATIENCE_SEC):
        await waiting.until(condition)
    return condition()


class Frames:
    """The frames that a WebSocket has received: ops as dicts, binary frames as bytes."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.got: list[Any] = []
        self._count = 0

    async def read(self) -> None:
        """Read frames until cancelled."""
        async for frame in self.socket:
            self.got.append(json.loads(frame) if isinstance(frame, str) else frame)

    async def send(self, op: str, **fields: Any) -> None:
        """Send an op."""
        await self.socket.send(json.dumps({"op": op, **fields}))

    def new_id(self) -> str:
        """Return an unused id."""
        self._count += 1
        return f"id{self._count}"

    def first(self, **fields: Any) -> Any:
        """Return the first op with these fields, if it has arrived."""
        return next((each for each in self.got if has(each, fields)), None)


def has(frame: Any, fields: dict[str, Any]) -> bool:
    """Return whether a frame is an op with these fields."""
    return isinstance(frame, dict) and fields.items() <= frame.items()


# Rosbridge, with rosapi


class Rosbridge(Frames):
    """A client like roslibjs that has requested status messages."""

    async def do(self, asked: Ask) -> Answer:
        """Send the op for a request."""
        ops: dict[str, Callable[[Ask, str], Awaitable[Answer]]] = {
            "see": self._get,
            "subscribe": self._subscribe,
            "publish": self._publish,
            "call": self._call,
            "goal": self._goal,
            "parameter": self._set,
            "advertise": self._advertise,
        }
        self.got.clear()
        return await ops[asked.verb](asked, self.new_id())

    async def _subscribe(self, asked: Ask, id_: str) -> Answer:
        await self.send("subscribe", id=id_, topic=asked.name, type=asked.type_name)
        return await self._told(id_, lambda: self.first(op="publish", topic=asked.name))

    async def _publish(self, asked: Ask, id_: str) -> Answer:
        fields = {"topic": asked.name, "type": asked.type_name, "msg": asked.values}
        await self.send("publish", id=id_, **fields)
        return await self._told(id_, asked.is_done)

    async def _advertise(self, asked: Ask, id_: str) -> Answer:
        await self.send("advertise_service", id=id_, service=asked.name, type=asked.type_name)
        return await self._told(id_, asked.is_done)

    async def _told(self, id_: str, is_done: Callable[[], Any]) -> Answer:
        """Wait for the effect of an op, or for the status that says why there is none."""
        await until(lambda: self.first(op="status", id=id_) or is_done())
        status = self.first(op="status", id=id_)
        if status is None:
            return DONE
        assert status["level"] == "error"
        return Answer(status["msg"])

    async def _call(self, asked: Ask, id_: str) -> Answer:
        await self.send("call_service", id=id_, service=asked.name, args=asked.values)
        answer = await until(lambda: self.first(op="service_response", id=id_))
        return DONE if answer["result"] else Answer(answer["values"])

    async def _goal(self, asked: Ask, id_: str) -> Answer:
        fields = {"action": asked.name, "action_type": asked.type_name, "args": asked.values}
        await self.send("send_action_goal", id=id_, **fields)
        answer = await until(lambda: self.first(op="action_result", id=id_))
        return DONE if answer["result"] else Answer(answer["values"])

    async def _set(self, asked: Ask, _: str) -> Answer:
        args = {"name": asked.name, "value": json.dumps(asked.values)}
        answer = await self.rosapi("set_param", args)
        return DONE if answer["successful"] else Answer(answer["reason"])

    async def _get(self, asked: Ask, _: str) -> Answer:
        answer = await self.rosapi("get_param", [asked.name])
        return DONE if answer["successful"] else Answer(answer["reason"])

    async def rosapi(self, service: str, args: Any = ()) -> Any:
        """Return the response of a service of rosapi."""
        id_ = self.new_id()
        await self.send("call_service", id=id_, service=f"/rosapi/{service}", args=args)
        answer = await until(lambda: self.first(op="service_response", id=id_))
        assert answer["result"], answer
        return answer["values"]

    async def names(self) -> set[str]:
        """Call each service of rosapi that lists something."""
        lists = [
            (await self.rosapi(service))[field]
            for service, field in (
                ("topics", "topics"),
                ("topics_and_raw_types", "topics"),
                ("services", "services"),
                ("action_servers", "action_servers"),
                ("nodes", "nodes"),
                ("get_param_names", "names"),
            )
        ]
        for node in lists[4]:
            lists += (await self.rosapi("node_details", [node])).values()
        found = {name for names in lists for name in names}
        return {name for name in found if not name.startswith("/rosapi/")}


# HTTP


class Http:
    """A program that sends requests."""

    def __init__(self, client: httpx.AsyncClient) -> None:
        self.client = client

    accepts = "application/json"

    async def do(self, asked: Ask) -> Answer:
        """Send the HTTP request for it."""
        async with self.client.stream(**request_for(asked, self.accepts)) as response:
            return await self._answer(asked, response)

    async def _answer(self, _: Ask, response: httpx.Response) -> Answer:
        await response.aread()
        return answer_of(response)

    async def names(self) -> set[str]:
        """Get each list, the details of the nodes, the OpenAPI document, and the metrics."""
        found: set[str] = set()
        for kind in ("topics", "services", "actions"):
            found |= {each["name"] for each in await self.json(f"/{kind}")}
        for node in await self.json("/nodes"):
            found.add(node)
            details = await self.json(f"/nodes{node}")
            found |= {name for each in details.values() if isinstance(each, dict) for name in each}
            answer = await self.client.get(f"/parameters{node}")
            if answer.status_code == 200:
                found |= {f"{node}:{name}" for name in answer.json()}
        for path in (await self.json("/openapi.json"))["paths"]:
            found.add("/" + path.partition("/")[2].partition("/")[2])
        metrics = (await self.client.get("/metrics")).text
        found |= {text for text in metrics.split('"') if text.startswith("/")}
        return found - {"/"}

    async def json(self, path: str) -> Any:
        """Return the JSON at a path."""
        answer = await self.client.get(path)
        assert answer.status_code == 200, answer.text
        return answer.json()


class Events(Http):
    """A program that requests server-sent events of a topic or a goal."""

    accepts = "text/event-stream"

    async def _answer(self, asked: Ask, response: httpx.Response) -> Answer:
        if not response.is_success:
            return await super()._answer(asked, response)
        assert response.headers["content-type"].startswith("text/event-stream")
        wanted = "event: result" if asked.verb == "goal" else "data: "
        async for line in response.aiter_lines():
            if line.startswith(wanted):
                return DONE
        raise AssertionError("the stream has ended without it")


def request_for(asked: Ask, accept: str) -> dict[str, Any]:
    """Return the request for something."""
    routes = {
        "see": ("GET", "parameters"),
        "subscribe": ("GET", "topics"),
        "publish": ("POST", "topics"),
        "call": ("POST", "services"),
        "goal": ("POST", "actions"),
        "parameter": ("PUT", "parameters"),
    }
    method, kind = routes[asked.verb]
    return {
        "method": method,
        "url": f"/{kind}{asked.name.replace(':', '/')}",
        "params": {"type": asked.type_name} if method == "POST" else {},
        "json": None if method == "GET" else asked.values,
        "headers": {"Accept": accept},
    }


def answer_of(response: httpx.Response) -> Answer:
    """Return what a response says."""
    if response.is_success:
        return DONE
    body = response.json()
    assert set(body) == {"error", "code"}
    return Answer(body["error"], f"{response.status_code} {body['code']}")


# Foxglove


class Foxglove(Frames):
    """A client like Foxglove's application."""

    async def do(self, asked: Ask) -> Answer:
        """Send the frames for it."""
        ops: dict[str, Callable[[Ask], Awaitable[Answer]]] = {
            "see": self._get,
            "subscribe": self._subscribe,
            "publish": self._publish,
            "call": self._call,
            "parameter": self._set,
        }
        return await ops[asked.verb](asked)

    def announced(self, op: str, field: str, key: str, name: str) -> Any:
        """Return what was announced of a topic or service."""
        items = (each for frame in self.got if has(frame, {"op": op}) for each in frame[field])
        return next((each for each in items if each[key] == name), None)

    async def _subscribe(self, asked: Ask) -> Answer:
        name = asked.name
        channel = await until(lambda: self.announced("advertise", "channels", "topic", name))
        number = int(self.new_id()[2:])
        wish = {"id": number, "channelId": channel["id"]}
        await self.send("subscribe", subscriptions=[wish])
        head = struct.pack("<BI", 1, number)
        return await self._told(
            asked, lambda: any(isinstance(f, bytes) and f.startswith(head) for f in self.got)
        )

    async def _publish(self, asked: Ask) -> Answer:
        number = int(self.new_id()[2:])
        channel = {"id": number, "topic": asked.name, "encoding": "json"}
        await self.send("advertise", channels=[channel | {"schemaName": asked.type_name}])
        message = struct.pack("<BI", 1, number) + json.dumps(asked.values).encode()
        await self.socket.send(message)
        return await self._told(asked, asked.is_done)

    async def _call(self, asked: Ask) -> Answer:
        name = asked.name
        service = await until(lambda: self.announced("advertiseServices", "services", "name", name))
        number = int(self.new_id()[2:])
        head = struct.pack("<BIII", 2, service["id"], number, 4)
        await self.socket.send(head + b"json" + json.dumps(asked.values).encode())
        done = struct.pack("<BII", 3, service["id"], number)
        failed = {"op": "serviceCallFailure", "callId": number}
        await until(
            lambda: (
                self.first(**failed)
                or any(isinstance(f, bytes) and f.startswith(done) for f in self.got)
            )
        )
        failure = self.first(**failed)
        return DONE if failure is None else Answer(failure["message"])

    async def _get(self, asked: Ask) -> Answer:
        id_ = self.new_id()
        await self.send("getParameters", parameterNames=[asked.name.replace(":", ".")], id=id_)
        return await self._told(asked, lambda: self.first(op="parameterValues", id=id_))

    async def _set(self, asked: Ask) -> Answer:
        id_ = self.new_id()
        parameter = {"name": asked.name.replace(":", "."), "value": asked.values, "type": "float64"}
        await self.send("setParameters", parameters=[parameter], id=id_)
        return await self._told(asked, lambda: self.first(op="parameterValues", id=id_))

    async def _told(self, asked: Ask, is_done: Callable[[], Any]) -> Answer:
        """Wait for the effect, or the status that says why there is none: it names the subject."""

        def status() -> Any:
            wanted = f"{asked.name}: refused"
            return next(
                (f for f in self.got if has(f, {"op": "status"}) and wanted in f["message"]), None
            )

        await until(lambda: status() or is_done())
        refusal = status()
        if refusal is None:
            return DONE
        self.got.remove(refusal)  # those of later asks for the same are others
        assert refusal["level"] == 2
        return Answer(refusal["message"])

    async def names(self) -> set[str]:
        """Return the names in announcements, the connection graph, and the parameters."""
        await self.send("subscribeConnectionGraph")
        await self.send("getParameters", parameterNames=[], id="all")
        graph = await until(lambda: self.first(op="connectionGraphUpdate"))
        parameters = await until(lambda: self.first(op="parameterValues", id="all"))
        found = {each["name"].replace(".", ":", 1) for each in parameters["parameters"]}
        for field in ("publishedTopics", "subscribedTopics", "advertisedServices"):
            for each in graph[field]:
                nodes = next(value for key, value in each.items() if key.endswith("Ids"))
                found |= {each["name"], *nodes}
        for frame in self.got:
            for field, key in (("channels", "topic"), ("services", "name")):
                if isinstance(frame, dict) and isinstance(frame.get(field), list):
                    found |= {each[key] for each in frame[field]}
        return found


WAYS: Final = ("rosbridge", "http", "events", "foxglove")


@asynccontextmanager
async def way_in(
    way: str, port: int, headers: dict[str, str], host: str = "127.0.0.1"
) -> AsyncIterator[Way]:
    """Connect a client by one of `WAYS`.

    Args:
        way: The protocol.
        port: The port of the gateway, on this host.
        headers: The client's headers.
        host: The name by which it addresses the gateway.

    Raises:
        InvalidStatus: a WebSocket is refused.
    """
    if way in {"http", "events"}:
        async with http_client(port) as requests:
            requests.headers.update({**headers, "Host": host})
            yield Http(requests) if way == "http" else Events(requests)
        return
    kind: type[Rosbridge | Foxglove] = Foxglove if way == "foxglove" else Rosbridge
    protocols = [Subprotocol("foxglove.sdk.v1")] if way == "foxglove" else None
    async with (
        connect(
            f"ws://{host}:{port}/",
            host="127.0.0.1",
            port=port,
            additional_headers=headers,
            subprotocols=protocols,
            proxy=None,
            max_size=None,
        ) as socket,
        asyncio.TaskGroup() as tasks,
    ):
        client = kind(socket)
        reading = tasks.create_task(client.read())
        if way == "rosbridge":
            await client.send("set_level", level="error")
        yield client
        reading.cancel()
