"""Every exception of aionode.

All derive from `AionodeError` and from the builtin that a caller would expect, so both
`except AionodeError` and `except TimeoutError` work. An exception that rclpy has keeps rclpy's
name; new ones end in `Error`. They carry plain values, never live objects.

::

    AionodeError
    ├── CallbackCancelledError (RuntimeError)
    ├── CallbackSignatureError (TypeError, RuntimeError)
    ├── CommandError (RuntimeError)
    ├── ConfigurationError (ValueError)
    ├── ContentFilterError (ValueError)
    ├── DecodeError (ValueError)
    ├── EntityDestroyedError (RuntimeError)
    ├── EntityInactiveError (RuntimeError)
    ├── ForkedProcessError (RuntimeError)
    ├── GoalError (RuntimeError)
    │   ├── GoalAbortedError
    │   ├── GoalCanceledError
    │   ├── GoalLostError
    │   └── GoalRejectedError
    ├── GoalTransitionError (RuntimeError)
    ├── IdlError (ValueError)
    ├── InterfaceNotFoundError (LookupError)
    ├── InvalidLogLevelError (ValueError, RuntimeError)
    ├── InvalidQoSProfileException (ValueError)
    ├── InvalidQosOverridesError (ValueError, RuntimeError)
    ├── InvalidROSArgsError (ValueError)
    │   └── UnknownROSArgsError
    ├── InvalidRemapRuleError (ValueError)
    ├── MessageError (ValueError)
    ├── NameValidationException (ValueError)
    │   ├── InvalidNamespaceException
    │   ├── InvalidNodeNameException
    │   ├── InvalidServiceNameException
    │   └── InvalidTopicNameException
    ├── ParameterException
    │   ├── InvalidParameterException (ValueError)
    │   ├── InvalidParameterTypeException (TypeError)
    │   ├── InvalidParameterValueException (ValueError)
    │   ├── ParameterAlreadyDeclaredException (ValueError)
    │   ├── ParameterImmutableException (RuntimeError)
    │   ├── ParameterNotDeclaredException (KeyError)
    │   └── ParameterUninitializedException (RuntimeError)
    ├── ParameterFileError (ValueError, RuntimeError)
    ├── NodeNameNonExistentError (LookupError, RuntimeError)
    ├── NodeNotRunningError (RuntimeError)
    ├── QueueFullError (RuntimeError)
    ├── ServiceError (RuntimeError)
    │   └── ServiceUnavailableError (TimeoutError)
    ├── RequestTimeoutError (TimeoutError)
    ├── TimeSourceChangedError (RuntimeError)
    ├── TransitionError (RuntimeError)
    └── TransportError (ConnectionError)
        └── FrameError
"""

from __future__ import annotations

from aionode.errors import _values
from aionode.errors._values import (
    AionodeError,
    DecodeError,
    InvalidLogLevelError,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    InvalidQosOverridesError,
    InvalidQoSProfileException,
    InvalidRemapRuleError,
    InvalidROSArgsError,
    InvalidServiceNameException,
    InvalidTopicNameException,
    MessageError,
    NameValidationException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterFileError,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    UnknownROSArgsError,
)

__all__ = [
    "AionodeError",
    "CallbackCancelledError",
    "CallbackSignatureError",
    "CommandError",
    "ConfigurationError",
    "ContentFilterError",
    "DecodeError",
    "EntityDestroyedError",
    "EntityInactiveError",
    "ForkedProcessError",
    "FrameError",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejectedError",
    "GoalTransitionError",
    "IdlError",
    "InterfaceNotFoundError",
    "InvalidLogLevelError",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidQoSProfileException",
    "InvalidQosOverridesError",
    "InvalidROSArgsError",
    "InvalidRemapRuleError",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "MessageError",
    "NameValidationException",
    "NodeNameNonExistentError",
    "NodeNotRunningError",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterFileError",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "QueueFullError",
    "RequestTimeoutError",
    "ServiceError",
    "ServiceUnavailableError",
    "TimeSourceChangedError",
    "TransitionError",
    "TransportError",
    "UnknownROSArgsError",
]

# For the texts of errors raised elsewhere in aionode; not public.
brief = _values.brief
shortened = _values.shortened


class EntityDestroyedError(AionodeError, RuntimeError):
    """A destroyed node or entity was used.

    Attributes:
        subject: What was destroyed, such as ``publisher of /chatter``.
    """

    def __init__(self, subject: str, action: str = "used") -> None:
        self.subject = subject
        super().__init__(f"{subject}: destroyed, and cannot be {action} any more; make a new one")


class EntityInactiveError(AionodeError, RuntimeError):
    """Something of a managed node was used that works only while the node is active.

    Attributes:
        subject: What was used.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(f"{subject}: the node is not active; activate it first")


class TransitionError(AionodeError, RuntimeError):
    """A managed node could not make a transition.

    Attributes:
        node: Full name of the node.
        transition: Label of the transition.
        state: Label of the state in which the node is now.
        reason: What went wrong.
    """

    def __init__(self, node: str, transition: str, state: str, reason: str) -> None:
        self.node, self.transition, self.state, self.reason = node, transition, state, reason
        super().__init__(f"{node}: cannot {transition}: {reason}; the node is {state}")


class ForkedProcessError(AionodeError, RuntimeError):
    """A forked process wants to use what belongs to the process that it was forked from.

    The threads of the network are not in the child, and its sockets and shared memory are the
    parent's: using them would stop or kill the parent.

    Attributes:
        subject: What was to be used.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(
            f"{subject}: this process was forked from one whose context is open, and cannot use "
            'it; start processes with multiprocessing.get_context("spawn"), or fork before the '
            "first node runs"
        )


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
            f"{topic}: a KEEP_ALL subscription is full, with {depth} unread messages or more; "
            "nothing was published. `await publisher.drain()` before the next, or use KEEP_LAST"
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


class ServiceUnavailableError(ServiceError, TimeoutError):
    """Every server that had the request went away before it answered.

    It is a TimeoutError too, because no reply will come: a caller that is prepared for silence, as
    callers of ROS have to be, is prepared for this, and learns it without waiting.
    """

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


class GoalError(AionodeError, RuntimeError):
    """A goal of an action did not come to a good end.

    Attributes:
        action: Name of the action.
        goal_id: Id of the goal, in 32 hexadecimal digits.
    """

    def __init__(self, action: str, goal_id: str, what: str) -> None:
        self.action = action
        self.goal_id = goal_id
        super().__init__(f"{action}: goal {goal_id} {what}")


class GoalRejectedError(GoalError):
    """The action server did not accept a goal."""

    def __init__(self, action: str, goal_id: str) -> None:
        super().__init__(
            action, goal_id, "was rejected; the server's goal_callback decides, and knows why"
        )


class GoalAbortedError(GoalError):
    """The action server gave a goal up.

    Attributes:
        result: The result message, as far as the server got.
        error_text: Type and text of the exception that ended it; empty if there was none, or if
            the server cannot tell.
    """

    def __init__(self, action: str, goal_id: str, result: object, error_text: str = "") -> None:
        self.result = result
        self.error_text = error_text
        reason = f": {error_text}" if error_text else "; the server gave no reason"
        super().__init__(action, goal_id, f"was aborted{reason}")


class GoalCanceledError(GoalError):
    """A goal was canceled, by a request from here or from elsewhere.

    Attributes:
        result: The result message, as far as the server got.
    """

    def __init__(self, action: str, goal_id: str, result: object) -> None:
        self.result = result
        super().__init__(action, goal_id, "was canceled")


class GoalLostError(GoalError):
    """How a goal ended cannot be known: its server went away, or does not know it any more.

    Attributes:
        problem: What happened.
    """

    def __init__(self, action: str, goal_id: str, problem: str) -> None:
        self.problem = problem
        super().__init__(
            action, goal_id, f"was lost: {problem}; wait_for_server() and send it again"
        )


class GoalTransitionError(AionodeError, RuntimeError):
    """A goal cannot do in its state what it was told to.

    Attributes:
        goal_id: Id of the goal, in 32 hexadecimal digits.
        status: Its state.
        event: What should have happened to it.
        fits: What can happen in that state.
    """

    def __init__(self, goal_id: str, status: str, event: str, fits: list[str]) -> None:
        self.goal_id = goal_id
        self.status = status
        self.event = event
        self.fits = fits
        possible = f"only {', '.join(fits)} can follow" if fits else "nothing can follow that"
        super().__init__(f"goal {goal_id}: {event} while {status}; {possible}")


class CallbackSignatureError(AionodeError, TypeError, RuntimeError):
    """A callback takes other arguments than it would be given.

    A TypeError, and a RuntimeError as in rclpy.

    Attributes:
        subject: The entity that was to be made.
        signature: Name and arguments of the callback.
        wanted: What fits.
    """

    def __init__(self, subject: str, signature: str, wanted: str) -> None:
        self.subject = subject
        self.signature = signature
        self.wanted = wanted
        super().__init__(f"{subject}: cannot call {signature}; it must take {wanted}")


class CallbackCancelledError(AionodeError, RuntimeError):
    """Something that a callback waited for was cancelled, and the callback did not handle it.

    Attributes:
        subject: The callback.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(
            f"{subject}: what it awaited was cancelled (its client or clock destroyed?); "
            "handle asyncio.CancelledError there if that is expected"
        )


class TimeSourceChangedError(AionodeError, RuntimeError):
    """ROS time was switched on or off during a sleep, so its end has lost its meaning.

    Attributes:
        active: Whether ROS time comes from `/clock` now.
    """

    def __init__(self, *, active: bool) -> None:
        self.active = active
        source = "/clock" if active else "the system clock"
        super().__init__(
            f"sleep: ROS time was switched to {source} meanwhile; decide what is left to wait for "
            "and sleep again"
        )


class ConfigurationError(AionodeError, ValueError):
    """An environment variable or an argument of `Context` says something that does not fit.

    Attributes:
        source: The variable or argument, such as ``ROS_DOMAIN_ID``.
        given: What it said.
        fits: What fits.
    """

    def __init__(self, source: str, given: str, fits: str) -> None:
        self.source = source
        self.given = given
        self.fits = fits
        super().__init__(f"{source}: {given!r} given; {fits}")


class ContentFilterError(AionodeError, ValueError):
    """A content filter cannot be used.

    Attributes:
        expression: The filter.
        position: Where in it the problem is, counted in characters from 0.
        problem: What is wrong.
    """

    def __init__(self, expression: str, position: int, problem: str) -> None:
        self.expression, self.position, self.problem = expression, position, problem
        super().__init__(f"content filter {expression!r}: {problem} (at character {position + 1})")


class NodeNameNonExistentError(AionodeError, LookupError, RuntimeError):
    """No node of this name is known; a RuntimeError as in rclpy.

    Attributes:
        node: Full name that was asked for.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(f"{node}: no such node; `await node.wait_for_node(name)` waits for one")


class NodeNotRunningError(AionodeError, RuntimeError):
    """A supervised node was asked for while none runs.

    Attributes:
        node: Its full name.
        problem: Why it does not run, and what becomes of it.
    """

    def __init__(self, node: str, problem: str) -> None:
        self.node = node
        self.problem = problem
        super().__init__(f"node {node}: not running: {problem}")


class TransportError(AionodeError, ConnectionError):
    """A transport cannot do what was asked; the text says what to change."""


class FrameError(TransportError):
    """A link between two processes carries, or should carry, what is no frame.

    The link ends with it, and what it carried goes over Zenoh.

    Attributes:
        problem: What came, or was to be sent.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"link: {problem}; do both processes run the same release of aionode?")


def silence(servers: int) -> str:
    """Return why a request has no reply, as far as the number of matched servers tells."""
    if servers == 0:
        return "no server is matched: is it running, with this name and type?"
    return f"{servers} matched server(s) stayed silent"


class IdlError(AionodeError, ValueError):
    """An interface definition cannot be read.

    Attributes:
        file: Path of the file, or the name of the type where the text came from elsewhere.
        line: Number of the line, from 1; 0 if the whole file is meant.
        column: Number of the character in it, from 1; 0 if the whole line is meant.
        problem: What is wrong and what fits.
    """

    def __init__(self, file: str, line: int, column: int, problem: str) -> None:
        self.file = file
        self.line = line
        self.column = column
        self.problem = problem
        place = ":".join(str(part) for part in (file, line, column) if part)
        super().__init__(f"{place}: {problem}")


class InterfaceNotFoundError(AionodeError, LookupError):
    """There is no message, service or action type of this name.

    Attributes:
        name: The name that was asked for.
        suggestions: Names like it that there are, the closest first.
    """

    def __init__(self, name: str, suggestions: tuple[str, ...] = (), problem: str = "") -> None:
        self.name = name
        self.suggestions = suggestions
        hint = f"did you mean {' or '.join(suggestions)}?" if suggestions else HOW_TO_FIND
        super().__init__(f"{name}: {problem or 'no such interface'}; {hint}")


HOW_TO_FIND = (
    "names look like std_msgs/msg/String or std_srvs/srv/Trigger, `aionode interface list` shows "
    "those there are, and aionode.idl.load_interfaces() adds your own"
)


class CommandError(AionodeError, RuntimeError):
    """A command of the command line cannot do what was asked.

    Attributes:
        status: The exit status of the command.
    """

    def __init__(self, text: str, status: int = 1) -> None:
        self.status = status
        super().__init__(text)


for _name in __all__:
    globals()[_name].__module__ = __name__  # users see aionode.errors.X, wherever X is written
