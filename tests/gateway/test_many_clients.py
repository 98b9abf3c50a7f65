"""Many clients of a gateway, in a process of their own, and one that reads nothing."""

from __future__ import annotations

import pytest

from tests.gateway.load.cases import run_with_clients, text

pytestmark = [pytest.mark.stress, pytest.mark.timeout(120)]


async def test_49_clients_get_every_message_beside_one_that_reads_nothing() -> None:
    """A local reader gets them, too: a slow client slows nobody down. See `make gateway-load`."""
    _, heard = await run_with_clients(text, 100.0, 3.0, "none", 49, deaf=1)

    assert heard.local == 0
    assert heard.lost == heard.doubled == heard.reordered == [0] * 49
