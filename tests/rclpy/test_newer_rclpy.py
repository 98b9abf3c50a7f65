"""Additions of newer rclpy versions than PyPI's, and what programs do with its parts."""

from __future__ import annotations

import gc
import importlib
import threading
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Any

import pytest

import rclpy
import rclpy.exceptions
import rclpy.experimental
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock_type import ClockType
from rclpy.endpoint_info import EndpointTypeEnum, ServiceEndpointInfo
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.task import Future
from rclpy.time import Time
from tests.support.peers import isolated_environment

PATIENCE_S = 20.0


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> Iterator[rclpy.Context]:
    """An isolated context."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    context = rclpy.Context()
    rclpy.init(args=[], context=context)
    yield context
    rclpy.shutdown(context=context)


@pytest.fixture
def node(context: rclpy.Context) -> Node:
    """A node."""
    return Node("node", context=context)


@pytest.fixture
def wait(context: rclpy.Context, node: Node) -> Callable[[Future[Any]], Any]:
    """Return a function that spins the node until a future is done, and returns its result."""
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def until(future: Future[Any]) -> Any:
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)
        assert future.done()
        return future.result()

    return until


@pytest.mark.parametrize(("end", "status"), [("succeed", 4), ("abort", 6), ("canceled", 5)])
def test_a_goal_takes_its_result_where_it_ends(
    node: Node, wait: Callable[[Future[Any]], Any], end: str, status: int
) -> None:
    """The result counts at once, whatever the callback returns later."""
    result = Fibonacci.Result()
    result.sequence = [1, 2]
    may_end: Future[None] = Future()

    async def execute(goal: Any) -> Any:
        await may_end
        getattr(goal, end)(result)
        return Fibonacci.Result()

    ActionServer(node, Fibonacci, "count", execute, cancel_callback=lambda _: CancelResponse.ACCEPT)
    client: Any = ActionClient(node, Fibonacci, "count")
    accepted = wait(client.send_goal_async(Fibonacci.Goal()))
    if end == "canceled":
        wait(accepted.cancel_goal_async())
    may_end.set_result(None)
    answer = wait(accepted.get_result_async())

    assert (answer.status, list(answer.result.sequence)) == (status, [1, 2])


def test_a_goal_may_be_executed_without_a_callback(
    node: Node, wait: Callable[[Future[Any]], Any]
) -> None:
    """Its own state machine ends it later."""
    goals: list[Any] = []
    ActionServer(node, Fibonacci, "count", lambda _: None, handle_accepted_callback=goals.append)
    client: Any = ActionClient(node, Fibonacci, "count")
    result = wait(client.send_goal_async(Fibonacci.Goal())).get_result_async()

    goals[0].executing()
    goals[0].succeed(Fibonacci.Result())

    assert wait(result).status == 4


def test_a_result_of_another_class_is_refused(
    node: Node, wait: Callable[[Future[Any]], Any]
) -> None:
    """The goal continues: its callback can still end it."""
    problems: list[str] = []

    def execute(goal: Any) -> Any:
        try:
            goal.succeed("done")
        except TypeError as error:
            problems.append(str(error))
        goal.succeed()
        return Fibonacci.Result()

    ActionServer(node, Fibonacci, "count", execute)
    client: Any = ActionClient(node, Fibonacci, "count")

    wait(wait(client.send_goal_async(Fibonacci.Goal())).get_result_async())
    assert problems == ["the result of a goal is a str; use a Result of its action"]


@pytest.mark.parametrize("place", ["instance", "class", "handle"])
def test_a_request_may_be_answered_later_from_anywhere(
    node: Node,
    wait: Callable[[Future[Any]], Any],
    place: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Bridges to asyncio replace `send_response` by their own function."""
    kept: list[tuple[Any, Any]] = []
    service: Any = node.create_service(AddTwoInts, "add", lambda request, response: response)
    send = service.send_response
    if place == "handle":
        handle = service._Service__service

        def send(response: Any, header: Any) -> None:
            handle.service_send_response(response, header.request_id)

    if place == "class":
        monkeypatch.setattr(Service, "send_response", lambda _, *parts: kept.append(parts))
    else:
        service.send_response = lambda *parts: kept.append(parts)
    answer = node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request(a=1, b=2))
    first: Future[None] = Future()

    def look() -> None:
        if kept and not first.done():
            first.set_result(None)

    node.create_timer(0.01, look)
    wait(first)
    ((response, header),) = kept
    response.sum = 3

    worker = threading.Thread(target=send, args=(response, header))
    worker.start()
    worker.join()

    assert wait(answer).sum == 3


@pytest.mark.parametrize(
    "spin",
    [
        lambda executor, _: executor.spin_once(PATIENCE_S),
        lambda executor, seen: executor.spin_once_until_future_complete(seen, PATIENCE_S),
        lambda executor, seen: executor.spin_until_future_complete(seen, PATIENCE_S),
    ],
    ids=["once", "once until", "until"],
)
def test_an_executor_says_whether_it_spins(
    context: rclpy.Context, node: Node, spin: Callable[[Any, Future[bool]], None]
) -> None:
    """Programs use this to decide whether they may wait for a callback."""
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    seen: Future[bool] = Future()

    def look() -> None:
        if not seen.done():
            seen.set_result(executor.is_spinning)

    node.create_timer(0.0, look)

    assert not executor.is_spinning
    spin(executor, seen)

    assert seen.result()
    assert not executor.is_spinning


def test_the_end_of_the_program_ends_the_spin_of_several_threads(
    context: rclpy.Context, node: Node
) -> None:
    """As it ends that of a single thread."""

    def leave() -> None:
        raise SystemExit(7)

    node.create_timer(0.0, leave)
    with MultiThreadedExecutor(2, context=context) as executor:
        executor.add_node(node)
        with pytest.raises(SystemExit) as caught:
            executor.spin()

    assert caught.value.code == 7


@pytest.mark.parametrize("executor_class", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_the_end_of_the_program_is_no_exception_that_nobody_has_retrieved(
    context: rclpy.Context,
    executor_class: type[SingleThreadedExecutor | MultiThreadedExecutor],
    capfd: pytest.CaptureFixture[str],
) -> None:
    """`spin` raises it; rclpy prints nothing more."""

    async def leave() -> None:
        raise SystemExit(7)

    executor = executor_class(context=context)
    with executor:
        task = executor.create_task(leave)
        with pytest.raises(SystemExit):
            executor.spin()
    del task
    gc.collect()

    assert "never retrieved" not in capfd.readouterr().err


def test_a_busy_pool_takes_nothing_that_it_cannot_call(context: rclpy.Context, node: Node) -> None:
    """Nobody could stop queued calls; a late timer runs once."""
    may_end, begun = threading.Event(), threading.Semaphore(0)
    calls: list[int] = []

    def work(number: int) -> None:
        calls.append(number)
        begun.release()
        may_end.wait(PATIENCE_S)

    group = ReentrantCallbackGroup()
    for number in range(4):
        node.create_timer(0.0, lambda number=number: work(number), callback_group=group)
    with MultiThreadedExecutor(2, context=context) as executor:
        executor.add_node(node)
        spinning = threading.Thread(target=executor.spin)
        spinning.start()
        for _ in range(2):
            begun.acquire()
        executor.shutdown(wait_for_threads=False)
        spinning.join(PATIENCE_S)
        may_end.set()

    assert (len(calls), spinning.is_alive()) == (2, False)


def test_time_becomes_a_local_time() -> None:
    """As in Lyrical: without time zone, and not for a clock with an arbitrary start."""
    moment = datetime(2026, 5, 23, 12, 30, 0, 250000)  # noqa: DTZ001  # as rclpy returns it
    time = Time(nanoseconds=round(moment.timestamp() * 1e9), clock_type=ClockType.SYSTEM_TIME)

    assert time.to_datetime() == moment
    with pytest.raises(TypeError, match="should be either ROS_TIME or SYSTEM_TIME"):
        Time(clock_type=ClockType.STEADY_TIME).to_datetime()


def test_the_clients_and_servers_of_a_service_are_told(node: Node) -> None:
    """As in Lyrical on rmw_zenoh, where each of them is one endpoint."""
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    node.create_client(AddTwoInts, "add")

    (server,) = node.get_servers_info_by_service("add")
    (client,) = node.get_clients_info_by_service("/add", no_mangle=True)

    assert (server.endpoint_type, client.endpoint_type) == (
        EndpointTypeEnum.SERVER,
        EndpointTypeEnum.CLIENT,
    )
    assert server.service_type == "example_interfaces/srv/AddTwoInts"
    assert server.endpoint_count == len(server.endpoint_gids) == len(server.qos_profiles) == 1
    assert "Endpoint type: SERVER\nEndpoint count: 1\nGID: " in str(server)
    assert node.get_publishers_info_by_topic("add") == []


def test_a_service_of_two_endpoints_is_shown_as_lyrical_shows_it() -> None:
    """As reported by middlewares on DDS."""
    info = ServiceEndpointInfo(
        endpoint_type=EndpointTypeEnum.CLIENT,
        endpoint_count=2,
        endpoint_gids=[[1, 2], [3]],
        qos_profiles=[QoSProfile(depth=1), QoSProfile(depth=2)],
    )

    text = str(info)

    assert "GIDs:\n - Request Writer : 03\n - Response Reader : 01.02\nQoS profiles:\n" in text
    assert "History (Depth): KEEP_LAST (2)" in text.partition(" - Response Reader :\n")[0]


def test_parameter_events_can_be_those_of_some_nodes(node: Node) -> None:
    """By a filter of the subscription, until it is removed."""
    handler = ParameterEventHandler(node)

    assert handler.configure_nodes_filter(["/one", "/two"])
    filtered = handler.parameter_event_subscription.get_content_filter()
    assert filtered.filter_expression == "node = %0 OR node = %1"
    assert filtered.expression_parameters == ["'/one'", "'/two'"]
    assert handler.configure_nodes_filter()
    assert not handler.parameter_event_subscription.is_cft_enabled


def test_the_arguments_of_lyrical_are_taken(node: Node) -> None:
    """They choose how messages travel, and none is lost without them."""
    subscription = node.create_subscription(
        Fibonacci.Impl.FeedbackMessage, "a", print, 1, acceptable_buffer_backends="any"
    )
    client: Any = ActionClient(node, Fibonacci, "b", enable_feedback_msg_optimization=True)

    assert subscription.topic_name == "/a"
    assert client.server_is_ready() is False


def test_the_modules_and_bases_of_lyrical_can_be_imported(node: Node) -> None:
    """For annotations, and for programs that check what a node is."""
    for kind in ("client", "clock", "node", "publisher", "service", "subscription", "timer"):
        base = getattr(importlib.import_module(f"rclpy.{kind}"), f"Base{kind.title()}")
        name = f"Async{kind.title()}"
        own = getattr(importlib.import_module(f"rclpy.experimental.async_{kind}"), name)

        assert issubclass(own, base)
        assert getattr(rclpy.experimental, name) is own
    assert isinstance(node, rclpy.node.BaseNode)
    assert issubclass(rclpy.exceptions.TimeSourceChangedError, Exception)
