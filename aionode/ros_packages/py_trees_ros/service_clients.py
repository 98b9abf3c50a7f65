"""Behaviours that call a service."""

from __future__ import annotations

import uuid
from abc import ABC, abstractmethod
from typing import Any

import py_trees
from py_trees.blackboard import Blackboard
from py_trees.common import Access, Status

from py_trees_ros._waiting import wait_for_server
from py_trees_ros.utilities import node_among

__all__ = ["AttributesFromBlackboard", "FromBlackboard", "FromCallback", "FromConstant"]


class FromBlackboard(py_trees.behaviour.Behaviour):
    """Calls a service with a request from the blackboard, and runs until the response.

    It fails if there is no request, or if the server is gone or fails. The response to a behaviour
    that is interrupted is ignored; what the server does is not undone.

    Args:
        name: The behaviour's name.
        service_type: The class of the service.
        service_name: The service's name.
        key_request: The key of the request.
        key_response: The key for the response, if it is to be written.
        wait_for_server_timeout_sec: How long `setup` waits for the server; negative to wait
            forever, with a warning each time that many seconds have passed, and 0 not to wait.
        callback_group: The callback group of the client.
    """

    def __init__(
        self,
        name: str,
        service_type: Any,
        service_name: str,
        key_request: str,
        key_response: str | None = None,
        wait_for_server_timeout_sec: float = -3.0,
        callback_group: Any = None,
    ) -> None:
        super().__init__(name)
        self.service_type = service_type
        self.service_name = service_name
        self.wait_for_server_timeout_sec = wait_for_server_timeout_sec
        self.callback_group = callback_group
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard.register_key(
            key="request", access=Access.READ, remap_to=Blackboard.absolute_name("/", key_request)
        )
        self.write_response_to_blackboard = key_response is not None
        if key_response is not None:
            self.blackboard.register_key(
                key="response",
                access=Access.WRITE,
                remap_to=Blackboard.absolute_name("/", key_response),
            )
        self.node: Any = None
        self.service_client: Any = None
        self.service_future: Any = None
        self.response: Any = None

    def setup(self, **kwargs: Any) -> None:
        """Create the client, and wait for the server.

        Raises:
            KeyError: The argument ``node`` is missing.
            TimedOutError: The server does not become available in time.
        """
        self.logger.debug(f"{self.qualified_name}.setup()")
        self.node = node_among(kwargs, self)
        client = self.service_client = self.node.create_client(
            self.service_type, self.service_name, callback_group=self.callback_group
        )
        wait_for_server(
            self,
            client.wait_for_service,
            self.wait_for_server_timeout_sec,
            "service",
            self.node.resolve_service_name(self.service_name),
        )

    def initialise(self) -> None:
        """Call the service if there are a request and a server."""
        self.logger.debug(f"{self.qualified_name}.initialise()")
        self.service_future = None
        try:
            request = self.blackboard.request
        except KeyError as error:
            self.logger.error(f"{error}")  # noqa: TRY400  # the logger of py_trees
            return
        if not self.service_client.service_is_ready():
            return
        try:
            self.service_future = self.service_client.call_async(request)
        except TypeError:
            self.logger.error(  # noqa: TRY400  # the logger of py_trees
                f"Received a request of type <{type(request).__name__}> instead of "
                f"<{self.service_type.Request.__name__}>"
            )

    def update(self) -> Status:
        """Check whether the response has arrived."""
        self.logger.debug(f"{self.qualified_name}.update()")
        if self.service_future is None:
            return Status.FAILURE
        if not self.service_future.done():
            return Status.RUNNING
        if self.service_future.exception() is not None:
            self.feedback_message = f"call failed [{self.service_future.exception()!r}]"
            return Status.FAILURE
        self.response = self.service_future.result()
        if self.write_response_to_blackboard:
            self.blackboard.response = self.response
        return Status.SUCCESS

    def terminate(self, new_status: Status) -> None:
        """Stop waiting for the response."""
        self.logger.debug(f"{self.qualified_name}.terminate({self.status}->{new_status})")
        if self.service_future is not None and not self.service_future.done():
            self.service_client.remove_pending_request(self.service_future)

    def shutdown(self) -> None:
        """Destroy the client."""
        if self.service_client is not None:
            self.service_client.destroy()


class FromConstant(FromBlackboard):
    """Always calls a service with the same request.

    Args:
        name: The behaviour's name.
        service_type: The class of the service.
        service_name: The service's name.
        service_request: The request.
        key_response: The key for the response, if it is to be written.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        service_type: Any,
        service_name: str,
        service_request: Any,
        key_response: str | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        key = f"/request_{uuid.uuid4()}"
        super().__init__(
            name, service_type, service_name, key, key_response, wait_for_server_timeout_sec
        )
        self.blackboard.register_key(key=key, access=Access.WRITE)
        self.blackboard.set(name=key, value=service_request)


class FromCallback(FromBlackboard, ABC):
    """Calls a service with the request that `get_request` of a subclass returns.

    Args:
        name: The behaviour's name.
        service_type: The class of the service.
        service_name: The service's name.
        key_response: The key for the response, if it is to be written.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        service_type: Any,
        service_name: str,
        key_response: str | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        self.key_request = f"/request_{uuid.uuid4()}"
        super().__init__(
            name,
            service_type,
            service_name,
            self.key_request,
            key_response,
            wait_for_server_timeout_sec,
        )
        self.blackboard.register_key(key=self.key_request, access=Access.WRITE)

    def initialise(self) -> None:
        """Get the request, and call the service."""
        self.blackboard.set(name=self.key_request, value=self.get_request())
        super().initialise()

    @abstractmethod
    def get_request(self) -> Any:
        """Return the request."""


class AttributesFromBlackboard(FromCallback):
    """Calls a service with a request whose fields are on the blackboard.

    Args:
        name: The behaviour's name.
        service_type: The class of the service.
        service_name: The service's name.
        request_fields: The key of each field.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        service_type: Any,
        service_name: str,
        request_fields: dict[str, str],
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        super().__init__(
            name,
            service_type,
            service_name,
            wait_for_server_timeout_sec=wait_for_server_timeout_sec,
        )
        self.request_fields = request_fields
        for key in request_fields.values():
            self.blackboard.register_key(key=key, access=Access.READ)

    def get_request(self) -> Any:
        """Return a request made of values on the blackboard.

        Raises:
            KeyError: A field is missing.
        """
        fields = {field: self.blackboard.get(key) for field, key in self.request_fields.items()}
        return self.service_type.Request(**fields)
