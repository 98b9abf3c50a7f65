"""Trees on a node, ticked by a timer, and watchers of the trees of other programs."""

from __future__ import annotations

import enum
import math
import statistics
import subprocess
import tempfile
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from shutil import which
from typing import Any, Final

import diagnostic_msgs.msg
import py_trees
import py_trees.console
import py_trees_ros_interfaces.msg
from py_trees.blackboard import Blackboard
from py_trees.common import Duration
from py_trees_ros_interfaces import srv
from rcl_interfaces.msg import (
    FloatingPointRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)

import rclpy
import rclpy.exceptions
from aionode.clock import S_TO_NS, MachineTime
from py_trees_ros import blackboard, conversions, exceptions, utilities, visitors
from rclpy.clock import Clock
from rclpy.node import Node
from rclpy.time import Time

__all__ = ["BehaviourTree", "SnapshotStream", "Watcher", "WatcherMode"]

console = py_trees.console

CLOSE_ENOUGH: Final = 0.98
"""The share of a period after which a snapshot is due, as ticks may be a little early."""
TICKS_COUNTED: Final = 10
INDENT: Final = " " * 4
WIDTH: Final = 80


class SnapshotStream:
    """Publishes snapshots of a tree.

    Args:
        node: The node that publishes.
        topic_name: The topic, as `expand_topic_name` accepts it.
        parameters: What is published, and how often.
    """

    _counter = 0

    class Parameters:
        """What is published, and how often.

        Args:
            blackboard_data: Whether to include the variables that behaviours of the last tick use.
            blackboard_activity: Whether to include who read and wrote them.
            snapshot_period: The seconds after which an unchanged tree is published again.
        """

        def __init__(
            self,
            blackboard_data: bool = False,
            blackboard_activity: bool = False,
            snapshot_period: Any = Duration.INFINITE,
        ) -> None:
            self.blackboard_data = blackboard_data
            self.blackboard_activity = blackboard_activity
            self.snapshot_period = getattr(snapshot_period, "value", snapshot_period)

    def __init__(
        self, node: Any, topic_name: str | None = None, parameters: Parameters | None = None
    ) -> None:
        self.node = node
        self.topic_name = SnapshotStream.expand_topic_name(node, topic_name)
        self.publisher = node.create_publisher(
            py_trees_ros_interfaces.msg.BehaviourTree,
            self.topic_name,
            utilities.qos_profile_latched(),
        )
        self.parameters = SnapshotStream.Parameters() if parameters is None else parameters
        self.last_snapshot_timestamp: float | None = None
        self.statistics = None

    @staticmethod
    def expand_topic_name(node: Any, topic_name: str | None) -> str:
        """Return the full name of a topic for snapshots.

        Args:
            node: The node that publishes.
            topic_name: A name that begins with a slash or tilde, or one relative to
                ``~/snapshot_streams``; by default, an unused name there.
        """
        if not topic_name:
            topic_name = f"_snapshots_{SnapshotStream._counter}"
            SnapshotStream._counter += 1
        if topic_name.startswith("/"):
            return topic_name
        if not topic_name.startswith("~"):
            topic_name = f"~/snapshot_streams/{topic_name}"
        return utilities.resolve_name(node, topic_name)

    def publish(
        self,
        root: Any,
        changed: bool,
        statistics: Any,
        visited_behaviour_ids: Iterable[Any],
        visited_blackboard_client_ids: Iterable[Any],
    ) -> None:
        """Publish a tree if it has changed or the period is over.

        Args:
            root: The tree.
            changed: Whether it has.
            statistics: The message with the times of its ticks, or None.
            visited_behaviour_ids: The behaviours of the last tick.
            visited_blackboard_client_ids: Their blackboard clients.
        """
        now = MachineTime.steady_ns() / S_TO_NS
        last = self.last_snapshot_timestamp
        if last is None:
            changed = True
        elif not changed and now - last < CLOSE_ENOUGH * self.parameters.snapshot_period:
            return
        visited = set(visited_behaviour_ids)
        message = py_trees_ros_interfaces.msg.BehaviourTree(changed=changed)
        for behaviour in root.iterate():
            part = conversions.behaviour_to_msg(behaviour)
            part.is_active = behaviour.id in visited
            message.behaviours.append(part)
        if self.parameters.blackboard_data:
            keys = Blackboard.keys_filtered_by_clients(client_ids=visited_blackboard_client_ids)
            message.blackboard_on_visited_path = [
                diagnostic_msgs.msg.KeyValue(
                    key=key,
                    value=str(Blackboard.get(key)) if blackboard.is_there(key) else "-",
                )
                for key in keys
            ]
        if self.parameters.blackboard_activity and Blackboard.activity_stream is not None:
            message.blackboard_activity = conversions.activity_stream_to_msgs()
        if statistics is not None:
            message.statistics = statistics
        self.publisher.publish(message)
        self.last_snapshot_timestamp = now

    def shutdown(self) -> None:
        """Destroy the publisher."""
        self.node.destroy_publisher(self.publisher)


class BehaviourTree(py_trees.trees.BehaviourTree):
    """A tree on a node, which other programs can watch.

    Its node has the parameters ``default_snapshot_stream`` (whether ``~/snapshots`` is published),
    ``default_snapshot_period``, ``default_snapshot_blackboard_data``,
    ``default_snapshot_blackboard_activity`` and ``setup_timeout``, and the services ``open``,
    ``close`` and ``reconfigure`` in ``~/snapshot_streams``, besides those of an `Exchange`.

    Args:
        root: The root behaviour.
        unicode_tree_debug: Whether to print each tick.
    """

    def __init__(self, root: Any, unicode_tree_debug: bool = False) -> None:
        super().__init__(root)
        self.snapshot_visitor = (
            py_trees.visitors.DisplaySnapshotVisitor()
            if unicode_tree_debug
            else py_trees.visitors.SnapshotVisitor()
        )
        self.visitors.append(self.snapshot_visitor)
        self.statistics: Any = None
        self.tick_start_time = None
        self.time_series: deque[float] = deque(maxlen=TICKS_COUNTED)
        self.tick_interval_series: deque[float] = deque(maxlen=TICKS_COUNTED)
        self.tick_duration_series: deque[float] = deque(maxlen=TICKS_COUNTED)
        self.pre_tick_handlers.append(self._statistics_pre_tick_handler)
        self.post_tick_handlers.append(self._statistics_post_tick_handler)
        self.timer: Any = None
        self.node: Any = None
        self.snapshot_streams: dict[str, SnapshotStream] = {}

    def setup(
        self,
        node: Any = None,
        node_name: str = "tree",
        timeout: Any = Duration.INFINITE,
        visitor: Any = None,
        **kwargs: Any,
    ) -> None:
        """Create the topics and services for watchers, and set up each behaviour with ``node``.

        Args:
            node: The node; None to create one.
            node_name: The name of a node that is created.
            timeout: How long setup may take, in seconds, unless the parameter sets it.
            visitor: Visits each behaviour after it is set up; by default, one that logs times.
            **kwargs: Further arguments for each behaviour.

        Raises:
            TypeError: The node is not an rclpy node.
            TimedOutError: It takes too long.
        """
        if node is not None and not isinstance(node, Node):
            raise TypeError(
                f"invalid node object [received: {type(node)}][expected: rclpy.node.Node]"
            )
        self.node = rclpy.create_node(node_name) if node is None else node
        self.default_snapshot_stream_topic_name = SnapshotStream.expand_topic_name(
            self.node, "~/snapshots"
        )
        self.snapshot_stream_services = utilities.Services(
            self.node,
            [
                (
                    name,
                    f"~/snapshot_streams/{name}",
                    getattr(srv, f"{name.capitalize()}SnapshotStream"),
                    getattr(self, f"_{name}_snapshot_stream"),
                )
                for name in ("close", "open", "reconfigure")
            ],
            introspection_topic_name="snapshot_streams/services",
        )
        self.blackboard_exchange = blackboard.Exchange()
        self.blackboard_exchange.setup(self.node)
        self.node.add_on_set_parameters_callback(self._set_parameters_callback)
        timeout = self._declare(getattr(timeout, "value", timeout))
        try:
            super().setup(
                timeout=Duration.INFINITE if timeout == Duration.INFINITE.value else timeout,
                visitor=visitors.SetupLogger(node=self.node) if visitor is None else visitor,
                node=self.node,
                **kwargs,
            )
        except RuntimeError as error:
            if str(error) == "tree setup interrupted or timed out":
                raise exceptions.TimedOutError(str(error)) from error
            raise
        self.tree_update_handler = self._on_tree_update_handler
        self.post_tick_handlers.append(self._snapshots_post_tick_handler)

    def _declare(self, timeout: float) -> float:
        """Declare the parameters, and return the setup timeout."""
        for name, value, description in (
            ("stream", False, "enable/disable the default snapshot stream in ~/snapshots"),
            ("period", 2.0, "time between snapshots, math.inf for changes of the tree alone"),
            ("blackboard_data", True, "append visited variables to the default snapshot stream"),
            ("blackboard_activity", False, "append activities to the default snapshot stream"),
        ):
            name = f"default_snapshot_{name}"  # noqa: PLW2901  # the full name
            self.node.declare_parameter(name, value, described(name, value, description))
        name = "setup_timeout"
        descriptor = described(name, timeout, "timeout for ROS tree setup (node, pubs, subs, ...)")
        descriptor.read_only = True
        return float(self.node.declare_parameter(name, float(timeout), descriptor).value)

    def _set_parameters_callback(self, parameters: list[Any]) -> Any:
        stream = self.snapshot_streams.get(self.default_snapshot_stream_topic_name)
        for parameter in parameters:
            name = parameter.name.removeprefix("default_snapshot_")
            if name == "stream":
                if stream is not None:
                    self._close(stream)
                stream = self._open(*self._default()) if parameter.value else None
            elif stream is not None and name == "blackboard_data":
                stream.parameters.blackboard_data = parameter.value
            elif stream is not None and name == "blackboard_activity":
                self._show_activity(stream, parameter.value)
            elif stream is not None and name == "period":
                stream.parameters.snapshot_period = parameter.value
        return SetParametersResult(successful=True)

    def _default(self) -> tuple[str, SnapshotStream.Parameters]:
        """Return the topic and the settings of the stream that parameters open."""
        try:
            period, data, activity = (
                self.node.get_parameter(f"default_snapshot_{name}").value
                for name in ("period", "blackboard_data", "blackboard_activity")
            )
        except rclpy.exceptions.ParameterNotDeclaredException:  # they follow, and are set then
            settings = SnapshotStream.Parameters()
        else:
            settings = SnapshotStream.Parameters(data, activity, period)
        return self.default_snapshot_stream_topic_name, settings

    def _open(self, topic: str | None, settings: SnapshotStream.Parameters) -> SnapshotStream:
        stream = SnapshotStream(self.node, topic, settings)
        if settings.blackboard_activity:
            self.blackboard_exchange.register_activity_stream_client()
        self.snapshot_streams[stream.topic_name] = stream
        return stream

    def _close(self, stream: SnapshotStream) -> None:
        stream.shutdown()
        if stream.parameters.blackboard_activity:
            self.blackboard_exchange.unregister_activity_stream_client()
        del self.snapshot_streams[stream.topic_name]

    def _show_activity(self, stream: SnapshotStream, shown: bool) -> None:
        if shown and not stream.parameters.blackboard_activity:
            self.blackboard_exchange.register_activity_stream_client()
        elif stream.parameters.blackboard_activity and not shown:
            self.blackboard_exchange.unregister_activity_stream_client()
        stream.parameters.blackboard_activity = shown

    def tick_tock(
        self,
        period_ms: float,
        number_of_iterations: int = py_trees.trees.CONTINUOUS_TICK_TOCK,
        pre_tick_handler: Callable[[Any], None] | None = None,
        post_tick_handler: Callable[[Any], None] | None = None,
    ) -> None:
        """Start a timer that ticks the tree while the node spins, and return at once.

        Args:
            period_ms: The time between two ticks, in milliseconds.
            number_of_iterations: How often to tick; forever by default.
            pre_tick_handler: Called with the tree before each tick.
            post_tick_handler: Called with the tree after each tick.
        """
        self.tick_tock_count = 0
        self.timer = self.node.create_timer(
            period_ms / 1000.0,
            partial(
                self._tick_tock_timer_callback,
                number_of_iterations,
                pre_tick_handler,
                post_tick_handler,
            ),
        )

    def _tick_tock_timer_callback(
        self, number_of_iterations: int, pre_tick_handler: Any, post_tick_handler: Any
    ) -> None:
        endless = number_of_iterations == py_trees.trees.CONTINUOUS_TICK_TOCK
        if endless or self.tick_tock_count < number_of_iterations:
            self.tick(pre_tick_handler, post_tick_handler)
            self.tick_tock_count += 1
        else:
            self.timer.cancel()

    def shutdown(self) -> None:
        """Stop the timer, shut the behaviours down, and destroy the node."""
        if self.node is not None and self.timer is not None:
            self.timer.cancel()
            self.node.destroy_timer(self.timer)
        super().shutdown()
        if self.node is not None:
            self.node.destroy_node()

    def _on_tree_update_handler(self) -> None:
        """Publish a tree to which a branch was added, or from which one was removed."""
        if self.statistics is not None:
            self.statistics.stamp = Clock().now().to_msg()
            self._publish_snapshots(changed=True)

    def _publish_snapshots(self, *, changed: bool) -> None:
        for stream in self.snapshot_streams.values():
            stream.publish(
                root=self.root,
                changed=changed,
                statistics=self.statistics,
                visited_behaviour_ids=self.snapshot_visitor.visited.keys(),
                visited_blackboard_client_ids=self.snapshot_visitor.visited_blackboard_client_ids,
            )

    def _statistics_pre_tick_handler(self, tree: Any) -> None:
        now = Clock().now()
        begun = conversions.rclpy_time_to_float(now)
        self.tick_interval_series.append(begun - self.time_series[-1] if self.time_series else 0.0)
        self.time_series.append(begun)
        average, variance = spread(self.tick_interval_series)
        self.statistics = py_trees_ros_interfaces.msg.Statistics(
            count=self.count,
            stamp=now.to_msg(),
            tick_interval=self.tick_interval_series[-1],
            tick_interval_average=average,
            tick_interval_variance=variance,
        )

    def _statistics_post_tick_handler(self, tree: Any) -> None:
        duration = conversions.rclpy_time_to_float(Clock().now()) - self.time_series[-1]
        self.tick_duration_series.append(duration)
        average, variance = spread(self.tick_duration_series)
        self.statistics.tick_duration = duration
        self.statistics.tick_duration_average = average
        self.statistics.tick_duration_variance = variance

    def _snapshots_post_tick_handler(self, tree: Any) -> None:
        if self.root.tip() is None:
            self.node.get_logger().error(
                "the root behaviour failed to return a tip [hint: tree is in an INVALID state, "
                "usually as a result of incorrectly coded behaviours]"
            )
            return
        self._publish_snapshots(changed=self.snapshot_visitor.changed)
        self.blackboard_exchange.post_tick_handler(
            visited_client_ids=self.snapshot_visitor.visited_blackboard_client_ids
        )

    def _close_snapshot_stream(self, request: Any, response: Any) -> Any:
        stream = self.snapshot_streams.get(request.topic_name)
        response.result = stream is not None
        if stream is not None:
            self._close(stream)
        return response

    def _open_snapshot_stream(self, request: Any, response: Any) -> Any:
        asked = request.parameters
        settings = SnapshotStream.Parameters(
            asked.blackboard_data, asked.blackboard_activity, asked.snapshot_period
        )
        topic = SnapshotStream.expand_topic_name(self.node, request.topic_name)
        if topic in self.snapshot_streams:
            self._close(self.snapshot_streams[topic])
        if len(self.snapshot_streams) == blackboard.MAX_STREAMS:
            default = self.default_snapshot_stream_topic_name
            self._close(next(s for name, s in self.snapshot_streams.items() if name != default))
        response.topic_name = self._open(topic, settings).topic_name
        return response

    def _reconfigure_snapshot_stream(self, request: Any, response: Any) -> Any:
        stream = self.snapshot_streams.get(request.topic_name)
        response.result = stream is not None
        if stream is not None:
            self._show_activity(stream, request.parameters.blackboard_activity)
            stream.parameters.blackboard_data = request.parameters.blackboard_data
            stream.parameters.snapshot_period = request.parameters.snapshot_period
        return response


def described(name: str, value: bool | float, description: str) -> Any:
    """Return the description of a parameter."""
    if isinstance(value, bool):
        kind, ranges = ParameterType.PARAMETER_BOOL, []
    else:
        kind = ParameterType.PARAMETER_DOUBLE
        ranges = [FloatingPointRange(from_value=0.0, to_value=Duration.INFINITE.value)]
    return ParameterDescriptor(
        name=name, type=kind, description=description, floating_point_range=ranges
    )


def spread(values: deque[float]) -> tuple[float, float]:
    """Return the mean and the variance of at least one value."""
    mean = sum(values) / len(values)
    return mean, statistics.variance(values, mean) if len(values) > 1 else 0.0


class WatcherMode(enum.Enum):
    """How a `Watcher` shows trees."""

    SNAPSHOTS = "SNAPSHOTS"
    """Prints each snapshot."""
    DOT_GRAPH = "DOT_GRAPH"
    """Draws the first one with xdot if it is installed, or prints it for Graphviz."""


class Watcher:
    """Shows the tree of another process.

    Args:
        topic_name: The topic of its snapshots; None to ask its node to open one.
        namespace_hint: A part of the names of its services, if there are several trees.
        parameters: What to request and show.
        statistics: Whether to show the times of ticks.
        mode: How to show the tree.
    """

    def __init__(
        self,
        topic_name: str | None = None,
        namespace_hint: str | None = None,
        parameters: SnapshotStream.Parameters | None = None,
        statistics: bool = False,
        mode: WatcherMode = WatcherMode.SNAPSHOTS,
    ) -> None:
        self.topic_name = topic_name
        self.namespace_hint = namespace_hint
        self.mode = mode
        self.parameters = SnapshotStream.Parameters() if parameters is None else parameters
        self.statistics = statistics
        self.node: Any = None
        self.subscriber: Any = None
        self.snapshot_visitor = py_trees.visitors.SnapshotVisitor()
        self.done = False
        self.xdot_process: subprocess.Popen[bytes] | None = None
        self.rendered = False
        self.services: dict[str, Any] = {"open": None, "close": None}
        self.service_names: dict[str, str | None] = {"open": None, "close": None}
        self.service_types = {"open": srv.OpenSnapshotStream, "close": srv.CloseSnapshotStream}
        self.service_type_strings = {
            key: f"py_trees_ros_interfaces/srv/{cls.__name__}"
            for key, cls in self.service_types.items()
        }

    def setup(self, timeout_sec: float) -> None:
        """Create a node, ask the tree's node to open a stream, and subscribe to it.

        Raises:
            NotFoundError: There is no tree.
            MultipleFoundError: There are several.
            TimedOutError: Nobody publishes snapshots, or a service does not answer.
        """
        self.node = rclpy.create_node(
            utilities.create_anonymous_node_name(node_name="tree_watcher"),
            start_parameter_services=False,
        )
        if self.topic_name is None:
            for key in self.service_names:
                self.service_names[key] = utilities.find_service(
                    node=self.node,
                    service_type=self.service_type_strings[key],
                    namespace=self.namespace_hint,
                    timeout=timeout_sec,
                )
                self.services[key] = self.create_service_client(key)
            request = self.service_types["open"].Request()
            request.parameters.blackboard_data = self.parameters.blackboard_data
            request.parameters.blackboard_activity = self.parameters.blackboard_activity
            request.parameters.snapshot_period = self.parameters.snapshot_period
            self.topic_name = self._call("open", request, timeout_sec).topic_name
        topic = self.topic_name
        if not utilities.wait_until(lambda: self.node.count_publishers(topic) > 0, timeout_sec):
            raise exceptions.TimedOutError(
                f"timed out waiting for a snapshot stream publisher [{topic}]"
            )
        self.subscriber = self.node.create_subscription(
            py_trees_ros_interfaces.msg.BehaviourTree,
            topic,
            self.callback_snapshot,
            utilities.qos_profile_latched(),
        )

    def _call(self, key: str, request: Any, timeout_sec: float) -> Any:
        future = self.services[key].call_async(request)
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=timeout_sec)
        if not future.done():
            raise exceptions.TimedOutError(f"timed out waiting for {self.service_names[key]}")
        return future.result()

    def shutdown(self) -> None:
        """Ask the tree's node to close the stream, and destroy this node."""
        if self.services["close"] is not None and self.topic_name is not None and rclpy.ok():
            request = self.service_types["close"].Request(topic_name=self.topic_name)
            future = self.services["close"].call_async(request)
            rclpy.spin_until_future_complete(self.node, future, timeout_sec=utilities.SERVER_SEC)
        self.node.destroy_node()

    def create_service_client(self, key: str) -> Any:
        """Return a client for the service ``open`` or ``close``.

        Raises:
            NotReadyError: `setup` was not called.
            TimedOutError: The server does not become available in time.
        """
        return utilities.client_of(self.node, self.service_types[key], self.service_names[key])

    def callback_snapshot(self, msg: Any) -> None:
        """Show a snapshot."""
        visitor = self.snapshot_visitor
        visitor.previously_visited = visitor.visited
        root, visitor.visited = tree_of(msg)
        if root is None:
            return
        if self.mode is WatcherMode.SNAPSHOTS:
            print("\n".join(self._lines(root, msg)))
        elif not self.rendered:
            self.rendered = True
            self._draw(root)
            self.done = True

    def _lines(self, root: Any, msg: Any) -> Iterator[str]:
        colour = console.green if msg.changed else console.bold
        title = f"Tick {msg.statistics.count}".center(WIDTH)
        yield f"{colour}\n{WIDTH * '*'}{console.reset}"
        yield f"{colour}* {console.bold}{title}{console.reset}"
        yield f"{colour}{WIDTH * '*'}\n{console.reset}"
        yield py_trees.display.unicode_tree(
            root=root,
            visited=self.snapshot_visitor.visited,
            previously_visited=self.snapshot_visitor.previously_visited,
        )
        yield f"{colour}{WIDTH * '-'}{console.reset}"
        if self.parameters.blackboard_data:
            data = {pair.key: pair.value for pair in msg.blackboard_on_visited_path}
            yield from section(colour, "Blackboard Data", data)
        if self.parameters.blackboard_activity and msg.blackboard_activity:
            yield f"\n{colour}Blackboard Activity Stream{console.reset}"
            yield py_trees.display.unicode_blackboard_activity_stream(
                msg.blackboard_activity, indent=0, show_title=False
            )
        elif self.parameters.blackboard_activity:
            yield from section(colour, "Blackboard Activity Stream", {})
        if self.statistics:
            yield from section(colour, "Statistics", times_of(msg.statistics))

    def _draw(self, root: Any) -> None:
        folder = tempfile.mkdtemp()
        py_trees.display.render_dot_tree(
            root=root,
            target_directory=folder,
            with_blackboard_variables=self.parameters.blackboard_data,
        )
        xdot = which("xdot")
        if xdot is None:
            console.logerror("No xdot viewer found [hint: sudo apt install xdot]")
            print(py_trees.display.dot_tree(root=root).to_string())
            return
        name = py_trees.utilities.get_valid_filename(root.name)
        self.xdot_process = subprocess.Popen([xdot, Path(folder, f"{name}.dot")])  # noqa: S603


def section(colour: str, title: str, values: dict[str, str]) -> Iterator[str]:
    """Yield the lines of a table with a title."""
    yield f"\n{colour}{title}{console.reset}"
    width = max(map(len, values), default=0) + 1
    for name, value in (values or {"-": "-"}).items():
        head = f"{console.cyan}{INDENT}{name:<{width}}{console.reset}"
        yield f"{head}: {console.yellow}{value}{console.reset}"


def times_of(counted: Any) -> dict[str, str]:
    """Return the times of ticks as texts."""

    def of(kind: str, factor: float, unit: str) -> str:
        values = (
            getattr(counted, f"tick_{kind}"),
            getattr(counted, f"tick_{kind}_average"),
            math.sqrt(max(getattr(counted, f"tick_{kind}_variance"), 0.0)),
        )
        shown = "/".join(f"{value * factor:.3f}" for value in values)
        return f"{shown} ({unit}) [time/avg/stddev]"

    return {
        "Timestamp": str(conversions.rclpy_time_to_float(Time.from_msg(counted.stamp))),
        "Duration": of("duration", 1000, "ms"),
        "Interval": of("interval", 1, "s"),
    }


def tree_of(msg: Any) -> tuple[Any, dict[Any, Any]]:
    """Return the root of a snapshot, or None, and the status of each behaviour of the last tick.

    Each behaviour has one parent and the root has none, so the result has no cycles whatever the
    message says.
    """
    made = {conversions.msg_to_uuid4(part.own_id): part for part in msg.behaviours}
    behaviours = {key: conversions.msg_to_behaviour(part) for key, part in made.items()}
    roots = [key for key, part in made.items() if not any(part.parent_id.uuid)]
    root = behaviours[roots[0]] if roots else None
    for key, part in made.items():
        behaviour = behaviours[key]
        children = [
            child
            for child in map(behaviours.get, map(conversions.msg_to_uuid4, part.child_ids))
            if child is not None and child is not root and child.parent is None
        ]
        for child in children:
            child.parent = behaviour
        if isinstance(behaviour, py_trees.decorators.Decorator):
            if children:
                behaviour.children = children[:1]
                behaviour.decorated = children[0]
            continue
        behaviour.children.extend(children)
        current = conversions.msg_to_uuid4(part.current_child_id)
        for child in children:
            if child.id == current:
                behaviour.current_child = child
    active = {key: behaviours[key].status for key, part in made.items() if part.is_active}
    return root, active
