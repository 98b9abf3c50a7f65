"""Actions of rclpy's API, servers and clients in one context."""

from __future__ import annotations

import gc
import threading
import weakref
from collections.abc import Callable, Iterator
from typing import Any, get_origin
from unittest.mock import Mock

import pytest

import rclpy
from aionode.action import GoalStatus
from aionode.engine.rules import status_pace as _status_pace
from aionode.engine.rules.goal_store import GoalStore
from aionode.interfaces.example_interfaces.action import Fibonacci as OwnFibonacci
from aionode.interfaces.tf2_msgs.action import LookupTransform as OwnLookupTransform
from rclpy._impl.errors import RCLError
from rclpy.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.action.client import ClientGoalHandle
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_services_default
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.task import Future
from rosidl_generator_py import action_class
from tests.support.peers import DOMAIN_ID, isolated_environment

Fibonacci = action_class("example_interfaces/action/Fibonacci")
LookupTransform = action_class("tf2_msgs/action/LookupTransform")
BOTH = ["rosidl", "aionode"]
Goal = ServerGoalHandle[Any, Any, Any]

PATIENCE_S = 20.0


@pytest.fixture
def small_queues(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limit what waits in contexts created from now on."""
    monkeypatch.setenv("AIONODE_QUEUE_BYTES", "65536")


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> Iterator[rclpy.Context]:
    """A context isolated from everything else on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    context = rclpy.Context()
    rclpy.init(args=[], context=context, domain_id=DOMAIN_ID)
    yield context
    rclpy.shutdown(context=context)


@pytest.fixture
def node(context: rclpy.Context) -> Node:
    """A node."""
    return Node("node", context=context)


@pytest.fixture
def executor(context: rclpy.Context, node: Node) -> SingleThreadedExecutor:
    """An executor that spins it when a test says so."""
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    return executor


@pytest.fixture
def result_of(executor: SingleThreadedExecutor) -> Callable[[Future[Any]], Any]:
    """Return a function that spins until a future is done, and returns its result."""

    def wait(future: Future[Any]) -> Any:
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)
        assert future.done()
        return future.result()

    return wait


class Server:
    """An action server whose goals the test ends."""

    def __init__(self, node: Node, action_type: Any = Fibonacci, **options: Any) -> None:
        self.action_type = action_type
        self.begun: list[Goal] = []
        self.may_end: Future[Any] = Future()
        options = {"cancel_callback": lambda _: CancelResponse.ACCEPT, **options}
        self.server: ActionServer[Any, Any, Any] = ActionServer(
            node, action_type, "fibonacci", self.execute, **options
        )

    async def execute(self, goal: Goal) -> Any:
        """Wait until the test lets goals end; those to be cancelled are."""
        self.begun.append(goal)
        await self.may_end
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.succeed()
        return self.action_type.Result(sequence=[goal.request.order])


def client_of(node: Node, action_type: Any = Fibonacci) -> ActionClient[Any, Any, Any]:
    """Return a client whose server exists."""
    client: ActionClient[Any, Any, Any] = ActionClient(node, action_type, "fibonacci")
    assert client.wait_for_server(PATIENCE_S)
    return client


@pytest.mark.parametrize("action_type", [Fibonacci, OwnFibonacci], ids=["rosidl", "aionode"])
def test_a_goal_of_either_message_family_succeeds(
    node: Node, result_of: Callable[..., Any], action_type: Any
) -> None:
    """A program that is moved to aionode may use both kinds of classes."""
    server = Server(node, action_type)
    client = client_of(node, action_type)
    handle = result_of(client.send_goal_async(action_type.Goal(order=7)))
    server.may_end.set_result(None)

    response = result_of(handle.get_result_async())

    assert (response.status, list(response.result.sequence)) == (GoalStatus.SUCCEEDED, [7])


@pytest.mark.parametrize("action_type", [Fibonacci, OwnFibonacci], ids=["rosidl", "aionode"])
def test_a_goal_of_either_message_family_is_cancelled(
    node: Node, result_of: Callable[..., Any], action_type: Any
) -> None:
    """The answer lists the goal as the type's own messages."""
    server = Server(node, action_type)
    client = client_of(node, action_type)
    handle = result_of(client.send_goal_async(action_type.Goal(order=7)))

    response = result_of(handle.cancel_goal_async())
    server.may_end.set_result(None)

    assert [info.goal_id for info in response.goals_canceling] == [handle.goal_id]
    assert result_of(handle.get_result_async()).status == GoalStatus.CANCELED


def test_every_goal_of_a_cancel_request_is_decided_about(
    node: Node, result_of: Callable[..., Any]
) -> None:
    """A request without an id selects all goals; rejected ones are left out of the answer."""
    asked: list[int] = []

    def refuse(goal: Goal) -> CancelResponse:
        asked.append(goal.request.order)
        return CancelResponse.REJECT

    Server(node, cancel_callback=refuse)
    client = client_of(node)
    for order in range(3):
        result_of(client.send_goal_async(Fibonacci.Goal(order=order)))
    service = Fibonacci.Impl.CancelGoalService
    plain = node.create_client(service, "fibonacci/_action/cancel_goal")
    assert plain.wait_for_service(PATIENCE_S)

    response = result_of(plain.call_async(service.Request()))

    assert asked == [0, 1, 2]
    assert response.goals_canceling == []


def test_a_goal_that_has_ended_cannot_be_cancelled(
    node: Node, result_of: Callable[..., Any]
) -> None:
    """The code says so, as in rcl_action."""
    server = Server(node)
    handle = result_of(client_of(node).send_goal_async(Fibonacci.Goal(order=1)))
    server.may_end.set_result(None)
    result_of(handle.get_result_async())

    response = result_of(handle.cancel_goal_async())

    assert response.return_code == response.ERROR_GOAL_TERMINATED


def test_a_goal_cannot_end_twice(node: Node, result_of: Callable[..., Any]) -> None:
    """A state that cannot follow is an error in the program."""
    server = Server(node)
    handle = result_of(client_of(node).send_goal_async(Fibonacci.Goal(order=1)))
    server.may_end.set_result(None)
    result_of(handle.get_result_async())

    with pytest.raises(RCLError, match="Failed to update goal state"):
        server.begun[0].abort()


def test_results_are_forgotten_after_their_time(node: Node, result_of: Callable[..., Any]) -> None:
    """Later requests are answered as for an unknown goal."""
    server = Server(node, result_timeout=0.01)
    handle = result_of(client_of(node).send_goal_async(Fibonacci.Goal(order=1)))
    server.may_end.set_result(None)
    statuses = iter(lambda: result_of(handle.get_result_async()).status, GoalStatus.UNKNOWN)

    assert set(statuses) <= {GoalStatus.SUCCEEDED}


def test_a_goal_may_end_in_a_thread_while_others_are_forgotten(
    node: Node, result_of: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ended goals are listed and forgotten in one step, for each thread."""
    server = Server(node)
    client = client_of(node)
    result_of(client.send_goal_async(Fibonacci.Goal(order=1)))
    result_of(client.send_goal_async(Fibonacci.Goal(order=2)))
    expire = GoalStore.expire
    has_ended: list[bool] = []

    def expire_while_another_ends(goals: GoalStore) -> list[Any]:
        if not has_ended:
            ending.start()
            ending.join(0.2)
            has_ended.append(not ending.is_alive())
        return expire(goals)

    ending = threading.Thread(target=server.begun[0].succeed)
    monkeypatch.setattr(GoalStore, "expire", expire_while_another_ends)
    result_of(client.send_goal_async(Fibonacci.Goal(order=3)))
    ending.join(PATIENCE_S)

    assert has_ended == [False]
    assert server.begun[0].status == GoalStatus.SUCCEEDED


def test_a_callback_may_destroy_its_server_while_a_result_is_due(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """`spin` continues: the server's goals are already forgotten."""

    def decide(goal: Any) -> GoalResponse:
        if server.begun:
            server.begun[0].succeed()
            server.server.destroy()
            destroyed.set_result(None)
        return GoalResponse.REJECT if server.begun else GoalResponse.ACCEPT

    destroyed: Future[None] = Future()
    server = Server(node, goal_callback=decide, result_timeout=0)
    client = client_of(node)
    result_of(client.send_goal_async(Fibonacci.Goal(order=1)))
    client.send_goal_async(Fibonacci.Goal(order=2))

    result_of(destroyed)
    executor.spin_once(timeout_sec=0.0)  # errors of callbacks are raised here

    assert not server.begun[0].is_active


def test_a_client_that_waits_gets_a_result_that_is_not_kept(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """A goal may expire after `succeed` and before its callback returns."""
    may_return: Future[Any] = Future()

    async def execute(goal: Goal) -> Any:
        goal.succeed()
        await may_return
        return Fibonacci.Result(sequence=[3])

    server: ActionServer[Any, Any, Any] = ActionServer(
        node, Fibonacci, "fibonacci", execute, result_timeout=0.05
    )
    client = client_of(node)
    handle = result_of(client.send_goal_async(Fibonacci.Goal(order=1)))
    result = handle.get_result_async()
    while server._goal_handles:
        executor.spin_once(timeout_sec=PATIENCE_S)
    may_return.set_result(None)

    assert list(result_of(result).result.sequence) == [3]


def test_nothing_is_kept_of_requests_whose_callback_fails(
    node: Node, executor: SingleThreadedExecutor
) -> None:
    """The exception leaves spin, as in rclpy, and the server does not grow."""

    def fail(_: Any) -> GoalResponse:
        raise LookupError("on purpose")

    server = Server(node, goal_callback=fail)
    future = client_of(node).send_goal_async(Fibonacci.Goal(order=1))

    with pytest.raises(LookupError, match="on purpose"):
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)

    assert server.server._handle.goal._taken == {}


def test_the_feedback_callback_of_a_rejected_goal_is_forgotten(
    node: Node, result_of: Callable[..., Any]
) -> None:
    """A client that is repeatedly rejected does not grow."""
    Server(node, goal_callback=lambda _: GoalResponse.REJECT)
    client = client_of(node)

    callback = Mock()
    known = weakref.ref(callback)

    handle = result_of(client.send_goal_async(Fibonacci.Goal(order=1), feedback_callback=callback))

    assert not handle.accepted
    del callback
    gc.collect()
    assert known() is None


def test_a_client_knows_the_state_of_its_goals(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """The server publishes it at each change."""
    server = Server(node)
    handle = result_of(client_of(node).send_goal_async(Fibonacci.Goal(order=1)))
    while handle.status != GoalStatus.EXECUTING:
        executor.spin_once(timeout_sec=PATIENCE_S)
    server.may_end.set_result(None)
    while handle.status != GoalStatus.SUCCEEDED:
        executor.spin_once(timeout_sec=PATIENCE_S)


class States:
    """Counts the status messages of goals, and keeps the last one."""

    def __init__(self, node: Node) -> None:
        self.count = 0
        self.last: list[Any] = []
        status_type = Fibonacci.Impl.GoalStatusMessage
        node.create_subscription(status_type, "fibonacci/_action/status", self.take, 10_000)

    def take(self, message: Any) -> None:
        """Take one."""
        self.count += 1
        self.last = [each.status for each in message.status_list]


def test_goals_beyond_the_limit_are_rejected_before_the_program_is_asked(
    node: Node, result_of: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Clients that send goals which never end do not take unlimited memory."""
    asked: list[Any] = []

    def decide(goal: Any) -> GoalResponse:
        asked.append(goal)
        return GoalResponse.ACCEPT

    Server(node, goal_callback=decide, max_goals=3)
    client = client_of(node)

    answers = [result_of(client.send_goal_async(Fibonacci.Goal(order=1))) for _ in range(5)]

    assert [answer.accepted for answer in answers] == [True] * 3 + [False] * 2
    assert len(asked) == 3
    (line,) = [each for each in caplog.records if "rejected" in each.message]
    assert "as 3 are active: max_goals=3" in line.message


@pytest.mark.usefixtures("small_queues")
@pytest.mark.parametrize("action_type", [LookupTransform, OwnLookupTransform], ids=BOTH)
def test_goals_that_are_too_large_together_are_rejected(
    node: Node,
    result_of: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
    action_type: Any,
) -> None:
    """A thousand active goals of some megabytes each would fill the memory."""
    Server(node, action_type)
    client = client_of(node, action_type)
    goal = action_type.Goal(target_frame="x" * 40_000)

    answers = [result_of(client.send_goal_async(goal)) for _ in range(2)]

    assert [answer.accepted for answer in answers] == [True, False]
    assert "AIONODE_QUEUE_BYTES" in caplog.text


def test_of_too_many_results_the_oldest_is_forgotten(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """The number of results is bounded, however long their timeout is."""
    server = Server(node, max_goals=2, result_timeout=-1)
    server.may_end.set_result(None)
    client = client_of(node)
    handles = []
    for order in (1, 2, 3):
        handles.append(result_of(client.send_goal_async(Fibonacci.Goal(order=order))))
        result_of(handles[-1].get_result_async())
    executor.spin_once(timeout_sec=0.0)  # the server learns what was forgotten

    kept = [result_of(handle.get_result_async()).status for handle in handles]

    assert kept == [GoalStatus.UNKNOWN, GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED]
    assert len(server.server._goal_handles) == len(server.server._futures) == 2


def test_the_states_of_many_goals_are_published_less_often_than_they_change(
    node: Node,
    executor: SingleThreadedExecutor,
    result_of: Callable[..., Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each message lists all goals; the last one is sent at the latest when the server ends."""
    monkeypatch.setattr(_status_pace, "SPACING_S", 1000.0)
    states = States(node)
    server = Server(node)
    client = client_of(node)
    for _ in range(_status_pace.UNSPACED + 10):
        result_of(client.send_goal_async(Fibonacci.Goal(order=1)))
    while len(states.last) <= _status_pace.UNSPACED:
        executor.spin_once(timeout_sec=PATIENCE_S)
    sent = states.count
    server.may_end.set_result(None)
    while any(each.is_active for each in server.begun) or len(server.begun) < 20:
        executor.spin_once(timeout_sec=0.1)
    assert states.count == sent

    server.server.destroy()
    while states.last != [GoalStatus.SUCCEEDED] * 20:
        executor.spin_once(timeout_sec=PATIENCE_S)
    assert states.count == sent + 1


def test_the_states_of_many_goals_are_published_after_a_while(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """The last message that clients get is current, although not every change was sent."""
    states = States(node)
    server = Server(node)
    client = client_of(node)
    for _ in range(_status_pace.UNSPACED + 10):
        result_of(client.send_goal_async(Fibonacci.Goal(order=1)))

    server.may_end.set_result(None)

    while states.last != [GoalStatus.SUCCEEDED] * 20:
        executor.spin_once(timeout_sec=PATIENCE_S)


def test_the_classes_can_be_given_types() -> None:
    """Programs annotate their callbacks this way; otherwise a module could not be imported."""
    for cls in (ServerGoalHandle, ClientGoalHandle, ActionServer, ActionClient):
        assert get_origin(cls[Any, Any, Any]) is cls


def test_an_invalid_name_is_refused(node: Node) -> None:
    """As a ValueError, which rclpy raises, too."""
    with pytest.raises(ValueError, match="nvalid topic name"):
        ActionServer(node, Fibonacci, "no such name", print)
    with pytest.raises(ValueError, match="nvalid topic name"):
        ActionClient(node, Fibonacci, "no such name")


def test_the_graph_has_actions(node: Node) -> None:
    """By their names, and by the nodes that serve and use them."""
    Server(node)
    client_of(node)
    expected = [("/fibonacci", ["example_interfaces/action/Fibonacci"])]

    assert get_action_names_and_types(node) == expected
    assert get_action_server_names_and_types_by_node(node, "node", "/") == expected
    assert get_action_client_names_and_types_by_node(node, "node", "/") == expected


def test_the_services_of_an_action_can_be_watched(
    node: Node, executor: SingleThreadedExecutor, result_of: Callable[..., Any]
) -> None:
    """Each service has a topic for that, on either side."""
    server = Server(node)
    client = client_of(node)
    clock = Clock(clock_type=ClockType.SYSTEM_TIME)
    for side in (server.server, client):
        side.configure_introspection(
            clock, qos_profile_services_default, ServiceIntrospectionState.METADATA
        )
    events: list[int] = []
    node.create_subscription(
        Fibonacci.Impl.SendGoalService.Event,
        "fibonacci/_action/send_goal/_service_event",
        lambda event: events.append(event.info.event_type),
        10,
    )

    result_of(client.send_goal_async(Fibonacci.Goal(order=1)))
    while len(events) < 4:
        executor.spin_once(timeout_sec=PATIENCE_S)

    assert sorted(events) == [0, 1, 2, 3]


def test_a_destroyed_server_is_not_found(node: Node) -> None:
    """Its node continues without it."""
    server = Server(node)
    client = client_of(node)

    server.server.destroy()

    assert list(node.waitables) == [client]
    assert not client.wait_for_server(0.0)


def test_a_blocked_thread_is_told_of_the_shutdown(context: rclpy.Context, node: Node) -> None:
    """It would wait forever: nothing arrives any more."""
    ActionServer(node, Fibonacci, "fibonacci", lambda _: Fibonacci.Result())
    client: Any = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(PATIENCE_S)
    raised: list[RCLError] = []
    is_sent = threading.Event()
    send = client.send_goal_async

    def send_and_note(*args: Any) -> Any:
        is_sent.set()
        return send(*args)

    client.send_goal_async = send_and_note

    def work() -> None:
        try:
            client.send_goal(Fibonacci.Goal())  # nobody spins
        except RCLError as error:
            raised.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    assert is_sent.wait(PATIENCE_S)
    assert context.handle is not None
    context.handle.interrupt()
    thread.join(PATIENCE_S)

    assert [str(error) for error in raised] == ["no answer of fibonacci: the context is shut down"]


def test_a_destroyed_client_sends_nothing(node: Node) -> None:
    """Its futures would never be done."""
    client: Any = ActionClient(node, Fibonacci, "fibonacci")
    client.destroy()

    with pytest.raises(RCLError, match=r"Failed to send goal request: .* is destroyed"):
        client.send_goal_async(Fibonacci.Goal())
    with pytest.raises(RCLError, match="is destroyed"):
        client.server_is_ready()
