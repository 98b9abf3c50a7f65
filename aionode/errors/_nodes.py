"""Errors about nodes, their entities and their callbacks."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = [
    "CallbackCancelledError",
    "CallbackSignatureError",
    "EntityDestroyedError",
    "EntityInactiveError",
    "ForkedProcessError",
    "NodeNameNonExistentError",
    "NodeNotRunningError",
    "TimeSourceChangedError",
    "TransitionError",
]


class NodeNameNonExistentError(AionodeError, LookupError, RuntimeError):
    """No node of this name is known; a RuntimeError as in rclpy.

    Attributes:
        node: Full name that was looked up.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(
            f"{node}: no such node; look at the existing names, or wait for it, as "
            "wait_for_node() does"
        )


class NodeNotRunningError(AionodeError, RuntimeError):
    """A supervised node was requested while it is not running.

    Attributes:
        node: Full name of the node.
        problem: Why it is not running, and whether it will be restarted.
    """

    def __init__(self, node: str, problem: str) -> None:
        self.node = node
        self.problem = problem
        super().__init__(f"node {node}: not running: {problem}")


class TransitionError(AionodeError, RuntimeError):
    """A managed node could not make a transition.

    Attributes:
        node: Full name of the node.
        transition: Label of the transition.
        state: Label of the state that the node is in now.
        reason: What went wrong.
    """

    def __init__(self, node: str, transition: str, state: str, reason: str) -> None:
        self.node, self.transition, self.state, self.reason = node, transition, state, reason
        super().__init__(f"{node}: cannot {transition}: {reason}; the node is {state}")


class EntityInactiveError(AionodeError, RuntimeError):
    """An entity of a managed node was used while the node was inactive.

    Attributes:
        subject: The entity that was used.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(f"{subject}: the node is not active; activate it first")


class EntityDestroyedError(AionodeError, RuntimeError):
    """A destroyed node or entity was used.

    Attributes:
        subject: What was destroyed, such as ``publisher of /chatter``.
    """

    def __init__(self, subject: str, action: str = "") -> None:
        self.subject = subject
        state = f"{subject} is destroyed; create a new one"
        super().__init__(f"cannot {action}: {state}" if action else state)


class ForkedProcessError(AionodeError, RuntimeError):
    """A forked child process used a node or context of its parent.

    The network threads do not exist in the child, and its sockets and shared memory are still
    those of the parent: using them could block or crash the parent.

    Attributes:
        subject: The node or context that was used.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(
            f"{subject}: this process was forked while the context was open and cannot use it; "
            'start processes with multiprocessing.get_context("spawn"), or fork before the first '
            "node runs"
        )


class CallbackSignatureError(AionodeError, TypeError, RuntimeError):
    """A callback does not accept the arguments that it would be called with.

    It is a TypeError, and a RuntimeError as in rclpy.

    Attributes:
        subject: The entity that was to be created.
        signature: Name and parameters of the callback.
        wanted: The parameters that it must accept.
    """

    def __init__(self, subject: str, signature: str, wanted: str) -> None:
        self.subject = subject
        self.signature = signature
        self.wanted = wanted
        super().__init__(f"{subject}: cannot call {signature}; it must take {wanted}")


class CallbackCancelledError(AionodeError, RuntimeError):
    """A callback raised CancelledError although nobody cancelled it.

    Something it awaited was cancelled, or it read the result of a cancelled future.

    Attributes:
        subject: Name of the callback.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(
            f"{subject}: it raised CancelledError, though nobody cancelled it: something inside it "
            "was cancelled (was its client or clock destroyed?); catch asyncio.CancelledError in "
            "the callback if that is expected"
        )


class TimeSourceChangedError(AionodeError, RuntimeError):
    """ROS time was switched on or off during a sleep, so the wake-up time is meaningless.

    Attributes:
        active: Whether ROS time now comes from `/clock`.
    """

    def __init__(self, *, active: bool) -> None:
        self.active = active
        source = "/clock" if active else "the system clock"
        super().__init__(
            f"sleep: ROS time was switched to {source} during the sleep; compute the remaining "
            "time and sleep again"
        )
