"""Service servers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rclpy._entities import ServiceEntity, in_use
from rclpy._impl.services import ServiceHandle, rmw_request_id_t, rmw_service_info_t
from rclpy.type_support import SrvType, SrvTypeRequest, SrvTypeResponse

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.callback_groups import CallbackGroup
    from rclpy.qos import QoSProfile

__all__ = [
    "BaseService",
    "Service",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
]

RequestT = TypeVar("RequestT")
ResponseT = TypeVar("ResponseT")


class Service(ServiceEntity[ServiceHandle], Generic[RequestT, ResponseT]):
    """Answers requests. Created by `Node.create_service`.

    Attributes:
        srv_type: The service class.
        srv_name: The name with which it was created.
        callback: Called with request and response; returns the response.
        callback_group: Its group.
        qos_profile: Its profile.
    """

    def __init__(
        self,
        service_impl: ServiceHandle,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[RequestT, ResponseT], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        self._handle = service_impl
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.callback_group = callback_group
        self._executor_event = False
        self.qos_profile = qos_profile

    @property
    def __service(self) -> ServiceHandle:
        """The handle, under the name that programs know."""
        return self._handle

    configure_introspection = in_use(ServiceHandle.configure_introspection)

    def send_response(
        self, response: ResponseT, header: rmw_service_info_t | rmw_request_id_t
    ) -> None:
        """Answer the request with this header.

        Raises:
            TypeError: `response` is of another class, or `header` is not a header.
            InvalidHandle: the service is destroyed.
        """
        if not isinstance(response, self.srv_type.Response):
            raise TypeError
        if isinstance(header, rmw_service_info_t):
            header = header.request_id
        if not isinstance(header, rmw_request_id_t):
            raise TypeError
        with self._handle:
            self._handle.service_send_response(response, header)


BaseService = Service
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
