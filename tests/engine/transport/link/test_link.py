"""Links between contexts: which route messages take, and what happens when a link breaks."""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import resource
import socket
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace

from aionode._process.concurrency import checkpoint
from aionode.content_filter import ContentFilterOptions
from aionode.endpoints.subscription import MessageInfo
from aionode.engine.context import Context
from aionode.engine.transport.drops import Drop
from aionode.engine.transport.link import _listener as listener
from aionode.engine.transport.link import _subscription as subscription
from aionode.engine.transport.link._continuation import seal
from aionode.engine.transport.link._protocol import Kind, Release, RetransmitDone
from aionode.engine.transport.link._subscription import LinkReader
from aionode.engine.transport.link._transport import LinkTransport
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire.typehash import type_hash
from aionode.errors import ConfigurationError, ServiceUnavailableError
from aionode.graph import EndpointKind
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import QoSProfile, ReliabilityPolicy
from tests.support.arrivals import gid_of
from tests.support.links import (
    Counting,
    Two,
    calls_of,
    fd_of,
    folder,
    freeze,
    link_of,
    manager_of,
    thaw,
    two_nodes,
    writer_of,
)
from tests.support.peers import DOMAIN_ID, KEEP_ALL, Collector, quiet_node, raw_session
from tests.support.waiting import until

__all__ = ["folder"]  # a fixture

NUMBERS = data_key(DOMAIN_ID, "/n", "std_msgs/msg/Int32", type_hash(Int32))


def number_of(sample: Any) -> int:
    """Return the number that a bare session has received."""
    return cdr.decode(Int32, sample.payload.to_bytes()).data


async def test_a_stream_changes_to_the_link_and_leaves_zenoh() -> None:
    """Each message arrives once and in order; after that, Zenoh is not used."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        assert not writer_of(numbers.publisher).routes.update()
        await numbers.go(500)
        assert numbers.subscription.stats.lost == 0


async def test_a_message_that_is_held_has_the_time_of_its_arrival(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With the time of its release, measured rates would be those of the hand-over."""
    monkeypatch.setattr(subscription, "ZENOH_LATE_S", 0.2)
    monkeypatch.setattr(LinkReader, "deliver", lambda *_: None)  # # Zenoh delivers nothing
    async with two_nodes() as nodes:
        infos: list[MessageInfo] = []
        publisher = nodes.a.create_publisher(Int32, "n", 100)
        nodes.b.create_subscription(Int32, "n", lambda _: None, 100)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32())  # the next subscription waits for it
        nodes.b.create_subscription(Int32, "n", lambda _, info: infos.append(info), 100)
        await publisher.wait_for_subscribers(2)
        await until(lambda: manager_of(nodes.a).links)
        while not infos:  # # a few at a time: if there are too many, none is held
            publisher.publish(Int32())
            await asyncio.to_thread(threading.Event().wait, 0.005)

    assert infos[0]["received_timestamp"] - infos[0]["source_timestamp"] < 100_000_000


async def test_every_kind_of_reader_gets_each_message_once() -> None:
    """One over the link, one in the same process, and one bare Zenoh session without tokens."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        beside = nodes.a.create_subscription(Int32, "n", None, 1000)
        await numbers.publisher.wait_for_subscribers(2)
        await numbers.until_linked()
        before = numbers.next
        with raw_session() as session:
            samples = Collector()
            subscriber = session.declare_subscriber(f"{DOMAIN_ID}/**", samples)
            # One at a time, and until the last is heard: Zenoh may drop some of a burst.
            await numbers.go_until(lambda: len(samples.items) >= 50)
            end = numbers.next
            await numbers.go_until(lambda: number_of(samples.items[-1]) >= end)
            subscriber.undeclare()
        heard = [number_of(sample) for sample in samples.items]
        assert heard == list(range(heard[0], heard[0] + len(heard)))
        assert before <= heard[0]
        assert [(await beside.receive()).data for _ in range(numbers.next)] == list(
            range(numbers.next)
        )
        assert numbers.subscription.stats.lost == 0


async def test_what_continues_a_link_after_its_end_is_not_called_a_fault(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A context closes its links first; the other end continues over Zenoh for a moment."""
    async with two_nodes() as nodes:
        await Counting(nodes).until_linked()
        ended = manager_of(nodes.b)
        secret = link_of(nodes.b).secret

    ended.on_retransmit(seal(secret, 1, RetransmitDone().pack()))

    assert [each.message for each in caplog.records if each.levelno >= logging.WARNING] == []


async def test_what_was_in_a_broken_link_reaches_each_reader_once() -> None:
    """Including what took both routes, and what was sent before an unannounced peer subscribed."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 10_000)
        await numbers.until_linked()
        before = numbers.next
        stalled = link_of(nodes.b)
        freeze(stalled)
        numbers.publish(100)
        with raw_session() as session:
            samples = Collector()
            subscriber = session.declare_subscriber(NUMBERS, samples)
            # until the unannounced peer is known
            await until(writer_of(numbers.publisher).routes.update)
            while not samples.items:
                numbers.publish()
                await checkpoint()
            numbers.publish(20)
            stalled.close()
            numbers.publish(20)
            assert [
                (await numbers.subscription.receive()).data for _ in range(before, numbers.next)
            ] == list(range(before, numbers.next))
            end = numbers.next
            while number_of(samples.items[-1]) < end:
                numbers.publish()
                await checkpoint()
            subscriber.undeclare()
        heard = [number_of(sample) for sample in samples.items]
        assert heard == sorted(set(heard))  # Zenoh may drop some of a burst
        assert numbers.subscription.stats.lost == 0


async def test_a_stream_goes_on_over_zenoh_when_the_link_ends_and_back_when_it_is_there() -> None:
    """Either end may close the link, and no message is lost."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        for node in nodes:
            await numbers.until_linked()
            link = link_of(node)
            link.close()
            await numbers.go(20)
            while link in (
                manager_of(n).linked(p) for n in nodes for p in manager_of(n).links
            ):  # # the other end has not noticed yet
                await numbers.go()
        await numbers.until_linked()
        assert numbers.subscription.stats.lost == 0


@pytest.mark.parametrize("profile", [QoSProfile(depth=1000), KEEP_ALL])
async def test_a_filtered_stream_loses_nothing_that_passes_when_the_link_ends(
    profile: QoSProfile,
) -> None:
    """What the filter rejects is sent too, and counts as received where messages are confirmed."""
    async with two_nodes() as nodes:
        subscription = nodes.b.create_subscription(
            Int32, "n", None, profile, content_filter_options=ContentFilterOptions("data > 0")
        )
        publisher = nodes.a.create_publisher(Int32, "n", profile)
        await publisher.wait_for_subscribers()
        number = 0
        for node in nodes:
            while writer_of(publisher).linked != 1:
                number += 1
                publisher.publish(Int32(data=number))
                assert (await subscription.receive()).data == number
            first = number + 1
            for _ in range(50):
                number += 1
                publisher.publish(Int32(data=number if number % 5 == 0 else 0))
                if number == first + 25:
                    link_of(node).close()
            number += 1
            publisher.publish(Int32(data=number))
            wanted = [n for n in range(first, number) if n % 5 == 0]
            got: list[int] = []
            while not got or got[-1] != number:
                got.append((await subscription.receive()).data)
            assert got == [*wanted, number]
        assert subscription.stats.filtered > 0
        assert subscription.stats.dropped == 0


async def test_the_end_is_seen_where_something_is_left_to_read_and_nothing_to_write() -> None:
    """An event loop may report only once that the other end closed the socket with data unread."""
    async with two_nodes() as nodes:
        unconfirmed = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
        numbers = Counting(nodes, unconfirmed)
        back = Counting(Two(nodes.b, nodes.a), topic="back")
        await numbers.until_linked()
        await back.until_linked()
        ends = [link_of(node) for node in nodes]
        for end in ends:
            freeze(end)
        first = numbers.next
        numbers.publish(20)
        back.publish(1)
        while not all(end.idle for end in ends):
            await checkpoint()
        ends[0].close()
        thaw(ends[1])
        while not ends[1].closed:
            await checkpoint()
        assert [(await numbers.subscription.receive()).data for _ in range(20)] == list(
            range(first, numbers.next)
        )
        assert (await back.subscription.receive()).data == back.next - 1


@pytest.mark.parametrize(
    "garbage", [b"no frame at all" * 10, b"\xff" * 40, b"\x00"], ids=["text", "length", "cut"]
)
async def test_malformed_data_ends_the_link_and_not_the_stream(
    garbage: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    """Both ends continue over Zenoh, and a warning gives the reason."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        link = link_of(nodes.b)
        os.write(fd_of(link), garbage)
        if len(garbage) < 40:
            link.close()
        await numbers.go_until(lambda: link.closed)
        await numbers.go(100)
        assert numbers.subscription.stats.lost == 0
    assert len(garbage) < 40 or "expected a frame" in caplog.text


async def test_what_a_link_brings_and_nobody_can_read_has_a_number_and_a_line(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The other process may have another definition of the type; the reader has to know."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        nodes.b.create_service(AddTwoInts, "add", lambda request, response: response)
        client: Any = nodes.a.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        await numbers.until_linked()
        link, bad = link_of(nodes.a), b"\0\1\0\0x"
        server = gid_of(nodes.b, "/add", EndpointKind.SERVER)
        asker = gid_of(nodes.a, "/add", EndpointKind.CLIENT)
        link.send_data(int(Kind.DATA), 10_000, 0, gid_of(nodes.a, "/n"), [bad])
        link.send_data(int(Kind.REQUEST), 1, 0, asker, [server, bad])
        dropped = manager_of(nodes.b).drops.of(Drop.MALFORMED)
        await until(lambda: len(dropped) == 2)

        assert dropped == {"/n": 1, "/add": 1}
        assert nodes.b.context.dropped == {"malformed": 2}
        assert numbers.subscription.stats.errors == 1
    assert sum("unknown form" in text for text in caplog.messages) == 2


async def test_retransmissions_that_cannot_be_read_are_reported_once_in_a_while(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Any process on the network may send any number of them."""
    async with quiet_node("one") as node:
        for _ in range(500):
            manager_of(node).on_retransmit(b"no frame at all" * 10)
    assert sum("retransmitted" in text for text in caplog.messages) == 1


async def test_unknown_clients_of_the_socket_get_no_link_and_stop_nothing(folder: Path) -> None:
    """Silence, garbage, or a frame before the Hello does not become a link."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        path = folder / f"{nodes.b.context.participant}.sock"
        for sent in (b"", b"x" * 100, bytes(7)):
            with socket.socket(socket.AF_UNIX) as client:
                client.connect(str(path))
                client.send(sent)
                await numbers.publisher.wait_for_subscribers()
                await numbers.go(5)
        assert manager_of(nodes.b).links in ([], [nodes.a.context.participant])


async def test_other_users_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process at the other end of the socket belongs to another user."""
    monkeypatch.setattr(listener, "is_own_user", lambda _: False)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.publisher.wait_for_subscribers()
        await numbers.go(20)
        assert manager_of(nodes.a).links == manager_of(nodes.b).links == []


def open_to_others(folder: Path) -> None:
    """Make the folder accessible to others."""
    folder.mkdir(mode=0o755)


def a_file(folder: Path) -> None:
    """Put a file in place of the folder."""
    folder.touch()


def no_parent(folder: Path) -> None:
    """Remove the parent of the folder."""
    folder.parent.rmdir()


@pytest.mark.parametrize("spoil", [open_to_others, a_file, no_parent])
async def test_without_a_folder_of_its_own_everything_goes_over_zenoh(
    spoil: Any, folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A warning says what is wrong with the folder."""
    spoil(folder)
    with caplog.at_level(logging.WARNING, "aionode.transport.link"):
        async with two_nodes() as nodes:
            numbers = Counting(nodes)
            await numbers.publisher.wait_for_subscribers()
            await numbers.go(20)
    assert str(folder) in caplog.text
    folder.parent.mkdir(exist_ok=True)


async def test_a_slow_reader_loses_the_oldest_and_the_publisher_counts_them() -> None:
    """While the socket is full, at most the publisher's depth of messages wait for it."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 10)
        await numbers.until_linked()
        link = link_of(nodes.b)
        freeze(link)
        numbers.publish(20_000)
        dropped = writer_of(numbers.publisher).dropped
        assert 0 < dropped < 20_000
        end = link_of(nodes.a)
        (waiting,) = end.queues
        assert waiting.unsent - end.unsent(gid_of(nodes.a, "/n")) == 10
        thaw(link)
        while (await numbers.subscription.receive()).data != numbers.next - 1:
            pass
        assert numbers.subscription.stats.lost == dropped


@pytest.mark.slow
async def test_a_keep_all_reader_that_does_not_read_fills_the_publisher_and_loses_nothing() -> None:
    """`drain` waits for the reader, and `publish` refuses messages beyond the limit."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, KEEP_ALL)
        await numbers.until_linked()
        begin = numbers.next
        total = 0
        while total < 40_000 and writer_of(numbers.publisher).has_room():
            numbers.publish()
            total += 1
            if not total % 1000:
                await asyncio.to_thread(lambda: None)  # # the loop runs meanwhile
        assert not writer_of(numbers.publisher).has_room()
        drained = asyncio.get_running_loop().create_future()

        async def drain() -> None:
            await numbers.publisher.drain()
            drained.set_result(None)

        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(drain())
            got = [(await numbers.subscription.receive()).data for _ in range(total)]
            assert got == list(range(begin, numbers.next))
            await drained
        assert numbers.subscription.stats.dropped == numbers.subscription.stats.lost == 0


@pytest.mark.slow
async def test_keep_all_loses_nothing_while_the_link_comes_up() -> None:
    """However far behind Zenoh is when the reader asks for the link."""
    async with two_nodes() as nodes:
        heard: list[int] = []
        nodes.b.create_subscription(Int32, "n", lambda msg: heard.append(msg.data), KEEP_ALL)
        publisher = nodes.a.create_publisher(Int32, "n", KEEP_ALL)
        await publisher.wait_for_subscribers()
        for number in range(12_000):
            if not writer_of(publisher).has_room():
                await publisher.drain()
            publisher.publish(Int32(data=number))
        await publisher.drain()
        while len(heard) < 12_000:
            await asyncio.to_thread(lambda: None)
        assert heard == list(range(12_000))


# Services


async def test_a_call_takes_the_link_and_ends_with_it() -> None:
    """The client cannot know whether the server has begun, so it is not sent again."""
    async with two_nodes() as nodes:
        begun = asyncio.Event()

        async def serve(request: Any, response: Any) -> Any:
            if request.a == 0:
                begun.set()
                await asyncio.Event().wait()
            response.sum = request.a + request.b
            return response

        nodes.b.create_service(AddTwoInts, "add", serve, concurrent=True)
        client: Any = nodes.a.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        while not manager_of(nodes.a).links:
            assert (await client.call(AddTwoInts.Request(a=1, b=2))).sum == 3
        async with asyncio.TaskGroup() as tasks:
            call = tasks.create_task(fails(client.call(AddTwoInts.Request(a=0, b=0))))
            await begun.wait()
            link_of(nodes.b).close()
            assert isinstance(await call, ServiceUnavailableError)
        assert (await client.call(AddTwoInts.Request(a=3, b=4))).sum == 7


async def test_an_action_takes_the_link() -> None:
    """Its services and feedback come in order, and the result after them."""
    async with two_nodes() as nodes:

        async def execute(goal: Any) -> Any:
            for number in range(20):
                goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
                await checkpoint()
            goal.succeed()
            return Fibonacci.Result(sequence=[1, 2])

        nodes.b.create_action_server(Fibonacci, "count", execute)
        client: Any = nodes.a.create_action_client(Fibonacci, "count")
        await client.wait_for_server()
        await until(lambda: manager_of(nodes.a).links)
        for _ in range(3):
            goal = await client.send_goal(Fibonacci.Goal(order=20))
            got = [list(feedback.sequence) async for feedback in goal]
            assert got == [[number] for number in range(20)]
            assert list((await goal.result()).result.sequence) == [1, 2]
        assert not calls_of(nodes.a)


async def fails(awaitable: Any) -> Exception | None:
    """Return the exception that it raises."""
    try:
        await awaitable
    except ServiceUnavailableError as error:
        return error
    return None


async def test_a_server_in_a_bare_session_is_asked_over_zenoh() -> None:
    """Links do not reach it, but a query over Zenoh reaches every server."""
    async with two_nodes() as nodes:
        served = []

        def serve(request: Any, response: Any) -> Any:
            served.append(request.a)
            return response

        nodes.b.create_service(AddTwoInts, "add", serve)
        async with quiet_node("c", Context(link=False)) as c:
            c.create_service(AddTwoInts, "add", serve)
            client: Any = nodes.a.create_client(AddTwoInts, "add")
            while nodes.a.count_services("/add") < 2:
                await nodes.a.graph.changed()
            await client.call(AddTwoInts.Request(a=1))
            await client.call(AddTwoInts.Request(a=2))
            assert calls_of(nodes.a) == {}
        assert set(served) == {1, 2}


# Large payloads


def image(number: int) -> Image:
    """Return an image of a single colour."""
    return Image(height=600, width=1000, step=1000, data=bytes([number]) * 600_000)


def memory_files() -> int:
    """Return how many in-memory files this process has open."""
    files = list(Path("/proc/self/fd").iterdir())
    return sum("memfd:" in str(file.readlink()) for file in files if file.is_symlink())


async def linked_images(nodes: Two) -> tuple[Any, Any]:
    """Return a publisher of images and its reader, linked from the first image on."""
    numbers = Counting(nodes)
    await numbers.until_linked()
    publisher = nodes.a.create_publisher(Image, "images", 10)
    subscription = nodes.b.create_subscription(Image, "images", None, 10)
    await numbers.go_until(lambda: writer_of(publisher).linked)
    return publisher, subscription


async def test_images_come_in_shared_memory_that_is_used_again() -> None:
    """They are read in place, unchanged while anything refers to them, and released afterwards."""
    async with two_nodes() as nodes:
        publisher, subscription = await linked_images(nodes)
        assert not writer_of(publisher).routes.update()  # # and Zenoh is not used
        kept = []
        for number in range(1, 6):
            publisher.publish(image(number))
            kept.append(await subscription.receive())
        lent = link_of(nodes.a).lent
        assert len(lent) == 5
        assert [np.frombuffer(one.data, np.uint8).max() for one in kept] == [1, 2, 3, 4, 5]
        assert all(memoryview(one.data).readonly for one in kept)
        kept.clear()
        gc.collect()
        while lent:
            await checkpoint()  # # the receiver reports it in its next turns of the event loop
        files = memory_files()
        publisher.publish(image(7))
        last = await subscription.receive()
        assert memory_files() == files
        assert bytes(last.data[:1]) == bytes([7])


@pytest.mark.parametrize("wakes", [False, True], ids=["in the loop", "in another thread"])
async def test_memory_is_released_where_the_last_reference_is_dropped(
    monkeypatch: pytest.MonkeyPatch, *, wakes: bool
) -> None:
    """The loop is woken by other threads only: it takes a system call, for each image."""
    loop = asyncio.get_running_loop()
    soon = loop.call_soon_threadsafe
    woken: list[tuple[Any, ...]] = []

    def call_soon(callback: Any, *args: Any, **options: Any) -> Any:
        woken.append(args)
        return soon(callback, *args, **options)

    async with two_nodes() as nodes:
        publisher, subscription = await linked_images(nodes)
        publisher.publish(image(1))
        kept = [await subscription.receive()]
        lent = link_of(nodes.a).lent
        number = next(iter(lent))
        monkeypatch.setattr(loop, "call_soon_threadsafe", call_soon)
        if wakes:
            await asyncio.to_thread(kept.clear)
        else:
            kept.clear()
        while lent:
            await checkpoint()

    assert ((Release(number),) in woken) is wakes


async def test_without_descriptors_large_payloads_go_through_the_stream(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is slower, but nothing is lost."""

    def exhausted(*_: Any) -> int:
        raise OSError(24, "Too many open files")

    async with two_nodes() as nodes:
        publisher, subscription = await linked_images(nodes)
        monkeypatch.setattr(os, "memfd_create", exhausted)
        for number in range(5):
            publisher.publish(image(number))
            assert bytes((await subscription.receive()).data[:1]) == bytes([number])
        assert not link_of(nodes.a).lent


async def test_a_receiver_without_descriptors_goes_on_over_zenoh_and_loses_nothing(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The system drops the descriptor on receipt, and with it the location of the image."""
    async with two_nodes() as nodes:
        publisher, subscription = await linked_images(nodes)
        pool = manager_of(nodes.a).pool
        fresh = pool.filled(bytes(600_000))  # # for which the receiver has no descriptor
        assert fresh is not None
        pool.release(fresh)
        limits = resource.getrlimit(resource.RLIMIT_NOFILE)
        free = os.open("/dev/null", os.O_RDONLY)
        os.close(free)
        resource.setrlimit(resource.RLIMIT_NOFILE, (free, limits[1]))
        link = link_of(nodes.a)
        try:
            for number in range(1, 4):
                publisher.publish(image(number))
            while not link.closed:
                await checkpoint()
        finally:
            # Zenoh itself loses large messages meanwhile: it has shared memory of its own.
            resource.setrlimit(resource.RLIMIT_NOFILE, limits)
        for number in range(1, 4):
            assert bytes((await subscription.receive()).data[:1]) == bytes([number])
    assert "too many files are open" in caplog.text


# # Leftovers


def descriptors() -> int:
    """Return how many descriptors are open."""
    return len(list(Path("/proc/self/fd").iterdir()))


def sockets(folder: Path) -> int:
    """Return how many sockets are in the folder."""
    return len(list(folder.iterdir()))


async def test_nothing_is_left_behind(folder: Path) -> None:
    """Neither a descriptor nor a socket.

    Zenoh closes its shared memory in another thread, a moment after the session.
    """
    async with two_nodes():  # # opened once and kept
        pass
    before = descriptors()
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        assert sockets(folder) == 2
    assert sockets(folder) == 0
    gc.collect()
    async with asyncio.timeout(10):
        while descriptors() > before:
            await asyncio.to_thread(threading.Event().wait, 0.01)
    assert descriptors() <= before


async def test_sockets_of_the_killed_are_removed(folder: Path) -> None:
    """A killed process could not remove its socket."""
    os.mkdir(folder, 0o700)  # noqa: PTH102  # nothing else uses the loop here
    with socket.socket(socket.AF_UNIX) as dead:
        dead.bind(str(folder / "dead.sock"))
    async with two_nodes():
        assert not (folder / "dead.sock").exists()


# The switch


def test_a_link_is_used_unless_it_was_switched_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """The variable decides unless the argument is given."""

    def linked(**options: Any) -> bool:
        return isinstance(Context(**options).transports[1], LinkTransport)

    monkeypatch.delenv("AIONODE_LINK", raising=False)
    assert linked()
    assert not linked(link=False)
    monkeypatch.setenv("AIONODE_LINK", "off")
    assert not linked()
    assert linked(link=True)
    monkeypatch.setenv("AIONODE_LINK", "on")
    assert linked()
    monkeypatch.setenv("AIONODE_LINK", "perhaps")
    with pytest.raises(ConfigurationError):
        linked()


async def test_contexts_with_and_without_links_hear_each_other() -> None:
    """One of them is an older release, or has links disabled."""
    async with two_nodes(links=(True, False)) as nodes:
        numbers = Counting(nodes)
        await numbers.publisher.wait_for_subscribers()
        await numbers.go(50)
        assert manager_of(nodes.a).links == []


def test_an_advertisement_says_which_contexts_can_be_linked() -> None:
    """Same host, same user, same version; any other text is rejected."""
    own = listener.Advertisement.own("1a")
    assert listener.Advertisement.parse(own.text()) == own
    assert own.is_near(replace(own, participant="2b"))
    assert not own.is_near(own)
    for other in (replace(own, host="x"), replace(own, uid=own.uid + 1)):
        assert not own.is_near(replace(other, participant="2b"))
    for text in ("", "1a/link", "../x/link/1/h/0", "1a/link/-1/h/0", f"{'1' * 33}/link/1/h/0"):
        assert listener.Advertisement.parse(text) is None
