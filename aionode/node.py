"""A node: names, clock, context and endpoints put together."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar, overload

from aionode import names, qos
from aionode._concurrency import to_the_end
from aionode._node import builtin_services
from aionode._node.actions import NodeActions
from aionode._node.end import EndRecord, NodeEnd
from aionode._node.graph import NodeGraphQueries
from aionode._node.parameters import NodeParameters
from aionode.arguments import Arguments, Usage, parse_arguments
from aionode.clock import ROSClock
from aionode.context import Context
from aionode.endpoints._core.callback_runner import Callbacks
from aionode.endpoints._core.entity import EndStage
from aionode.endpoints._core.graph_entry import GraphEntry
from aionode.endpoints._core.loop_affinity import LoopAffinity
from aionode.endpoints._core.shutdown import Ending
from aionode.endpoints._core.unenforced_qos import policies_without_effect
from aionode.endpoints.client import Client
from aionode.endpoints.publisher import Publisher
from aionode.endpoints.service import Service
from aionode.endpoints.subscription import Subscription
from aionode.endpoints.timer import Rate, Timer
from aionode.endpoints.timer._timer import to_period_ns
from aionode.errors import EntityDestroyedError, brief, shortened
from aionode.graph import EndpointKind
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.logging import get_logger
from aionode.message import Message, ServiceType, holds_arrays
from aionode.parameter import Parameter, ParameterStore, declare_qos_overrides

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from types import TracebackType

    from aionode.clock import Clock
    from aionode.endpoints._core.callback_runner import OnError
    from aionode.endpoints._core.entity import Entity
    from aionode.endpoints.service import ServiceCallback
    from aionode.endpoints.subscription import SubscriptionCallback
    from aionode.endpoints.timer import TimerCallback
    from aionode.graph import Graph
    from aionode.logging import RcutilsLogger
    from aionode.message import ServiceClass
    from aionode.parameter import QoSOverridingOptions
    from aionode.qos import QoSProfile
    from aionode.transport.base import Registration, Transport

__all__ = ["Node"]

MsgT = TypeVar("MsgT", bound=Message)
RequestT = TypeVar("RequestT", bound=Message)
ResponseT = TypeVar("ResponseT", bound=Message)
EntityT = TypeVar("EntityT", bound="Entity")
AnnouncedT = TypeVar("AnnouncedT", bound="Registration")


class Node(NodeActions, NodeGraphQueries, NodeParameters):
    """A participant in the system, with publishers, subscriptions, services, clients and timers.

    A node is made at any time, with or without a running event loop, and so are its entities. Its
    callbacks are called while it runs: inside ``async with node:``, or during ``await node.run()``.
    It runs once; a destroyed node refuses everything with EntityDestroyedError.

    An exception in the callback of a subscription or timer ends the node, unless the entity's
    `on_error` says otherwise: all its callbacks are cancelled, and the exception comes out of
    ``async with`` or `run` in an ExceptionGroup, as from an `asyncio.TaskGroup`. Services and
    action servers tell the caller, log the exception, and go on. What the body of ``async with``
    itself raises comes out as it is.

    Args:
        node_name: Letters, digits and underscores, not beginning with a digit.
        namespace: Prefix of its relative names; the root without it.
        context: Whom it shares graph and transports with; `Context.default()` without it.
        cli_args: Arguments for this node alone, as on a command line.
        use_global_arguments: Whether the arguments given to `aionode.run` hold for it too.
        enable_rosout: Whether its log goes to ``/rosout`` as well.
        rosout_qos_profile: The profile of that publisher.
        start_parameter_services: Whether others can read and set its parameters.
        parameter_overrides: Values that win over those of `declare_parameter`.
        allow_undeclared_parameters: Whether parameters can be set without being declared.
        automatically_declare_parameters_from_overrides: Whether each override declares one.
        enable_logger_service: Whether others can read and set its log levels.
        callback_budget_ms: How long, in milliseconds, a callback may block the event loop before
            that is reported.

    Raises:
        InvalidNodeNameException: `node_name` is invalid (a ValueError).
        InvalidNamespaceException: `namespace` is invalid (a ValueError).
        EntityDestroyedError: the context was shut down (a RuntimeError).
    """

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
        namespace = names.normalize_namespace(namespace)
        self.context = Context.default() if context is None else context
        # Where two arguments say something of the same, the node's own win: they come first among
        # the rules, of which the first that matches counts, and last among the parameters.
        own = parse_arguments(cli_args or ())
        own.refuse_unknown()
        self.uses_global_arguments = use_global_arguments
        shared = self.context.arguments if use_global_arguments else Arguments()
        self._rules = own.remap_rules + shared.remap_rules
        self._usages = [Usage(own), self.context.usage if use_global_arguments else Usage(shared)]
        for usage in self._usages:
            usage.note_node(node_name)
        node_name = names.remap_node_name(self._rules, node_name)
        namespace = names.remap_namespace(self._rules, node_name, namespace)
        self._made = False
        self._warned_of: set[str] = set()
        self._entities: dict[Entity, None] = {}
        self._tasks: asyncio.TaskGroup | None = None
        self._running = False
        self._destroyed = asyncio.Event()
        self._end_record = EndRecord(f"node {names.fully_qualified_name(namespace, node_name)}")
        self._clock = ROSClock(time_base=self.context.time_base)
        self._logger = get_logger(
            names.logger_name(namespace, node_name), now_ns=self.context.time_base.system_ns
        )
        self._callbacks = Callbacks(
            node=names.fully_qualified_name(namespace, node_name),
            logger=self._logger,
            budget_ns=round(callback_budget_ms * 1e6),
        )
        self._affinity = LoopAffinity()
        self._ending = Ending(self._entities, self._callbacks, self._leave)
        self._unlog: Callable[[], None] | None = None
        self._registrations: list[Registration] = []
        self._info = self.context.describe_node(
            node_name, namespace, enclave=own.enclave or shared.enclave or "/"
        )
        self.context.add_node(self)
        try:
            self._registrations = self._announced(lambda it: it.create_node(self._info))
            self.context.graph.add_node(self._info)
            if enable_rosout and shared.rosout_logs and own.rosout_logs:
                self._unlog = builtin_services.publish_log(self, rosout_qos_profile)
            full_name = self.get_fully_qualified_name()
            self._parameters = ParameterStore(
                full_name,
                overrides=[
                    *parameters_from(shared.parameters_for(full_name)),
                    *parameters_from(own.parameters_for(full_name)),
                    *(parameter_overrides or ()),
                ],
                allow_undeclared=allow_undeclared_parameters,
                publish=builtin_services.publish_parameter_events(self),
            )
            for usage in self._usages:
                if not usage.is_over:
                    usage.note_parameters(self._parameters)
            if automatically_declare_parameters_from_overrides:
                dynamic = ParameterDescriptor(dynamic_typing=True)
                for name in self._parameters.overrides:
                    self.declare_parameter(name, descriptor=dynamic)
            builtin_services.TimeSource(self, self._clock)
            if start_parameter_services:
                builtin_services.serve_parameters(self, self._parameters)
            builtin_services.serve_type_descriptions(self)
            if enable_logger_service:
                builtin_services.serve_logger_levels(self)
        except BaseException:
            self.destroy_node()  # or half a node would stay in its context
            raise
        self._made = True

    def __repr__(self) -> str:
        state = "destroyed" if self.destroyed else "running" if self._running else "not running"
        return f"<Node {self.get_fully_qualified_name()} {state} entities={len(self._entities)}>"

    # Lifetime

    async def __aenter__(self) -> Self:
        """Begin to run: open the context, and call callbacks from now on.

        Raises:
            RuntimeError: the node runs already, or was destroyed.
            TransportError: the context cannot connect.
        """
        if self.destroyed:
            raise EntityDestroyedError(f"node {self.get_fully_qualified_name()}", "run")
        if self._running:
            raise RuntimeError(f"node {self.get_fully_qualified_name()} runs already")
        self._running = True
        try:
            await self.context.acquire()
        except BaseException:
            self._running = False
            raise
        self._affinity.attach()
        self._end_record.begin()
        self._tasks = await asyncio.TaskGroup().__aenter__()
        for entity in list(self._entities):
            self._start(entity, self._tasks)
        for usage in self._usages:
            usage.begin(self.context.time_base, lambda: not self.destroyed, self._logger.warning)
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the node, and wait until its callbacks have ended; see `destroy_node`.

        What the body of ``async with`` raised comes out as it is, unless callbacks failed as well.

        Raises:
            ExceptionGroup: of what callbacks raised, and the body, if it raised too.
        """
        tasks = self._tasks
        assert tasks is not None  # noqa: S101  # set by __aenter__
        with self._end_record.recorded(exc):
            self.destroy_node()
            try:
                await to_the_end(self._ending.wait())
            except asyncio.CancelledError as cancelled:
                if exc is None:
                    exc_type, exc, traceback = type(cancelled), cancelled, cancelled.__traceback__
            try:
                await tasks.__aexit__(exc_type, exc, traceback)
            except BaseExceptionGroup as group:
                if group.exceptions != (exc,):
                    raise
            finally:
                self._running = False
                self._affinity.detach()
                await to_the_end(self.context.release())

    async def run(self) -> None:
        """Run until `destroy_node`, which any callback may call.

        Cancelling destroys the node.

        Raises:
            ExceptionGroup: of what callbacks raised.
            RuntimeError: the node runs already, or was destroyed.
            TransportError: the context cannot connect.
        """
        async with self:
            await self.until_destroyed()

    async def until_destroyed(self) -> None:
        """Wait until `destroy_node` is called, as `run` does inside its ``async with``.

        Cancelling has no effect on the node.
        """
        await self._destroyed.wait()

    async def ended(self) -> NodeEnd:
        """Wait until the node has ended, and return how and why.

        It has when its callbacks have ended and its context was given back: after ``async with`` or
        `run`, or at once if it was destroyed without ever running. Any number of tasks may wait,
        and later calls return the same at once. Never raises what the node failed with.
        Cancelling has no effect on the node.

        Raises:
            RuntimeError: it is awaited by the task that runs the node, which would wait for itself.
        """
        return await self._end_record.wait()

    @property
    def destroyed(self) -> bool:
        """Whether `destroy_node` was called."""
        return self._destroyed.is_set()

    @property
    def is_running(self) -> bool:
        """Whether callbacks are called: `run` or ``async with`` has begun and not ended."""
        return self._running

    def destroy_node(self) -> None:
        """End the node. Twice is allowed.

        Subscriptions, services, timers and action servers are destroyed at once, and their
        callbacks cancelled. Publishers, clients and the clock work until these have ended, so that
        a callback can stop a robot in ``finally``; then they are destroyed, and the node leaves the
        graph. In a node that does not run, all of that is done when this returns.

        `run` and ``async with`` wait for it, up to 5 s for callbacks and 1 s for the servers whose
        goals are cancelled, and send what was published. The log names callbacks that take long.

        It may be called in any thread; outside that of the node's event loop it returns before the
        loop has done it.
        """
        if self.destroyed:
            return
        if self._affinity.is_other_thread():
            self._affinity.call(self.destroy_node)
            return
        self._destroyed.set()
        self._ending.begin()

    def _leave(self) -> None:
        """End what is left when all entities are destroyed."""
        if self._unlog is not None:
            self._unlog()
        self._clock.destroy()
        for registration in self._registrations:
            registration.close()
        self.context.graph.remove_node(self._info)
        self.context.remove_node(self)
        if not self._running:
            self._end_record.note(NodeEnd("destroyed"))

    def abandon(self) -> None:
        """Leave everything to the process that this one was forked from. Called by the context."""
        self._affinity.detach()
        self._destroyed = asyncio.Event()  # without those who wait for it in the parent
        self._destroyed.set()
        self._tasks = None
        for entity in self._entities:
            entity.destroyed = True

    def call_in_loop(self, action: Callable[[], None]) -> None:
        """Do `action` in the thread of the node's loop: at once if this is it, or none runs."""
        self._affinity.call(action)

    # What it is

    def get_name(self) -> str:
        """Return the name without namespace."""
        return self._info.name

    def get_namespace(self) -> str:
        """Return the namespace, beginning with a slash."""
        return self._info.namespace

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name in one."""
        return self._info.fully_qualified_name

    def get_logger(self) -> RcutilsLogger:
        """Return the logger that bears the node's name."""
        return self._logger

    def get_clock(self) -> Clock:
        """Return the node's clock: ROS time, which is the system's unless `use_sim_time` is set."""
        return self._clock

    @property
    def graph(self) -> Graph:  # type: ignore[override]  # read-only here
        """The nodes and endpoints known now, and ``await node.graph.changed()``."""
        return self.context.graph

    @property
    def publishers(self) -> list[Publisher[Any]]:
        """The publishers of this node."""
        return self._entities_of(Publisher)

    @property
    def subscriptions(self) -> list[Subscription[Any]]:
        """The subscriptions of this node."""
        return self._entities_of(Subscription)

    @property
    def services(self) -> list[Service[Any, Any]]:
        """The services of this node."""
        return self._entities_of(Service)

    @property
    def clients(self) -> list[Client[Any, Any]]:
        """The clients of this node."""
        return self._entities_of(Client)

    @property
    def timers(self) -> list[Timer]:
        """The timers of this node."""
        return self._entities_of(Timer)

    def _entities_of(self, kind: type[EntityT]) -> list[EntityT]:
        return [entity for entity in self._entities if isinstance(entity, kind)]

    # Names

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic of this node, remapped unless `only_expand`.

        Raises:
            InvalidTopicNameException: `topic` is invalid (a ValueError).
        """
        return self._resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service of this node, remapped unless `only_expand`.

        Raises:
            InvalidServiceNameException: `service` is invalid (a ValueError).
        """
        return self._resolve(service, only_expand=only_expand, is_service=True)

    def _resolve(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        resolve = partial(names.resolve, is_service=is_service)
        if only_expand:
            return resolve(name, self.get_name(), self.get_namespace())
        for usage in self._usages:
            if not usage.is_over:
                expanded = resolve(name, self.get_name(), self.get_namespace())
                usage.note_name(
                    expanded, self.get_name(), self.get_namespace(), is_service=is_service
                )
        return resolve(name, self.get_name(), self.get_namespace(), self._rules)

    # Entities

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        qos_overriding_options: QoSOverridingOptions | None = None,
    ) -> Publisher[MsgT]:
        """Return a publisher of `msg_type`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; a relative one gets the node's namespace.
            qos_profile: A profile, or the number of messages to keep.
            qos_overriding_options: Which policies parameters may set.

        Raises:
            TypeError: `msg_type` is no message class, or `qos_profile` neither profile nor number.
            ValueError: `qos_profile` is a negative number.
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("publisher")
        expect_message_type(msg_type, f"publisher of {topic}")
        graph_entry = self._graph_entry(
            EndpointKind.PUBLISHER, topic, msg_type, qos_profile, qos_overriding_options
        )
        writers = self._announced(lambda it: it.create_writer(graph_entry.endpoint, msg_type))
        return self._add(
            Publisher(graph_entry, msg_type, writers, self.context.time_base), graph_entry
        )

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
        qos_overriding_options: QoSOverridingOptions | None = None,
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
        qos_overriding_options: QoSOverridingOptions | None = None,
    ) -> Subscription[MsgT]: ...

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
        qos_overriding_options: QoSOverridingOptions | None = None,
    ) -> Subscription[Any]:
        """Return a subscription to `topic`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; a relative one gets the node's namespace.
            callback: Called with each message, or with message and `MessageInfo`; sync or async.
                Without it the subscription is an async iterator.
            qos_profile: A profile, or the number of unread messages to keep.
            concurrent: False calls back one message after the other, True all at once, a number at
                most so many at once.
            raw: Whether to receive CDR bytes instead of messages.
            on_error: What becomes of an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function gets (exception, CallbackContext).
            offload: Whether to run a sync callback in a thread.
            qos_overriding_options: Which policies parameters may set.

        Raises:
            TypeError: an argument is of a wrong kind, or the callback takes other arguments.
            ValueError: `concurrent`, `on_error` or `qos_profile` has an impossible value.
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("subscription")
        expect_message_type(msg_type, f"subscription of {topic}")
        graph_entry = self._graph_entry(
            EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile, qos_overriding_options
        )
        subscription: Subscription[Any] = Subscription(
            graph_entry,
            msg_type,
            callback,
            self.context.time_base,
            concurrent=concurrent,
            raw=raw,
            on_error=on_error,
            offload=offload,
        )
        subscription.add_registrations(
            self._announced(
                lambda it: it.create_reader(graph_entry.endpoint, msg_type, subscription)
            )
        )
        return self._add(subscription, graph_entry)

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
        """Return a server of `srv_name`.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; a relative one gets the node's namespace.
            callback: Called with (request, response), or with (request); returns the response; sync
                or async. What it raises is told to the client as a `ServiceError` first.
            qos_profile: A profile, or a depth.
            concurrent: False answers one request after the other, True all at once, a number at
                most so many at once.
            on_error: What becomes of an exception in the callback, once the client was told:
                ``"log"`` logs it with its traceback, counts it and goes on, ``"raise"`` ends the
                node, a function gets (exception, CallbackContext).
            offload: Whether to run a sync callback in a thread.

        Raises:
            TypeError: an argument is of a wrong kind, or the callback takes other arguments.
            ValueError: `concurrent`, `on_error` or `qos_profile` has an impossible value.
            InvalidServiceNameException: `srv_name` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("service")
        expect_service_type(srv_type, f"service {srv_name}")
        graph_entry = self._graph_entry(EndpointKind.SERVER, srv_name, srv_type, qos_profile)
        service: Service[RequestT, ResponseT] = Service(
            graph_entry,
            srv_type,
            callback,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
        )
        service.add_registrations(
            self._announced(
                lambda it: it.create_server(graph_entry.endpoint, srv_type, service.serve)
            )
        )
        return self._add(service, graph_entry)

    def create_client(
        self,
        srv_type: ServiceClass[RequestT, ResponseT],
        srv_name: str,
        *,
        qos_profile: QoSProfile | int = qos.qos_profile_services_default,
    ) -> Client[RequestT, ResponseT]:
        """Return a client of `srv_name`, whose `call` is awaited.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; a relative one gets the node's namespace.
            qos_profile: A profile, or a depth.

        Raises:
            TypeError: an argument is of a wrong kind.
            InvalidServiceNameException: `srv_name` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("client")
        expect_service_type(srv_type, f"client of {srv_name}")
        graph_entry = self._graph_entry(EndpointKind.CLIENT, srv_name, srv_type, qos_profile)
        requesters = self._announced(lambda it: it.create_requester(graph_entry.endpoint, srv_type))
        return self._add(
            Client(graph_entry, srv_type, requesters, self.context.time_base), graph_entry
        )

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
        """Return a timer that calls `callback` every `timer_period_sec` seconds.

        The first call is one period from now. A late call does not move the later ones, and missed
        ones are skipped; calls never overlap.

        Args:
            timer_period_sec: The period in seconds; 0 calls as often as the loop allows.
            callback: Called without arguments, or with a `TimerInfo`; sync or async.
            clock: Whose time counts; the node's clock without it.
            autostart: Whether it runs at once, or only after `reset`.
            on_error: What becomes of an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function gets (exception, CallbackContext).
            offload: Whether to run a sync callback in a thread.

        Raises:
            TypeError: an argument is of a wrong kind, or the callback takes other arguments.
            ValueError: the period is negative, or `on_error` is an unknown word.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("timer")
        timer = Timer(
            callback,
            to_period_ns(timer_period_sec),
            self._clock if clock is None else clock,
            partial(self._callbacks.make_runner, on_error=on_error, offload=offload),
            autostart=autostart,
        )
        return self._add(timer)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Return a rate that one awaits: ``await rate.sleep()``, or ``async for _ in rate``.

        Args:
            frequency: Ticks per second.
            clock: Whose time counts; the node's clock without it.

        Raises:
            TypeError: `frequency` is no number.
            ValueError: `frequency` is not positive.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("rate")
        return self._add(Rate(frequency, self._clock if clock is None else clock))

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a publisher of this node, as `publisher.destroy()` does."""
        return self._destroy(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a subscription of this node, as `subscription.destroy()` does."""
        return self._destroy(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Destroy a service of this node, as `service.destroy()` does."""
        return self._destroy(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Destroy a client of this node, as `client.destroy()` does."""
        return self._destroy(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer of this node, as `timer.destroy()` does."""
        return self._destroy(timer)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate of this node, as `rate.destroy()` does."""
        return self._destroy(rate)

    def _destroy(self, entity: Entity) -> bool:
        """Destroy `entity`; return whether it was one of this node's."""
        if entity not in self._entities:
            return False
        entity.destroy()
        return True

    def _graph_entry(
        self,
        kind: EndpointKind,
        name: str,
        ros_type: Any,
        qos_profile: QoSProfile | int,
        overriding: QoSOverridingOptions | None = None,
    ) -> GraphEntry:
        """Return the entry of a new endpoint; it is entered into the graph by `_add`."""
        if self._made:
            load_arrays(ros_type)
        is_service = kind in {EndpointKind.SERVER, EndpointKind.CLIENT}
        full_name = self._resolve(name, is_service=is_service)
        profile = qos.as_profile(qos_profile)
        if overriding is not None:
            entity: Literal["publisher", "subscription"] = (
                "publisher" if kind is EndpointKind.PUBLISHER else "subscription"
            )
            profile = declare_qos_overrides(self, full_name, entity, profile, overriding)
        if self._made:
            self._warn_of_no_effect(kind, full_name, profile)
        others = [e.qos for e in self.graph.endpoints(kind.opposite, name=full_name)]
        if kind is EndpointKind.PUBLISHER:
            profile = qos.best_available_for_publisher(profile, others)
        elif kind is EndpointKind.SUBSCRIPTION:
            profile = qos.best_available_for_subscription(profile, others)
        endpoint = self.context.describe_endpoint(
            kind, self._info, full_name, ros_type, profile.resolved()
        )
        return GraphEntry(endpoint, self.graph, self._callbacks, self._affinity)

    def _warn_of_no_effect(self, kind: EndpointKind, name: str, profile: QoSProfile) -> None:
        """Say once of each endpoint which of its policies do nothing."""
        policies = policies_without_effect(profile, sends=kind is EndpointKind.PUBLISHER)
        subject = f"{kind.value} of {name}"
        if policies and subject not in self._warned_of:
            self._warned_of.add(subject)
            self._logger.warning(
                f"{subject}: {', '.join(policies)}: announced to others and compared with theirs, "
                "but without effect here: no event comes, and no message is dropped for it; to "
                "notice silence, let a timer look at the time of the last message"
            )

    def _add(self, entity: EntityT, graph_entry: GraphEntry | None = None) -> EntityT:
        """Take `entity` in: announce it, and start it if the node runs."""
        self._entities[entity] = None
        entity.adopt(self._forget)
        if graph_entry is not None:
            graph_entry.open()
        if self._tasks is not None:
            self._start(entity, self._tasks)
        return entity

    def _start(self, entity: Entity, tasks: asyncio.TaskGroup) -> None:
        """Let `entity` work; the end of the node waits for what calls callbacks."""
        task = entity.start(tasks)
        if task is not None and entity.stage is EndStage.CALLBACKS:
            self._ending.watch(task)

    def _announced(self, announce: Callable[[Transport], AnnouncedT]) -> list[AnnouncedT]:
        """Announce something to every transport of the context, or, if one refuses, to none."""
        made: list[AnnouncedT] = []
        try:
            made.extend(map(announce, self.context.transports))
        except BaseException:
            for registration in made:
                registration.close()
            raise
        return made

    def _forget(self, entity: Entity) -> None:
        self._entities.pop(entity, None)

    def _refuse_if_destroyed(self, wanted: str) -> None:
        if self.destroyed:
            raise EntityDestroyedError(
                f"node {self.get_fully_qualified_name()}", f"create {wanted}"
            )


def load_arrays(ros_type: Any) -> None:
    """Import numpy if values of a type need it, so that no callback has to wait for that.

    A node's own services need it too, but hardly ever; it starts without them waiting for it.
    """
    halves = (ros_type,) if issubclass(ros_type, Message) else (ros_type.Request, ros_type.Response)
    if any(holds_arrays(half) for half in halves):
        import numpy  # noqa: F401, ICN001  # imported to be there later


def parameters_from(values: Mapping[str, object]) -> list[Parameter]:
    """Return plain values as parameters."""
    return [Parameter(name, value=value) for name, value in values.items()]


def expect_message_type(msg_type: object, subject: str) -> None:
    """Raise TypeError unless `msg_type` is a message class."""
    if not (isinstance(msg_type, type) and issubclass(msg_type, Message)):
        raise TypeError(
            f"{shortened(subject)}: {brief(msg_type)} is no message class; use one such as "
            "aionode.interfaces.std_msgs.msg.String, or derive from aionode.message.Message"
        )


def expect_service_type(srv_type: object, subject: str) -> None:
    """Raise TypeError unless `srv_type` is a service class."""
    if not (isinstance(srv_type, type) and issubclass(srv_type, ServiceType)):
        raise TypeError(
            f"{shortened(subject)}: {brief(srv_type)} is no service class; use one such as "
            "aionode.interfaces.example_interfaces.srv.AddTwoInts, or derive from "
            "aionode.message.ServiceType"
        )
