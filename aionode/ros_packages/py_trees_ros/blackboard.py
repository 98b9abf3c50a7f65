"""The blackboard for other programs: services that list its variables, and streams of them."""

from __future__ import annotations

import pickle
from collections.abc import Iterable, Iterator
from typing import Any, Final

import py_trees
from py_trees import console
from py_trees.blackboard import Blackboard
from py_trees_ros_interfaces import srv
from std_msgs.msg import String

import rclpy
from aionode.clock import S_TO_NS, MachineTime
from py_trees_ros import utilities
from rclpy.qos import qos_profile_services_default

__all__ = ["BlackboardView", "BlackboardWatcher", "Exchange", "SubBlackboard"]

PLAIN: Final = (bool, int, float, str, bytes, list, tuple, dict, set, frozenset, type(None))
"""The types of values whose attributes are not listed."""
MAX_DEPTH: Final = 8
MAX_NAMES: Final = 10_000
"""Maximum number of names listed: attributes of objects may form cycles."""
INDENT: Final = " " * 4
LISTENER_SEC: Final = 5.0
"""How long a stream waits for its first listener."""
MAX_STREAMS: Final = 100
"""Maximum number of open streams; the oldest is closed for a new one."""
CANNOT_COMPARE: Final = (TypeError, AttributeError, pickle.PicklingError, RecursionError)


class SubBlackboard:
    """Detects changes of a part of the blackboard.

    Args:
        node: The node that logs, once, that something cannot be compared.
    """

    def __init__(self, node: Any) -> None:
        self.is_changed = False
        self.variable_names: set[str] = set()
        self.pickled_storage: bytes | None = None
        self.node = node
        self.warned = False

    def update(self, variable_names: set[str] | None) -> None:
        """Compare with the blackboard; values that cannot be compared count as changed.

        Args:
            variable_names: The variables to compare, such as ``battery.percentage``; None for all.
        """
        names = Blackboard.keys() if variable_names is None else variable_names
        self.variable_names = names
        storage = {name: Blackboard.get(name) for name in names if is_there(name)}
        try:
            pickled = pickle.dumps(storage, -1)
        except CANNOT_COMPARE:
            if not self.warned:
                self.warned = True
                self.node.get_logger().warning(
                    "You have objects on the blackboard that can't be pickled. Any blackboard "
                    "watchers will always receive updates, regardless of whether the data changed "
                    "or not"
                )
            self.pickled_storage = None
            self.is_changed = True
            return
        self.is_changed = pickled != self.pickled_storage
        self.pickled_storage = pickled

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        width = max(map(len, self.variable_names), default=0) + 1
        for name in sorted(self.variable_names):
            value = str(Blackboard.get(name)) if is_there(name) else "-"
            head = f"{console.cyan}{INDENT}{name:<{width}}{console.reset}:"
            lines = [f"{console.yellow}{line}{console.reset}" for line in value.split("\n")]
            if len(lines) == 1:
                yield f"{head} {lines[0]}"
            else:
                yield head
                yield from (f"{INDENT}{line}" for line in lines)


def is_there(name: str) -> bool:
    """Return whether a variable, or a part of one, is on the blackboard."""
    try:
        Blackboard.get(name)
    except (KeyError, AttributeError):
        return False
    return True


class BlackboardView:
    """A stream of a part of the blackboard.

    Args:
        node: The node that publishes.
        topic_name: The topic.
        variable_names: The variables; empty for all.
        filter_on_visited_path: Whether to include only variables used by behaviours of the last
            tick.
        with_activity_stream: Whether to include who read and wrote them.
    """

    def __init__(
        self,
        node: Any,
        topic_name: str,
        variable_names: set[str],
        filter_on_visited_path: bool,
        with_activity_stream: bool,
    ) -> None:
        self.topic_name = topic_name
        self.variable_names = variable_names
        self.sub_blackboard = SubBlackboard(node=node)
        self.sub_activity_stream = py_trees.blackboard.ActivityStream()
        self.node = node
        self.publisher = node.create_publisher(String, topic_name, utilities.qos_profile_latched())
        self.filter_on_visited_path = filter_on_visited_path
        self.with_activity_stream = with_activity_stream
        self.tracked_variable_names: set[str] | None = set()
        self.tracked_keys: set[str] = set()
        self._opened_ns = MachineTime.steady_ns()
        self._had_listeners = False

    def is_listened_to(self) -> bool:
        """Return whether there is a listener."""
        is_there = bool(self.node.count_subscribers(self.topic_name))
        self._had_listeners |= is_there
        return is_there

    def is_abandoned(self) -> bool:
        """Return whether a stream without listeners had some before, or has waited long enough."""
        waited_ns = MachineTime.steady_ns() - self._opened_ns
        return self._had_listeners or waited_ns > LISTENER_SEC * S_TO_NS

    def shutdown(self) -> None:
        """Destroy the publisher."""
        self.node.destroy_publisher(self.publisher)

    def is_changed(self, visited_clients: Any) -> bool:
        """Return whether the part has changed since the last call.

        Args:
            visited_clients: The blackboard clients of the behaviours of the last tick.
        """
        keys = Blackboard.keys()
        if self.filter_on_visited_path:
            keys = Blackboard.keys_filtered_by_clients(client_ids=visited_clients)
        if self.variable_names:
            of_keys = {name: name.partition(".")[0] for name in self.variable_names}
            if self.filter_on_visited_path:
                of_keys = {name: key for name, key in of_keys.items() if key in keys}
            self.tracked_variable_names = set(of_keys)
            self.tracked_keys = set(of_keys.values())
        else:
            self.tracked_variable_names = keys if self.filter_on_visited_path else None
            self.tracked_keys = keys
        self.sub_blackboard.update(self.tracked_variable_names)
        if self.with_activity_stream and Blackboard.activity_stream is not None:
            self.sub_activity_stream.clear()
            for item in Blackboard.activity_stream.data:
                if item.key in self.tracked_keys:
                    self.sub_activity_stream.push(item)
        return self.sub_blackboard.is_changed

    def text(self) -> str:
        """Return the current text of the stream."""
        if not self.with_activity_stream:
            return str(self.sub_blackboard)
        activities = py_trees.display.unicode_blackboard_activity_stream(
            activity_stream=self.sub_activity_stream.data
        )
        head = f"{console.green}Blackboard Data\n{console.reset}"
        return f"{head}{self.sub_blackboard}\n{activities}"


class Exchange:
    """The services of a node that list the blackboard, and open and close streams of it."""

    _counter = 0

    def __init__(self) -> None:
        self.node: Any = None
        self.views: list[BlackboardView] = []
        self.services: dict[str, Any] = {}
        self.activity_stream_clients = 0

    def setup(self, node: Any) -> None:
        """Create the services ``~/blackboard_streams/get_variables``, ``open`` and ``close``."""
        self.node = node
        for name, cls, answer in (
            ("get_variables", srv.GetBlackboardVariables, self._get_variables_service),
            ("open", srv.OpenBlackboardStream, self._open_service),
            ("close", srv.CloseBlackboardStream, self._close_service),
        ):
            self.services[name] = node.create_service(
                cls,
                f"~/blackboard_streams/{name}",
                answer,
                qos_profile=qos_profile_services_default,
            )

    def _get_nested_keys(self) -> list[str]:
        names: list[str] = []
        for key in sorted(Blackboard.storage):
            add_names(names, key, Blackboard.storage[key], MAX_DEPTH)
        return names

    def post_tick_handler(self, visited_client_ids: Iterable[Any] | None = None) -> None:
        """Publish changes to listeners, and close streams without listeners.

        Args:
            visited_client_ids: The blackboard clients of the behaviours of this tick.
        """
        for view in list(self.views):
            if view.is_listened_to():
                if view.is_changed(visited_client_ids):
                    view.publisher.publish(String(data=view.text()))
            elif view.is_abandoned():
                self._close_view(view)
        if Blackboard.activity_stream is None:
            if self.activity_stream_clients > 0:
                Blackboard.enable_activity_stream()
        elif self.activity_stream_clients == 0:
            Blackboard.disable_activity_stream()
        else:
            Blackboard.activity_stream.clear()

    def register_activity_stream_client(self) -> None:
        """Record activities for one more client that shows them."""
        self.activity_stream_clients += 1

    def unregister_activity_stream_client(self) -> None:
        """Record activities for one client fewer."""
        self.activity_stream_clients -= 1

    def _close_view(self, view: BlackboardView) -> None:
        if view.with_activity_stream:
            self.unregister_activity_stream_client()
        view.shutdown()
        self.views.remove(view)

    def _close_service(self, request: Any, response: Any) -> Any:
        views = [view for view in self.views if view.topic_name == request.topic_name]
        for view in views:
            self._close_view(view)
        response.result = bool(views)
        return response

    def _get_variables_service(self, unused_request: Any, response: Any) -> Any:
        response.variables = self._get_nested_keys()
        return response

    def _open_service(self, request: Any, response: Any) -> Any:
        response.topic = utilities.resolve_name(
            self.node, f"~/blackboard_streams/_watcher_{Exchange._counter}"
        )
        Exchange._counter += 1
        if len(self.views) == MAX_STREAMS:
            self._close_view(self.views[0])
        if request.with_activity_stream:
            self.register_activity_stream_client()
        self.views.append(
            BlackboardView(
                node=self.node,
                topic_name=response.topic,
                variable_names=set(request.variables),
                filter_on_visited_path=request.filter_on_visited_path,
                with_activity_stream=request.with_activity_stream,
            )
        )
        return response


def add_names(names: list[str], name: str, value: Any, levels: int) -> None:
    """Add the name of a value, and those of its public attributes, down to some depth."""
    if len(names) >= MAX_NAMES:
        return
    names.append(name)
    if levels == 0 or isinstance(value, PLAIN) or hasattr(value, "__array__"):
        return
    for attribute in dir(type(value)):
        if attribute.startswith("_") or attribute.isupper():
            continue
        part = getattr(value, attribute, None)
        if not callable(part):
            add_names(names, f"{name}.{attribute}", part, levels - 1)


class BlackboardWatcher:
    """The client of an `Exchange`, which calls its services.

    Args:
        namespace_hint: A part of the names of the services, if there are several trees.
    """

    def __init__(self, namespace_hint: str | None = None) -> None:
        self.namespace_hint = namespace_hint
        self.node: Any = None
        self.service_names: dict[str, str | None] = {"list": None, "open": None, "close": None}
        self.service_types = {
            "list": srv.GetBlackboardVariables,
            "open": srv.OpenBlackboardStream,
            "close": srv.CloseBlackboardStream,
        }
        self.service_type_strings = {
            key: f"py_trees_ros_interfaces/srv/{cls.__name__}"
            for key, cls in self.service_types.items()
        }

    def setup(self, timeout_sec: float) -> None:
        """Create a node, and find the services.

        Raises:
            NotFoundError: There are none.
            MultipleFoundError: There are services of several trees.
        """
        self.node = rclpy.create_node(
            utilities.create_anonymous_node_name(node_name="watcher"),
            start_parameter_services=False,
        )
        for key in self.service_names:
            self.service_names[key] = utilities.find_service(
                node=self.node,
                service_type=self.service_type_strings[key],
                namespace=self.namespace_hint,
                timeout=timeout_sec,
            )

    def create_service_client(self, key: str) -> tuple[Any, Any]:
        """Return a request and a client for the service ``list``, ``open`` or ``close``.

        Raises:
            NotReadyError: `setup` was not called.
            TimedOutError: The server does not become available in time.
        """
        name = self.service_names[key]
        cls = self.service_types[key]
        return cls.Request(), utilities.client_of(self.node, cls, name)

    def echo_blackboard_contents(self, msg: Any) -> None:
        """Print a message of a stream."""
        print(msg.data)

    def shutdown(self) -> None:
        """Destroy the node."""
        if self.node is not None:
            self.node.destroy_node()
