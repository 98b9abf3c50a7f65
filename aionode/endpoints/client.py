"""Service clients: calls, their timeouts, and their ends."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.clock import perf_ns
from aionode.endpoints.core.entity import EndStage
from aionode.endpoints.core.future import Futures, asks
from aionode.endpoints.service_introspection import IntrospectedEntity
from aionode.endpoints.stats import ClientStats
from aionode.engine.causes import Party, Run, take
from aionode.engine.membership import register
from aionode.engine.rules.service_events import REQUEST_SENT, RESPONSE_RECEIVED
from aionode.engine.transport.base import SampleInfo
from aionode.errors import (
    AionodeError,
    EntityDestroyedError,
    MessageError,
    RequestTimeoutError,
    ServiceError,
    ServiceUnavailableError,
    silence,
)
from aionode.message import Message, checker

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.endpoints.core.endpoint import EndpointSetup
    from aionode.endpoints.publisher import Publisher
    from aionode.engine.transport.base import Call

__all__ = ["Client", "Exchange"]

RequestT = TypeVar("RequestT", bound=Message)

ResponseT = TypeVar("ResponseT", bound=Message)


class Client(IntrospectedEntity, Generic[RequestT, ResponseT]):
    """Calls a service. Created by `Node.create_client`.

    Attributes:
        srv_type: The service class.
        qos_profile: Its profile.
        stats: Counts and outcomes of the calls.
    """

    def __init__(
        self,
        setup: EndpointSetup,
        srv_type: Any,
        create_publisher: Callable[..., Publisher[Any]],
    ) -> None:
        subject = f"client of {setup.endpoint.name}"
        super().__init__(subject, setup, srv_type, create_publisher, EndStage.LAST)
        self.stats = ClientStats()
        self._requesters = tuple(  # one per transport
            register(
                setup.context,
                lambda transport: transport.create_requester(setup.endpoint, srv_type),
            )
        )
        self._check = checker(srv_type.Request)
        self._now_ns = setup.context.time_base.system_ns
        self._answers: set[asyncio.Future[Any]] = set()
        self._futures = Futures(self)
        self._warned = False
        self._has_told_caveat = False
        self._party = Party.of(self._endpoint)

    def __repr__(self) -> str:
        return (
            f"<Client {self.srv_name} {self._endpoint.type_name} "
            f"calls={self.stats.calls} errors={self.stats.errors}>"
        )

    def service_is_ready(self) -> bool:
        """Return whether a server is matched now."""
        return self._count_matched() > 0

    @asks
    async def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until a server is matched.

        Args:
            timeout_sec: The longest wait in seconds; None waits forever.

        Returns:
            True once a server is matched, False if none was within `timeout_sec`. A server that is
            known not to answer, on Fast DDS behind a bridge, counts as a match but is warned about
            in the log.

        Raises:
            EntityDestroyedError: the client was destroyed before or during the wait (a
                RuntimeError); its ``__cause__`` is the node's error, if it failed.
            CancelledError: the client was destroyed during the wait of one of the node's own
                tasks: a callback, or the body of ``async with node``.
        """
        self._refuse_if_destroyed()
        try:
            async with asyncio.timeout(timeout_sec):
                await self._until(self.service_is_ready)
        except TimeoutError:
            return self.service_is_ready()
        self._tell_caveat()
        return True

    async def call(self, request: RequestT, timeout_sec: float | None = None) -> ResponseT:
        """Send `request` and wait for the response.

        Without a server there is no answer, so limit the wait with `timeout_sec` or
        `asyncio.timeout`, or wait for the service first. A call that is cancelled or times out is
        dropped on both sides: a server that has not started it never does, and a late reply is
        ignored. If there are several servers, the first answer counts.

        Args:
            request: An instance of ``srv_type.Request``; it may be changed once the call has
                started.
            timeout_sec: The longest wait in seconds; None waits forever.

        Raises:
            TypeError: `request` is of another type.
            MessageError: a value does not fit its field.
            ServiceError: the handler failed; carries the type and text of its exception.
            ServiceUnavailableError: the server went away before it answered (a ServiceError).
            RequestTimeoutError: `timeout_sec` has passed (a TimeoutError).
            EntityDestroyedError: the client was destroyed before or during the call (a
                RuntimeError); its ``__cause__`` is the node's error, if it failed.
            CancelledError: the client was destroyed during a call of one of the node's own tasks: a
                callback, or the body of ``async with node``.
        """
        if self.destroyed:
            self._refuse_if_destroyed("call service")
        if type(request) is not self.srv_type.Request:
            self._check(request)
        began_ns = perf_ns()
        limit = None if timeout_sec is None else asyncio.timeout(timeout_sec)
        response: ResponseT
        try:
            if limit is None:
                response = await self._answer(self._begin(request))
            else:
                async with limit:
                    response = await self._answer(self._begin(request))
        except TimeoutError as error:
            self.stats.errors += 1
            if limit is not None and timeout_sec is not None and limit.expired():
                raise RequestTimeoutError(
                    self.srv_name, timeout_sec, self._servers(), self._caveat()
                ) from error
            raise
        except asyncio.CancelledError as error:
            self.stats.errors += 1
            error.add_note(f"{self.srv_name}: no reply; {silence(self._servers())}")
            raise
        except AionodeError as error:
            self.stats.errors += 1
            if isinstance(error, MessageError):
                error.add_note(f"in a call of {self.srv_name}")
            raise
        self.stats.run_time.record(perf_ns() - began_ns)
        return response

    def call_async(self, request: RequestT) -> asyncio.Future[ResponseT]:
        """Send `request`, and return a future of the response, as in rclpy.

        It is an asyncio future: await it, or use `add_done_callback`; `result` returns the
        response or raises what `call` raises in the task that asks for the future. Cancelling it
        cancels the call. A call made before the node runs is sent when the node starts.

        Args:
            request: An instance of ``srv_type.Request``.

        Raises:
            EntityDestroyedError: the client was destroyed (a RuntimeError).
            RuntimeError: no event loop is running.
        """
        self._refuse_if_destroyed("call service")
        return self._futures.begin(self.call(request))

    def _start(self, tasks: asyncio.TaskGroup) -> asyncio.Task[None] | None:
        """Send the calls that were made before the node ran."""
        task = super()._start(tasks)
        self._futures.start(tasks)
        return task

    async def _answer(self, exchange: Exchange) -> Any:
        """Return the first answer to a request."""
        try:
            return await exchange.answer
        except EntityDestroyedError:
            end = self._end_of_wait()
            raise end from end.__cause__
        finally:
            self._note_answer(exchange)
            exchange.cancel()

    def _note_answer(self, exchange: Exchange) -> None:
        """Count an answer among the causes of what the current task sends from now on."""
        answer = exchange.answer
        if self._causes is None or not answer.done() or answer.cancelled():
            return
        error = answer.exception()
        if error is None or type(error) is ServiceError:  # the server has answered
            now_ns = perf_ns()
            gid = self._party.gid
            take(Run(self._party, "response", gid, exchange.sequence, now_ns, now_ns))

    def _begin(self, request: RequestT) -> Exchange:
        """Send `request` to the servers matched now, and return the pending exchange.

        For requests that must outlive the task that sends them.

        Raises:
            TypeError: `request` is of another type.
            MessageError: a value does not fit its field.
        """
        self.stats.calls += 1
        servers = 0
        reached = []
        for requester in self._requesters:
            matched = requester.servers
            if matched:
                servers += matched
                reached.append(requester)
        if servers == 0:
            self._check(request)
            self._warn_of_silence()
        endpoint = self._endpoint
        sample_info = SampleInfo(endpoint.gid, self.stats.calls, self._now_ns())
        exchange = Exchange(endpoint.name, servers, self._answers)
        try:
            for requester in reached:
                exchange.open += 1
                exchange.calls.append(requester.send(request, sample_info, exchange))
        except BaseException:
            exchange.cancel()
            raise
        exchange.sequence = sample_info.sequence
        if self._causes is not None:
            self._causes.note("request", self._party, sample_info.sequence)
        if self._introspects and not self._is_internal(request):
            self._introspect(request, sample_info, exchange)
        return exchange

    def _introspect(self, request: Any, sample_info: SampleInfo, exchange: Exchange) -> None:
        """Publish that a request was sent, and its response when it arrives."""
        publish = self._introspection.publish
        publish(REQUEST_SENT, sample_info, request)

        def answered(answer: asyncio.Future[Any]) -> None:
            if not answer.cancelled() and answer.exception() is None:
                publish(RESPONSE_RECEIVED, sample_info, answer.result())

        exchange.answer.add_done_callback(answered)

    def _servers(self) -> int:
        return sum(requester.servers for requester in self._requesters)

    def _caveat(self) -> str:
        """Return why the matched servers may not answer, if a transport knows a reason."""
        return next((caveat for requester in self._requesters if (caveat := requester.caveat)), "")

    def _tell_caveat(self) -> None:
        """Log once why the matched servers may not answer, if a transport knows a reason."""
        caveat = self._caveat()
        if caveat and not self._has_told_caveat:
            self._has_told_caveat = True
            self._callbacks.logger.warning(
                f"{self.srv_name}: a server is matched, but may not answer: {caveat}"
            )

    def _warn_of_silence(self) -> None:
        if not self._warned:
            self._warned = True
            self._callbacks.logger.warning(
                f"{self.srv_name}: called while {silence(0)} The call waits without an answer; "
                "wait for the server first: wait_for_service() of a client, wait_for_server() of "
                "an action client"
            )

    def _close(self) -> None:
        """Withdraw the client; end its calls and the waits for a server."""
        self._leave_graph()
        # First, so that the calls do not fail as if the servers were gone.
        for answer in list(self._answers):
            if not answer.done():
                answer.set_exception(EntityDestroyedError(self._subject))
                answer.exception()  # mark it retrieved: perhaps nobody awaits it any more
        self._futures.close()
        self._introspection.close()
        for requester in self._requesters:
            requester.close()


class Exchange:
    """The client's end of one call; the first answer from any transport counts.

    A call that started without any server stays pending, since no server can go away.

    Args:
        service: Name of the service.
        servers: How many servers were matched when the call began.
        answers: The client's pending answers, which include this one until `cancel`.

    Attributes:
        answer: The response, or the error in its place; EntityDestroyedError if the client is
            destroyed. Cancelling a task that awaits it directly
            cancels it too, unless it is shielded by `asyncio.shield`.
        calls: The pending request in each transport.
        open: How many of `calls` may still answer.
        sequence: The number of the request.
    """

    def __init__(self, service: str, servers: int, answers: set[asyncio.Future[Any]]) -> None:
        self.answer: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self.calls: list[Call] = []
        self.open = 0
        self.sequence = 0
        self._service = service
        self._servers = servers
        self._answers = answers
        answers.add(self.answer)

    def reply(self, response: Any, sample_info: SampleInfo) -> None:  # noqa: ARG002  # part of ReplyTo
        """Take a response."""
        if not self.answer.done():
            self.answer.set_result(response)

    def fail(self, error: ServiceError) -> None:
        """Take a server's error."""
        if not self.answer.done():
            self.answer.set_exception(error)

    def end(self) -> None:
        """Mark one transport as finished: it will bring no more answers."""
        self.open -= 1
        if self.open == 0 and not self.answer.done():
            self.answer.set_exception(ServiceUnavailableError(self._service))

    def cancel(self) -> None:
        """Drop the call: a server that has not started it never will, and a reply is ignored."""
        self._answers.discard(self.answer)
        if not self.answer.cancel() and not self.answer.cancelled():
            self.answer.exception()  # mark it retrieved, so that asyncio does not report it
        for call in self.calls:
            call.cancel()
