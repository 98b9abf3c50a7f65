"""The counts of live publishers, whatever happens in which order."""

from __future__ import annotations

import asyncio

from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.clock import Duration
from aionode.endpoints.events import QoSLivelinessChangedInfo
from aionode.engine.rules.liveliness import PublisherLiveliness
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.qos import LivelinessPolicy, QoSProfile
from aionode.testing import ManualClock

NODE = NodeInfo("1", 0, "node", "/")
LEASE = Duration(seconds=1)
PUBLISHERS = [
    EndpointInfo(
        EndpointKind.PUBLISHER,
        NODE,
        number,
        "/n",
        "std_msgs/msg/Int32",
        "",
        QoSProfile(depth=1, liveliness=policy, liveliness_lease_duration=LEASE),
        bytes([number] * 16),
    )
    for number, policy in enumerate(
        [LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC] * 2
    )
]
STEPS = st.lists(
    st.tuples(
        st.sampled_from(["add", "remove", "message", "assertion", "pass"]),
        st.sampled_from(PUBLISHERS),
        st.sampled_from([0.3, 0.6, 1.0]),
    ),
    max_size=40,
)


@given(STEPS, st.booleans())
@settings(deadline=None)
def test_the_counts_are_those_of_the_publishers(
    steps: list[tuple[str, EndpointInfo, float]], limited: bool
) -> None:
    """Each change adds up, and none is counted twice."""
    events: list[QoSLivelinessChangedInfo] = []

    async def run() -> None:
        clock = ManualClock()
        profile = QoSProfile(depth=1, liveliness_lease_duration=LEASE if limited else Duration())
        watched = PublisherLiveliness(clock, profile, events.append)
        watched.start()
        for what, publisher, seconds in steps:
            if what == "add":
                watched.add(publisher)
            elif what == "remove":
                watched.remove(publisher)
            elif what == "message":
                watched.note_message(publisher.gid)
            elif what == "assertion":
                watched.note_assertion(publisher.gid)
            else:
                await clock.advance(seconds)
            states = [lease.alive for lease in watched._leases.values()]
            assert watched._alive == states.count(True)
            assert watched._not_alive == states.count(False)
        watched.stop()
        await clock.advance(5)

    asyncio.run(run())
    alive = not_alive = 0
    for event in events:
        alive += event.alive_count_change
        not_alive += event.not_alive_count_change
        assert (alive, not_alive) == (event.alive_count, event.not_alive_count)
        assert event.alive_count_change or event.not_alive_count_change


async def test_messages_renew_the_lease_of_an_automatic_publisher_whose_assertions_stay_away() -> (
    None
):
    """A network may lose assertions alone: a publisher whose messages arrive is alive."""
    clock = ManualClock()
    events: list[QoSLivelinessChangedInfo] = []
    automatic = PUBLISHERS[0]
    liveliness = PublisherLiveliness(clock, automatic.qos, events.append)
    liveliness.start()
    liveliness.add(automatic)
    liveliness.note_assertion(automatic.gid)
    for _ in range(3):
        await clock.advance(0.6)
        liveliness.note_message(automatic.gid)
    assert [event.alive_count for event in events] == [1]
    await clock.advance(1)
    assert [event.alive_count for event in events] == [1, 0]
    liveliness.note_message(automatic.gid)
    assert [event.alive_count for event in events] == [1, 0, 1]
    liveliness.stop()
