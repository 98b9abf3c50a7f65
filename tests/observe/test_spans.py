"""Spans of OpenTelemetry: what is sent, who takes it, and how they belong together."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter

from aionode import Node
from aionode.errors import ConfigurationError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.observe import export_spans
from aionode.testing import local_context
from tests.support.peers import contexts_over


def provider_of(exporter: InMemorySpanExporter) -> TracerProvider:
    """Return a provider of one process, which keeps its spans."""
    provider = TracerProvider()
    provider.add_span_processor(SimpleSpanProcessor(exporter))
    return provider


async def test_spans_of_several_processes_belong_together() -> None:
    """A message and who takes it share a trace; links lead to the one before."""
    sent, taken = InMemorySpanExporter(), InMemorySpanExporter()
    async with (
        contexts_over("link", causes=True) as (a, b),
        Node("slam", context=a) as slam,
        Node("planner", context=b) as planner,
    ):
        ends = [export_spans(slam, provider_of(sent)), export_spans(planner, provider_of(taken))]
        mapped = slam.create_publisher(Int32, "map", 10)
        driven = planner.create_publisher(Int32, "drive", 10)

        async def on_map(message: Int32) -> None:
            driven.publish(message)

        planner.create_subscription(Int32, "map", on_map)
        done = slam.create_subscription(Int32, "drive")
        await mapped.wait_for_subscribers()
        await driven.wait_for_subscribers()
        mapped.publish(Int32())
        await done.receive()
        for end in ends:
            end()
        mapped.publish(Int32())
        await done.receive()

    def named(exporter: InMemorySpanExporter, name: str) -> Any:
        (span,) = [each for each in exporter.get_finished_spans() if each.name.endswith(name)]
        return span

    first, run, second = named(sent, "/map"), named(taken, "on_map"), named(taken, "/drive")
    assert run.parent is not None
    assert run.context.trace_id == first.context.trace_id
    assert run.parent.span_id == first.context.span_id
    assert [(link.context.trace_id, link.context.span_id) for link in second.links] == [
        (run.context.trace_id, run.context.span_id)
    ]
    assert first.start_time <= run.start_time <= second.start_time <= run.end_time
    assert dict(run.attributes or {})["messaging.destination.name"] == "/map"


async def test_it_is_refused_where_it_would_do_nothing() -> None:
    """Without causes, and without a provider of the SDK."""
    async with Node("robot", context=local_context()) as node:
        with pytest.raises(ConfigurationError, match="AIONODE_CAUSES"):
            export_spans(node)
    async with (
        contexts_over("local", causes=True) as (context, _),
        Node("robot", context=context) as node,
    ):
        with pytest.raises(ConfigurationError, match="set_tracer_provider"):
            export_spans(node)


def test_it_is_imported_only_where_it_is_used() -> None:
    """A program that exports no spans has none of it in memory."""
    code = "import sys, aionode.observe; print([m for m in sys.modules if 'opentelemetry' in m])"
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)

    assert told.stdout.strip() == b"[]"
