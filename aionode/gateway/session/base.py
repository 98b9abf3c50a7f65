"""A session and the policy, which every part of a session asks before it touches the robot."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sized
from contextlib import AbstractContextManager, contextmanager
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol, TypeAlias

from aionode._process.concurrency import checkpoint, run_in_thread
from aionode.clock import S_TO_NS
from aionode.errors import InterfaceNotFoundError, MessageError, RefusedError
from aionode.gateway.session.encoding.client_json import is_large
from aionode.gateway.session.encoding.values import from_json
from aionode.gateway.session.outbox import Outbox
from aionode.gateway.session.refusals import Refusal
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS
from aionode.message import Message, fields
from aionode.names import is_hidden, validate_full_topic_name
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.gateway.policy.identity import Credentials, Identity
    from aionode.gateway.policy.policy import Decision, Verb
    from aionode.gateway.session.command import Owner
    from aionode.gateway.session.robot import Robot

__all__ = ["HAS_WAITED", "SessionBase", "as_message"]

CDR_HEADER: Final = 4

HAS_WAITED: Final = "it may have waited while the gateway stood still; send it again"

MOST_QUESTIONS: Final = 256
"""Questions about the graph that may wait, for each client."""


Kind: TypeAlias = Literal["topic", "service", "action"]
"""A kind of name."""


class Connection(Protocol):
    """The connection of a client, as its session uses it."""

    def silent_sec(self) -> float:
        """Return how long nothing has arrived, in seconds."""

    def has_unread(self) -> bool:
        """Return whether something of the client waits to be read."""

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Ask the client for a sign, and call `answered` with it."""

    def abort(self) -> None:
        """Close the connection at once."""


class SessionBase:
    """The base of a session, which asks the policy; see `Session`."""

    def __init__(
        self, robot: Robot, identity: Identity, kind: str, credentials: Credentials | None = None
    ) -> None:
        self.identity = identity
        self.kind = kind
        self.credentials = credentials
        self.ended = asyncio.Event()
        self.end_reason = ""
        self.owner: Owner = self
        self._robot = robot
        self._limits = robot.policy.limits
        self.outbox = Outbox(self._limits.queued_bytes)
        self.outbox.on_drop, self.outbox.on_overflow = self._note_slow, self._note_overflow
        self._topics_of: dict[Hashable, str] = {}  # by the keys of queues in the outbox
        self._coming: Counter[str] = Counter()
        self._turn = asyncio.Lock()
        self.refused = 0
        self.refused_cheaply = 0  # of these, commands that came too late, or on a topic in use
        self.connection: Connection | None = None
        self._frame_ns: int | None = None  # when the frame arrived that is handled
        self._doubts = self._trusted = 0  # how many there were, and how many are over
        self._doubted_ns = -1
        self._stood_still = 0  # which doubt the last standstill of the gateway was a reason for
        self._stood_still_ns = -1

    @property
    def way(self) -> str:
        """How the client is connected, for `Owner`."""
        return self.kind

    def end(self, reason: str) -> None:
        """End the session, and tell the client why."""
        self.end_reason = reason
        self.note(Refusal.DISCONNECTED, "connection", reason)
        self.ended.set()

    def note(self, kind: Refusal, subject: str, reason: str, count: int = 1) -> None:
        """Count and log what is refused, dropped or late of the client; see `Refusals.note`."""
        self._robot.refusals.note(self.identity, self.kind, kind, subject, reason, count)

    def note_failure(self, error: Exception, op: str = "") -> None:
        """Count and log that an op of the client has failed.

        Args:
            error: Why.
            op: The op, with what it is about as far as the error does not say it.
        """
        subject, reason = "", str(error) or "no answer in time"
        if isinstance(error, RefusedError):
            subject, reason = error.subject, f"refused: {error.reason}"
        elif isinstance(error, MessageError):
            subject, reason = error.path, error.problem
        self.note(Refusal.of(error), ": ".join(filter(None, (op, subject))), reason)

    def _note_slow(self, key: Hashable) -> None:
        topic = self._topics_of.get(key, str(key))
        self.note(Refusal.SLOW, topic, "messages are dropped: it reads more slowly than they come")

    def _note_overflow(self) -> None:
        self.note(Refusal.DISCONNECTED, "connection", "it does not read answers to what it asks")

    # The policy

    def decision(self, verb: Verb, name: str, type_name: str, message: Any = None) -> Decision:
        """Return the decision of the policy about the client; see `Policy.decide`.

        The audit log has what all clients send, so a pattern does not show it.
        """
        return self._robot.policy.decide(
            self.identity, verb, name, type_name, message, private=name == self._robot.audit.topic
        )

    def decide(self, verb: Verb, name: str, type_name: str, message: Any = None) -> Decision:
        """Return the decision of the policy; see `Policy.decide`.

        Raises:
            RefusedError: it does not; the refusal is in the audit log.
        """
        decision = self.decision(verb, name, type_name, message)
        if not decision.allowed:
            raise self._refused(verb, name, decision.reason, decision.code, message)
        return decision

    def _refused(
        self, verb: str, name: str, reason: str, code: str, message: Any = None
    ) -> RefusedError:
        """Return the error of a refusal, and write the refusal down."""
        self.refused += 1
        self.refused_cheaply += code in {"held", "too_old"}
        self._robot.audit.note(
            self.identity, verb, name, arguments=message, result=f"refused: {reason}",
            code=code, way=self.kind,
        )  # fmt: skip
        return RefusedError(f"{verb} {name}", reason, code)

    async def _allow(self, verb: Verb, name: str, type_name: str, message: Any) -> Decision:
        """Return the decision of the policy, within its rate, and after a person has said yes.

        Raises:
            RefusedError: it is not allowed.
        """
        decision = self.decide(verb, name, type_name, message)
        rule = decision.rule
        if rule is not None and not self._robot.rates.allows(self.identity, rule, name):
            raise self._refused(
                verb, name, f"more often than {rule.rate_hz:g} times a second", "too_fast", message
            )
        if decision.ask:
            await self._ask(verb, name, decision.message)
            # A person takes a while, in which the policy may have changed.
            decision = self.decide(verb, name, type_name, message)
        return decision

    async def _ask(self, verb: Verb, name: str, message: Any) -> None:
        ask = self._robot.ask
        if ask is None:
            raise self._refused(
                verb, name, "a person has to say yes, and nobody is there to ask",
                "not_confirmed", message,
            )  # fmt: skip
        if not await ask(self.identity, verb, name, message):
            raise self._refused(verb, name, "a person has said no", "not_confirmed", message)

    def _sees(self, name: str, type_names: list[str]) -> bool:
        return any(self.decision("see", name, kind).allowed for kind in type_names or [""])

    @contextmanager
    def _one_more(self, verb: str, name: str, what: str, held: Sized, most: int) -> Iterator[None]:
        """Count one more of what a client may have so many of, while the block makes it.

        Those that are being made count, too: several at once would each find the last place.

        Args:
            verb: What the client does.
            name: With what.
            what: What there may be so many of.
            held: Those that are made.
            most: How many there may be.

        Raises:
            RefusedError: there are as many.
        """
        there_are = len(held) + self._coming[what]
        if there_are >= most:
            reason = f"the client has {there_are} {what}, which is the limit"
            raise self._refused(verb, name, reason, "too_many")
        self._coming[what] += 1
        try:
            yield
        finally:
            self._coming[what] -= 1

    def _one_call(self, verb: str, name: str) -> AbstractContextManager[None]:
        """Count one more call, goal, or question to a node, while the block lasts."""
        what = "calls, goals and questions under way"
        return self._one_more(verb, name, what, (), self._limits.calls)

    def _check_size(self, verb: Verb, name: str, decision: Decision, message: Message) -> None:
        most = None if decision.rule is None else decision.rule.max_bytes
        if most is None:
            return
        from aionode.engine.wire import cdr  # few rules limit the size

        if len(cdr.encode(message)) > most:
            raise self._refused(verb, name, f"it has more than {most} bytes", "too_large")

    def _decide_parameter(self, node: str, parameter: Parameter) -> Parameter:
        """Return a parameter that the client may set, within its limits.

        Raises:
            RefusedError: it may not.
        """
        name = f"{node}:{parameter.name}"
        decision = self.decide("parameter", name, "", {"value": parameter.value})
        changed = decision.message["value"]
        return parameter if changed == parameter.value else Parameter(parameter.name, value=changed)

    def _check_seen(self, node: str, names: Iterable[str]) -> None:
        """Refuse to tell anything of parameters that the client may not see.

        Raises:
            RefusedError: it may not see one of them.
        """
        for name in names:
            if not self._sees(f"{node}:{name}", []):
                raise self._refused(
                    "see", f"{node}:{name}", "the policy does not show it", "not_allowed"
                )

    def node_name(self, node: str) -> str:
        """Return the full name of a node, by which the policy knows it.

        Raises:
            InvalidTopicNameException: it is no full name (a ValueError).
            RefusedError: the gateway's node would ask another node instead.
        """
        service = f"{node}/set_parameters"
        validate_full_topic_name(service)
        if self._robot.node.resolve_service_name(service) != service:
            raise RefusedError(node, "the gateway's node remaps its services")
        return node

    async def turn(self) -> None:
        """Wait for a turn of the loop in which no client of the gateway asks anything else.

        Questions about the graph walk through it, for which they hold up the loop: those of a burst
        come one by one, the clients in turn, and the callbacks of the robot between them.

        Raises:
            RefusedError: too many questions of the client wait.
        """
        with self._one_more("ask", "the graph", "questions", (), MOST_QUESTIONS):
            async with self._turn, self._robot.turn:
                await checkpoint()

    def _visible(self, named: Any, *, hidden: bool) -> dict[str, list[str]]:
        return {
            name: types
            for name, types in named
            if (hidden or not is_hidden(name)) and self._sees(name, types)
        }

    @property
    def is_doubtful(self) -> bool:
        """Whether commands may be from before a silence, as a ping is not answered yet."""
        return self._trusted < self._doubts

    def doubt(self, *, stood_still: bool = False) -> None:
        """Refuse commands until the client has answered a ping, which is sent now.

        It was silent for too long, or the gateway has not read what it has sent. What was on its
        way meanwhile was sent before that answer.

        Args:
            stood_still: Whether the gateway stood still for long. Then calls, goals and parameters
                are refused as well: nobody expects them any more.
        """
        if self.connection is not None:
            self._doubts += 1
            self._doubted_ns = self._robot.time_base.steady_ns() - 1
            if stood_still:
                self._stood_still, self._stood_still_ns = self._doubts, self._doubted_ns
            self.ask_for_sign()

    def ask_for_sign(self) -> None:
        """Send a ping; if the session is doubtful, its answer ends the doubt."""
        if self.connection is not None:
            answered = partial(self._trust, self._doubts) if self.is_doubtful else None
            self.connection.ping(answered)

    def note_frame(self) -> None:
        """Begin to handle a frame that arrived with the client's latest bytes."""
        if self.connection is not None:
            self._robot.standstills.look()
            self.note_arrival(self.connection.silent_sec())
            # What waits in a lane is handled when the doubt is over, perhaps.
            if self.is_doubtful:
                self._doubted_ns = max(self._doubted_ns, self.arrival_ns())
            if self._trusted < self._stood_still:
                self._stood_still_ns = max(self._stood_still_ns, self.arrival_ns())

    def note_arrival(self, age_sec: float) -> None:
        """Begin to handle something that arrived some seconds ago."""
        self._frame_ns = self.steady_ns() - round(age_sec * S_TO_NS)

    def arrival_ns(self) -> int:
        """Return when that arrived which is handled, in nanoseconds of the steady clock."""
        return self.steady_ns() if self._frame_ns is None else self._frame_ns

    def _trust(self, doubt: int) -> None:
        """End a doubt and those before it; the ping for a later one is not answered yet."""
        self._trusted = max(self._trusted, doubt)

    def _check_waited(self, verb: Verb, name: str, arrived_ns: int) -> None:
        """Refuse a call, a goal or a parameter that may have waited while the gateway stood still.

        Args:
            verb: What the client does.
            name: With what.
            arrived_ns: When its frame or request arrived, in nanoseconds of the steady clock.

        Raises:
            RefusedError: it may have waited; its code is ``too_old``.
        """
        standstills = self._robot.standstills
        standstills.look()  # this may be the first that happens after one
        if self.connection is None:
            has_waited = arrived_ns <= standstills.long_until_ns
        else:
            has_waited = self._trusted < self._stood_still or arrived_ns <= self._stood_still_ns
        if has_waited:
            raise self._refused(verb, name, HAS_WAITED, "too_old")

    # Types and names

    async def message_class(self, type_name: str) -> Any:
        """Return the class of a message type: of this program, or as a node describes it.

        Raises:
            InterfaceNotFoundError: nobody knows it.
        """
        return await self._robot.find_type(type_name, "msg")

    async def service_class(self, type_name: str) -> Any:
        """Return the class of a service type; see `message_class`."""
        return await self._robot.find_type(type_name, "srv")

    async def action_class(self, type_name: str) -> Any:
        """Return the class of an action type; see `message_class`."""
        return await self._robot.find_type(type_name, "action")

    async def message_of(
        self, cls: Any, values: Message | Mapping[str, Any] | list[Any] | bytes
    ) -> Any:
        """Return a message of a class; see `as_message`.

        A large one is made in a thread, one at a time, as that takes up to a second. It may not
        take more room than a frame of a client: in JSON, a large message is soon written.
        """
        clock = self._robot.node.get_clock()
        if isinstance(values, Message) or not is_large(values):
            return as_message(cls, values, clock)
        async with self._robot.making:
            return await run_in_thread(large_message, cls, values, clock, self._limits.frame_bytes)

    def now_ns(self) -> int:
        """Return the time of the node's clock, which may be simulated, in nanoseconds."""
        return self._robot.node.get_clock().now().nanoseconds

    def topic_name(self, name: str) -> str:
        """Return the full name of a topic or action, as the node resolves it.

        Raises:
            InvalidTopicNameException: it is invalid (a ValueError).
        """
        return self._settled(self._robot.node.resolve_topic_name, name)

    def service_name(self, name: str) -> str:
        """Return the full name of a service, as the node resolves it.

        Raises:
            InvalidServiceNameException: it is invalid (a ValueError).
        """
        return self._settled(self._robot.node.resolve_service_name, name)

    def _settled(self, resolve: Callable[[str], str], name: str) -> str:
        """Return the name that an endpoint gets, about which the policy is asked."""
        full = resolve(name)
        if resolve(full) != full:  # two remap rules, one after the other
            raise RefusedError(name, f"the gateway's node remaps {full} once more")
        return full

    def type_of(self, name: str, kind: Kind) -> str:
        """Return the type that the graph shows of a full name.

        Raises:
            InterfaceNotFoundError: no node has it.
        """
        for type_name in self._types_of(name, kind):
            return type_name
        raise InterfaceNotFoundError(name, problem=f"no node has this {kind}; give its type")

    def types_of(self, name: str, kind: Kind) -> list[str]:
        """Return the types of a full name; none if no node has it, or the client may not see it."""
        types = list(self._types_of(name, kind))
        return types if types and self._sees(name, types) else []

    def sees(self, name: str, type_name: str) -> bool:
        """Return whether the client sees a name; without a type, those of the topic count."""
        types = [type_name] if type_name else list(self._types_of(name, "topic"))
        return self._sees(name, types)

    def _types_of(self, name: str, kind: Kind) -> dict[str, None]:
        place, suffix = name, ""
        if kind == "action":
            place, suffix = f"{name}/_action/feedback", "_FeedbackMessage"
        kinds = SERVICE_KINDS if kind == "service" else TOPIC_KINDS
        endpoints = self._robot.node.graph.endpoints(*kinds, name=place)
        return {endpoint.type_name.removesuffix(suffix): None for endpoint in endpoints}

    def steady_ns(self) -> int:
        """Return the time of the steady clock in nanoseconds, for `arrived_ns` of `publish`."""
        return self._robot.time_base.steady_ns()


def as_message(
    cls: Any, values: Message | Mapping[str, Any] | list[Any] | bytes, clock: Clock
) -> Any:
    """Return a message of a class: as it is, or of its values as clients write them, or bytes.

    Args:
        cls: The class.
        values: The message, its values by name or in order (see `from_json`), or its CDR bytes.
        clock: Gives the time of stamps that the client leaves to the robot.

    Raises:
        MessageError: a value does not fit its field.
        DecodeError: the bytes are no such message.
    """
    if isinstance(values, Message):
        return values
    if isinstance(values, bytes | bytearray | memoryview):
        from aionode.engine.wire import cdr  # few clients send bytes

        return cdr.decode(cls, values)
    return from_json(cls, values, clock.now().nanoseconds)


def least_bytes(cls: Any, values: object) -> int:
    """Return how many bytes the messages in the lists of a message take at least, if empty."""
    if isinstance(values, list):
        values = dict(zip((field.name for field in fields(cls)), values, strict=False))
    if not isinstance(values, Mapping):
        return 0
    total = 0
    for field in fields(cls):
        nested, inner = field.type.nested, values.get(field.name)
        if nested is None or not inner:
            continue
        if field.type.container == "single":
            total += least_bytes(nested, inner)
        elif isinstance(inner, list):
            total += len(inner) * empty_bytes(nested)
            total += sum(least_bytes(nested, item) for item in inner if item)
    return total


@cache
def empty_bytes(cls: Any) -> int:
    """Return the size of an empty message, in bytes of CDR."""
    from aionode.engine.wire import cdr  # few clients send large messages

    return len(cdr.encode(cls())) - CDR_HEADER


def large_message(cls: Any, values: Any, clock: Clock, most_bytes: int) -> Any:
    """Return a message; see `as_message`. It is called in a thread.

    Raises:
        MessageError: it takes more than `most_bytes`.
    """
    from aionode.engine.wire import cdr  # few clients send large messages

    least = least_bytes(cls, values)
    if least > most_bytes:  # the empty messages alone would take the memory
        raise MessageError(cls.__ros_type__, f"takes {least} bytes, at most {most_bytes} fit")
    message = as_message(cls, values, clock)
    size = len(cdr.encode(message))
    if size > most_bytes:
        raise MessageError(cls.__ros_type__, f"takes {size} bytes, at most {most_bytes} fit")
    return message
