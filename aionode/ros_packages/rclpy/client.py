"""Service clients."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.engine.causes import take as take_cause
from rclpy._entities import ServiceEntity, in_use, wait_until
from rclpy._impl.context import LAST_CALL_S
from rclpy._impl.destroyable import Wakeup
from rclpy._impl.errors import RCLError
from rclpy._impl.services import ClientHandle
from rclpy._impl.uninterrupted import refuse_to_wait
from rclpy.task import Future
from rclpy.type_support import SrvType, SrvTypeRequest, SrvTypeResponse

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context
    from rclpy.qos import QoSProfile

__all__ = [
    "BaseClient",
    "Client",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
]

RequestT = TypeVar("RequestT")
ResponseT = TypeVar("ResponseT")


class Client(ServiceEntity[ClientHandle], Generic[RequestT, ResponseT]):
    """Calls a service. Made by `Node.create_client`.

    Attributes:
        context: Its context.
        srv_type: The service class.
        srv_name: The name with which it was created.
        qos_profile: Its profile.
        callback_group: Its group.
    """

    def __init__(
        self,
        context: Context,
        client_impl: ClientHandle,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        self.context = context
        self._handle = client_impl
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self._pending_requests: dict[int, Future[ResponseT]] = {}
        self._sequences: dict[Future[ResponseT], int] = {}  # the same requests, by their futures
        self.callback_group = callback_group
        self._executor_event = False
        # Held while numbers and futures of requests change: a response that arrives at once waits
        # until its future is registered. A signal handler may call while this thread holds it.
        self._lock = threading.RLock()

    @property
    def __client(self) -> ClientHandle:
        """The handle, under the name that programs know."""
        return self._handle

    def call(self, request: RequestT, timeout_sec: float | None = None) -> ResponseT | None:
        """Send a request, and block the thread until the response has arrived.

        It may be called in a callback: nobody needs to spin the client's node. But the server must
        be able to answer meanwhile, so the same single-threaded executor must not serve it.

        Args:
            request: The request.
            timeout_sec: Maximum time to wait, in seconds; None for no limit.

        Raises:
            TypeError: `request` is of another class.
            TimeoutError: no response arrived in time; a later one is dropped.
            RCLError: the context was shut down meanwhile, perhaps by a signal, or before, and no
                response arrived within a second; or a finalizer calls this where it cannot wait.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        refuse_to_wait()
        wakeup = Wakeup()
        responses: list[bytes] = []

        def take(data: bytes) -> None:
            responses.append(data)
            wakeup.wake()

        with self._handle:
            with self._lock:
                sequence = self._handle.send_request(request, take)
            try:
                if self.context.ok():
                    wait_until(lambda: responses, self.context, timeout_sec, wakeup)
                else:  # a last word, such as the stop of a motor after a signal
                    limit_s = LAST_CALL_S if timeout_sec is None else min(timeout_sec, LAST_CALL_S)
                    wakeup.wait(limit_s)
            finally:
                if not responses:  # perhaps a signal handler has raised
                    self._handle.forget(sequence)
            if not responses:
                if not self.context.ok():
                    raise RCLError(f"no response of {self.srv_name}: the context is shut down")
                raise TimeoutError
            response: ResponseT = self._handle.receive(sequence, responses[0])
            cause = self._handle.take_cause(sequence)
        if cause is not None:
            take_cause(cause)
        return response

    def call_async(self, request: RequestT) -> Future[ResponseT]:
        """Send a request, and return a future for the response; an executor completes it.

        Raises:
            TypeError: `request` is of another class.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        future: Future[ResponseT] = Future()
        with self._lock, self._handle:
            sequence = self._handle.send_request(request)
            self._sequences[future] = sequence
            self._pending_requests[sequence] = future
        future.add_done_callback(self.remove_pending_request)
        return future

    def get_pending_request(self, sequence_number: int) -> Future[ResponseT]:
        """Return the future of a request.

        Raises:
            KeyError: it was answered or given up.
        """
        with self._lock:
            return self._pending_requests[sequence_number]

    def remove_pending_request(self, future: Future[ResponseT]) -> None:
        """Give up a request; its future never completes."""
        with self._lock:
            sequence = self._sequences.get(future)
            if sequence is None:
                return
            self._pending_requests.pop(sequence, None)
            # last, so that an interrupted removal can be repeated
            self._sequences.pop(future, None)
            if not future.done():
                self._handle.forget(sequence)

    configure_introspection = in_use(ClientHandle.configure_introspection)
    service_is_ready = in_use(ClientHandle.service_server_is_available)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Block the thread until a server is available; nobody needs to spin.

        Args:
            timeout_sec: Maximum time to wait, in seconds; None for no limit.

        Returns:
            Whether one is available.
        """
        return wait_until(self.service_is_ready, self.context, timeout_sec)


BaseClient = Client
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
