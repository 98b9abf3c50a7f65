"""An rcl within this process, for `aionode.transport.rcl` without ROS and DDS.

It has the interface of `Rcl` and of rclpy's extension module, as far as they are used. Messages go
straight from publishers to subscriptions as CDR; changes are reported by guard conditions, as the
real one does from its own threads.
"""

from __future__ import annotations

import ctypes
import itertools
import os
import sys
import threading
from collections import defaultdict, deque
from collections.abc import Iterator
from types import ModuleType, SimpleNamespace
from typing import Any, Self

import pytest

from aionode.clock import Duration, perf_ns
from aionode.engine.transport.rcl import _bindings, _services, _state, _topics
from aionode.engine.transport.rcl._bindings import ByteArray
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

__all__ = ["FakeRcl", "Reference", "install"]

HOST = b"\x01\x0fme"  # how the gids of Fast DDS on one host begin
NOTHING = 401  # RCL_RET_SUBSCRIPTION_TAKE_FAILED
REFUSED = 1  # RCL_RET_ERROR


def install(monkeypatch: pytest.MonkeyPatch) -> FakeRcl:
    """Have ``transport="rcl"`` use a fake for the rest of a test, and return the fake."""
    if not hasattr(os, "eventfd"):
        pytest.skip("transport=rcl needs Linux, whose eventfds wake the event loop")
    rcl = FakeRcl()

    def load() -> FakeRcl:
        return rcl

    for module in (_bindings, _state, _topics):
        monkeypatch.setattr(module, "load", load)
    for module in (_topics, _services):
        monkeypatch.setattr(module, "rosidl_class", Interface)
    monkeypatch.setattr(_services, "MessageSupport", Messages)
    modules: dict[str, dict[str, Any]] = {
        "rclpy": {},
        "rclpy.context": {"Context": lambda: FakeContext(rcl)},
        "rclpy.duration": {"Duration": Duration},
        "rclpy.qos": {
            "DurabilityPolicy": DurabilityPolicy,
            "HistoryPolicy": HistoryPolicy,
            "LivelinessPolicy": LivelinessPolicy,
            "QoSProfile": Profile,
            "ReliabilityPolicy": ReliabilityPolicy,
        },
    }
    for name, attributes in modules.items():
        made = ModuleType(name)
        vars(made).update(attributes)
        monkeypatch.setitem(sys.modules, name, made)
        parent, _, child = name.rpartition(".")
        if parent:
            setattr(sys.modules[parent], child, made)
    return rcl


class Profile(QoSProfile):
    """A QoS profile like rclpy's."""

    def get_c_qos_profile(self) -> QoSProfile:
        """Return the form for the extension module."""
        return self


class Interface:
    """A message class like rosidl's."""

    def __init__(self, type_name: str, type_hash: str) -> None:
        self.type_name = type_name
        self.type_hash = type_hash
        self.Request = f"{type_name}_Request"
        self.Response = f"{type_name}_Response"


class Messages:
    """Messages in memory: the CDR of each by its id."""

    def __init__(self, rcl: FakeRcl, cls: object) -> None:  # as MessageSupport
        self._rcl = rcl

    def create(self) -> int:
        """Return the id of a new message."""
        return self._rcl.next_id()

    def destroy(self, message: int) -> None:
        """Forget a message."""
        self._rcl.messages.pop(message, None)

    def to_cdr(self, message: int, array: ByteArray) -> bytes:  # as MessageSupport
        """Return a message."""
        return self._rcl.messages[message]

    def from_cdr(self, payload: bytes, message: int) -> None:
        """Fill a message."""
        self._rcl.messages[message] = payload


class Reference:
    """The result of ``ctypes.byref``."""

    def __init__(self, structure: ctypes.Structure) -> None:
        self._obj = structure


class Handle:
    """The base of all handles of the extension module.

    Attributes:
        pointer: Its number.
    """

    def __init__(self, rcl: FakeRcl) -> None:
        self.rcl = rcl
        self.pointer = rcl.next_id()
        rcl.handles[self.pointer] = self

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def destroy_when_not_in_use(self) -> None:
        """Destroy it."""
        self.rcl.handles.pop(self.pointer, None)
        self.rcl.note_change()


class FakeContext:
    """The ``rclpy.context.Context``."""

    def __init__(self, rcl: FakeRcl) -> None:
        self.handle = ContextHandle(rcl)

    def init(self, *, args: list[str], initialize_logging: bool, domain_id: int) -> None:
        """Join a domain."""
        assert not args
        assert not initialize_logging
        self.handle.domain_id = domain_id

    def shutdown(self) -> None:
        """Leave the domain."""
        left = [one for one in self.handle.rcl.of(Entity) if one.node.context is self.handle]
        assert not left, f"not destroyed: {left}"

    def destroy(self) -> None:
        """Destroy the context."""
        self.handle.destroy_when_not_in_use()


class ContextHandle(Handle):
    """A participant; all its gids begin with its gid prefix."""

    domain_id = 0

    @property
    def prefix(self) -> bytes:
        """The prefix of its gids: all participants are on one host."""
        return HOST + self.pointer.to_bytes(8, "little")

    def new_gid(self) -> bytes:
        """Return the gid of a new endpoint."""
        return self.prefix + self.rcl.next_id().to_bytes(4, "little")


class NodeHandle(Handle):
    """A node."""

    def __init__(
        self, rcl: FakeRcl, name: str, namespace: str, context: ContextHandle, *_: object
    ) -> None:
        super().__init__(rcl)
        self.name = name
        self.namespace = namespace or "/"
        self.context = context
        self.guard = Guard(rcl)
        rcl.note_change()

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return the nodes."""
        nodes = self.rcl.of(NodeHandle)
        return [
            (one.name, one.namespace, "/")
            for one in nodes
            if one.context.domain_id == self.context.domain_id
        ]


class Entity(Handle):
    """A publisher, subscription, service or client."""

    def __init__(
        self, rcl: FakeRcl, node: NodeHandle, interface: Interface, name: str, qos: Profile
    ) -> None:
        super().__init__(rcl)
        self.node = node
        self.interface = interface
        self.name = name
        self.qos = qos
        self.gid = node.context.new_gid()
        self.fd: int | None = None
        self.sequence = itertools.count(1)
        keep = None if qos.history is HistoryPolicy.KEEP_ALL else qos.depth
        self.queue: deque[Any] = deque(maxlen=keep)
        rcl.note_change()

    def put(self, item: object) -> None:
        """Add something to be taken."""
        self.queue.append(item)
        if self.fd is not None and (self.rcl.is_fast_dds or len(self.queue) == 1):
            os.eventfd_write(self.fd, 1)

    def others(self, kind: type[Entity]) -> list[Any]:
        """Return the entities of a kind that match."""
        return [
            one
            for one in self.rcl.of(kind)
            if (one.name, one.interface.type_name) == (self.name, self.interface.type_name)
            and one.node.context.domain_id == self.node.context.domain_id
        ]

    def info(self) -> dict[str, Any]:
        """Return its description in discovery."""
        version, _, value = self.interface.type_hash.removeprefix("RIHS").partition("_")
        return {
            "endpoint_gid": list(self.gid),
            "node_name": self.node.name,
            "node_namespace": self.node.namespace,
            "topic_type": self.interface.type_name,
            "topic_type_hash": {"version": int(version or 0), "value": bytes.fromhex(value)},
            "qos_profile": {
                "history": HistoryPolicy.UNKNOWN,
                "depth": 0,
                "reliability": self.qos.reliability,
                "durability": self.qos.durability,
                "lifespan": self.qos.lifespan,
                "deadline": self.qos.deadline,
                "liveliness": self.qos.liveliness,
                "liveliness_lease_duration": self.qos.liveliness_lease_duration,
                "avoid_ros_namespace_conventions": False,
            },
        }


class PublisherHandle(Entity):
    """A publisher; what it keeps for late subscriptions is in `queue`."""


class SubscriptionHandle(Entity):
    """A subscription."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        if self.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            for publisher in self.others(PublisherHandle):
                self.queue.extend(publisher.queue)


class ServiceHandle(Entity):
    """A server."""


class ClientHandle(Entity):
    """A client."""


class Guard(Handle):
    """A guard condition."""

    triggered = False

    def trigger_guard_condition(self) -> None:
        """Wake the wait set that contains it."""
        with self.rcl.condition:
            self.triggered = True
            self.rcl.condition.notify_all()


class WaitSet(Handle):
    """A wait set of guard conditions."""

    def __init__(self, rcl: FakeRcl, *_: object) -> None:
        super().__init__(rcl)
        self.guards: list[Guard] = []

    def clear_entities(self) -> None:
        """Remove all entities."""
        self.guards.clear()

    def add_guard_condition(self, guard: Guard) -> None:
        """Add a guard condition."""
        self.guards.append(guard)

    def wait(self, timeout_ns: int) -> None:
        """Wait until one is triggered."""
        assert timeout_ns == -1
        with self.rcl.condition:
            self.rcl.condition.wait_for(lambda: any(one.triggered for one in self.guards))
            for one in self.guards:
                one.triggered = False


class NodeNameNonExistentError(Exception):
    """There is no such node."""


class FakeRcl:
    """The interface of `Rcl` without its libraries.

    Attributes:
        refuses: Why publishing fails; empty if it does not.
        numbers: Whether messages come with a number, as over Fast DDS.
        silent: How many queries for services of a node fail before one succeeds.
        hides_changes: Whether changes of the graph are not reported.
        takes: How many times a subscription was asked for a message.
        published: How many messages were published.
        is_fast_dds: Whether it reports each message; if not, only the first of several.
    """

    version = "9.9.9"
    middleware = "rmw_fastrtps_cpp"
    notify = None

    def __init__(self) -> None:
        self.handles: dict[int, Handle] = {}
        self.messages: dict[int, bytes] = {}
        self.condition = threading.Condition()
        self.refuses = ""
        self.numbers = True
        self.silent = 0
        self.hides_changes = False
        self.takes = self.published = 0
        self.is_fast_dds = True
        self._ids = itertools.count(1)
        self.take_without_gil, self.publish_without_gil = self.take, self.publish
        self.set_service_callback = self.set_client_callback = self.set_subscription_callback
        self.client_gid = self.publisher_gid
        made = {
            "Node": NodeHandle,
            "Publisher": PublisherHandle,
            "Subscription": SubscriptionHandle,
            "Service": ServiceHandle,
            "Client": ClientHandle,
        }
        self.module = SimpleNamespace(
            GuardCondition=lambda context: Guard(self),  # its signature
            WaitSet=lambda *sizes: WaitSet(self),  # its signature
            NodeNameNonExistentError=NodeNameNonExistentError,
            rclpy_get_topic_names_and_types=self._topics,
            rclpy_get_publishers_info_by_topic=self._infos(PublisherHandle),
            rclpy_get_subscriptions_info_by_topic=self._infos(SubscriptionHandle),
            rclpy_get_service_names_and_types_by_node=self._services(ServiceHandle),
            rclpy_get_client_names_and_types_by_node=self._services(ClientHandle),
            **{name: self._maker(kind) for name, kind in made.items()},
        )

    def _maker(self, kind: Any) -> Any:
        return lambda *arguments: kind(self, *arguments)

    def next_id(self) -> int:
        """Return an unused number."""
        return next(self._ids)

    def of(self, kind: type[Any]) -> list[Any]:
        """Return the handles of a kind."""
        return [one for one in list(self.handles.values()) if isinstance(one, kind)]

    def note_change(self) -> None:
        """Report a change of the graph to all nodes."""
        if self.hides_changes:
            return
        for node in self.of(NodeHandle):
            node.guard.trigger_guard_condition()

    # Discovery

    def _seen(self, asker: NodeHandle, kind: type[Entity]) -> Iterator[Any]:
        domain_id = asker.context.domain_id
        return (one for one in self.of(kind) if one.node.context.domain_id == domain_id)

    def _topics(self, asker: NodeHandle, _: bool) -> list[tuple[str, list[str]]]:
        found: dict[str, set[str]] = defaultdict(set)
        for kind in (PublisherHandle, SubscriptionHandle):
            for one in self._seen(asker, kind):
                found[one.name].add(one.interface.type_name)
        return [(name, sorted(types)) for name, types in found.items()]

    def _infos(self, kind: type[Entity]) -> Any:
        def ask(asker: NodeHandle, topic: str, no_mangle: bool) -> list[dict[str, Any]]:
            if no_mangle and topic == "ros_discovery_info":
                return [
                    {"endpoint_gid": list(one.new_gid())}
                    for one in self.of(ContextHandle)
                    if one.domain_id == asker.context.domain_id
                ]
            return [one.info() for one in self._seen(asker, kind) if one.name == topic]

        return ask

    def _services(self, kind: type[Entity]) -> Any:
        def ask(asker: NodeHandle, name: str, namespace: str) -> list[tuple[str, list[str]]]:
            if self.silent:
                self.silent -= 1
                raise NodeNameNonExistentError
            return [
                (one.name, [one.interface.type_name])
                for one in self._seen(asker, kind)
                if (one.node.name, one.node.namespace) == (name, namespace)
            ]

        return ask

    # The functions of rcl

    def graph_guard(self, node: int) -> int:
        """Return the guard condition of a node."""
        handle: Any = self.handles[node]
        return int(handle.guard.pointer)

    def add_guard(self, wait_set: int, guard: int, _: None) -> None:
        """Add a guard condition to a wait set."""
        handle: Any = self.handles[wait_set]
        handle.guards.append(self.handles[guard])

    def set_subscription_callback(self, pointer: int, _: None, fd: int | None) -> int:
        """Have an eventfd written when something arrives."""
        handle: Any = self.handles[pointer]
        handle.fd = fd
        return 0

    def publisher_gid(self, pointer: int) -> bytes:
        """Return the gid of an entity."""
        handle: Any = self.handles[pointer]
        return bytes(handle.gid)

    def publish(self, pointer: int, array: Any, _: None) -> int:
        """Publish a serialized message."""
        if self.refuses:
            return REFUSED
        self.published += 1
        publisher: Any = self.handles[pointer]
        view = array._obj
        payload = ctypes.string_at(ctypes.c_void_p.from_buffer(view).value or 0, view.length)
        item = (payload, publisher.gid, next(publisher.sequence), perf_ns())
        if publisher.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            publisher.queue.append(item)
        for one in publisher.others(SubscriptionHandle):
            one.put(item)
        return 0

    def take(self, pointer: int, array: Any, info: Any, _: None) -> int:
        """Take a serialized message."""
        self.takes += 1
        reader: Any = self.handles[pointer]
        if not reader.queue:
            return NOTHING
        payload, gid, sequence, stamp_ns = reader.queue.popleft()
        reader.taken = payload  # until the next one: the array shows it
        array._obj.buffer = ctypes.cast(ctypes.c_char_p(payload), ctypes.c_void_p)
        array._obj.length = len(payload)
        info._obj.gid[:] = gid
        info._obj.sequence = sequence if self.numbers else _bindings.UNNUMBERED
        info._obj.source_ns = stamp_ns
        return 0

    def send_request(self, pointer: int, message: int, number: Any) -> int:
        """Send a request."""
        if self.refuses:
            return REFUSED
        client: Any = self.handles[pointer]
        number._obj.value = next(client.sequence)
        for server in client.others(ServiceHandle):
            server.put((self.messages[message], client.gid, number._obj.value))
        return 0

    def take_request(self, pointer: int, info: Any, message: int) -> int:
        """Take a request, or a response."""
        handle: Any = self.handles[pointer]
        if not handle.queue:
            return NOTHING
        self.messages[message], gid, number = handle.queue.popleft()
        info._obj.request_id.gid[:] = gid
        info._obj.request_id.sequence = number
        return 0

    take_response = take_request

    def send_response(self, pointer: int, request_id: Any, message: int) -> int:
        """Send a response."""
        if self.refuses:
            return REFUSED
        gid, number = bytes(request_id._obj.gid), request_id._obj.sequence
        server: Any = self.handles[pointer]
        for client in server.others(ClientHandle):
            if client.gid == gid:
                client.put((self.messages[message], gid, number))
        return 0

    def is_available(self, node: int, pointer: int, found: Any) -> int:  # as rcl's
        """Return whether a client has a server."""
        client: Any = self.handles[pointer]
        found._obj.value = bool(client.others(ServiceHandle))
        return 0

    def count_subscriptions(self, pointer: int, count: Any) -> int:
        """Return how many subscriptions a publisher has."""
        publisher: Any = self.handles[pointer]
        count._obj.value = len(publisher.others(SubscriptionHandle))
        return 0

    def assert_liveliness(self, pointer: int) -> int:
        """Assert the liveliness of a publisher."""
        assert pointer in self.handles
        return 0

    def error(self) -> str:
        """Return why the last call failed."""
        return self.refuses

    def forget_error(self) -> None:
        """Clear the error."""

    def new_array(self, size: int = 256) -> ByteArray:  # as rcl's
        """Return an array."""
        return ByteArray()

    def free_array(self, array: ByteArray) -> None:
        """Free an array."""
