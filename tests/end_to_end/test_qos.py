"""Liveliness of a hanging process: the system no longer runs it, and no peer is notified."""

from __future__ import annotations

import asyncio
import signal
from typing import TYPE_CHECKING

import pytest

from aionode.endpoints.events import QoSLivelinessChangedInfo
from aionode.engine.context import Context
from aionode.engine.rules.liveliness import PublisherLiveliness
from aionode.interfaces.std_msgs.msg import Int32
from tests.end_to_end.process import Process
from tests.end_to_end.qos_member import PROFILE
from tests.support.links import folder
from tests.support.peers import quiet_node
from tests.support.spies import returns_of

if TYPE_CHECKING:
    from collections.abc import AsyncIterator


__all__ = ["folder"]  # a fixture

pytestmark = pytest.mark.one_loop  # which loop waits for the processes is of no interest

ZENOH_LEASE_S = 10.0
"""How long Zenoh waits before it takes a process that hangs for gone."""


@pytest.mark.parametrize("link", [True, False], ids=["link", "zenoh"])
async def test_a_frozen_process_is_not_alive_within_its_lease(
    link: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is alive again when it continues."""
    asserted = returns_of(monkeypatch, PublisherLiveliness, "note_assertion")
    context = Context(link=link)
    setting = {"AIONODE_LINK": "on" if link else "off"}
    with Process("tests/end_to_end/qos_member.py", env=setting) as member:
        async with context, quiet_node("node", context) as node:
            subscription = node.create_subscription(Int32, "n", None, PROFILE)
            changes = liveliness(subscription.events)
            assert (await anext(changes)).alive_count == 1
            await asserted.get()

            loop = asyncio.get_running_loop()
            began_s = loop.time()
            member.send(signal.SIGSTOP)
            change = await anext(changes)
            assert (change.alive_count, change.not_alive_count) == (0, 1)
            assert loop.time() - began_s < ZENOH_LEASE_S / 2

            member.send(signal.SIGCONT)
            change = await anext(changes)
            assert (change.alive_count, change.not_alive_count) == (1, 0)


async def liveliness(events: AsyncIterator[object]) -> AsyncIterator[QoSLivelinessChangedInfo]:
    """Yield the changes of liveliness among other events."""
    async for event in events:
        if isinstance(event, QoSLivelinessChangedInfo):
            yield event
