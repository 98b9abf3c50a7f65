"""Code as users write it, which mypy --strict and pyright accept."""

from __future__ import annotations

from typing import Any, ClassVar, TypeVar, assert_type

import numpy as np
import numpy.typing as npt

from aionode import (
    Client,
    GoalResponse,
    Health,
    Node,
    NodeEnd,
    Parameter,
    ServerGoalHandle,
    Supervisor,
)
from aionode.interfaces import get_action, get_message, get_service
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Point, PoseStamped, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState, LaserScan
from aionode.interfaces.std_msgs.msg import ByteMultiArray, Header, String
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.message import (
    DEFAULT,
    ActionClass,
    ActionType,
    Array,
    Bounded,
    Message,
    Sequence,
    ServiceClass,
    ServiceType,
    byte,
    documentation,
    fields,
    float32,
    float64,
    from_builtins,
    from_json,
    int32,
    json_schema,
    snapshot,
    snapshotter,
    to_builtins,
    to_json,
    type_name,
    uint8,
)

RequestT = TypeVar("RequestT", bound=Message)
ResponseT = TypeVar("ResponseT", bound=Message)
GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)


class Words(Message, typename="tutorial/msg/Words"):
    """A message written by hand."""

    LIMIT: ClassVar[uint8] = 7

    text: str = ""
    short: Bounded[str, 3] = "abc"
    level: byte = b"\x00"
    count: int32 = 0
    where: Point = DEFAULT
    matrix: Array[float64, 4] = DEFAULT
    scores: Sequence[float32] = DEFAULT
    few: Sequence[Point, 3] = DEFAULT


class Say(ServiceType, typename="tutorial/srv/Say"):
    """A service written by hand."""

    class Request(Message):
        """The words to say."""

        words: Words = DEFAULT

    class Response(Message):
        """Whether it was said."""

        done: bool = False


class Walk(ActionType, typename="tutorial/action/Walk"):
    """An action written by hand."""

    class Goal(Message):
        """How far."""

        distance: float64 = 0.0

    class Result(Message):
        """How long it took."""

        seconds: float64 = 0.0

    class Feedback(Message):
        """How far so far."""

        distance: float64 = 0.0


def request_and_response(
    service: ServiceClass[RequestT, ResponseT],
) -> tuple[RequestT, ResponseT]:
    """Take a service type as create_client does."""
    return service.Request(), service.Response()


def goal_and_result(
    action: ActionClass[GoalT, ResultT, FeedbackT],
) -> tuple[GoalT, ResultT, FeedbackT]:
    """Take an action type as ActionClient does."""
    return action.Goal(), action.Result(), action.Feedback()


def written_by_hand() -> None:
    """Fields are what their annotations say."""
    words = Words(text="hi", matrix=np.zeros(4), scores=[1.0], few=[Point()])
    assert_type(words.text, str)
    assert_type(words.short, str)
    assert_type(words.level, bytes)
    assert_type(words.count, int)
    assert_type(words.where, Point)
    assert_type(Words.LIMIT, int)
    words.matrix = [1, 2, 3, 4]
    words.count += 1


def single_values() -> None:
    """An int fits a float, as everywhere in Python."""
    twist = Twist(linear=Vector3(x=1, y=0.5))
    twist.angular.z = 0.3
    assert_type(twist.linear.x, float)
    pose = PoseStamped(header=Header(frame_id="map"))
    pose.header.stamp.sec = 3
    assert_type(String().data, str)


def arrays() -> None:
    """They take lists, tuples and arrays, and read as arrays."""
    imu = Imu(orientation_covariance=[0.0] * 9)
    imu.angular_velocity_covariance = np.zeros(9)
    imu.linear_acceleration_covariance = (0,) * 9
    imu.orientation_covariance[0] = -1
    covariance: npt.NDArray[np.floating[Any]] = imu.orientation_covariance
    scan = LaserScan(ranges=covariance.astype(np.float32))
    nearest = float(scan.ranges.min())
    joints = JointState(name=["a", "b"], position=[0.0, nearest])
    joints.name.append("c")
    assert_type(joints.name, list[str])


def bytes_like() -> None:
    """Images take what holds bytes."""
    image = Image(data=b"abc")
    image.data = bytearray(b"abc")
    image.data = memoryview(b"abc")
    image.data = np.zeros(3, np.uint8)
    image.data = [1, 2, 3]
    length: int = len(image.data)
    pixels = np.frombuffer(image.data, np.uint8).reshape(1, length)
    assert pixels.shape == (1, 3)
    ByteMultiArray(data=[b"a", b"b"])


def services_and_actions() -> None:
    """A client knows what it sends and gets."""
    assert_type(request_and_response(AddTwoInts), tuple[AddTwoInts.Request, AddTwoInts.Response])
    assert_type(request_and_response(Say), tuple[Say.Request, Say.Response])
    assert_type(goal_and_result(Walk), tuple[Walk.Goal, Walk.Result, Walk.Feedback])
    result = Fibonacci.Result(sequence=[0, 1, 1])
    last = int(result.sequence[-1])
    assert last == 1
    AddTwoInts.Event(request=[AddTwoInts.Request(a=1)])
    Fibonacci.Impl.SendGoalService.Request()


async def goals(node: Node) -> None:
    """An action client knows its messages, and so does the handle that a server's callback gets."""
    client = node.create_action_client(Fibonacci, "fibonacci")
    goal = await client.send_goal(Fibonacci.Goal(order=5))
    async for feedback in goal:
        assert_type(feedback, Fibonacci.Feedback)
    assert_type((await goal.result()).result, Fibonacci.Result)
    assert_type(await client.call(Fibonacci.Goal()), Fibonacci.Result)

    sent = client.send_goal_async(Fibonacci.Goal())
    assert_type((await (await sent).get_result_async()).result, Fibonacci.Result)
    assert_type(await client.wait_for_server(timeout_sec=1.0), bool)

    async def execute(
        handle: ServerGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback],
    ) -> Fibonacci.Result:
        assert_type(handle.request, Fibonacci.Goal)
        handle.publish_feedback(Fibonacci.Feedback())
        handle.succeed()
        return Fibonacci.Result()

    node.create_action_server(
        Fibonacci, "fibonacci", execute, goal_callback=lambda _goal: GoalResponse.ACCEPT
    )


async def types_by_name(node: Node) -> None:
    """A class that is found by its name fits wherever one of its kind is wanted."""
    node.create_client(get_service("std_srvs/srv/Trigger"), "trigger")
    node.create_action_client(get_action("example_interfaces/action/Fibonacci"), "fibonacci")
    node.create_publisher(get_message("std_msgs/msg/String"), "text", 1)
    node.create_service(await node.find_type("std_srvs/srv/Trigger"), "trigger", print)


async def any_service(node: Node, name: str, type_name: str, given: object) -> dict[str, object]:
    """Call any service in twelve lines, as tools for agents, panels and recorders do."""
    service = await node.find_service(type_name)
    text, _ = documentation(service)
    schema: dict[str, object] = json_schema(service.Request)
    schema["description"] = text
    request = from_builtins(service.Request, given)
    assert_type(request, Message)
    client = node.create_client(service, name)
    assert_type(client, Client[Message, Message])
    response = await client.call(request)
    names = [field.name for field in fields(service.Response)]
    return {**to_builtins(response), "names": names, "type": type_name_of(service)}


def type_name_of(service: ServiceClass[Message, Message]) -> str:
    """Return the name of any service."""
    return type_name(service)


async def any_action(node: Node, name: str, type_name: str, given: object) -> Message:
    """The same over any action."""
    action = await node.find_action(type_name)
    json_schema(action.Goal)
    client = node.create_action_client(action, name)
    return await client.call(from_builtins(action.Goal, given))


async def any_topic(node: Node, type_name: str) -> None:
    """The same over any message."""
    message = await node.find_message(type_name)
    node.create_publisher(message, "/anything", 1).publish(message())
    node.create_publisher(message, "/anything", 1).publish(from_json(message, "{}"))


def services_in_a_list(node: Node, action: type[ActionType]) -> None:
    """Types of services and actions are one kind of thing."""
    services: list[type[ServiceType]] = [AddTwoInts, Say]
    for service in services:
        node.create_client(service, "any")
        json_schema(service.Request)
    node.create_action_client(action, "any")
    assert_type(type_name_of(AddTwoInts), str)


def numbers(values: npt.NDArray[np.float64]) -> float:
    """Compute with doubles, as most functions do."""
    return float(values.sum())


def parameters_and_arrays(node: Node) -> None:
    """Declared parameters have a type; arrays of messages go where arrays are wanted."""
    assert_type(node.declare_parameter("speed", 0.5).value, float)
    assert_type(node.declare_parameter("count", 5).value, int)
    assert_type(node.declare_parameter("on", True).value, bool)
    assert_type(node.declare_parameter("name", "x").value, str)
    assert_type(node.declare_parameter("later", Parameter.Type.DOUBLE).value, Any)
    speed: Parameter = node.get_parameter("speed")
    print(speed.value + 1)  # noqa: T201
    numbers(Imu().orientation_covariance)
    numbers(JointState().position)


async def calls(node: Node) -> None:
    """A future knows its response, a wait that it answers yes or no."""
    client = node.create_client(AddTwoInts, "add")
    assert_type(await client.call_async(AddTwoInts.Request()), AddTwoInts.Response)
    assert_type(client.call_async(AddTwoInts.Request()).result(), AddTwoInts.Response)
    while not await client.wait_for_service(timeout_sec=1.0):
        pass
    while not await node.wait_for_node("other", 1.0):
        pass


class Camera(LifecycleNode):
    """Overrides callbacks, one of them as a coroutine function."""

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Start, and enable what is managed."""
        return super().on_activate(state)

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Await something first."""
        await self.get_clock().sleep(0.0)
        return super().on_configure(state)


async def supervised() -> None:
    """A supervisor knows the class of its node."""

    class Robot(Node):
        speed = 0.5

    async with Supervisor(lambda: Robot("robot")) as robot:
        assert_type(robot.node.speed, float)
        assert_type(robot.health(), Health)
        assert_type(await robot.node.ended(), NodeEnd)


def functions() -> None:
    """Functions that describe or copy keep the type."""
    assert_type(snapshot(String(data="hi")), String)
    assert_type(snapshotter(Twist)(Twist()), Twist)
    assert_type(from_json(Twist, to_json(Twist())), Twist)
    assert_type(type_name(AddTwoInts), str)
    assert_type(fields(Words)[0].name, str)
