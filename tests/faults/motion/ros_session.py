"""Movers and wheels of a stand-in for a ROS 2 node on rmw_zenoh: see `tests.faults.standin`."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import zenoh  # plays another participant, without aionode

from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._liveliness import gid_of
from aionode.graph import EndpointKind
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.test_msgs.action import Fibonacci
from tests.faults.motion.words import Handed, Mover, What, Wheel

if TYPE_CHECKING:
    from tests.faults.standin import StandIn

__all__ = ["commander", "obey", "send_goal"]

GOAL_ID = os.urandom(16)

ASK_S = 2.0
"""How often a goal is sent until there is an answer."""


def commander(stand_in: StandIn, mover: Mover) -> Callable[[], None]:
    """Return a function that publishes one command."""
    publisher = stand_in.session.declare_publisher(stand_in.key(mover.topic, Twist))
    gid = gid_of(stand_in.endpoint(EndpointKind.PUBLISHER, mover.topic, 10, Twist))
    sequence = 0

    def publish() -> None:
        nonlocal sequence
        sequence += 1
        command = Twist(
            linear=Vector3(x=1.0, y=time.monotonic()), angular=Vector3(x=float(os.getpid()))
        )
        publisher.put(
            cdr.encode(command), attachment=attachment.pack(sequence, time.time_ns(), gid)
        )

    return publish


def send_goal(stand_in: StandIn, mover: Mover) -> None:
    """Announce the parts of an action client, and send a goal until it is answered."""
    impl = Fibonacci.Impl
    hidden = f"{mover.topic}/_action"
    gids = {}
    for part, kind in (
        ("send_goal", impl.SendGoalService),
        ("get_result", impl.GetResultService),
        ("cancel_goal", impl.CancelGoalService),
    ):
        token = stand_in.endpoint(EndpointKind.CLIENT, f"{hidden}/{part}", 10, kind)
        gids[part] = gid_of(token)
    request = impl.SendGoalService.Request(goal=Fibonacci.Goal(order=os.getpid()))
    request.goal_id.uuid = list(GOAL_ID)

    def ask(part: str, kind: Any, asked: Any, taken: Callable[[Any], None]) -> None:
        stand_in.session.get(
            stand_in.key(f"{hidden}/{part}", kind),
            taken,
            payload=cdr.encode(asked),
            attachment=attachment.pack(1, time.time_ns(), gids[part]),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=600.0,
        )

    answered = threading.Event()

    def take(_reply: zenoh.Reply) -> None:
        answered.set()
        result = impl.GetResultService.Request()
        result.goal_id.uuid = list(GOAL_ID)
        ask("get_result", impl.GetResultService, result, lambda _: None)

    def send() -> None:
        while not answered.wait(ASK_S):  # the server may not be known yet
            ask("send_goal", impl.SendGoalService, request, take)

    threading.Thread(target=send, daemon=True).start()


def obey(stand_in: StandIn, wheel: Wheel) -> None:
    """Obey messages."""
    report = stand_in.reporter.report

    def take(sample: zenoh.Sample) -> None:
        msg = cdr.decode(Twist, sample.payload.to_bytes())
        what: What = "stop" if msg.linear.x == 0.0 else "move"
        report.handed.append(
            Handed(wheel.topic, what, time.monotonic(), int(msg.angular.x), msg.linear.y)
        )

    stand_in.kept.append(
        stand_in.session.declare_subscriber(stand_in.key(wheel.topic, Twist), take)
    )
    stand_in.endpoint(EndpointKind.SUBSCRIPTION, wheel.topic, 10, Twist)
