"""``aionode node``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.action import ActionServer
from aionode.cli._nouns.node import info, list_nodes
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci


async def test_list_prints_full_names_sorted(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Hidden nodes, such as other terminals, are left out."""
    for name, namespace in (("talker", "/"), ("camera", "/front"), ("_hidden", "/")):
        node_factory(name, namespace=namespace)

    await list_nodes(tool, output=screen.output)
    await list_nodes(tool, count=True, output=screen.output)
    await list_nodes(tool, hidden=True, count=True, output=screen.output)

    assert screen.text == "/front/camera\n/talker\n2\n3\n"


async def test_two_nodes_of_one_name_are_warned_of(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The names stay on stdout, one per node."""
    node_factory("talker")
    node_factory("talker")

    await list_nodes(tool, output=screen.output)

    assert screen.text == "/talker\n/talker\n"
    assert screen.errors.startswith(
        "WARNING: Be aware that there are nodes in the graph that share"
    )


async def test_info_prints_what_ros2_prints(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """A heading with nothing below it has an empty line, as in ros2."""
    node_factory("param_node")

    await info(tool, "/param_node", output=screen.output)

    assert screen.text == (
        "/param_node\n"
        "  Subscribers:\n"
        "\n"
        "  Publishers:\n"
        "    /parameter_events: rcl_interfaces/msg/ParameterEvent\n"
        "    /rosout: rcl_interfaces/msg/Log\n"
        "  Service Servers:\n"
        "    /param_node/describe_parameters: rcl_interfaces/srv/DescribeParameters\n"
        "    /param_node/get_parameter_types: rcl_interfaces/srv/GetParameterTypes\n"
        "    /param_node/get_parameters: rcl_interfaces/srv/GetParameters\n"
        "    /param_node/get_type_description: "
        "type_description_interfaces/srv/GetTypeDescription\n"
        "    /param_node/list_parameters: rcl_interfaces/srv/ListParameters\n"
        "    /param_node/set_parameters: rcl_interfaces/srv/SetParameters\n"
        "    /param_node/set_parameters_atomically: rcl_interfaces/srv/SetParametersAtomically\n"
        "  Service Clients:\n"
        "\n"
        "  Action Servers:\n"
        "\n"
        "  Action Clients:\n"
        "\n"
    )


async def test_info_shows_an_action_as_one_thing(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Its five topics and services are hidden."""

    async def execute(goal_handle: Any) -> Any:
        return Fibonacci.Result()

    ActionServer(node_factory("fib_server"), Fibonacci, "fibonacci", execute)

    await info(tool, "fib_server", output=screen.json_output)

    (record,) = screen.records
    assert record["action_servers"] == {"/fibonacci": ["example_interfaces/action/Fibonacci"]}
    assert not any("_action" in name for name in record["publishers"])


async def test_an_unknown_node_is_named_with_one_like_it(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The same words as ros2's, and a hint."""
    node_factory("talker")

    with pytest.raises(
        CommandError, match=r"Unable to find node '/taker'\. Did you mean '/talker'"
    ):
        await info(tool, "/taker", output=screen.output)
