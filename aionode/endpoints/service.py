"""Service servers."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.clock import perf_ns
from aionode.endpoints.core.callback_runner import (
    accepts,
    checked_concurrency,
    consume,
    is_unfinished,
)
from aionode.endpoints.core.endpoint import report_heavy
from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.service_introspection import IntrospectedEntity
from aionode.endpoints.stats import CallbackStats
from aionode.engine.causes import note_end
from aionode.engine.membership import register
from aionode.engine.rules.service_events import REQUEST_RECEIVED, RESPONSE_SENT
from aionode.message import Message, type_name
from aionode.message.memory_size import memory_size

if TYPE_CHECKING:
    from aionode.endpoints.core.callback_runner import OnError
    from aionode.endpoints.core.endpoint import EndpointSetup
    from aionode.endpoints.publisher import Publisher
    from aionode.engine.transport.base import Request

__all__ = ["Service", "ServiceCallback"]

RequestT = TypeVar("RequestT", bound=Message)

ResponseT = TypeVar("ResponseT", bound=Message)

WAITING_REQUESTS = 10_000
"""Maximum queued requests; further ones are refused at once with an error.

Unlike a message, a request has a client waiting for the answer, so none is silently dropped because
of the profile's depth.
"""

REFUSED_SEC = 10.0
"""Minimum time between log lines about refused requests."""

ServiceCallback = (
    Callable[[RequestT, ResponseT], ResponseT | Coroutine[Any, Any, ResponseT]]
    | Callable[[RequestT], ResponseT | Coroutine[Any, Any, ResponseT]]
)


class Service(IntrospectedEntity, Generic[RequestT, ResponseT]):
    """Answers requests. Created by `Node.create_service`.

    Attributes:
        srv_type: The service class.
        qos_profile: Its profile.
        callback: Answers the requests.
        stats: Counts and durations of its requests.
    """

    def __init__(
        self,
        setup: EndpointSetup,
        srv_type: Any,
        callback: ServiceCallback[RequestT, ResponseT],
        create_publisher: Callable[..., Publisher[Any]],
        *,
        concurrent: bool | int,
        on_error: OnError,
        offload: bool,
    ) -> None:
        subject = f"service {setup.endpoint.name}"
        super().__init__(subject, setup, srv_type, create_publisher)
        self.callback = callback
        self.stats = CallbackStats()
        self._message_queue: MessageQueue[Request] = MessageQueue(
            WAITING_REQUESTS, self.stats, keep_all=True, slice_ns=setup.callbacks.slice_ns
        )
        size_of = memory_size(srv_type.Request)
        if size_of is not None:
            self._message_queue.weigh(
                lambda request: size_of(request.message),
                setup.context.network.queue_bytes,
                partial(report_heavy, setup, "refused"),
                unweighed=0,
            )
        self._concurrent = checked_concurrency(concurrent, self._subject)
        self._client_gid = b""  # of the last request that was started
        wants = accepts(
            callback, 2, 1, subject=self._subject, wanted="(request, response) or (request)"
        )
        self._wants_response = wants == 2  # request and response
        self._runner = setup.callbacks.make_runner(
            callback, self, self.stats, on_error=on_error, offload=offload
        )
        self._party = self._runner.party_of(self._endpoint)
        self._registrations = register(  # one per transport
            setup.context,
            lambda transport: transport.create_server(self._endpoint, srv_type, self._serve),
        )

    def __repr__(self) -> str:
        return (
            f"<Service {self.srv_name} {self._endpoint.type_name} "
            f"received={self.stats.received} errors={self.stats.errors}>"
        )

    def _serve(self, request: Request, inline_deadline_ns: int = 0) -> None:
        """Accept a request from a transport; see `Serve` for `inline_deadline_ns`."""
        if self.destroyed:
            request.drop()
        elif inline_deadline_ns and self._message_queue.take_inline(request, inline_deadline_ns):
            pass
        elif not self._message_queue.put(request):
            waiting = len(self._message_queue)
            problem = f"{waiting} requests are waiting already"
            if waiting < WAITING_REQUESTS:
                problem += ", which take as many bytes as may wait (AIONODE_QUEUE_BYTES)"
            self._callbacks.logger.warning(
                f"{self._subject}: refused a request, as {problem}; stats.dropped counts them",
                throttle_duration_sec=REFUSED_SEC,
            )
            request.fail("QueueFullError", problem)

    def _run(self) -> Coroutine[Any, Any, None]:
        """Return the coroutine that answers requests."""
        inline = self._runner.is_sync or self._concurrent is not False
        return consume(self._message_queue, self._handle, self._concurrent, inline=inline)

    def _handle(self, entered_ns: int, request: Request) -> Coroutine[Any, Any, None] | None:
        if request.cancelled:
            self.stats.dropped += 1
            request.drop()
            return None
        self.stats.received += 1
        self.stats.queue_wait.record(perf_ns() - entered_ns)
        self._client_gid = gid = request.sample_info.gid
        if self._causes is not None:
            self._causes.begin(
                self._party, "request", gid, request.sample_info.sequence, entered_ns
            )
        if self._introspects and not self._is_internal(request.message):
            self._introspection.publish(REQUEST_RECEIVED, request.sample_info, request.message)
        try:
            if self._wants_response:
                entered = self._runner.enter(request.message, self.srv_type.Response())
            else:
                entered = self._runner.enter(request.message)
            if is_unfinished(entered):
                return self._finish(request, entered)
            if self._causes is not None:
                note_end(perf_ns())
            self._reply(request, entered)
        except Exception as error:  # noqa: BLE001  # see `_fail`
            self._fail(request, error)
        return None

    async def _finish(self, request: Request, entered: Any) -> None:
        try:
            self._reply(request, await self._runner.outcome(entered))
        except asyncio.CancelledError:
            request.drop()
            raise
        except Exception as error:  # noqa: BLE001  # see `_fail`
            self._fail(request, error)

    def _fail(self, request: Request, error: Exception) -> None:
        """Send `error` to the client, then apply `on_error`."""
        request.fail(type(error).__name__, str(error))
        self._note_answer(request)
        self._runner.fail(error)

    def _reply(self, request: Request, response: Any) -> None:
        if not isinstance(response, self.srv_type.Response):
            given = "None" if response is None else f"a {type(response).__name__}"
            raise TypeError(
                f"{self._subject}: the handler returned {given} in place of "
                f"{type_name(self.srv_type.Response)}; it must end with `return response`"
            )
        request.reply(response)
        self._note_answer(request)
        if self._introspects and not self._is_internal(request.message):
            self._introspection.publish(RESPONSE_SENT, request.sample_info, response)

    def _note_answer(self, request: Request) -> None:
        """Note what caused an answer; it is identified like its request."""
        if self._causes is not None:
            gid, sequence = request.sample_info.gid, request.sample_info.sequence
            self._causes.note("response", self._party, sequence, gid=gid)

    def _close(self) -> None:
        """Withdraw the service, and drop the queued requests."""
        self._leave_graph()
        self._introspection.close()
        for registration in self._registrations:
            registration.close()
        for request in self._message_queue.discard():
            request.drop()
        self._message_queue.wake()
