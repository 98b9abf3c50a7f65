"""Service introspection: the events of a service's calls, published on a topic.

Both APIs use it: see `aionode.endpoints.service_introspection`.
"""

from __future__ import annotations

import contextlib
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import QueueFullError, brief

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Clock
    from aionode.engine.transport.base import SampleInfo
    from aionode.qos import QoSProfile

__all__ = [
    "REQUEST_RECEIVED",
    "REQUEST_SENT",
    "RESPONSE_RECEIVED",
    "RESPONSE_SENT",
    "TOPIC_SUFFIX",
    "Introspection",
    "ServiceIntrospectionState",
]

TOPIC_SUFFIX: Final = "/_service_event"
REQUEST_SENT: Final = 0
REQUEST_RECEIVED: Final = 1
RESPONSE_SENT: Final = 2
RESPONSE_RECEIVED: Final = 3


class ServiceIntrospectionState(IntEnum):
    """How much a client or server publishes about each request and response."""

    OFF = 0
    """Nothing, without even a publisher."""
    METADATA = 1
    """The client, the sequence number of the request, and the time."""
    CONTENTS = 2
    """The metadata, and the request or response itself."""

    __str__ = Enum.__str__  # as rclpy prints it: ServiceIntrospectionState.OFF


class Introspection:
    """Publishes the service events of one client or server.

    Args:
        srv_type: The service class.
        service_name: Full name of the service.
        create_publisher: Returns a publisher for a type, a topic and a profile.
    """

    def __init__(
        self, srv_type: Any, service_name: str, create_publisher: Callable[..., Any]
    ) -> None:
        self._srv_type = srv_type
        self._topic = service_name + TOPIC_SUFFIX
        self._create_publisher = create_publisher
        self._publisher: Any = None
        self._qos: QoSProfile | int | None = None
        self._clock: Clock | None = None
        self._state = ServiceIntrospectionState.OFF

    def configure(
        self, clock: Clock, qos_profile: QoSProfile | int, state: ServiceIntrospectionState
    ) -> bool:
        """Publish according to `state` from now on; return whether there is anything to publish.

        Raises:
            ValueError: `state` is unknown.
            TypeError: `clock` is not a clock, or `qos_profile` has the wrong type.
        """
        state = ServiceIntrospectionState(state)
        if not hasattr(clock, "now"):
            raise TypeError(
                f"configure_introspection of {self._topic}: clock is {brief(clock)}; expected a "
                "clock such as node.get_clock()"
            )
        if state is ServiceIntrospectionState.OFF or qos_profile != self._qos:
            self.close()
        if state is not ServiceIntrospectionState.OFF and self._publisher is None:
            self._publisher = self._create_publisher(self._srv_type.Event, self._topic, qos_profile)
            self._qos = qos_profile
        self._clock = clock
        self._state = state
        return self._publisher is not None

    def close(self) -> None:
        """Destroy the publisher."""
        publisher, self._publisher = self._publisher, None
        if publisher is not None:
            publisher.destroy()

    def publish(self, event_type: int, sample_info: SampleInfo, content: Any) -> None:
        """Publish one event.

        Args:
            event_type: One of the constants of `ServiceEventInfo`.
            sample_info: The client, and its sequence number for the request.
            content: The request or response.
        """
        publisher = self._publisher
        if publisher is None or publisher.destroyed or self._clock is None:
            return
        event = self._srv_type.Event()
        info = event.info
        info.event_type = event_type
        stamp = self._clock.now().to_msg()  # its class may belong to another message family
        info.stamp.sec, info.stamp.nanosec = stamp.sec, stamp.nanosec
        info.client_gid = list(sample_info.gid)
        info.sequence_number = sample_info.sequence
        if self._state is ServiceIntrospectionState.CONTENTS:
            if event_type in (REQUEST_SENT, REQUEST_RECEIVED):
                event.request = [content]
            else:
                event.response = [content]
        # A KEEP_ALL reader that does not read must not make the call fail.
        with contextlib.suppress(QueueFullError):
            publisher.publish(event)
