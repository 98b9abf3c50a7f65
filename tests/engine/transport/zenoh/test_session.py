"""Opening and closing sessions: failures are explained, and nothing is left behind."""

from __future__ import annotations

import asyncio
import logging
import os
import socket
import threading
from collections.abc import Iterable
from contextlib import AsyncExitStack, ExitStack, closing
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.network import network_from
from aionode.engine.transport.zenoh.session.session import (
    answering_ports,
    close_session,
    open_router,
    open_session,
    run_in_own_thread,
    speaking_ports,
)
from aionode.engine.transport.zenoh.session.settings import GOSSIPING
from aionode.errors import ConfigurationError, TransportError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from tests.support.peers import free_ports, quiet_node, ros_router, ros_session

pytestmark = pytest.mark.one_loop


def test_only_ports_that_accept_a_connection_answer() -> None:
    """Listening processes are dialled, and a free port is taken."""
    with closing(socket.create_server(("127.0.0.1", 0))) as server:
        taken = server.getsockname()[1]
        (free,) = free_ports(1)

        assert answering_ports([taken, free]) == [taken]


def test_ports_answer_in_a_process_with_more_than_1023_descriptors() -> None:
    """One of several contexts among a hundred has as many; select() takes no higher number."""
    with ExitStack() as stack, closing(socket.create_server(("127.0.0.1", 0))) as server:
        try:
            for _ in range(1024):
                stack.callback(os.close, os.dup(server.fileno()))
        except OSError:
            pytest.skip("the system allows fewer descriptors")
        port = server.getsockname()[1]

        assert answering_ports([port]) == [port]


def held(stack: ExitStack, ports: Iterable[int], *, listening: bool = True) -> None:
    """Hold ports like programs that do not speak Zenoh."""
    for port in ports:
        one = stack.enter_context(socket.socket())
        one.bind(("127.0.0.1", port))
        if listening:
            one.listen()


def meeting_ports(monkeypatch: pytest.MonkeyPatch, count: int) -> list[int]:
    """Set ports to meet on, of which those beyond three are spare."""
    ports = free_ports(count)
    monkeypatch.setenv("AIONODE_MEETING_PORTS", ",".join(map(str, ports)))
    return ports


def sayings(caplog: pytest.LogCaptureFixture) -> list[tuple[int, str]]:
    """Return level and text of log lines about ports held by others."""
    return [
        (record.levelno, record.getMessage())
        for record in caplog.records
        if "other programs use" in record.getMessage()
    ]


def test_a_port_that_speaks_zenoh_is_told_from_others() -> None:
    """A port that accepts connections may belong to any program."""
    silent, router_port = free_ports(1)[0], int(os.environ["AIONODE_ROUTER_PORT"])
    with ExitStack() as stack:
        held(stack, [silent])
        stack.enter_context(closing(ros_router()))

        assert speaking_ports([silent, router_port]) == {router_port}
        assert speaking_ports([silent]) == set()


def knows(node: Node, names: Iterable[str]) -> bool:
    """Return whether a node knows just the nodes of these names."""
    return {*names} == {other.name for other in node.graph.nodes()}


async def both_seen(node: Node) -> None:
    """Wait until a node sees both of a test."""
    async with asyncio.timeout(20):
        await node.graph.until(partial(knows, node, ("one", "two")))


def list_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have sessions meet as on systems that do not list them."""
    monkeypatch.setattr("aionode.engine.transport.network.UDP_SOCKETS", Path("/nowhere"))


@pytest.mark.slow
async def test_processes_meet_elsewhere_if_others_have_all_their_ports(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Programs that know nothing of aionode may use any port."""
    list_nothing(monkeypatch)
    ports = meeting_ports(monkeypatch, 6)
    with ExitStack() as stack, caplog.at_level(logging.INFO, "aionode.transport.zenoh"):
        held(stack, ports[:3])
        async with quiet_node("one") as one, quiet_node("two") as two:
            for node in (one, two):
                await both_seen(node)

    assert [level for level, _ in sayings(caplog)] == [logging.INFO, logging.INFO]


async def test_one_line_says_that_processes_cannot_meet(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It says what was found, and what to do."""
    list_nothing(monkeypatch)
    ports = meeting_ports(monkeypatch, 3)
    with ExitStack() as stack, caplog.at_level(logging.INFO, "aionode.transport.zenoh"):
        held(stack, ports)
        async with quiet_node("one"):
            pass

    ((level, text),) = sayings(caplog)
    assert level == logging.WARNING
    assert ", ".join(map(str, ports)) in text
    assert "AIONODE_MEETING_PORTS" in text


async def test_listed_processes_meet_whatever_ports_others_have(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """If the machine lists them, they need no well-known port."""
    ports = meeting_ports(monkeypatch, 3)
    with ExitStack() as stack, caplog.at_level(logging.INFO, "aionode.transport.zenoh"):
        held(stack, ports)
        async with quiet_node("one") as one, quiet_node("two") as two:
            for node in (one, two):
                await both_seen(node)

    assert sayings(caplog) == []


async def test_a_session_opens_where_loopback_is_down(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a sandbox without a network: nobody can be met, but nodes of the process work."""
    nobody_may_connect = "255.255.255.255"
    monkeypatch.setattr(
        "aionode.engine.transport.zenoh.session.local_sessions.address_of",
        lambda _: nobody_may_connect,
    )
    async with quiet_node("one") as one:
        assert knows(one, ["one"])


@pytest.mark.parametrize("place", [0, 2, 3], ids=["first", "in between", "last"])
async def test_a_process_that_cannot_list_or_be_listed_meets_all_others(
    monkeypatch: pytest.MonkeyPatch, place: int
) -> None:
    """As many as there are here all introduce it, also to those that have no meeting port."""
    names = [f"n{number}" for number in range(GOSSIPING)]
    async with AsyncExitStack() as stack:
        nodes = []
        for number, name in enumerate(names):
            with monkeypatch.context() as patch:
                if number == place:
                    list_nothing(patch)
                nodes.append(await stack.enter_async_context(quiet_node(name)))
        for node in nodes:
            async with asyncio.timeout(20):
                await node.graph.until(partial(knows, node, names))


@pytest.mark.parametrize("listening", [True, False], ids=["listening", "bound"])
async def test_a_port_that_another_program_has_is_passed_over(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, *, listening: bool
) -> None:
    """Whether it listens there, or uses it for an outgoing connection."""
    ports = meeting_ports(monkeypatch, 3)
    with ExitStack() as stack, caplog.at_level(logging.INFO, "aionode.transport.zenoh"):
        held(stack, ports[:2], listening=listening)
        async with quiet_node("one") as one:
            assert answering_ports(ports[2:]) == ports[2:]
            async with quiet_node("two") as two:
                await both_seen(two)
            assert one.context.ok()

    assert sayings(caplog) == []


async def test_a_setting_that_zenoh_does_not_know_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may come from a variable that was set long ago."""
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", "mode='nonsense'")
    with pytest.raises(ConfigurationError, match="ZENOH_CONFIG_OVERRIDE: \"mode='nonsense'\""):
        async with Context():
            pass


async def test_a_setting_of_the_program_is_named_as_such() -> None:
    """Then the variables are not to blame."""
    with pytest.raises(ConfigurationError, match="config: 'no/such/setting=1' given"):
        async with Context(config={"no/such/setting": 1}):
            pass


async def test_a_configuration_file_that_is_none_is_named(tmp_path: Path) -> None:
    """With the reason."""
    missing = tmp_path / "missing.json5"
    with pytest.raises(ConfigurationError, match=f"config: '{missing}' given"):
        async with Context(config=missing):
            pass


async def test_a_configuration_file_takes_the_place_of_all_settings(tmp_path: Path) -> None:
    """Two contexts that its author links hear each other."""
    (port,) = free_ports(1)
    listening, dialling = tmp_path / "listen.json5", tmp_path / "dial.json5"
    common = (
        "scouting: {multicast: {enabled: false}}, "
        "open: {return_conditions: {connect_scouted: false}}"
    )
    listening.write_text(
        f"{{mode: 'peer', listen: {{endpoints: ['tcp/127.0.0.1:{port}']}}, {common}}}"
    )
    dialling.write_text(
        f"{{mode: 'client', connect: {{endpoints: ['tcp/127.0.0.1:{port}']}}, {common}}}"
    )
    async with (
        quiet_node("a", Context(config=listening)) as a,
        quiet_node("b", Context(config=f"file://{dialling}")) as b,
    ):
        subscription = b.create_subscription(Int32, "n")
        publisher = a.create_publisher(Int32, "n", 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        assert (await subscription.receive()).data == 1


@pytest.mark.parametrize(
    ("options", "others"),
    [
        ({}, 0),
        ({"discovery_range": "SUBNET"}, None),
        ({"config": {"scouting/gossip/enabled": True}}, None),
    ],
)
async def test_the_number_of_peers_is_known_only_where_all_are_of_this_machine(
    options: dict[str, Any], others: int | None
) -> None:
    """Gossip may introduce those of other machines, for which a start did not wait."""
    opened = await open_session(network_from(os.environ, **options), "a10de")
    opened.close()

    assert opened.others == others


async def test_a_port_that_is_taken_is_named() -> None:
    """Two routers on one port cannot be."""
    endpoint = f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"
    first = await open_router([endpoint])
    try:
        with pytest.raises(TransportError, match="is another router running there"):
            await open_router([endpoint])
    finally:
        await close_session(first)


@pytest.mark.parametrize("router_first", [True, False])
async def test_ros_nodes_are_found_through_a_router(router_first: bool) -> None:
    """With rmw_zenoh's own configuration, whichever starts first."""
    router = await asyncio.to_thread(ros_router) if router_first else None
    async with quiet_node("ours") as ours:
        ros = await asyncio.to_thread(ros_session)
        if router is None:
            router = await asyncio.to_thread(ros_router)
        try:
            token = ros.liveliness().declare_token(
                f"@ros2_lv/{ours.context.domain_id}/{ros.zid()}/0/0/NN/%/%/theirs"
            )
            names = {"ours", "theirs"}
            await ours.graph.until(lambda: names == {n.name for n in ours.graph.nodes()})
            token.undeclare()
            await ours.graph.until(lambda: {"ours"} == {n.name for n in ours.graph.nodes()})
        finally:
            await asyncio.to_thread(ros.close)
            await asyncio.to_thread(router.close)


async def test_opening_can_be_cancelled() -> None:
    """Ctrl-C does not wait for the network, and nothing stays open."""
    context = Context()
    opening = asyncio.get_running_loop().create_task(context.__aenter__())
    await checkpoint()
    opening.cancel()
    with pytest.raises(asyncio.CancelledError):
        await opening

    async with context:
        assert context.ok()


async def test_work_in_a_thread_returns_its_result_and_leaves_no_thread() -> None:
    """An error is raised likewise."""
    before = set(threading.enumerate())

    assert await run_in_own_thread(lambda: 5) == 5
    with pytest.raises(ZeroDivisionError):
        await run_in_own_thread(lambda: 1 // 0)
    assert not set(threading.enumerate()) - before


async def test_a_result_without_a_waiter_is_given_up() -> None:
    """A session that opens after its context was cancelled is closed."""
    gate, late = threading.Event(), threading.Event()
    results: list[int] = []

    def work() -> int:
        gate.wait()
        return 5

    def give_up(result: int) -> None:
        results.append(result)
        late.set()

    waiting = asyncio.get_running_loop().create_task(run_in_own_thread(work, give_up))
    await checkpoint()
    waiting.cancel()
    with pytest.raises(asyncio.CancelledError):
        await waiting
    gate.set()
    await asyncio.to_thread(late.wait)

    assert results == [5]
