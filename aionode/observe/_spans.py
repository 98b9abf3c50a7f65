"""OpenTelemetry spans for sent messages and for the callbacks that receive them."""

from __future__ import annotations

import threading
from hashlib import blake2b
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import MachineTime, perf_ns
from aionode.errors import ConfigurationError

if TYPE_CHECKING:
    from collections.abc import Callable

    from opentelemetry.sdk.trace import TracerProvider
    from opentelemetry.trace import SpanContext

    from aionode.engine.causes import Run, Sent
    from aionode.node import Node

__all__ = ["export_spans"]

TRACE_BYTES: Final = 16
SPAN_BYTES: Final = 8


def export_spans(node: Node, provider: TracerProvider | None = None) -> Callable[[], None]:
    """Export what a node's context sends, and its callbacks, as spans.

    A trace consists of one message and the callbacks that receive it, in all processes: its id
    follows from the publisher's gid and the sequence number, which each of them knows. The span of
    a message has links to the callbacks that caused it, in earlier traces.

    Args:
        node: A node of a context that keeps causes.
        provider: Makes the spans; by default the one set by the program.

    Returns:
        A function that ends the export.

    Raises:
        ConfigurationError: the context keeps no causes (a ValueError), or the program has set no
            provider of OpenTelemetry's SDK.
        ModuleNotFoundError: the SDK is not installed: ``pip install 'aionode[opentelemetry]'``.
    """
    from opentelemetry import trace  # most programs have none
    from opentelemetry.sdk.trace import Tracer

    log = node.context.causes
    if log is None:
        raise ConfigurationError("AIONODE_CAUSES", "0", "use 1: spans are made of what it keeps")
    tracer = trace.get_tracer("aionode", tracer_provider=provider)
    if not isinstance(tracer, Tracer):
        remedy = "call opentelemetry.trace.set_tracer_provider with one of its SDK, or pass one"
        raise ConfigurationError("TracerProvider", type(tracer).__name__, remedy)
    spans = Spans(tracer)
    log.listeners.append(spans)

    def end() -> None:
        if spans in log.listeners:
            log.listeners.remove(spans)

    return end


class Ids(threading.local):
    """Provides the ids for a tracer's next span."""

    trace_id = 0
    span_id = 0

    def generate_trace_id(self) -> int:
        """Return the id of the trace."""
        return self.trace_id

    def generate_span_id(self) -> int:
        """Return the id of the span."""
        return self.span_id

    def is_trace_id_random(self) -> bool:
        """Return whether ids are random; they are hashes."""
        return False


def ids_of(*parts: object) -> tuple[int, int]:
    """Return the ids of a trace and a span, derived from parts."""
    digest = blake2b(repr(parts).encode(), digest_size=TRACE_BYTES + SPAN_BYTES).digest()
    return int.from_bytes(digest[:TRACE_BYTES]), int.from_bytes(digest[TRACE_BYTES:])


def ids_of_run(run: Run) -> tuple[int, int]:
    """Return the ids of a run; its trace is that of its input."""
    own = ids_of("run", run.party.node, run.party.name, run.gid, run.sequence, run.began_ns)
    if run.kind == "timer" and not run.sequence:
        return own
    return ids_of(run.kind, run.gid, run.sequence)[0], own[1]


class Spans:
    """Makes a span for each sent item and each callback that has ended."""

    def __init__(self, tracer: Any) -> None:
        self._tracer = tracer
        self._ids = tracer.id_generator = Ids()
        self._system_ns = MachineTime().system_ns

    def note_sent(self, sent: Sent) -> None:
        """Export a sent item."""
        from opentelemetry.trace import Link, SpanKind

        self._export(
            ids_of(sent.kind, sent.gid, sent.sequence),
            f"send {sent.kind} {sent.party.name}",
            (sent.at_ns, sent.at_ns),
            {
                "messaging.operation.name": "send",
                "ros.node": sent.party.node,
                "messaging.destination.name": sent.party.name,
                "ros.sequence": sent.sequence,
            },
            kind=SpanKind.CLIENT if sent.kind in ("request", "goal") else SpanKind.PRODUCER,
            links=[Link(context_of(*ids_of_run(run))) for run in sent.causes if run.is_call],
        )

    def note_end(self, run: Run) -> None:
        """Export a callback that has ended."""
        from opentelemetry import trace

        parent = None
        if run.kind != "timer" or run.sequence:
            sender = context_of(*ids_of(run.kind, run.gid, run.sequence))
            parent = trace.set_span_in_context(trace.NonRecordingSpan(sender))
        kinds = {"message": trace.SpanKind.CONSUMER, "request": trace.SpanKind.SERVER}
        self._export(
            ids_of_run(run),
            run.party.callback() or run.party.name,
            (run.began_ns, run.ended_ns),
            {
                "messaging.operation.name": "process",
                "ros.node": run.party.node,
                "messaging.destination.name": run.party.name,
                "ros.sequence": run.sequence,
                "ros.waited_ms": (run.began_ns - run.entered_ns) / 1e6,
            },
            kind=kinds.get(run.kind, trace.SpanKind.INTERNAL),
            context=parent,
        )

    def _export(
        self,
        ids: tuple[int, int],
        name: str,
        times_ns: tuple[int, int],
        attributes: dict[str, Any],
        **options: Any,
    ) -> None:
        self._ids.trace_id, self._ids.span_id = ids
        since_1970_ns = self._system_ns() - perf_ns()
        began_ns, ended_ns = (at_ns + since_1970_ns for at_ns in times_ns)
        attributes["messaging.system"] = "ros2"
        span = self._tracer.start_span(name, start_time=began_ns, attributes=attributes, **options)
        span.end(ended_ns)


def context_of(trace_id: int, span_id: int) -> SpanContext:
    """Return the context of a span that another process may have exported."""
    from opentelemetry.trace import SpanContext, TraceFlags

    return SpanContext(
        trace_id, span_id, is_remote=True, trace_flags=TraceFlags(TraceFlags.SAMPLED)
    )
