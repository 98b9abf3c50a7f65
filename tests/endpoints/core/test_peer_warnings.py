"""Warnings that other processes can cause in any number."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from aionode import Context, Node
from aionode.engine.reports.peer_warnings import PeerWarnings
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int8, String
from aionode.message import type_name
from aionode.qos import qos_profile_default

NODE = NodeInfo("abc", 1, "robot", "/")


def texts(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings so far."""
    return [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]


def strangers(topic: str, count: int) -> Iterator[EndpointInfo]:
    """Yield subscriptions of another process, of another type."""
    for number in range(count):
        yield EndpointInfo(
            EndpointKind.SUBSCRIPTION,
            NODE,
            number,
            topic,
            type_name(Int8),
            type_hash(Int8),
            qos_profile_default,
            number.to_bytes(16, "big"),
        )


async def test_a_thousand_endpoints_that_do_not_match_are_a_dozen_lines(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """They would push everything else out of the log."""
    node.create_publisher(String, "/words", 10)

    for stranger in strangers("/words", 1000):
        context.graph.add_endpoint(stranger)

    found = texts(caplog)
    assert len(found) == 13
    assert found[-1] == (
        "100 more warnings about endpoints that do not match were left out, the last one about "
        "/words; `aionode doctor` shows all"
    )


def test_each_subject_has_its_share_of_the_log(caplog: pytest.LogCaptureFixture) -> None:
    """A flood about one topic must not hide the one warning about another."""
    warnings = PeerWarnings("endpoints that do not match")
    for number in range(1000):
        warnings.warn(NODE, "/flooded", f"flood {number}")

    warnings.warn(NODE, "/other", "this one matters")

    assert texts(caplog)[-1] == "this one matters"


def test_all_subjects_together_are_bounded(caplog: pytest.LogCaptureFixture) -> None:
    """Others may choose any topic names."""
    warnings = PeerWarnings("endpoints that do not match")

    for number in range(10_000):
        warnings.warn(NODE, f"/topic{number}", "odd")

    assert len(texts(caplog)) == 100 + 4  # 1, 10, 100 and 1000 more
