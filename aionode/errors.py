"""Every exception of aionode.

All derive from `AionodeError` and from the builtin that a caller would expect, so both
`except AionodeError` and `except TimeoutError` work. An exception that rclpy has keeps rclpy's
name; new ones end in `Error`. They carry plain values, never live objects.

::

    AionodeError
    ├── EntityDestroyedError (RuntimeError)
    ├── MessageError (ValueError)
    ├── QueueFullError (RuntimeError)
    ├── ServiceError (RuntimeError)
    │   └── ServiceUnavailableError
    ├── RequestTimeoutError (TimeoutError)
    └── TransportError (ConnectionError)
"""

from __future__ import annotations

__all__ = [
    "AionodeError",
    "EntityDestroyedError",
    "MessageError",
    "QueueFullError",
    "RequestTimeoutError",
    "ServiceError",
    "ServiceUnavailableError",
    "TransportError",
]


class AionodeError(Exception):
    """Base of all errors that aionode raises on purpose."""


class EntityDestroyedError(AionodeError, RuntimeError):
    """A destroyed node or entity was used.

    Attributes:
        subject: What was destroyed, such as ``publisher of /chatter``.
    """

    def __init__(self, subject: str, action: str = "used") -> None:
        self.subject = subject
        super().__init__(f"{subject}: destroyed, and cannot be {action} any more; make a new one")


class MessageError(AionodeError, ValueError):
    """A value does not fit its field.

    Attributes:
        path: Type and path of the field, such as ``sensor_msgs/msg/JointState.name[3]``.
        problem: What was given and what fits.
    """

    def __init__(self, path: str, problem: str) -> None:
        self.path = path
        self.problem = problem
        super().__init__(f"{path}: {problem}")


class QueueFullError(AionodeError, RuntimeError):
    """A KEEP_ALL reader has no room; nothing was delivered to anybody.

    Attributes:
        topic: The topic.
        depth: How many messages the full queue holds.
    """

    def __init__(self, topic: str, depth: int) -> None:
        self.topic = topic
        self.depth = depth
        super().__init__(
            f"{topic}: a KEEP_ALL subscription already holds {depth} unread messages; nothing was "
            "published. `await publisher.drain()` before publishing on, or use KEEP_LAST"
        )


class ServiceError(AionodeError, RuntimeError):
    """The server could not serve a request.

    Attributes:
        service: Name of the service.
        error_type: Name of the exception that its handler raised, where there was one.
        error_text: Text of that exception, or what else went wrong.
    """

    def __init__(self, service: str, error_text: str, error_type: str = "") -> None:
        self.service = service
        self.error_type = error_type
        self.error_text = error_text
        what = f"{error_type}: {error_text}" if error_type else error_text
        super().__init__(f"{service}: {what}")


class ServiceUnavailableError(ServiceError):
    """Every server that had the request went away before it answered."""

    def __init__(self, service: str) -> None:
        super().__init__(
            service, "the server went away before it answered; wait_for_service() and call again"
        )


class RequestTimeoutError(AionodeError, TimeoutError):
    """No reply came within `timeout_sec`.

    Attributes:
        service: Name of the service.
        timeout_sec: How long the call waited, in seconds.
        servers: How many servers were matched when it gave up.
    """

    def __init__(self, service: str, timeout_sec: float, servers: int) -> None:
        self.service = service
        self.timeout_sec = timeout_sec
        self.servers = servers
        super().__init__(f"{service}: no reply in {timeout_sec:g} s; {silence(servers)}")


class TransportError(AionodeError, ConnectionError):
    """A transport cannot do what was asked; the text says what to change."""


def silence(servers: int) -> str:
    """Return why a request has no reply, as far as the number of matched servers tells."""
    if servers == 0:
        return "no server is matched: is it running, with this name and type?"
    return f"{servers} matched server(s) stayed silent"
