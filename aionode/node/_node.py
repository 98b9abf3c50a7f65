"""The class `Node`, which programs instantiate or subclass.

Where its parts live:

- publishers, subscriptions, services, clients, timers, actions: each class is in `endpoints/`
- lifetime and owned entities: `NodeCore` in `endpoints/core/node_core.py`; the staged shutdown:
  `endpoints/core/shutdown.py`
- parameters, and the checks of their changes: `parameter/_store.py`
- graph queries: `engine/graph_queries.py`
"""

from __future__ import annotations

import asyncio
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar, overload

from aionode import names, qos
from aionode.clock import Clock
from aionode.endpoints.core.end_record import NodeEnd, failure_line
from aionode.endpoints.core.endpoint import EndpointSetup
from aionode.endpoints.core.future import asks
from aionode.endpoints.core.node_core import NodeCore, core_of, in_loop_thread, is_named
from aionode.endpoints.core.node_tasks import OWNER
from aionode.endpoints.core.silence_watch import SILENCE_SEC, Silence
from aionode.endpoints.publisher import Publisher
from aionode.endpoints.service import Service
from aionode.endpoints.subscription import Subscription
from aionode.endpoints.timer import Rate, Timer, to_period_ns
from aionode.engine.causes import CauseLog, Party
from aionode.engine.context import Context
from aionode.engine.graph_queries import (
    GraphQueries,
    NamesAndTypes,
    TopicEndpointInfo,
    actions_among,
    topic_endpoint_info,
)
from aionode.engine.membership import affinity_of, describe_endpoint, load_arrays
from aionode.errors import InterfaceNotFoundError, brief, shortened
from aionode.graph import SERVICE_KINDS, EndpointKind
from aionode.interfaces import fitting
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.message import ActionType, Message, ServiceType
from aionode.node import _builtin_services as builtin_services
from aionode.node._own_graph import OwnGraph
from aionode.node._time_source import TimeSource
from aionode.parameter import declare_qos_overrides, declare_struct
from aionode.parameter.methods import ParameterMethods

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Sequence
    from types import TracebackType

    from aionode.action import ActionClient, ActionServer, ServerGoalHandle
    from aionode.content_filter import ContentFilterOptions
    from aionode.endpoints.client import Client
    from aionode.endpoints.core.callback_runner import OnError
    from aionode.endpoints.core.subscription_reader import MessageInfo, Parts, Take
    from aionode.endpoints.events import PublisherEventCallbacks, SubscriptionEventCallbacks
    from aionode.endpoints.service import ServiceCallback
    from aionode.endpoints.subscription import SubscriptionCallback
    from aionode.endpoints.timer import TimerCallback
    from aionode.graph import EndpointInfo, Graph
    from aionode.logging import RcutilsLogger
    from aionode.message import ActionClass, ServiceClass
    from aionode.parameter import Parameter, QoSOverridingOptions
    from aionode.qos import QoSProfile

__all__ = ["Node", "direct_subscription"]

MsgT = TypeVar("MsgT", bound=Message)
RequestT = TypeVar("RequestT", bound=Message)
ResponseT = TypeVar("ResponseT", bound=Message)
GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)
TopicT = TypeVar("TopicT", Publisher[Any], Subscription[Any])
StructT = TypeVar("StructT")
T = TypeVar("T")
ConstructorT = TypeVar("ConstructorT", bound="Callable[..., None]")


def in_context_thread(constructor: ConstructorT) -> ConstructorT:
    """Run the constructor of `Node` in the thread of its context's loop, if the context is open."""

    @wraps(constructor)
    def construct(self: Node, *args: Any, **options: Any) -> None:
        affinity = affinity_of(options.get("context") or Context.default())
        if affinity.is_other_thread():
            affinity.wait_for(partial(constructor, self, *args, **options))
        else:
            constructor(self, *args, **options)

    return construct  # type: ignore[return-value]  # it has the same signature


def destroying_on_error(constructor: ConstructorT) -> ConstructorT:
    """Wrap a constructor so that it destroys the node if it raises.

    Otherwise a node that the program never received would stay in its context, next to the one that
    a supervisor creates in its place.
    """

    @wraps(constructor)
    def construct(self: Node, *args: Any, **options: Any) -> None:
        owner = OWNER.get()
        try:
            constructor(self, *args, **options)
        except BaseException:
            if is_named(self):  # otherwise its name was rejected, and there is nothing to destroy
                self.destroy_node()
            raise
        finally:
            if type(self).__init__ is construct:  # otherwise a subclass's constructor continues
                OWNER.set(owner)

    return construct  # type: ignore[return-value]  # it has the same signature


class Node(ParameterMethods, GraphQueries):
    """A participant in the ROS graph, with publishers, subscriptions, services, clients and timers.

    A node and its entities can be created at any time, with or without a running event loop, and in
    any thread: outside the thread of the context's event loop the call blocks until the loop has
    created them. Their callbacks are called while the node runs: inside ``async with node:``, or
    during ``await node.run()``. A node runs once; after `destroy_node`, any use raises
    EntityDestroyedError.

    An exception in the callback of a subscription or timer ends the node, unless the entity's
    `on_error` says otherwise: all its callbacks are cancelled, and the exception comes out of
    ``async with`` or `run` in an ExceptionGroup, as from an `asyncio.TaskGroup`. Services and
    action servers report the exception to the caller, log it, and carry on. An exception from the
    body of ``async with`` itself propagates unchanged.

    Args:
        node_name: Letters, digits and underscores, not beginning with a digit.
        namespace: Prefix of the node's relative names; the root by default.
        context: The context to join; `Context.default()` by default.
        cli_args: Arguments for this node only, as on a command line.
        use_global_arguments: Whether the arguments given to `aionode.run` apply to this node too.
        enable_rosout: Whether its log is also published on ``/rosout``.
        rosout_qos_profile: QoS of the ``/rosout`` publisher.
        start_parameter_services: Whether other nodes can read and set its parameters.
        parameter_overrides: Values that take precedence over those given to `declare_parameter`.
        allow_undeclared_parameters: Whether parameters can be set without being declared.
        automatically_declare_parameters_from_overrides: Whether to declare a parameter for each
            override.
        enable_logger_service: Whether other nodes can read and set its log levels.
        callback_budget_ms: How long, in milliseconds, a callback may block the event loop before it
            is reported.

    Raises:
        InvalidNodeNameException: `node_name` is invalid (a ValueError).
        InvalidNamespaceException: `namespace` is invalid (a ValueError).
        EntityDestroyedError: the context was shut down (a RuntimeError).
    """

    @destroying_on_error
    @in_context_thread
    def __init__(
        self,
        node_name: str,
        *,
        namespace: str | None = None,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = qos.qos_profile_rosout_default,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
        callback_budget_ms: float = 10.0,
    ) -> None:

        names.validate_node_name(node_name)
        core = NodeCore(
            self,
            node_name,
            names.normalize_namespace(namespace),
            Context.default() if context is None else context,
            cli_args,
            use_global_arguments=use_global_arguments,
            callback_budget_ms=callback_budget_ms,
            parameter_overrides=parameter_overrides or (),
            allow_undeclared_parameters=allow_undeclared_parameters,
        )
        self._aionode__core = core
        self.context = core.context
        ParameterMethods.__init__(self, core.parameters)
        GraphQueries.__init__(self, OwnGraph(core))
        core.join()
        if enable_rosout and core.shared_arguments.rosout_logs and core.own_arguments.rosout_logs:
            core.at_end.append(builtin_services.publish_log(self, rosout_qos_profile))
        core.parameters.publish = builtin_services.publish_parameter_events(self)
        for usage in core.usages:
            if not usage.is_over:
                usage.note_parameters(core.parameters)
        if automatically_declare_parameters_from_overrides:
            dynamic = ParameterDescriptor(dynamic_typing=True)
            for name in core.parameters.overrides:
                self.declare_parameter(name, descriptor=dynamic)
        TimeSource(self, core.clock)
        if start_parameter_services:
            builtin_services.serve_parameters(self, core.parameters)
        builtin_services.serve_type_descriptions(self)
        if enable_logger_service:
            builtin_services.serve_logger_levels(self)
        core.constructed = True

    def __init_subclass__(cls, **options: Any) -> None:
        """Wrap the constructor of each subclass: if it raises, the node leaves its context."""
        super().__init_subclass__(**options)
        if "__init__" in vars(cls):
            cls.__init__ = destroying_on_error(cls.__init__)  # type: ignore[method-assign]

    def __repr__(self) -> str:
        core = core_of(self)
        state = "destroyed" if self.destroyed else "running" if core.running else "not running"
        return f"<Node {self.get_fully_qualified_name()} {state} entities={len(core.entities)}>"

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start the node: open its context and start calling callbacks.

        Raises:
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        await core_of(self).start()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the node and wait until its callbacks have ended; see `destroy_node`.

        An exception from the body of ``async with`` propagates unchanged, unless callbacks failed
        as well.

        Raises:
            ExceptionGroup: the exceptions of callbacks, together with that of the body, if any.
        """
        await core_of(self).finish(exc_type, exc, traceback)

    async def run(self) -> None:
        """Run until `destroy_node` is called, which any callback may do.

        Cancelling destroys the node. When run in its own task, ``asyncio.create_task(node.run())``,
        it also logs one ERROR if the node fails, since nobody may ever await that task.

        Raises:
            ExceptionGroup: the exceptions of callbacks.
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        try:
            async with self:
                await self.until_destroyed()
        except Exception as error:
            tell_failure(core_of(self), error)
            raise

    async def until_destroyed(self) -> None:
        """Wait until `destroy_node` is called, as `run` does inside its ``async with``.

        Cancelling has no effect on the node.
        """
        await core_of(self).ending.wait()

    async def ended(self) -> NodeEnd:
        """Wait until the node has ended, and return how and why.

        A node has ended when its callbacks have ended and it has released its context: after
        ``async with`` or `run`, or at once if it was destroyed without ever running. Any number of
        tasks may wait, and later calls return the same result immediately. The node's own exception
        is returned, never raised. Cancelling has no effect on the node.

        Raises:
            RuntimeError: the task that runs the node awaits it, and would wait for itself.
        """
        return await core_of(self).record.wait()

    @property
    def destroyed(self) -> bool:
        """Whether `destroy_node` was called."""
        return core_of(self).ending.is_set()

    @property
    def is_running(self) -> bool:
        """Whether the node calls callbacks: `run` or ``async with`` is in progress."""
        return core_of(self).running

    def destroy_node(self) -> None:
        """End the node. Calling it again has no effect.

        Subscriptions, services, timers and action servers are destroyed at once, and their
        callbacks cancelled. Publishers, clients and the clock keep working until these callbacks
        have ended, so that a callback can stop a robot in ``finally``; then they are destroyed too,
        and the node leaves the graph. If the node is not running, all of this is done when the call
        returns.

        `run` and ``async with`` wait for it: up to 5 s for callbacks, 1 s for action servers to
        confirm that goals are canceled, and until published messages are sent. The log names
        callbacks that take long.

        It may be called in any thread. Outside the thread of the node's event loop it returns
        before the loop has done the work.
        """
        core_of(self).destroy()

    # Identity and names

    def get_name(self) -> str:
        """Return the name without namespace."""
        return core_of(self).info.name

    def get_namespace(self) -> str:
        """Return the namespace, which begins with a slash."""
        return core_of(self).info.namespace

    def get_fully_qualified_name(self) -> str:
        """Return the namespace and name, joined by a slash."""
        return core_of(self).info.fully_qualified_name

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger, which is named after the node."""
        return core_of(self).logger

    def get_clock(self) -> Clock:
        """Return the node's clock: ROS time, which is system time unless `use_sim_time` is set."""
        return core_of(self).clock

    @property
    def graph(self) -> Graph:
        """The nodes and endpoints known now, and ``await node.graph.changed()``."""
        return self.context.graph

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic of this node, remapped unless `only_expand`.

        Raises:
            InvalidTopicNameException: `topic` is invalid (a ValueError).
        """
        return core_of(self).resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service of this node, remapped unless `only_expand`.

        Raises:
            InvalidServiceNameException: `service` is invalid (a ValueError).
        """
        return core_of(self).resolve(service, only_expand=only_expand, is_service=True)

    # Parameters

    def declare_struct(
        self,
        struct_type: type[StructT],
        prefix: str = "",
        *,
        on_change: Callable[[StructT], None] | None = None,
    ) -> StructT:
        """Declare the fields of a class as parameters; return an instance that follows them.

        Args:
            struct_type: A `msgspec.Struct` or dataclass that is not frozen; `msgspec.Meta` gives
                ranges and descriptions.
            prefix: Prepended to all names, with a dot, unless it is empty.
            on_change: Called with the instance after each change.

        Raises:
            TypeError: a field has a type that parameters do not have, or the class is frozen.
            ParameterUninitializedException: a field has neither a default nor an override.
            InvalidParameterValueException: a default or an override is out of range.
            ParameterAlreadyDeclaredException: one of the names is already declared.
        """
        return declare_struct(self, struct_type, prefix, on_change=on_change)

    # Endpoints, timers and rates

    @property
    def publishers(self) -> list[Publisher[Any]]:
        """The publishers of this node."""
        return core_of(self).entities_of(Publisher)

    @property
    def subscriptions(self) -> list[Subscription[Any]]:
        """The subscriptions of this node."""
        return core_of(self).entities_of(Subscription)

    @property
    def services(self) -> list[Service[Any, Any]]:
        """The services of this node."""
        return core_of(self).entities_of(Service)

    @property
    def clients(self) -> list[Client[Any, Any]]:
        """The clients of this node."""
        from aionode.endpoints.client import Client  # nodes without clients start faster

        return core_of(self).entities_of(Client)

    @property
    def timers(self) -> list[Timer]:
        """The timers of this node."""
        return core_of(self).entities_of(Timer)

    @in_loop_thread
    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
    ) -> Publisher[MsgT]:
        """Create a publisher of `msg_type`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; relative names are prefixed with the node's namespace.
            qos_profile: A profile, or a depth: the number of messages to keep.
            event_callbacks: Called with the publisher's events; otherwise read them from
                `Publisher.events`.
            qos_overriding_options: The policies that parameters may override.

        Raises:
            TypeError: `msg_type` is not a message class, or another argument has the wrong type.
            ValueError: `qos_profile` is a negative number.
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        core_of(self).refuse_if_destroyed("publisher")
        expect_message_type(msg_type, f"publisher of {topic}")
        setup = endpoint_setup(
            self, EndpointKind.PUBLISHER, topic, msg_type, qos_profile, qos_overriding_options
        )
        publisher = Publisher(
            setup,
            msg_type,
            event_callbacks,
        )
        return core_of(self).add_with_events(publisher)

    @overload
    def create_subscription(
        self,
        msg_type: type[Message],
        topic: str,
        callback: SubscriptionCallback[bytes] | None = None,
        qos_profile: QoSProfile | int = 10,
        *,
        concurrent: bool | int = False,
        raw: Literal[True],
        on_error: OnError = "raise",
        offload: bool = False,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        content_filter_options: ContentFilterOptions | None = None,
        on_silence: Callable[[], object] | None = None,
        silence_sec: float = SILENCE_SEC,
        clock: Clock | None = None,
    ) -> Subscription[bytes]: ...

    @overload
    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: SubscriptionCallback[MsgT] | None = None,
        qos_profile: QoSProfile | int = 10,
        *,
        concurrent: bool | int = False,
        raw: Literal[False] = False,
        on_error: OnError = "raise",
        offload: bool = False,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        content_filter_options: ContentFilterOptions | None = None,
        on_silence: Callable[[], object] | None = None,
        silence_sec: float = SILENCE_SEC,
        clock: Clock | None = None,
    ) -> Subscription[MsgT]: ...

    @in_loop_thread
    def create_subscription(
        self,
        msg_type: type[Any],
        topic: str,
        callback: SubscriptionCallback[Any] | None = None,
        qos_profile: QoSProfile | int = 10,
        *,
        concurrent: bool | int = False,
        raw: bool = False,
        on_error: OnError = "raise",
        offload: bool = False,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        content_filter_options: ContentFilterOptions | None = None,
        on_silence: Callable[[], object] | None = None,
        silence_sec: float = SILENCE_SEC,
        clock: Clock | None = None,
    ) -> Subscription[Any]:
        """Create a subscription to `topic`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; relative names are prefixed with the node's namespace.
            callback: Called with each message, or with the message and its `MessageInfo`; sync or
                async. Without one, iterate over the subscription with ``async for``.
            qos_profile: A profile, or a depth: the number of unread messages to keep.
            concurrent: How many calls of an async callback may run at once: one if False, any
                number if True, or a number.
            raw: Whether to deliver serialized messages (CDR bytes) instead of objects.
            on_error: What happens on an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function is called with (exception,
                CallbackContext).
            offload: Whether to run a sync callback in a thread.
            event_callbacks: Called with the subscription's events; otherwise read them from
                `Subscription.events`.
            qos_overriding_options: The policies that parameters may override.
            content_filter_options: Selects the messages to deliver; see `set_content_filter`.
            on_silence: Called without arguments when the topic falls silent after a message: none
                has arrived for `silence_sec`, or all who published are gone. Sync or async; its
                exceptions are handled like those of the callback. Beforehand, queued messages are
                dropped, and running calls of the callback are cancelled, or waited for if in a
                thread. It is called again only after a message that was published later; earlier
                ones are dropped, however late they arrive.
            silence_sec: The longest silence, in seconds. Time while the host is suspended counts as
                well.
            clock: The clock that measures the silence; the steady clock by default. A simulated
                clock counts as silent if nobody has set it for `silence_sec` of the steady clock.

        Raises:
            TypeError: an argument has the wrong type, a callback takes other arguments, or
                `on_silence` is given without a callback, or its settings without `on_silence`.
            ValueError: `concurrent`, `on_error`, `qos_profile` or `silence_sec` is invalid.
            ContentFilterError: the filter is malformed, or does not fit the type (a ValueError).
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        core_of(self).refuse_if_destroyed("subscription")
        expect_message_type(msg_type, f"subscription of {topic}")
        setup = endpoint_setup(
            self, EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile, qos_overriding_options
        )
        subscription: Subscription[Any] = Subscription(
            setup,
            msg_type,
            callback,
            concurrent=concurrent,
            raw=raw,
            on_error=on_error,
            offload=offload,
            content_filter_options=content_filter_options,
            event_callbacks=event_callbacks,
            silence=Silence.given(
                on_silence,
                silence_sec,
                clock,
                f"subscription of {setup.endpoint.name}",
                has_callback=callback is not None,
            ),
        )
        return core_of(self).add_with_events(subscription)

    @in_loop_thread
    def create_service(
        self,
        srv_type: ServiceClass[RequestT, ResponseT],
        srv_name: str,
        callback: ServiceCallback[RequestT, ResponseT],
        *,
        qos_profile: QoSProfile | int = qos.qos_profile_services_default,
        concurrent: bool | int = False,
        on_error: OnError = "log",
        offload: bool = False,
    ) -> Service[RequestT, ResponseT]:
        """Create a server of the service `srv_name`.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; relative names are prefixed with the node's namespace.
            callback: Called with (request, response), or with (request); returns the response; sync
                or async. An exception that it raises reaches the client as a `ServiceError`.
            qos_profile: A profile, or a depth.
            concurrent: How many requests an async callback may answer at once: one if False, any
                number if True, or a number.
            on_error: What happens on an exception in the callback, after the client has been
                told: ``"log"`` logs it with its traceback, counts it and carries on, ``"raise"``
                ends the node, a function is called with (exception, CallbackContext).
            offload: Whether to run a sync callback in a thread.

        Raises:
            TypeError: an argument has the wrong type, or the callback takes other arguments.
            ValueError: `concurrent`, `on_error` or `qos_profile` is invalid.
            InvalidServiceNameException: `srv_name` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        core_of(self).refuse_if_destroyed("service")
        expect_service_type(srv_type, f"service {srv_name}")
        setup = endpoint_setup(self, EndpointKind.SERVER, srv_name, srv_type, qos_profile)
        service: Service[RequestT, ResponseT] = Service(
            setup,
            srv_type,
            callback,
            self.create_publisher,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
        )
        return core_of(self).add(service)

    @in_loop_thread
    def create_client(
        self,
        srv_type: ServiceClass[RequestT, ResponseT],
        srv_name: str,
        *,
        qos_profile: QoSProfile | int = qos.qos_profile_services_default,
    ) -> Client[RequestT, ResponseT]:
        """Create a client of `srv_name`; await its `call`.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; relative names are prefixed with the node's namespace.
            qos_profile: A profile, or a depth.

        Raises:
            TypeError: an argument has the wrong type.
            InvalidServiceNameException: `srv_name` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        from aionode.endpoints.client import Client  # nodes without clients start faster

        core_of(self).refuse_if_destroyed("client")
        expect_service_type(srv_type, f"client of {srv_name}")
        setup = endpoint_setup(self, EndpointKind.CLIENT, srv_name, srv_type, qos_profile)
        return core_of(self).add(
            Client(
                setup,
                srv_type,
                self.create_publisher,
            )
        )

    @in_loop_thread
    def create_timer(
        self,
        timer_period_sec: float,
        callback: TimerCallback,
        clock: Clock | None = None,
        autostart: bool = True,  # rclpy's signature
        *,
        on_error: OnError = "raise",
        offload: bool = False,
    ) -> Timer:
        """Create a timer that calls `callback` every `timer_period_sec` seconds.

        The first call is one period from now. A late call does not delay later ones, missed calls
        are skipped, and calls never overlap.

        Args:
            timer_period_sec: The period in seconds; 0 calls as often as the event loop allows.
            callback: Called without arguments, or with a `TimerInfo`; sync or async.
            clock: The clock to follow; the node's clock by default. A callback group, rclpy's third
                argument, is accepted here with a warning and has no effect.
            autostart: Whether to start at once; otherwise `reset` starts it.
            on_error: What happens on an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function is called with (exception,
                CallbackContext).
            offload: Whether to run a sync callback in a thread.

        Raises:
            TypeError: an argument has the wrong type, or the callback takes other arguments.
            ValueError: the period is negative, or `on_error` is invalid.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        core_of(self).refuse_if_destroyed("timer")
        timer = Timer(
            callback,
            to_period_ns(timer_period_sec),
            clock_for_timer(core_of(self), clock),
            partial(core_of(self).callbacks.make_runner, on_error=on_error, offload=offload),
            autostart=autostart,
            causes=timer_causes(core_of(self), timer_period_sec),
        )
        return core_of(self).add(timer)

    @in_loop_thread
    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate, for ``await rate.sleep()`` or ``async for _ in rate``.

        Args:
            frequency: Ticks per second.
            clock: The clock to follow; the node's clock by default.

        Raises:
            TypeError: `frequency` is not a number.
            ValueError: `frequency` is not positive.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        core_of(self).refuse_if_destroyed("rate")
        return core_of(self).add(Rate(frequency, core_of(self).clock if clock is None else clock))

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a publisher, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a subscription, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Destroy a service, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Destroy a client, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(timer)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate, as its `destroy` does; False if it is not one of this node's."""
        return core_of(self).destroy_entity(rate)

    # Actions

    def create_action_server(
        self,
        action_type: ActionClass[GoalT, ResultT, FeedbackT],
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any],
        *,
        goal_callback: Callable[[GoalT], Any] | None = None,
        handle_accepted_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        cancel_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        result_timeout: float = 10.0,
        max_goals: int = 1000,
        concurrent: bool | int = True,
        on_error: OnError = "log",
        offload: bool = False,
        on_client_lost: Literal["cancel", "continue"] | None = None,
        client_lost_sec: float = 3.0,
    ) -> ActionServer[GoalT, ResultT, FeedbackT]:
        """Create an action server; see `aionode.ActionServer` for all arguments."""
        from aionode.action import ActionServer  # nodes without actions start faster

        return ActionServer(
            self,
            action_type,
            action_name,
            execute_callback,
            goal_callback=goal_callback,
            handle_accepted_callback=handle_accepted_callback,
            cancel_callback=cancel_callback,
            result_timeout=result_timeout,
            max_goals=max_goals,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
            on_client_lost=on_client_lost,
            client_lost_sec=client_lost_sec,
        )

    def create_action_client(
        self, action_type: ActionClass[GoalT, ResultT, FeedbackT], action_name: str
    ) -> ActionClient[GoalT, ResultT, FeedbackT]:
        """Create an action client; see `aionode.ActionClient`."""
        from aionode.action import ActionClient  # nodes without actions start faster

        return ActionClient(self, action_type, action_name)

    async def find_type(self, name: str, *, endpoints: Sequence[EndpointInfo] | None = None) -> Any:
        """Return the message, service or action class of a type, given its name.

        That is the program's or aionode's own class. If neither has it, or the nodes that use the
        type define it differently, the class is made from the description sent by one of these
        nodes: at most five are asked, each for at most 2 s. Such a class is accepted only if its
        type hash is the one in the graph. Cancelling is safe. The result is `Any` to type
        checkers; `find_message`, `find_service` and `find_action` are checked::

            message = await node.find_type("my_robot_msgs/msg/Words")
            node.create_subscription(message, "/words", print)

        Args:
            name: Its ROS name.
            endpoints: Ask only the nodes of these endpoints; by default, of all that use the type.

        Raises:
            InterfaceNotFoundError: the type is unknown here, and no node describes it within the
                limits of a description; the text says what went wrong (a LookupError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        from aionode.node._type_lookup import find_type  # most programs know their types

        return await find_type(self, name, endpoints)

    async def find_message(
        self, name: str, *, endpoints: Sequence[EndpointInfo] | None = None
    ) -> type[Message]:
        """Return the class of a message type that is known by its name; see `find_type`.

        Raises:
            InterfaceNotFoundError: as `find_type`; or the type is not a message.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        found: type[Message] = await self.__found(name, Message, endpoints)
        return found

    async def find_service(
        self, name: str, *, endpoints: Sequence[EndpointInfo] | None = None
    ) -> ServiceClass[Message, Message]:
        """Return the class of a service type that is known by its name; see `find_type`.

        Code for arbitrary services passes type checks with it: the result fits `create_client`, and
        its ``Request`` fits `json_schema` and `from_builtins`::

            service = await node.find_service("std_srvs/srv/SetBool")
            request = from_builtins(service.Request, {"data": True})
            response = await node.create_client(service, "/light").call(request)

        Raises:
            InterfaceNotFoundError: as `find_type`; or the type is not a service.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        found: ServiceClass[Message, Message]
        found = await self.__found(name, ServiceType, endpoints)
        return found

    async def find_action(
        self, name: str, *, endpoints: Sequence[EndpointInfo] | None = None
    ) -> ActionClass[Message, Message, Message]:
        """Return the class of an action type that is known by its name; see `find_type`.

        Raises:
            InterfaceNotFoundError: as `find_type`; or the type is not an action.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        found: ActionClass[Message, Message, Message]
        found = await self.__found(name, ActionType, endpoints)
        return found

    async def __found(self, name: str, base: type, endpoints: Sequence[EndpointInfo] | None) -> Any:
        found = await self.find_type(name, endpoints=endpoints)
        if not (isinstance(found, type) and issubclass(found, base)):
            kind = base.__name__.removesuffix("Type").lower()
            problem = f"it is not of kind {kind}; find_type() finds a type of any kind"
            raise InterfaceNotFoundError(name, problem=problem)
        return found

    # The graph

    @asks
    async def wait_for_node(
        self,
        fully_qualified_node_name: str,
        timeout: float | None = None,
        *,
        check_interval: float = 0.1,  # noqa: ARG002  # rclpy's signature
    ) -> bool:
        """Wait until a node of this name exists.

        Args:
            fully_qualified_node_name: Namespace and name; the leading slash is optional.
            timeout: The longest wait, in seconds; None waits forever.
            check_interval: Ignored: the wait ends as soon as the graph changes.

        Returns:
            True if the node exists, False if `timeout` has passed.

        Raises:
            EntityDestroyedError: this node ended before or during the wait (a RuntimeError); its
                ``__cause__`` is the error that the node failed with, if any.
            CancelledError: this node ended while one of its own tasks was waiting: a callback, or
                the body of ``async with node``.
        """
        wanted = "/" + fully_qualified_node_name.removeprefix("/")
        own = self.get_fully_qualified_name()

        def is_there() -> bool:
            return bool(self.graph.nodes_named(wanted))

        try:
            async with asyncio.timeout(timeout):
                while not is_there():
                    if core_of(self).info not in self.graph.nodes_named(own):
                        raise core_of(self).tasks.end_of_wait(f"node {own}")
                    await self.graph.changed(wanted, own)
        except TimeoutError:
            return is_there()
        return True

    # Topics by name

    def get_publishers_info_by_topic(
        self,
        topic_name: str,
        no_mangle: bool = False,  # noqa: ARG002  # rclpy's signature
    ) -> list[TopicEndpointInfo]:
        """Return every publisher of a topic; `no_mangle` is ignored."""
        return topic_endpoints(self, EndpointKind.PUBLISHER, topic_name)

    def get_subscriptions_info_by_topic(
        self,
        topic_name: str,
        no_mangle: bool = False,  # noqa: ARG002  # rclpy's signature
    ) -> list[TopicEndpointInfo]:
        """Return every subscription of a topic; `no_mangle` is ignored."""
        return topic_endpoints(self, EndpointKind.SUBSCRIPTION, topic_name)

    # Actions

    def get_action_names_and_types(self) -> NamesAndTypes:
        """Return all actions, with their types."""
        return actions_among(self.get_topic_names_and_types())

    def get_action_server_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the actions that a node serves.

        Raises:
            NodeNameNonExistentError: there is no node of this name.
        """
        return actions_among(self.get_publisher_names_and_types_by_node(node_name, node_namespace))

    def get_action_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the actions that a node calls.

        Raises:
            NodeNameNonExistentError: there is no node of this name.
        """
        return actions_among(self.get_subscriber_names_and_types_by_node(node_name, node_namespace))


# Helpers of the methods above


def tell_failure(core: NodeCore, error: Exception) -> None:
    """Log why a node failed, if its task runs nothing but `run`.

    Such a task may be awaited late or never, and asyncio reports its exception only when the task
    is garbage-collected.
    """
    task = asyncio.current_task()
    coroutine = None if task is None else task.get_coro()
    if getattr(coroutine, "cr_code", None) is Node.run.__code__:
        core.logger.error(
            f"the node failed and has ended: {failure_line(error)}. "
            "To get the exception, await the task of run()"
        )


def endpoint_setup(
    node: Node,
    kind: EndpointKind,
    name: str,
    ros_type: Any,
    qos_profile: QoSProfile | int,
    overriding: QoSOverridingOptions | None = None,
) -> EndpointSetup:
    """Return the arguments for a new endpoint of a node; `NodeCore.add` puts it into the graph."""
    core = core_of(node)
    if core.constructed:  # the built-in services do without
        load_arrays(ros_type)
    full_name = core.resolve(name, is_service=kind in SERVICE_KINDS)
    profile = qos.as_profile(qos_profile)
    if overriding is not None:
        entity: Literal["publisher", "subscription"] = (
            "publisher" if kind is EndpointKind.PUBLISHER else "subscription"
        )
        profile = declare_qos_overrides(node, full_name, entity, profile, overriding)
    context = core.context
    endpoint = describe_endpoint(context, kind, core.info, full_name, ros_type, profile)
    return EndpointSetup(endpoint, context, core.callbacks)


def timer_causes(core: NodeCore, period_sec: float) -> tuple[CauseLog, Party] | None:
    """Return the log for the calls of a new timer, and the timer as their party; or None."""
    log = core.context.causes
    if log is None:
        return None
    name, gid = f"timer of {period_sec:g} s", core.context.new_uuid()
    return log, Party("timer", core.info.fully_qualified_name, name, gid)


def direct_subscription(
    node: Node, msg_type: type[Any], topic: str, take: Take, qos_profile: QoSProfile
) -> Subscription[bytes]:
    """Create a subscription that passes CDR bytes to `take` in the loop event that brings them.

    Messages arrive from now on, whether the node is running or not: those kept by transient local
    publishers may arrive before this returns.

    Args:
        node: The node that subscribes.
        msg_type: A message class.
        topic: Name of the topic.
        take: Called with the bytes (a list of parts if there are many, and a memoryview if the
            sender lends them), the sequence number, and the times of publishing and arrival; see
            `Take`. It must not block or raise, as it may be called inside the `publish` of a node.
        qos_profile: A profile.

    Raises:
        InvalidTopicNameException: `topic` is invalid (a ValueError).
        EntityDestroyedError: the node was destroyed (a RuntimeError).
    """
    core = core_of(node)
    core.refuse_if_destroyed("subscription")
    subscription: Subscription[bytes] = Subscription(
        endpoint_setup(node, EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile),
        msg_type,
        None,
        concurrent=False,
        raw=True,
        on_error="raise",
        offload=False,
        take=take,
    )
    return core.add_with_events(subscription)


def parts_subscription(
    node: Node,
    msg_type: type[Any],
    topic: str,
    callback: Callable[[Parts, MessageInfo], Awaitable[None] | None],
    qos_profile: QoSProfile,
    event_callbacks: SubscriptionEventCallbacks,
) -> Subscription[Parts]:
    """Create a subscription that passes CDR bytes to `callback` as they arrive; see `Parts`.

    Its errors are logged. The arguments are those of `Node.create_subscription`.

    Raises:
        InvalidTopicNameException: `topic` is invalid (a ValueError).
        EntityDestroyedError: the node was destroyed (a RuntimeError).
    """
    core = core_of(node)
    core.refuse_if_destroyed("subscription")
    subscription: Subscription[Parts] = Subscription(
        endpoint_setup(node, EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile),
        msg_type,
        callback,
        concurrent=False,
        raw="parts",
        on_error="log",
        offload=False,
        event_callbacks=event_callbacks,
    )
    return core.add_with_events(subscription)


def clock_for_timer(core: NodeCore, given: object) -> Clock:
    """Return the clock of a timer, given the third argument of `create_timer`."""
    if isinstance(given, Clock):
        return given
    if given is None:
        return core.clock
    if not hasattr(given, "can_execute"):
        raise TypeError(
            f"create_timer: clock is {brief(given)}; give a clock such as SteadyClock(), or "
            "nothing for the node's clock"
        )
    kind = type(given).__name__
    if kind not in core.warned_about:
        core.warned_about.add(kind)
        core.logger.warning(
            f"create_timer: the third argument is a {kind}, which has no effect: calls of one "
            "timer never overlap, and callbacks of different entities take turns where they "
            "await. In aionode this argument is the clock: write create_timer(period, "
            "callback), and concurrent= on subscriptions and services for calls at once"
        )
    return core.clock


def topic_endpoints(node: Node, kind: EndpointKind, topic_name: str) -> list[TopicEndpointInfo]:
    """Return the endpoints of a kind on a topic, whose name is resolved as in this node."""
    name = node.resolve_topic_name(topic_name)
    return [topic_endpoint_info(found) for found in node.graph.endpoints(kind, name=name)]


def expect_message_type(msg_type: object, subject: str) -> None:
    """Raise TypeError unless `msg_type` is a message class."""
    if not (isinstance(msg_type, type) and issubclass(msg_type, Message)):
        raise TypeError(
            f"{shortened(subject)}: {brief(msg_type)} is not a message class; "
            f"{fitting(msg_type, 'aionode.interfaces.std_msgs.msg.String')}, "
            "or derive from aionode.message.Message"
        )


def expect_service_type(srv_type: object, subject: str) -> None:
    """Raise TypeError unless `srv_type` is a service class."""
    if not (isinstance(srv_type, type) and issubclass(srv_type, ServiceType)):
        raise TypeError(
            f"{shortened(subject)}: {brief(srv_type)} is not a service class; "
            f"{fitting(srv_type, 'aionode.interfaces.example_interfaces.srv.AddTwoInts')}, "
            "or derive from aionode.message.ServiceType"
        )
