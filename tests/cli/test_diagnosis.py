"""``aionode doctor``: the problems it finds, and what it does not mention."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node, QoSProfile, ReliabilityPolicy
from aionode.cli._nouns.doctor import doctor, network_findings
from aionode.cli._support.lookup import ALIKE, close_to, likeness
from aionode.engine.transport.network import network_from
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.std_msgs.msg import Int8, String
from aionode.message import Message, int32
from aionode.parameter import Parameter


@pytest.fixture
async def talker(node_factory: Callable[..., Node]) -> Node:
    """A node that publishes /chatter."""
    talking = node_factory("talker")
    talking.create_publisher(String, "/chatter", 10)
    return talking


async def findings(tool: Node, screen: Any, *names: str) -> tuple[int, list[dict[str, str]]]:
    """Return the exit status and the findings, without those about the network and the machine.

    On a busy machine, callbacks of this process have been late in tests before.
    """
    status = await doctor(tool, names, output=screen.json_output)
    elsewhere = ("discovery range", f"process {os.getpid()} ")
    about_nodes = [r for r in screen.records[1:] if not r["subject"].startswith(elsewhere)]
    return status, about_nodes


async def test_a_sound_system_has_no_problem(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """No findings, and the status of success."""
    node_factory("listener").create_subscription(String, "/chatter", lambda msg: None)

    assert await findings(tool, screen) == (0, [])
    assert screen.records[0]["nodes"] == 2


async def test_two_types_do_not_communicate(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The finding names both types and their nodes."""
    node_factory("listener").create_subscription(Int8, "/chatter", lambda msg: None)

    status, (finding,) = await findings(tool, screen)

    assert status == 1
    assert finding["severity"] == "problem"
    assert finding["subject"] == "topic /chatter"
    assert (
        "publisher of /talker and subscription of /listener do not communicate" in finding["text"]
    )
    assert "their types are std_msgs/msg/String and std_msgs/msg/Int8" in finding["text"]


async def test_simulated_time_that_nobody_publishes_is_a_problem(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The nodes stand still silently."""
    follower = node_factory("follower")
    follower.set_parameters([Parameter("use_sim_time", value=True)])

    status, (finding,) = await findings(tool, screen)

    assert status == 1
    assert (finding["severity"], finding["subject"]) == ("problem", "topic /clock")
    assert "/follower: use_sim_time is true, but nobody publishes /clock" in finding["text"]
    assert "aionode param set /follower use_sim_time false" in finding["remedy"]


async def test_simulated_time_that_somebody_publishes_is_no_problem(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """However many follow it."""
    node_factory("gazebo").create_publisher(Clock, "/clock", 1)
    node_factory("follower").set_parameters([Parameter("use_sim_time", value=True)])

    assert await findings(tool, screen) == (0, [])


async def test_two_definitions_of_one_type_do_not_communicate(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Only the type hashes differ; no other tool reports that."""

    class Words(Message, typename="tutorial/msg/Words"):
        text: str

    class Other(Message, typename="tutorial/msg/Words"):
        number: int32

    node_factory("talker").create_publisher(Words, "/words", 1)
    node_factory("listener").create_subscription(Other, "/words", lambda msg: None)

    _, (finding,) = await findings(tool, screen)

    assert "their definitions of tutorial/msg/Words differ" in finding["text"]


async def test_qos_that_does_not_fit_is_explained(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Offered and requested, in words."""
    weak = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    node_factory("talker").create_publisher(String, "/chatter", weak)
    node_factory("listener").create_subscription(String, "/chatter", lambda msg: None)

    _, (finding,) = await findings(tool, screen)

    assert "QoS reliability: offered best_effort, requested reliable" in finding["text"]


async def test_nearly_equal_names_are_found(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The most common reason, with a remedy that can be typed."""
    node_factory("listener").create_subscription(String, "/robot/chatter", lambda msg: None)

    status, (finding,) = await findings(tool, screen)

    assert status == 1
    assert (
        "subscription of /listener is waiting, but the publisher of /talker uses /chatter"
        in (finding["text"])
    )
    assert finding["remedy"] == "rename one of them: --ros-args -r /robot/chatter:=/chatter"


async def test_a_client_without_a_server_is_a_hint(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """It may start later, so the status is still that of success."""
    node_factory("client").create_client(AddTwoInts, "/add_two_ints")

    status, (finding,) = await findings(tool, screen)

    assert status == 0
    assert finding["severity"] == "hint"
    assert finding["text"] == "the client of /client is waiting: there is no server"


async def test_two_nodes_of_one_name_are_a_hint(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Requests for their parameters reach both."""
    node_factory("twin")
    node_factory("twin")

    _, (finding,) = await findings(tool, screen)

    assert finding["subject"] == "/twin"


async def test_names_narrow_the_view(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """In a large system the question is about one topic, and the endpoint that misspelled it."""
    node_factory("listener").create_subscription(String, "/chater", lambda msg: None)
    node_factory("client").create_client(AddTwoInts, "/add_two_ints")

    _, (finding,) = await findings(tool, screen, "/chatter")

    assert finding["subject"] == "topic /chater"


async def test_an_unknown_name_is_an_error(tool: Node, talker: Node, screen: Any) -> None:
    """Nothing found is not the same as nothing wrong."""
    with pytest.raises(CommandError, match="No node, topic or service '/chattr'"):
        await doctor(tool, ["/chattr"], output=screen.output)


async def test_text_has_a_summary_and_an_arrow_for_each_remedy(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Text is the form for people."""
    node_factory("listener").create_subscription(Int8, "/chatter", lambda msg: None)

    await doctor(tool, output=screen.output)

    assert screen.text.startswith("Domain: ")
    assert "\nproblem: topic /chatter: " in screen.text
    assert "\n  -> use the same type on both sides" in screen.text
    assert "\n1 problem(s), " in screen.text


@pytest.mark.parametrize(
    ("environ", "state", "subject"),
    [
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, {}, "discovery range"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}, {}, "router"),
        ({}, {"alone": True}, "discovery range"),
        ({}, {"alone": True, "domains": [5]}, "domain"),
        ({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, {}, "RMW_IMPLEMENTATION"),
    ],
)
def test_what_keeps_nodes_from_being_found(
    environ: dict[str, str], state: dict[str, Any], subject: str
) -> None:
    """Settings are the usual reason when no node is found."""
    options: dict[str, Any] = {"has_router": False, "domains": [], "alone": False, **state}

    (finding,) = network_findings(network_from(environ), environ, **options)

    assert finding.subject == subject


def test_a_normal_network_is_not_remarked_on() -> None:
    """No finding for default settings or for the RMW that aionode communicates with."""
    environ = {"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}

    remarks = network_findings(
        network_from(environ), environ, has_router=False, domains=[], alone=False
    )

    assert remarks == []


@pytest.mark.parametrize(
    ("name", "other", "alike"),
    [
        ("/chatter", "/Chatter", True),
        ("/chatter", "/robot/chatter", True),
        ("/word_count", "/word_counts", True),
        ("/chatter", "/odom", False),
        ("/left/image", "/left/depth", False),
        ("/robot/chater", "/chatter", True),
        ("/left/image", "/right/image", False),
        ("/camera/image_raw", "/camera/image_info", False),
        ("/first/get_parameters", "/talker/get_parameters", False),
    ],
)
def test_names_that_are_alike(name: str, other: str, alike: bool) -> None:
    """Different words are not a misspelling."""
    assert (likeness(name, other) >= ALIKE) is alike


def test_the_nearest_name_is_suggested() -> None:
    """The first one with the same last part is not, nor one that has nothing else in common."""
    known = ["/arm/get_state", "/base/get_state"]

    assert close_to("/bse/get_state", known) == ". Did you mean '/base/get_state'?"
    assert close_to("get_state", known) == ". Did you mean '/arm/get_state'?"
    assert close_to("/wheels/get_state", known) == ""


async def test_services_of_another_node_are_no_misspelling(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """All nodes have services with these names: renaming one would not help."""
    node_factory("first").create_service(AddTwoInts, "~/add", lambda request, response: response)
    node_factory("client").create_client(AddTwoInts, "/second/add")

    status, (finding,) = await findings(tool, screen)

    assert (status, finding["text"]) == (0, "the client of /client is waiting: there is no server")


async def test_two_servers_of_one_service_are_a_hint(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Each call reaches both, which is rarely meant."""
    for name in ("one", "two"):
        node_factory(name).create_service(AddTwoInts, "/add", lambda request, response: response)

    status, (finding,) = await findings(tool, screen)

    assert (status, finding["severity"], finding["subject"]) == (0, "hint", "service /add")
    assert finding["text"].startswith("it has 2 servers, of /one, /two: each request goes to all")
