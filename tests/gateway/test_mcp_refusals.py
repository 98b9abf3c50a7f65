"""Refusals of an assistant before it has a session: they are counted and logged like anyone's."""

from __future__ import annotations

import logging

import pytest

from aionode.gateway import Identity
from tests.support.mcp_bench import POLICY, bench_of

ONE_CLIENT = f"{POLICY}\n[limits]\nclients = 1\n"


@pytest.mark.parametrize("over_http", [False, True], ids=["in process", "http"])
async def test_a_call_without_a_place_has_a_number_and_a_line(
    over_http: bool, caplog: pytest.LogCaptureFixture
) -> None:
    """The model is told, and the robot's owner reads why the assistant does nothing."""
    async with bench_of(ONE_CLIENT, over_http=over_http) as bench:
        client = await bench.connect()
        async with bench.clients.session(Identity("driver"), "test"):
            result = await client.call_tool("read", {"topic": "/text"})

        assert result.is_error
        assert bench.clients.stats.refusals == {"too_many": 1}
    warnings = [each.getMessage() for each in caplog.records if each.levelno == logging.WARNING]
    assert sum("connection: refused: there are already 1 clients" in line for line in warnings) == 1
