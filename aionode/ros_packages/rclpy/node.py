"""Nodes."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import (  # noqa: UP035  # programs take them from here
    TYPE_CHECKING,
    Any,
    Dict,
    List,
    Optional,
    Self,
    Sequence,
    Tuple,
    Type,
    TypeVar,
    Union,
)

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ListParametersResult,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.msg import Parameter as ParameterMsg

from aionode import qos as core
from aionode.engine.graph_queries import GraphQueries
from aionode.graph import EndpointKind
from aionode.parameter.methods import ParameterMethods
from rclpy._endpoint_infos import info_of, service_info_of
from rclpy._entities import in_use_by_node, wait_until
from rclpy._impl import messages as msg
from rclpy._impl.errors import NodeNameNonExistentError
from rclpy._impl.node import NodeHandle
from rclpy._impl.services import ClientHandle, ServiceHandle
from rclpy._impl.topics import PublisherHandle, SubscriptionHandle
from rclpy._parameter_store import NodeParameterStore, ParameterEvents
from rclpy.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from rclpy.client import Client
from rclpy.clock import Clock, ROSClock
from rclpy.constants import S_TO_NS
from rclpy.context import Context
from rclpy.event_handler import (
    DefaultHandler,
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from rclpy.exceptions import (
    InvalidHandle,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    InvalidTopicNameException,
    NotInitializedException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.executors import Executor
from rclpy.guard_condition import GuardCondition
from rclpy.logging import get_logger
from rclpy.logging_service import LoggingService
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService
from rclpy.publisher import Publisher
from rclpy.qos import (
    QoSProfile,
    as_own,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from rclpy.qos_overriding_options import QoSOverridingOptions, _declare_qos_parameters
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.time_source import TimeSource
from rclpy.timer import Rate, Timer
from rclpy.type_description_service import TypeDescriptionService
from rclpy.type_support import (
    MsgType,
    SrvType,
    SrvTypeRequest,
    SrvTypeResponse,
    check_is_valid_msg_type,
    check_is_valid_srv_type,
)
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.logging import RcutilsLogger
    from rclpy._impl.destroyable import Arrivals
    from rclpy.endpoint_info import ServiceEndpointInfo
    from rclpy.subscription_content_filter_options import ContentFilterOptions
    from rclpy.topic_endpoint_info import TopicEndpointInfo
    from rclpy.waitable import Waitable

__all__ = [
    "HIDDEN_NODE_PREFIX",
    "Any",
    "BaseNode",
    "Callable",
    "Context",
    "Dict",
    "FloatingPointRange",
    "IntegerRange",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidTopicNameException",
    "List",
    "ListParametersResult",
    "MsgType",
    "MutuallyExclusiveCallbackGroup",
    "Node",
    "NodeNameNonExistentError",
    "Optional",
    "Parameter",
    "ParameterAlreadyDeclaredException",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterImmutableException",
    "ParameterMsg",
    "ParameterNotDeclaredException",
    "ParameterType",
    "ParameterUninitializedException",
    "ParameterValue",
    "Publisher",
    "QoSProfile",
    "ReentrantCallbackGroup",
    "Sequence",
    "SetParametersResult",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
    "Timer",
    "Tuple",
    "Type",
    "TypeVar",
    "Union",
]

HIDDEN_NODE_PREFIX = "_"


class Node(ParameterMethods, GraphQueries):
    """A node: a name in the graph, and publishers, subscriptions, services, clients and timers.

    Callbacks run in the threads that spin an executor with this node. Everything else works without
    spinning, and in any thread.

    Args:
        node_name: Its name.
        context: Its context; the default one by default.
        cli_args: Arguments for this node alone, as on a command line.
        namespace: Its namespace; the root by default.
        use_global_arguments: Whether the context's arguments apply as well.
        enable_rosout: Whether its log is published on ``/rosout``.
        rosout_qos_profile: The QoS of that topic.
        start_parameter_services: Whether other nodes can read and set its parameters.
        parameter_overrides: Values that take precedence over those of `declare_parameter`.
        allow_undeclared_parameters: Whether parameters can be set without being declared.
        automatically_declare_parameters_from_overrides: Whether to declare a parameter for each
            override.
        enable_logger_service: Whether other nodes can read and set its log levels.

    Raises:
        NotInitializedException: the context is not initialised, or shut down.
        InvalidNodeNameException, InvalidNamespaceException: a name is invalid (ValueErrors).
    """

    ParameterInput = Any  # accepted by declare_parameters, for type checkers

    PARAM_REL_TOL = 1e-6
    """The relative tolerance for a float at a limit or a step."""

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter[Any]] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._context = get_default_context() if context is None else context
        self._publishers: list[Publisher[Any]] = []
        self._subscriptions: list[Subscription[Any]] = []
        self._clients: list[Client[Any, Any]] = []
        self._services: list[Service[Any, Any]] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._Node__waitables: list[Waitable[Any]] = []
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()
        self._Node__executor_weakref: weakref.ref[Executor] | None = None
        if self._context.handle is None or not self._context.ok():
            raise NotInitializedException("cannot create node")
        with self._context.handle:
            self._Node__handle = NodeHandle(
                node_name,
                namespace or "",
                self._context.handle,
                cli_args,
                use_global_arguments,
                enable_rosout,
                as_profile(rosout_qos_profile),
            )
        GraphQueries.__init__(self, self._Node__handle)
        self._logger = get_logger(self._Node__handle.logger_name())
        self._clock = self._Node__make_clock()
        store = NodeParameterStore(
            self._Node__handle.get_fully_qualified_name(),
            overrides=[
                *self._Node__handle.get_parameters(Parameter).values(),
                *(parameter_overrides or ()),
            ],
            allow_undeclared=allow_undeclared_parameters,
        )
        ParameterMethods.__init__(self, store)
        self._Node__parameter_store = store
        # Programs of rclpy read these.
        self._allow_undeclared_parameters = allow_undeclared_parameters
        self._parameters, self._descriptors = store.tables()
        self._parameter_overrides = store.overrides
        self._pre_set_parameters_callbacks = store.callbacks.pre
        self._on_set_parameters_callbacks = store.callbacks.on
        self._post_set_parameters_callbacks = store.callbacks.post
        events = self.create_publisher(
            msg.ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )
        store.publish = ParameterEvents(events, self._clock)
        if automatically_declare_parameters_from_overrides:
            self.declare_parameters(
                "",
                [
                    (name, parameter.value, msg.ParameterDescriptor())
                    for name, parameter in self._parameter_overrides.items()
                ],
                ignore_override=True,
            )
        self._time_source = TimeSource(node=self)
        self._time_source.attach_clock(self._clock)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)
        if enable_logger_service:
            self._logger_service = LoggingService(self)
        self._type_description_service = TypeDescriptionService(self)
        self._context.track_node(self)

    def _Node__make_clock(self) -> ROSClock:
        """Return the clock of a new node."""
        return ROSClock()

    @property
    def handle(self) -> NodeHandle:
        """The handle."""
        return self._Node__handle

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    get_name = in_use_by_node(NodeHandle.get_node_name)
    get_namespace = in_use_by_node(NodeHandle.get_namespace)
    get_fully_qualified_name = in_use_by_node(NodeHandle.get_fully_qualified_name)

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic, remapped unless `only_expand`."""
        with self._Node__handle:
            return self._Node__handle.resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service, remapped unless `only_expand`."""
        with self._Node__handle:
            return self._Node__handle.resolve(service, only_expand=only_expand, is_service=True)

    @property
    def context(self) -> Context:
        """Its context."""
        return self._context

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Its publishers."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Its subscriptions."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        """Its clients."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service[Any, Any]]:
        """Its services."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """Its timers."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Its guard conditions."""
        yield from self._guards

    @property
    def waitables(self) -> Iterator[Waitable[Any]]:
        """Its waitables."""
        yield from self._Node__waitables

    @property
    def executor(self) -> Executor | None:
        """The executor that calls its callbacks, or None.

        Setting it removes the node from the former one.
        """
        return None if self._Node__executor_weakref is None else self._Node__executor_weakref()

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.executor
        if current is new_executor:
            return
        self._Node__executor_weakref = None
        if current is not None:
            current.remove_node(self)
        if new_executor is not None:
            self._Node__executor_weakref = weakref.ref(new_executor)
            new_executor.add_node(self)

    def _wake_executor(self) -> None:
        executor = self.executor
        if executor is not None:
            executor.wake()

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of entities created without one; only one callback of it runs at a time."""
        return self._default_callback_group

    def get_clock(self) -> Clock:
        """Return its clock, which shows ROS time."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """Return its logger."""
        return self._logger

    # Entities

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
    ) -> Any:
        """Return a publisher.

        Args:
            msg_type: The class of its messages.
            topic: Its topic; relative names are in the node's namespace.
            qos_profile: Its profile, or a depth.
            callback_group: The group of its event callbacks.
            event_callbacks: Callbacks for its events.
            qos_overriding_options: Which policies parameters may override.
            publisher_class: The class of the publisher.

        Raises:
            InvalidTopicNameException: the topic is invalid (a ValueError).
            InvalidHandle: the node is destroyed.
        """
        profile = as_profile(qos_profile)
        group = callback_group or self.default_callback_group
        name = self.resolve_topic_name(topic)
        profile = _declare_qos_parameters(Publisher, self, name, profile, qos_overriding_options)
        check_is_valid_msg_type(msg_type)
        with self.handle:
            handle = PublisherHandle(self._Node__handle, msg_type, topic, profile)
        try:
            publisher = publisher_class(
                handle,
                msg_type,
                topic,
                profile,
                event_callbacks=event_callbacks or PublisherEventCallbacks(),
                callback_group=group,
            )
        except BaseException:
            handle.destroy_when_not_in_use()
            raise
        self._publishers.append(publisher)
        self._wake_executor()
        self._Node__add_event_handlers(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
        acceptable_buffer_backends: str | None = None,
    ) -> Subscription[Any]:
        """Return a subscription.

        Args:
            msg_type: The class of its messages.
            topic: Its topic; relative names are in the node's namespace.
            callback: Called with each message, or with it and a `MessageInfo`.
            qos_profile: Its profile, or a depth: how many messages wait for the callback.
            callback_group: The group of its callbacks.
            event_callbacks: Callbacks for its events.
            qos_overriding_options: Which policies parameters may override.
            raw: Whether the callback gets bytes.
            content_filter_options: Selects the messages that it receives.
            acceptable_buffer_backends: Where large arrays may be stored, as in rclpy of Lyrical:
                messages always arrive in main memory, which every publisher offers, whatever else
                is acceptable.

        Raises:
            InvalidTopicNameException: the topic is invalid (a ValueError).
            RuntimeError: the callback takes other arguments.
            RCLError: the content filter cannot be used.
            InvalidHandle: the node is destroyed.
        """
        profile = as_profile(qos_profile)
        group = callback_group or self.default_callback_group
        name = self.resolve_topic_name(topic)
        profile = _declare_qos_parameters(Subscription, self, name, profile, qos_overriding_options)
        check_is_valid_msg_type(msg_type)
        with self.handle:
            handle = SubscriptionHandle(
                self._Node__handle, msg_type, topic, profile, content_filter_options
            )
        try:
            subscription: Subscription[Any] = Subscription(
                handle,
                msg_type,
                topic,
                callback,
                group,
                profile,
                raw,
                event_callbacks=event_callbacks or SubscriptionEventCallbacks(),
            )
        except BaseException:
            handle.destroy_when_not_in_use()
            raise
        self._Node__add(subscription, self._subscriptions, self._Node__handle.messages)
        self._Node__add_event_handlers(subscription)
        return subscription

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client[Any, Any]:
        """Return a client of a service.

        Raises:
            InvalidServiceNameException: the name is invalid (a ValueError).
            InvalidHandle: the node is destroyed.
        """
        group = callback_group or self.default_callback_group
        check_is_valid_srv_type(srv_type)
        with self.handle:
            handle = ClientHandle(self._Node__handle, srv_type, srv_name, qos_profile)
        client: Client[Any, Any] = Client(
            self.context, handle, srv_type, srv_name, qos_profile, group
        )
        self._Node__add(client, self._clients, self._Node__handle.responses)
        return client

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service[Any, Any]:
        """Return a service; `callback` gets request and response, and returns the response.

        Raises:
            InvalidServiceNameException: the name is invalid (a ValueError).
            InvalidHandle: the node is destroyed.
        """
        group = callback_group or self.default_callback_group
        check_is_valid_srv_type(srv_type)
        with self.handle:
            handle = ServiceHandle(self._Node__handle, srv_type, srv_name, qos_profile)
        service: Service[Any, Any] = Service(
            handle, srv_type, srv_name, callback, group, qos_profile
        )
        self._Node__add(service, self._services, self._Node__handle.requests)
        return service

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., object] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Return a timer that calls `callback` every `timer_period_sec` seconds.

        Args:
            timer_period_sec: The period in seconds.
            callback: Called without arguments, or with a `TimerInfo` if it has a parameter
                annotated as one.
            callback_group: Its group.
            clock: The clock that it follows; the node's by default.
            autostart: Whether it starts now, rather than with `reset`.
        """
        period_ns = int(float(timer_period_sec) * S_TO_NS)
        group = callback_group or self.default_callback_group
        with self.handle:
            timer = Timer(
                callback,
                group,
                period_ns,
                self._clock if clock is None else clock,
                context=self.context,
                autostart=autostart,
            )
        timer.handle.signal = self._Node__handle.signal
        self._Node__add(timer, self._timers)
        return timer

    def create_guard_condition(
        self, callback: Callable[[], object], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Return a guard condition that makes an executor call `callback`."""
        group = callback_group or self.default_callback_group
        with self.handle:
            guard = GuardCondition(callback, group, context=self.context)
        guard.handle.signal = self._Node__handle.signal
        self._Node__add(guard, self._guards)
        return guard

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Return a rate, for a thread that sleeps while another one spins.

        Args:
            frequency: Ticks per second.
            clock: The clock that it follows; the node's by default.

        Raises:
            ValueError: `frequency` is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, self._rate_group, clock)
        return Rate(timer, context=self.context)

    def _Node__add(
        self, entity: Any, entities: list[Any], arrivals: Arrivals | None = None
    ) -> None:
        """Register an entity, and wake the executor.

        Args:
            entity: The entity.
            entities: The entities of its kind.
            arrivals: The arrivals of its kind, as something may already wait for it; None for kinds
                for which nothing arrives.
        """
        entity.callback_group.add_entity(entity)
        entities.append(entity)
        if arrivals is None:
            self._wake_executor()
        else:
            arrivals.note()

    def add_waitable(self, waitable: Waitable[Any]) -> None:
        """Add `waitable` to what the executor waits for."""
        self._Node__waitables.append(waitable)
        self._wake_executor()

    def remove_waitable(self, waitable: Waitable[Any]) -> None:
        """Undo `add_waitable`."""
        self._Node__waitables.remove(waitable)
        self._wake_executor()

    # The graph: nobody needs to spin for these queries

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Block the thread until a node with this name exists; return whether it appeared in time.

        Args:
            fully_qualified_node_name: Namespace and name; the leading slash may be omitted.
            timeout: The longest wait in seconds.
        """
        wanted = "/" + fully_qualified_node_name.removeprefix("/")
        return wait_until(
            lambda: wanted in self.get_fully_qualified_node_names(), self._context, timeout
        )

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic; with `no_mangle` its name is complete."""
        return self._Node__infos(EndpointKind.PUBLISHER, topic_name, is_complete=no_mangle)

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the subscriptions of a topic; with `no_mangle` its name is complete."""
        return self._Node__infos(EndpointKind.SUBSCRIPTION, topic_name, is_complete=no_mangle)

    def get_clients_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        """Return the clients of a service, in Lyrical; with `no_mangle` its name is complete."""
        return self._Node__services(EndpointKind.CLIENT, service_name, is_complete=no_mangle)

    def get_servers_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        """Return the servers of a service, in Lyrical; with `no_mangle` its name is complete."""
        return self._Node__services(EndpointKind.SERVER, service_name, is_complete=no_mangle)

    def _Node__services(
        self, kind: EndpointKind, service_name: str, *, is_complete: bool
    ) -> list[ServiceEndpointInfo]:
        endpoints = self._Node__handle.endpoints(kind, service_name, is_complete=is_complete)
        return [service_info_of(endpoint) for endpoint in endpoints]

    def _Node__infos(
        self, kind: EndpointKind, topic_name: str, *, is_complete: bool
    ) -> list[TopicEndpointInfo]:
        endpoints = self._Node__handle.endpoints(kind, topic_name, is_complete=is_complete)
        return [info_of(endpoint) for endpoint in endpoints]

    # End

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a publisher; return whether it belonged to this node."""
        self._Node__remove_event_handlers(publisher, self._publishers)
        return self._Node__destroy(publisher, self._publishers)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a subscription; return whether it belonged to this node."""
        self._Node__remove_event_handlers(subscription, self._subscriptions)
        return self._Node__destroy(subscription, self._subscriptions)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Destroy a client; return whether it belonged to this node."""
        return self._Node__destroy(client, self._clients)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Destroy a service; return whether it belonged to this node."""
        return self._Node__destroy(service, self._services)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer; return whether it belonged to this node."""
        return self._Node__destroy(timer, self._timers)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition; return whether it belonged to this node."""
        return self._Node__destroy(guard, self._guards)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate, and wake sleeping threads; return whether it belonged to this node."""
        success = self.destroy_timer(rate._timer)
        rate.destroy()
        return success

    def _Node__add_event_handlers(self, entity: Any) -> None:
        for handler in entity.event_handlers:
            if not isinstance(handler, DefaultHandler):
                self.add_waitable(handler)

    def _Node__remove_event_handlers(self, entity: Any, entities: list[Any]) -> None:
        if entity in entities:
            for handler in entity.event_handlers:
                if handler in self._Node__waitables:
                    self._Node__waitables.remove(handler)

    def _Node__destroy(self, entity: Any, entities: list[Any]) -> bool:
        try:
            entities.remove(entity)
        except ValueError:
            return False
        try:
            entity.destroy()
        except InvalidHandle:
            return False
        self._wake_executor()
        return True

    def destroy_node(self) -> None:
        """Destroy its entities, and leave the graph. Calling it again has no effect."""
        self._context.untrack_node(self)
        self._Node__parameter_store.publish = None
        ends: tuple[tuple[list[Any], Callable[[Any], bool]], ...] = (
            (self._publishers, self.destroy_publisher),
            (self._subscriptions, self.destroy_subscription),
            (self._clients, self.destroy_client),
            (self._services, self.destroy_service),
            (self._timers, self.destroy_timer),
            (self._guards, self.destroy_guard_condition),
        )
        for entities, destroy in ends:
            while entities:
                destroy(entities[0])
        self._type_description_service.destroy()
        self._Node__handle.destroy_when_not_in_use()
        self._wake_executor()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def as_profile(qos_or_depth: QoSProfile | int) -> QoSProfile:
    """Return a profile, given as such or as a depth.

    Raises:
        ValueError: the depth is negative.
        TypeError: it is neither.
    """
    if isinstance(qos_or_depth, core.QoSProfile):
        return as_own(qos_or_depth)
    if not isinstance(qos_or_depth, int):
        raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")
    if qos_or_depth < 0:
        raise ValueError("history depth must be greater than or equal to zero")
    return QoSProfile(depth=qos_or_depth)


BaseNode = Node
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
