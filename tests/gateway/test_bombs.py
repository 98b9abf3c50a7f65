"""Small requests designed to be costly: refused with a clear answer while the loop runs on."""

from __future__ import annotations

import base64
import json
import re
import struct
import zlib
from collections.abc import AsyncIterator

import httpx
import pytest
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed

from aionode.engine.wire import cdr
from aionode.errors import MessageError
from aionode.gateway import Gateway, Policy
from aionode.gateway.session.encoding.client_json import decoded
from aionode.interfaces.geometry_msgs.msg import PoseArray
from aionode.interfaces.std_msgs.msg import String, UInt8MultiArray
from tests.support.gateway_server import busiest_turn, http_client, raw_connect, serving, upgraded
from tests.support.waiting import until

SIZE = 990_000
"""As much as fits in a frame."""

TURN_SEC = 0.1
"""The longest loop iteration on a slow machine; here it takes less than 20 ms."""

MARKERS = "visualization_msgs/MarkerArray"
POSES = "geometry_msgs/PoseArray"
NUMBERS = "std_msgs/UInt8MultiArray"
NAMES = "sensor_msgs/JointState"

DEEP = "recursion|needs a"
"""Python 3.13 can parse a value nested this deep, which then is not a message."""

REFUSED = {
    "lists": (POSES, "[" + "[]," * (SIZE // 3) + "[]]", "objects and lists"),
    "lists beside a NaN": (POSES, "[NaN," + "[]," * (SIZE // 3) + "[]]", "objects and lists"),
    "deep lists": (POSES, "[" * 4_000 + "]" * 4_000, DEEP),
    "deep objects": (POSES, '{"poses":' * 2_000 + "1" + "}" * 2_000, DEEP),
    "empty objects": (POSES, '{"poses":[' + "{}," * (SIZE // 3) + "{}]}", "objects and lists"),
    "messages that grow": (MARKERS, '{"markers":[' + "{}," * 60_000 + "{}]}", "at most"),
    "a huge number": (POSES, '{"poses":' + "1" * SIZE + "}", "out of range"),
    "huge exponents": (POSES, "[" + "1e999," * (SIZE // 6) + "1]", "out of range"),
    "many keys": (POSES, json.dumps({str(key): 1 for key in range(80_000)}), "no such field"),
    "numbers that do not fit": (
        NUMBERS,
        '{"data":[' + "1," * 250_000 + "999]}",
        "holds 0 to 255",
    ),
    "texts for numbers": (NAMES, '{"position":[' + '"",' * (SIZE // 3) + '""]}', "needs a float"),
    "base64 of a wrong length": (NUMBERS, '{"data":"' + "A" * (SIZE - 1) + '"}', "base64"),
    "numbers": (
        NUMBERS,
        '{"data":[' + "1," * 1_100_000 + "1]}",
        "values, at most 1000000 are",
    ),
    "a huge name": (NAMES, '{"' + "x" * SIZE + '":1}', "no such field"),
}
"""By kind: the type, the values in JSON, and a pattern of the answer."""

TAKEN = {
    "bytes as numbers": (NUMBERS, '{"data":[' + "1," * (SIZE // 2) + "1]}"),
    "many names": (NAMES, '{"name":[' + '"",' * 90_000 + '""]}'),
    "many poses": (POSES, '{"poses":[' + "{}," * 4_900 + "{}]}"),
    "brackets in a text": ("std_msgs/String", '{"data":"' + "[" * SIZE + '"}'),
}
"""Large, but valid messages."""


@pytest.fixture
async def gateway() -> AsyncIterator[Gateway]:
    """Yield a gateway that allows everything."""
    async with serving(Policy.default(allow_write=True)) as made:
        yield made


def publish_op(type_name: str, values: str) -> str:
    """Return a frame of rosbridge."""
    return f'{{"op":"publish","topic":"/t","type":"{type_name}","msg":{values}}}'


async def status_of(client: ClientConnection) -> str:
    """Return the next status."""
    while (answer := json.loads(await client.recv()))["op"] != "status":
        pass
    return str(answer.get("msg") or answer["message"])


async def still_served(client: ClientConnection) -> None:
    """Wait for the answer to a request sent after everything else."""
    await client.send('{"op":"call_service","service":"/rosapi/get_time","id":"still there"}')
    while json.loads(await client.recv()).get("id") != "still there":
        pass


@pytest.mark.parametrize(
    ("name", "as_bytes"),
    [*((name, False) for name in REFUSED), ("lists", True), ("deep lists", True)],
)
async def test_a_bomb_for_rosbridge_is_answered(
    gateway: Gateway, name: str, *, as_bytes: bool
) -> None:
    """In text or binary frames, both of which contain JSON."""
    type_name, values, words = REFUSED[name]
    frame = publish_op(type_name, values)
    async with raw_connect(gateway, "/", {}, []) as client:
        await client.send('{"op":"set_level","level":"error"}')
        async with busiest_turn() as busy:
            await client.send(frame.encode() if as_bytes else frame)
            assert re.search(words, await status_of(client))
        assert busy.longest_sec < TURN_SEC
        await still_served(client)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name == "bytes as numbers" else name
        for name in TAKEN
    ],
)
async def test_a_large_message_of_a_client_leaves_the_loop_to_the_robot(
    gateway: Gateway, name: str
) -> None:
    """Half a million numbers in JSON take half a second, in a thread."""
    type_name, values = TAKEN[name]
    published: list[String] = []

    def take(line: String) -> None:
        if '"action":"publish"' in line.data:
            published.append(line)

    gateway.node.create_subscription(String, "/gateway/audit", take)
    async with raw_connect(gateway, "/", {}, []) as client:
        await client.send('{"op":"set_level","level":"error"}')
        async with busiest_turn() as busy:
            await client.send(publish_op(type_name, values))
            await until(lambda: published)
        assert busy.longest_sec < TURN_SEC
        await still_served(client)
        assert gateway.stats.refused == 0


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name == "texts for numbers" else name
        for name in REFUSED
    ],
)
async def test_a_bomb_over_http_is_answered(gateway: Gateway, name: str) -> None:
    """As the body of a message."""
    type_name, values, words = REFUSED[name]
    async with http_client() as client, busiest_turn() as busy:
        answer = await post(client, gateway, type_name, values)
        assert answer.status_code == 400
        assert re.search(words, answer.json()["error"])
    assert busy.longest_sec < TURN_SEC


async def post(
    client: httpx.AsyncClient, gateway: Gateway, type_name: str, values: str
) -> httpx.Response:
    """Publish a message over HTTP."""
    url = f"http://127.0.0.1:{gateway.port}/topics/t?type={type_name}"
    head = {"content-type": "application/json"}
    return await client.post(url, content=values.encode(), headers=head)


FOXGLOVE_CDR = {
    "a length of 2^32": cdr.encode(UInt8MultiArray())[:-4] + struct.pack("<I", 2**32 - 1),
    "a length of all there is": cdr.encode(PoseArray())[:-4] + struct.pack("<I", 2**31),
    "nothing": b"",
    "half a message": cdr.encode(UInt8MultiArray(data=b"x" * SIZE))[: SIZE // 2],
}


@pytest.mark.parametrize("encoding", [pytest.param("json", marks=pytest.mark.slow), "cdr"])
async def test_a_bomb_for_foxglove_is_answered(gateway: Gateway, encoding: str) -> None:
    """In binary frames, with messages in JSON or in CDR."""
    tries = [(kind, values.encode(), words) for kind, values, words in REFUSED.values()]
    if encoding == "cdr":
        tries = [(NUMBERS if n != 1 else POSES, data, "") for n, data in enumerate_cdr()]
    async with raw_connect(gateway, "/", {}, ["foxglove.sdk.v1"]) as client:
        for number, (type_name, data, words) in enumerate(tries, 1):
            channel = {"id": number, "topic": f"/t{number}", "encoding": encoding}
            channel["schemaName"] = type_name.replace("/", "/msg/")
            await client.send(json.dumps({"op": "advertise", "channels": [channel]}))
            async with busiest_turn() as busy:
                await client.send(struct.pack("<BI", 1, number) + data)
                assert re.search(words, await status_of(client))
            assert busy.longest_sec < TURN_SEC


def enumerate_cdr() -> list[tuple[int, bytes]]:
    """Return CDR bombs with a number for each."""
    return list(enumerate(FOXGLOVE_CDR.values()))


ROSAPI = {
    "set_param, deep": ("set_param", {"name": "/gateway:x", "value": "[" * 100_000}),
    "set_param, long": ("set_param", {"name": "/gateway:x", "value": f"[{'1,' * 400_000}1]"}),
    "get_param": ("get_param", {"name": "/gateway:x", "default_value": "[" * 900_000}),
    "message_details": ("message_details", {"type": "x/" * 400_000}),
    "topics_for_type": ("topics_for_type", {"type": "x" * 900_000}),
    "a name of 900 kB": ("topic_type", {"topic": "/x" * 400_000}),
}


@pytest.mark.parametrize("name", ROSAPI)
async def test_a_bomb_for_rosapi_is_answered(gateway: Gateway, name: str) -> None:
    """Its text fields may contain JSON, names or types."""
    service, args = ROSAPI[name]
    op = {"op": "call_service", "service": f"/rosapi/{service}", "id": "bomb", "args": args}
    async with raw_connect(gateway, "/", {}, []) as client, busiest_turn() as busy:
        await client.send(json.dumps(op))
        answer = json.loads(await client.recv())
        assert (answer["op"], answer["id"]) == ("service_response", "bomb")
        assert len(json.dumps(answer)) < 10_000 or service == "get_param"
        assert busy.longest_sec < TURN_SEC


CBOR = {
    "a length of 2^60": b"\xa1\x62op\x5b" + (2**60).to_bytes(8, "big"),
    "deep lists": b"\x81" * 900_000,
    "a list of 2^60": b"\x9b" + (2**60).to_bytes(8, "big"),
}


@pytest.mark.parametrize("name", CBOR)
async def test_cbor_of_clients_is_refused(gateway: Gateway, name: str) -> None:
    """Clients of rosbridge send JSON, even in binary frames: no CBOR decoder sees their data."""
    async with raw_connect(gateway, "/", {}, []) as client:
        await client.send('{"op":"set_level","level":"error"}')
        await client.send(CBOR[name])
        assert "invalid JSON" in await status_of(client)


async def test_a_picture_of_a_client_is_not_inflated(gateway: Gateway) -> None:
    """Pictures that contain ops are only sent to clients: 1 MB of one may inflate to a gigabyte."""
    bomb = base64.b64encode(zlib.compress(bytes(50_000_000))).decode()
    async with raw_connect(gateway, "/", {}, []) as client:
        await client.send('{"op":"set_level","level":"error"}')
        await client.send(json.dumps({"op": "png", "data": bomb}))
        assert "'png' is unknown" in await status_of(client)


async def test_frames_are_not_inflated(gateway: Gateway) -> None:
    """The gateway agrees to no compression of frames, and rejects compressed ones."""
    more = "Sec-WebSocket-Extensions: permessage-deflate\r\n"
    reader, writer, head = await upgraded(gateway, more)
    assert "permessage-deflate" not in head.lower()
    data = zlib.compress(bytes(10_000))[2:-4][:100]
    writer.write(bytes([0xC1, 0x80 | len(data)]) + bytes(4) + data)
    answer = await reader.read()
    assert answer[:1] == b"\x88"
    assert int.from_bytes(answer[2:4], "big") == 1002
    await until(lambda: not gateway.stats.sessions)
    writer.close()


@pytest.mark.parametrize("size", [10**7 + 1, 2**62])
async def test_a_frame_that_announces_too_much_is_refused_at_once(
    gateway: Gateway, size: int
) -> None:
    """The gateway does not wait for the rest, and allocates no memory for it."""
    reader, writer, _ = await upgraded(gateway)
    writer.write(bytes([0x82, 0x80 | 127]) + size.to_bytes(8, "big") + bytes(4) + b"x")
    answer = await reader.read()
    assert int.from_bytes(answer[2:4], "big") == 1009
    await until(lambda: not gateway.stats.sessions)
    writer.close()


async def test_fragments_that_never_complete_are_bounded(gateway: Gateway) -> None:
    """In characters and in number: the oldest are dropped, or the client gets an error."""
    async with raw_connect(gateway, "/", {}, []) as client:
        await client.send('{"op":"set_level","level":"error"}')
        data = "x" * 900_000
        for number in range(20):
            op = {"op": "fragment", "id": f"{number}", "data": data, "num": 0, "total": 2}
            await client.send(json.dumps(op))
        assert "fragment" in await status_of(client)
        await still_served(client)


async def test_a_client_that_only_sends_bombs_is_disconnected(gateway: Gateway) -> None:
    """After a hundred frames that are not valid ops."""
    async with raw_connect(gateway, "/", {}, []) as client:
        for _ in range(101):
            await client.send("[" * 1000)
        with pytest.raises(ConnectionClosed):
            await client.recv()


@pytest.mark.parametrize(
    ("text", "is_taken"),
    [
        ('{"a":"' + "[" * 30_000 + '"}', True),
        ('{"a":"\\\\","b":"' + "[" * 30_000 + '"}', True),
        ('{"a":"\\"' + "[" * 30_000 + '"}', True),
        ('{"a":"\\\\"}' + "[" * 30_000, False),
        ("[" + "[]," * 19_000 + "[]]", True),
        ("[" + "[]," * 21_000 + "[]]", False),
    ],
)
def test_brackets_in_texts_are_no_parts(text: str, *, is_taken: bool) -> None:
    """A text may contain any brackets: only those of objects and lists count."""
    if is_taken:
        assert decoded(text, 20_000) == json.loads(text)
    else:
        with pytest.raises(MessageError, match="objects and lists"):
            decoded(text, 20_000)
