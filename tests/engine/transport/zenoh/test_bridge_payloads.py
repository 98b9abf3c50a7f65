"""Payloads for the keys of bridges, none of which a robot's bridge may fail to survive."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from typing import Any, TypeAlias

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aionode.action import CancelResponse
from aionode.clock import Duration
from aionode.engine.wire import cdr
from aionode.errors import AionodeError
from aionode.interfaces.action_msgs.srv import CancelGoal
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rcl_interfaces.srv import GetParameters
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Empty, String, UInt8MultiArray
from aionode.interfaces.std_srvs.srv import Empty as NoRequest
from aionode.message import type_name
from aionode.node import Node
from aionode.qos import QoSProfile
from tests.support.bridge import LATCHED, StandIn, stand_in, string
from tests.support.peers import KEEP_ALL, kept, quiet_node
from tests.support.strategies import messages
from tests.support.waiting import until

MOMENT = Duration(nanoseconds=1_000_000)
PROFILES = {
    "plain": QoSProfile(depth=5),
    "all": KEEP_ALL,
    "brief": QoSProfile(depth=1, lifespan=MOMENT, deadline=MOMENT),
    "kept": kept(3),
    "kept briefly": kept(3).replace(lifespan=MOMENT),
}
TOPICS: tuple[Any, ...] = (Empty, String, UInt8MultiArray, Image)
SERVICES: tuple[Any, ...] = (NoRequest, AddTwoInts, GetParameters)

ACTION = "example_interfaces/action/Fibonacci"
PARTS: dict[str, Any] = {
    "send_goal": Fibonacci.Impl.SendGoalService,
    "cancel_goal": CancelGoal,
    "get_result": Fibonacci.Impl.GetResultService,
}
"""The services of an action."""
OUTCOMES = ("succeed", "abort", "no end", "error")

Step: TypeAlias = tuple[Any, ...]


def messages_of(cls: Any) -> st.SearchStrategy[Any]:
    """Return what a program may publish: messages, and bytes that are one or not."""
    return messages(cls) | messages(cls).map(cdr.encode) | st.binary(max_size=12)


PUBLISH = st.sampled_from(TOPICS).flatmap(
    lambda cls: st.tuples(
        st.just("publish"),
        st.just(cls),
        st.sampled_from(list(PROFILES)),
        st.lists(messages_of(cls), max_size=4),
    )
)
CALL = st.sampled_from(SERVICES).flatmap(
    lambda cls: st.tuples(st.just("call"), st.just(cls), messages(cls.Request), st.booleans())
)
SERVE = st.sampled_from(SERVICES).flatmap(
    lambda cls: st.tuples(
        st.just("serve"),
        st.just(cls),
        messages(cls.Request).map(cdr.encode) | st.binary(max_size=12),
        messages(cls.Response) | st.sampled_from([None, ValueError("no"), cls.Response]),
    )
)
GOAL = st.tuples(
    st.just("goal"),
    messages(Fibonacci.Goal),
    st.fixed_dictionaries(
        {name: messages(cls.Response).map(cdr.encode) for name, cls in PARTS.items()}
    ),
    st.sampled_from(["waits", "cancels", "gives up"]),
)
EXECUTE = st.tuples(
    st.just("execute"),
    st.lists(
        st.sampled_from(list(PARTS)).flatmap(
            lambda name: st.tuples(
                st.just(name),
                messages(PARTS[name].Request).map(cdr.encode) | st.binary(max_size=12),
            )
        ),
        max_size=3,
    ),
    st.lists(messages(Fibonacci.Feedback), max_size=3),
    st.sampled_from(OUTCOMES),
)


def answered(response: bytes, _: bytes) -> bytes:
    """Answer a request with the same response each time."""
    return response


class Robot:
    """A bridge with a subscription to each topic, and a server of each service."""

    def __init__(self, bridge: StandIn) -> None:
        self.bridge = bridge
        self.served = 0
        for cls in TOPICS:
            bridge.subscribe(f"/now/{cls.__name__}", type_name(cls))
            bridge.subscribe(f"/kept/{cls.__name__}", type_name(cls), LATCHED)
        for cls in SERVICES:
            response = cdr.encode(cls.Response())
            bridge.serve(f"/{cls.__name__}", type_name(cls), partial(answered, response))
        self.answers: dict[str, bytes] = {}
        for part in PARTS:
            bridge.serve(f"/fib/_action/{part}", "", partial(self._answer, part), kind="")
        self.token = bridge.announce("AS", "/fib", ACTION)
        self.marks = bridge.subscribe("/mark")

    def _answer(self, part: str, _: bytes) -> bytes:
        """Answer as the action server of DDS."""
        return self.answers[part]

    async def run(self, steps: list[Step]) -> None:
        """Have a node do something, and wait until what it sent has passed the bridge."""
        async with quiet_node("ours") as node:
            for what, *rest in steps:
                await getattr(self, what)(node, *rest)
            mark = node.create_publisher(String, "/mark", 1)
            await mark.wait_for_subscribers()
            self.marks.clear()
            mark.publish(String(data="end"))
            async with asyncio.timeout(10):
                await until(lambda: string("end") in self.marks)

    async def publish(self, node: Node, cls: Any, profile: str, published: list[Any]) -> None:
        """Publish, and destroy the publisher."""
        name = f"/{'kept' if 'kept' in profile else 'now'}/{cls.__name__}"
        publisher = node.create_publisher(cls, name, PROFILES[profile])
        await publisher.wait_for_subscribers()
        for one in published:
            with suppress(AionodeError):  # of bytes that are not a message
                publisher.publish(one)
        publisher.assert_liveliness()
        await publisher.drain()
        publisher.destroy()

    async def call(self, node: Node, cls: Any, request: Any, gives_up: bool) -> None:
        """Call a service of DDS, and wait for its answer or not."""
        client = node.create_client(cls, f"/{cls.__name__}")
        await client.wait_for_service()
        answer = client.call_async(request)
        if gives_up:
            answer.cancel()
        else:
            await answer
        client.destroy()

    async def serve(self, node: Node, cls: Any, request: bytes, response: Any) -> None:
        """Serve one request of DDS, which may be none, with an answer that may be none."""

        def handle(_: Any) -> Any:
            if isinstance(response, Exception):
                raise response
            return response

        self.served += 1
        name = f"served_{self.served}"
        node.create_service(cls, f"/{name}", handle, on_error="log")
        token = f"/SS/{name}/"
        await until(lambda: any(token in one for one in list(self.bridge.announced)))
        for answer in await asyncio.to_thread(self.bridge.call, f"/{name}", request):
            assert answer[:2] in {b"\0\0", b"\0\1"}
            cdr.decode(cls.Response, answer)

    async def goal(self, node: Node, goal: Any, answers: dict[str, bytes], how: str) -> None:
        """Send a goal to a server of DDS, which may refuse it or answer with nonsense."""
        self.answers = answers
        client = node.create_action_client(Fibonacci, "/fib")
        await client.wait_for_server()
        with suppress(AionodeError, TimeoutError):
            async with asyncio.timeout(0.5):
                handle = await client.send_goal(goal)
                if how == "cancels":
                    await handle.cancel()
                if how != "gives up":
                    await handle.result()
        client.destroy()

    async def execute(
        self, node: Node, requests: list[tuple[str, bytes]], feedback: list[Any], outcome: str
    ) -> None:
        """Serve an action for a client of DDS, whose requests may be none."""

        async def run(goal: Any) -> Any:
            for one in feedback:
                goal.publish_feedback(one)
            if outcome == "error":
                raise ValueError("no")
            if outcome in {"succeed", "abort"}:
                getattr(goal, outcome)()
            return Fibonacci.Result()

        self.served += 1
        name = f"served_{self.served}"
        node.create_action_server(
            Fibonacci, f"/{name}", run, cancel_callback=lambda _: CancelResponse.ACCEPT
        )
        token = f"/AS/{name}/"
        await until(lambda: any(token in one for one in list(self.bridge.announced)))
        client = self.bridge.announce("AC", f"/{name}", ACTION)
        for part, request in requests:
            answers = await asyncio.to_thread(
                self.bridge.call, f"/{name}/_action/{part}", request, 0.5
            )
            for answer in answers:
                assert answer[:2] in {b"\0\0", b"\0\1"}
                cdr.decode(PARTS[part].Response, answer)
        client.undeclare()


@pytest.fixture
def runner() -> Iterator[asyncio.Runner]:
    """One event loop for all examples."""
    with asyncio.Runner() as one:
        yield one


@pytest.fixture
def robot() -> Iterator[Robot]:
    """One bridge for all examples."""
    with stand_in() as bridge:
        yield Robot(bridge)


@pytest.mark.slow
@pytest.mark.timeout(300)  # many of the steps wait for an answer that does not come
@given(st.lists(PUBLISH | CALL | SERVE | GOAL | EXECUTE, min_size=1, max_size=4))
@settings(max_examples=20, suppress_health_check=list(HealthCheck))
def test_nothing_that_goes_to_a_bridge_ends_it(
    robot: Robot, runner: asyncio.Runner, steps: list[Step]
) -> None:
    """Whatever a program does: no empty payload, no delete, no wildcard query, no bad token."""
    runner.run(robot.run(steps))

    assert robot.bridge.deaths == []
