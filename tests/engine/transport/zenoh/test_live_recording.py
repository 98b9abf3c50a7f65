"""What a real ROS 2 on rmw_zenoh_cpp declared and sent, against what aionode reads and writes.

The recording is of rclpy 9.1.2 (Kilted) over rmw_zenoh_cpp 0.6.7.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from aionode import Context, Duration, Node
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire._key_expression import parse_data_key
from aionode.engine.wire._liveliness import endpoint_token, node_token, parse_token
from aionode.graph import EndpointInfo, EndpointKind
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.test_msgs.action import Fibonacci
from aionode.interfaces.test_msgs.srv import BasicTypes
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    qos_profile_best_available,
    qos_profile_sensor_data,
    qos_profile_system_default,
)
from tests.support.peers import known, raw_session

RECORDED: dict[str, Any] = json.loads(
    (Path(__file__).parents[3] / "vectors" / "live_rmw_zenoh.json").read_text(encoding="utf-8")
)
TOKENS: list[str] = RECORDED["tokens"]
DOMAIN_ID = 42

PROFILES = {
    "default": QoSProfile(depth=10),
    "sensor": qos_profile_sensor_data,
    "keep_all": QoSProfile(history=HistoryPolicy.KEEP_ALL),
    "tl": QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    "system": qos_profile_system_default,
    "d42": QoSProfile(depth=42),
    "dl": QoSProfile(
        depth=1,
        deadline=Duration(seconds=1.5),
        lifespan=Duration(seconds=2),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=3),
    ),
    "ba": qos_profile_best_available,
}
"""The profiles of the topics ``q_…`` and ``qs_…`` of the recorded program."""


def test_each_token_is_read_and_written_back() -> None:
    """A single wrong character shows in `ros2 topic info -v`, or changes the gid."""
    for text in TOKENS:
        token = parse_token(text)

        assert token is not None, text
        if isinstance(token.info, EndpointInfo):
            assert endpoint_token(token.domain_id, token.info) == text
        else:
            assert node_token(token.domain_id, token.info) == text


@pytest.mark.parametrize("sample", RECORDED["samples"], ids=lambda sample: sample["key"][3:20])
def test_the_gid_of_a_sample_is_that_of_its_token(sample: dict[str, Any]) -> None:
    """A message is attributed to its publisher by it."""
    key = parse_data_key(sample["key"])
    extra = attachment.unpack(bytes.fromhex(sample["attachment"]))
    assert key is not None
    assert extra is not None
    publishers = [
        token.info.gid
        for token in map(parse_token, TOKENS)
        if token is not None
        and isinstance(token.info, EndpointInfo)
        and token.info.kind is EndpointKind.PUBLISHER
        and (token.info.name, token.info.type_hash) == (key.name, key.type_hash)
    ]

    assert extra.gid in publishers


DIFFERENT = {
    # The queue for feedback is deep, so that a goal whose reader pauses loses none. The last chunk
    # is for publishers of ROS 2 Lyrical, and ignored by all others.
    "%askfib%_action%feedback/": ("::,10:,:,:,,", "::,1000:,:,:,,/backends:cpu:"),
    # The best available policies are chosen once, when the endpoint is created, and announced as
    # chosen: from them other processes of aionode see whether to acknowledge messages and whether
    # they take a link, and tools what the endpoint does.
    "MP/%/%/cap/%q_ba/": ("4:4:,10:,854775806:,:5,,854775806", ":1:,10:,:,:,,"),
    "MS/%/%/cap/%qs_ba/": ("4:4:,10:,854775806:,:5,,854775806", ":1:,10:,:,:3,,"),
}
"""The differences that are on purpose: the recorded QoS, and aionode's own."""


def expected(text: str) -> str:
    """Return how aionode declares the same."""
    for part, (recorded, own) in DIFFERENT.items():
        if part in text:
            return text.removesuffix(recorded) + own
    return text


def plain(text: str) -> str:
    """Return a token without the domain, the session and the ids."""
    return "/".join(text.split("/")[5:])


def create_recorded(node: Node) -> None:
    """Create what the recorded program had in its first node."""
    for name, profile in PROFILES.items():
        node.create_publisher(String, f"q_{name}", profile)
        node.create_subscription(String, f"qs_{name}", None, profile)
    node.create_service(BasicTypes, "srv", lambda _, response: response)
    node.create_client(BasicTypes, "ask")
    node.create_action_server(Fibonacci, "fib", lambda _: Fibonacci.Result())
    node.create_action_client(Fibonacci, "askfib")
    node.create_publisher(Image, "img", qos_profile_sensor_data)


async def test_the_same_nodes_declare_the_same() -> None:
    """Only ids, their order, and what is listed above differ."""
    async with (
        Context() as context,
        Node("cap", context=context) as cap,
        Node("second", namespace="/a/b", context=context) as second,
    ):
        create_recorded(cap)
        second.create_publisher(String, "rel", 1)
        second.create_publisher(String, "~/priv", 1)
        with raw_session() as session:
            seen = await known(session, f"@ros2_lv/{DOMAIN_ID}/**", len(TOKENS))

    assert set(map(plain, seen)) == set(map(expected, map(plain, TOKENS)))
