"""Commands of remote clients: who holds a topic, and when the stop is sent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from aionode.errors import RefusedError
from aionode.gateway import Session
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import (
    Pose,
    PoseStamped,
    Quaternion,
    Twist,
    TwistStamped,
    Vector3,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.testing import settle
from tests.support.gateway_bench import Bench

POLICY = """
[[who]]
name = "high"
loopback = true
[[who]]
name = "low"
loopback = true
[[who]]
name = "other"
loopback = true
[[allow]]
who = "high"
publish = "/**"
type = "geometry_msgs/msg/*"
lease = { ttl_sec = 0.3, priority = 2 }
[[allow]]
who = ["low", "other"]
publish = "/**"
type = "geometry_msgs/msg/*"
lease = { ttl_sec = 0.3, priority = 1, stop = { linear = { z = -1.0 } } }
[[who]]
name = "pilot"
loopback = true
[[allow]]
who = "pilot"
publish = "/goal_pose"
lease = { stop = { header = { frame_id = "base_link" } } }
[[allow]]
publish = "/**"
"""


class Connection:
    """A connection whose client answers a ping when the test says so."""

    def __init__(self) -> None:
        self.pongs: list[Callable[[], None]] = []

    def silent_sec(self) -> float:
        """Return how long nothing has arrived."""
        return 0.0

    def has_unread(self) -> bool:
        """Return whether data is waiting."""
        return False

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Keep the answer for later."""
        if answered is not None:
            self.pongs.append(answered)

    def abort(self) -> None:
        """Do nothing."""


@pytest.fixture
def wheels(bench: Bench) -> list[tuple[float, float]]:
    """Record what the wheels receive: forward, and upward in some stops."""
    got: list[tuple[float, float]] = []
    bench.node.create_subscription(
        Twist, "/cmd_vel", lambda msg: got.append((msg.linear.x, msg.linear.z)), 100
    )
    bench.allow(POLICY)
    return got


async def drive(session: Session, speed: float, **options: int) -> None:
    """Send a command."""
    await session.publish(
        "/cmd_vel", Twist(linear=Vector3(x=speed)), "geometry_msgs/Twist", **options
    )
    await settle()


async def refusal(session: Session, speed: float = 9.0, **options: int) -> str:
    """Return the code with which a command is refused."""
    with pytest.raises(RefusedError) as refused:
        await drive(session, speed, **options)
    return refused.value.code


async def test_the_stop_is_sent_when_a_client_is_silent(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """A frozen page or an unplugged cable: once, after the time to live."""
    async with bench.session("high") as session:
        await drive(session, 1.0)
        await bench.advance(0.2)
        await drive(session, 2.0)
        await bench.advance(0.299)
        assert wheels == [(1, 0), (2, 0)]
        await bench.advance(0.001)
        assert wheels == [(1, 0), (2, 0), (0, 0)]
        await bench.advance(1.0)
        assert len(wheels) == 3
        assert bench.robot.commands.holders() == {}


async def test_the_stop_is_sent_when_a_client_leaves(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """A closed tab: at once; the policy defines the message."""
    async with bench.session("low") as session:
        await drive(session, 1.0)
    await settle()
    assert wheels == [(1, 0), (0, -1)]


async def test_a_type_whose_default_may_move_the_robot_needs_a_stop(bench: Bench) -> None:
    """A robot would drive to a pose at the origin, or at a default speed."""
    bench.allow(POLICY)
    pose = PoseStamped(pose=Pose(orientation=Quaternion(z=1.0, w=0.0)))
    async with bench.session("high") as session:
        with pytest.raises(RefusedError, match=r"pose\.orientation\.w=1\.0; give the rule's lease"):
            await session.publish("/goal_pose", pose, "geometry_msgs/PoseStamped")
        assert bench.robot.commands.holders() == {}


async def test_a_stop_of_the_policy_serves_such_a_type(bench: Bench) -> None:
    """The owner of the robot knows which message stops it."""
    bench.allow(POLICY)
    async with bench.session("pilot") as session:
        await session.publish("/goal_pose", PoseStamped(), "geometry_msgs/PoseStamped")
        assert list(bench.robot.commands.holders()) == ["/goal_pose"]


async def test_the_stop_is_sent_when_a_client_is_cancelled(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """As a web server does when a connection is lost."""
    async with asyncio.TaskGroup() as tasks:

        async def client() -> None:
            async with bench.session("high") as session:
                await drive(session, 1.0)
                await asyncio.Event().wait()

        running = tasks.create_task(client())
        await settle()
        running.cancel()
    await settle()
    assert wheels == [(1, 0), (0, 0)]


async def test_one_client_at_a_time_commands(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """Others learn who commands, and may command afterwards."""
    async with bench.session("low") as first, bench.session("other") as second:
        await drive(first, 1.0)
        with pytest.raises(RefusedError, match="low commands it now") as refused:
            await drive(second, 2.0)
        assert refused.value.code == "held"
        await first.unadvertise("/cmd_vel")
        await drive(second, 3.0)
    await settle()
    assert wheels == [(1, 0), (0, -1), (3, 0), (0, -1)]


async def test_a_higher_priority_takes_the_topic_over(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """The former holder's stop is sent first, and it cannot take the topic back."""
    async with bench.session("low") as low, bench.session("high") as high:
        await drive(low, 1.0)
        await drive(high, 2.0)
        assert await refusal(low) == "held"
        assert wheels == [(1, 0), (0, -1), (2, 0)]
        await bench.advance(0.3)
        await drive(low, 3.0)
    await settle()
    assert wheels[3:] == [(0, 0), (3, 0), (0, -1)]


async def test_a_rule_without_a_lease_is_no_way_around_a_holder(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """While somebody commands a topic, nobody else publishes to it through the gateway."""
    async with bench.session("high") as high, bench.session("guest") as guest:
        await drive(high, 1.0)
        assert await refusal(guest) == "held"
    await settle()
    assert wheels == [(1, 0), (0, 0)]


async def test_a_command_that_waited_too_long_is_refused(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """Half a second in a queue of the gateway, with the default limit."""
    async with bench.session("high") as session:
        arrived_ns = session.steady_ns()
        await bench.advance(0.6)
        assert await refusal(session, arrived_ns=arrived_ns) == "too_old"
    assert wheels == []


async def test_a_command_with_an_old_stamp_is_refused(bench: Bench) -> None:
    """A stamp in the future, which says as little about the command's age, is refused too."""
    bench.allow(POLICY)
    got: list[TwistStamped] = []
    bench.node.create_subscription(TwistStamped, "/stamped", got.append)
    now_ns = bench.clock.now().nanoseconds
    async with bench.session("high") as session:
        for age_ns, is_refused in ((0, False), (600_000_000, True), (-600_000_000, True)):
            stamp = Time(sec=(now_ns - age_ns) // 10**9, nanosec=(now_ns - age_ns) % 10**9)
            command = TwistStamped(header=Header(stamp=stamp))
            work = session.publish("/stamped", command, "geometry_msgs/TwistStamped")
            if is_refused:
                with pytest.raises(RefusedError) as refused:
                    await work
                assert refused.value.code == "too_old"
            else:
                await work
        await settle()
        assert len(got) == 1


async def test_what_a_link_delivers_after_a_silence_is_refused(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """It was sent before the cut; data after the pong was sent after the ping."""
    async with bench.session("high") as session:
        session.arrivals.connection = connection = Connection()
        await drive(session, 1.0)
        await bench.advance(0.3)
        assert await refusal(session) == "too_old"
        (pong,) = connection.pongs
        pong()
        await drive(session, 2.0)
    await settle()
    assert wheels == [(1, 0), (0, 0), (2, 0), (0, 0)]


async def test_a_command_that_waits_while_the_ping_is_answered_is_refused(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """It arrived before the pong, and waits in a lane for the description of its type."""
    async with bench.session("high") as session:
        session.arrivals.connection = connection = Connection()
        await drive(session, 1.0)
        await bench.advance(0.3)
        session.arrivals.note_frame()
        arrived_ns = session.arrivals.arrival_ns()
        connection.pongs.pop()()
        assert await refusal(session, arrived_ns=arrived_ns) == "too_old"
        await bench.advance(0.001)
        session.arrivals.note_frame()
        await drive(session, 2.0)
    await settle()
    assert wheels == [(1, 0), (0, 0), (2, 0), (0, 0)]


async def test_the_gateway_repeats_nothing(bench: Bench, wheels: list[tuple[float, float]]) -> None:
    """It repeats none while a client is silent, nor when it takes the topic again."""
    async with bench.session("high") as session:
        for _ in range(3):
            await drive(session, 1.0)
            await bench.advance(5.0)
    await settle()
    assert wheels == [(1, 0), (0, 0)] * 3


async def test_commands_at_once_open_one_lease(
    bench: Bench, wheels: list[tuple[float, float]]
) -> None:
    """Two clients whose first commands arrive in the same loop iteration."""
    async with bench.session("low") as first, bench.session("other") as second:
        results = await asyncio.gather(
            drive(first, 1.0), drive(second, 2.0), drive(first, 3.0), return_exceptions=True
        )
        assert [isinstance(each, RefusedError) for each in results] == [False, True, False]
        assert wheels == [(1, 0), (3, 0)]


async def test_a_stop_that_does_not_fit_refuses_the_command(bench: Bench) -> None:
    """A mistake in the policy shows before anything moves."""
    bench.allow("[[allow]]\npublish = '/x'\nlease = { stop = { speed = 0 } }")
    got: list[Twist] = []
    bench.node.create_subscription(Twist, "/x", got.append)
    async with bench.session() as session:
        with pytest.raises(ValueError, match="speed"):
            await session.publish("/x", Twist(), "geometry_msgs/Twist")
    await settle()
    assert got == []


async def test_without_a_file_velocities_have_a_lease(bench: Bench) -> None:
    """A tutorial's page that sends one command must not drive the robot into a wall."""
    got: list[float] = []
    bench.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x))
    async with bench.session() as session:
        await drive(session, 1.0)
        await bench.advance(0.5)
        assert got == [1.0, 0.0]
