"""Processes find each other while others start, end or hang."""

from __future__ import annotations

import asyncio
import contextlib
import os
import queue
import signal
import threading
import time  # noqa: TID251  # how long a process takes is what is tested
from contextlib import ExitStack
from pathlib import Path

import pytest

from aionode.engine.transport.zenoh.connections import stopped_peers
from tests.end_to_end.process import SOON_S, Process, member
from tests.support.peers import quiet_node, ros_router, ros_session

ATTEMPTS = 4

STOPPED_S = 20.0
"""Within which a stopped process is given up; it takes half of that, on a machine that is idle."""


def group(stack: ExitStack, *names: str) -> list[Process]:
    """Start members one after another, each when the previous ones are open."""
    members = []
    for name in names:
        each = stack.enter_context(member(name))
        each.expect("open")
        members.append(each)
    return members


def heard_within(stack: ExitStack, limit_s: float, *others: str) -> Process:
    """Start newcomers until one hears all others soon enough after loading; return it.

    A loaded machine may delay any single one.
    """
    took = []
    for number in range(ATTEMPTS):
        newcomer = stack.enter_context(member(f"newcomer{number}"))
        began_s = newcomer.expect("started")
        took.append(newcomer.expect(*(f"heard {name}" for name in others)) - began_s)
        if took[-1] < limit_s:
            return newcomer
    pytest.fail(f"newcomers took {took} s to hear {others}; {limit_s} s is the limit")


def stop_soon(*members: Process) -> None:
    """End each with Ctrl-C, even if readers take nothing."""
    for each in members:
        took_s, status = each.stop()
        assert status == 0, f"{status}: {each.rest()}"
        assert took_s < SOON_S


@pytest.mark.parametrize("first", ["talker", pytest.param("listener", marks=pytest.mark.stress)])
def test_two_terminals_hear_each_other_in_either_order(first: str) -> None:
    """The tutorial: two commands, no configuration."""
    second = "listener" if first == "talker" else "talker"
    with Process(f"examples/{first}.py") as one, Process(f"examples/{second}.py") as two:
        listener = one if first == "listener" else two
        listener.expect("I heard: Hello")
        stop_soon(one, two)


def test_the_second_process_hears_the_first_soon_after_its_start() -> None:
    """`benchmarks/start.py` holds the target of 300 ms from exec, on a quiet machine."""
    with ExitStack() as stack:
        group(stack, "first")
        heard_within(stack, 1.0, "first")


def test_six_started_at_once_all_hear_all() -> None:
    """They compete for three meeting ports; those without one are introduced by the others."""
    names = [f"m{number}" for number in range(6)]
    with ExitStack() as stack:
        members = [stack.enter_context(member(name)) for name in names]
        for each in members:
            each.expect(*(f"heard {name}" for name in names))


def test_nothing_listens_beyond_loopback() -> None:
    """No other machine can reach a node unless its user asks for it."""
    with ExitStack() as stack:
        for each in group(stack, "a", "b"):
            addresses = listening_addresses(each.pid)
            assert addresses
            assert all(address.startswith("127.") for address in addresses)


def test_a_killed_process_leaves_the_graph_and_ends_its_calls() -> None:
    """It leaves soon, and waiting callers get an error."""
    with ExitStack() as stack:
        one, two, three = group(stack, "one", "two", "three")
        one.expect("heard three")
        two.write("call three -1")
        three.expect("asked")
        killed_s = time.monotonic()
        three.send(signal.SIGKILL)
        for each in (one, two):
            gone_s = each.expect("gone three") + each.started_s
            assert gone_s - killed_s < SOON_S
        ended_s = two.expect("error ServiceUnavailableError: /add_three: the server went away")
        assert ended_s + two.started_s - killed_s < SOON_S
        two.write("call one 5")
        two.expect("sum 5")


@pytest.mark.slow
@pytest.mark.one_loop
async def test_a_stopped_process_leaves_the_graph_of_those_that_do_not_look_at_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Beside many others, a process looks at a few of them, and is told by the rest."""
    monkeypatch.setattr(stopped_peers, "SUCCESSORS", 0)
    with ExitStack() as stack:
        frozen, _ = group(stack, "frozen", "looking")
        async with quiet_node("told") as node:

            def known() -> set[str]:
                return {other.name for other in node.graph.nodes()}

            async with asyncio.timeout(SOON_S):
                await node.graph.until(lambda: known() == {"frozen", "looking", "told"})
            frozen.send(signal.SIGSTOP)
            async with asyncio.timeout(STOPPED_S):
                await node.graph.until(lambda: known() == {"looking", "told"})


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(signal.SIGKILL, id="killed", marks=pytest.mark.stress),
        pytest.param(signal.SIGSTOP, id="frozen"),
    ],
)
def test_newcomers_hear_everyone_when_the_holder_of_the_meeting_port_is_gone(
    number: signal.Signals,
) -> None:
    """The first process holds the first port, but no other may depend on it."""
    with ExitStack() as stack:
        holder, *others = group(stack, "holder", "one", "two", "three")
        others[-1].expect("heard holder", "heard one", "heard two")
        holder.send(number)
        newcomer = heard_within(stack, 1.0, "one", "two", "three")
        stop_soon(newcomer, *others)


def test_newcomers_hear_everyone_when_all_holders_are_killed() -> None:
    """The remaining process has no meeting port, and dials them."""
    with ExitStack() as stack:
        *holders, last = group(stack, "h1", "h2", "h3", "last")
        last.expect("heard h1", "heard h2", "heard h3")
        for holder in holders:
            holder.send(signal.SIGKILL)
        last.expect("gone h1", "gone h2", "gone h3")
        newcomer = stack.enter_context(member("newcomer"))
        newcomer.expect("heard last")
        last.expect("heard newcomer")
        stop_soon(last, newcomer)


def test_the_others_do_not_notice_when_the_holder_goes() -> None:
    """Processes that know each other are connected directly."""
    with ExitStack() as stack:
        holder, one, two = group(stack, "holder", "one", "two")
        one.expect("heard two")
        holder.send(signal.SIGSTOP)
        one.write("call two 4")
        one.expect("sum 4")
        stop_soon(one, two)


@pytest.mark.parametrize("order", ["router first", "ours first"])
def test_ros_nodes_and_ours_see_each_other_through_a_router(order: str) -> None:
    """With rmw_zenoh's own configuration, in any order of start."""
    with ExitStack() as stack:
        if order == "router first":
            stack.callback(ros_router().close)
        ours = stack.enter_context(member("ours"))
        ours.expect("open")
        ros = ros_session()
        stack.callback(ros.close)
        if order == "ours first":
            stack.callback(ros_router().close)
        later = stack.enter_context(member("later"))
        key = "42/hello/std_msgs::msg::dds_::String_/RIHS01_" + STRING_HASH
        heard = []
        subscriber = ros.declare_subscriber(key, lambda s: heard.append(s.payload.to_bytes()))
        publisher = ros.declare_publisher(key)
        ends_s = time.monotonic() + 50
        while time.monotonic() < ends_s:
            publisher.put(b"\0\1\0\0\x04\0\0\0ros\0", attachment=bytes(16) + b"\x10" + bytes(16))
            if {b"ours", b"later"} <= {payload[8:-1] for payload in heard}:
                break
            time.sleep(0.02)
        assert {b"ours", b"later"} <= {payload[8:-1] for payload in heard}
        # Seen by the ROS side: now the other way.
        with contextlib.ExitStack() as puts:
            puts.callback(subscriber.undeclare)
            for each in (ours, later):
                each.expect("heard ros")


STRING_HASH = "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


def listening_addresses(pid: int) -> list[str]:
    """Return the addresses on which a process accepts connections or packets."""
    inodes = set()
    for descriptor in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(OSError):
            inodes.add(str(descriptor.readlink()).removeprefix("socket:[").removesuffix("]"))
    found = []
    for table, state in (("tcp", "0A"), ("tcp6", "0A"), ("udp", "07"), ("udp6", "07")):
        path = Path(f"/proc/{pid}/net/{table}")
        for line in path.read_text().splitlines()[1:] if path.exists() else ():
            fields = line.split()
            if fields[3] == state and fields[9] in inodes:
                found.append(readable(fields[1].split(":")[0]))
    return found


def readable(address: str) -> str:
    """Return an IPv4 address of /proc/net in dotted form, and an IPv6 address as it is."""
    if len(address) != 8:
        return address
    return ".".join(str(byte) for byte in reversed(bytes.fromhex(address)))


def test_our_router_introduces_ros_nodes_to_each_other() -> None:
    """`aionode router` is for users without rmw_zenohd."""
    endpoint = f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"
    with ExitStack() as stack:
        router = stack.enter_context(Process("-m", "aionode", "router", "--listen", endpoint))
        router.expect("Router is listening")
        one, two = ros_session(), ros_session()
        stack.callback(one.close)
        stack.callback(two.close)
        heard: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        subscriber = two.declare_subscriber("key", lambda s: heard.put(s.payload.to_bytes()))
        stack.callback(subscriber.undeclare)
        publisher = one.declare_publisher("key")
        linked = threading.Event()
        publisher.declare_matching_listener(lambda s: linked.set() if s.matching else None)
        if publisher.matching_status.matching:  # type: ignore[attr-defined]  # no bool
            linked.set()
        assert linked.wait(15), router.lines
        publisher.put(b"hello")
        assert heard.get(timeout=5) == b"hello"
        stop_soon(router)
