"""The route of a pair of endpoints, as seen by another process."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.cli._nouns.doctor import doctor
from aionode.cli._nouns.doctor.routes import link_findings, pairs_of
from aionode.engine.transport.base import LinkStatus
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int8, String

NO_LINKS = LinkStatus(set(), set())


def endpoint(kind: EndpointKind, participant: str, name: str) -> EndpointInfo:
    """Return an endpoint of /chatter, of a node in a separate process."""
    node = NodeInfo(participant, 0, name, "/")
    gid = f"{participant}/{name}".encode()
    return EndpointInfo(kind, node, 1, "/chatter", "a/msg/B", "hash", QoSProfile(depth=1), gid)


TALKER = endpoint(EndpointKind.PUBLISHER, "a", "talker")
LISTENER = endpoint(EndpointKind.SUBSCRIPTION, "b", "listener")


def advertisements(**ends: str) -> LinkStatus:
    """Return the advertisements of unlinked contexts, each with version, host and user."""
    return LinkStatus({f"{participant}/link/{end}" for participant, end in ends.items()}, set())


def test_linked_processes_use_the_link() -> None:
    """Regardless of which process advertises the link."""
    (pair,) = pairs_of([LISTENER, TALKER], LinkStatus(set(), {frozenset("ab")}))

    assert pair.text() == "/talker -> /listener on /chatter: link"
    assert link_findings([pair]) == []


def test_what_is_kept_for_late_subscriptions_goes_by_zenoh() -> None:
    """Even if the processes are linked."""
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    kept = msgspec.structs.replace(TALKER, qos=profile)

    (pair,) = pairs_of([kept, LISTENER], LinkStatus(set(), {frozenset("ab")}))

    assert (pair.route, pair.reason) == ("zenoh", "it keeps messages for late subscriptions")
    assert link_findings([pair]) == []


@pytest.mark.parametrize(
    ("known", "reason"),
    [
        (NO_LINKS, "no link is offered by /talker and /listener"),
        (advertisements(a="1/host/1000"), "no link is offered by /listener"),
        (advertisements(b="1/host/1000"), "no link is offered by /talker"),
        (advertisements(a="1/host/1000", b="nonsense"), "no link is offered by /listener"),
        (advertisements(a="1/host/1000", b="1/other/1000"), "they are on different hosts"),
        (advertisements(a="1/host/1000", b="1/host/1001"), "they belong to different users"),
    ],
)
def test_where_no_link_is_possible_zenoh_is_used_and_nothing_is_wrong(
    known: LinkStatus, reason: str
) -> None:
    """The normal case with every ROS 2 node."""
    (pair,) = pairs_of([TALKER, LISTENER], known)

    assert pair.text() == f"/talker -> /listener on /chatter: zenoh ({reason})"
    assert link_findings([pair]) == []


@pytest.mark.parametrize(
    ("version", "text", "remedy"),
    [
        (1, "could be linked, but are not", "the same XDG_RUNTIME_DIR"),
        (2, "use different versions of the link protocol", "the same version of aionode"),
    ],
)
def test_a_link_that_should_be_there_is_a_hint(version: int, text: str, remedy: str) -> None:
    """Everything works without it, only slower; one hint for two processes with many endpoints."""
    other = endpoint(EndpointKind.SUBSCRIPTION, "b", "other")
    known = advertisements(a="1/host/1000", b=f"{version}/host/1000")

    pairs = pairs_of([TALKER, LISTENER, other], known)
    (finding,) = link_findings(pairs)

    assert [pair.route for pair in pairs] == ["zenoh", "zenoh"]
    assert (finding.severity, finding.subject) == ("hint", "link")
    assert f"the processes of /talker and /listener {text}" in finding.text
    assert remedy in finding.remedy


async def test_the_doctor_shows_the_routes_of_the_given_names(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Within one process nothing is linked; endpoints that do not match have no route."""
    node_factory("talker").create_publisher(String, "/chatter", 10)
    node_factory("listener").create_subscription(String, "/chatter", lambda msg: None)
    node_factory("deaf").create_subscription(Int8, "/chatter", lambda msg: None)
    node_factory("clock").create_publisher(String, "/time", 10)
    node_factory("watch").create_subscription(String, "/time", lambda msg: None)

    await doctor(tool, ["listener", "/time"], output=screen.output)

    assert (
        "\nPairs of linked processes: 0\n"
        "  /talker -> /listener on /chatter: local\n"
        "  /clock -> /watch on /time: local\n"
    ) in screen.text
    assert "/deaf on" not in screen.text


async def test_without_names_the_routes_are_only_in_the_record(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """As text they would be too many lines."""
    node_factory("talker").create_publisher(String, "/chatter", 10)
    node_factory("listener").create_subscription(String, "/chatter", lambda msg: None)

    await doctor(tool, output=screen.output)
    assert "Pairs of linked processes: 0\n" in screen.text
    assert "->" not in screen.text.partition("hint")[0]

    screen.stdout.truncate(0)
    screen.stdout.seek(0)
    await doctor(tool, output=screen.json_output)
    assert screen.records[0]["links"] == 0
    assert screen.records[0]["pairs"] == [
        {
            "publisher": "/talker",
            "subscription": "/listener",
            "topic": "/chatter",
            "route": "local",
            "reason": "",
        }
    ]
