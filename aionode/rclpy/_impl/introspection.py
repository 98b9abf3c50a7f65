"""Service introspection: each end of a call tells of it on ``<service>/_service_event``."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any

from aionode.clock import Time
from aionode.rclpy._impl.topics import PublisherHandle

if TYPE_CHECKING:
    from aionode.rclpy._impl.node import NodeHandle
    from aionode.rclpy._impl.timers import ClockHandle

__all__ = ["Introspection", "ServiceEvent", "ServiceIntrospectionState"]


class ServiceIntrospectionState(IntEnum):
    """What is told of a call."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class ServiceEvent(IntEnum):
    """What has happened; the values are those of service_msgs/msg/ServiceEventInfo."""

    REQUEST_SENT = 0
    REQUEST_RECEIVED = 1
    RESPONSE_SENT = 2
    RESPONSE_RECEIVED = 3


class Introspection:
    """What one client or server tells."""

    def __init__(self, node: NodeHandle, srv_type: Any, service: str) -> None:
        self._node = node
        self._event_type = srv_type.Event
        self._topic = f"{service}/_service_event"
        self._state = ServiceIntrospectionState.OFF
        self._publisher: PublisherHandle | None = None
        self._clock: ClockHandle | None = None

    def configure(
        self, clock: ClockHandle, qos_profile: Any, state: ServiceIntrospectionState
    ) -> None:
        """Tell this from now on."""
        self.close()
        self._clock = clock
        self._state = state
        if state is not ServiceIntrospectionState.OFF:
            self._publisher = PublisherHandle(
                self._node, self._event_type, self._topic, qos_profile
            )

    def tell(
        self,
        event: ServiceEvent,
        client_gid: bytes,
        sequence: int,
        *,
        request: Any = None,
        response: Any = None,
    ) -> None:
        """Tell of one step of a call."""
        if self._publisher is None or self._clock is None:
            return
        message = self._event_type()
        info = message.info
        info.event_type = int(event)
        info.stamp = Time(nanoseconds=self._clock.clock.now_ns()).to_msg()
        info.client_gid = list(client_gid)
        info.sequence_number = sequence
        if self._state is ServiceIntrospectionState.CONTENTS:
            message.request = [] if request is None else [request]
            message.response = [] if response is None else [response]
        self._publisher.publish(message)

    def close(self) -> None:
        """Tell nothing."""
        publisher, self._publisher = self._publisher, None
        if publisher is not None:
            publisher.destroy_when_not_in_use()
