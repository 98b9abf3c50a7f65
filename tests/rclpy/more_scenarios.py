"""Further scenes of the differential tests: ``more_scenarios.py [name …]``, like `scenarios.py`.

Events of QoS, introspection of services, parameters of other nodes, logs, clocks, rates, futures,
waitables, and more calls than a server keeps.
"""

from __future__ import annotations

import threading
import time
import warnings
from collections.abc import Callable
from typing import Any

import action_scenarios  # noqa: F401  # its scenes
from rcl_interfaces.msg import Log, LoggerLevel, ParameterValue
from rcl_interfaces.srv import GetLoggerLevels, ListParameters, SetLoggerLevels
from scenarios import PATIENCE_S, Trace, attempt, main, scene, thread_name, until
from service_msgs.msg import ServiceEventInfo
from std_msgs.msg import Int32

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.clock import Clock, ClockType, JumpThreshold, ROSClock
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.guard_condition import GuardCondition
from rclpy.lifecycle import LifecycleState
from rclpy.lifecycle.managed_entity import SimpleManagedEntity
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.node import Node
from rclpy.parameter import Parameter, get_parameter_value, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_system_default,
)
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.task import Future
from rclpy.time import Time
from rclpy.timer import TimerInfo
from rclpy.waitable import NumberOfEntities, Waitable


def spin(node: Any) -> None:
    """Let one callback of a node run."""
    rclpy.spin_once(node, timeout_sec=0.1)


@scene
def qos_events_of_profiles_that_do_not_fit(trace: Trace) -> None:
    node = rclpy.create_node("mismatch")
    offered: list[Any] = []
    requested: list[Any] = []
    node.create_publisher(
        Int32,
        "mismatch",
        QoSProfile(depth=1, durability=DurabilityPolicy.VOLATILE),
        event_callbacks=PublisherEventCallbacks(incompatible_qos=offered.append),
    )
    node.create_subscription(
        Int32,
        "mismatch",
        lambda msg: trace("heard"),
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        event_callbacks=SubscriptionEventCallbacks(incompatible_qos=requested.append),
    )
    until(lambda: offered and requested, lambda: spin(node))
    for name, (event,) in (("offered", offered), ("requested", requested)):
        trace(name, event.total_count, event.total_count_change, str(event.last_policy_kind))


@scene
def qos_events_of_deadlines(trace: Trace) -> None:
    node = rclpy.create_node("deadline")
    profile = QoSProfile(depth=1, deadline=Duration(seconds=0.1))
    offered: list[Any] = []
    requested: list[Any] = []
    publisher = node.create_publisher(
        Int32,
        "deadline",
        profile,
        event_callbacks=PublisherEventCallbacks(deadline=offered.append),
    )
    node.create_subscription(
        Int32,
        "deadline",
        lambda msg: None,
        profile,
        event_callbacks=SubscriptionEventCallbacks(deadline=requested.append),
    )
    until(publisher.get_subscription_count)
    publisher.publish(Int32())
    until(lambda: len(offered) >= 2 and len(requested) >= 2, lambda: spin(node))
    for name, events in (("offered", offered), ("requested", requested)):
        first, second = events[:2]
        trace(name, first.total_count >= first.total_count_change >= 1)
        trace(name, second.total_count - first.total_count == second.total_count_change)


@scene
def qos_events_of_liveliness(trace: Trace) -> None:
    node = rclpy.create_node("liveliness")
    profile = QoSProfile(
        depth=1,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=0.5),
    )
    changes: list[Any] = []
    lost: list[Any] = []

    def changed(event: Any) -> None:
        changes.append(
            (
                event.alive_count,
                event.not_alive_count,
                event.alive_count_change,
                event.not_alive_count_change,
            )
        )

    node.create_subscription(
        Int32,
        "liveliness",
        lambda msg: None,
        profile,
        event_callbacks=SubscriptionEventCallbacks(liveliness=changed),
    )
    publisher = node.create_publisher(
        Int32,
        "liveliness",
        profile,
        event_callbacks=PublisherEventCallbacks(liveliness=lost.append),
    )
    until(publisher.get_subscription_count)
    publisher.assert_liveliness()
    until(lambda: len(changes) >= 2 and lost, lambda: spin(node))
    trace("lost", lost[0].total_count, lost[0].total_count_change)
    publisher.assert_liveliness()
    until(lambda: len(changes) >= 3, lambda: spin(node))
    trace("changes", changes[:3])


@scene
def services_tell_of_their_calls(trace: Trace) -> None:
    node = rclpy.create_node("introspection")
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def answer(request: Any, response: Any) -> Any:
        response.result.names = [*request.prefixes, "answered"]
        return response

    service = node.create_service(ListParameters, "told", answer)
    client = node.create_client(ListParameters, "told")
    events: list[Any] = []
    node.create_subscription(ListParameters.Event, "told/_service_event", events.append, 10)
    client.wait_for_service(PATIENCE_S)

    def call() -> None:
        future = client.call_async(ListParameters.Request(prefixes=["a"]))
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)

    call()
    trace("off", len(events))
    for state in (ServiceIntrospectionState.METADATA, ServiceIntrospectionState.CONTENTS):
        events.clear()
        for entity in (service, client):
            entity.configure_introspection(node.get_clock(), qos_profile_system_default, state)
        until(lambda: node.count_publishers("told/_service_event") == 2)
        time.sleep(0.3)  # until they are matched
        call()
        until(lambda: len(events) == 4, lambda: executor.spin_once(timeout_sec=0.1))
        for kind in ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED"):
            number = getattr(ServiceEventInfo, kind)
            (event,) = [each for each in events if each.info.event_type == number]
            trace(
                state.name,
                kind,
                [list(each.prefixes) for each in event.request],
                [list(each.result.names) for each in event.response],
            )
        numbers = {each.info.sequence_number for each in events}
        trace("one call", len(numbers), len({bytes(each.info.client_gid) for each in events}))
    service.configure_introspection(
        node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.OFF
    )
    until(lambda: node.count_publishers("told/_service_event") == 1)
    trace("switched off", node.count_publishers("told/_service_event"))


@scene
def parameters_of_another_node(trace: Trace) -> None:
    asked = rclpy.create_node("asked")
    asked.declare_parameter("speed", 1.5)
    asked.declare_parameter("name", "robot")
    node = rclpy.create_node("asking")
    executor = SingleThreadedExecutor()
    executor.add_node(asked)
    executor.add_node(node)
    client = AsyncParameterClient(node, "asked")
    trace("services", client.wait_for_services(PATIENCE_S), client.services_are_ready())

    def result(future: Any) -> Any:
        executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)
        return future.result()

    trace("list", sorted(result(client.list_parameters(depth=10)).result.names))
    values = result(client.get_parameters(["speed", "name"])).values
    trace("get", [value.type for value in values], values[0].double_value, values[1].string_value)
    trace("get unknown", [each.type for each in result(client.get_parameters(["what"])).values])
    answers = result(
        client.set_parameters([Parameter("speed", value=2.5), Parameter("name", value=3)])
    ).results
    trace("set", [(each.successful, each.reason) for each in answers])
    answer = result(
        client.set_parameters_atomically(
            [Parameter("speed", value=3.5), Parameter("name", value=3)]
        )
    ).result
    trace("atomically", answer.successful, asked.get_parameter("speed").value)
    trace("types", list(result(client.get_parameter_types(["speed", "name"])).types))
    (descriptor,) = result(client.describe_parameters(["speed"])).descriptors
    trace("describe", descriptor.name, descriptor.type, descriptor.read_only)
    answers = result(client.delete_parameters(["speed"])).results
    trace("delete", [each.successful for each in answers])
    called: list[Any] = []
    result(client.get_parameters(["name"], callback=called.append))
    until(lambda: called, lambda: executor.spin_once(timeout_sec=0.1))
    trace("callback", type(called[0]).__name__)


@scene
def handlers_of_parameter_events(trace: Trace) -> None:
    node = rclpy.create_node("handled")
    node.declare_parameter("speed", 1)
    node.declare_parameter("other", 1)
    handler = ParameterEventHandler(node)
    seen: list[Any] = []
    events: list[Any] = []
    each = handler.add_parameter_callback(
        parameter_name="speed",
        node_name="handled",
        callback=lambda parameter: seen.append((parameter.name, parameter.value.integer_value)),
    )
    handler.add_parameter_event_callback(callback=events.append)
    until(lambda: node.count_subscribers("/parameter_events"))
    time.sleep(0.3)  # until they are matched
    node.set_parameters([Parameter("other", value=2), Parameter("speed", value=2)])
    until(lambda: len(seen) == 1 and len(events) >= 2, lambda: spin(node))
    trace("seen", seen)
    trace("events", [[one.name for one in event.changed_parameters] for event in events])
    trace("from event", handler.get_parameter_from_event(events[-1], "speed", "handled").name)
    trace("not there", handler.get_parameter_from_event(events[-1], "what", "handled"))
    handler.remove_parameter_callback(each)
    node.set_parameters([Parameter("speed", value=3)])
    until(lambda: len(events) >= 3, lambda: spin(node))
    trace("removed", len(seen))
    attempt(trace, "again", lambda: handler.remove_parameter_callback(each))


@scene
def logs_and_their_levels(trace: Trace) -> None:
    node = rclpy.create_node("logs", namespace="/deep")
    logger = node.get_logger()
    child = logger.get_child("arm")
    trace("names", logger.name, child.name, get_logger("free").name)
    trace("effective", logger.get_effective_level().name, child.get_effective_level().name)
    logger.set_level(LoggingSeverity.ERROR)
    trace("error", child.get_effective_level().name, child.is_enabled_for(LoggingSeverity.WARN))
    child.set_level(LoggingSeverity.DEBUG)
    trace("debug", child.get_effective_level().name, logger.get_effective_level().name)
    trace("said", logger.info("hidden"), logger.is_enabled_for(LoggingSeverity.FATAL))
    logger.set_level(LoggingSeverity.FATAL)
    for number in range(3):
        trace("once", number, logger.error("hidden", once=True))
    attempt(trace, "both", lambda: logger.fatal("x", throttle_duration_sec=1))
    attempt(trace, "no level", lambda: logger.log("x", 3))
    attempt(trace, "no logger", lambda: get_logger(""))
    attempt(trace, "unset", lambda: child.set_level(LoggingSeverity.UNSET))
    trace("unset", child.get_effective_level().name)


@scene
def rates_let_threads_sleep(trace: Trace) -> None:
    node = rclpy.create_node("rates")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    worker = threading.Thread(target=executor.spin, daemon=True)
    worker.start()
    rate = node.create_rate(50.0)
    began = time.monotonic()
    for _ in range(5):
        rate.sleep()
    trace("slept", time.monotonic() - began > 0.05)
    trace("destroyed", node.destroy_rate(rate), node.destroy_rate(rate))
    attempt(trace, "sleep", rate.sleep)
    slow = node.create_rate(0.01)
    raised: list[str] = []

    def sleep() -> None:
        try:
            slow.sleep()
        except Exception as error:  # noqa: BLE001  # what is raised is traced
            raised.append(type(error).__name__)

    sleeper = threading.Thread(target=sleep)
    sleeper.start()
    time.sleep(0.2)
    rclpy.shutdown()
    sleeper.join(PATIENCE_S)
    worker.join(PATIENCE_S)
    trace("woken by shutdown", raised, sleeper.is_alive(), worker.is_alive())


@scene
def clocks_let_threads_sleep(trace: Trace) -> None:
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    trace("for", clock.sleep_for(Duration(seconds=0.05)))
    trace("until", clock.sleep_until(clock.now() + Duration(seconds=0.05)))
    trace("past", clock.sleep_until(clock.now() - Duration(seconds=0.05)))
    attempt(trace, "another clock", lambda: clock.sleep_until(Time(seconds=1)))
    attempt(trace, "context", lambda: clock.sleep_for(Duration(), context=rclpy.Context()))
    slept: list[Any] = []
    sleeper = threading.Thread(target=lambda: slept.append(clock.sleep_for(Duration(seconds=60))))
    sleeper.start()
    time.sleep(0.2)
    rclpy.shutdown()
    sleeper.join(PATIENCE_S)
    trace("woken by shutdown", slept)
    attempt(trace, "threshold", lambda: JumpThreshold(None, Duration(seconds=1)).min_forward)
    ros = ROSClock()
    trace("types", ros.clock_type.name, clock.clock_type.name, ros.ros_time_is_active)
    attempt(trace, "Clock of ROS", lambda: type(Clock(clock_type=ClockType.ROS_TIME)).__name__)


@scene
def timers_on_a_clock_that_is_set(trace: Trace) -> None:
    node = rclpy.create_node("set_clock")
    clock = ROSClock()
    clock._set_ros_time_is_active(True)

    def at(seconds: float) -> None:
        clock.set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))

    def state(name: str) -> None:
        until_ns, since_ns = timer.time_until_next_call(), timer.time_since_last_call()
        trace(name, timer.is_ready(), until_ns, since_ns)

    def called(info: TimerInfo) -> None:
        trace("call", info.expected_call_time.nanoseconds, info.actual_call_time.nanoseconds)

    called.__annotations__["info"] = TimerInfo  # rclpy takes no text for it
    at(10)
    timer = node.create_timer(1.0, called, clock=clock)
    state("new")
    at(10.5)
    state("before")
    for seconds in (11, 13, 13, 13, 15.5):
        at(seconds)
        state("due")
        spin(node)
        state("called")
    at(5)
    state("back")
    at(6.25)
    spin(node)
    state("again")
    timer.timer_period_ns = 500_000_000
    at(7)
    spin(node)
    state("faster")
    timer.cancel()
    at(9)
    trace("cancelled", timer.is_ready(), timer.time_until_next_call())
    timer.reset()
    state("reset")
    at(9.25)
    for active in (False, True):
        clock._set_ros_time_is_active(active)
        until_ns, since_ns = timer.time_until_next_call(), timer.time_since_last_call()
        trace("switched", timer.is_ready(), 2e8 < until_ns < 3e8, 2e8 < since_ns < 3e8)
    clock._set_ros_time_is_active(False)
    at(0)
    clock._set_ros_time_is_active(True)
    trace("without time", timer.is_ready())
    at(20)
    state("first time")


@scene
def futures_and_their_callbacks(trace: Trace) -> None:
    future: Future = Future()
    future.add_done_callback(lambda done: trace("callback", done.result(), thread_name()))
    worker = threading.Thread(target=lambda: future.set_result(3), name="setter")
    worker.start()
    worker.join()
    future.add_done_callback(lambda done: trace("late", done.result(), thread_name()))
    trace("done", future.done(), future.cancelled(), future.result(), future.exception())
    cancelled: Future = Future()
    cancelled.add_done_callback(lambda done: trace("cancelled callback", done.cancelled()))
    cancelled.cancel()
    trace("cancelled", cancelled.done(), cancelled.cancelled(), cancelled.result())
    failed: Future = Future()
    failed.set_exception(LookupError("gone"))
    attempt(trace, "failed", failed.result)
    trace("exception", type(failed.exception()).__name__)

    def never(done: Any) -> None:
        trace("never")

    removed: Future = Future()
    removed.add_done_callback(never)
    trace("removed", removed.remove_done_callback(never))
    removed.set_result(1)
    executor = SingleThreadedExecutor()
    waited: Future = Future(executor=executor)
    waited.add_done_callback(lambda done: trace("in the executor", done.result()))
    waited.set_result(2)
    trace("before the spin")
    executor.spin_once(timeout_sec=1.0)

    async def wait() -> Any:
        return (await future) + 1

    task = executor.create_task(wait)
    executor.spin_until_future_complete(task, timeout_sec=PATIENCE_S)
    trace("awaited", task.result())


class Ring(Waitable):
    """Rings when its guard condition was triggered."""

    def __init__(self, node: Any, trace: Trace) -> None:
        super().__init__(rclpy.callback_groups.MutuallyExclusiveCallbackGroup())
        self.guard = GuardCondition(None, None, context=node.context)
        self.trace = trace
        self.rung = False
        self.index = 0

    def is_ready(self, wait_set: Any) -> bool:
        if wait_set.is_ready("guard_condition", self.index):
            self.rung = True
        return self.rung

    def take_data(self) -> Any:
        rung, self.rung = self.rung, False
        return "rung" if rung else None

    async def execute(self, taken_data: Any) -> None:
        self.trace("execute", taken_data, thread_name())

    def get_num_entities(self) -> Any:
        return NumberOfEntities(num_gcs=1)

    def add_to_wait_set(self, wait_set: Any) -> None:
        self.index = wait_set.add_guard_condition(self.guard.handle)

    def __enter__(self) -> None:
        self.guard.handle.__enter__()

    def __exit__(self, *error: object) -> None:
        self.guard.handle.__exit__(*error)


@scene
def waitables_of_ones_own(trace: Trace) -> None:
    node = rclpy.create_node("waitables")
    ring = Ring(node, trace)
    node.add_waitable(ring)
    trace("member", ring in list(node.waitables), ring.callback_group.has_entity(ring))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_once(timeout_sec=0.1)
    threading.Timer(0.1, ring.guard.trigger).start()
    executor.spin_once(timeout_sec=PATIENCE_S)
    executor.spin_once(timeout_sec=0.1)
    node.remove_waitable(ring)
    trace("removed", ring in list(node.waitables))


@scene
def more_calls_than_the_server_keeps(trace: Trace) -> None:
    node = rclpy.create_node("many")
    answered: list[int] = []
    service = node.create_service(ListParameters, "many", lambda request, response: response)
    client = node.create_client(ListParameters, "many")
    client.wait_for_service(PATIENCE_S)
    futures = [client.call_async(ListParameters.Request()) for _ in range(2000)]
    for number, future in enumerate(futures):
        future.add_done_callback(lambda _, number=number: answered.append(number))
    quiet_since = time.monotonic()
    known = 0
    while time.monotonic() - quiet_since < 1.0:
        rclpy.spin_once(node, timeout_sec=0.05)
        if len(answered) > known:
            known, quiet_since = len(answered), time.monotonic()
    trace("some", 10 <= len(answered) < 2000, "in order", answered == sorted(answered))
    trace("the others", sum(future.done() for future in futures) == len(answered))
    future = client.call_async(ListParameters.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=PATIENCE_S)
    trace("the next", future.done())
    trace("destroyed", node.destroy_client(client), node.destroy_service(service))


@scene
def what_belongs_to_a_node(trace: Trace) -> None:
    node = rclpy.create_node("owner", start_parameter_services=False, enable_rosout=False)
    publisher = node.create_publisher(
        Int32, "owned", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    subscription = node.create_subscription(Int32, "owned", lambda msg: None, 1)
    timer = node.create_timer(10.0, lambda: None)
    guard = node.create_guard_condition(lambda: None)
    trace("publishers", publisher in list(node.publishers))
    trace("subscriptions", list(node.subscriptions) == [subscription])
    trace("timers", list(node.timers) == [timer], "guards", guard in list(node.guards))
    trace("services", len(list(node.services)), "clients", len(list(node.clients)))
    trace("profile", publisher.qos_profile.reliability.name, subscription.qos_profile.depth)
    trace("logger", publisher.logger_name, subscription.logger_name)
    with node.create_publisher(Int32, "short", 1) as short:
        trace("inside", short.topic_name)
    attempt(trace, "after", lambda: short.topic_name)
    trace("executor", node.executor)
    with MultiThreadedExecutor(num_threads=2) as executor:
        executor.add_node(node)
        trace("executor", node.executor is executor)
    trace("after", node.executor is executor, executor.get_nodes())


@scene
def questions_about_the_graph_check_names(trace: Trace) -> None:
    class Counting(Node):
        """Has its own attributes, like programs do."""

        def __init__(self) -> None:
            super().__init__("counting")
            self._count = self._nodes = self._of_node = None

    node = Counting()
    questions: dict[str, Callable[[], Any]] = {
        "nodes": lambda: node.get_node_names().count("counting"),
        "full names": lambda: node.get_fully_qualified_node_names().count("/counting"),
        "enclaves": lambda: node.get_node_names_and_namespaces_with_enclaves().count(
            ("counting", "/", "/")
        ),
        "topics": lambda: dict(node.get_topic_names_and_types()).get("/rosout"),
        "own": lambda: dict(node.get_publisher_names_and_types_by_node("counting", "")),
        "invalid node": lambda: node.get_service_names_and_types_by_node("a b", "/"),
        "invalid namespace": lambda: node.get_service_names_and_types_by_node("counting", "a b"),
        "subscribers": lambda: node.count_subscribers("nothing"),
        "invalid topic": lambda: node.count_subscribers("a b"),
        "clients": lambda: node.count_clients("/nothing"),
        "invalid service": lambda: node.count_clients("a b"),
        "info": lambda: node.get_subscriptions_info_by_topic("nothing"),
        "invalid info": lambda: node.get_publishers_info_by_topic("a b"),
        "complete info": lambda: node.get_publishers_info_by_topic("rt/nothing", no_mangle=True),
        "actions": lambda: get_action_names_and_types(node),
        "actions of": lambda: get_action_server_names_and_types_by_node(node, "counting", "/"),
        "nobody": lambda: node.get_client_names_and_types_by_node("nobody", "/"),
    }
    for what, question in questions.items():
        attempt(trace, what, question)
    try:
        get_action_client_names_and_types_by_node(node, "nobody", "/")
    except RCLError as error:
        trace("actions of nobody", isinstance(error, RuntimeError))
    node.destroy_node()
    for what, question in questions.items():
        attempt(trace, f"{what}, destroyed", question)


@scene
def log_levels_are_read_and_set_by_others(trace: Trace) -> None:
    node = Node("loud", enable_logger_service=True)
    told: list[Any] = []
    node.create_subscription(Log, "/rosout", told.append, 10)
    get = node.create_client(GetLoggerLevels, "loud/get_logger_levels")
    put = node.create_client(SetLoggerLevels, "loud/set_logger_levels")
    get.wait_for_service(PATIENCE_S)
    put.wait_for_service(PATIENCE_S)

    def ask(client: Any, request: Any) -> Any:
        future = client.call_async(request)
        rclpy.spin_until_future_complete(node, future, timeout_sec=PATIENCE_S)
        return future.result()

    wanted = [("loud", 10), ("loud", 99), ("quiet", 40), ("loud", 0), ("loud", 30)]
    levels = [LoggerLevel(name=name, level=level) for name, level in wanted]
    for result in ask(put, SetLoggerLevels.Request(levels=levels)).results:
        trace("set", result.successful, result.reason)
    for level in ask(get, GetLoggerLevels.Request(names=["loud", "unheard"])).levels:
        trace("get", level.name, level.level)
    trace("none", len(ask(get, GetLoggerLevels.Request()).levels))
    node.get_logger().info("not published")
    node.get_logger().warning("published")
    until(lambda: told, lambda: spin(node))
    trace("log", told[0].name, told[0].level, told[0].msg, told[0].function)


@scene
def names_that_public_programs_take_from_modules(trace: Trace) -> None:
    from rclpy.event_handler import UnsupportedEventTypeError
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.lifecycle.node import LifecycleState
    from rclpy.node import HIDDEN_NODE_PREFIX
    from rclpy.parameter import PARAMETER_SEPARATOR_STRING
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSPresetProfiles
    from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

    trace("expanded", expand_topic_name("~/scan", "driver", "/robot"))
    trace("hidden", topic_or_service_is_hidden("/robot/_secret"), HIDDEN_NODE_PREFIX)
    trace("shown", topic_or_service_is_hidden("/robot/scan"), PARAMETER_SEPARATOR_STRING)
    state = LifecycleState(label="active", state_id=3)
    trace("state", state.label, state.state_id)
    trace("an error of rcl", UnsupportedEventTypeError.__mro__[1].__name__)
    sensor = QoSPresetProfiles.SENSOR_DATA.value
    trace("sensor data", sensor.reliability.name, sensor.history.name, sensor.depth)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        kept = HistoryPolicy.RMW_QOS_POLICY_HISTORY_KEEP_LAST
        volatile = DurabilityPolicy.RMW_QOS_POLICY_DURABILITY_VOLATILE
    trace("former names", kept is HistoryPolicy.KEEP_LAST, volatile.name)
    trace("warnings", [each.category.__name__ for each in caught])


@scene
def texts_that_stand_for_parameters(trace: Trace) -> None:
    texts = "1|1.5|true|yes|null|~||abc|'5'|[1,2]|[1.5,2]|[1,2.5]|[true,false]|[a,b]|[a,1]|[]|[[1]]"
    for text in [*texts.split("|"), "0x10", ".inf", "1e3", "!!str 5", "[1, true]", "[1, 2", " 5 "]:
        message = get_parameter_value(text)
        trace(text, message.type, repr(parameter_value_to_python(message)))
    for value in ([b"a", b"\x00"], [1, 2], [0.5], ["a"], [True], None):
        message = Parameter("name", value=value).get_parameter_value()
        trace(repr(value), message.type, repr(parameter_value_to_python(message)))
        message = Parameter("name", value=value).to_parameter_msg()
        trace(repr(list(Parameter.from_parameter_msg(message).value or ())))
    unknown = ParameterValue(type=99)
    attempt(trace, "unknown type", lambda: parameter_value_to_python(unknown))


@scene
def methods_of_managed_entities(trace: Trace) -> None:
    class Entity(SimpleManagedEntity):
        @SimpleManagedEntity.when_enabled
        def work(self, number: int) -> int:
            trace("work", number)
            return number

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: trace("no work"))
        def other_work(self, *, number: int) -> int:
            trace("other work", number)
            return number

    entity = Entity()
    for change in (entity.on_configure, entity.on_activate, entity.on_deactivate, entity.on_error):
        trace(change(LifecycleState("inactive", 2)).name, entity.is_activated)
        trace("result", entity.work(1), entity.other_work(number=2))


if __name__ == "__main__":
    main()
