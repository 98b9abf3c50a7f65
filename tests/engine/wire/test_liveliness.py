"""Liveliness tokens: the graph in key expressions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.clock import CONST_INFINITE_NS, Duration
from aionode.engine.wire import _liveliness as liveliness
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_default,
    qos_profile_parameters,
    qos_profile_rosout_default,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
)

VECTORS: dict[str, Any] = json.loads(
    Path(__file__).parents[2].joinpath("vectors", "vectors.json").read_text()
)
TOKENS: list[dict[str, str]] = VECTORS["liveliness_tokens"]

PROFILES = {
    "default profile (reliable volatile keep_last 10)": qos_profile_default,
    "rmw system default (depth 42)": qos_profile_system_default,
    "sensor_data": qos_profile_sensor_data,
    "tf_static / action status (reliable transient_local depth 1)": QoSProfile(
        depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL
    ),
    "services default": qos_profile_services_default,
    "parameters": qos_profile_parameters,
    "rosout (transient_local, 1000, lifespan 10 s)": qos_profile_rosout_default,
    "keep_all reliable (depth 0 sent as 42 -> elided)": QoSProfile(
        history=HistoryPolicy.KEEP_ALL, depth=0
    ),
    "deadline 100 ms": QoSProfile(depth=10, deadline=Duration(seconds=0.1)),
    "liveliness manual_by_topic lease 1 s": QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=1),
    ),
}

WORDS = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
NAMES = st.lists(WORDS, max_size=3).map(lambda words: "/" + "/".join(words))
IDS = st.integers(0, 2**63)
NODES = st.builds(
    NodeInfo, st.from_regex(r"[1-9a-f][0-9a-f]{0,31}", fullmatch=True), IDS, WORDS, NAMES, NAMES
)
DURATIONS = st.integers(0, CONST_INFINITE_NS).map(lambda ns: Duration(nanoseconds=ns))
PROFILE = st.builds(
    QoSProfile,
    history=st.sampled_from(HistoryPolicy),
    depth=st.integers(1, 2**40),
    reliability=st.sampled_from(ReliabilityPolicy),
    durability=st.sampled_from(DurabilityPolicy),
    lifespan=DURATIONS,
    deadline=DURATIONS,
    liveliness=st.sampled_from(LivelinessPolicy),
    liveliness_lease_duration=DURATIONS,
)


@pytest.mark.parametrize("golden", TOKENS, ids=lambda golden: golden["key"][-24:])
def test_tokens_are_those_of_rmw_zenoh(golden: dict[str, str]) -> None:
    """Read and written again, each of the recorded tokens is the same."""
    key = golden["key"]
    token = liveliness.parse_token(key)

    assert token is not None
    if isinstance(token.info, NodeInfo):
        assert liveliness.node_token(token.domain_id, token.info) == key
    else:
        backends = liveliness.CPU_BACKEND if key.endswith(liveliness.CPU_BACKEND) else ""
        assert liveliness.endpoint_token(token.domain_id, token.info, backends) == key


@pytest.mark.parametrize("golden", TOKENS, ids=lambda golden: golden["key"][-24:])
def test_gids_are_those_of_rmw_zenoh(golden: dict[str, str]) -> None:
    """All systems derive the same id from a token, as shown by `ros2 topic info -v`."""
    assert liveliness.gid_of(golden["key"]).hex() == golden["gid"]


def test_a_publisher_is_read_with_everything_it_says() -> None:
    """The graph shows what the token says."""
    token = liveliness.parse_token(TOKENS[2]["key"])

    assert token == liveliness.Token(
        0,
        EndpointInfo(
            kind=EndpointKind.SUBSCRIPTION,
            node=NodeInfo("8b20917502ee955ac4476e0266340d5c", 0, "listener", "/robot1"),
            endpoint_id=11,
            name="/robot1/chatter",
            type_name="std_msgs/msg/String",
            type_hash=VECTORS["messages"]["std_msgs/msg/String"]["rihs01"],
            qos=qos_profile_default.resolved(),
            gid=bytes.fromhex(TOKENS[2]["gid"]),
        ),
    )


@pytest.mark.parametrize("name", PROFILES)
def test_qos_is_written_as_rmw_zenoh_writes_it(name: str) -> None:
    """A default is left out, and what is left to the system is a default."""
    assert liveliness.qos_chunk(PROFILES[name]) == VECTORS["qos_strings"][name]


def test_every_recorded_profile_is_covered() -> None:
    """None is forgotten when the recording grows."""
    assert PROFILES.keys() == VECTORS["qos_strings"].keys()


@given(PROFILE)
def test_reading_qos_undoes_writing(qos: QoSProfile) -> None:
    """What arrives is what the endpoint really does: nothing is left to the system."""
    assert liveliness.parse_qos(liveliness.qos_chunk(qos)) == qos.resolved()


@given(st.integers(0, 2**32 - 1), NODES)
def test_reading_a_node_undoes_writing(domain_id: int, node: NodeInfo) -> None:
    """Names, namespaces and enclaves come out whole."""
    key = liveliness.node_token(domain_id, node)

    assert key.count("/") == 8
    assert liveliness.parse_token(key) == liveliness.Token(domain_id, node)


@given(NODES, st.sampled_from(EndpointKind), IDS, NAMES, PROFILE, st.sampled_from(["", "b:c"]))
def test_reading_an_endpoint_undoes_writing(
    node: NodeInfo, kind: EndpointKind, number: int, name: str, qos: QoSProfile, backends: str
) -> None:
    """For every kind, with and without the chunk that Lyrical adds."""
    endpoint = EndpointInfo(
        kind, node, number, f"{name.rstrip('/')}/x", "p/msg/T", "RIHS01_0", qos.resolved(), b""
    )
    key = liveliness.endpoint_token(3, endpoint, backends)
    token = liveliness.parse_token(key)

    assert token is not None
    assert isinstance(token.info, EndpointInfo)
    assert token.domain_id == 3
    assert token.info.gid == liveliness.gid_of(key)
    assert liveliness.endpoint_token(3, token.info, backends) == key


@given(st.lists(st.text(alphabet="0aNMPSé²%:,_ ", max_size=12), max_size=15))
def test_any_token_is_read_or_none(chunks: list[str]) -> None:
    """Any program may declare any token: parsing it never raises."""
    liveliness.parse_token("/".join([liveliness.PREFIX, *chunks]))


@given(st.integers(0, 12), st.text(alphabet="0a%:,-_ é²", max_size=8))
def test_a_token_with_one_strange_chunk_never_raises(place: int, chunk: str) -> None:
    """The nearly right ones are the dangerous ones."""
    chunks = TOKENS[1]["key"].split("/")
    chunks[place] = chunk

    liveliness.parse_token("/".join(chunks))


@pytest.mark.parametrize(
    "chunk",
    [
        "",
        "::,10:,:,:",
        "::10:,:,:,,",
        "::,10:,:,:,",
        "9::,10:,:,:,,",
        "::,10:,:,:2,,",
        "::,-1:,:,:,,",
        "::,ten:,:,:,,",
        "::,10:1_0,:,:,,",
    ],
)
def test_an_unknown_qos_is_none(chunk: str) -> None:
    """rmw_zenoh rejects such a token whole; liveliness 2 is not in its table."""
    assert liveliness.parse_qos(chunk) is None


def test_what_a_later_release_appends_is_left_alone() -> None:
    """Lyrical appended a chunk; the next release may append another."""
    token = liveliness.parse_token(TOKENS[1]["key"] + "/backends:cpu:/more")

    assert token is not None
    assert liveliness.parse_qos("::,10:,:,:,,:more") == liveliness.parse_qos("::,10:,:,:,,")


def test_a_profile_that_is_changed_is_not_that_of_another_endpoint() -> None:
    """Profiles of equal chunks are remembered."""
    first = liveliness.parse_qos("::,10:,:,:,,")
    assert first is not None
    first.depth = 3

    second = liveliness.parse_qos("::,10:,:,:,,")
    assert second is not None
    assert second.depth == 10


def test_endpoints_share_what_they_have_in_common() -> None:
    """Others may announce thousands, and the graph keeps them all."""
    token = TOKENS[-1]["key"]
    infos = []
    for number in (1001, 1002):
        chunks = token.split("/")
        chunks[4] = str(number)
        parsed = liveliness.parse_token("/".join(chunks))
        assert parsed is not None
        assert isinstance(parsed.info, EndpointInfo)
        infos.append(parsed.info)
    one, other = infos

    assert one != other
    assert one.node is other.node
    assert one.name is other.name
    assert one.type_name is other.type_name
    assert one.type_hash is other.type_hash


def test_a_depth_of_zero_is_the_default_depth() -> None:
    """As rmw_zenoh takes it."""
    qos = liveliness.parse_qos("::,0:,:,:,,")

    assert qos is not None
    assert qos.depth == 42


@pytest.mark.parametrize(
    "character", ["\x1b", "\n", "\r", "\x00", "\x7f", "\x9b", "\u202e", " ", "["]
)
def test_a_token_with_what_no_name_can_hold_is_refused(character: str) -> None:
    """Tools print the names of others, so a name could recolour or rewrite a terminal."""
    good = "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/1/NN/%/%/talker"

    assert liveliness.parse_token(good) is not None
    assert liveliness.parse_token(good.replace("talker", f"talk{character}er")) is None
    assert liveliness.parse_token(f"{good}{'x' * 5000}") is None


@pytest.mark.parametrize(
    ("place", "chunk"),
    [
        (6, "%..%etc"),
        (7, "%..%..%etc"),
        (7, "%ns%"),
        (8, ".."),
        (8, "~"),
        (8, "9lives"),
        (9, "%..%..%etc"),
        (9, "%chatter%"),
        (9, "chatter"),
        (9, "%a%%b"),
        (9, "%chatter%9"),
        (9, f"%{'x' * 250}"),
        (10, "..%..%etc::msg::dds_::String_"),
        (10, "std_msgs::..::dds_::String_"),
        (10, "std_msgs::msg::dds_::.._"),
    ],
)
def test_a_token_with_a_name_that_ros_does_not_allow_is_refused(place: int, chunk: str) -> None:
    """No node of ROS has such a name, and tools make paths and keys of the names of others."""
    chunks = TOKENS[1]["key"].split("/")
    assert liveliness.parse_token("/".join(chunks)) is not None
    chunks[place] = chunk

    assert liveliness.parse_token("/".join(chunks)) is None
