"""Errors of service calls, and of goals of actions."""

from __future__ import annotations

from aionode.errors._base import AionodeError, brief, shortened

__all__ = [
    "FAST_DDS_REMEDY",
    "FAST_DDS_SILENCE",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejected",
    "GoalRejectedError",
    "GoalTransitionError",
    "RequestRefusedError",
    "RequestTimeoutError",
    "ServiceError",
    "ServiceUnavailableError",
    "silence",
]


MAX_REASON = 1000
"""Maximum characters in the reason of a rejection: servers keep a number of reasons."""


class ServiceError(AionodeError, RuntimeError):
    """A service call failed at the server.

    Attributes:
        service: Name of the service.
        error_type: Name of the exception that the handler raised; empty if it raised none.
        error_text: Text of that exception, or another description of the failure.
    """

    def __init__(self, service: str, error_text: str, error_type: str = "") -> None:
        self.service = service
        self.error_type = error_type
        self.error_text = error_text
        what = f"{error_type}: {error_text}" if error_type else error_text
        super().__init__(f"{service}: {what}")


class ServiceUnavailableError(ServiceError, TimeoutError):
    """Every server that received the request went away before it replied.

    It is also a TimeoutError: no reply will come, so code that handles a missing reply handles this
    too, without waiting for the timeout.
    """

    def __init__(self, service: str) -> None:
        super().__init__(
            service,
            "the server went away before it replied; call again once a server is there",
        )


class RequestRefusedError(AionodeError, ValueError):
    """A request exceeds the limits of a service that every node offers."""


class RequestTimeoutError(AionodeError, TimeoutError):
    """No reply came within `timeout_sec`.

    Attributes:
        service: Name of the service.
        timeout_sec: How long the call waited, in seconds.
        servers: Number of servers that were matched when the call timed out.
    """

    def __init__(self, service: str, timeout_sec: float, servers: int, caveat: str = "") -> None:
        self.service = service
        self.timeout_sec = timeout_sec
        self.servers = servers
        hint = f": {caveat}" if caveat else ""
        super().__init__(f"{service}: no reply in {timeout_sec:g} s; {silence(servers)}{hint}")


def silence(servers: int) -> str:
    """Return a likely reason for a missing reply, given the number of matched servers."""
    if servers == 0:
        return "no server is matched: is it running, with this name and type?"
    return f"{servers} matched server(s) did not reply"


FAST_DDS_SILENCE = (
    "there are nodes on Fast DDS behind the zenoh-bridge-ros2dds, whose services, actions and "
    "parameters time out (topics work)"
)
"""Why services behind a bridge do not answer."""

FAST_DDS_REMEDY = (
    "start them with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp, or run aionode on the robot with "
    "AIONODE_TRANSPORT=rcl"
)


class GoalError(AionodeError, RuntimeError):
    """An action goal did not succeed.

    Attributes:
        action: Name of the action.
        goal_id: Id of the goal, in 32 hexadecimal digits.
    """

    def __init__(self, action: str, goal_id: str, what: str) -> None:
        self.action = action
        self.goal_id = goal_id
        super().__init__(f"{action}: goal {goal_id} {what}")


class GoalRejected(AionodeError, RuntimeError):  # an answer, as GoalResponse.REJECT
    """Raised by a `goal_callback` to reject a goal with a reason: ``too far: 12 m of at most 5``.

    To ROS it is ``GoalResponse.REJECT``. Clients of aionode get the reason with their
    `GoalRejectedError`, and the log of the server has it.

    Attributes:
        reason: The reason, in words for the caller; its first 1000 characters.

    Raises:
        TypeError: `reason` is not a str.
    """

    def __init__(self, reason: str) -> None:
        if not isinstance(reason, str):
            raise TypeError(f"GoalRejected: reason={brief(reason)}; a str is needed")
        self.reason = shortened(reason, MAX_REASON)
        super().__init__(self.reason)


class GoalRejectedError(GoalError):
    """The action server rejected a goal.

    Attributes:
        reason: The reason that its `goal_callback` gave by `GoalRejected`; empty if it gave none,
            or if the server does not send it, like those of ROS.
    """

    def __init__(self, action: str, goal_id: str, reason: str = "") -> None:
        self.reason = reason
        unknown = (
            " by the server, by its goal_callback or because max_goals are active; ROS sends no "
            "reason, so see the server's log, or have goal_callback raise GoalRejected with one"
        )
        super().__init__(action, goal_id, f"was rejected{f': {reason}' if reason else unknown}")


class GoalAbortedError(GoalError):
    """The action server aborted a goal.

    Attributes:
        result: The result message, as far as the server filled it in.
        error_text: Type and text of the exception that ended the goal; empty if there was none, or
            if the server does not send it.
    """

    def __init__(self, action: str, goal_id: str, result: object, error_text: str = "") -> None:
        self.result = result
        self.error_text = error_text
        reason = f": {error_text}" if error_text else "; the server gave no reason"
        super().__init__(action, goal_id, f"was aborted{reason}")


class GoalCanceledError(GoalError):
    """A goal was canceled: by this client, by another, or by a server that had lost this one.

    Attributes:
        result: The result message, as far as the server filled it in.
        error_text: Why the server canceled it on its own; empty if a client asked for it.
    """

    def __init__(self, action: str, goal_id: str, result: object, error_text: str = "") -> None:
        self.result = result
        self.error_text = error_text
        reason = f": {error_text}" if error_text else ""
        super().__init__(action, goal_id, f"was canceled{reason}")


class GoalLostError(GoalError):
    """The outcome of a goal cannot be known: its server went away, or no longer knows the goal.

    Attributes:
        problem: What happened.
    """

    def __init__(self, action: str, goal_id: str, problem: str) -> None:
        self.problem = problem
        super().__init__(
            action, goal_id, f"was lost: {problem}; send it again once a server is there"
        )


class GoalTransitionError(AionodeError, RuntimeError):
    """The state of a goal does not allow the requested transition.

    Attributes:
        goal_id: Id of the goal, in 32 hexadecimal digits.
        status: The state of the goal.
        event: The event that was requested.
        fits: The events that are allowed in that state.
    """

    def __init__(self, goal_id: str, status: str, event: str, fits: list[str]) -> None:
        self.goal_id = goal_id
        self.status = status
        self.event = event
        self.fits = fits
        allowed = f"only {', '.join(fits)} is allowed" if fits else "no event is allowed"
        super().__init__(f"goal {goal_id}: cannot {event} while {status}; {allowed}")
