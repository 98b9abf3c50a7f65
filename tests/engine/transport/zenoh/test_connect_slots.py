"""Processes that start together connect one after another."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from msgspec.structs import replace

from aionode._process.concurrency import checkpoint
from aionode.engine.transport.network import DiscoveryRange, Network, network_from
from aionode.engine.transport.zenoh.session import connect_slots as _connect_slots
from aionode.engine.transport.zenoh.session.connect_slots import connecting, is_idle, one_at_a_time
from aionode.engine.transport.zenoh.session.local_sessions import announce
from tests.support.peers import free_ports
from tests.support.waiting import waited_s

pytestmark = [
    pytest.mark.one_loop,
    pytest.mark.skipif(
        not sys.platform.startswith("linux"), reason="only Linux lists the sessions of others"
    ),
]


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[Network]:
    """Return the settings of a process beside another one, on a busy machine with a processor."""
    monkeypatch.setenv("AIONODE_MEETING_PORTS", ",".join(map(str, free_ports(6))))
    monkeypatch.setattr(_connect_slots, "is_idle", lambda: False)
    monkeypatch.setattr(_connect_slots, "processors", lambda: 1)
    found = network_from(os.environ)
    with closing(announce(found.meeting_ports[0], 4711)):
        yield found


class Visits:
    """How many connect at a time, and in total."""

    def __init__(self) -> None:
        self.now = self.most = self.all = 0

    async def visit(self, network: Network) -> None:
        """Connect, for some turns of the loop."""
        async with connecting(network):
            self.now += 1
            self.all += 1
            self.most = max(self.most, self.now)
            for _ in range(20):
                await checkpoint()
            self.now -= 1

    async def visit_together(self, network: Network) -> None:
        """Connect eight times, at the same time if that is possible."""
        async with asyncio.TaskGroup() as tasks:
            for _ in range(8):
                tasks.create_task(self.visit(network))


@pytest.mark.parametrize(("processors", "most"), [(1, 1), (2, 1), (4, 2), (9, 4), (64, 5)])
async def test_one_process_connects_at_a_time_for_two_processors(
    network: Network, monkeypatch: pytest.MonkeyPatch, processors: int, most: int
) -> None:
    """All others wait for it, and each gets its slot. There are at most five, each with a port."""
    monkeypatch.setattr(_connect_slots, "processors", lambda: processors)
    visits = Visits()
    await visits.visit_together(network)

    assert (visits.most, visits.all) == (most, 8)


async def test_nobody_waits_while_a_processor_is_free(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process that connects may be waiting for another one, which may be frozen."""
    monkeypatch.setattr(_connect_slots, "is_idle", lambda: True)
    visits = Visits()
    await visits.visit_together(network)

    assert visits.most == 8


async def test_nobody_waits_if_there_is_no_other_process(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same holds if a context does not look for any, or no port is available for slots."""
    monkeypatch.setattr(_connect_slots, "SLOT_S", 1000.0)
    alone = network_from({"AIONODE_MEETING_PORTS": ",".join(map(str, free_ports(6)))})
    off = network_from(os.environ, discovery_range=DiscoveryRange.OFF)
    single = replace(network, meeting_ports=network.meeting_ports[:1], spare_ports=())
    for settings in (alone, off, single):
        visits = Visits()
        async with asyncio.timeout(20):
            await visits.visit_together(settings)

        assert visits.most == 8


async def test_a_process_that_does_not_go_on_is_not_waited_for(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be frozen while it connects; then no other one appears either."""
    monkeypatch.setattr(_connect_slots, "SLOT_S", 0.01)
    async with connecting(network), asyncio.timeout(20), connecting(network):
        pass


@pytest.fixture
def foreign_slots(network: Network) -> Iterator[None]:
    """Have a process of another user hold all slots."""
    if os.getuid() != 0:
        pytest.skip("only root may start a process of another user")
    program = (
        "import socket, sys\n"
        "kept = [socket.socket(type=socket.SOCK_DGRAM) for _ in sys.argv[1:]]\n"
        "for slot, port in zip(kept, sys.argv[1:]): slot.bind(('127.0.0.1', int(port)))\n"
        "print(flush=True); sys.stdin.read()"
    )
    ports = map(str, (*network.meeting_ports, *network.spare_ports))
    with subprocess.Popen(
        ["/usr/bin/env", "python3", "-c", program, *ports],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        user=65534,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        yield
        process.communicate()


@pytest.mark.usefixtures("foreign_slots")
async def test_a_slot_that_another_user_keeps_costs_a_third_of_a_second(network: Network) -> None:
    """Each start took three seconds longer, since whoever binds the port blocks all others."""

    def now_s() -> float:
        return asyncio.get_running_loop().time() - waited_s()

    began_s = now_s()
    with one_at_a_time(network.meeting_ports[0]):
        met_s = now_s()
    async with connecting(network):
        connected_s = now_s()

    assert met_s - began_s < 2.0
    assert connected_s - met_s < 2.5


async def test_it_is_waited_longer_while_others_appear(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If a hundred start, the last one waits for a minute."""
    lists = iter([{1}, {1, 2}, {1, 2, 3}, {1, 2, 3}])
    monkeypatch.setattr(_connect_slots, "SLOT_S", 0.01)
    monkeypatch.setattr(_connect_slots, "listed", lambda _: next(lists))
    async with connecting(network), connecting(network):
        pass

    assert next(lists, None) is None


async def test_waiting_for_a_slot_can_be_cancelled(network: Network) -> None:
    """Ctrl-C does not wait for others."""
    async with connecting(network):
        waiting = asyncio.get_running_loop().create_task(Visits().visit(network))
        await checkpoint()
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting


@pytest.mark.parametrize(
    ("text", "idle"),
    [
        ("0.5 0.4 0.3 2/512 12345\n", True),
        ("9.5 0.4 0.3 3/512 12345\n", False),
        ("nothing\n", True),
        ("", True),
        ("0.5 0.4 0.3 x/512 12345\n", True),
    ],
)
def test_a_machine_is_busy_if_more_threads_run_than_it_has_processors(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, text: str, *, idle: bool
) -> None:
    """Where the number of threads is unknown, nobody should wait."""
    load = tmp_path / "loadavg"
    monkeypatch.setattr(_connect_slots, "LOAD", load)
    monkeypatch.setattr(_connect_slots, "processors", lambda: 2)

    assert is_idle()
    load.write_text(text)
    assert is_idle() is idle
