"""The tokens and keys of bridges, which must never be of a form that ends a robot's bridge."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from aionode.engine.wire._bridge import (
    BridgedEndpoint,
    bridge_key,
    bridge_token,
    bridged_endpoints,
    namespace_prefix,
    parse_bridge_token,
    parse_node,
    parse_request_id,
    takes_for_its_own,
    token_of,
)
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from tests.support.bridge import cause_of_death

ZID = "8b20917502ee955ac4476e0266340d5c"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
STRING = "std_msgs/msg/String"
NODE = NodeInfo(ZID, 0, "talker", "/")
PARTS = st.text(st.sampled_from("ab/§*?$#@:_ \0%ü"), max_size=12) | st.text(max_size=12)
PROFILES = st.builds(
    QoSProfile,
    depth=st.integers(1, 10**6),
    history=st.sampled_from([HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL]),
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]),
)


@given(
    st.sampled_from([ZID, "a"]) | PARTS,
    st.sampled_from(["MP", "MS", "SS", "SC", "AS", "AC"]) | PARTS,
    PARTS | st.sampled_from(["/chatter", "chatter", "/bot1/chatter"]),
    PARTS | st.sampled_from([STRING, "std_msgs::msg::dds_::String_"]),
    st.none() | PROFILES,
    PARTS | st.just(HASH),
)
@example(ZID, "NN", "/chatter", STRING, None, "")
@example(ZID, "MP", "/§chatter", STRING, QoSProfile(depth=1), "")
@example(ZID, "MP", "/a//b", STRING, QoSProfile(depth=1), "")
@example(ZID, "MP", "/", STRING, QoSProfile(depth=1), "")
@example(ZID, "SS", "/a", "/srv/", None, "")
@example(ZID, "SS", "/a\n", "p/srv/A\n", None, "")
def test_no_token_is_of_a_form_that_ends_a_bridge(
    zid: str, kind: str, name: str, type_name: str, qos: QoSProfile | None, type_hash: str
) -> None:
    """Whatever comes in: either it is refused, or a bridge can read it, and we can."""
    with suppress(ValueError):
        token = bridge_token(zid, kind, name, type_name, qos, type_hash)

        assert cause_of_death(token) is None
        assert not set(token) & set("*?$# \n\0")
        parsed = parse_bridge_token(token)
        assert parsed is not None
        assert (parsed.zid, parsed.kind) == (zid, kind)
        assert (parsed.key, parsed.type_name) == (name.strip("/"), type_name)
        assert token.count("@") == 2
        if kind[0] == "M":
            assert token.split("/")[6].startswith(":")  # without a key


@given(
    st.sampled_from(["bot1", "bot1/arm", "b"]),
    st.sampled_from(["bot1", "bot10", "bot12/a", "bot1/a", "b", "bot1/arm/x", "bot1/armx/y", "c"]),
)
def test_every_key_that_ends_a_bridge_with_a_namespace_is_known(namespace: str, key: str) -> None:
    """What is announced for one robot is read by the bridges of all others."""
    token = bridge_token(ZID, "SS", f"/{key}", "p/srv/Add")
    if cause_of_death(token, f"/{namespace}") is not None:
        assert takes_for_its_own(namespace_prefix(namespace), key)
    if key.startswith(f"{namespace}/"):
        assert not takes_for_its_own(namespace_prefix(namespace), key)


@given(st.text())
def test_any_token_can_be_read(text: str) -> None:
    """Any program may declare anything."""
    parse_bridge_token(text)
    parse_bridge_token(f"@/{ZID}/@ros2_lv/MP/chatter/std_msgs§msg§String/{text}")
    parse_node(f"@/{ZID}/ros2/node/{text}", text.encode(errors="replace"))


@pytest.mark.parametrize(
    ("kind", "type_name", "expected"),
    [
        (
            EndpointKind.PUBLISHER,
            STRING,
            f"MP/chatter/std_msgs§msg§String/:1:0:0,10:typehash={HASH};",
        ),
        (
            EndpointKind.SUBSCRIPTION,
            STRING,
            f"MS/chatter/std_msgs§msg§String/:1:0:0,10:typehash={HASH};",
        ),
        (EndpointKind.SERVER, "p/srv/Add", "SS/chatter/p§srv§Add"),
        (EndpointKind.CLIENT, "p/srv/Add", "SC/chatter/p§srv§Add"),
    ],
)
def test_an_endpoint_has_the_token_that_a_bridge_reads(
    kind: EndpointKind, type_name: str, expected: str
) -> None:
    """Byte for byte, as bridges announce their own."""
    endpoint = EndpointInfo(
        kind, NODE, 1, "/chatter", type_name, HASH, QoSProfile(depth=10), b"g" * 16
    )

    assert token_of(ZID, endpoint) == f"@/{ZID}/@ros2_lv/{expected}"


def test_the_parts_of_an_action_have_one_token() -> None:
    """The services and topics of an action have none of their own."""
    found = [
        token_of(
            ZID,
            EndpointInfo(one.kind, NODE, 1, one.name, one.type_name, "", one.qos, b"g" * 16),
        )
        for one in parts_of(f"@/{ZID}/@ros2_lv/AS/fib/p§action§Fib")
    ]

    assert found == [f"@/{ZID}/@ros2_lv/AS/fib/p§action§Fib", "", "", "", ""]


def parts_of(token: str) -> list[BridgedEndpoint]:
    """Return the endpoints of a token."""
    parsed = parse_bridge_token(token)
    assert parsed is not None
    return bridged_endpoints(parsed)


@pytest.mark.parametrize(
    ("text", "reliable", "transient", "depth", "type_hash", "has_history"),
    [
        (f":1::0,7:typehash={HASH};", True, False, 7, HASH, True),  # Cyclone
        (":1:1:0,1000", True, True, 1000, "", True),  # Humble
        (f":1:::typehash={HASH};", True, False, 1, HASH, False),  # Fast DDS
        (":0:0:1,0", False, False, 1, "", True),
        (":::", True, False, 1, "", False),
    ],
)
def test_the_qos_of_bridges_is_read(
    text: str, reliable: bool, transient: bool, depth: int, type_hash: str, has_history: bool
) -> None:
    """As it was seen; what is unset has DDS's default for publishers."""
    found = parse_bridge_token(f"@/{ZID}/@ros2_lv/MP/chatter/std_msgs§msg§String/{text}")

    assert found is not None
    assert (found.qos.reliability is ReliabilityPolicy.RELIABLE) is reliable
    assert (found.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL) is transient
    assert (found.qos.depth, found.type_hash, found.has_history) == (depth, type_hash, has_history)


def test_a_subscription_without_reliability_takes_what_comes() -> None:
    """DDS's default differs between the two ends."""
    found = parse_bridge_token(f"@/{ZID}/@ros2_lv/MS/chatter/std_msgs§msg§String/:::")

    assert found is not None
    assert found.qos.reliability is ReliabilityPolicy.BEST_EFFORT


def test_keys_are_names_without_the_first_slash() -> None:
    """A namespace is the part with which they begin."""
    assert bridge_key("/bot1/chatter") == "bot1/chatter"
    assert (namespace_prefix("/"), namespace_prefix("/bot1")) == ("", "bot1/")


def test_the_id_of_a_bridged_request_is_read() -> None:
    """It tells requests apart; any other attachment is none."""
    extra = bytes.fromhex("727168aec3fa4fc637842a010000000000000001")

    assert parse_request_id(extra) == (bytes.fromhex("aec3fa4fc637842a").ljust(16, b"\0"), 1)
    assert parse_request_id(extra[1:]) is None
