"""Errors about publishers and subscriptions: their QoS, queues, filters and leases."""

from __future__ import annotations

from aionode.errors._base import AionodeError, brief, shortened

__all__ = [
    "ContentFilterError",
    "InvalidQoSProfileException",
    "InvalidQosOverridesError",
    "LeaseExpiredError",
    "LeaseHeldError",
    "QueueFullError",
]


class InvalidQoSProfileException(AionodeError, ValueError):
    """A QoS profile was given invalid values.

    Attributes:
        problem: What was given and what is valid.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"Invalid QoSProfile: {problem}")


class InvalidQosOverridesError(AionodeError, ValueError, RuntimeError):
    """QoS override parameters are invalid for an endpoint; a RuntimeError as in rclpy.

    Attributes:
        subject: The endpoint, or the parameter at fault.
        problem: What is wrong.
    """

    def __init__(self, subject: str, problem: str) -> None:
        self.subject = subject
        self.problem = problem
        super().__init__(f"{subject}: QoS overrides are not valid: {problem}")


class ContentFilterError(AionodeError, ValueError):
    """A content filter expression is invalid.

    Attributes:
        expression: The filter expression.
        position: Index of the character where the problem is, from 0.
        problem: What is wrong.
    """

    def __init__(self, expression: str, position: int, problem: str) -> None:
        self.expression, self.position, self.problem = expression, position, problem
        super().__init__(
            f"content filter {brief(expression)}: {shortened(problem, 300)} "
            f"(at character {position + 1})"
        )


class QueueFullError(AionodeError, RuntimeError):
    """The queue of a KEEP_ALL subscription is full; the message was not published to anyone.

    Attributes:
        topic: The topic.
        depth: Number of messages that the full queue holds.
    """

    def __init__(self, topic: str, depth: int) -> None:
        self.topic = topic
        self.depth = depth
        super().__init__(
            f"{topic}: a KEEP_ALL subscription is full, with {depth} unread messages or more; "
            "the message was not published. Call `await publisher.drain()` before the next one, "
            "or use KEEP_LAST"
        )


class LeaseExpiredError(AionodeError, TimeoutError):
    """A command lease has ended: its stop was sent, and no more commands are accepted.

    Attributes:
        topic: The topic of the commands.
        reason: Why it ended.
    """

    def __init__(self, topic: str, reason: str) -> None:
        self.topic = topic
        self.reason = reason
        super().__init__(
            f"{topic}: the lease has ended and its stop was sent, because {reason}; enter a new "
            "one to go on"
        )


class LeaseHeldError(AionodeError, RuntimeError):
    """A publisher was used directly while a command lease on it is held.

    Attributes:
        topic: The topic of the commands.
    """

    def __init__(self, topic: str) -> None:
        self.topic = topic
        super().__init__(
            f"{topic}: a lease of this publisher is held; only its holder publishes, with "
            "lease.publish(), until the block of the lease ends"
        )
