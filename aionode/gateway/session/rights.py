"""The rights of a client: every part of its session checks here before it touches the robot."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sized
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Any

from aionode.errors import MessageError, RefusedError
from aionode.gateway.session.refusals import Refusal
from aionode.names import is_hidden
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.gateway.policy.policy import Decision, Limits, Rule, Verb
    from aionode.gateway.session.robot import Ask, Robot
    from aionode.message import Message

__all__ = ["Rights"]


class Rights:
    """Asks the policy about one client, and records refusals.

    Args:
        robot: The robot, which has the policy, the audit log, and the counts of refusals.
        identity: Who the client is.
        kind: The protocol, for the audit log.

    Attributes:
        identity: Who the client is; a new policy may give it another name.
        kind: The protocol.
        ask: Asks a person about the client; None to use the gateway's way.
        refused: Number of times the client was refused something.
        refused_cheaply: How many of these were commands that came too late, or on a topic in use.
    """

    def __init__(self, robot: Robot, identity: Identity, kind: str) -> None:
        self.identity = identity
        self.kind = kind
        self.refused = 0
        self.refused_cheaply = 0
        self.ask: Ask | None = None
        self._robot = robot
        self._coming: Counter[str] = Counter()

    @property
    def limits(self) -> Limits:
        """The limits in the current policy."""
        return self._robot.policy.limits

    @property
    def rules(self) -> list[Rule]:
        """The allowing rules that apply to the client."""
        return [rule for rule in self._robot.policy.allow if rule.is_about(self.identity)]

    def note(self, kind: Refusal, subject: str, reason: str, count: int = 1) -> None:
        """Count and log what is refused, dropped or late for the client; see `Refusals.note`."""
        self._robot.refusals.note(self.identity, self.kind, kind, subject, reason, count)

    def note_failure(self, error: Exception, op: str = "") -> None:
        """Count and log that an op of the client has failed.

        Args:
            error: Why.
            op: The op, with its subject unless the error names that.
        """
        subject, reason = "", str(error) or "no answer in time"
        if isinstance(error, RefusedError):
            subject, reason = error.subject, f"refused: {error.reason}"
        elif isinstance(error, MessageError):
            subject, reason = error.path, error.problem
        self.note(Refusal.of(error), ": ".join(filter(None, (op, subject))), reason)

    def decision(self, verb: Verb, name: str, type_name: str, message: Any = None) -> Decision:
        """Return the decision of the policy about the client; see `Policy.decide`.

        The audit log contains what all clients send, so a pattern does not make it visible.
        """
        return self._robot.policy.decide(
            self.identity, verb, name, type_name, message, private=name == self._robot.audit.topic
        )

    def decide(self, verb: Verb, name: str, type_name: str, message: Any = None) -> Decision:
        """Return the decision of the policy; see `Policy.decide`.

        Raises:
            RefusedError: the policy refuses it; the refusal is in the audit log.
        """
        decision = self.decision(verb, name, type_name, message)
        if not decision.allowed:
            raise self.refusal(verb, name, decision.reason, decision.code, message)
        return decision

    def refusal(
        self, verb: str, name: str, reason: str, code: str, message: Any = None
    ) -> RefusedError:
        """Return the error for a refusal, and record the refusal."""
        self.refused += 1
        self.refused_cheaply += code in {"held", "too_old"}
        self._robot.audit.note(
            self.identity, verb, name, arguments=message, result=f"refused: {reason}",
            code=code, way=self.kind,
        )  # fmt: skip
        return RefusedError(f"{verb} {name}", reason, code)

    async def allow(self, verb: Verb, name: str, type_name: str, message: Any) -> Decision:
        """Return the decision of the policy, checking the rate, and asking a person if required.

        Raises:
            RefusedError: it is not allowed.
        """
        decision = self.decide(verb, name, type_name, message)
        rule = decision.rule
        if rule is not None and not self._robot.rates.allows(self.identity, rule, name):
            raise self.refusal(
                verb, name, f"more often than {rule.rate_hz:g} times a second", "too_fast", message
            )
        if decision.ask:
            await self._ask(verb, name, decision.message)
            # Asking a person takes a while, during which the policy may have changed.
            decision = self.decide(verb, name, type_name, message)
        return decision

    async def confirm(self, verb: Verb, name: str, type_name: str, message: Any) -> None:
        """Ask a person now, if the policy requires it.

        Raises:
            RefusedError: the policy does not allow it, or no person has approved.
        """
        decision = self.decide(verb, name, type_name, message)
        if decision.ask:
            await self._ask(verb, name, decision.message)

    async def _ask(self, verb: Verb, name: str, message: Any) -> None:
        ask = self.ask or self._robot.ask
        if ask is None:
            raise self.refusal(
                verb, name, "a person has to approve, and there is nobody to ask",
                "not_confirmed", message,
            )  # fmt: skip
        if not await ask(self.identity, verb, name, message):
            raise self.refusal(verb, name, "a person has said no", "not_confirmed", message)

    def sees(self, name: str, type_names: Iterable[str]) -> bool:
        """Return whether the client may see a name with any of some types, or without a type."""
        return any(self.decision("see", name, kind).allowed for kind in type_names or [""])

    @contextmanager
    def one_more(self, verb: str, name: str, what: str, held: Sized, limit: int) -> Iterator[None]:
        """Count one more of something limited for each client, during the block.

        Those still being created count too: several at once would each find the last place.

        Args:
            verb: What the client does.
            name: The name that it uses.
            what: What is limited.
            held: The ones that exist.
            limit: The limit.

        Raises:
            RefusedError: the limit is reached.
        """
        there_are = len(held) + self._coming[what]
        if there_are >= limit:
            reason = f"the client has {there_are} {what}, which is the limit"
            raise self.refusal(verb, name, reason, "too_many")
        self._coming[what] += 1
        try:
            yield
        finally:
            self._coming[what] -= 1

    def one_call(self, verb: str, name: str) -> AbstractContextManager[None]:
        """Count one more call, goal or node query for the duration of the block."""
        what = "calls, goals and queries in progress"
        return self.one_more(verb, name, what, (), self.limits.calls)

    def check_size(self, verb: Verb, name: str, decision: Decision, message: Message) -> None:
        """Refuse a message larger than its rule allows.

        Raises:
            RefusedError: it is too large.
        """
        limit = None if decision.rule is None else decision.rule.max_bytes
        if limit is None:
            return
        from aionode.engine.wire import cdr  # few rules limit the size

        if len(cdr.encode(message)) > limit:
            raise self.refusal(verb, name, f"it has more than {limit} bytes", "too_large")

    def decide_parameter(self, node: str, parameter: Parameter) -> Parameter:
        """Return a parameter that the client may set, clamped to its limits.

        Raises:
            RefusedError: it may not.
        """
        name = f"{node}:{parameter.name}"
        decision = self.decide("parameter", name, "", {"value": parameter.value})
        changed = decision.message["value"]
        return parameter if changed == parameter.value else Parameter(parameter.name, value=changed)

    def check_seen(self, node: str, names: Iterable[str]) -> None:
        """Refuse to reveal anything about parameters that the client may not see.

        Raises:
            RefusedError: it may not see one of them.
        """
        for name in names:
            if not self.sees(f"{node}:{name}", []):
                raise self.refusal(
                    "see", f"{node}:{name}", "the policy does not show it", "not_allowed"
                )

    def visible(self, named: Any, *, hidden: bool) -> dict[str, list[str]]:
        """Return the names that the client may see, with their types.

        Args:
            named: Pairs of a name and its types.
            hidden: Whether to include names that ROS hides.
        """
        return {
            name: types
            for name, types in named
            if (hidden or not is_hidden(name)) and self.sees(name, types)
        }
