"""Clients in separate processes that vanish while the robot moves: the stop is sent.

`make gateway-load` measures how soon, many times.
"""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.gateway.load.vanishing import silences, stops_after
from tests.support.peers import isolated_environment

SOON_SEC = 5.0
"""How late it may be on a busy machine; `make gateway-load` measures the promise."""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
async def test_the_stop_is_sent_when_a_client_is_killed_or_frozen(how: signal.Signals) -> None:
    """Neither sends a close frame; the frozen one even keeps its connection."""
    assert len(await stops_after(how)) == 1


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
async def test_the_wheels_stop_when_the_gateway_is_killed_or_frozen(
    how: signal.Signals, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Nobody sends a stop then: the wheels themselves notice the silence."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)

    (found,) = await silences(how, tmp_path)

    assert found.after_sec < SOON_SEC
    assert found.moved == 0
