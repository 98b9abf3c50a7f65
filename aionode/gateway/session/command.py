"""Commands of remote clients: one holder of a topic at a time, and a stop when it is gone."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Protocol

from aionode.clock import S_TO_NS
from aionode.errors import AionodeError, LeaseExpiredError, RefusedError
from aionode.message import Message, from_builtins, to_builtins, type_name

if TYPE_CHECKING:
    from aionode.clock import TimeBase
    from aionode.endpoints.lease import CommandLease
    from aionode.endpoints.publisher import Publisher
    from aionode.gateway.policy.identity import Identity
    from aionode.gateway.policy.policy import LeaseRule

__all__ = ["Commands", "Holder", "Owner", "check_age"]


class Owner(Protocol):
    """The owner of commands: a session, or an object shared by several requests of one client."""

    @property
    def way(self) -> str:
        """How it is connected, for refusals of others that try to command the same topic."""

    def doubt(self) -> None:
        """Handle a client that was silent for the time to live."""


class Holder:
    """A client that commands a topic, from its first command until its lease ends.

    Attributes:
        owner: The session of the client, or something that its requests share.
        identity: Who it is.
        rule: How it publishes.
        type_name: The name of the topic's type.
    """

    def __init__(self, owner: Owner, identity: Identity, rule: LeaseRule, type_name: str) -> None:
        self.owner = owner
        self.identity = identity
        self.rule = rule
        self.type_name = type_name
        self.lease: CommandLease[Any] | None = None
        self.entered: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.leaving = asyncio.Event()
        self.ended = asyncio.Event()


class Commands:
    """The holders of all command topics of a gateway.

    A lease begins with a client's first command. It ends when the client is silent for the time to
    live, leaves, or loses the topic to a client of higher priority; then its stop is sent. Apart
    from the stop, nothing is ever published that no client has sent.

    Args:
        tasks: Run the blocks of the leases.
    """

    def __init__(self, tasks: asyncio.TaskGroup) -> None:
        self._tasks = tasks
        self._holders: dict[str, Holder] = {}

    def holder(self, topic: str) -> Holder | None:
        """Return the client that commands a topic now."""
        return self._holders.get(topic)

    def holders(self) -> dict[str, Holder]:
        """Return the holder of each commanded topic."""
        return dict(self._holders)

    def refuse_if_held(self, topic: str, owner: object) -> None:
        """Refuse to publish on a topic that another client commands.

        Raises:
            RefusedError: another client commands it; the code is ``held``.
        """
        holder = self._holders.get(topic)
        if holder is not None and holder.owner != owner:
            raise held(topic, holder)

    async def publish(
        self,
        publisher: Publisher[Any],
        owner: Owner,
        identity: Identity,
        rule: LeaseRule,
        message: Any,
    ) -> None:
        """Publish a command of a client, which holds the topic from now on.

        Raises:
            RefusedError: another client of at least that priority holds the topic (``held``), or
                the client was silent for the time to live and the stop was just sent (``too_old``);
                or the policy does not say how this type stops (``not_allowed``).
            AionodeError: what `Publisher.publish` and `Publisher.lease` raise.
        """
        topic = publisher.topic_name
        holder = self._holders.get(topic)
        if holder is not None and (holder.owner != owner or holder.rule != rule):
            if holder.owner != owner and rule.priority <= holder.rule.priority:
                raise held(topic, holder)
            # of a client of lower priority, or of a policy that has changed
            await self._end(holder)
            self.refuse_if_held(topic, owner)
            holder = self._holders.get(topic)
        if holder is None:
            refuse_without_stop(topic, publisher.msg_type, rule)
            holder = Holder(owner, identity, rule, type_name(publisher.msg_type))
            self._holders[topic] = holder
            self._tasks.create_task(self._hold(topic, publisher, holder))
        await asyncio.shield(holder.entered)
        try:
            if holder.lease is not None:
                holder.lease.publish(message)
        except LeaseExpiredError as error:
            raise RefusedError(
                f"publish {topic}",
                f"no command arrived for {holder.rule.ttl_sec:g} s, so the stop was sent; "
                "send commands more often",
                "too_old",
            ) from error

    async def _hold(self, topic: str, publisher: Publisher[Any], holder: Holder) -> None:
        """Hold a lease until its holder leaves, or is silent for too long."""
        rule = holder.rule
        try:
            stop = from_builtins(publisher.msg_type, rule.stop)
            async with publisher.lease(stop=stop, ttl_sec=rule.ttl_sec) as lease:
                holder.lease = lease
                if not holder.entered.done():
                    holder.entered.set_result(None)
                await holder.leaving.wait()
        except LeaseExpiredError:
            holder.owner.doubt()  # it was silent: the stop was sent
        except AionodeError as error:
            if not holder.entered.done():
                holder.entered.set_exception(error)
                holder.entered.exception()  # retrieved, since the client may be gone
        finally:
            if self._holders.get(topic) is holder:
                del self._holders[topic]
            if not holder.entered.done():
                holder.entered.cancel()
            holder.ended.set()

    async def _end(self, holder: Holder) -> None:
        """End a lease, and wait until its stop was sent."""
        holder.leaving.set()
        await holder.ended.wait()

    async def leave(self, owner: object, topic: str | None = None) -> None:
        """End the leases of a client: all of them, or that of one topic."""
        for name, holder in list(self._holders.items()):
            if holder.owner == owner and topic in {None, name}:
                await self._end(holder)

    async def close(self) -> None:
        """End all leases, and wait until their stops were sent."""
        for holder in list(self._holders.values()):
            await self._end(holder)


def refuse_without_stop(topic: str, msg_type: type[Message], rule: LeaseRule) -> None:
    """Refuse a lease whose stop would be a default message that may move the robot.

    A definition may give its fields their own defaults, such as a speed; and a pose at the origin
    is no stop at all.

    Raises:
        RefusedError: the default message is not all zeros, and the rule gives no stop.
    """
    if rule.stop or (moving := moving_field(to_builtins(msg_type()))) is None:
        return
    raise RefusedError(
        f"publish {topic}",
        "the policy does not define its stop, and the default message of "
        f"{type_name(msg_type)} has {moving}; give the rule's lease a stop",
        "not_allowed",
    )


def moving_field(value: Any, path: str = "") -> str | None:
    """Return the first number in a message that is not zero, with its path, or None."""
    if isinstance(value, dict):
        parts = ((f"{path}.{name}".lstrip("."), part) for name, part in value.items())
    elif isinstance(value, list):
        parts = ((f"{path}[{index}]", part) for index, part in enumerate(value))
    else:
        return f"{path}={value}" if isinstance(value, int | float) and value else None
    return next(filter(None, (moving_field(part, name) for name, part in parts)), None)


def held(topic: str, holder: Holder) -> RefusedError:
    """Return the error for a topic that another client commands."""
    who, where = holder.identity.name, holder.identity.address
    source = f"by {holder.owner.way}" + (f" from {where}" if where else "")
    return RefusedError(f"publish {topic}", f"{who} commands it now, {source}; try again later",
                        "held")  # fmt: skip


def check_age(
    topic: str, message: Any, rule: LeaseRule, *, now_ns: int, arrived_ns: int, time_base: TimeBase
) -> None:
    """Refuse a command that was in transit for too long.

    Args:
        topic: The topic.
        message: The command; its ``header.stamp`` counts if it is not zero.
        rule: How commands are published.
        now_ns: The time of the node's clock, in nanoseconds.
        arrived_ns: When the frame arrived, in nanoseconds of the steady clock.
        time_base: Shows the steady clock.

    Raises:
        RefusedError: the command is older than the rule allows; the code is ``too_old``.
    """
    ages = [(time_base.steady_ns() - arrived_ns) / S_TO_NS]
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    if isinstance(message, Message) and stamp is not None:
        with suppress(AttributeError):
            stamp_ns = stamp.sec * S_TO_NS + stamp.nanosec
            if stamp_ns:  # a stamp in the future is just as meaningless
                ages.append(abs(now_ns - stamp_ns) / S_TO_NS)
    if max(ages) > rule.max_age_sec:
        raise RefusedError(
            f"publish {topic}",
            f"it is {max(ages):.3f} s old, at most {rule.max_age_sec:g} s are allowed; "
            "check the clock of the client",
            "too_old",
        )
