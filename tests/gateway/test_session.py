"""Sessions: a client's actions are allowed or refused, and all of them end with the client.

Tests set the time, and there are no sockets: see `test_server.py` for those.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from aionode.action import ActionServer
from aionode.errors import (
    InterfaceNotFoundError,
    MessageError,
    NodeNameNonExistentError,
    RefusedError,
    ServiceError,
)
from aionode.gateway import FieldLimit, Policy, Rule, Session
from aionode.gateway.session.feed import Received
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.rcl_interfaces.srv import SetParameters
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.parameter import Parameter
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from aionode.testing import settle
from tests.support.gateway_bench import Bench

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NOTHING = Policy()


def text_of(received: Received) -> str:
    """Return the text of a message."""
    text: str = received.message.data
    return text


def waiting(session: Session) -> list[Any]:
    """Return the frames that wait for a client."""
    frames = []
    while (frame := session.outbox.next_frame()) is not None:
        frames.append(frame)
    return frames


async def subscribe(session: Session) -> None:
    """Subscribe to a topic of the robot."""
    await session.subscribe("/words", frame=text_of, key="w")


async def publish(session: Session) -> None:
    """Publish."""
    await session.publish("/x", {"data": "a"}, "std_msgs/String")


async def call(session: Session) -> None:
    """Call a service of the robot."""
    await session.call("/add", {"a": 1, "b": 2})


async def send_goal(session: Session) -> None:
    """Send a goal to an action of the robot."""
    async with session.goal("/count", {"order": 3}) as goal:
        await goal.result()


async def set_parameter(session: Session) -> None:
    """Set a parameter of the robot."""
    await session.parameters.set("/robot", Parameter("speed", value=2.0))


async def serve(session: Session) -> None:
    """Offer a service."""

    async def answer(request: Any) -> Any:
        return {"sum": request.a + request.b}

    await session.serve("/mine", "example_interfaces/srv/AddTwoInts", answer)


async def serve_action(session: Session) -> None:
    """Offer an action."""

    async def execute(goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result(sequence=[1])

    await session.serve_action("/mine", "example_interfaces/action/Fibonacci", execute)


async def see(session: Session) -> None:
    """Read the parameters of the robot."""
    assert "speed" in await session.parameters.names("/robot")


ACTIONS = [
    (subscribe, "subscribe = '/words'"),
    (publish, "publish = '/x'"),
    (call, "call = '/add'"),
    (send_goal, "goal = '/count'"),
    (set_parameter, "parameter = '/robot:speed'"),
    (serve, "advertise = '/mine'"),
    (serve_action, "advertise = '/mine'"),
    (see, "see = '/robot'"),
]


@pytest.fixture
def furnished(bench: Bench) -> Bench:
    """A robot with a topic, a service, an action and a parameter."""
    bench.node.create_publisher(String, "/words", 10)
    bench.node.create_service(AddTwoInts, "/add", lambda r: AddTwoInts.Response(sum=r.a + r.b))
    bench.node.declare_parameter("speed", 1.0)

    async def count(goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1])

    ActionServer(bench.node, Fibonacci, "/count", count)
    return bench


@pytest.mark.parametrize(("act", "rule"), ACTIONS)
async def test_each_rule_allows_what_it_says(
    furnished: Bench, act: Callable[[Session], Awaitable[None]], rule: str
) -> None:
    """Nothing more is needed for it."""
    furnished.allow(f"[[allow]]\n{rule}\n[[allow]]\nsee = '/robot'")
    async with furnished.session() as session:
        await act(session)


@pytest.mark.parametrize("act", [act for act, _ in ACTIONS])
async def test_what_no_rule_allows_does_not_reach_the_robot(
    furnished: Bench, act: Callable[[Session], Awaitable[None]]
) -> None:
    """The robot sees neither an endpoint nor a message of the client."""
    furnished.robot.policy = NOTHING
    before = set(furnished.context.graph.endpoints())
    async with furnished.session() as session:
        with pytest.raises(RefusedError) as refused:
            await act(session)
        assert refused.value.code == "not_allowed"
        assert set(furnished.context.graph.endpoints()) == before
        assert session.rights.refused == 1


async def test_a_client_sees_only_what_the_policy_shows(furnished: Bench) -> None:
    """Names reveal much; a hidden node is as if it did not exist."""
    furnished.allow("[[allow]]\nsubscribe = '/words'\ncall = '/add'\n[[allow]]\ngoal = '/count'")
    async with furnished.session() as session:
        assert session.graph.topics() == {"/words": ["std_msgs/msg/String"]}
        assert session.graph.services() == {"/add": ["example_interfaces/srv/AddTwoInts"]}
        assert session.graph.actions() == {"/count": ["example_interfaces/action/Fibonacci"]}
        assert session.graph.nodes() == []
        with pytest.raises(NodeNameNonExistentError):
            session.graph.node_details("/robot")


# Ways around a rule


@pytest.mark.parametrize("part", ["send_goal", "get_result", "cancel_goal"])
async def test_an_action_has_no_way_in_by_its_services(furnished: Bench, part: str) -> None:
    """A client that may call all services must not send goals, which nobody would cancel."""
    furnished.allow("[[allow]]\ncall = '/**'")
    async with furnished.session() as session:
        with pytest.raises(RefusedError):
            await session.call(f"/count/_action/{part}", {})


async def test_parameters_have_no_way_in_by_their_services(furnished: Bench) -> None:
    """A client that may call all services must not set parameters, nor exceed their limits."""
    speed = Parameter("speed", value=9.0).to_parameter_msg()
    request = SetParameters.Request(parameters=[speed])
    async with furnished.session() as session:
        furnished.allow("[[allow]]\ncall = '/**'")
        with pytest.raises(RefusedError):
            await session.call("/robot/set_parameters", request)
        furnished.allow(
            "[[allow]]\ncall = '/**'\nparameter = '/**'\nfields = { value = { max = 5 } }"
        )
        with pytest.raises(RefusedError):
            await session.call("/robot/set_parameters", request)
    assert furnished.node.get_parameter("speed").value == 1.0


@pytest.mark.parametrize(
    "more", ["ask = true", "rate_hz = 1000", "fields = { value = { max = 5, outside = 'clamp' } }"]
)
async def test_a_call_gets_around_no_part_of_a_rule_for_parameters(
    furnished: Bench, more: str
) -> None:
    """A person's approval, a rate and a limit apply to setting it as a parameter."""
    speed = Parameter("speed", value=9.0).to_parameter_msg()
    furnished.allow(f"[[allow]]\ncall = '/**'\n[[allow]]\nparameter = '/**'\n{more}")
    async with furnished.session() as session:
        with pytest.raises(RefusedError):
            await session.call("/robot/set_parameters", SetParameters.Request(parameters=[speed]))
    assert furnished.node.get_parameter("speed").value == 1.0


@pytest.mark.parametrize("node", ["/r{ns}obot", "/{node}", "robot", "~", "/robot/"])
async def test_the_name_of_a_node_is_taken_as_it_is(furnished: Bench, node: str) -> None:
    """A name expanded later would be another node than the one the policy was asked about."""
    async with furnished.session() as session:
        with pytest.raises(ValueError, match="name"):
            await session.parameters.set(node, Parameter("speed", value=2.0))
        with pytest.raises(ValueError, match="name"):
            await session.parameters.names(node)


async def test_a_relative_name_is_judged_by_what_it_stands_for(bench: Bench) -> None:
    """Clients of rosbridge omit the slash."""
    bench.allow("[[allow]]\npublish = '/x'")
    async with bench.session() as session:
        await session.publish("x", {"data": "a"}, "std_msgs/String")
        with pytest.raises(RefusedError):
            await session.publish("~/x", {"data": "a"}, "std_msgs/String")


# Limits


async def test_a_field_is_clamped_or_refused(bench: Bench) -> None:
    """The robot gets no velocity beyond the limits."""
    got: list[float] = []
    bench.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x))
    rule = "[[allow]]\npublish = '/cmd_vel'\nfields = {{ 'linear.x' = {{ max = 0.5{} }} }}"
    async with bench.session() as session:
        bench.allow(rule.format(", outside = 'clamp'"))
        await session.publish("/cmd_vel", Twist(linear=Vector3(x=3.0)), "geometry_msgs/Twist")
        bench.allow(rule.format(""))
        with pytest.raises(RefusedError) as refused:
            await session.publish("/cmd_vel", Twist(linear=Vector3(x=3.0)))
    await settle()
    assert got == [0.5]
    assert refused.value.code == "out_of_limits"


async def test_a_parameter_is_clamped(furnished: Bench) -> None:
    """The same limits, for the field `value`."""
    limit = FieldLimit(max=1.5, outside="clamp")
    furnished.robot.policy = Policy(allow=[Rule(parameter="/robot", fields={"value": limit})])
    async with furnished.session() as session:
        await session.parameters.set("/robot", Parameter("speed", value=2.0))
        found = await session.parameters.get("/robot", ["speed", "none"])
        assert found == {"speed": Parameter("speed", value=1.5)}


async def test_a_rate_and_a_size_are_limited(bench: Bench) -> None:
    """For the client as a whole: a second connection does not double the rate."""
    bench.allow("[[allow]]\npublish = '/x'\nrate_hz = 2\nmax_bytes = 50")
    async with bench.session() as first, bench.session() as second:
        await publish(first)
        await publish(second)
        with pytest.raises(RefusedError) as refused:
            await publish(second)
        assert refused.value.code == "too_fast"
        await bench.advance(0.5)
        with pytest.raises(RefusedError) as refused:
            await first.publish("/x", {"data": "a" * 100})
        assert refused.value.code == "too_large"


async def test_what_a_client_holds_is_limited(bench: Bench) -> None:
    """Subscriptions, topics that it publishes, and services that it offers."""
    bench.node.create_publisher(String, "/words", 10)
    bench.allow(
        "[limits]\nsubscriptions = 1\nadvertised = 1\n"
        "[[allow]]\nsubscribe = '/**'\npublish = '/**'\nadvertise = '/**'"
    )
    async with bench.session() as session:
        for act in (subscribe, publish, serve):
            await act(session)
        for again in (
            subscribe(session),
            session.publish("/y", {"data": "a"}, "std_msgs/String"),
            session.serve("/y", "example_interfaces/srv/AddTwoInts", settled),
        ):
            with pytest.raises(RefusedError) as refused:
                await again
            assert refused.value.code == "too_many"


async def settled(request: Any) -> Any:
    """Answer nothing."""
    return {}


async def test_a_person_says_yes_or_no(furnished: Bench) -> None:
    """Without anyone to ask it is refused; a slow person delays nobody else."""
    furnished.allow("[[allow]]\ncall = '/add'\nask = true")
    asked: list[Any] = []
    answer = asyncio.get_running_loop().create_future()

    async def ask(identity: Any, verb: Any, name: str, message: Any) -> bool:
        asked.append((identity.name, verb, name, message.a))
        answered: bool = await answer
        return answered

    async with furnished.session() as session, asyncio.TaskGroup() as tasks:
        with pytest.raises(RefusedError) as refused:
            await call(session)
        assert refused.value.code == "not_confirmed"
        furnished.robot.ask = ask
        calling = tasks.create_task(session.call("/add", {"a": 1, "b": 2}))
        await settle()
        assert asked == [("guest", "call", "/add", 1)]
        answer.set_result(True)
        assert (await calling).sum == 3
        answer = asyncio.get_running_loop().create_future()
        answer.set_result(False)
        with pytest.raises(RefusedError):
            await call(session)


# Topics


async def test_a_message_is_encoded_once_for_all_clients(bench: Bench) -> None:
    """Fifty clients cost one encoding."""
    words = bench.node.create_publisher(String, "/words", 10)
    made: list[str] = []

    def encode(received: Received) -> str:
        made.append(received.message.data)
        return made[-1]

    async with bench.session() as first, bench.session() as second:
        for session in (first, second):
            await session.subscribe("/words", frame=lambda r: r.once("json", encode), key="w")
        words.publish(String(data="a"))
        await settle()
        assert (waiting(first), waiting(second), made) == (["a"], ["a"], ["a"])
        assert len(list(bench.robot.feeds)) == 1
    assert list(bench.robot.feeds) == []


async def test_a_slow_client_keeps_its_newest_messages(bench: Bench) -> None:
    """It slows nobody down: the oldest are dropped and counted."""
    words = bench.node.create_publisher(String, "/words", 10)
    async with bench.session() as slow, bench.session() as fast:
        await slow.subscribe("/words", frame=text_of, key="w", depth=2)
        await fast.subscribe("/words", frame=text_of, key="w", depth=10)
        for text in "abcde":
            words.publish(String(data=text))
            await settle()
        assert waiting(fast) == ["a", "b", "c", "d", "e"]
        assert waiting(slow) == ["d", "e"]
        assert slow.dropped() == {"/words": 3}


async def test_little_is_kept_for_those_who_come_late(bench: Bench) -> None:
    """A message in Python takes far more than its text, and a client sends as it likes."""
    heard: list[str] = []
    async with bench.session() as session:
        for number in range(30):
            await session.publish("/words", {"data": str(number)}, "std_msgs/String")
        late = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        bench.node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), late)
        await settle()

    assert heard == [str(number) for number in range(20, 30)]


async def test_a_client_that_comes_late_gets_what_is_kept_for_it(bench: Bench) -> None:
    """A map, a robot description: even if another client has subscribed before."""
    maps = bench.node.create_publisher(String, "/map", LATCHED)
    maps.publish(String(data="map"))
    async with bench.session() as first, bench.session() as second:
        await first.subscribe("/map", frame=text_of, key="m")
        await settle()
        await second.subscribe("/map", frame=text_of, key="m")
        await settle()
        assert (waiting(first), waiting(second)) == (["map"], ["map"])


BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.mark.parametrize("offered", [LATCHED, BEST_EFFORT])
async def test_a_publisher_that_comes_later_is_heard(bench: Bench, offered: QoSProfile) -> None:
    """Whatever it offers: earlier subscriptions adapt to it. Its latched messages arrive once."""
    async with bench.session() as session:
        await session.subscribe("/late", "std_msgs/String", frame=text_of, key="l")
        await settle()
        publisher = bench.node.create_publisher(String, "/late", offered)
        publisher.publish(String(data="x"))
        await settle()
        publisher.publish(String(data="y"))
        await settle()
        assert waiting(session) == ["x", "y"]


async def test_a_subscription_matches_the_qos_of_existing_publishers(bench: Bench) -> None:
    """Without one it requests nothing; later it misses no message that a publisher repeats."""

    async def wanted() -> tuple[ReliabilityPolicy, DurabilityPolicy]:
        await settle()
        (subscription,) = bench.node.get_subscriptions_info_by_topic("/late")
        profile = subscription.qos_profile
        return profile.reliability, profile.durability

    weak = (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    strong = (ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    async with bench.session() as session:
        await session.subscribe("/late", "std_msgs/String", frame=text_of, key="l")
        assert await wanted() == weak
        reliable = bench.node.create_publisher(String, "/late", LATCHED)
        assert await wanted() == strong
        unreliable = bench.node.create_publisher(String, "/late", BEST_EFFORT)
        assert await wanted() == weak
        unreliable.publish(String(data="u"))
        await settle()
        unreliable.destroy()
        assert await wanted() == strong
        reliable.publish(String(data="r"))
        await settle()
        assert waiting(session) == ["u", "r"]


async def test_a_rate_leaves_messages_out(bench: Bench) -> None:
    """A dashboard needs five a second, not a thousand."""
    words = bench.node.create_publisher(String, "/words", 10)
    async with bench.session() as session:
        await session.subscribe("/words", frame=text_of, key="w", depth=1, min_period_sec=0.2)
        read = []
        for text in "abcdefg":
            words.publish(String(data=text))
            await bench.advance(0.075)
            read += waiting(session)
        assert read == ["a", "c", "f"]


@pytest.mark.parametrize(
    ("depth", "later"), [(1, [["e"], [], []]), (2, [["d"], ["e"], []])], ids=["newest", "two"]
)
async def test_a_rate_keeps_the_newest_messages_of_a_burst(
    bench: Bench, depth: int, later: list[list[str]]
) -> None:
    """The last state has to arrive: a light that went off must not be shown as on forever."""
    words = bench.node.create_publisher(String, "/words", 10)
    async with bench.session() as session:
        await session.subscribe("/words", frame=text_of, key="w", depth=depth, min_period_sec=1.0)
        for text in "abcde":
            words.publish(String(data=text))
        await bench.advance(0.9)
        assert waiting(session) == ["a"]
        for expected in later:
            await bench.advance(1.0)
            assert waiting(session) == expected


async def test_a_rate_forgets_what_waits_when_its_client_unsubscribes(bench: Bench) -> None:
    """Nothing arrives after the end."""
    words = bench.node.create_publisher(String, "/words", 10)
    async with bench.session() as session:
        subscribed = await session.subscribe("/words", frame=text_of, key="w", min_period_sec=1.0)
        for text in "ab":
            words.publish(String(data=text))
        await settle()
        subscribed.close()
        await bench.advance(5.0)
        assert waiting(session) == []


async def test_a_message_that_does_not_fit_is_refused(bench: Bench) -> None:
    """The error names the wrong field; nothing is sent."""
    async with bench.session() as session:
        with pytest.raises(MessageError, match="data"):
            await session.publish("/x", {"data": 5}, "std_msgs/String")
        with pytest.raises(InterfaceNotFoundError):
            await session.publish("/y", {"data": 5})
        with pytest.raises(InterfaceNotFoundError):
            await session.publish("/y", {}, "../etc/passwd")


# The end


async def test_a_session_that_ends_gives_everything_back(furnished: Bench) -> None:
    """The robot's graph is as before, at most ten seconds later."""
    before = set(furnished.context.graph.endpoints())
    async with furnished.session() as session:
        for act, _ in ACTIONS:
            if act is not serve_action:
                await act(session)
    await furnished.advance(10.1)
    assert set(furnished.context.graph.endpoints()) == before


async def test_a_goal_is_cancelled_with_its_client(bench: Bench) -> None:
    """Motion ends when its client has gone, even if it just closes its connection."""
    ended: list[str] = []

    async def drive(goal: Any) -> Any:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            ended.append("cancelled")
            raise

    ActionServer(bench.node, Fibonacci, "/drive", drive, cancel_callback=lambda _: accepted())
    async with asyncio.TaskGroup() as tasks:

        async def client() -> None:
            async with (
                bench.session() as session,
                session.goal("/drive", {"order": 3}) as goal,
            ):
                await goal.result()

        running = tasks.create_task(client())
        await settle()
        running.cancel()
    await settle()
    assert ended == ["cancelled"]


def accepted() -> Any:
    """Accept the request to cancel a goal."""
    from aionode.action import CancelResponse

    return CancelResponse.ACCEPT


async def test_who_calls_a_service_of_a_client_that_leaves_gets_an_error(bench: Bench) -> None:
    """Rosbridge answers with an empty response."""
    client = bench.node.create_client(AddTwoInts, "/mine")

    async def never(request: Any) -> Any:
        await asyncio.Event().wait()

    async with asyncio.TaskGroup() as tasks:
        async with bench.session() as session:
            await session.serve("/mine", "example_interfaces/AddTwoInts", never)
            await client.wait_for_service()
            calling = tasks.create_task(failure_of(client.call(AddTwoInts.Request())))
            await settle()
        assert isinstance(await calling, ServiceError)


async def failure_of(work: Awaitable[Any]) -> Exception:
    """Return the exception that work raises."""
    try:
        await work
    except ServiceError as error:
        return error
    raise AssertionError


async def test_an_error_of_a_client_reaches_who_called_its_service(
    bench: Bench, capfd: pytest.CaptureFixture[str]
) -> None:
    """Without a traceback in the robot's log."""

    async def fail(request: Any) -> Any:
        raise ValueError("no such thing")

    async with bench.session() as session:
        await session.serve("/mine", "example_interfaces/AddTwoInts", fail)
        client = bench.node.create_client(AddTwoInts, "/mine")
        with pytest.raises(ServiceError, match="no such thing"):
            await client.call(AddTwoInts.Request())
    assert "Traceback" not in capfd.readouterr().err


async def test_a_policy_that_is_read_again_ends_what_it_does_not_allow(bench: Bench) -> None:
    """The client stays connected, and whatever is still allowed continues."""
    words = bench.node.create_publisher(String, "/words", 10)
    numbers = bench.node.create_publisher(Int32, "/numbers", 10)
    async with bench.session() as session:
        await subscribe(session)
        await session.subscribe("/numbers", frame=lambda r: str(r.message.data), key="n")
        bench.allow("[[allow]]\nsubscribe = '/numbers'")
        session.check_again()
        words.publish(String(data="a"))
        numbers.publish(Int32(data=1))
        await settle()
        assert waiting(session) == ["1"]
        assert not session.ended.is_set()


@pytest.mark.parametrize("does", [publish, serve, serve_action])
async def test_a_client_that_may_not_publish_or_offer_any_more_is_disconnected(
    bench: Bench, does: Callable[[Session], Awaitable[None]]
) -> None:
    """This ends its leases, goals and services."""
    async with bench.session() as session:
        await does(session)
        session.check_again()
        assert not session.ended.is_set()
        bench.allow("[[allow]]\nsubscribe = '/**'")
        session.check_again()
        assert session.ended.is_set()


# The audit log


async def test_the_audit_log_says_who_did_what(furnished: Bench) -> None:
    """Including refusals."""
    furnished.allow("[[allow]]\ncall = '/add'")
    async with furnished.session("operator") as session:
        await call(session)
        with pytest.raises(RefusedError):
            await publish(session)
    await settle()
    called, refused = [json.loads(line) for line in furnished.lines]
    assert called["who"] == "operator"
    assert (called["action"], called["name"], called["result"]) == ("call", "/add", "ok")
    assert "a=1" in called["arguments"]
    assert "duration_ms" in called
    assert (refused["action"], refused["code"]) == ("publish", "not_allowed")


async def test_a_client_that_asks_in_vain_does_not_fill_the_audit_log(bench: Bench) -> None:
    """A limited number of refusals per second is written, and the others are counted."""
    bench.robot.policy = NOTHING
    async with bench.session() as session:
        for _ in range(100):
            with pytest.raises(RefusedError):
                await publish(session)
    await settle()
    for result in ("succeeded", "failed: why"):
        bench.robot.audit.note(session.identity, "goal", "/" + "x" * 9999, result=result)
    await settle()
    assert len(bench.lines) == 22  # actions are still written, shortened
    assert bench.robot.audit.lost == 80
    assert len(json.dumps(bench.lines[-1])) < 5000
