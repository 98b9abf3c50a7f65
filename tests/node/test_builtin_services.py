"""Tests of what every node offers: log, parameters, types, time, and arguments."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Any

import hypothesis
import pytest
from hypothesis import strategies as st

from aionode.engine.wire.typehash import type_hash
from aionode.errors import (
    ParameterNotDeclaredException,
    UnknownROSArgsError,
)
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.rcl_interfaces import srv
from aionode.interfaces.rcl_interfaces.msg import (
    Log,
    LoggerLevel,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from aionode.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from aionode.interfaces.rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.parameter_client import AsyncParameterClient
from aionode.qos import qos_profile_rosout_default
from aionode.testing import local_context, settle

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from aionode.engine.context import Context

# Parameters


async def test_parameters_can_be_read_and_set_by_another_node(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """It uses the six services, through the client that awaits them."""
    node.declare_parameter("speed", 1.5)
    client = AsyncParameterClient(node_factory("other"), "/node")
    assert await client.wait_for_services()

    assert [p.value for p in await client.get_parameters(["speed"])] == [1.5]
    (result,) = await client.set_parameters([Parameter("speed", value=2.5)])
    assert result.successful
    assert node.get_parameter("speed").value == 2.5
    assert "speed" in (await client.list_parameters()).names
    assert (await client.describe_parameters(["speed"]))[0].name == "speed"
    assert (await client.get_parameter_types(["speed"])) == [Parameter.Type.DOUBLE]
    result = await client.set_parameters_atomically([Parameter("speed", value="fast")])
    assert not result.successful
    assert "expected" in result.reason
    client.destroy()


async def test_an_undeclared_parameter_is_refused_by_the_service(node: Node) -> None:
    """An exception would end the node that was asked."""
    client = AsyncParameterClient(node, "node")
    (result,) = await client.set_parameters([Parameter("nope", value=5)])
    assert not result.successful
    assert "nope" in result.reason
    assert await client.get_parameters(["nope"]) == []


async def test_a_parameter_file_is_loaded_into_a_running_node(node: Node, tmp_path: Path) -> None:
    """`param load` does the same."""
    node.declare_parameter("speed", 1.0)
    file = tmp_path / "speed.yaml"
    file.write_text("/node: {ros__parameters: {speed: 3.0}}")
    (result,) = await AsyncParameterClient(node, "/node").load_parameter_file(file)
    assert result.successful
    assert node.get_parameter("speed").value == 3.0


async def test_waiting_for_parameter_services_can_end_without_them(node: Node) -> None:
    """The wait returns False, like every such wait."""
    assert not await AsyncParameterClient(node, "/ghost").wait_for_services(timeout_sec=0)


async def test_changes_of_parameters_are_published(node: Node, manual_clock: Any) -> None:
    """The event has the node's name and the time."""
    await manual_clock.advance(2.0)
    events = node.create_subscription(ParameterEvent, "/parameter_events")
    node.declare_parameter("speed", 1.0)
    node.set_parameters([Parameter("speed", value=2.0)])
    declared, changed = await events.receive(), await events.receive()
    assert [p.name for p in declared.new_parameters] == ["speed"]
    assert [p.value.double_value for p in changed.changed_parameters] == [2.0]
    assert changed.node == "/node"
    assert changed.stamp == TimeMsg(sec=2)


async def test_overrides_come_from_arguments_and_the_constructor(context: Context) -> None:
    """The constructor takes precedence over the command line."""
    node = Node(
        "node",
        context=context,
        cli_args=["--ros-args", "-p", "a:=1", "-p", "b:=1"],
        parameter_overrides=[Parameter("b", value=2)],
    )
    assert node.declare_parameter("a", 0).value == 1
    assert node.declare_parameter("b", 0).value == 2


async def test_overrides_can_declare_parameters_by_themselves(context: Context) -> None:
    """This is for nodes that accept whatever they are given."""
    node = Node(
        "node",
        context=context,
        parameter_overrides=[Parameter("a.b", value="x")],
        automatically_declare_parameters_from_overrides=True,
    )
    assert node.get_parameter("a.b").value == "x"
    with pytest.raises(ParameterNotDeclaredException):
        node.get_parameter("c")


async def test_callbacks_of_parameters_may_reject_a_change(node: Node) -> None:
    """The methods have rclpy's names."""
    node.declare_parameter("speed", 1.0)
    node.add_on_set_parameters_callback(
        lambda parameters: SetParametersResult(successful=False, reason="too fast")
    )
    (result,) = node.set_parameters([Parameter("speed", value=9.0)])
    assert result.reason == "too fast"
    assert node.get_parameter("speed").value == 1.0


async def test_profiles_can_be_overridden_by_parameters(context: Context) -> None:
    """The endpoint has to allow it."""
    from aionode.parameter import QoSOverridingOptions

    node = Node(
        "node",
        context=context,
        parameter_overrides=[Parameter("qos_overrides./words.publisher.depth", value=3)],
    )
    options = QoSOverridingOptions.with_default_policies()
    publisher = node.create_publisher(String, "words", 10, qos_overriding_options=options)
    assert publisher.qos_profile.depth == 3


# Arguments


async def test_names_are_remapped_by_arguments(context: Context) -> None:
    """Nodes, namespaces, topics and services; the node's own rules precede shared ones."""
    from aionode.arguments import parse_arguments

    context.arguments = parse_arguments(
        ["--ros-args", "-r", "chatter:=/shared", "-r", "__ns:=/robot"]
    )
    node = Node(
        "node",
        context=context,
        cli_args=["--ros-args", "-r", "__node:=renamed", "-r", "chatter:=/own"],
    )
    assert node.get_fully_qualified_name() == "/robot/renamed"
    assert node.create_publisher(String, "chatter", 10).topic_name == "/own"
    assert node.resolve_topic_name("chatter", only_expand=True) == "/robot/chatter"
    alone = Node("alone", context=context, use_global_arguments=False)
    assert alone.resolve_topic_name("chatter") == "/chatter"


async def test_unknown_arguments_are_refused_with_the_nearest(context: Context) -> None:
    """A typo must not be ignored silently."""
    with pytest.raises(UnknownROSArgsError, match="did you mean --remap"):
        Node("node", context=context, cli_args=["--ros-args", "--remp", "a:=b"])


# Log


async def test_what_a_node_logs_is_published(node: Node, manual_clock: Any) -> None:
    """It goes to /rosout with level, name, place and time, also for late subscriptions."""
    await manual_clock.advance(1.0)
    node.get_logger().warning("hot")
    reader = node.create_subscription(Log, "/rosout", None, qos_profile_rosout_default)
    entry = await reader.receive()
    assert (entry.level, entry.name, entry.msg) == (30, "node", "hot")
    assert entry.file.endswith("test_builtin_services.py")
    assert entry.function == "test_what_a_node_logs_is_published"
    assert entry.stamp == TimeMsg(sec=1)


async def test_a_log_from_a_thread_is_published_in_the_loop(node: Node) -> None:
    """Offloaded callbacks log as well, and queues belong to the loop."""
    reader = node.create_subscription(Log, "/rosout")
    await settle()
    await asyncio.to_thread(lambda: node.get_logger().info(threading.current_thread().name))
    assert (await reader.receive()).msg != threading.current_thread().name


async def test_a_text_that_cannot_be_encoded_is_logged_all_the_same(node: Node) -> None:
    """Logging never fails because of the logged text."""
    reader = node.create_subscription(Log, "/rosout")
    node.get_logger().info("bad \udcff byte")
    assert (await reader.receive()).msg == "bad ? byte"


async def test_the_log_topic_can_be_left_out(context: Context) -> None:
    """The constructor or an argument does that."""
    quiet = Node("quiet", context=context, enable_rosout=False)
    args = ["--ros-args", "--disable-rosout-logs"]
    silent = Node("silent", context=context, cli_args=args)
    assert quiet.count_publishers("/rosout") == 0
    assert not any(publisher.topic_name == "/rosout" for publisher in silent.publishers)


async def test_levels_of_loggers_can_be_set_by_others(
    context: Context, node: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    """Nodes of rclpy offer these two services on request."""
    async with Node("loud", context=context, enable_logger_service=True) as loud:
        get = node.create_client(GetLoggerLevels, "/loud/get_logger_levels")
        put = node.create_client(SetLoggerLevels, "/loud/set_logger_levels")
        levels = [LoggerLevel(name="loud", level=40), LoggerLevel(name="loud", level=7)]
        answer = await put.call(SetLoggerLevels.Request(levels=levels))
        assert [result.successful for result in answer.results] == [True, False]
        loud.get_logger().info("not heard")
        names = GetLoggerLevels.Request(names=["loud"])
        assert (await get.call(names)).levels[0].level == 40
        loud.get_logger().set_level(0)
    assert "not heard" not in capfd.readouterr().err


# Types


async def test_a_node_describes_the_types_it_uses(node: Node) -> None:
    """The description has a matching hash, and the text of the definition."""
    node.create_publisher(Twist, "cmd_vel", 10)
    client = node.create_client(GetTypeDescription, "/node/get_type_description")
    response = await client.call(
        GetTypeDescription.Request(
            type_name="geometry_msgs/msg/Twist",
            type_hash=type_hash(Twist),
            include_type_sources=True,
        )
    )
    assert response.successful
    description = response.type_description
    assert description.type_description.type_name == "geometry_msgs/msg/Twist"
    assert [part.type_name for part in description.referenced_type_descriptions] == [
        "geometry_msgs/msg/Vector3"
    ]
    assert "Vector3" in response.type_sources[0].raw_file_contents


@pytest.mark.parametrize(
    ("name", "wanted_hash", "reason"),
    [
        ("std_msgs/msg/String", "", "is not in use by this node"),
        ("example_interfaces/srv/AddTwoInts", "RIHS01_00", "not RIHS01_00"),
    ],
)
async def test_a_type_that_is_not_used_is_not_described(
    node: Node, name: str, wanted_hash: str, reason: str
) -> None:
    """The answer says why."""
    node.create_service(AddTwoInts, "add", lambda request: AddTwoInts.Response())
    client = node.create_client(GetTypeDescription, "/node/get_type_description")
    response = await client.call(GetTypeDescription.Request(type_name=name, type_hash=wanted_hash))
    assert not response.successful
    assert reason in response.failure_reason


# What peers send


NAMES = st.sampled_from(["speed", "limit", "", "a b", "use_sim_time", "qos_overrides./x.y"])
VALUES: Any = st.builds(
    ParameterValue,
    type=st.integers(0, 255),
    bool_value=st.booleans(),
    integer_value=st.integers(-(2**63), 2**63 - 1),
    double_value=st.floats(),
    string_value=st.text(max_size=5),
    byte_array_value=st.binary(max_size=3),
    integer_array_value=st.lists(st.integers(-(2**63), 2**63 - 1), max_size=3),
)
PARAMETERS = st.lists(st.builds(ParameterMsg, name=NAMES, value=VALUES), max_size=3)
REQUESTS = st.one_of(
    st.builds(srv.GetParameters.Request, names=st.lists(NAMES, max_size=3)),
    st.builds(srv.GetParameterTypes.Request, names=st.lists(NAMES, max_size=3)),
    st.builds(srv.DescribeParameters.Request, names=st.lists(NAMES, max_size=3)),
    st.builds(
        srv.ListParameters.Request, prefixes=st.lists(NAMES), depth=st.integers(0, 2**64 - 1)
    ),
    st.builds(srv.SetParameters.Request, parameters=PARAMETERS),
    st.builds(srv.SetParametersAtomically.Request, parameters=PARAMETERS),
    st.builds(GetLoggerLevels.Request, names=st.lists(st.text(max_size=5), max_size=2)),
    st.builds(
        SetLoggerLevels.Request,
        levels=st.lists(
            st.builds(LoggerLevel, name=st.just("of_nobody"), level=st.integers(0, 2**32 - 1)),
            max_size=2,
        ),
    ),
    st.builds(GetTypeDescription.Request, type_name=st.text(max_size=5)),
)
SERVICES: dict[Any, str] = {
    srv.GetParameters: "get_parameters",
    srv.GetParameterTypes: "get_parameter_types",
    srv.DescribeParameters: "describe_parameters",
    srv.ListParameters: "list_parameters",
    srv.SetParameters: "set_parameters",
    srv.SetParametersAtomically: "set_parameters_atomically",
    GetLoggerLevels: "get_logger_levels",
    SetLoggerLevels: "set_logger_levels",
    GetTypeDescription: "get_type_description",
}


@hypothesis.settings(max_examples=hypothesis.settings().max_examples * 3 // 2, deadline=None)
@hypothesis.given(requests=st.lists(REQUESTS, min_size=1, max_size=5), undeclared=st.booleans())
def test_no_request_of_a_peer_ends_a_node(requests: list[Any], *, undeclared: bool) -> None:
    """The built-in services answer any request of another program."""

    async def ask() -> None:
        async with (
            local_context() as context,
            Node(
                "robot",
                context=context,
                enable_logger_service=True,
                allow_undeclared_parameters=undeclared,
            ) as robot,
            Node("peer", context=context) as peer,
        ):
            robot.declare_parameter("speed", 1.0)
            robot.declare_parameter("limit", 3)
            for request in requests:
                (kind,) = (each for each in SERVICES if type(request) is each.Request)
                client = peer.create_client(kind, f"/robot/{SERVICES[kind]}")
                await client.call(request)
            assert robot.is_running

    asyncio.run(ask())
