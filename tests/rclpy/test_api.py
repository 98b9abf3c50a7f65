"""rclpy's API on aionode, where no other rclpy is available for comparison."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import subprocess
import sys
import threading
import weakref
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

import rclpy
from aionode._process.recent import Recent
from aionode.clock import perf_ns
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS
from aionode.interfaces.example_interfaces.srv import AddTwoInts as OwnAddTwoInts
from aionode.interfaces.rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from aionode.interfaces.std_msgs.msg import String as OwnString
from aionode.message import SerializedMessage
from rclpy import executors
from rclpy._impl.errors import RCLError, RMWError
from rclpy._impl.topics import SubscriptionHandle
from rclpy._impl.typesupport import service_support
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental.asyncio import AsyncNode
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.subscription_content_filter_options import ContentFilterOptions
from rclpy.task import Future
from rclpy.time import Time
from rclpy.waitable import Waitable
from rosidl_generator_py import action_class, message_class, service_class
from tests.support.fork_server import start
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from types import FrameType, ModuleType

Clock = message_class("rosgraph_msgs/msg/Clock")
String = message_class("std_msgs/msg/String")
TimeMsg = message_class("builtin_interfaces/msg/Time")
AddTwoInts = service_class("example_interfaces/srv/AddTwoInts")
GetLoggerLevels = service_class("rcl_interfaces/srv/GetLoggerLevels")
GetTypeDescription = service_class("type_description_interfaces/srv/GetTypeDescription")
GetParameters = service_class("rcl_interfaces/srv/GetParameters")
Fibonacci = action_class("example_interfaces/action/Fibonacci")

LIMIT_S = 20.0


@pytest.fixture
def initialised(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Initialise the default context, and check that nothing of it is left afterwards."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    before = set(threading.enumerate())
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()
    left = [each for each in threading.enumerate() if each not in before]
    for thread in left:
        thread.join(5.0)  # Zenoh ends that of a transient local subscription by itself
    assert [each.name for each in left if each.is_alive()] == []


def spin_until(node: Any, future: Any) -> Any:
    """Spin until a future is done, and return its result."""
    rclpy.spin_until_future_complete(node, future, timeout_sec=LIMIT_S)
    assert future.done()
    return future.result()


def test_few_lifespans_of_publishers_are_remembered() -> None:
    """Messages may arrive with any number of invented gids."""
    handle: Any = object.__new__(SubscriptionHandle)
    handle._lifespans = Recent(REMEMBERED_PUBLISHERS)
    handle.io = SimpleNamespace(call=lambda *_: 0)
    for number in range(5000):
        handle._has_expired(number.to_bytes(16, "big"), 0, 0)

    assert len(handle._lifespans) == REMEMBERED_PUBLISHERS


@pytest.mark.usefixtures("initialised")
@pytest.mark.parametrize("stamp_ns", [0, 2**62])
def test_a_message_whose_stamp_says_nothing_lives_from_its_arrival_on(stamp_ns: int) -> None:
    """As in DDS: its publisher gives no stamp, or its clock is ahead."""
    node = rclpy.create_node("lifespan")
    subscription = node.create_subscription(String, "lifespan", print, 10)
    profile = QoSProfile(depth=1, lifespan=Duration(seconds=60))
    publisher = node.create_publisher(String, "lifespan", profile).handle.endpoint
    data = SerializedMessage(serialize_message(String(data="here")))
    inbox = subscription.handle.inbox
    now_ns = node.get_clock().now().nanoseconds

    inbox.deliver(data, publisher.gid, 1, stamp_ns, arrived_ns=now_ns - 61 * 10**9)
    inbox.deliver(data, publisher.gid, 2, stamp_ns, arrived_ns=now_ns)

    taken = subscription.handle.take_message(String, raw=False)
    assert taken is not None
    assert taken[1]["publication_sequence_number"] == 2


def test_bytes_that_are_no_message_are_an_error_of_the_middleware() -> None:
    """As in rclpy, so that programs which skip bad messages catch it as RuntimeError."""
    with pytest.raises(RMWError, match=r"failed to deserialize ROS message: std_msgs/msg/String"):
        deserialize_message(b"\x00\x01\x00\x00\xff", String)


@pytest.mark.usefixtures("initialised")
@pytest.mark.parametrize(("offered_s", "requested_s"), [(60, 3600), (3600, 60), (0, 60)])
def test_the_shorter_lifespan_of_publisher_and_subscription_counts(
    offered_s: int, requested_s: int
) -> None:
    """As with Fast DDS; 0 stands for no limit."""
    node = rclpy.create_node("lifespans")
    requested = QoSProfile(depth=10, lifespan=Duration(seconds=requested_s))
    subscription = node.create_subscription(String, "lifespans", print, requested)
    offered = QoSProfile(depth=1, lifespan=Duration(seconds=offered_s))
    publisher = node.create_publisher(String, "lifespans", offered).handle.endpoint
    data = SerializedMessage(serialize_message(String(data="here")))
    now_ns = node.get_clock().now().nanoseconds

    for number, age_s in enumerate((61, 1)):
        sent_ns = now_ns - age_s * 10**9
        subscription.handle.inbox.deliver(data, publisher.gid, number, sent_ns, arrived_ns=sent_ns)

    taken = subscription.handle.take_message(String, raw=False)
    assert taken is not None
    assert taken[1]["publication_sequence_number"] == 1


@pytest.mark.usefixtures("initialised")
def test_a_content_filter_can_be_set_read_and_taken_away() -> None:
    """rmw_zenoh has no content filters: no other rclpy shows the results of their methods."""
    node = rclpy.create_node("filtering")
    options = ContentFilterOptions("data = %0", ["'yes'"])
    subscription = node.create_subscription(
        String, "filtered", print, 10, content_filter_options=options
    )
    publisher = node.create_publisher(String, "filtered", 10)

    def taken_of(*texts: str) -> list[str]:
        for text in texts:
            publisher.publish(String(data=text))
        messages = iter(lambda: subscription.handle.take_message(String, raw=False), None)
        return [message.data for message, _ in messages]

    assert taken_of("yes", "no") == ["yes"]
    subscription.set_content_filter("data <> %0", ["'yes'"])
    assert subscription.get_content_filter() == ContentFilterOptions("data <> %0", ["'yes'"])
    assert taken_of("yes", "no") == ["no"]
    with pytest.raises(RCLError, match="price"):
        subscription.set_content_filter("price > 3", [])
    subscription.set_content_filter("", [])
    assert not subscription.is_cft_enabled
    with pytest.raises(RCLError, match="not enabled"):
        subscription.get_content_filter()
    assert taken_of("yes", "no") == ["yes", "no"]


@pytest.mark.usefixtures("initialised")
def test_a_subscription_with_a_content_filter_that_cannot_be_used_is_refused() -> None:
    """With the error of rclpy, as when a filter is set later."""
    node = rclpy.create_node("filtering")
    options = ContentFilterOptions("price > 3", [])

    with pytest.raises(RCLError, match="price"):
        node.create_subscription(String, "filtered", print, 10, content_filter_options=options)


@pytest.mark.usefixtures("initialised")
def test_a_content_filter_lets_malformed_messages_pass(caplog: pytest.LogCaptureFixture) -> None:
    """They are reported like those of any subscription; the transport continues."""
    node = rclpy.create_node("filtering")
    options = ContentFilterOptions("data = %0", ["'yes'"])
    subscription = node.create_subscription(
        String, "filtered", print, 10, content_filter_options=options
    )

    subscription.handle.inbox.deliver(SerializedMessage(b"\0"), bytes(16), 1, 0)

    assert subscription.handle.take_message(String, raw=False) is None
    assert "not a message of this type" in caplog.text


@pytest.mark.usefixtures("initialised")
def test_what_cannot_be_read_is_counted_and_said(caplog: pytest.LogCaptureFixture) -> None:
    """A request with another definition used to be refused silently."""
    node = rclpy.create_node("reader")
    subscription = node.create_subscription(String, "words", print, 10)
    server = node.create_service(AddTwoInts, "add", lambda request, response: response)
    for _ in range(20):
        subscription.handle.inbox.deliver(SerializedMessage(b"\0"), bytes(16), 1, 0)
        assert subscription.handle.take_message(String, raw=False) is None
    client = node.create_client(AddTwoInts, "add")
    assert client.wait_for_service(LIMIT_S)
    request = service_support(AddTwoInts).wire_type.Request(b"\0\1\0\0x")  # type: ignore[arg-type]  # a class is hashable
    client.handle.io.call(client.handle.bare.send, request, 0, print, print)
    wait_for = perf_ns() + int(LIMIT_S * 1e9)
    while server.handle.io.context.dropped != {"malformed": 21}:
        assert perf_ns() < wait_for
        rclpy.spin_once(node, timeout_sec=0.01)

    said = [text for text in caplog.messages if "unknown form" in text]
    assert [text.partition(":")[0] for text in said] == ["/words", "/add"]


@pytest.mark.usefixtures("initialised")
@pytest.mark.parametrize("part", ["FeedbackMessage", "SendGoal", "GetResult"])
def test_a_node_describes_the_types_of_its_actions(part: str) -> None:
    """The action's own entities use them, as in rcl; bags and pages request them."""
    node = rclpy.create_node("walker")
    ActionServer(node, Fibonacci, "walk", print)
    client = node.create_client(GetTypeDescription, "/walker/get_type_description")
    assert client.wait_for_service(LIMIT_S)
    name = f"example_interfaces/action/Fibonacci_{part}"

    future = client.call_async(GetTypeDescription.Request(type_name=name))
    rclpy.spin_until_future_complete(node, future, timeout_sec=LIMIT_S)

    described: Any = future.result()
    assert described.successful, described.failure_reason
    assert described.type_description.type_description.type_name == name


@pytest.mark.usefixtures("initialised")
@pytest.mark.parametrize("srv_type", [AddTwoInts, OwnAddTwoInts], ids=["rclpy's", "aionode's"])
def test_events_of_services_have_stamps_in_either_family_of_messages(srv_type: Any) -> None:
    """A node's clock has rclpy's times, and the event a class of its own family."""
    node = rclpy.create_node("introspected")
    service = node.create_service(srv_type, "add", lambda _, response: response)
    service.configure_introspection(
        node.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.METADATA
    )
    events: list[Any] = []
    node.create_subscription(srv_type.Event, "add/_service_event", events.append, 10)
    before = node.get_clock().now()

    spin_until(node, node.create_client(srv_type, "add").call_async(srv_type.Request()))
    while len(events) < 2:
        rclpy.spin_once(node, timeout_sec=LIMIT_S)

    assert [event.info.event_type for event in events] == [1, 2]
    assert all(event.info.stamp.sec >= before.nanoseconds // 10**9 for event in events)


@pytest.mark.usefixtures("initialised")
def test_a_request_about_too_many_loggers_gets_an_empty_answer() -> None:
    """Any node may send any number; the program's spin() continues."""
    node = rclpy.create_node("loud", enable_logger_service=True)
    answers = {service.service_name: service.callback for service in node.services}
    request = GetLoggerLevels.Request(names=["loud"] * 1001)

    response = answers["/loud/get_logger_levels"](request, GetLoggerLevels.Response())

    assert response.levels == []


@pytest.mark.usefixtures("initialised")
def test_a_clock_message_that_holds_no_time_is_left_out() -> None:
    """Any node can publish on /clock; an exception would end the executor of each follower."""
    node = rclpy.create_node("sim", parameter_overrides=[Parameter("use_sim_time", value=True)])
    take = node._time_source.clock_callback
    for sec, nanosec in ((1, 0), (-1, 0), (5, 10**9), (2, 0)):
        take(Clock(clock=TimeMsg(sec=sec, nanosec=nanosec)))
        assert node.get_clock().now().nanoseconds == (2 if sec == 2 else 1) * 10**9


@pytest.mark.usefixtures("initialised")
def test_the_log_says_it_if_nobody_publishes_simulated_time(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Whether or not the node spins, because otherwise only stalled timers would be seen."""
    monkeypatch.setattr("aionode.engine.reports.simulated_time.WAIT_S", 0.0)
    node = rclpy.create_node("sim", parameter_overrides=[Parameter("use_sim_time", value=True)])
    ends_ns = perf_ns() + int(LIMIT_S * 1e9)
    while not any("nobody publishes /clock" in text for text in caplog.messages):
        assert perf_ns() < ends_ns
        rclpy.spin_once(node, timeout_sec=0.01)


@pytest.mark.usefixtures("initialised")
def test_message_classes_of_both_families_meet_on_a_topic() -> None:
    """A program may move to aionode's messages file by file."""
    node = rclpy.create_node("families")
    got: Future[Any] = Future()
    node.create_subscription(String, "words", got.set_result, 10)
    own: list[Any] = []
    node.create_subscription(OwnString, "words", own.append, 10)

    node.create_publisher(OwnString, "words", 10).publish(OwnString(data="typed"))

    assert spin_until(node, got) == String(data="typed")
    rclpy.spin_once(node, timeout_sec=1.0)
    assert own == [OwnString(data="typed")]


@pytest.mark.usefixtures("initialised")
def test_a_call_in_a_callback_is_answered_by_another_executor() -> None:
    """Its thread waits for the response itself, so nothing needs to spin the client's node."""
    node, server = rclpy.create_node("caller"), rclpy.create_node("server")

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    server.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    executor = SingleThreadedExecutor()
    executor.add_node(server)
    worker = threading.Thread(target=lambda: executor.spin_until_future_complete(stop))
    stop: Future[None] = Future()
    worker.start()
    answer: Future[int] = Future()

    def callback() -> None:
        timer.cancel()
        response = client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=LIMIT_S)
        assert response is not None
        answer.set_result(response.sum)

    timer = node.create_timer(0.01, callback)
    try:
        assert spin_until(node, answer) == 5
    finally:
        stop.set_result(None)
        worker.join(LIMIT_S)


@pytest.mark.usefixtures("initialised")
def test_a_goal_has_feedback_and_a_result() -> None:
    """The whole life of a goal, client and server in one executor."""
    node = rclpy.create_node("actions")

    def execute(goal_handle: Any) -> Any:
        feedback = Fibonacci.Feedback()
        feedback.sequence = [0, 1]
        goal_handle.publish_feedback(feedback)
        goal_handle.succeed()
        result = Fibonacci.Result()
        result.sequence = [0, 1, goal_handle.request.order]
        return result

    server: ActionServer[Any, Any, Any] = ActionServer(node, Fibonacci, "fibonacci", execute)
    client: ActionClient[Any, Any, Any] = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(timeout_sec=LIMIT_S)
    feedback: list[list[int]] = []

    handle = spin_until(
        node,
        client.send_goal_async(
            Fibonacci.Goal(order=7),
            feedback_callback=lambda msg: feedback.append(list(msg.feedback.sequence)),
        ),
    )
    assert handle.accepted
    result = spin_until(node, handle.get_result_async())

    assert list(result.result.sequence) == [0, 1, 7]
    assert feedback == [[0, 1]]
    client.destroy()
    server.destroy()


@pytest.mark.usefixtures("initialised")
def test_a_goal_that_waits_is_cancelled() -> None:
    """A coroutine that awaits a future leaves the executor free for the cancel request."""
    node = rclpy.create_node("cancelling")
    cancelled: Future[None] = Future()

    async def execute(goal_handle: Any) -> Any:
        await cancelled
        goal_handle.canceled()
        return Fibonacci.Result()

    def accept(goal_handle: Any) -> CancelResponse:
        node.create_timer(0.01, lambda: cancelled.set_result(None))
        return CancelResponse.ACCEPT

    ActionServer(node, Fibonacci, "fibonacci", execute, cancel_callback=accept)
    client: ActionClient[Any, Any, Any] = ActionClient(node, Fibonacci, "fibonacci")
    client.wait_for_server(timeout_sec=LIMIT_S)
    handle = spin_until(node, client.send_goal_async(Fibonacci.Goal(order=1)))
    result = handle.get_result_async()

    answer = spin_until(node, handle.cancel_goal_async())
    assert len(answer.goals_canceling) == 1
    assert spin_until(node, result).status == 5


@pytest.mark.usefixtures("initialised")
def test_a_descriptor_of_the_other_family_keeps_its_ranges() -> None:
    """A program may describe its parameters with aionode's messages, too."""
    node = rclpy.create_node("described")
    limits = IntegerRange(from_value=0, to_value=10, step=2)

    node.declare_parameter("speed", 4, ParameterDescriptor(integer_range=[limits]))

    (odd, even) = node.set_parameters([Parameter("speed", value=5), Parameter("speed", value=6)])
    assert (odd.successful, even.successful) == (False, True)


@pytest.mark.usefixtures("initialised")
def test_a_request_for_too_many_parameters_gets_an_empty_answer() -> None:
    """No peer is trusted, and its data must not make the program's spin raise."""
    node = rclpy.create_node("asked")
    client = node.create_client(GetParameters, "asked/get_parameters")
    assert client.wait_for_service(LIMIT_S)

    future = client.call_async(GetParameters.Request(names=["use_sim_time"] * 10_001))

    assert list(spin_until(node, future).values) == []


@pytest.mark.usefixtures("initialised")
def test_a_managed_publisher_is_silent_until_its_node_is_active() -> None:
    """Messages published before are dropped silently, as in rclpy."""
    node = LifecycleNode("managed")
    got: list[str] = []
    node.create_subscription(String, "words", lambda msg: got.append(msg.data), 10)
    publisher = node.create_lifecycle_publisher(String, "words", 10)

    publisher.publish(String(data="early"))
    assert node.trigger_configure() is TransitionCallbackReturn.SUCCESS
    assert node.trigger_activate() is TransitionCallbackReturn.SUCCESS
    publisher.publish(String(data="active"))
    rclpy.spin_once(node, timeout_sec=1.0)

    assert got == ["active"]
    assert node.trigger_shutdown() is TransitionCallbackReturn.SUCCESS


@pytest.mark.usefixtures("initialised")
def test_a_wake_up_from_before_a_round_begins_no_second_one() -> None:
    """The done callback of a future wakes the executor that has just called it."""

    class Counting(SingleThreadedExecutor):
        rounds = 0

        def get_nodes(self) -> list[Any]:
            self.rounds += 1
            return super().get_nodes()

    executor = Counting()
    executor.wake()

    executor.spin_once(timeout_sec=0.01)

    assert executor.rounds == 1
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
def test_a_timer_that_another_timer_resets_is_called_a_period_later() -> None:
    """Although both were due when the round began."""
    node = rclpy.create_node("watching")
    clock = clock_at(0.0)
    called: list[float] = []

    def rearm() -> None:
        watchdog.reset()

    def bark() -> None:
        called.append(clock.now().nanoseconds / 1e9)

    node.create_timer(1.0, rearm, clock=clock)
    watchdog = node.create_timer(1.0, bark, clock=clock)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    clock.set_ros_time_override(Time(seconds=1.5, clock_type=ClockType.ROS_TIME))

    for _ in range(3):
        executor.spin_once(timeout_sec=0)

    assert called == []
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
def test_a_timer_that_another_timer_cancels_takes_no_turn() -> None:
    """The next spin calls the timer after it."""
    node = rclpy.create_node("cancelling")
    clock = clock_at(0.0)
    called: list[str] = []

    def cancel() -> None:
        cancelled.cancel()

    node.create_timer(1.0, cancel, clock=clock)
    cancelled = node.create_timer(1.0, lambda: called.append("cancelled"), clock=clock)
    node.create_timer(1.0, lambda: called.append("next"), clock=clock)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    clock.set_ros_time_override(Time(seconds=1.5, clock_type=ClockType.ROS_TIME))

    for _ in range(2):
        executor.spin_once(timeout_sec=0)

    assert called == ["next"]
    executor.shutdown()


def clock_at(seconds: float) -> ROSClock:
    """Return a clock that shows this time until another one is set."""
    clock = ROSClock()
    clock._set_ros_time_is_active(True)
    clock.set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))
    return clock


@pytest.mark.usefixtures("initialised")
@pytest.mark.timeout(20)
def test_a_message_that_woke_a_spin_which_ended_is_found_by_the_next_one() -> None:
    """The wake-up was taken with the spin that ended; the message stays."""
    node = rclpy.create_node("late")
    got: list[str] = []
    node.create_subscription(String, "late", lambda msg: got.append(msg.data), 10)
    publisher = node.create_publisher(String, "late", 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_once(timeout_sec=0.01)
    done: Future[None] = Future()
    done.set_result(None)
    publisher.publish(String(data="hello"))
    executor.spin_once_until_future_complete(done)
    assert not got

    executor.spin_once(timeout_sec=60.0)

    assert got == ["hello"]
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
@pytest.mark.timeout(20)
def test_a_message_that_arrived_while_its_group_was_spinning_is_found_after_that() -> None:
    """The end of the callback that has spun makes it callable, and wakes nobody."""
    node = rclpy.create_node("nested")
    got: list[str] = []
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    second = node.create_publisher(String, "second", 10)

    def spin_in_callback(_: object) -> None:
        second.publish(String(data="hello"))
        executor.spin_once(timeout_sec=0.01)

    node.create_subscription(String, "first", spin_in_callback, 10)
    node.create_subscription(String, "second", lambda msg: got.append(msg.data), 10)
    node.create_publisher(String, "first", 10).publish(String())
    executor.spin_once(timeout_sec=60.0)

    executor.spin_once(timeout_sec=60.0)

    assert got == ["hello"]
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
@pytest.mark.timeout(20)
def test_what_is_ready_in_a_node_that_is_added_during_a_wait_is_found() -> None:
    """Only adding the node wakes the executor, which looks for what is ready in it, too."""
    got: list[str] = []
    late = rclpy.create_node("late")
    guard = late.create_guard_condition(lambda: got.append("called"))
    guard.trigger()

    class Executor(SingleThreadedExecutor):
        """Adds the node just before it waits, when it asks whether to wait for a timer."""

        def can_execute(self, entity: Any) -> bool:
            self.add_node(late)
            return super().can_execute(entity)

    node = rclpy.create_node("early")
    node.create_timer(3600.0, lambda: None)
    executor = Executor()
    executor.add_node(node)

    executor.spin_once(timeout_sec=60.0)

    assert got == ["called"]
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
@pytest.mark.timeout(20)
def test_a_waitable_that_a_callback_makes_ready_is_executed() -> None:
    """It may have no handle that wakes the executor."""

    class Told(Waitable[None]):
        told = executed = False

        def is_ready(self, _: object) -> bool:
            return self.told

        def take_data(self) -> None:
            self.told = False

        async def execute(self, _: object) -> None:
            self.executed = True

        def add_to_wait_set(self, _: object) -> None:
            pass

        def __enter__(self) -> None:
            pass

        def __exit__(self, *_: object) -> None:
            pass

    node = rclpy.create_node("telling")
    waitable = Told(ReentrantCallbackGroup())
    node.add_waitable(waitable)
    node.create_subscription(String, "tell", lambda _: setattr(waitable, "told", True), 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    node.create_publisher(String, "tell", 10).publish(String())
    executor.spin_once(timeout_sec=60.0)

    executor.spin_once(timeout_sec=60.0)

    assert waitable.executed
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
@pytest.mark.timeout(20)
def test_a_message_is_found_after_a_signal_handler_has_raised_in_a_spin() -> None:
    """Here just after the executor has taken the wake-up."""
    node = rclpy.create_node("interrupted")
    got: list[str] = []
    node.create_subscription(String, "interrupted", lambda msg: got.append(msg.data), 10)
    publisher = node.create_publisher(String, "interrupted", 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_once(timeout_sec=0.01)
    publisher.publish(String(data="hello"))

    def interrupt(frame: FrameType, event: str, called: object) -> None:
        is_here = frame.f_code.co_filename == executors.__file__
        if event == "c_return" and is_here and getattr(called, "__name__", "") == "acquire":
            raise KeyboardInterrupt

    sys.setprofile(interrupt)
    try:
        with pytest.raises(KeyboardInterrupt):
            executor.spin_once(timeout_sec=60.0)
    finally:
        sys.setprofile(None)

    executor.spin_once(timeout_sec=60.0)

    assert got == ["hello"]
    executor.shutdown()


@pytest.mark.usefixtures("initialised")
def test_a_transition_that_is_not_possible_is_warned_of_in_the_words_of_rcl(
    caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]
) -> None:
    """Programs and people look for these lines in a log."""
    node = LifecycleNode("managed")

    assert node.trigger_activate() is TransitionCallbackReturn.ERROR

    logged = caplog.text + capsys.readouterr().err
    assert "No transition matching 3 found for current state unconfigured" in logged
    node.destroy_node()


@pytest.mark.usefixtures("initialised")
async def test_an_async_node_needs_no_executor() -> None:
    """Its callbacks run in the loop that awaits it."""
    async with AsyncNode("awaited") as node, asyncio.timeout(LIMIT_S):
        got: asyncio.Queue[str] = asyncio.Queue()

        async def keep(msg: Any) -> None:
            await got.put(msg.data)

        async def add(request: Any, response: Any) -> Any:
            response.sum = request.a + request.b
            return response

        node.create_subscription(String, "words", keep, 10)
        publisher = node.create_publisher(String, "words", 10)
        node.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add")
        node.create_timer(0.01, lambda: publisher.publish(String(data="tick")))

        assert await got.get() == "tick"
        await client.wait_for_service()
        assert (await client.call(AddTwoInts.Request(a=2, b=3))).sum == 5
        await node.get_clock().sleep(0.01)


@pytest.mark.usefixtures("initialised")
async def test_an_async_node_calls_guard_conditions_that_it_creates_while_it_runs() -> None:
    """Callbacks of other entities created then are called, too."""
    async with AsyncNode("awaited") as node, asyncio.timeout(LIMIT_S):
        called = asyncio.Event()

        node.create_guard_condition(called.set).trigger()

        await called.wait()


def said_until_end(process: subprocess.Popen[str]) -> tuple[str, str]:
    """Return what a program writes; one that does not end writes the stacks of its threads."""
    try:
        return process.communicate(timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGABRT)  # PYTHONFAULTHANDLER is set
        return process.communicate()


ENDING = """\
import sys
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("ending")
node.create_publisher(String, "words", 10).publish(String(data="last words"))


def fail():
    raise LookupError("on purpose")


def say():
    timer.cancel()
    print("spins", flush=True)


timer = node.create_timer(0.01, say)
if sys.argv[1] == "spin":
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("interrupted")
    except rclpy.executors.ExternalShutdownException:
        pass  # it was waiting; between two callbacks, `spin` returns
    print("ended", rclpy.ok())
if sys.argv[1] == "fail":
    node.create_timer(0.02, fail)
    rclpy.spin(node)
"""


@pytest.mark.parametrize(
    ("how", "number", "said", "status"),
    [
        pytest.param("exit", None, "", 0, marks=pytest.mark.slow),
        ("spin", signal.SIGINT, "spins\ninterrupted\nended False\n", 0),
        pytest.param("spin", signal.SIGTERM, "spins\nended False\n", 0, marks=pytest.mark.slow),
        ("fail", None, "spins\n", 1),
    ],
)
def test_a_program_ends_however_it_ends(
    how: str, number: int | None, said: str, status: int, tmp_path: Path
) -> None:
    """Regularly, by a signal or by an exception; without `shutdown`, and without a hang."""
    program = tmp_path / "ending.py"
    program.write_text(ENDING)
    process = start(
        ["-m", "aionode.rclpy", str(program), how],
        env={**os.environ, **isolated_environment(), "PYTHONFAULTHANDLER": "1"},
        fresh=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    first = process.stdout.readline()
    if number is not None:
        process.send_signal(number)
    rest, errors = said_until_end(process)

    assert (first + rest, process.returncode) == (said, status), errors
    assert ("LookupError: on purpose" in errors) == (how == "fail")


SIGNAL_IN_A_THREAD = """\
import os, signal, threading, time
import rclpy

def send():
    while open(f"/proc/self/task/{os.getpid()}/stat").read().rsplit(")", 1)[1].split()[0] != "S":
        time.sleep(0.01)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)

rclpy.init()
node = rclpy.create_node("sleeping")
guard = node.create_guard_condition(threading.Thread(target=send, daemon=True).start)
guard.trigger()
try:
    rclpy.spin(node)
except rclpy.executors.ExternalShutdownException:
    pass
print("ended", flush=True)
"""


@pytest.mark.slow
def test_a_signal_that_does_not_interrupt_a_wait_is_handled(tmp_path: Path) -> None:
    """One that comes just before the wait cannot be timed, so a thread gets it."""
    program = tmp_path / "sleeping.py"
    program.write_text(SIGNAL_IN_A_THREAD)
    process = start(
        ["-m", "aionode.rclpy", str(program)],
        env={**os.environ, **isolated_environment(), "PYTHONFAULTHANDLER": "1"},
        fresh=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    printed, _ = said_until_end(process)

    assert (printed, process.returncode) == ("ended\n", 0)


ENDING_PUBLISHER = """\
import rclpy
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("ending")
qos = QoSProfile(
    history=QoSHistoryPolicy.KEEP_ALL, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL
)
publisher = node.create_publisher(Int32, "numbers", qos)
for number in range(5000):
    publisher.publish(Int32(data=number))
"""


@pytest.mark.slow
def test_a_program_that_ends_without_shutdown_drops_nothing(tmp_path: Path) -> None:
    """A thread passes the messages to Zenoh, and still has many of them when the program ends."""
    program = tmp_path / "ending.py"
    program.write_text(ENDING_PUBLISHER)
    process = start(
        ["-m", "aionode.rclpy", str(program)],
        env={**os.environ, **isolated_environment(), "PYTHONFAULTHANDLER": "1"},
        fresh=True,  # the order in which modules are imported decides
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    printed, _ = said_until_end(process)

    assert (printed, process.returncode) == ("", 0)


@pytest.mark.slow
@pytest.mark.usefixtures("initialised")
def test_ten_thousand_calls_at_once_leave_nothing_behind() -> None:
    """As in rclpy, only those within the server's depth are answered; the rest are not kept."""
    node = rclpy.create_node("many")
    node.create_service(AddTwoInts, "many", lambda request, response: response)
    client = node.create_client(AddTwoInts, "many")
    assert client.wait_for_service(LIMIT_S)
    futures = [client.call_async(AddTwoInts.Request()) for _ in range(10_000)]
    spin_until(node, futures[-1])
    answered = sum(future.done() for future in futures)

    assert 10 <= answered < 10_000
    assert not client.handle._calls
    spin_until(node, client.call_async(AddTwoInts.Request()))
    rclpy.spin_once(node, timeout_sec=LIMIT_S)  # its done callback
    for future in futures:
        client.remove_pending_request(future)
    assert not client._pending_requests


def lines_run(call: Callable[[], object], module: ModuleType) -> list[int]:
    """Return the number of each line of a module that a call runs, in order."""
    lines: list[int] = []

    def note(frame: FrameType, event: str, _: object) -> Any:
        if frame.f_code.co_filename != module.__file__:
            return None
        if event == "line":
            lines.append(frame.f_lineno)
        return note

    before = sys.gettrace()
    sys.settrace(note)
    try:
        call()
    finally:
        sys.settrace(before)
    return lines


@pytest.mark.usefixtures("initialised")
def test_giving_a_request_up_costs_the_same_however_many_are_pending() -> None:
    """Otherwise a program that gives up thousands of them would wait for seconds."""
    client = rclpy.create_node("many").create_client(AddTwoInts, "nobody_serves")
    few = [client.call_async(AddTwoInts.Request()) for _ in range(2)]
    lines_of_few = lines_run(partial(client.remove_pending_request, few[-1]), rclpy.client)
    many = [client.call_async(AddTwoInts.Request()) for _ in range(200)]

    lines_of_many = lines_run(partial(client.remove_pending_request, many[-1]), rclpy.client)
    assert len(lines_of_many) == len(lines_of_few) > 0
    with pytest.raises(KeyError):
        client.get_pending_request(len(few) + len(many))
    assert client.get_pending_request(len(few) + len(many) - 1) is many[-2]


@pytest.mark.usefixtures("initialised")
def test_a_sleep_that_an_exception_ends_changes_none_after_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A signal handler raises; a count of those who sleep would never be right again."""
    node = rclpy.create_node("interrupted")
    rate = node.create_rate(0.001)
    (timer,) = node.timers
    would_return: list[bool] = []

    def interrupt(*_: Any) -> bool:
        raise InterruptedError

    def look(is_ready: Callable[[], bool], *_: Any) -> bool:
        would_return.append(is_ready())
        return True

    monkeypatch.setattr("rclpy.timer.wait_until", interrupt)
    with pytest.raises(InterruptedError):
        rate.sleep()
    monkeypatch.setattr("rclpy.timer.wait_until", look)
    rate.sleep()
    assert timer.callback is not None
    timer.callback()
    rate.sleep()
    rate.sleep()

    assert would_return == [False, True, False]


@pytest.mark.usefixtures("initialised")
def test_an_object_whose_method_waits_for_the_shutdown_is_not_kept() -> None:
    """Not even if the function of the method refers to it."""

    def listen() -> weakref.ref[Any]:
        class Listener:
            def end(self) -> None:
                raise AssertionError(listener)

        listener = Listener()
        rclpy.get_default_context().on_shutdown(listener.end)
        return weakref.ref(listener)

    listener = listen()
    gc.collect()

    assert listener() is None


@pytest.mark.parametrize(
    ("member", "text"),
    [
        (rclpy.clock.ClockChange.ROS_TIME_ACTIVATED, "ClockChange.ROS_TIME_ACTIVATED"),
        (rclpy.qos.QoSCompatibility.OK, "QoSCompatibility.OK"),
        (rclpy.action.server.GoalEvent.SUCCEED, "GoalEvent.SUCCEED"),
        (rclpy.signals.SignalHandlerOptions.ALL, "SignalHandlerOptions.ALL"),
    ],
)
def test_what_rclpy_takes_from_its_extension_is_printed_by_name(member: Any, text: str) -> None:
    """Python prints the number of an `IntEnum`; the extension's enumerations are none."""
    assert f"{member}" == text
