"""Service introspection: events that clients and servers publish about requests and responses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import pytest

from aionode import (
    ActionClient,
    ActionServer,
    Client,
    Clock,
    Node,
    QoSProfile,
    Service,
    ServiceIntrospectionState,
    Time,
)
from aionode.errors import EntityDestroyedError, ServiceError
from aionode.graph import EndpointKind
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.service_msgs.msg import ServiceEventInfo
from aionode.qos import HistoryPolicy, qos_profile_system_default
from aionode.testing import settle
from tests.support.arrivals import gid_of, writers_of

OFF = ServiceIntrospectionState.OFF
METADATA = ServiceIntrospectionState.METADATA
CONTENTS = ServiceIntrospectionState.CONTENTS

Request = AddTwoInts.Request
Response = AddTwoInts.Response

TOPIC = "/add/_service_event"


def add(request: Request, response: Response) -> Response:
    """Answer with the sum."""
    response.sum = request.a + request.b
    return response


class Bench:
    """A service, a client, and a node that reads their events.

    Attributes:
        events: The events so far.
    """

    def __init__(self, node: Node, reader: Node) -> None:
        self.node = node
        self.server: Service[Any, Any] = node.create_service(AddTwoInts, "/add", add)
        self.client: Client[Any, Any] = node.create_client(AddTwoInts, "/add")
        self.events: list[Any] = []
        reader.create_subscription(AddTwoInts.Event, TOPIC, self.events.append, 100)

    def configure(
        self, client: ServiceIntrospectionState, server: ServiceIntrospectionState
    ) -> None:
        """Set the states of both."""
        clock = self.node.get_clock()
        self.client.configure_introspection(clock, qos_profile_system_default, client)
        self.server.configure_introspection(clock, qos_profile_system_default, server)

    async def call(self) -> list[Any]:
        """Call once, and return the events of that call, in the order of their types."""
        self.events.clear()
        await self.client.call(Request(a=2, b=3))
        await settle()
        return sorted(self.events, key=lambda event: int(event.info.event_type))


@pytest.fixture
async def bench(node_factory: Callable[..., Node]) -> Bench:
    """A service, a client and a reader in one context."""
    return Bench(node_factory("node"), node_factory("reader"))


async def test_nothing_is_published_before_it_is_asked_for(bench: Bench) -> None:
    """There is no publisher either, which would be an entry in the graph of every node."""
    assert await bench.call() == []
    assert bench.node.count_publishers(TOPIC) == 0


async def test_metadata_says_which_request_and_when(bench: Bench) -> None:
    """The four events of one call, without its contents, as rclpy publishes them."""
    bench.configure(METADATA, METADATA)
    clock = bench.node.get_clock()

    before = clock.now()
    events = await bench.call()

    assert [event.info.event_type for event in events] == [
        ServiceEventInfo.REQUEST_SENT,
        ServiceEventInfo.REQUEST_RECEIVED,
        ServiceEventInfo.RESPONSE_SENT,
        ServiceEventInfo.RESPONSE_RECEIVED,
    ]
    assert {event.info.sequence_number for event in events} == {1}
    gid = gid_of(bench.node, "/add", EndpointKind.CLIENT)
    assert {bytes(event.info.client_gid) for event in events} == {gid}
    assert all(len(event.request) == len(event.response) == 0 for event in events)
    after = clock.now()
    assert all(before <= Time.from_msg(event.info.stamp) <= after for event in events)


async def test_contents_are_those_of_the_call(bench: Bench) -> None:
    """The request with the request's events, the response with those of the response."""
    bench.configure(CONTENTS, CONTENTS)

    events = await bench.call()

    assert [list(event.request) for event in events] == [[Request(a=2, b=3)]] * 2 + [[]] * 2
    assert [list(event.response) for event in events] == [[]] * 2 + [[Response(sum=5)]] * 2


@pytest.mark.parametrize(
    ("client", "server", "types"),
    [(METADATA, OFF, [0, 3]), (OFF, METADATA, [1, 2]), (OFF, OFF, [])],
)
async def test_each_side_has_a_state_of_its_own(
    bench: Bench,
    client: ServiceIntrospectionState,
    server: ServiceIntrospectionState,
    types: list[int],
) -> None:
    """Often only one side of a system is watched."""
    bench.configure(client, server)

    assert [event.info.event_type for event in await bench.call()] == types


async def test_the_state_can_be_changed_at_any_time(bench: Bench) -> None:
    """With OFF the publisher goes, too."""
    bench.configure(CONTENTS, CONTENTS)
    assert bench.node.count_publishers(TOPIC) == 2
    bench.configure(METADATA, METADATA)
    assert [len(event.request) for event in await bench.call()] == [0] * 4

    bench.configure(OFF, OFF)

    assert await bench.call() == []
    assert bench.node.count_publishers(TOPIC) == 0


async def test_another_profile_takes_effect(bench: Bench) -> None:
    """A reader that comes late may want the last events, for example."""
    clock = bench.node.get_clock()
    bench.server.configure_introspection(clock, 10, METADATA)
    bench.server.configure_introspection(clock, QoSProfile(depth=3), METADATA)

    (publisher,) = bench.node.get_publishers_info_by_topic(TOPIC)
    assert publisher.qos_profile.depth == 3


async def test_a_failing_handler_sends_no_response(bench: Bench) -> None:
    """ROS has no event for an error; the request's events are there."""
    bench.server.destroy()

    def fail(request: Request, response: Response) -> Response:
        raise ValueError("no")

    bench.server = bench.node.create_service(AddTwoInts, "/add", fail)
    bench.configure(METADATA, METADATA)

    with pytest.raises(ServiceError):
        await bench.call()
    await settle()

    assert sorted(int(event.info.event_type) for event in bench.events) == [0, 1]


async def test_events_follow_the_clock_that_was_given(bench: Bench) -> None:
    """So stamps can be compared with those of messages, on whichever clock these are."""

    class Stopped(Clock):
        def now(self) -> Time:
            return Time(seconds=5, nanoseconds=7)

    bench.server.configure_introspection(Stopped(), 10, METADATA)

    stamps = [event.info.stamp for event in await bench.call()]
    assert [(stamp.sec, stamp.nanosec) for stamp in stamps] == [(5, 7)] * 2


async def test_a_full_reader_does_not_disturb_the_calls(
    node: Node, node_factory: Callable[..., Node], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`publish` refuses if a reader that keeps all events reads none; the call continues."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
    node_factory("reader").create_subscription(
        AddTwoInts.Event, TOPIC, qos_profile=QoSProfile(history=HistoryPolicy.KEEP_ALL)
    )
    server = node.create_service(AddTwoInts, "/add", add)
    client = node.create_client(AddTwoInts, "/add")
    server.configure_introspection(node.get_clock(), keep_all, METADATA)
    (publisher,) = [each for each in node.publishers if each.topic_name == TOPIC]
    for writer in writers_of(publisher):
        monkeypatch.setattr(writer, "has_room", lambda: False)
        monkeypatch.setattr(writer, "bounded", True)

    assert (await client.call(Request(a=1, b=1))).sum == 2


async def test_the_publisher_goes_with_its_owner(bench: Bench) -> None:
    """No entry is left in the graph."""
    bench.configure(METADATA, METADATA)

    bench.server.destroy()
    bench.client.destroy()

    assert bench.node.count_publishers(TOPIC) == 0
    with pytest.raises(EntityDestroyedError):
        bench.server.configure_introspection(bench.node.get_clock(), 10, METADATA)


async def test_invalid_arguments_are_refused(bench: Bench) -> None:
    """With the valid options."""
    with pytest.raises(ValueError, match="7 is not a valid ServiceIntrospectionState"):
        bench.server.configure_introspection(bench.node.get_clock(), 10, 7)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="clock is None; expected a clock"):
        bench.client.configure_introspection(None, 10, METADATA)  # type: ignore[arg-type]


@pytest.mark.parametrize("on_client_lost", ["cancel", "continue"])
async def test_the_services_of_an_action_are_introspected(
    node: Node,
    node_factory: Callable[..., Node],
    on_client_lost: Literal["cancel", "continue"],
) -> None:
    """On either side: a goal, and the result that was asked for; no signs of life."""

    def execute(goal: Any) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1])

    server = ActionServer(node, Fibonacci, "/count", execute, on_client_lost=on_client_lost)
    client = ActionClient(node, Fibonacci, "/count")
    goals: list[Any] = []
    results: list[Any] = []
    impl = Fibonacci.Impl
    for topic, service, seen in (
        ("send_goal", impl.SendGoalService, goals),
        ("get_result", impl.GetResultService, results),
    ):
        node_factory("reader_" + topic).create_subscription(
            service.Event, f"/count/_action/{topic}/_service_event", seen.append, 100
        )
    server.configure_introspection(node.get_clock(), 10, CONTENTS)
    client.configure_introspection(node.get_clock(), 10, CONTENTS)

    await client.call(Fibonacci.Goal(order=7))
    await settle()

    assert sorted(int(event.info.event_type) for event in goals) == [0, 1, 2, 3]
    assert {event.request[0].goal.order for event in goals if len(event.request)} == {7}
    assert sorted(int(event.info.event_type) for event in results) == [0, 1, 2, 3]
    assert {len(e.response[0].result.sequence) for e in results if len(e.response)} == {2}
