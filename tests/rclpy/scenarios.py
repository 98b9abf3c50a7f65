"""The scenes of the differential tests for rclpy and aionode: ``scenarios.py [name …]``.

Each function plays a scene with rclpy's API and traces what can be seen of it, except what depends
on speed. The traces are printed as JSON, by name. The numbers are those of the rules that a
compatible API has to keep.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from typing import Any

from lifecycle_msgs.msg import TransitionEvent
from lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rcl_interfaces.srv import ListParameters
from std_msgs.msg import Int32, String

import rclpy
import rclpy.executors
from rclpy.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle
from rclpy.executors import (
    ExternalShutdownException,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    TimeoutException,
)
from rclpy.lifecycle import (
    LifecycleNode,
    ManagedEntity,
    State,
    TransitionCallbackReturn,
)
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.task import Future
from rclpy.time import Time
from rclpy.timer import TimerInfo
from rclpy.wait_for_message import wait_for_message

Trace = Callable[..., None]

PATIENCE_S = 20.0

SCENES: dict[str, Callable[[Trace], None]] = {}


def scene(function: Callable[[Trace], None]) -> Callable[[Trace], None]:
    """Add a scene."""
    SCENES[function.__name__] = function
    return function


def until(condition: Callable[[], Any], step: Callable[[], None] | None = None) -> bool:
    """Wait for a condition; `step` is called in between."""
    ends = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > ends:
            return False
        if step is None:
            time.sleep(0.01)
        else:
            step()
    return True


def attempt(trace: Trace, what: str, action: Callable[[], Any]) -> None:
    """Trace the name of the exception that an action raises, or its result."""
    try:
        result = action()
    except Exception as error:  # noqa: BLE001  # what is raised is traced
        trace(what, "raises", type(error).__name__)
    else:
        trace(what, "returns", result)


def thread_name() -> str:
    """Return the name of the current thread."""
    main = threading.current_thread() is threading.main_thread()
    return "main" if main else threading.current_thread().name


def matched_pair(node: Any, topic: str, callback: Any, depth: int = 10) -> tuple[Any, Any]:
    """Return a publisher and a subscription that have found each other."""
    subscription = node.create_subscription(Int32, topic, callback, depth)
    publisher = node.create_publisher(Int32, topic, depth)
    until(lambda: publisher.get_subscription_count() and subscription.get_publisher_count())
    return publisher, subscription


@scene
def e01_callbacks_run_in_the_thread_that_spins(trace: Trace) -> None:
    node = rclpy.create_node("e01")
    publisher, _ = matched_pair(node, "e01", lambda msg: trace("subscription", thread_name()))
    node.create_timer(0.01, lambda: trace("timer", thread_name())).cancel()
    guard = node.create_guard_condition(lambda: trace("guard", thread_name()))
    done: list[int] = []
    publisher.publish(Int32(data=1))
    guard.trigger()
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def spin() -> None:
        for _ in range(4):
            executor.spin_once(timeout_sec=0.5)
        done.append(1)

    worker = threading.Thread(target=spin, name="worker")
    worker.start()
    worker.join()
    trace("spun", len(done))


@scene
def e02_everything_but_callbacks_works_without_spinning(trace: Trace) -> None:
    node = rclpy.create_node("e02", namespace="/deep")
    client = node.create_client(ListParameters, "e02/list_parameters")
    trace("service", client.wait_for_service(timeout_sec=10.0))
    publisher = node.create_publisher(String, "e02", 10)
    publisher.publish(String(data="unheard"))
    trace("count", node.count_publishers("e02"), node.count_subscribers("e02"))
    trace("topics", ("/deep/e02", ["std_msgs/msg/String"]) in node.get_topic_names_and_types())
    trace("names", "/deep/e02" in node.get_fully_qualified_node_names())
    node.declare_parameter("speed", 1.5)
    trace("parameter", node.get_parameter("speed").value)
    trace("wait_for_node", node.wait_for_node("/deep/e02", 5.0))
    trace("no such node", node.wait_for_node("/nobody", 0.2))


@scene
def e03_spin_once_calls_one_callback_in_the_order_of_rounds(trace: Trace) -> None:
    node = rclpy.create_node("e03")
    publisher, subscription = matched_pair(node, "e03", lambda msg: trace("sub", msg.data))
    timer = node.create_timer(0.5, lambda: (trace("timer"), timer.cancel()))
    guard = node.create_guard_condition(lambda: trace("guard"))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while True:  # woken by adding it
        before = time.monotonic()
        executor.spin_once(timeout_sec=0.01)
        if time.monotonic() - before > 0.005:
            break
    publisher.publish(Int32(data=1))
    publisher.publish(Int32(data=2))
    guard.trigger()
    until(timer.is_ready)  # the messages are there by then
    for _ in range(6):
        trace("once")
        executor.spin_once(timeout_sec=0)


@scene
def e04_spin_once_works_inside_of_a_running_event_loop(trace: Trace) -> None:
    node = rclpy.create_node("e04")
    got: list[int] = []
    publisher, _ = matched_pair(node, "e04", lambda msg: got.append(msg.data))

    async def main() -> None:
        publisher.publish(Int32(data=4))
        while not got:
            rclpy.spin_once(node, timeout_sec=0.1)
            await asyncio.sleep(0)
        trace("got", *got)

    asyncio.run(main())


@scene
def e05_nested_spins_complete_what_another_node_waits_for(trace: Trace) -> None:
    node = rclpy.create_node("e05")
    other = rclpy.create_node("e05_other")
    other_client = other.create_client(ListParameters, "e05_server/list_parameters")
    own_client = node.create_client(ListParameters, "e05_server/list_parameters")
    server = rclpy.create_node("e05_server")
    background = SingleThreadedExecutor()
    background.add_node(server)
    worker = threading.Thread(target=background.spin, daemon=True)
    worker.start()
    other_client.wait_for_service(10.0)
    own_client.wait_for_service(10.0)
    finished = Future()

    def callback() -> None:
        guard_timer.cancel()
        nested = SingleThreadedExecutor()
        future = other_client.call_async(ListParameters.Request())
        rclpy.spin_until_future_complete(other, future, nested, timeout_sec=10.0)
        trace("other node", future.done())
        future = own_client.call_async(ListParameters.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=0.5)
        trace("own node, same group", future.done())
        finished.set_result(None)

    guard_timer = node.create_timer(0.01, callback)
    rclpy.spin_until_future_complete(node, finished, timeout_sec=PATIENCE_S)
    background.shutdown()
    worker.join(5.0)


@scene
def e06_messages_wait_while_nothing_spins_and_the_newest_stay(trace: Trace) -> None:
    node = rclpy.create_node("e06")
    got: list[int] = []
    publisher, _ = matched_pair(node, "e06", lambda msg: got.append(msg.data), depth=3)
    for number in range(10):
        publisher.publish(Int32(data=number))
        time.sleep(0.01)
    time.sleep(0.2)
    ends = time.monotonic() + 1.0
    while time.monotonic() < ends and len(got) < 4:
        rclpy.spin_once(node, timeout_sec=0.1)
    trace(got)


@scene
def e07_entities_come_and_go_while_another_thread_spins(trace: Trace) -> None:
    node = rclpy.create_node("e07")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    worker = threading.Thread(target=executor.spin, daemon=True)
    worker.start()
    got = threading.Event()
    publisher, subscription = matched_pair(node, "e07", lambda msg: got.set())
    publisher.publish(Int32(data=1))
    trace("subscription", got.wait(10.0))
    ticked = threading.Event()
    timer = node.create_timer(0.02, ticked.set)
    trace("timer", ticked.wait(10.0))
    pulled = threading.Event()
    guard = node.create_guard_condition(pulled.set)
    guard.trigger()
    trace("guard", pulled.wait(10.0))
    client = node.create_client(ListParameters, "e07/list_parameters")
    trace("call", client.call(ListParameters.Request(), timeout_sec=10.0) is not None)
    trace("destroyed", node.destroy_subscription(subscription), node.destroy_timer(timer))
    trace("again", node.destroy_subscription(subscription))
    trace("rest", node.destroy_guard_condition(guard), node.destroy_client(client))
    executor.shutdown()
    worker.join(5.0)
    trace("ended", not worker.is_alive())


@scene
def e08_a_node_is_in_one_executor(trace: Trace) -> None:
    node = rclpy.create_node("e08")
    first, second = SingleThreadedExecutor(), SingleThreadedExecutor()
    trace("added", first.add_node(node), first.add_node(node))
    trace("in first", node.executor is first, node in first.get_nodes())
    trace("added to second", second.add_node(node))
    trace("in second", node.executor is second, node in first.get_nodes())
    second.remove_node(node)
    trace("removed", node in second.get_nodes())


class Counting(CallbackGroup):
    """Traces what an executor calls of it."""

    def __init__(self) -> None:
        super().__init__()
        self.events: list[str] = []

    def can_execute(self, entity: Any) -> bool:
        return True

    def beginning_execution(self, entity: Any) -> bool:
        self.events.append("begin")
        return True

    def ending_execution(self, entity: Any) -> None:
        self.events.append("end")


@scene
def e09_callback_groups(trace: Trace) -> None:
    node = rclpy.create_node("e09")
    trace("default", type(node.default_callback_group).__name__)
    own = Counting()
    guard = node.create_guard_condition(lambda: own.events.append("call"), own)
    trace("member", own.has_entity(guard), node.default_callback_group.has_entity(guard))
    guard.trigger()
    until(lambda: "end" in own.events, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace(own.events)
    for group in (MutuallyExclusiveCallbackGroup(), ReentrantCallbackGroup()):
        running: list[int] = []
        most: list[int] = []
        both = threading.Barrier(2)

        def work(running: list[int] = running, most: list[int] = most) -> None:
            running.append(1)
            most.append(len(running))
            try:
                both.wait(0.5)
            except threading.BrokenBarrierError:
                pass
            running.pop()

        guards = [node.create_guard_condition(work, group) for _ in range(2)]
        executor = MultiThreadedExecutor(num_threads=4)
        executor.add_node(node)
        for each in guards:
            each.trigger()
        until(lambda most=most: len(most) == 2, lambda: executor.spin_once(timeout_sec=0.1))
        until(lambda running=running: not running)
        trace(type(group).__name__, "at once", max(most))
        executor.shutdown()


class OwnExecutor(rclpy.executors.Executor):
    """Runs each task in a new thread, like the example of a custom executor."""

    def spin_once(self, timeout_sec: float | None = None) -> None:
        try:
            task, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            return
        worker = threading.Thread(target=task, name="task")
        worker.start()
        worker.join()


@scene
def e10_own_executors_take_tasks(trace: Trace) -> None:
    node = rclpy.create_node("e10")
    guard = node.create_guard_condition(lambda: trace("guard", thread_name()))
    executor = OwnExecutor()
    executor.add_node(node)
    guard.trigger()
    for _ in range(3):
        executor.spin_once(timeout_sec=0.2)
    task = executor.create_task(lambda: thread_name())
    executor.spin_once(timeout_sec=0.2)
    trace("task", task.done(), task.result())
    attempt(trace, "timeout", lambda: executor.wait_for_ready_callbacks(timeout_sec=0.05))


@scene
def e11_exceptions_come_out_of_spin(trace: Trace) -> None:
    node = rclpy.create_node("e11")

    def fail() -> None:
        timer.cancel()
        raise KeyError("broken")

    timer = node.create_timer(0.01, fail)
    attempt(trace, "spin", lambda: rclpy.spin(node))
    timer.reset()
    attempt(
        trace,
        "spin_once",
        lambda: until(lambda: False, lambda: rclpy.spin_once(node, timeout_sec=1.0)),
    )

    async def fail_later() -> None:
        guard_done.append(1)
        raise ValueError("later")

    guard_done: list[int] = []
    guard = node.create_guard_condition(fail_later)
    guard.trigger()
    attempt(trace, "coroutine", lambda: rclpy.spin(node))
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    timer.reset()
    attempt(trace, "threads", executor.spin)
    executor.shutdown()


@scene
def e12_futures(trace: Trace) -> None:
    free: Future = Future()
    free.add_done_callback(lambda future: trace("free", thread_name(), future.result()))
    setter = threading.Thread(target=lambda: free.set_result(3), name="setter")
    setter.start()
    setter.join()
    free.add_done_callback(lambda future: trace("late", future.done()))
    executor = SingleThreadedExecutor()
    bound = executor.create_future()
    bound.add_done_callback(lambda future: trace("bound", thread_name()))
    setter = threading.Thread(target=lambda: bound.set_result(3), name="setter")
    setter.start()
    setter.join()
    trace("not yet")
    executor.spin_once(timeout_sec=1.0)
    cancelled: Future = Future()
    cancelled.cancel()
    trace("cancelled", cancelled.cancelled(), cancelled.done(), cancelled.result())
    failed: Future = Future()
    failed.set_exception(OSError("no"))
    attempt(trace, "failed", failed.result)
    trace("removed", cancelled.remove_done_callback(print))


@scene
def e13_coroutines_wait_for_futures_and_for_bare_yields(trace: Trace) -> None:
    node = rclpy.create_node("e13")
    gate: Future = Future()
    finished: Future = Future()

    class Step:
        def __await__(self) -> Any:
            yield

    async def callback(msg: Int32) -> None:
        trace("begins", msg.data)
        await Step()
        trace("stepped")
        trace("opened with", await gate)
        try:
            await asyncio.sleep(0.01)
        except RuntimeError as error:
            trace("asyncio", str(error))
        finished.set_result(None)

    publisher, _ = matched_pair(node, "e13", callback)
    publisher.publish(Int32(data=13))
    timer = node.create_timer(0.3, lambda: (timer.cancel(), gate.set_result("key")))
    rclpy.spin_until_future_complete(node, finished, timeout_sec=2.0)  # which rclpy waits out
    trace("finished", finished.done())


@scene
def e14_call_blocks_and_its_timeout_forgets_the_request(trace: Trace) -> None:
    node = rclpy.create_node("e14")
    server = rclpy.create_node("e14_server")
    client = node.create_client(ListParameters, "e14_server/list_parameters")
    client.wait_for_service(10.0)
    attempt(trace, "no server spins", lambda: client.call(ListParameters.Request(), 0.2))
    attempt(trace, "wrong type", lambda: client.call(ListParameters.Response()))
    attempt(trace, "wrong type, async", lambda: client.call_async(None))
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    executor.add_node(server)
    worker = threading.Thread(target=executor.spin, daemon=True)
    worker.start()
    response = client.call(ListParameters.Request(), timeout_sec=10.0)
    trace("names", sorted(response.result.names))
    future = client.call_async(ListParameters.Request())
    trace("async", until(future.done), type(future.result()).__name__)
    executor.shutdown()
    worker.join(5.0)


@scene
def e15_sleeps_block_a_thread_and_shutdown_wakes_them(trace: Trace) -> None:
    node = rclpy.create_node("e15")
    clock = node.get_clock()
    trace("sleep_for", clock.sleep_for(Duration(seconds=0.05)))
    past = Time(seconds=1, clock_type=ClockType.ROS_TIME)
    trace("past", clock.sleep_until(past))
    attempt(
        trace,
        "wrong clock",
        lambda: clock.sleep_until(Time(seconds=1, clock_type=ClockType.STEADY_TIME)),
    )
    rate = node.create_rate(20)
    results: list[str] = []

    def sleep() -> None:
        rate.sleep()
        results.append("ticked")
        try:
            while True:
                rate.sleep()
        except BaseException as error:  # noqa: BLE001  # what is raised is traced
            results.append(type(error).__name__)

    def sleep_long() -> None:
        results.append(f"long {clock.sleep_for(Duration(seconds=60))}")

    sleepers = [threading.Thread(target=sleep), threading.Thread(target=sleep_long)]
    for each in sleepers:
        each.start()
    until(lambda: results, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    rclpy.shutdown()
    for each in sleepers:
        each.join(10.0)
    trace(sorted(results))


@scene
def e16_shutdown_in_a_callback_ends_spin(trace: Trace) -> None:
    node = rclpy.create_node("e16")
    node.create_timer(0.01, rclpy.shutdown)
    attempt(trace, "spin", lambda: rclpy.spin(node))
    trace("ok", rclpy.ok())


@scene
def e16_shutdown_in_another_thread_ends_spin(trace: Trace) -> None:
    node = rclpy.create_node("e16")
    worker = threading.Timer(0.2, rclpy.shutdown)
    worker.start()
    try:
        rclpy.spin(node)
        trace("returned")
    except ExternalShutdownException:
        trace("returned")  # rclpy does either, depending on whether it happens to wait
    worker.join()
    trace("ok", rclpy.ok())


@scene
def e16_sigint_is_a_keyboard_interrupt(trace: Trace) -> None:
    signalled(trace, signal.SIGINT)


@scene
def e16_sigterm_ends_spin(trace: Trace) -> None:
    signalled(trace, signal.SIGTERM)


def signalled(trace: Trace, number: int) -> None:
    """Trace the effect of a signal on a spinning program."""
    node = rclpy.create_node("e16")
    context = rclpy.get_default_context()
    context.on_shutdown(lambda: trace("on_shutdown"))
    sender = threading.Timer(0.3, lambda: os.kill(os.getpid(), number))
    sender.start()
    try:
        rclpy.spin(node)
        trace("returned")
    except BaseException as error:  # noqa: BLE001  # what is raised is traced
        trace("raised", type(error).__name__)
    sender.join()
    trace("ok", rclpy.ok())
    node.destroy_node()
    attempt(trace, "shutdown", rclpy.shutdown)
    attempt(trace, "again", context.shutdown)
    attempt(trace, "try", context.try_shutdown)


@scene
def e16_a_loop_that_publishes_ends_by_sigterm(trace: Trace) -> None:
    node = rclpy.create_node("e16")
    publisher = node.create_publisher(Int32, "e16", 1)
    sender = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGTERM))
    sender.start()

    def loop() -> None:
        while True:
            publisher.publish(Int32())
            time.sleep(0.01)

    attempt(trace, "loop", loop)
    sender.join()
    trace("ok", rclpy.ok())


@scene
def e16_after_a_signal_nothing_is_asked(trace: Trace) -> None:
    node = rclpy.create_node("e16")
    publisher = node.create_publisher(Int32, "e16", 1)
    subscription = node.create_subscription(Int32, "e16", trace, 1)
    client = node.create_client(ListParameters, "e16")
    parameters = AsyncParameterClient(node, "missing")
    os.kill(os.getpid(), signal.SIGTERM)
    until(lambda: not rclpy.ok())
    attempts: dict[str, Callable[[], Any]] = {
        "service_is_ready": client.service_is_ready,
        "wait_for_service": lambda: client.wait_for_service(timeout_sec=0.1),
        "wait_for_services": lambda: parameters.wait_for_services(0.1),
        "wait_for_node": lambda: node.wait_for_node("missing", 0.1),
        "get_node_names": node.get_node_names,
        "get_topic_names_and_types": node.get_topic_names_and_types,
        "get_service_names_and_types": node.get_service_names_and_types,
        "by_node": lambda: node.get_client_names_and_types_by_node("e16", "/"),
        "count_publishers": lambda: node.count_publishers("e16"),
        "count_services": lambda: node.count_services("e16"),
        "info": lambda: node.get_subscriptions_info_by_topic("e16"),
        "get_subscription_count": publisher.get_subscription_count,
        "get_publisher_count": lambda: subscription.get_publisher_count() >= 0,
        "assert_liveliness": publisher.assert_liveliness,
        "wait_for_all_acked": publisher.wait_for_all_acked,
        "call_async": lambda: client.call_async(ListParameters.Request()).done(),
        "declare_parameter": lambda: node.declare_parameter("e16", 1),
        "create_publisher": lambda: node.create_publisher(Int32, "late", 1),
        "create_subscription": lambda: node.create_subscription(Int32, "late", trace, 1),
        "create_client": lambda: node.create_client(ListParameters, "late"),
        "create_service": lambda: node.create_service(ListParameters, "late", trace),
        "create_timer": lambda: node.create_timer(1.0, trace),
        "get_name": node.get_name,
    }
    for what, action in attempts.items():
        attempt(trace, what, action)


@scene
def e17_contexts_are_independent(trace: Trace) -> None:
    first, second = rclpy.Context(), rclpy.Context()
    attempt(trace, "before init", first.shutdown)
    attempt(trace, "domain before init", first.get_domain_id)
    rclpy.init(context=first, domain_id=33)
    rclpy.init(context=second, domain_id=34)
    attempt(trace, "init twice", lambda: rclpy.init(context=first))
    trace("domains", first.get_domain_id(), second.get_domain_id())
    first.on_shutdown(lambda: trace("first is over"))
    node = rclpy.create_node("e17", context=first)
    other = rclpy.create_node("e17", context=second)
    trace("alone", other.count_publishers("/only_here"))
    executor = SingleThreadedExecutor(context=second)
    executor.add_node(other)
    first.shutdown()
    trace("ok", first.ok(), second.ok())
    attempt(trace, "node of the first", node.get_name)
    trace("node of the second", other.get_name())
    first.on_shutdown(lambda: trace("called at once"))
    second.try_shutdown()
    second.try_shutdown()
    trace("ok", second.ok())
    attempt(trace, "node", lambda: rclpy.create_node("late", context=second))
    with rclpy.init(context=rclpy.Context()) as manager:
        trace("inside", manager.context.ok())
    trace("after", manager.context.ok())


@scene
def e18_destroyed_entities_refuse(trace: Trace) -> None:
    node = rclpy.create_node("e18")
    publisher = node.create_publisher(Int32, "e18", 10)
    timer = node.create_timer(10.0, lambda: None)
    handle = publisher.handle
    with handle:
        trace("destroyed", node.destroy_publisher(publisher))
        attempt(trace, "inside", lambda: publisher.publish(Int32()))
    attempt(trace, "publish", lambda: publisher.publish(Int32()))
    attempt(trace, "name", lambda: publisher.topic_name)
    node.destroy_timer(timer)
    attempt(trace, "timer", timer.is_ready)
    node.destroy_node()
    attempt(trace, "node", lambda: node.create_publisher(Int32, "e18", 10))
    attempt(trace, "subscription", lambda: node.create_subscription(Int32, "e", print, 10))
    attempt(trace, "service", lambda: node.create_client(ListParameters, "e"))
    attempt(trace, "get_name", node.get_name)
    attempt(trace, "destroy again", node.destroy_node)
    trace("is", issubclass(InvalidHandle, Exception))


@scene
def e19_modules_are_attributes(trace: Trace) -> None:
    for name in ("context", "parameter", "signals", "task", "utilities"):
        trace(name, hasattr(rclpy, name))
    for name in ("executors", "qos", "clock", "callback_groups", "timer", "exceptions", "logging"):
        trace(name, hasattr(rclpy, name))


@scene
def e20_guard_conditions_and_wait_for_message(trace: Trace) -> None:
    node = rclpy.create_node("e20")
    trace("none", wait_for_message(Int32, node, "e20", time_to_wait=0.2))
    publisher = node.create_publisher(Int32, "e20", 10)
    stop = threading.Event()

    def publish() -> None:
        while not stop.wait(0.05):
            publisher.publish(Int32(data=20))

    worker = threading.Thread(target=publish)
    worker.start()
    found, msg = wait_for_message(Int32, node, "e20", time_to_wait=10.0)
    stop.set()
    worker.join()
    trace("found", found, msg.data)
    guard = node.create_guard_condition(lambda: trace("guard", thread_name()))
    worker = threading.Thread(target=guard.trigger)
    worker.start()
    worker.join()
    rclpy.spin_once(node, timeout_sec=1.0)


# Each group of the API


@scene
def topics_callbacks_and_their_arguments(trace: Trace) -> None:
    node = rclpy.create_node("topics")
    finished: Future = Future()

    def with_info(msg: Int32, info: Any) -> None:
        trace("info", sorted(info), msg.data)
        finished.set_result(None)

    publisher, subscription = matched_pair(node, "topics", with_info)
    trace("names", publisher.topic_name, publisher.topic, subscription.topic_name)
    attempt(trace, "wrong type", lambda: publisher.publish(String()))
    attempt(trace, "no message", lambda: publisher.publish(None))
    publisher.publish(serialize_message(Int32(data=5)))
    rclpy.spin_until_future_complete(node, finished, timeout_sec=10.0)
    attempt(trace, "three", lambda: node.create_subscription(Int32, "t", lambda a, b, c: 0, 1))
    attempt(trace, "none", lambda: node.create_subscription(Int32, "t", lambda: 0, 1))
    raw: list[Any] = []
    node.create_subscription(Int32, "topics", raw.append, 10, raw=True)
    until(lambda: publisher.get_subscription_count() == 2)
    publisher.publish(Int32(data=6))
    until(lambda: raw, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace("raw", type(raw[0]).__name__, deserialize_message(raw[0], Int32).data)


@scene
def names_that_are_invalid(trace: Trace) -> None:
    attempt(trace, "node", lambda: rclpy.create_node("wrong name"))
    attempt(trace, "namespace", lambda: rclpy.create_node("n", namespace="/wrong name"))
    node = rclpy.create_node("names", namespace="ns")
    trace("namespace", node.get_namespace(), node.get_fully_qualified_name())
    attempt(trace, "topic", lambda: node.create_publisher(Int32, "wrong topic", 1))
    attempt(trace, "service", lambda: node.create_client(ListParameters, "wrong service"))
    attempt(trace, "depth", lambda: node.create_publisher(Int32, "t", -1))
    attempt(trace, "qos", lambda: node.create_publisher(Int32, "t", "10"))
    attempt(trace, "profile", QoSProfile)
    trace("resolved", node.resolve_topic_name("~/a"), node.resolve_service_name("b"))
    attempt(trace, "count", lambda: node.count_publishers("42"))
    attempt(trace, "of nobody", lambda: node.get_publisher_names_and_types_by_node("nobody", "/"))


@scene
def arguments_rename_and_set(trace: Trace) -> None:
    arguments = ["-r", "__node:=renamed", "-r", "chatter:=/talk", "-p", "speed:=3"]
    node = rclpy.create_node("args", cli_args=["--ros-args", *arguments])
    trace(node.get_name(), node.resolve_topic_name("chatter"))
    trace(node.declare_parameter("speed", 1).value)
    attempt(trace, "type", lambda: node.declare_parameter("other", 1, ParameterDescriptor()).value)
    attempt(trace, "unknown", lambda: rclpy.create_node("a", cli_args=["--ros-args", "what"]))
    trace("rest", rclpy.utilities.remove_ros_args(["prog", "--ros-args", "-r", "a:=b", "--", "x"]))


@scene
def timers(trace: Trace) -> None:
    node = rclpy.create_node("timers")
    calls: list[int] = []
    timer = node.create_timer(0.02, lambda: calls.append(1))
    trace("period", timer.timer_period_ns, timer.is_canceled(), timer.is_ready())
    until(lambda: len(calls) >= 3, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace("called", len(calls) >= 3)
    timer.cancel()
    trace("cancelled", timer.is_canceled(), timer.time_until_next_call())
    timer.reset()
    trace("reset", timer.is_canceled())
    timer.timer_period_ns = 10**12
    trace("changed", timer.timer_period_ns)
    node.destroy_timer(timer)
    finished: Future = Future()

    def with_info(info: TimerInfo) -> None:
        trace("info", info.actual_call_time >= info.expected_call_time)
        finished.set_result(None)

    with_info.__annotations__["info"] = TimerInfo  # rclpy takes no text for it
    second = node.create_timer(0.01, with_info)
    rclpy.spin_until_future_complete(node, finished, timeout_sec=10.0)
    second.cancel()
    waiting = node.create_timer(0.01, lambda: trace("never"), autostart=False)
    rclpy.spin_once(node, timeout_sec=0.1)
    trace("autostart", waiting.is_canceled())
    attempt(trace, "negative", lambda: node.create_timer(-1.0, lambda: None))
    attempt(trace, "rate", lambda: node.create_rate(0))


@scene
def parameters(trace: Trace) -> None:
    node = rclpy.create_node("parameters", parameter_overrides=[Parameter("given", value=7)])
    trace("override", node.declare_parameter("given", 1).value)
    trace("ignored", node.declare_parameter("other", 2).value)
    attempt(trace, "twice", lambda: node.declare_parameter("other", 3))
    attempt(trace, "unknown", lambda: node.get_parameter("unknown"))
    attempt(trace, "set unknown", lambda: node.set_parameters([Parameter("unknown", value=1)]))
    attempt(trace, "empty", lambda: node.declare_parameter("", 3))
    result = node.set_parameters([Parameter("other", value="text")])[0]
    trace("type", result.successful, result.reason)
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    result = node.set_parameters([Parameter("fixed", value=2)])[0]
    trace("read-only", result.successful, result.reason)
    attempt(trace, "undeclare", lambda: node.undeclare_parameter("fixed"))
    node.declare_parameter("typed", Parameter.Type.STRING)
    attempt(trace, "uninitialised", lambda: node.get_parameter("typed"))
    trace("or", node.get_parameter_or("typed", Parameter("typed", value="x")).value)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        node.declare_parameter("bare")
        trace("warned", len(caught))
    trace("bare", node.get_parameter("bare").value, node.describe_parameter("bare").dynamic_typing)
    for name in ("a.b.c", "a.b.d", "a.e"):
        node.declare_parameter(name, 0)
    trace("prefix", sorted(node.get_parameters_by_prefix("a")))
    found = node.list_parameters(["a"], 1)
    trace("list", sorted(found.names), sorted(found.prefixes))
    trace("types", node.get_parameter_type("other"), ParameterType.PARAMETER_INTEGER)


@scene
def parameter_callbacks_in_their_order(trace: Trace) -> None:
    node = rclpy.create_node("callbacks")
    node.declare_parameter("speed", 1)

    def before(parameters: list[Any]) -> list[Any]:
        trace("pre", [each.value for each in parameters])
        return [Parameter("speed", value=each.value + 1) for each in parameters]

    def check(parameters: list[Any]) -> Any:
        trace("on", [each.value for each in parameters])
        return SetParametersResult(successful=parameters[0].value < 10, reason="too fast")

    node.add_pre_set_parameters_callback(before)
    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(lambda all_: trace("post", [p.value for p in all_]))
    trace(node.set_parameters([Parameter("speed", value=4)])[0].successful)
    result = node.set_parameters_atomically([Parameter("speed", value=40)])
    trace(result.successful, result.reason, node.get_parameter("speed").value)
    node.remove_pre_set_parameters_callback(before)
    node.remove_on_set_parameters_callback(check)
    trace(node.set_parameters([Parameter("speed", value=40)])[0].successful)
    attempt(trace, "not callable", lambda: node.add_on_set_parameters_callback(3))


@scene
def graph_answers(trace: Trace) -> None:
    node = rclpy.create_node("graph", namespace="/here")
    node.create_publisher(Int32, "topic", QoSProfile(depth=5))
    node.create_subscription(Int32, "topic", lambda msg: None, 5)
    node.create_client(ListParameters, "asked")
    until(lambda: node.count_subscribers("topic"))
    trace(node.count_publishers("topic"), node.count_subscribers("topic"))
    info = node.get_publishers_info_by_topic("topic")[0]
    trace(info.node_name, info.node_namespace, info.topic_type, info.endpoint_type.name)
    trace(str(info.topic_type_hash), info.qos_profile.reliability.name)
    trace(dict(node.get_client_names_and_types_by_node("graph", "/here")))
    trace(node.count_clients("asked"), node.count_services("asked"))
    trace(dict(node.get_service_names_and_types()).get("/here/asked"))
    services = dict(node.get_service_names_and_types_by_node("graph", "/here"))
    trace(sorted(services))
    publishers = dict(node.get_publisher_names_and_types_by_node("graph", "/here"))
    trace({name: types for name, types in publishers.items() if name != "/rosout"})


@scene
def times_and_durations(trace: Trace) -> None:
    second = Duration(seconds=1)
    moment = Time(seconds=10, nanoseconds=5, clock_type=ClockType.ROS_TIME)
    trace(str(second), repr(second), str(moment), repr(moment))
    trace((moment + second).nanoseconds, (moment - second).nanoseconds)
    trace((moment - Time(seconds=4, clock_type=ClockType.ROS_TIME)).nanoseconds)
    attempt(trace, "mixed", lambda: moment - Time(seconds=1))
    attempt(trace, "compared", lambda: moment < Time(seconds=1))
    attempt(trace, "negative", lambda: Time(seconds=-1))
    attempt(trace, "too long", lambda: Duration(nanoseconds=2**63))
    stamp = moment.to_msg()
    trace(type(stamp).__module__, stamp.sec, stamp.nanosec, Time.from_msg(stamp) == moment)
    trace(Duration.from_msg(second.to_msg()) == second)


@scene
def qos_events_of_matches(trace: Trace) -> None:
    from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks

    node = rclpy.create_node("events")
    counts: list[Any] = []

    def matched(info: Any) -> None:
        counts.append((info.total_count, info.current_count, info.current_count_change))

    node.create_publisher(
        Int32, "events", 1, event_callbacks=PublisherEventCallbacks(matched=matched)
    )
    subscription = node.create_subscription(Int32, "events", lambda msg: None, 1)
    until(lambda: len(counts) == 1, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    node.destroy_subscription(subscription)
    until(lambda: len(counts) == 2, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace(counts)
    seen: list[Any] = []
    node.create_subscription(
        Int32,
        "events",
        lambda msg: None,
        1,
        event_callbacks=SubscriptionEventCallbacks(matched=seen.append),
    )
    until(lambda: seen, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace(seen[0].total_count, seen[0].current_count)


@scene
def services_with_coroutines(trace: Trace) -> None:
    node = rclpy.create_node("services")
    gate: Future = Future()

    async def answer(request: Any, response: Any) -> Any:
        await gate
        response.result.names = list(request.prefixes)
        return response

    service = node.create_service(ListParameters, "late", answer)
    client = node.create_client(ListParameters, "late")
    trace("names", service.service_name, client.service_name, client.srv_name)
    trace("ready", client.wait_for_service(10.0))
    future = client.call_async(ListParameters.Request(prefixes=["a"]))
    timer = node.create_timer(0.1, lambda: (timer.cancel(), gate.set_result(None)))
    rclpy.spin_until_future_complete(node, future, timeout_sec=2.0)  # as above
    trace("answer", list(future.result().result.names))
    broken = node.create_service(ListParameters, "broken", lambda request, response: None)
    other = node.create_client(ListParameters, "broken")
    other.wait_for_service(10.0)
    other.call_async(ListParameters.Request())
    attempt(trace, "no response", lambda: rclpy.spin(node))
    trace("destroyed", node.destroy_service(broken), node.destroy_service(service))


@scene
def tasks_of_an_executor(trace: Trace) -> None:
    executor = SingleThreadedExecutor()
    task = executor.create_task(lambda a, b: a + b, 1, b=2)
    trace("before", task.done())
    executor.spin_once(timeout_sec=1.0)
    trace("after", task.done(), task.result())

    async def work() -> str:
        return "coroutine"

    task = executor.create_task(work)
    executor.spin_until_future_complete(task, timeout_sec=5.0)
    trace(task.result())

    def fail() -> None:
        raise LookupError("gone")

    task = executor.create_task(fail)
    attempt(trace, "spin", lambda: executor.spin_once(timeout_sec=1.0))
    attempt(trace, "result", task.result)
    forever: Future = Future()
    executor.spin_until_future_complete(forever, timeout_sec=0.1)
    trace("timeout", forever.done())
    trace("shutdown", executor.shutdown())


@scene
def managed_nodes_go_through_their_states(trace: Trace) -> None:
    class Entity(ManagedEntity):
        def on_activate(self, state: State) -> Any:
            trace("entity", state)
            return TransitionCallbackReturn.SUCCESS

    class Talker(LifecycleNode):
        def on_configure(self, state: State) -> Any:
            trace("configure", type(state).__name__, state)
            self.talk = self.create_lifecycle_publisher(String, "talk", 10)
            self.add_managed_entity(Entity())
            return super().on_configure(state)

        def on_shutdown(self, state: State) -> Any:
            trace("shutdown", state)
            return TransitionCallbackReturn.FAILURE

    talker = Talker("talker")
    node = rclpy.create_node("listener")
    heard: list[str] = []
    node.create_subscription(String, "talk", lambda message: heard.append(message.data), 10)
    attempt(trace, "activate", lambda: talker.trigger_activate().name)
    trace("configured", talker.trigger_configure().name)
    until(talker.talk.get_subscription_count)
    trace("activated before", talker.talk.is_activated)
    talker.talk.publish(String(data="inactive"))
    trace("activated", talker.trigger_activate().name, talker.talk.is_activated)
    talker.talk.publish(String(data="active"))
    until(lambda: heard, lambda: rclpy.spin_once(node, timeout_sec=0.1))
    trace("deactivated", talker.trigger_deactivate().name, talker.talk.is_activated)
    talker.talk.publish(String(data="inactive again"))
    rclpy.spin_once(node, timeout_sec=0.2)
    trace("heard", heard)
    attempt(trace, "entity", lambda: talker.add_managed_entity(Talker))
    trace("destroyed", talker.destroy_lifecycle_publisher(talker.talk))
    trace("shut down", talker.trigger_shutdown().name)
    attempt(trace, "again", talker.trigger_shutdown)
    attempt(trace, "after that", lambda: talker.trigger_configure().name)


@scene
def callbacks_of_managed_nodes_that_fail(trace: Trace) -> None:
    class Failing(LifecycleNode):
        outcome: Any = None
        after_error: Any = TransitionCallbackReturn.SUCCESS

        def on_configure(self, state: State) -> Any:
            if isinstance(self.outcome, Exception):
                raise self.outcome
            return self.outcome

        def on_error(self, state: State) -> Any:
            trace("error", state)
            return self.after_error

        @property
        def label(self) -> str:
            return self._state_machine.current_state[1]

    for number, (outcome, after_error) in enumerate(
        (
            (TransitionCallbackReturn.FAILURE, TransitionCallbackReturn.SUCCESS),
            (TransitionCallbackReturn.ERROR, TransitionCallbackReturn.SUCCESS),
            (TransitionCallbackReturn.ERROR, TransitionCallbackReturn.FAILURE),
            (LookupError("gone"), TransitionCallbackReturn.ERROR),
            (None, TransitionCallbackReturn.SUCCESS),
        )
    ):
        node = Failing(f"failing{number}", enable_communication_interface=False)
        node.outcome, node.after_error = outcome, after_error
        attempt(trace, number, lambda node=node: node.trigger_configure().name)
        trace(number, node.label)


def managed_and_manager(note: Callable[[Any], None]) -> tuple[Any, Any, Any]:
    """Return a managed node, one that records its transitions, and the executor of both."""
    managed = LifecycleNode("managed")
    node = rclpy.create_node("manager")
    executor = SingleThreadedExecutor()
    executor.add_node(managed)
    executor.add_node(node)
    node.create_subscription(TransitionEvent, "managed/transition_event", note, 10)
    return managed, node, executor


@scene
def services_of_managed_nodes(trace: Trace) -> None:
    events: list[tuple[str, str]] = []
    managed, node, executor = managed_and_manager(
        lambda event: events.append((event.start_state.label, event.goal_state.label))
    )
    until(lambda: node.count_publishers("managed/transition_event"))

    def call(service: Any, name: str, request: Any) -> Any:
        client = node.create_client(service, f"managed/{name}")
        client.wait_for_service(PATIENCE_S)
        future = client.call_async(request)
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)
        return future.result()

    until(lambda: managed.count_subscribers("managed/transition_event"))
    for id_, label in ((0, "activate"), (3, "configure"), (3, ""), (99, ""), (4, "no such")):
        request = ChangeState.Request()
        request.transition.id, request.transition.label = id_, label
        trace(id_, label, call(ChangeState, "change_state", request).success)
        state = call(GetState, "get_state", GetState.Request()).current_state
        trace(state.id, state.label)
    until(lambda: len(events) == 4, lambda: executor.spin_once(timeout_sec=0.1))
    trace("events", events)
    states = call(GetAvailableStates, "get_available_states", GetAvailableStates.Request())
    trace([(state.id, state.label) for state in states.available_states])
    for name in ("get_available_transitions", "get_transition_graph"):
        found = call(GetAvailableTransitions, name, GetAvailableTransitions.Request())
        trace(
            name,
            [
                (
                    each.transition.id,
                    each.transition.label,
                    each.start_state.label,
                    each.goal_state.label,
                )
                for each in found.available_transitions
            ],
        )


@scene
def events_and_response_of_a_transition(trace: Trace) -> None:
    order: list[str] = []
    managed, node, executor = managed_and_manager(
        lambda event: order.append(event.goal_state.label)
    )
    client = node.create_client(ChangeState, "managed/change_state")
    client.wait_for_service(PATIENCE_S)
    until(lambda: managed.count_subscribers("managed/transition_event"))
    for id_ in (1, 3, 4, 2):
        request = ChangeState.Request()
        request.transition.id = id_
        client.call_async(request).add_done_callback(lambda _: order.append("response"))
        until(lambda: len(order) == 3, lambda: executor.spin_once(timeout_sec=0.1))
        # Whether the response comes before the second event is a race, in rclpy as well.
        order.remove("response")
        trace(id_, list(order), "response")
        order.clear()


def main() -> None:
    """Play the scenes, and print the traces."""
    traces: dict[str, list[Any]] = {}
    for name in sys.argv[1:] or SCENES:
        events: list[Any] = []
        rclpy.init(args=["program"])
        try:
            SCENES[name](lambda *what, events=events: events.append(what))
        except BaseException as error:  # noqa: BLE001  # a scene that breaks is a difference
            events.append(("the scene broke", type(error).__name__, str(error)))
        rclpy.try_shutdown()
        traces[name] = events
    print(json.dumps(traces), flush=True)  # noqa: T201  # a program prints
    if not rclpy.__name__.startswith("aionode"):
        os._exit(0)  # rclpy hangs at the end, now and then


if __name__ == "__main__":
    main()
