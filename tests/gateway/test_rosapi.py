"""The services of rosapi, as called by clients of rosbridge."""

from __future__ import annotations

import json
from typing import Any

import pytest

from aionode.action import ActionServer
from aionode.gateway.policy.policy import Policy
from aionode.gateway.session.robot import Robot
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import settle
from tests.support.rosbridge import RosbridgeClient, rosbridge_client


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Answer a request."""
    return AddTwoInts.Response()


@pytest.fixture(autouse=True)
async def endpoints(node: Node) -> None:
    """Give the node one endpoint of each kind."""
    node.create_publisher(String, "/words", 10)
    node.create_subscription(Twist, "/cmd_vel", print)
    node.create_service(AddTwoInts, "/add", add)
    ActionServer(node, Fibonacci, "/fibonacci", print)
    node.declare_parameter("speed", 1.5)
    await settle()


@pytest.mark.parametrize(
    ("service", "args", "values"),
    [
        ("topic_type", {"topic": "/words"}, {"type": "std_msgs/msg/String"}),
        ("topic_type", {"topic": "/none"}, {"type": ""}),
        ("topics_for_type", {"type": "geometry_msgs/Twist"}, {"topics": ["/cmd_vel"]}),
        ("publishers", {"topic": "/words"}, {"publishers": ["/robot_node"]}),
        ("subscribers", {"topic": "cmd_vel"}, {"subscribers": ["/robot_node"]}),
        ("service_type", {"service": "/add"}, {"type": "example_interfaces/srv/AddTwoInts"}),
        ("service_type", {"service": "/none"}, {"type": ""}),
        ("service_type", {"service": "/rosapi/nodes"}, {"type": "rosapi_msgs/srv/Nodes"}),
        ("services_for_type", {"type": "example_interfaces/AddTwoInts"}, {"services": ["/add"]}),
        ("service_node", {"service": "/add"}, {"node": "/robot_node"}),
        ("service_node", {"service": "/none"}, {"node": ""}),
        (
            "service_providers",
            {"service": "example_interfaces/srv/AddTwoInts"},
            {"providers": ["/robot_node"]},
        ),
        ("action_servers", {}, {"action_servers": ["/fibonacci"]}),
        (
            "action_type",
            {"action": "/fibonacci"},
            {"type": "example_interfaces/action/Fibonacci"},
        ),
        (
            "get_param",
            {"name": "/robot_node:speed"},
            {"value": "1.5", "successful": True, "reason": ""},
        ),
        ("has_param", {"name": "/robot_node:speed"}, {"exists": True}),
        ("has_param", {"name": "/robot_node:none"}, {"exists": False}),
        ("has_param", {"name": "nonsense"}, {"exists": False}),
    ],
)
async def test_a_question_has_its_answer(
    client: RosbridgeClient, service: str, args: dict[str, str], values: dict[str, Any]
) -> None:
    """The fields are those of rosapi_msgs; names may lack their slash."""
    answer = await client.call(f"/rosapi/{service}", **args)

    assert answer["result"] is True
    assert answer["values"] == values


async def test_lists_have_what_the_robot_has(client: RosbridgeClient) -> None:
    """Without hidden names, and with rosapi itself, which clients look for."""
    topics = (await client.call("rosapi/topics"))["values"]
    services = (await client.call("rosapi/services"))["values"]["services"]
    nodes = (await client.call("rosapi/nodes"))["values"]["nodes"]
    interfaces = (await client.call("rosapi/interfaces"))["values"]["interfaces"]

    types = dict(zip(topics["topics"], topics["types"], strict=True))
    assert types["/words"] == "std_msgs/msg/String"
    assert not [name for name in types if "/_" in name]
    assert {"/add", "/rosapi/topics"} <= set(services)
    assert "/robot_node" in nodes
    assert "std_msgs/msg/String" in interfaces


async def test_pages_ask_for_what_is_offered_without_infrastructure(
    client: RosbridgeClient,
) -> None:
    """The page shows the log and parameters of nodes in separate panels."""
    offered = (await client.call("/rosapi/offered"))["values"]

    types = dict(zip(offered["topics"], offered["types"], strict=True))
    assert types["/words"] == "std_msgs/msg/String"
    assert not {"/rosout", "/parameter_events"} & set(types)
    assert "/add" in offered["services"]
    assert "/robot_node/get_parameters" not in offered["services"]
    assert offered["actions"] == ["/fibonacci"]
    assert "/robot_node" in offered["nodes"]


async def test_node_details_name_the_endpoints_of_a_node(client: RosbridgeClient) -> None:
    """An unknown node has none: rosapi does not answer at all."""
    details = (await client.call("/rosapi/node_details", node="/robot_node"))["values"]
    nothing = (await client.call("/rosapi/node_details", node="/none"))["values"]

    assert "/words" in details["publishing"]
    assert details["subscribing"] == ["/cmd_vel"]
    assert "/add" in details["services"]
    assert nothing == {"subscribing": [], "publishing": [], "services": []}


async def test_message_details_describe_a_type_and_what_it_contains(
    client: RosbridgeClient,
) -> None:
    """The type itself comes first; clients create forms from these."""
    answer = await client.call("/rosapi/message_details", type="geometry_msgs/Twist")

    twist, vector = answer["values"]["typedefs"]
    assert twist["type"] == "geometry_msgs/Twist"
    assert twist["fieldnames"] == ["linear", "angular"]
    assert twist["fieldtypes"] == ["geometry_msgs/Vector3"] * 2
    assert (twist["fieldarraylen"], twist["examples"]) == ([-1, -1], ["{}", "{}"])
    assert (vector["fieldtypes"], vector["examples"]) == (["double"] * 3, ["0.0"] * 3)


@pytest.mark.parametrize(
    ("service", "type_name", "fields"),
    [
        ("message_details", "action/Fibonacci_FeedbackMessage", ["goal_id", "feedback"]),
        ("message_details", "action/Fibonacci_Goal", ["order"]),
        ("service_request_details", "action/Fibonacci_SendGoal", ["goal_id", "goal"]),
    ],
)
async def test_details_describe_the_parts_of_an_action(
    client: RosbridgeClient, service: str, type_name: str, fields: list[str]
) -> None:
    """The lists of topics and services name them."""
    type_name = f"example_interfaces/{type_name}"
    answer = await client.call(f"/rosapi/{service}", type=type_name)

    assert answer["values"]["typedefs"][0]["fieldnames"] == fields


async def test_details_tell_arrays_defaults_and_constants(client: RosbridgeClient) -> None:
    """A length of 0 means any, and -1 no array."""
    answer = await client.call("/rosapi/message_details", type="sensor_msgs/msg/BatteryState")

    battery = answer["values"]["typedefs"][0]
    lengths = dict(zip(battery["fieldnames"], battery["fieldarraylen"], strict=True))
    values = dict(zip(battery["constnames"], battery["constvalues"], strict=True))
    assert (lengths["cell_voltage"], lengths["voltage"]) == (0, -1)
    assert values["POWER_SUPPLY_STATUS_CHARGING"] == "1"


@pytest.mark.parametrize(
    ("service", "type_name", "fields"),
    [
        ("service_request_details", "example_interfaces/AddTwoInts", ["a", "b"]),
        ("service_response_details", "example_interfaces/srv/AddTwoInts", ["sum"]),
        ("action_goal_details", "example_interfaces/action/Fibonacci", ["order"]),
        ("action_result_details", "example_interfaces/action/Fibonacci", ["sequence"]),
        ("action_feedback_details", "example_interfaces/Fibonacci", ["sequence"]),
    ],
)
async def test_details_of_services_and_actions(
    client: RosbridgeClient, service: str, type_name: str, fields: list[str]
) -> None:
    """Each part has a service of its own."""
    answer = await client.call(f"/rosapi/{service}", type=type_name)

    assert answer["values"]["typedefs"][0]["fieldnames"] == fields


@pytest.mark.parametrize(
    "type_name", ["none/msg/None", "", "std_msgs", "example_interfaces/srv/AddTwoInts"]
)
async def test_an_unknown_type_is_an_answer(client: RosbridgeClient, type_name: str) -> None:
    """Rosapi raises in its own log, and the client waits."""
    answer = await client.call("/rosapi/message_details", type=type_name)

    assert answer["result"] is False
    assert isinstance(answer["values"], str)


async def test_raw_types_have_the_whole_text(client: RosbridgeClient) -> None:
    """Foxglove reads them to decode cbor-raw."""
    values = (await client.call("/rosapi/topics_and_raw_types"))["values"]

    texts = dict(zip(values["topics"], values["typedefs_full_text"], strict=True))
    assert texts["/cmd_vel"].startswith("Vector3 linear\nVector3 angular\n")
    assert f"\n{'=' * 80}\nMSG: geometry_msgs/Vector3\n" in texts["/cmd_vel"]


# Parameters


async def test_a_parameter_is_set_and_deleted(client: RosbridgeClient, node: Node) -> None:
    """Values are JSON text; a refusal has a reason."""
    done = await client.call("/rosapi/set_param", name="/robot_node:speed", value="2.5")
    wrong = await client.call("/rosapi/set_param", name="/robot_node:speed", value='"fast"')
    nothing = await client.call("/rosapi/set_param", name="/robot_node:speed", value="{")
    unknown = await client.call("/rosapi/set_param", name="speed", value="1")
    undeclared = await client.call("/rosapi/delete_param", name="/robot_node:speed")

    assert done["values"] == {"successful": True, "reason": ""}
    assert node.get_parameter("speed").value == 2.5
    for answer in (wrong, nothing, unknown, undeclared):
        assert answer["result"] is True
        assert answer["values"]["successful"] is False
        assert answer["values"]["reason"]


@pytest.mark.parametrize(
    ("present", "text", "value"),
    [
        (1.5, "2", 2.0),
        ([1.5], "[2, 3]", [2.0, 3.0]),
        ([1.5], "[3.5, 4]", [3.5, 4.0]),
        (1, "2", 2),
        ([1], "[2, 3]", [2, 3]),
        (["left"], "[]", []),
        ([1.5], "[]", []),
    ],
)
async def test_a_double_may_be_written_as_a_whole_number(
    client: RosbridgeClient, node: Node, present: Any, text: str, value: Any
) -> None:
    """JavaScript cannot write 2.0."""
    node.declare_parameter("gain", present)

    done = await client.call("/rosapi/set_param", name="/robot_node:gain", value=text)

    assert done["values"] == {"successful": True, "reason": ""}
    got = node.get_parameter("gain").value
    assert (list(got) if isinstance(value, list) else got) == value


async def test_a_parameter_that_is_not_there_has_the_default(client: RosbridgeClient) -> None:
    """A name without a colon is an error that the client gets."""
    for name in ("/robot_node:none", "nonsense", "/none:speed"):
        answer = await client.call("/rosapi/get_param", name=name, default_value="7")

        assert answer["values"]["value"] == "7"
        assert answer["values"]["successful"] is False


async def test_parameters_of_all_nodes_are_listed(client: RosbridgeClient) -> None:
    """With the names of their nodes."""
    names = (await client.call("/rosapi/get_param_names"))["values"]["names"]

    assert "/robot_node:speed" in names


# Time and policy


async def test_the_time_is_that_of_the_node(client: RosbridgeClient, robot: Robot) -> None:
    """Simulated time included."""
    time = (await client.call("/rosapi/get_time"))["values"]["time"]

    assert abs(time["sec"] - robot.node.get_clock().now().nanoseconds // 10**9) <= 1


async def test_what_the_policy_hides_is_not_in_the_answers(robot: Robot, tmp_path: Any) -> None:
    """It is neither in lists, nor returned when requested by name."""
    file = tmp_path / "policy.toml"
    file.write_text('[[allow]]\nsee = "/words"\n')
    robot.policy = Policy.load(file)
    async with rosbridge_client(robot) as client:
        topics = (await client.call("/rosapi/topics"))["values"]["topics"]
        kind = (await client.call("/rosapi/topic_type", topic="/cmd_vel"))["values"]["type"]
        nodes = (await client.call("/rosapi/nodes"))["values"]["nodes"]
        speed = await client.call("/rosapi/get_param", name="/robot_node:speed")
        changed = await client.call("/rosapi/set_param", name="/robot_node:speed", value="1.0")

    assert (topics, kind, nodes) == (["/words"], "", [])
    assert speed["values"]["successful"] is False
    assert changed["values"]["successful"] is False
    assert "refused" in json.dumps(changed)
