"""Refusals by the gateway, errors in its policy file, and those of an assistant's tools."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = ["PolicyFileError", "RefusedError", "ToolError"]


class RefusedError(AionodeError, PermissionError):
    """The gateway refuses a client's request; nothing reached the robot.

    Attributes:
        subject: What the client asked for, such as ``publish to /cmd_vel``.
        reason: Why it is refused, and what would be allowed.
        code: The reason as a code for programs: ``not_allowed`` by the policy, ``unauthorized``
            without a valid token or from a page that may not connect, ``out_of_limits`` for a value
            outside the limits of its field, ``too_large``, ``too_fast``, ``not_confirmed`` by a
            person, ``held`` by another client that commands the topic, ``too_many`` of what is
            counted, ``too_old`` for a command that arrived late, ``unsupported`` for a protocol
            that the gateway does not speak.
    """

    def __init__(self, subject: str, reason: str, code: str = "not_allowed") -> None:
        self.subject = subject
        self.reason = reason
        self.code = code
        super().__init__(f"{subject}: refused: {reason}")


class PolicyFileError(AionodeError, ValueError):
    """A policy file cannot be read, or is not a policy.

    Attributes:
        path: The file.
        problem: What is wrong, and what would be valid.
    """

    def __init__(self, path: str, problem: str) -> None:
        self.path = path
        self.problem = problem
        super().__init__(f"policy {path}: {problem}")


class ToolError(AionodeError, RuntimeError):
    """A tool of an assistant cannot do what it was called to do.

    Attributes:
        subject: What it was called with.
        reason: Why it cannot, and what to do.
        code: The reason as a code for programs: ``not_found``, ``timeout``, or ``failed``.
    """

    def __init__(self, subject: str, reason: str, code: str = "failed") -> None:
        self.subject = subject
        self.reason = reason
        self.code = code
        super().__init__(f"{subject}: {reason}")
