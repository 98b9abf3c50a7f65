"""Tests of the life of a node: what it starts, what it ends, and what it raises."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.errors import EntityDestroyedError, NodeNameNonExistentError, ServiceError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.testing import local_context, settle
from tests.support.living import living

if TYPE_CHECKING:
    from collections.abc import Callable


def failing(msg: String) -> None:
    """Raise an error with the received message."""
    raise ValueError(f"cannot use {msg.data}")


# Lifetime


async def test_run_returns_after_destroy_node(context: Context) -> None:
    """A program's main coroutine ends when its node is destroyed."""
    node = Node("node", context=context)
    asyncio.get_running_loop().call_soon(node.destroy_node)

    await node.run()

    assert node.destroyed


async def test_a_callback_may_destroy_its_own_node(context: Context) -> None:
    """A node often knows in a callback that its work is done."""
    node = Node("node", context=context)
    heard: list[str] = []

    async def last_words(msg: String) -> None:
        heard.append(msg.data)
        node.destroy_node()

    node.create_subscription(String, "bye", last_words)
    node.create_publisher(String, "bye", 10).publish(String(data="now"))

    await node.run()

    assert heard == ["now"]


async def test_no_callback_is_called_after_a_sync_one_destroyed_the_node(context: Context) -> None:
    """Queued messages are not delivered to a destroyed node."""
    node = Node("node", context=context)
    heard: list[str] = []

    def first(msg: String) -> None:
        heard.append(msg.data)
        node.destroy_node()

    node.create_subscription(String, "words", first)
    publisher = node.create_publisher(String, "words", 10)
    for text in "abc":
        publisher.publish(String(data=text))

    await node.run()

    assert heard == ["a"]


async def test_entities_made_before_the_node_runs_work_once_it_does(context: Context) -> None:
    """A constructor creates them, possibly long before the loop runs."""
    node = Node("node", context=context)
    heard: list[str] = []
    node.create_subscription(String, "words", lambda msg: heard.append(msg.data))
    publisher = node.create_publisher(String, "words", 10)
    publisher.publish(String(data="early"))
    await settle()
    assert heard == []

    async with node:
        await settle()

    assert heard == ["early"]


def test_nodes_and_entities_can_be_made_without_a_loop() -> None:
    """They can be module-level objects, or be created by a synchronous constructor."""
    context = local_context()
    node = Node("node", context=context)
    node.create_publisher(String, "words", 10)
    node.create_subscription(String, "words", print)
    node.create_client(AddTwoInts, "add")
    node.create_timer(1.0, lambda: None)
    assert node.count_publishers("words") == 1
    node.destroy_node()


def test_a_context_serves_one_loop_after_the_other() -> None:
    """Nodes of the default context may run in several calls of asyncio.run."""
    context = local_context()
    heard: list[str] = []

    async def once(name: str) -> None:
        async with Node(name, context=context) as node:
            node.create_subscription(String, "words", lambda msg: heard.append(msg.data))
            node.create_publisher(String, "words", 10).publish(String(data=name))
            await settle()

    asyncio.run(once("first"))
    asyncio.run(once("second"))

    assert heard == ["first", "second"]


async def test_a_node_that_runs_cannot_be_run_again(node: Node) -> None:
    """Both owners would end it."""
    await settle()
    with pytest.raises(RuntimeError, match="/node is already running"):
        await node.run()


async def test_a_destroyed_node_cannot_run(context: Context) -> None:
    """It has no entities any more."""
    node = Node("node", context=context)
    node.destroy_node()
    with pytest.raises(EntityDestroyedError, match="cannot run: node /node is destroyed"):
        await node.run()


async def test_destroying_twice_is_allowed(node: Node) -> None:
    """Cleanup code need not know what was already cleaned up."""
    publisher = node.create_publisher(String, "words", 10)
    publisher.destroy()
    publisher.destroy()
    node.destroy_node()
    node.destroy_node()


@pytest.mark.parametrize(
    "create",
    [
        lambda node: node.create_publisher(String, "t", 10),
        lambda node: node.create_subscription(String, "t", print),
        lambda node: node.create_service(AddTwoInts, "s", lambda request: request),
        lambda node: node.create_client(AddTwoInts, "s"),
        lambda node: node.create_timer(1.0, lambda: None),
        lambda node: node.create_rate(1.0),
    ],
)
def test_a_destroyed_node_refuses_new_entities(create: Callable[[Node], object]) -> None:
    """The mistake is reported where it is made, not when nothing ever arrives."""
    node = Node("node", context=local_context())
    node.destroy_node()
    with pytest.raises(RuntimeError, match=r"cannot create [a-z]+: node /node is destroyed"):
        create(node)


async def test_leaving_a_node_cancels_callbacks_and_waits_for_them(context: Context) -> None:
    """Nothing of a node runs after its block."""
    events: list[str] = []

    async def slow(_: String) -> None:
        events.append("began")
        try:
            await asyncio.Event().wait()
        finally:
            await checkpoint()
            events.append("cleaned up")

    async with Node("node", context=context) as node:
        node.create_subscription(String, "words", slow)
        node.create_publisher(String, "words", 10).publish(String())
        await settle()

    assert events == ["began", "cleaned up"]


async def test_cancelling_run_destroys_the_node(context: Context) -> None:
    """A task that runs a node is stopped like any other task."""
    node = Node("node", context=context)
    task = asyncio.get_running_loop().create_task(node.run())
    await settle()

    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task

    assert node.destroyed


async def test_the_clock_of_a_destroyed_node_is_destroyed(node: Node) -> None:
    """Pending sleeps on it end."""
    clock = node.get_clock()
    node.destroy_node()
    await settle()  # callbacks that clean up may sleep
    with pytest.raises(RuntimeError):
        await clock.sleep(1.0)


# Errors


@pytest.mark.parametrize("concurrent", [False, True, 2])
async def test_an_exception_of_a_callback_ends_the_node(
    context: Context, *, concurrent: bool | int
) -> None:
    """It is raised as from a TaskGroup, however callbacks are run."""
    node = Node("node", context=context)
    node.create_subscription(String, "words", failing, concurrent=concurrent)
    node.create_publisher(String, "words", 10).publish(String(data="x"))

    with pytest.raises(ExceptionGroup) as caught:
        await node.run()

    assert caught.group_contains(ValueError, match="cannot use x")


async def test_an_exception_of_the_body_comes_out_as_it_is(context: Context) -> None:
    """So ``except LookupError`` around the node catches it; the node is destroyed."""
    node = Node("node", context=context)

    with pytest.raises(LookupError, match="body"):
        async with node:
            raise LookupError("body")

    assert node.destroyed
    assert not node.is_running


async def test_an_error_of_a_service_can_be_caught_around_the_node(context: Context) -> None:
    """As in the README, a function creates a node, calls, and returns the answer."""

    def fail(_request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise ValueError("cannot add")

    async def add() -> AddTwoInts.Response:
        async with Node("asking", context=context) as node:
            return await node.create_client(AddTwoInts, "add").call(AddTwoInts.Request())

    async with Node("serving", context=context) as serving:
        serving.create_service(AddTwoInts, "add", fail, on_error="log")
        with pytest.raises(ServiceError, match="cannot add"):
            await add()


async def test_exceptions_of_body_and_callback_come_in_one_group(context: Context) -> None:
    """None of them may hide the other."""
    node = Node("node", context=context)
    node.create_subscription(String, "words", failing)
    node.create_publisher(String, "words", 10).publish(String(data="x"))

    async def body() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            raise LookupError("body")

    with pytest.raises(ExceptionGroup) as caught:
        async with node:
            await body()

    assert caught.group_contains(LookupError, match="body")
    assert caught.group_contains(ValueError, match="cannot use x")


async def test_a_group_that_the_body_raised_comes_out_as_it_is(context: Context) -> None:
    """A TaskGroup inside the node raises one, for example."""
    group = ExceptionGroup("own", [LookupError("body")])

    with pytest.raises(ExceptionGroup) as caught:
        async with Node("node", context=context):
            raise group

    assert caught.value is group


async def test_a_failing_callback_interrupts_the_body(context: Context) -> None:
    """The body may be waiting for something that can never come now."""
    node = Node("node", context=context)
    node.create_subscription(String, "words", failing)
    node.create_publisher(String, "words", 10).publish(String(data="x"))
    with pytest.raises(ExceptionGroup) as caught:
        async with node:
            await asyncio.Event().wait()

    assert caught.group_contains(ValueError)


async def test_a_failing_node_leaves_others_alone(context: Context) -> None:
    """Each node of a context fails by itself."""
    async with Node("healthy", context=context) as healthy:
        node = Node("node", context=context)
        node.create_timer(0.0, lambda: 1 / 0)
        with pytest.raises(ExceptionGroup):
            await node.run()
        assert not healthy.destroyed
        assert healthy.get_node_names() == ["healthy"]


# Context


async def test_shutting_a_context_down_ends_its_nodes() -> None:
    """One call ends a whole program."""
    context = local_context()
    node = Node("node", context=context)
    asyncio.get_running_loop().call_soon(context.shutdown)

    await node.run()

    assert not context.ok()
    with pytest.raises(EntityDestroyedError, match="context"):
        Node("other", context=context)


async def test_leaving_a_context_waits_for_its_nodes() -> None:
    """A node that runs in its own task has ended when the context is left."""
    async with local_context() as context:
        node = Node("node", context=context)
        task = asyncio.get_running_loop().create_task(node.run())
        await settle()
    assert not node.is_running
    await task


def test_the_default_context_is_made_anew_after_shutdown(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program may start over, as after rclpy.shutdown and rclpy.init."""
    monkeypatch.setattr(Context, "_default", local_context())
    first = Context.default()
    assert Context.default() is first
    first.shutdown()
    assert Context.default() is not first


def test_an_unknown_transport_is_refused() -> None:
    """The error lists the valid ones."""
    words = 'transport=\'dds\' is unknown; use "zenoh", "rcl" or "local"'
    with pytest.raises(ValueError, match=words):
        Context(transport="dds")


# Names and graph


async def test_a_node_knows_its_names(context: Context) -> None:
    """The methods are rclpy's."""
    node = Node("arm", namespace="/robot1", context=context)
    assert node.get_name() == "arm"
    assert node.get_namespace() == "/robot1"
    assert node.get_fully_qualified_name() == "/robot1/arm"
    assert node.get_logger().name == "robot1.arm"
    assert node.resolve_topic_name("~/joint") == "/robot1/arm/joint"
    assert node.resolve_service_name("move") == "/robot1/move"


async def test_hidden_names_can_be_left_out(context: Context) -> None:
    """Names of actions and tools are hidden; `ros2 topic list` omits them, too."""
    async with Node("arm", context=context) as node:
        node.create_publisher(String, "/words", 10)
        node.create_publisher(String, "/_words", 10)
        node.create_service(AddTwoInts, "/arm/_add", lambda request: request)

        topics = dict(node.get_topic_names_and_types(include_hidden=False))
        services = dict(node.get_service_names_and_types(include_hidden=False))

        assert "/words" in topics
        assert "/_words" not in topics
        assert "/arm/get_parameters" in services
        assert "/arm/_add" not in services
        assert "/_words" in dict(node.get_topic_names_and_types())
        assert "/arm/_add" in dict(node.get_service_names_and_types())


async def test_the_graph_shows_nodes_topics_and_services(context: Context) -> None:
    """`aionode node list` and `topic list` are made from it."""
    async with Node("arm", namespace="/robot1", context=context) as node:
        node.create_publisher(String, "/words", 10)
        node.create_subscription(String, "/words", print)
        node.create_service(AddTwoInts, "/add", lambda request: request)

        assert node.get_node_names_and_namespaces_with_enclaves() == [("arm", "/robot1", "/")]
        assert ("/words", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
        services = node.get_service_names_and_types_by_node("arm", "/robot1")
        assert ("/add", ["example_interfaces/srv/AddTwoInts"]) in services
        assert (node.count_publishers("/words"), node.count_subscribers("/words")) == (1, 1)
        assert (node.count_services("/add"), node.count_clients("/add")) == (1, 0)
        (info,) = node.get_publishers_info_by_topic("/words")
        assert (info.node_name, info.topic_type) == ("arm", "std_msgs/msg/String")
        assert info.topic_type_hash.startswith("RIHS01_")
        assert len(info.endpoint_gid) == 16


async def test_a_service_with_clients_only_is_among_the_services(context: Context) -> None:
    """ROS 2 does the same on each middleware; `count_services` returns the number of servers."""
    async with Node("arm", context=context) as node:
        node.create_client(AddTwoInts, "/add")

        types = dict(node.get_service_names_and_types())
        assert types["/add"] == ["example_interfaces/srv/AddTwoInts"]
        assert (node.count_services("/add"), node.count_clients("/add")) == (0, 1)


async def test_asking_about_an_unknown_node_is_an_error(node: Node) -> None:
    """An empty list would mean that the node exists and does nothing."""
    with pytest.raises(NodeNameNonExistentError, match="/ghost: no such node"):
        node.get_publisher_names_and_types_by_node("ghost", "/")


async def test_wait_for_node_returns_when_the_node_appears(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """The graph wakes it; it does not poll."""
    async with asyncio.TaskGroup() as tasks:
        waiting = tasks.create_task(node.wait_for_node("late"))
        await settle()
        assert not waiting.done()
        node_factory("late")


async def test_the_graph_can_be_watched(node: Node) -> None:
    """`changed` is done at the next change of any kind."""
    change = node.graph.changed()
    assert not change.done()
    node.create_publisher(Int32, "numbers", 10)
    await change


async def test_what_is_destroyed_leaves_the_graph(node: Node) -> None:
    """Within one process it does so at once."""
    publisher = node.create_publisher(String, "/words", 10)
    publisher.destroy()
    assert node.count_publishers("/words") == 0
    assert publisher not in node.publishers


@pytest.mark.slow
async def test_cancelled_waits_leave_nothing_in_the_graph(node: Node) -> None:
    """A program that waits with timeouts for days must not grow."""
    await settle()
    futures = living(asyncio.Future)
    for _ in range(100):
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0):
                await node.graph.changed()
    await settle()
    assert living(asyncio.Future) < futures + 10


@pytest.mark.processes
@pytest.mark.parametrize(
    ("module", "loaded"), [("std_msgs.msg.String", False), ("sensor_msgs.msg.JointState", True)]
)
def test_numpy_is_there_before_a_callback_needs_it(module: str, *, loaded: bool) -> None:
    """Importing it within a callback would block the loop; a node without arrays does without."""
    package, _, name = module.rpartition(".")
    program = (
        "import sys\n"
        f"from aionode.interfaces.{package} import {name}\n"
        "from aionode.node import Node\n"
        "from aionode.testing import local_context\n"
        "node = Node('node', context=local_context())\n"
        "assert 'numpy' not in sys.modules\n"
        f"node.create_publisher({name}, 'topic', 10)\n"
        f"assert ('numpy' in sys.modules) is {loaded}\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)  # the text is here


def test_a_node_whose_own_constructor_fails_leaves_its_context() -> None:
    """A supervisor creates the next one: failed ones must not accumulate in the graph."""

    class Robot(Node):
        def __init__(self, context: Context) -> None:
            super().__init__("robot", context=context)
            self.create_publisher(String, "/chatter", 10)
            raise OSError("no motor")

    context = local_context()

    with pytest.raises(OSError, match="no motor"):
        Robot(context)

    assert context.graph.nodes() == []
    assert context.graph.endpoints() == []
    assert repr(context).endswith("nodes=0>")


async def test_a_callback_group_as_third_argument_of_create_timer_is_reported(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """There rclpy has its callback group, and aionode its clock."""

    class MutuallyExclusiveCallbackGroup:
        def can_execute(self, entity: object) -> bool:
            return True

    for _ in range(2):
        timer = node.create_timer(1.0, lambda: None, MutuallyExclusiveCallbackGroup())  # type: ignore[arg-type]

    assert timer.clock is node.get_clock()
    (record,) = [one for one in caplog.records if one.levelname == "WARNING"]
    text = record.getMessage()
    assert "the third argument is a MutuallyExclusiveCallbackGroup, which has no effect" in text


def test_a_clock_that_is_none_is_refused() -> None:
    """The error says what to pass instead."""
    node = Node("node", context=local_context())

    with pytest.raises(TypeError, match=r"create_timer: clock is 'steady'; give a clock such as"):
        node.create_timer(1.0, lambda: None, "steady")  # type: ignore[arg-type]
