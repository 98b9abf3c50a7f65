"""Service introspection: publish each request and response of a service on a topic.

An introspected client or server publishes on ``<service>/_service_event`` what it sends and
receives: the client ``REQUEST_SENT`` and ``RESPONSE_RECEIVED``, the server ``REQUEST_RECEIVED`` and
``RESPONSE_SENT``. All four share the client's gid and the sequence number of the request.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.endpoints.core.endpoint import Endpoint
from aionode.endpoints.core.entity import EndStage
from aionode.engine.rules.service_events import Introspection, ServiceIntrospectionState

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Clock
    from aionode.endpoints.core.endpoint import EndpointSetup
    from aionode.endpoints.publisher import Publisher
    from aionode.qos import QoSProfile

__all__ = ["ServiceIntrospectionState"]


class IntrospectedEntity(Endpoint):
    """A service or its client: its type, its name, and the introspection of its calls.

    Args:
        subject: What it is, for errors and logs.
        setup: What it uses of its node.
        srv_type: The service class.
        create_publisher: The node's method.
        stage: When it is destroyed as its node ends.

    Attributes:
        srv_type: The service class.
        qos_profile: Its profile.
    """

    def __init__(
        self,
        subject: str,
        setup: EndpointSetup,
        srv_type: Any,
        create_publisher: Callable[..., Publisher[Any]],
        stage: EndStage = EndStage.CALLBACKS,
    ) -> None:
        super().__init__(subject, setup, stage)
        self.srv_type = srv_type
        self._introspection = Introspection(srv_type, setup.endpoint.name, create_publisher)
        self._introspects = False  # whether it publishes events
        # Returns whether a request is internal and must not be published.
        self._is_internal: Callable[[Any], bool] = lambda _request: False

    @property
    def srv_name(self) -> str:
        """The full name of the service."""
        return self._endpoint.name

    service_name = srv_name

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile | int,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish each request and response sent or received from now on.

        The topic is ``<service>/_service_event``, and ``aionode service echo`` prints it. It may be
        called again at any time with another state.

        Args:
            clock: The source of time stamps, such as ``node.get_clock()``.
            service_event_qos_profile: QoS of the publisher.
            introspection_state: Whether to publish nothing, metadata only, or contents as well.

        Raises:
            TypeError: `clock` or the profile has the wrong type.
            ValueError: `introspection_state` is unknown.
            EntityDestroyedError: the service or client was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("configure introspection")
        self._introspects = self._introspection.configure(
            clock, service_event_qos_profile, introspection_state
        )
