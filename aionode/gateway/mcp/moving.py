"""The tools that change something: commands, goals, calls and parameters; and the stop.

Every motion ends with its call. The end of a call ends its session, which sends the stops of leases
and cancels goals; a call ends when it is cancelled, when its client disconnects, when somebody
calls `stop`, and at the latest after the time that the policy allows.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Any, Final

from msgspec import Meta, field

from aionode.errors import RefusedError, ToolError
from aionode.gateway._stopping import cancelled
from aionode.gateway.mcp.answers import answer
from aionode.gateway.mcp.arguments import Arguments, Nothing
from aionode.gateway.mcp.names import topic_of
from aionode.message import summarize

if TYPE_CHECKING:
    import mcp_types as types

    from aionode.gateway.mcp.call import Call
    from aionode.gateway.policy.policy import Decision, LeaseRule
    from aionode.gateway.session.command import Holder
    from aionode.gateway.session.motions import Motion
    from aionode.gateway.session.session import Session

__all__ = ["CallService", "Do", "Move", "Publish", "SetParameter", "call_service", "do"]
__all__ += ["move", "publish", "run_goal", "run_service", "set_parameter", "stop"]

RATE_HZ: Final = 20.0
"""How often a command is repeated, in hertz, if its rule and lease allow that."""

LISTENERS_SEC: Final = 1.0
"""How long to wait until the subscriptions of a topic are matched, in seconds."""

LONG: Final = 4000


# Topics

TopicName = Annotated[str, Meta(description="The full name of the topic.")]
Values = Annotated[
    dict[str, Any],
    Meta(description='The fields by name, such as {"linear": {"x": 0.2}}; others are zero.'),
]


class Publish(Arguments, frozen=True):
    """The arguments of `publish`."""

    topic: TopicName
    message: Values = field(default_factory=dict)


async def publish(call: Call, given: Publish) -> types.CallToolResult:
    """Publish one message; topics that carry commands have `move`."""
    session = call.session
    topic, type_name, decision = decided(session, given.topic)
    if decision.lease is not None:
        raise RefusedError(
            f"publish {topic}",
            "it carries commands, which the robot would follow without end; use the tool "
            "`move`, which stops the robot at the end",
        )
    await session.advertise(topic, type_name)
    listeners = await listening(call, topic)
    await session.publish(topic, given.message, type_name)
    return answer({"topic": topic, "type": type_name, "published": 1, "subscribers": listeners})


def decided(session: Session, name: str) -> tuple[str, str, Decision]:
    """Return the full name of a topic, its type, and the rule by which the client publishes.

    Raises:
        ToolError: there is no such topic.
        RefusedError: the policy does not allow it.
    """
    topic = session.topic_name(name)
    session.rights.decide("publish", topic, "")
    topic = topic_of(session, name)
    type_name = session.graph.type_of(topic, "topic")
    return topic, type_name, session.rights.decide("publish", topic, type_name)


async def listening(call: Call, topic: str) -> int:
    """Wait until the subscriptions of a topic are matched, and return their number."""
    publisher = call.session.publisher(topic)
    with suppress(TimeoutError):
        async with asyncio.timeout(LISTENERS_SEC):
            await publisher.wait_for_subscribers()
    return int(publisher.get_subscription_count())


class Move(Arguments, frozen=True):
    """The arguments of `move`."""

    topic: TopicName
    message: Values
    seconds: Annotated[
        float, Meta(gt=0, description="For how long; the robot is stopped afterwards.")
    ]


async def move(call: Call, given: Move) -> types.CallToolResult:
    """Repeat a command for some seconds, then send the stop, however the call ends."""
    session = call.session
    topic, type_name, decision = decided(session, given.topic)
    if decision.lease is None or decision.rule is None:
        raise RefusedError(
            f"move {topic}",
            "its rule in the policy has no lease, which defines how the motion stops; "
            "publish one message with the tool `publish`, or ask for a `lease` in the rule",
        )
    check_seconds(given.seconds, session.rights.limits.move_sec, "move_sec")
    await session.advertise(topic, type_name)
    # Before the time counts: check the values, ask the person, and wait for subscriptions.
    publisher = session.publisher(topic)
    message = await session.message_of(publisher.msg_type, given.message)
    await session.rights.confirm("publish", topic, type_name, message)
    listeners = await listening(call, topic)
    mover = Mover(call, topic, type_name, given)
    with call.moving("publish", topic, type_name) as motion:
        await mover.run(motion, period_of(decision.lease, decision.rule.rate_hz))
        lasted = motion.seconds()
        await session.unadvertise(topic)  # sends the stop
    call.outcome = motion.outcome(mover.how(motion))
    return answer(
        {
            "outcome": call.outcome,
            "topic": topic,
            "seconds": round(lasted, 3),
            "commands": mover.sent,
            "subscribers": listeners,
            "stop_sent": True,
        },
        is_error=mover.problem is not None,
    )


class Mover:
    """Repeats the command of one call.

    Attributes:
        sent: How many were sent.
        problem: Why it ended before its time; None if it did not, or by `stop`.
    """

    def __init__(self, call: Call, topic: str, type_name: str, given: Move) -> None:
        self.sent = 0
        self.problem: str | None = None
        self._call = call
        self._topic = topic
        self._type_name = type_name
        self._given = given
        self._commands = call.clients.robot.commands

    async def run(self, motion: Motion, period_sec: float) -> None:
        """Send commands until the time is over, the motion is ended, or the topic is lost.

        Raises:
            RefusedError: the first command is refused.
        """
        session, given = self._call.session, self._given
        session.arrivals.check_waited("publish", self._topic, session.arrivals.arrival_ns())
        holder: Holder | None = None
        try:
            async with motion.running(given.seconds):
                while motion.seconds() < given.seconds:
                    if holder is not None and self._commands.holder(self._topic) is not holder:
                        # The stop was sent, and no command may follow it.
                        self.problem = self._lost()
                        break
                    await session.publish(
                        self._topic,
                        given.message,
                        self._type_name,
                        arrived_ns=session.arrivals.fresh_ns(),
                    )
                    holder = holder or self._commands.holder(self._topic)
                    self.sent += 1
                    await self._call.report(
                        motion.seconds(), given.seconds, f"moving {self._topic}"
                    )
                    await self._call.sleep(period_sec)
        except RefusedError as error:
            if not self.sent:
                raise
            self.problem = self._lost() if error.code == "too_old" else error.reason

    def _lost(self) -> str:
        """Return why the topic is no longer commanded."""
        holder = self._commands.holder(self._topic)
        if holder is not None:
            return f"{holder.identity.name} commands {self._topic} now"
        return "this computer was too busy, and the robot was stopped; try again"

    def how(self, motion: Motion) -> str:
        """Return how the motion ended, in words."""
        if motion.stopped_by:
            self.problem = None
            return f"by {motion.stopped_by}"
        return self.problem or "done"


def check_seconds(seconds: float, max_sec: float, limit: str) -> None:
    """Refuse a time longer than the policy allows.

    Raises:
        RefusedError: it is too long; the code is ``out_of_limits``.
    """
    if seconds > max_sec:
        raise RefusedError(
            "seconds",
            f"{seconds:g} s, at most {max_sec:g} s are allowed by {limit} of the policy; move in "
            "several steps, and look in between",
            "out_of_limits",
        )


def period_of(lease: LeaseRule, rate_hz: float) -> float:
    """Return the time between two commands, in seconds.

    Raises:
        RefusedError: the rule does not allow as many as its lease needs.
    """
    period_sec = max(min(1 / RATE_HZ, lease.ttl_sec / 4), 1.1 / rate_hz)
    if period_sec > lease.ttl_sec / 2:
        raise RefusedError(
            "move",
            f"the rule allows {rate_hz:g} commands a second, but its lease of "
            f"{lease.ttl_sec:g} s needs more; ask for another rate_hz or ttl_sec in "
            "the policy",
        )
    return period_sec


# Services

Seconds = Annotated[float, Meta(gt=0, description="How long it may take at most.")]


class CallService(Arguments, frozen=True):
    """The arguments of `call_service`."""

    service: Annotated[str, Meta(description="The full name of the service.")]
    request: Annotated[dict[str, Any], Meta(description="The fields of the request by name.")] = (
        field(default_factory=dict)
    )


async def call_service(call: Call, given: CallService) -> types.CallToolResult:
    """Call a service by its name."""
    return await run_service(call, given.service, given.request)


async def run_service(call: Call, service: str, request: Any) -> types.CallToolResult:
    """Call a service, and return its response."""
    response = await call.session.call(service, request, timeout_sec=call.session.wait_sec(None))
    return answer({"service": service, "response": summarize(response, LONG)})


# Actions


class Do(Arguments, frozen=True):
    """The arguments of `do`."""

    action: Annotated[str, Meta(description="The full name of the action.")]
    goal: Annotated[dict[str, Any], Meta(description="The fields of the goal by name.")] = field(
        default_factory=dict
    )
    seconds: Seconds | None = None


async def do(call: Call, given: Do) -> types.CallToolResult:
    """Send a goal to an action by its name."""
    return await run_goal(call, given.action, given.goal, given.seconds)


async def run_goal(
    call: Call, action: str, goal: Any, seconds: float | None
) -> types.CallToolResult:
    """Send a goal, wait for its end, and report progress meanwhile."""
    session = call.session
    max_sec = session.rights.limits.goal_sec
    seconds = max_sec if seconds is None else seconds
    check_seconds(seconds, max_sec, "goal_sec")
    action = session.topic_name(action)
    session.rights.decide("goal", action, "")
    type_name = session.graph.type_of(action, "action")
    feedback: Any = None
    result: Any = None
    with call.moving("goal", action, type_name) as motion:
        async with session.goal(action, goal, type_name=type_name) as handle:
            async with motion.running(seconds):
                async for feedback in handle:
                    far = str(summarize(feedback, 300).get("value"))
                    await call.report(motion.seconds(), seconds, far)
                result = await handle.result()
            if result is None:
                result = await cancelled(handle)
    values, is_error = ended(call, motion, action, feedback, result)
    return answer(values, is_error=is_error)


def ended(
    call: Call, motion: Motion, action: str, feedback: Any, result: Any
) -> tuple[dict[str, Any], bool]:
    """Return the answer about a goal that was given up or has ended, and whether it has failed."""
    status = "unknown" if result is None else result.status.name.lower()
    how = f"by {motion.stopped_by}" if motion.stopped_by else "expired"
    if not motion.was_cut:
        how = "done" if status == "succeeded" else status
    elif status == "unknown":
        how = f"{how}; the goal goes on: its server has not ended it"
    call.outcome = motion.outcome(how)
    values: dict[str, Any] = {
        "outcome": call.outcome,
        "action": action,
        "status": status,
        "seconds": round(motion.seconds(), 3),
    }
    if result is not None:
        values["result"] = summarize(result.result, LONG)
        if result.error_text:
            values["error"] = result.error_text
    if feedback is not None:
        values["last_feedback"] = summarize(feedback, LONG // 4)
    return values, status != "succeeded"


# Parameters


class SetParameter(Arguments, frozen=True):
    """The arguments of `set_parameter`."""

    node: Annotated[str, Meta(description="The full name of the node.")]
    name: Annotated[str, Meta(description="The name of the parameter.")]
    value: Annotated[
        bool | int | float | str | list[Any],
        Meta(description="The value, of the same type as now."),
    ]


async def set_parameter(call: Call, given: SetParameter) -> types.CallToolResult:
    """Set a parameter of a node."""
    result = await call.session.parameters.set_json(given.node, given.name, given.value)
    if not result.successful:
        reason = result.reason or "the node refused it without a reason"
        raise ToolError(f"{given.node}:{given.name}", reason)
    return answer({"node": given.node, "name": given.name, "value": given.value})


# The stop


async def stop(call: Call, _given: Nothing) -> types.CallToolResult:
    """End the client's own motion, and the motion of others as far as the policy allows."""
    stopped = await call.clients.stopping.everywhere(call.session.rights)
    ended = sorted(f"{name} ({who})" for name, who in stopped.ended)
    # What is unknown comes first: a long list is cut short.
    in_order = sorted(stopped.moving, key=lambda each: (each.name != "unknown", each))
    moving = [{"name": name, "who": who} for name, who in in_order]
    call.outcome = f"ended {len(ended)}, {len(moving)} go on"
    return answer({"ended": ended, "still_moving": moving})
