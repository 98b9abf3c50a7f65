"""The limit on announcements of others that a context keeps."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
import zenoh  # noqa: TID251  # its kinds of samples

from aionode.clock import MachineTime
from aionode.engine.context import Context
from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh.bridge._state import BridgeState
from aionode.engine.transport.zenoh.delivery.acknowledgements import GONE
from aionode.engine.transport.zenoh.discovery import graph_watcher
from aionode.engine.transport.zenoh.session import announced
from aionode.engine.transport.zenoh.session.announced import AnnouncedLimit
from aionode.engine.wire._liveliness import endpoint_token
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.message import type_name
from aionode.qos import QoSProfile
from tests.support.peers import DOMAIN_ID, quiet_node, raw_session

LIMIT = 4_000_000


def taken(limit: AnnouncedLimit, participant: str, count: int) -> int:
    """Return how many of some tokens of a participant were accepted."""
    return sum(limit.admit(participant, f"{participant} {number:04}") for number in range(count))


def test_one_participant_gets_an_eighth() -> None:
    """One flood leaves room for everyone else."""
    limit = AnnouncedLimit(LIMIT)

    assert taken(limit, "liar", 10_000) == LIMIT // 8 // (announced.TOKEN_BYTES + 9)


def test_the_size_of_a_token_counts() -> None:
    """A name may have thousands of characters."""
    limit = AnnouncedLimit(LIMIT)

    assert not limit.admit("liar", "x" * (LIMIT // 8))
    assert limit.admit("liar", "x" * (LIMIT // 16))


def test_a_connected_participant_keeps_its_place() -> None:
    """Invented participants, which are unlimited in number, get only the rest."""
    limit = AnnouncedLimit(LIMIT, {"robot"})
    for number in range(100):
        taken(limit, f"invented{number}", 100)

    assert taken(limit, "late", 1) == 0
    assert taken(limit, "robot", 100) == 100
    assert taken(limit, "robot", 1000) < 1000


def test_contexts_that_acknowledge_are_limited_present_or_gone() -> None:
    """A token costs whoever declares it nothing."""
    state = SessionState("a1", DOMAIN_ID, graph_bytes=LIMIT)
    acknowledgements = state.acknowledgements

    def take(participant: str, kind: zenoh.SampleKind) -> None:
        key = acknowledgements.token_of(participant)
        acknowledgements._receive_token(SimpleNamespace(key_expr=key, kind=kind))  # type: ignore[arg-type]  # a stand-in

    take("f" * 33, zenoh.SampleKind.PUT)  # no Zenoh session has such an id
    for number in range(3000):
        take(f"{number:x}", zenoh.SampleKind.PUT)
    kept = len(acknowledgements.present)
    assert 1500 < kept < LIMIT // announced.TOKEN_BYTES
    for number in range(3000):
        take(f"{number:x}", zenoh.SampleKind.DELETE)

    assert acknowledgements.present == set()
    assert len(acknowledgements.participants) == GONE
    take("7", zenoh.SampleKind.PUT)
    assert "7" in acknowledgements.present


def test_namespaces_of_bridges_are_limited(caplog: pytest.LogCaptureFixture) -> None:
    """Each is compared with each name of this context, and remembered forever."""
    state = BridgeState("a1", DOMAIN_ID, MachineTime(), LoopWaker())
    for number in range(150):
        state.add_bridge(f"{number:x}", f"robot{number}/")
    state.add_bridge("ff", "robot1/")

    assert len(state._served) == 100
    assert len(state.prefixes) == 101
    assert caplog.text.count("more than 100 namespaces") == 1


def test_what_has_gone_leaves_its_place(caplog: pytest.LogCaptureFixture) -> None:
    """The log occasionally says that something was left out, and by which limit."""
    limit = AnnouncedLimit(LIMIT)
    count = taken(limit, "a", 10_000)
    for number in range(count):
        limit.release("a", f"a {number:04}")

    assert taken(limit, "a", 10_000) == count
    assert limit.left_out == 2 * (10_000 - count)
    (line,) = caplog.messages
    assert "AIONODE_GRAPH_BYTES" in line


async def test_a_flood_is_left_out_of_the_graph_and_has_its_place_when_there_is_room(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Later announcements of others are still in it."""
    monkeypatch.setattr(announced, "RESERVED_BYTES", 10_000)
    monkeypatch.setattr(graph_watcher, "FILL_S", 0.05)
    async with quiet_node("a", Context(graph_bytes=100_000)) as a:
        with raw_session() as session:
            liar = NodeInfo(str(session.zid()), 0, "liar", "/", "/")
            publishers = [
                EndpointInfo(
                    EndpointKind.PUBLISHER,
                    liar,
                    number,
                    f"/topic_{number}",
                    type_name(Int32),
                    type_hash(Int32),
                    QoSProfile(depth=1),
                    b"",
                )
                for number in range(20)
            ]
            held = [
                session.liveliness().declare_token(endpoint_token(DOMAIN_ID, each))
                for each in publishers
            ]
            async with quiet_node("b") as b:
                b.create_publisher(Int32, "late", 1)
                await a.graph.until(lambda: bool(a.graph.count(EndpointKind.PUBLISHER, "/late")))
                kept = [each for each in a.graph.endpoints() if each.node == liar]
                assert 0 < len(kept) < 20

                for token in held[:15]:
                    token.undeclare()
                await a.graph.until(
                    lambda: (
                        {each.name for each in a.graph.endpoints() if each.node == liar}
                        == {f"/topic_{number}" for number in range(15, 20)}
                    )
                )
