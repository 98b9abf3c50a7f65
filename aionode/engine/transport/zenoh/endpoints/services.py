"""Servers and clients on Zenoh: a request is a query, a response its reply."""

from __future__ import annotations

import logging
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import zenoh

from aionode._process.concurrency import running_loop
from aionode.clock import perf_ns
from aionode.engine.transport.base import Request, Requester, SampleInfo
from aionode.engine.transport.drops import Drop
from aionode.engine.transport.zenoh._session_state import Declaration, size_of
from aionode.engine.transport.zenoh.connections.handlers import CALL_PRIORITY, direct, translated
from aionode.engine.transport.zenoh.delivery.delivery import UNKNOWN_GID, sample_info_of
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.errors import DecodeError, ServiceError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Call, ReplyTo, Serve
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.graph import EndpointInfo, Graph

__all__ = ["ZenohRequester", "ZenohServer", "error_payload", "parse_error"]

logger = logging.getLogger("aionode.transport.zenoh")

FOREVER_S = 1e9
"""Timeout of a request for the result of a goal, which may take any time."""

LONG_S = 600.0
"""Timeout of a request, as in ROS; the effective limit is the caller's, which cancels the call."""

SHORT_S = 30.0
"""Timeout of the requests of a client that calls frequently."""

OFTEN = 1_000
"""Number of calls within `LONG_S` that counts as frequent. Zenoh remembers a query until its
timeout, answered or not: some 700 bytes each."""

AGAIN_S = (0.005, 0.03, 0.15)
"""Delays before a request is resent that found no server although there is one, in seconds.

The token of a server can be visible shortly before requests find their way to it. A request that
ends later than `AT_ONCE_NS` was received, and is not resent.
"""

AT_ONCE_NS = 50_000_000

ARRIVING_REQUESTS = 50_000
"""Maximum number of requests waiting for the loop, before the service counts and refuses them.
"""

UNANNOUNCED = 8
"""Maximum number of threads that send answers to clients without a token, whose ids are
arbitrary."""

TOO_MANY = (
    "other requests are waiting already in this process, of all clients or of this one, which take "
    "as many bytes as may wait (AIONODE_QUEUE_BYTES)"
)

FRESH_NS = 100_000_000
"""A request that is no older than this, by its stamp, shows that its client is alive."""


def error_payload(error_type: str, error_text: str) -> bytes:
    """Return an error in the form that is sent to clients."""
    import json  # only errors need it

    return json.dumps({"type": error_type, "text": error_text}).encode()


def parse_error(payload: bytes, service: str) -> ServiceError:
    """Parse an error from a server; it has a type if the server runs aionode."""
    import json  # only errors need it

    text = payload.decode(errors="replace")
    try:
        fields = json.loads(text)
        error_text, error_type = str(fields["text"]), str(fields["type"])
        (error_text + error_type).encode()  # JSON can hold half a surrogate pair; UTF-8 cannot
    except (ValueError, TypeError, LookupError, RecursionError):
        return ServiceError(service, text or "the server sent an error without a text")
    return ServiceError(service, error_text, error_type)


# Servers


class ZenohServer(Declaration):
    """A server as seen by clients of other contexts."""

    def __init__(
        self,
        state: SessionState,
        endpoint: EndpointInfo,
        srv_type: type[Any],
        serve: Serve,
    ) -> None:
        names = state.names_of(endpoint)
        super().__init__(state, names.token, names.gid)
        self.key = names.key
        self.endpoint = endpoint
        self.srv_type = srv_type
        self._serve = serve
        self._queryable: zenoh.Queryable[None] | None = None
        self._queue = state.queue(self._receive)
        self._note_refused = state.queue(self._report_refused, limit=ARRIVING_REQUESTS)
        self.unanswered: dict[tuple[bytes, int], ZenohRequest] = {}
        # The context of each client that has a token. The loop writes it, and Zenoh's threads read
        # it: a request of a client that has just come or gone counts as one without a token.
        self._clients: dict[bytes, str] = {}
        self._unwatch: Callable[[], None] | None = None
        state.cancellations.listen(endpoint.name, self.cancel)
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the queryable."""
        if self.state.graph is not None:
            self._unwatch = self.state.graph.watch(
                EndpointKind.CLIENT, self.endpoint.name, self._note_client
            )
        self._queryable = session.declare_queryable(
            self.key,
            direct(self._arrive),
            complete=True,
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def undeclare_data(self) -> None:
        """Withdraw it, and end unanswered calls."""
        queryable, self._queryable = self._queryable, None
        if queryable is not None:
            queryable.undeclare()
        if self._unwatch is not None:
            self._unwatch()
            self._unwatch = None
        self._clients.clear()
        for query in self._queue.take_out():
            self.state.request_room.release(query)
        for request in list(self.unanswered.values()):
            request.drop()

    def _note_client(self, client: EndpointInfo, present: bool) -> None:
        if present:
            self._clients[client.gid] = client.node.participant
        else:
            self._clients.pop(client.gid, None)

    def close(self) -> None:
        """Withdraw the server for good."""
        self.state.cancellations.unlisten(self.endpoint.name, self.cancel)
        super().close()

    def cancel(self, gid: bytes, sequence: int) -> None:
        """Handle the cancellation of a request by its client."""
        request = self.unanswered.get((gid, sequence))
        if request is not None:
            request.cancelled = True

    def _arrive(self, query: zenoh.Query) -> None:
        """Pass a request to the loop; in a Zenoh thread.

        A request for which there is no room is refused here, in the thread that reads what its
        client sends: if the client does not read answers, only that thread waits.
        """
        room = self.state.request_room
        client = self._clients.get(gid_in(query.attachment), "")
        if len(self._queue) < ARRIVING_REQUESTS and room.reserve(query, client, size_of(query)):
            self._queue.put(query)
            return
        self._note_refused.put(None)
        problem = error_payload("QueueFullError", TOO_MANY)
        answer(query, lambda: query.reply_err(problem))

    def _report_refused(self, _: None) -> None:
        """Count a request that was refused before it reached the loop."""
        limit = f"{self.state.queue_bytes / 2**20:.3g} MiB"
        self.state.drops.note(Drop.REQUESTS, self.endpoint.name, limit)

    def _receive(self, query: zenoh.Query) -> None:
        sample_info = sample_info_of(query.attachment)
        if sample_info is None:
            if query.attachment is not None:
                self.state.note_malformed(self.key, "an attachment")
            sample_info = SampleInfo(UNKNOWN_GID, 0, 0)
        self._receive_from(query, sample_info)

    def _receive_from(self, query: zenoh.Query, sample_info: SampleInfo) -> None:
        payload = query.payload
        try:
            message = cdr.decode_request(
                self.srv_type.Request, b"" if payload is None else payload.to_bytes()
            )
        except DecodeError as error:
            self.state.note_malformed(self.key, str(error))
            self.refuse(query, sample_info, error_payload("DecodeError", str(error)))
        else:
            if abs(self.state.now_ns() - sample_info.source_ns) < FRESH_NS:
                self.state.peer_senders.heard(self.participant_of(sample_info.gid))
            self._serve(
                ZenohRequest(message, sample_info, query, self), self.state.waker.inline_deadline_ns
            )

    def attachment_of(self, sample_info: SampleInfo) -> bytes | None:
        """Return the attachment for the response to a request."""
        return attachment.pack(sample_info.sequence, self.state.now_ns(), sample_info.gid)

    def participant_of(self, client: bytes) -> str:
        """Return the context of a client; one of a few for clients without a token."""
        return (
            self._clients.get(client) or f"unannounced {client[0] % UNANNOUNCED if client else 0}"
        )

    def refuse(self, query: zenoh.Query, sample_info: SampleInfo, problem: bytes) -> None:
        """End `query` with an error."""
        self.answer(query, sample_info, lambda: query.reply_err(problem), len(problem))

    def answer(
        self,
        query: zenoh.Query,
        sample_info: SampleInfo,
        reply: Callable[[], None] | None,
        size_bytes: int,
    ) -> None:
        """End `query`, without waiting for a client that hangs."""
        room = self.state.request_room

        def send() -> None:
            answer(query, reply)
            room.release(query)

        self.state.peer_senders.send((self.participant_of(sample_info.gid),), size_bytes, send)


def gid_in(extra: zenoh.ZBytes | None) -> bytes:
    """Return the gid of the client in the attachment of a request; empty if there is none."""
    fields = None if extra is None else attachment.unpack_fields(extra.to_bytes())
    return b"" if fields is None else fields[2]


def answer(query: zenoh.Query, reply: Callable[[], None] | None = None) -> None:
    """End `query`, with or without a reply; does nothing if its client has gone."""
    try:
        if reply is not None:
            reply()
        query.drop()
    except zenoh.ZError as error:
        logger.debug("%s: not answered: %s", query.key_expr, error)


class ZenohRequest(Request):
    """A request from another process."""

    def __init__(
        self, message: Any, sample_info: SampleInfo, query: zenoh.Query, server: ZenohServer
    ) -> None:
        self.message = message
        self.sample_info = sample_info
        self._query = query
        self._server = server
        self._id = (sample_info.gid, sample_info.sequence)
        # A request without an attachment has no number either; then the object itself is the id.
        if self._id in server.unanswered or sample_info.gid == UNKNOWN_GID:
            self._id = (sample_info.gid, id(self))
        server.unanswered[self._id] = self

    def _finish(self) -> bool:
        """Mark the request as answered; return whether it was not answered before."""
        return self._server.unanswered.pop(self._id, None) is not None

    def reply(self, response: Any) -> None:
        """Send the response, with the client's own number."""
        payload = cdr.encoder(self._server.srv_type.Response)(response)
        if not self._finish():
            return
        query = self._query
        extra = self._server.attachment_of(self.sample_info)
        self._server.answer(
            query,
            self.sample_info,
            lambda: query.reply(query.key_expr, payload, attachment=extra),
            len(payload),
        )

    def fail(self, error_type: str, error_text: str) -> None:
        """Send an error; ROS clients log it and keep waiting."""
        if self._finish():
            payload = error_payload(error_type, error_text)
            self._server.refuse(self._query, self.sample_info, payload)

    def drop(self) -> None:
        """End the query, which tells the client that no response will come."""
        if self._finish():
            self._server.answer(self._query, self.sample_info, None, 0)


# Clients


class ZenohRequester(Declaration, Requester):
    """A client as seen by servers of other contexts."""

    target: ClassVar[zenoh.QueryTarget] = zenoh.QueryTarget.ALL_COMPLETE

    def __init__(self, state: SessionState, endpoint: EndpointInfo, srv_type: type[Any]) -> None:
        names = state.names_of(endpoint)
        super().__init__(state, names.token, names.gid)
        self.key = names.key
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.unanswered: set[ZenohCall] = set()
        self._looked_at: tuple[Graph, int] | None = None
        self._known: list[EndpointInfo] = []
        self._window_ns = perf_ns()
        self._window_calls = 0
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Do nothing: a client declares only its token."""

    def undeclare_data(self) -> None:
        """End pending calls, as nothing can answer them any more."""
        for call in list(self.unanswered):
            call.end()

    def timeout_s(self) -> float:
        """Return the timeout of the next request."""
        if self.endpoint.name.endswith("/_action/get_result"):
            return FOREVER_S
        now_ns = perf_ns()
        if now_ns - self._window_ns > LONG_S * 1e9:
            self._window_ns, self._window_calls = now_ns, 0
        self._window_calls += 1
        return LONG_S if self._window_calls <= OFTEN else SHORT_S

    def _matched(self) -> list[EndpointInfo]:
        graph = self.state.graph
        if graph is None:
            return []
        if self._looked_at != (graph, graph.changes):
            self._looked_at = (graph, graph.changes)
            self._known = [
                server
                for server in graph.endpoints(EndpointKind.SERVER, name=self.endpoint.name)
                if self.state.reaches(server.node) and self.endpoint.matches(server)
            ]
        return self._known

    def participants(self) -> set[str]:
        """Return the contexts of the servers."""
        return {server.node.participant for server in self._matched()}

    @property
    def servers(self) -> int:
        """Number of matched servers in other contexts."""
        return len(self._matched())

    def tell_cancelled(self, sequence: int) -> None:
        """Tell the servers that a request need not be served."""
        participants = self.participants()
        self.state.cancellations.tell(participants, self.endpoint.name, self.gid, sequence)

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` to every server of other contexts."""
        payload = cdr.encoder(self.srv_type.Request)(request)
        extra = attachment.pack(sample_info.sequence, sample_info.source_ns, self.gid)
        call = ZenohCall(self, reply_to, sample_info.sequence)
        session = self.state.session
        if session is None:
            call.refuse()
            return call

        call.send(session, payload, extra, self.timeout_s())
        return call


class ZenohCall:
    """A pending call."""

    def __init__(self, requester: ZenohRequester, reply_to: ReplyTo, sequence: int) -> None:
        self._requester = requester
        # None once the call has ended, and never set again. The loop writes it; a thread that sends
        # reads it, so that no request is sent for a call that has ended.
        self._reply_to: ReplyTo | None = reply_to
        self._sequence = sequence
        self._token = zenoh.CancellationToken()
        self._unreadable: ServiceError | None = None
        self._send_again: Callable[[], None] | None = None
        self._sent_ns = 0  # written by the sending thread, before the loop can get a reply
        self._attempts = 0
        self._queue = requester.state.queue(self._receive)
        requester.unanswered.add(self)

    def send(self, session: zenoh.Session, payload: bytes, extra: bytes, timeout_s: float) -> None:
        """Send the request without waiting for a server that hangs, on the loop."""
        self._send_again = partial(self.send, session, payload, extra, timeout_s)
        requester = self._requester
        requester.state.peer_senders.send(
            requester.participants(),
            len(payload),
            partial(self._get, session, payload, extra, timeout_s),
        )

    def _get(self, session: zenoh.Session, payload: bytes, extra: bytes, timeout_s: float) -> None:
        """Send the request, unless it was given up meanwhile, on any thread."""
        if self._reply_to is None:
            return
        self._sent_ns = perf_ns()
        try:
            session.get(
                self._requester.key,
                direct(self._queue.put, lambda: self._queue.put(None)),
                target=self._requester.target,
                consolidation=zenoh.ConsolidationMode.NONE,
                congestion_control=zenoh.CongestionControl.BLOCK,
                priority=CALL_PRIORITY,
                timeout=timeout_s,
                payload=payload,
                attachment=extra,
                allowed_destination=zenoh.Locality.REMOTE,
                cancellation_token=self._token,
            )
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._requester.key, error)
            self.refuse()

    def refuse(self) -> None:
        """End the call soon: it cannot be sent."""
        self._queue.put(None)

    def _receive(self, reply: zenoh.Reply | None) -> None:
        reply_to = self._reply_to
        if reply_to is None:
            return
        if reply is None:
            if not self._try_again():
                self.end()
            return
        servers = self._requester.participants()
        if len(servers) == 1:  # otherwise it is unknown which of them is alive
            self._requester.state.peer_senders.heard(servers.pop())
        sample = reply.ok
        if sample is None:
            error = reply.err
            self._finish()
            reply_to.fail(
                parse_error(
                    b"" if error is None else error.payload.to_bytes(),
                    self._requester.endpoint.name,
                )
            )
            return
        try:
            response = cdr.decode(self._requester.srv_type.Response, sample.payload.to_bytes())
        except DecodeError as decode_error:
            # Another server may answer in a better form; otherwise the caller gets the error.
            self._requester.state.note_malformed(self._requester.key, str(decode_error))
            self._unreadable = ServiceError(
                self._requester.endpoint.name, f"the response is unreadable: {decode_error}"
            )
            return
        self._finish()
        reply_to.reply(response, sample_info_of(sample.attachment) or SampleInfo(UNKNOWN_GID, 0, 0))

    def _try_again(self) -> bool:
        """Resend the request if no server received it though there is one; return whether."""
        if (
            self._send_again is None
            or self._unreadable is not None
            or self._attempts == len(AGAIN_S)
            or perf_ns() - self._sent_ns > AT_ONCE_NS
            or not self._requester.servers
        ):
            return False
        delay_s = AGAIN_S[self._attempts]
        self._attempts += 1
        running_loop().call_later(delay_s, self._go_again)
        return True

    def _go_again(self) -> None:
        if self._reply_to is None or self._send_again is None:
            return
        if self._requester.state.session is not None and self._requester.servers:
            self._send_again()
        else:
            self.end()

    def end(self) -> None:
        """Handle the end of the replies."""
        reply_to = self._reply_to
        self._finish()
        if reply_to is None:
            return
        if self._unreadable is not None:
            reply_to.fail(self._unreadable)
        else:
            reply_to.end()

    def _finish(self) -> None:
        self._reply_to = None
        self._requester.unanswered.discard(self)

    def cancel(self) -> None:
        """Forget the call, and send a cancellation to the servers that run aionode."""
        if self._reply_to is None:
            return
        self._finish()
        with translated(self._requester.key):
            self._token.cancel()
        self._requester.tell_cancelled(self._sequence)
