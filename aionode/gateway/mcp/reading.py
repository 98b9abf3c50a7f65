"""The tools that only look: names, messages, pictures, transforms, the log, and bags."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

import mcp_types as types
from msgspec import Meta, field

from aionode._process.concurrency import run_in_thread
from aionode.clock import S_TO_NS, Time
from aionode.errors import (
    AionodeError,
    MessageError,
    ToolError,
    TransformException,
)
from aionode.gateway.mcp.answers import answer
from aionode.gateway.mcp.arguments import Arguments, meant
from aionode.gateway.mcp.collecting import Arrivals, Numbers, numbers_of
from aionode.gateway.mcp.names import rights, topic_of, user_names
from aionode.gateway.session.encoding.image import IMAGE_TYPES, Form, picture_of
from aionode.graph import EndpointKind
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.message import json_schema, summarize
from aionode.observe import to_chains
from aionode.tf import BufferCore

if TYPE_CHECKING:
    from aionode.gateway.mcp.call import Call
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.session import Session

__all__ = ["Bags", "Describe", "GetParameters", "List", "Log", "Look", "Read", "Transform", "Watch"]
__all__ += [
    "Bag",
    "Because",
    "because",
    "describe",
    "get_parameters",
    "list_names",
    "log",
    "look",
    "read",
    "transform",
]
__all__ += ["watch"]

MAX_WATCH_SEC: Final = 30.0

LONG: Final = 4000
"""The longest summary of a single message, in bytes."""

SHORT: Final = 1500
"""The longest summary of one of several messages, in bytes."""

QUIET_SEC: Final = 0.3
"""Seconds without a new line after which the log is considered complete."""

LEVELS: Final = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}

Topic = Annotated[str, Meta(description="The full name of the topic, such as /odom.")]
Wait = Annotated[
    float, Meta(ge=0, le=60, description="How long to wait for a message, in seconds.")
]


class List(Arguments, frozen=True):
    """The arguments of `list_names`."""

    kind: Annotated[
        Literal["all", "nodes", "topics", "services", "actions"], Meta(description="Which names.")
    ] = "all"
    containing: Annotated[str, Meta(description="Only names with this text in them.")] = ""


async def list_names(call: Call, given: List) -> types.CallToolResult:
    """Return the names of the robot, without infrastructure."""
    await call.session.graph.turn()
    kinds: dict[str, Any] = user_names(call.session)
    chosen = {kind: names for kind, names in kinds.items() if given.kind in {"all", kind}}
    found: dict[str, Any] = {}
    for kind, names in chosen.items():
        fitting = {name: of for name, of in sorted(names.items()) if given.containing in name}
        found[kind] = sorted(fitting) if kind == "nodes" else fitting
    return answer(found)


class Describe(Arguments, frozen=True):
    """The arguments of `describe`."""

    name: Annotated[
        str,
        Meta(
            description="The full name of a node, topic, service or action, such as /odom, or the "
            "name of a type, such as geometry_msgs/msg/Twist."
        ),
    ]


async def describe(call: Call, given: Describe) -> types.CallToolResult:
    """Return everything known about a name: types with their fields, nodes, and rights."""
    session, name = call.session, given.name
    if not name.startswith("/"):
        return answer({"type": name, **await type_description(session, name)})
    await session.graph.turn()
    found: dict[str, Any] = {}
    if name in session.graph.nodes():
        details = session.graph.node_details(name)
        found["node"] = {part: getattr(details, part) for part in details.__struct_fields__}
        with suppress(AionodeError, TimeoutError):
            found["node"]["parameters"] = await session.parameters.names(name)
    kinds: tuple[tuple[Literal["topic", "service", "action"], str], ...] = (
        ("topic", "msg"), ("service", "srv"), ("action", "action"),
    )  # fmt: skip
    for kind, _ in kinds:
        for type_name in session.graph.types_of(name, kind)[:1]:
            part: dict[str, Any] = {
                "type": type_name,
                "you_may": rights(session, kind, name, type_name),
            }
            if kind == "topic":
                part["published_by"] = session.graph.users(EndpointKind.PUBLISHER, name)
                part["subscribed_by"] = session.graph.users(EndpointKind.SUBSCRIPTION, name)
            found[kind] = part | await type_description(session, type_name)
    if not found:
        known = [each for names in user_names(session).values() for each in names]
        raise ToolError(name, f"the robot has no such name{meant(name, known)}", "not_found")
    return answer(found)


async def type_description(session: Session, type_name: str) -> dict[str, Any]:
    """Return the fields of a type as JSON Schema.

    Raises:
        InterfaceNotFoundError: nobody knows it.
    """
    kind = type_name.split("/")[1] if type_name.count("/") == 2 else "msg"
    if kind == "srv":
        service = await session.service_class(type_name)
        return {"request": json_schema(service.Request), "response": json_schema(service.Response)}
    if kind == "action":
        action = await session.action_class(type_name)
        return {
            "goal": json_schema(action.Goal),
            "result": json_schema(action.Result),
            "feedback": json_schema(action.Feedback),
        }
    return {"message": json_schema(await session.message_class(type_name))}


class Because(Arguments, frozen=True):
    """The arguments of `because`."""

    name: Annotated[
        str,
        Meta(
            description="The full name of a topic, service, action or node, such as /cmd_vel, or "
            "the id of a goal."
        ),
    ]


async def because(call: Call, given: Because) -> types.CallToolResult:
    """Return what led to the latest message of a name."""
    session, name = call.session, given.name
    found = await session.graph.why(name)
    known = [each for names in user_names(session).values() for each in names]
    if name not in known and all(each.unknown == "hidden" for each in found.sent):
        raise ToolError(name[:200], f"the robot has no such name{meant(name, known)}", "not_found")
    return answer({"name": name, "chains": to_chains(found).splitlines()})


class Read(Arguments, frozen=True):
    """The arguments of `read`."""

    topic: Topic
    count: Annotated[int, Meta(ge=1, le=20, description="How many messages to wait for.")] = 1
    timeout_sec: Wait = 5.0


async def read(call: Call, given: Read) -> types.CallToolResult:
    """Return the next messages of a topic."""
    topic = topic_of(call.session, given.topic)
    arrivals = await subscribed(call.session, topic, given.count)
    messages: list[dict[str, Any]] = []
    with suppress(TimeoutError):
        async with asyncio.timeout(given.timeout_sec):
            while len(messages) < given.count:
                received = await arrivals.get()
                size = LONG if given.count == 1 else max(SHORT, LONG // given.count) // 2
                messages.append(shown(received, size))
                await call.report(len(messages), given.count, f"{len(messages)} messages")
    if not messages:
        raise nothing_came(call.session, topic, given.timeout_sec)
    return answer({"topic": topic, "messages": messages})


def shown(received: Received, max_bytes: int) -> dict[str, Any]:
    """Return a message that has arrived, limited in bytes."""
    return {"time": round(received.time_ns / 1e9, 3), **summarize(received.message, max_bytes)}


def nothing_came(session: Session, topic: str, seconds: float) -> ToolError:
    """Return the error for a topic without a message, which names its publishers."""
    publishers = session.graph.users(EndpointKind.PUBLISHER, topic)
    who = f"it is published by {', '.join(publishers)}" if publishers else "no node publishes it"
    return ToolError(topic, f"no message within {seconds:g} s; {who}", "timeout")


async def subscribed(session: Session, topic: str, max_messages: int) -> Arrivals:
    """Subscribe to a topic until the call ends."""
    arrivals = Arrivals(max_messages)
    await session.subscribe(topic, frame=arrivals.put, key=arrivals, depth=1)
    return arrivals


class Watch(Arguments, frozen=True):
    """The arguments of `watch`."""

    topic: Topic
    seconds: Annotated[float, Meta(gt=0, le=MAX_WATCH_SEC, description="For how long.")] = 3.0


class Seen:
    """Statistics of the messages of a topic.

    Attributes:
        first: The first one; None if there was none.
        last: The last one; None if there was none.
        count: How many there were.
    """

    def __init__(self) -> None:
        self.first: Received | None = None
        self.last: Received | None = None
        self.count = 0
        self._numbers: dict[str, Numbers] = {}

    def add(self, received: Received) -> None:
        """Count a message."""
        self.first, self.last = self.first or received, received
        self.count += 1
        for path, values in numbers_of(received.message):
            self._numbers.setdefault(path, Numbers()).add(values)

    def fields(self, units: Mapping[str, str]) -> dict[str, Any]:
        """Return the statistics of each field, with their units by path."""
        found = {path: each.summary() for path, each in self._numbers.items()}
        for path, unit in units.items():
            for name, summary in found.items():
                if name == path or name.startswith(f"{path}."):
                    summary["unit"] = unit
        return found


async def watch(call: Call, given: Watch) -> types.CallToolResult:
    """Return the statistics of a topic's messages over some time."""
    session, seen = call.session, Seen()
    topic = topic_of(session, given.topic)
    arrivals = await subscribed(session, topic, 1000)
    began_ns = session.steady_ns()

    def seconds() -> float:
        return (session.steady_ns() - began_ns) / S_TO_NS

    async def ticking() -> None:
        while True:
            await call.sleep(0.5)
            await call.report(seconds(), given.seconds, f"{seen.count} messages")

    async def taking() -> None:
        while True:
            seen.add(await arrivals.get())

    with suppress(TimeoutError):
        async with asyncio.timeout(given.seconds), asyncio.TaskGroup() as tasks:
            tasks.create_task(ticking())
            tasks.create_task(taking())
    if seen.first is None or seen.last is None:
        raise nothing_came(session, topic, given.seconds)
    lasted, last = seconds(), shown(seen.last, SHORT)
    return answer(
        {
            "topic": topic,
            "seconds": round(lasted, 3),
            "messages": seen.count,
            "rate_hz": round(seen.count / lasted, 3),
            "fields": seen.fields(summarize(seen.last.message, LONG).get("units", {})),
            "first": shown(seen.first, SHORT),
            "last": last,
        }
    )


class Look(Arguments, frozen=True):
    """The arguments of `look`."""

    topic: Annotated[
        str, Meta(description="The topic with the images; empty if the robot has only one.")
    ] = ""
    width: Annotated[int, Meta(ge=16, le=1024, description="The largest width, in pixels.")] = 512
    timeout_sec: Wait = 5.0


async def look(call: Call, given: Look) -> types.CallToolResult:
    """Return the next image of a topic as an image."""
    session = call.session
    images = {
        name: kinds for name, kinds in user_names(session)["topics"].items()
        if IMAGE_TYPES & set(kinds)
    }  # fmt: skip
    if not given.topic and len(images) != 1:
        raise MessageError(
            "topic", f"the robot has {len(images)} topics with images{meant('', images)}"
        )
    topic = topic_of(session, given.topic or next(iter(images)))
    if topic not in images:
        raise MessageError("topic", f"{topic} has no images{meant(topic, images)}")
    arrivals = await subscribed(session, topic, 1)
    try:
        async with asyncio.timeout(given.timeout_sec):
            received = await arrivals.get()
    except TimeoutError:
        raise nothing_came(session, topic, given.timeout_sec) from None
    picture = await picture_of(received, Form("image/jpeg", given.width, 80))
    header = received.message.header
    facts = {
        "topic": topic,
        "frame_id": header.frame_id,
        "time": round(received.time_ns / 1e9, 3),
        "width": getattr(received.message, "width", None),
        "height": getattr(received.message, "height", None),
    }
    result = answer({name: value for name, value in facts.items() if value is not None})
    import base64  # few clients look

    data = base64.b64encode(bytes(picture.data)).decode()
    image = types.ImageContent(type="image", data=data, mime_type=picture.media_type)
    return result.model_copy(update={"content": [image, *result.content]})


class Transform(Arguments, frozen=True):
    """The arguments of `transform`."""

    target: Annotated[str, Meta(description="The frame in which the pose is given, such as odom.")]
    source: Annotated[str, Meta(description="The frame whose pose is wanted, such as base_link.")]
    timeout_sec: Wait = 2.0


async def transform(call: Call, given: Transform) -> types.CallToolResult:
    """Return the newest transform between two frames."""
    buffer, came = BufferCore(), asyncio.Event()

    def take(*, is_static: bool) -> Any:
        def put(received: Received) -> None:
            message = received.message
            if isinstance(message, TFMessage):
                for each in message.transforms:
                    add = buffer.set_transform_static if is_static else buffer.set_transform
                    add(each, "tf")
            came.set()

        return put

    for topic in ("/tf", "/tf_static"):
        await call.session.subscribe(
            topic, "tf2_msgs/msg/TFMessage", key=topic, frame=take(is_static=topic != "/tf")
        )
    problem = ""
    with suppress(TimeoutError):
        async with asyncio.timeout(given.timeout_sec):
            while True:
                came.clear()
                try:
                    found = buffer.lookup_transform_core(given.target, given.source, Time())
                except TransformException as error:
                    problem = str(error).rstrip(" .")
                else:
                    return answer(described(found))
                await came.wait()
    frames = buffer._getFrameStrings()
    if not frames:
        problem = "no transforms were received on /tf and /tf_static"
    missing = [frame for frame in (given.target, given.source) if frame not in frames]
    hint = meant(missing[0], frames) if missing and frames else ""
    raise ToolError(f"{given.target} to {given.source}", f"{problem}{hint}", "not_found")


def described(stamped: Any) -> dict[str, Any]:
    """Return a transform together with its heading, which most callers want."""
    import math  # few clients ask for a transform

    rotation = stamped.transform.rotation
    yaw = math.atan2(
        2 * (rotation.w * rotation.z + rotation.x * rotation.y),
        1 - 2 * (rotation.y**2 + rotation.z**2),
    )
    return {**summarize(stamped, LONG), "yaw": {"value": round(yaw, 6), "unit": "rad"}}


class Log(Arguments, frozen=True):
    """The arguments of `log`."""

    level: Annotated[
        Literal["debug", "info", "warn", "error", "fatal"], Meta(description="The least severity.")
    ] = "info"
    node: Annotated[str, Meta(description="Only lines of loggers with this text in the name.")] = ""
    count: Annotated[int, Meta(ge=1, le=100, description="How many of the newest lines.")] = 30
    seconds: Annotated[float, Meta(ge=0, le=30, description="For how long to wait for more.")] = 0.5


async def log(call: Call, given: Log) -> types.CallToolResult:
    """Return the newest lines of the robot's log."""
    arrivals = Arrivals(1000)
    await call.session.subscribe(
        "/rosout", "rcl_interfaces/msg/Log", frame=arrivals.put, key=arrivals, depth=1
    )
    lines: list[dict[str, Any]] = []
    with suppress(TimeoutError):
        async with asyncio.timeout(given.seconds + QUIET_SEC):
            while True:
                message = (await arrivals.get()).message
                level = message.level[0] if isinstance(message.level, bytes) else message.level
                if level < LEVELS[given.level] or given.node not in message.name:
                    continue
                stamp = message.stamp.sec + message.stamp.nanosec / 1e9
                lines.append(
                    {
                        "time": round(stamp, 3),
                        "level": next((n for n, v in LEVELS.items() if v == level), str(level)),
                        "name": message.name,
                        "text": message.msg,
                    }
                )
    lines.sort(key=lambda line: float(line["time"]))
    return answer({"lines": lines[-given.count :]})


class GetParameters(Arguments, frozen=True):
    """The arguments of `get_parameters`."""

    node: Annotated[str, Meta(description="The full name of the node.")]
    names: Annotated[list[str], Meta(description="Which parameters; all if empty.")] = field(
        default_factory=list
    )


async def get_parameters(call: Call, given: GetParameters) -> types.CallToolResult:
    """Return the values of a node's parameters."""
    known_node(call.session, given.node)
    names = given.names or await call.session.parameters.names(given.node)
    found = await call.session.parameters.get(given.node, list(names))
    for name in names:
        if name not in found:
            known = await call.session.parameters.names(given.node)
            raise MessageError(f"{given.node}:{name}", f"no such parameter{meant(name, known)}")
    values = {name: plain(parameter.value) for name, parameter in found.items()}
    return answer({"node": given.node, "parameters": values})


def plain(value: Any) -> Any:
    """Return the value of a parameter in JSON form."""
    if isinstance(value, bytes):
        return list(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


def known_node(session: Session, node: str) -> None:
    """Refuse the name of a node that does not exist.

    Raises:
        ToolError: there is none.
    """
    nodes = session.graph.nodes()
    if node not in nodes:
        raise ToolError(node, f"the robot has no such node{meant(node, nodes)}", "not_found")


class Bag(Arguments, frozen=True):
    """The arguments of `Bags.summary`."""

    name: Annotated[
        str, Meta(description="The name of the bag in its folder; empty lists them.")
    ] = ""


class Bags:
    """The bags of one folder, the only files of the robot that an assistant may read.

    Args:
        folder: The folder.
    """

    def __init__(self, folder: str) -> None:
        self._folder = Path(folder).resolve()

    async def summary(self, call: Call, given: Bag) -> types.CallToolResult:
        """Return the contents of a bag, or the names of the bags."""
        call.session.rights.decide("see", "/bags", "")
        return answer(await run_in_thread(self._summary, given.name))

    def _summary(self, name: str) -> dict[str, Any]:
        """Return the contents of a bag. Called in a thread.

        Raises:
            MessageError: there is no such bag in the folder.
            BagError: it cannot be read.
        """
        from aionode import bag  # needs the extra `bag`

        known = sorted(entry.name for entry in self._folder.iterdir())
        if not name:
            return {"folder": str(self._folder), "bags": known}
        path = (self._folder / name).resolve()
        if not path.is_relative_to(self._folder) or name not in known:
            raise MessageError("name", f"{name}: no such bag{meant(name, known)}")
        with bag.open(path) as opened:
            topics = {
                name: {"type": topic.type, "messages": topic.message_count}
                for name, topic in sorted(opened.topics.items())
            }
            return {
                "bag": name,
                "messages": opened.message_count,
                "start": round(opened.start_ns / 1e9, 3),
                "seconds": round((opened.end_ns - opened.start_ns) / 1e9, 3),
                "topics": topics,
            }
