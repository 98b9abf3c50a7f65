"""Publishers, subscriptions, services, clients, timers and rates of a node."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Literal, TypeVar, overload

from aionode import qos
from aionode._node.parameters import NodeParameters
from aionode.clock import Clock
from aionode.endpoints._core.endpoint import EndpointSetup
from aionode.endpoints._core.silence_watch import SILENCE_SEC, Silence
from aionode.endpoints.client import Client
from aionode.endpoints.publisher import Publisher
from aionode.endpoints.service import Service
from aionode.endpoints.subscription import Subscription
from aionode.endpoints.timer import Rate, Timer
from aionode.endpoints.timer._timer import to_period_ns
from aionode.engine.loop_affinity import in_loop_thread
from aionode.errors import brief, shortened
from aionode.graph import SERVICE_KINDS, EndpointKind
from aionode.interfaces import fitting
from aionode.message import Message, ServiceType, holds_arrays
from aionode.parameter import declare_qos_overrides

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.content_filter import ContentFilterOptions
    from aionode.endpoints._core.callback_runner import OnError
    from aionode.endpoints._core.entity import Entity
    from aionode.endpoints._core.subscription_reader import Take
    from aionode.endpoints.events import PublisherEventCallbacks, SubscriptionEventCallbacks
    from aionode.endpoints.service import ServiceCallback
    from aionode.endpoints.subscription import SubscriptionCallback
    from aionode.endpoints.timer import TimerCallback
    from aionode.message import ServiceClass
    from aionode.parameter import QoSOverridingOptions
    from aionode.qos import QoSProfile

__all__ = ["NodeEndpoints"]

MsgT = TypeVar("MsgT", bound=Message)
RequestT = TypeVar("RequestT", bound=Message)
ResponseT = TypeVar("ResponseT", bound=Message)
TopicT = TypeVar("TopicT", Publisher[Any], Subscription[Any])
T = TypeVar("T")


class NodeEndpoints(NodeParameters):
    """The part of `aionode.Node` that creates and destroys endpoints, timers and rates."""

    @property
    def publishers(self) -> list[Publisher[Any]]:
        """The publishers of this node."""
        return self._Node__entities_of(Publisher)

    @property
    def subscriptions(self) -> list[Subscription[Any]]:
        """The subscriptions of this node."""
        return self._Node__entities_of(Subscription)

    @property
    def services(self) -> list[Service[Any, Any]]:
        """The services of this node."""
        return self._Node__entities_of(Service)

    @property
    def clients(self) -> list[Client[Any, Any]]:
        """The clients of this node."""
        return self._Node__entities_of(Client)

    @property
    def timers(self) -> list[Timer]:
        """The timers of this node."""
        return self._Node__entities_of(Timer)

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
        """Return a publisher of `msg_type`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; relative names are prefixed with the node's namespace.
            qos_profile: A profile, or a depth: the number of messages to keep.
            event_callbacks: Called with its events; without them, see `Publisher.events`.
            qos_overriding_options: Which policies parameters may override.

        Raises:
            TypeError: `msg_type` is not a message class, or another argument has the wrong type.
            ValueError: `qos_profile` is a negative number.
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("publisher")
        expect_message_type(msg_type, f"publisher of {topic}")
        setup = self._Node__endpoint_setup(
            EndpointKind.PUBLISHER, topic, msg_type, qos_profile, qos_overriding_options
        )
        publisher = Publisher(
            setup,
            msg_type,
            lambda: self.context._register(
                lambda transport: transport.create_writer(setup.endpoint, msg_type)
            ),
            self.context.time_base,
            event_callbacks,
        )
        return self._Node__add_with_events(publisher)

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
        """Return a subscription to `topic`.

        Args:
            msg_type: A message class.
            topic: Name of the topic; relative names are prefixed with the node's namespace.
            callback: Called with each message, or with message and `MessageInfo`; sync or async.
                Without one, iterate over the subscription with ``async for``.
            qos_profile: A profile, or a depth: the number of unread messages to keep.
            concurrent: How many calls of an async callback may run at once: one if False, any
                number if True, or a number.
            raw: Whether to deliver serialized messages (CDR bytes) instead of objects.
            on_error: What happens on an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function is called with (exception,
                CallbackContext).
            offload: Whether to run a sync callback in a thread.
            event_callbacks: Called with its events; without them, see `Subscription.events`.
            qos_overriding_options: Which policies parameters may override.
            content_filter_options: Which messages to deliver; see `set_content_filter`.
            on_silence: Called without arguments when the topic falls silent after a message: none
                has arrived for `silence_sec`, or nobody is left who has published. Sync or async;
                its exceptions are those of the callback. Before that, what is queued is dropped,
                and calls of the callback that have not ended are cancelled, or waited for in a
                thread. It is called again only after a message that is published later; earlier
                ones are dropped, however late they arrive.
            silence_sec: The longest silence, in seconds. The time while the host is suspended
                counts as well.
            clock: What the silence is measured with; the steady clock by default. With simulated
                time, a clock that nobody has set for `silence_sec` of the steady clock is silent.

        Raises:
            TypeError: an argument has the wrong type, a callback takes other arguments, or
                `on_silence` is given without a callback, or its settings without it.
            ValueError: `concurrent`, `on_error`, `qos_profile` or `silence_sec` is invalid.
            ContentFilterError: the filter is malformed, or does not fit the type (a ValueError).
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("subscription")
        expect_message_type(msg_type, f"subscription of {topic}")
        setup = self._Node__endpoint_setup(
            EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile, qos_overriding_options
        )
        subscription: Subscription[Any] = Subscription(
            setup,
            msg_type,
            callback,
            self.context.time_base,
            concurrent=concurrent,
            raw=raw,
            on_error=on_error,
            offload=offload,
            event_callbacks=event_callbacks,
            silence=Silence.given(
                on_silence,
                silence_sec,
                clock,
                f"subscription of {setup.endpoint.name}",
                has_callback=callback is not None,
            ),
        )
        if content_filter_options is not None:  # before messages can arrive
            subscription.set_content_filter(
                content_filter_options.filter_expression,
                content_filter_options.expression_parameters,
            )
        return self._Node__add_subscription(subscription)

    def _Node__create_direct_subscription(
        self, msg_type: type[Any], topic: str, take: Take, qos_profile: QoSProfile
    ) -> Subscription[bytes]:
        """Return a subscription that hands CDR bytes to `take` within the event that brings them.

        Messages come from now on, whether the node runs or not: those that transient local
        publishers have kept may come before this returns.

        Args:
            msg_type: A message class.
            topic: Name of the topic.
            take: Called with the bytes, or a list of their parts if they are many, the number, and
                the times of publishing and arrival; see `Take`.
                It never waits and never raises: it may be called within the `publish` of a node.
            qos_profile: A profile.

        Raises:
            InvalidTopicNameException: `topic` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("subscription")
        setup = self._Node__endpoint_setup(EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile)
        return self._Node__add_subscription(
            Subscription(
                setup,
                msg_type,
                None,
                self.context.time_base,
                concurrent=False,
                raw=True,
                on_error="raise",
                offload=False,
                take=take,
            )
        )

    def _Node__add_subscription(self, subscription: Subscription[T]) -> Subscription[T]:
        """Announce a subscription to the transports, and own it."""
        subscription._add_registrations(
            self.context._register(
                lambda transport: transport.create_reader(
                    subscription._endpoint, subscription.msg_type, subscription._reader
                )
            )
        )
        self._Node__add_with_events(subscription)
        return subscription

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
        """Return a service server of `srv_name`.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; relative names are prefixed with the node's namespace.
            callback: Called with (request, response), or with (request); returns the response; sync
                or async. The client gets an exception it raises as a `ServiceError`.
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
        self._Node__refuse_if_destroyed("service")
        expect_service_type(srv_type, f"service {srv_name}")
        setup = self._Node__endpoint_setup(EndpointKind.SERVER, srv_name, srv_type, qos_profile)
        service: Service[RequestT, ResponseT] = Service(
            setup,
            srv_type,
            callback,
            self.create_publisher,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
        )
        service._add_registrations(
            self.context._register(
                lambda transport: transport.create_server(setup.endpoint, srv_type, service._serve)
            )
        )
        return self._Node__add_entity(service)

    @in_loop_thread
    def create_client(
        self,
        srv_type: ServiceClass[RequestT, ResponseT],
        srv_name: str,
        *,
        qos_profile: QoSProfile | int = qos.qos_profile_services_default,
    ) -> Client[RequestT, ResponseT]:
        """Return a client of `srv_name`; await its `call`.

        Args:
            srv_type: A service class.
            srv_name: Name of the service; relative names are prefixed with the node's namespace.
            qos_profile: A profile, or a depth.

        Raises:
            TypeError: an argument has the wrong type.
            InvalidServiceNameException: `srv_name` is invalid (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("client")
        expect_service_type(srv_type, f"client of {srv_name}")
        setup = self._Node__endpoint_setup(EndpointKind.CLIENT, srv_name, srv_type, qos_profile)
        requesters = self.context._register(
            lambda transport: transport.create_requester(setup.endpoint, srv_type)
        )
        return self._Node__add_entity(
            Client(
                setup,
                srv_type,
                requesters,
                self.context.time_base,
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
        """Return a timer that calls `callback` every `timer_period_sec` seconds.

        The first call is one period from now. A late call does not delay later ones, missed calls
        are skipped, and calls never overlap.

        Args:
            timer_period_sec: The period in seconds; 0 calls as often as the event loop allows.
            callback: Called without arguments, or with a `TimerInfo`; sync or async.
            clock: The clock to follow; the node's clock by default. A callback group, rclpy's third
                argument, is accepted here with a warning, and has no effect.
            autostart: Whether it starts at once; otherwise `reset` starts it.
            on_error: What happens on an exception in the callback: ``"raise"`` ends the node,
                ``"log"`` logs and counts it, a function is called with (exception,
                CallbackContext).
            offload: Whether to run a sync callback in a thread.

        Raises:
            TypeError: an argument has the wrong type, or the callback takes other arguments.
            ValueError: the period is negative, or `on_error` is invalid.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("timer")
        timer = Timer(
            callback,
            to_period_ns(timer_period_sec),
            self._Node__clock_for_timer(clock),
            partial(self._Node__callbacks.make_runner, on_error=on_error, offload=offload),
            autostart=autostart,
        )
        return self._Node__add_entity(timer)

    def _Node__clock_for_timer(self, given: object) -> Clock:
        """Return the clock that a timer follows, from the third argument of `create_timer`."""
        if isinstance(given, Clock):
            return given
        if given is None:
            return self._Node__clock
        if not hasattr(given, "can_execute"):
            raise TypeError(
                f"create_timer: clock is {brief(given)}; give a clock such as SteadyClock(), or "
                "nothing for the node's clock"
            )
        kind = type(given).__name__
        if kind not in self._Node__warned_about:
            self._Node__warned_about.add(kind)
            self._Node__logger.warning(
                f"create_timer: the third argument is a {kind}, which has no effect: calls of one "
                "timer never overlap, and callbacks of different entities take turns where they "
                "await. In aionode this argument is the clock: write create_timer(period, "
                "callback), and concurrent= on subscriptions and services for calls at once"
            )
        return self._Node__clock

    @in_loop_thread
    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Return a rate, for ``await rate.sleep()`` or ``async for _ in rate``.

        Args:
            frequency: Ticks per second.
            clock: The clock to follow; the node's clock by default.

        Raises:
            TypeError: `frequency` is not a number.
            ValueError: `frequency` is not positive.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._Node__refuse_if_destroyed("rate")
        return self._Node__add_entity(
            Rate(frequency, self._Node__clock if clock is None else clock)
        )

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a publisher, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a subscription, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Destroy a service, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Destroy a client, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(timer)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate, as its `destroy` does; False if it is not one of this node's."""
        return self._Node__destroy(rate)

    def _Node__destroy(self, entity: Entity) -> bool:
        """Destroy `entity`; return whether it belonged to this node."""
        if entity not in self._Node__entities:
            return False
        entity.destroy()
        return True

    def _Node__add_with_events(self, endpoint: TopicT) -> TopicT:
        """Own a publisher or subscription, and what calls its event callbacks."""
        self._Node__add_entity(endpoint)
        monitor = endpoint._monitor
        if monitor is not None and monitor.handler is not None:
            self._Node__add_entity(monitor.handler)
        return endpoint

    def _Node__endpoint_setup(
        self,
        kind: EndpointKind,
        name: str,
        ros_type: Any,
        qos_profile: QoSProfile | int,
        overriding: QoSOverridingOptions | None = None,
    ) -> EndpointSetup:
        """Return what a new endpoint is made with; `_add_entity` puts it into the graph."""
        if self._Node__constructed:  # the built-in services are rarely called, and start without it
            load_arrays(ros_type)
        is_service = kind in SERVICE_KINDS
        full_name = self._Node__resolve(name, is_service=is_service)
        profile = qos.as_profile(qos_profile)
        if overriding is not None:
            entity: Literal["publisher", "subscription"] = (
                "publisher" if kind is EndpointKind.PUBLISHER else "subscription"
            )
            profile = declare_qos_overrides(self, full_name, entity, profile, overriding)
        others = [e.qos for e in self.graph.endpoints(kind.opposite, name=full_name)]
        if kind is EndpointKind.PUBLISHER:
            profile = qos.best_available_for_publisher(profile, others)
        elif kind is EndpointKind.SUBSCRIPTION:
            profile = qos.best_available_for_subscription(profile, others)
        endpoint = self.context._describe_endpoint(
            kind, self._Node__info, full_name, ros_type, profile.resolved()
        )
        return EndpointSetup(
            endpoint,
            self.graph,
            self._Node__callbacks,
            self._Node__affinity,
            self.context.network.queue_bytes,
        )


def load_arrays(ros_type: Any) -> None:
    """Import numpy if a type has fields that are arrays, so that no callback waits for the import.

    The built-in services have such fields too, but are rarely called: a node that uses no others
    starts without it.
    """
    halves = (ros_type,) if issubclass(ros_type, Message) else (ros_type.Request, ros_type.Response)
    if any(holds_arrays(half) for half in halves):
        import numpy  # noqa: F401, ICN001  # imported ahead of use


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
