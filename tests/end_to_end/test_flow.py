"""Over Zenoh, a process that freezes, lags or ends stops no other and costs no message."""

from __future__ import annotations

import signal
import time  # noqa: TID251  # how long a process takes is what is tested
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

from tests.end_to_end.process import Process

STANDS_MS = 1000.0
"""The longest stall of a loop beside other tests, in ms; the defects took seconds."""

ALONE_MS = 50.0
"""The same on a machine that does nothing else."""

SMALL_BUFFERS = (
    "transport/link/tcp/so_rcvbuf=262144;transport/link/tcp/so_sndbuf=262144"  # fill in no time
)

ENDS_S = 6.0
"""A process ends within its flush limit of two seconds, give or take the machine; it took ten."""

ENDLESS = 10**9


@pytest.fixture(autouse=True)
def without_links(monkeypatch: pytest.MonkeyPatch) -> None:
    """As between hosts or users."""
    monkeypatch.setenv("AIONODE_LINK", "off")


@contextmanager
def members(*each: tuple[object, ...]) -> Iterator[list[Process]]:
    """Start members of the group, one after another."""
    with ExitStack() as stack:
        started = []
        for role, *rest in each:
            script = "plain_reader" if role == "plain" else "flow_member"
            words = [str(word) for word in (rest if role == "plain" else (role, *rest))]
            process = Process(f"tests/end_to_end/{script}.py", *words)
            stack.enter_context(process)
            process.expect("open")
            started.append(process)
        yield started


def gap_ms(process: Process) -> float:
    """Return how long the loop of a member stood still since the last question."""
    return float(process.ask("gap", "gap"))


def count(process: Process) -> int:
    """Return how many messages, requests or replies a member has had."""
    return int(process.ask("count", "count"))


def sleep_s(seconds: float) -> None:
    """Wait while other processes run."""
    time.sleep(seconds)


def freeze_reader(
    freeze_s: float, *, role: str = "reader", messages: int = 15_000, limit_ms: float = STANDS_MS
) -> None:
    """Freeze the reader of a KEEP_ALL publisher: it misses nothing, and others never lag."""
    with members(
        (role, "big", messages),
        ("lister", "tick", ENDLESS),
        ("ticker", "tick"),
        ("keeper", "big", messages, 1_000),
    ) as (reader, healthy, ticker, keeper):
        keeper.expect("matched")
        reader.send(signal.SIGSTOP)
        watched = (healthy, ticker, keeper)
        for process in watched:
            gap_ms(process)
        before = count(healthy)
        sleep_s(freeze_s)
        assert max(gap_ms(process) for process in watched) < limit_ms
        assert count(healthy) - before > 10 * freeze_s  # of 200 in a second, on an idle machine
        assert count(keeper) < messages
        reader.send(signal.SIGCONT)
        keeper.expect(f"sent {messages} 0")
        reader.expect(f"heard {messages}")
        assert not [line for line in reader.rest_so_far() if line.startswith("wrong")]
        took_s, status = keeper.stop(signal.SIGTERM)
        assert status == 0
        assert took_s < ENDS_S


@pytest.mark.slow
def test_a_frozen_reader_stops_no_loop_and_loses_nothing() -> None:
    """A BLOCK put held the queue towards it, and with it every thread, including the loop's."""
    freeze_reader(2.0)


@pytest.mark.faults
@pytest.mark.timeout(200)
@pytest.mark.parametrize("freeze_s", [5.0, 14.0, 70.0])
def test_a_reader_may_be_frozen_for_longer_than_the_lease(freeze_s: float) -> None:
    """Its connection ends after ten seconds, and its place is kept until it comes back."""
    freeze_reader(freeze_s, limit_ms=ALONE_MS)


@pytest.mark.slow
def test_a_frozen_reader_that_acknowledges_nothing_stops_no_loop() -> None:
    """Such as a ROS 2 node: a thread waits for it as long as its connection lasts."""
    freeze_reader(2.0, role="plain")


@pytest.mark.parametrize("role", ["reader", pytest.param("plain", marks=pytest.mark.stress)])
def test_a_publisher_ends_at_once_beside_a_frozen_reader_and_says_what_is_lost(role: str) -> None:
    """SIGTERM took ten seconds or more, and waiting messages were lost silently."""
    with members((role, "big", ENDLESS), ("keeper", "big", 100_000, 500)) as (reader, keeper):
        keeper.expect("matched")
        reader.send(signal.SIGSTOP)
        while (sent := count(keeper)) == 0 or sent < count(keeper):
            sleep_s(0.2)
        took_s, status = keeper.stop(signal.SIGTERM)
        assert status == 0
        assert took_s < ENDS_S
        assert any("of the messages published here were dropped" in line for line in keeper.rest())


@pytest.mark.slow
def test_a_reader_that_pauses_with_its_loop_free_has_everything() -> None:
    """Its network thread used to wait with it, and then the connection was lost."""
    with members(("reader", "big", 15_000), ("keeper", "big", 15_000, 500)) as (reader, keeper):
        keeper.expect("matched")
        reader.write("pause 2")
        keeper.expect("sent 15000 0")
        reader.expect("heard 15000")
        assert gap_ms(reader) < STANDS_MS
        assert not [line for line in reader.rest_so_far() if line.startswith("wrong")]


@pytest.mark.parametrize(
    ("role", "messages", "size"),
    [
        pytest.param("lister", 20_000, 20, marks=pytest.mark.slow),
        ("plain", 200, 20_000),
        pytest.param("lister", 200, 20_000, marks=pytest.mark.stress),
        pytest.param("plain", 20_000, 20, marks=pytest.mark.stress),
    ],
)
def test_a_reliable_burst_within_the_depth_arrives_as_a_whole(
    role: str, messages: int, size: int
) -> None:
    """Published at once, with KEEP_LAST and a sufficient depth."""
    with members((role, "burst", messages), ("sender", "burst", messages, size)) as (
        reader,
        sender,
    ):
        sender.expect(f"sent {messages} 0")
        reader.expect(f"heard {messages}")


@pytest.mark.parametrize(
    ("messages", "size"), [(5_000, 1_000), pytest.param(200, 20_000, marks=pytest.mark.stress)]
)
def test_what_a_publisher_has_sent_before_it_ends_arrives(messages: int, size: int) -> None:
    """Its process waits for that as long as the reader accepts messages."""
    with members(("reader", "last", messages), ("quitter", "last", messages, size)) as (
        reader,
        quitter,
    ):
        reader.expect(f"heard {messages}")
        assert quitter.wait() == 0


@pytest.mark.slow
def test_a_client_goes_on_beside_a_frozen_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """A request waited on the loop until the server took it, so that no timeout could help."""
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", SMALL_BUFFERS)
    with members(("server", "get"), ("client", "get", 200, 2_000)) as (server, client):
        client.expect("matched")
        while not count(client):
            sleep_s(0.1)
        gap_ms(client)
        server.send(signal.SIGSTOP)
        sleep_s(3)
        assert gap_ms(client) < STANDS_MS
        server.send(signal.SIGCONT)
        before = count(client)
        while count(client) == before:
            sleep_s(0.1)
        server.send(signal.SIGSTOP)
        sleep_s(2)
        took_s, status = client.stop(signal.SIGTERM)
        assert status == 0
        assert took_s < ENDS_S


@pytest.mark.slow
def test_a_server_goes_on_beside_a_frozen_client(monkeypatch: pytest.MonkeyPatch) -> None:
    """A reply waited on the loop until the client took it, and all other clients with it."""
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", SMALL_BUFFERS)
    with members(("server", "get"), ("client", "get", 200, 2_000), ("client", "get", 2)) as (
        server,
        frozen,
        other,
    ):
        for client in (frozen, other):
            client.expect("matched")
        while not count(frozen) or not count(other):
            sleep_s(0.1)
        gap_ms(server)
        frozen.send(signal.SIGSTOP)
        before = count(other)
        sleep_s(3)
        assert count(other) > before + 300
        assert max(gap_ms(server), gap_ms(other)) < STANDS_MS
        took_s, status = server.stop(signal.SIGTERM)
        assert status == 0
        assert took_s < ENDS_S
