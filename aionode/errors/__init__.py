"""All exceptions that aionode raises on purpose.

Each derives from `AionodeError` and from the builtin exception that a caller would expect, so
`except AionodeError` and `except TimeoutError` both work. Exceptions that also exist in rclpy keep
rclpy's name; new ones end in `Error`. They carry plain values, never live objects.

::

    AionodeError
    ├── BagError (ValueError)
    ├── BagWriteError (OSError)
    ├── CallbackCancelledError (RuntimeError)
    ├── CallbackSignatureError (TypeError, RuntimeError)
    ├── CommandError (RuntimeError)
    ├── ConfigurationError (ValueError)
    ├── ContentFilterError (ValueError)
    ├── DecodeError (ValueError)
    ├── EntityDestroyedError (RuntimeError)
    ├── EntityInactiveError (RuntimeError)
    ├── ExecutableNotFoundError (LookupError)
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
    ├── MemberNotFoundError (LookupError)
    ├── LaunchFileError (ValueError)
    ├── MessageError (ValueError)
    ├── LeaseExpiredError (TimeoutError)
    ├── LeaseHeldError (RuntimeError)
    ├── NameValidationException (ValueError)
    │   ├── InvalidNamespaceException
    │   ├── InvalidNodeNameException
    │   ├── InvalidServiceNameException
    │   └── InvalidTopicNameException
    ├── PackageNotFoundError (LookupError)
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
    ├── NotReadyError (TimeoutError)
    ├── ProgramStartError (OSError)
    ├── QueueFullError (RuntimeError)
    ├── ServiceError (RuntimeError)
    │   └── ServiceUnavailableError (TimeoutError)
    ├── RequestRefusedError (ValueError)
    ├── RequestTimeoutError (TimeoutError)
    ├── TimeSourceChangedError (RuntimeError)
    ├── TransformException (RuntimeError)
    │   ├── ConnectivityException
    │   ├── ExtrapolationException
    │   │   ├── BackwardExtrapolationException
    │   │   ├── ForwardExtrapolationException
    │   │   └── NoDataForExtrapolationException
    │   ├── InvalidArgumentException (ValueError)
    │   ├── LookupException (LookupError)
    │   └── TimeoutException (TimeoutError)
    ├── TransitionError (RuntimeError)
    ├── TransportError (ConnectionError)
    │   └── FrameError
    └── TypeDescriptionError (ValueError)
"""

from __future__ import annotations

from collections.abc import Sequence

from aionode.errors import _values
from aionode.errors._bag import BagError, BagWriteError
from aionode.errors._commands import CommandError, LaunchFileError
from aionode.errors._values import (
    AionodeError,
    BackwardExtrapolationException,
    ConnectivityException,
    DecodeError,
    ExtrapolationException,
    ForwardExtrapolationException,
    GoalAbortedError,
    GoalCanceledError,
    GoalError,
    GoalLostError,
    GoalRejectedError,
    GoalTransitionError,
    IdlError,
    InvalidArgumentException,
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
    LeaseExpiredError,
    LeaseHeldError,
    LookupException,
    MessageError,
    NameValidationException,
    NoDataForExtrapolationException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterFileError,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    QueueFullError,
    TimeoutException,
    TransformException,
    TypeDescriptionError,
    UnknownROSArgsError,
)

__all__ = [
    "AionodeError",
    "BackwardExtrapolationException",
    "BagError",
    "BagWriteError",
    "CallbackCancelledError",
    "CallbackSignatureError",
    "CommandError",
    "ConfigurationError",
    "ConnectivityException",
    "ContentFilterError",
    "DecodeError",
    "EntityDestroyedError",
    "EntityInactiveError",
    "ExecutableNotFoundError",
    "ExtrapolationException",
    "ForkedProcessError",
    "ForwardExtrapolationException",
    "FrameError",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejectedError",
    "GoalTransitionError",
    "IdlError",
    "InterfaceNotFoundError",
    "InvalidArgumentException",
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
    "LaunchFileError",
    "LeaseExpiredError",
    "LeaseHeldError",
    "LookupException",
    "MemberNotFoundError",
    "MessageError",
    "NameValidationException",
    "NoDataForExtrapolationException",
    "NodeNameNonExistentError",
    "NodeNotRunningError",
    "NotReadyError",
    "PackageNotFoundError",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterFileError",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "ProgramStartError",
    "QueueFullError",
    "RequestRefusedError",
    "RequestTimeoutError",
    "ServiceError",
    "ServiceUnavailableError",
    "TimeSourceChangedError",
    "TimeoutException",
    "TransformException",
    "TransitionError",
    "TransportError",
    "TypeDescriptionError",
    "UnknownROSArgsError",
]

# Used by other modules of aionode to write error texts; not public.
brief, escaped, shortened = _values.brief, _values.escaped, _values.shortened


class EntityDestroyedError(AionodeError, RuntimeError):
    """A destroyed node or entity was used.

    Attributes:
        subject: What was destroyed, such as ``publisher of /chatter``.
    """

    def __init__(self, subject: str, action: str = "") -> None:
        self.subject = subject
        state = f"{subject} is destroyed; create a new one"
        super().__init__(f"cannot {action}: {state}" if action else state)


class EntityInactiveError(AionodeError, RuntimeError):
    """An entity of a managed node was used while the node was not active.

    Attributes:
        subject: The entity that was used.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        super().__init__(f"{subject}: the node is not active; activate it first")


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

    It is also a TimeoutError, since no reply will come: code that handles a missing reply handles
    this too, without having to wait for the timeout.
    """

    def __init__(self, service: str) -> None:
        super().__init__(
            service,
            "the server went away before it replied; await wait_for_service() and call again",
        )


class RequestRefusedError(AionodeError, ValueError):
    """A request to a service that every node offers is beyond the limits of that service."""


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
    """A callback raised CancelledError, although nobody has cancelled it.

    Something that it awaited was cancelled, or it took the result of a cancelled future.

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


class ConfigurationError(AionodeError, ValueError):
    """An environment variable or an argument of `Context` has an invalid value.

    Attributes:
        source: The variable or argument, such as ``ROS_DOMAIN_ID``.
        given: Its value.
        fits: Which values are valid.
    """

    def __init__(self, source: str, given: str, fits: str) -> None:
        self.source = source
        self.given = given
        self.fits = fits
        super().__init__(f"{source}: {given!r} given; {fits}")


class ContentFilterError(AionodeError, ValueError):
    """A content filter expression is not valid.

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


class NodeNameNonExistentError(AionodeError, LookupError, RuntimeError):
    """No node of this name is known; a RuntimeError as in rclpy.

    Attributes:
        node: Full name that was looked up.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(f"{node}: no such node; `await node.wait_for_node(name)` waits for one")


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


class NotReadyError(AionodeError, TimeoutError):
    """A member of a system is not ready: something is missing, or it has ended.

    Attributes:
        name: The member.
        problem: What is missing, or how it ended.
        last_lines: What it printed last.
    """

    def __init__(self, name: str, problem: str, last_lines: Sequence[str] = ()) -> None:
        self.name = name
        self.problem = problem
        self.last_lines = tuple(last_lines)
        lines = "\n".join(f"  {line}" for line in self.last_lines)
        printed = f"; its last lines:\n{lines}" if lines else "; it has printed nothing"
        super().__init__(f"{name}: not ready: {problem}{shortened(printed)}")


class MemberNotFoundError(AionodeError, LookupError):
    """A system has no member of this name.

    Attributes:
        name: The name that was looked up.
        known: The names of its members.
    """

    def __init__(self, name: str, known: Sequence[str]) -> None:
        self.name = name
        self.known = tuple(known)
        super().__init__(f"{name}: no such member; the system has {', '.join(known) or 'none'}")


class ProgramStartError(AionodeError, OSError):
    """A program could not be started.

    Attributes:
        argv: Its command line.
        problem: Why not.
    """

    def __init__(self, argv: Sequence[str], problem: str) -> None:
        self.argv = list(argv)
        self.problem = problem
        super().__init__(f"{' '.join(self.argv)}: could not be started: {problem}")


class TransportError(AionodeError, ConnectionError):
    """A transport cannot perform an operation; the text says what to change."""


class FrameError(TransportError):
    """A malformed frame was received on, or passed to, the link between two processes.

    The link is closed, and its messages go over Zenoh from then on.

    Attributes:
        problem: What was received, or was to be sent.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"link: {problem}; do both processes run the same release of aionode?")


FAST_DDS_SILENCE = (
    "there are nodes on Fast DDS behind the zenoh-bridge-ros2dds, whose services, actions and "
    "parameters time out (topics work)"
)
"""Why services behind a bridge do not answer."""

FAST_DDS_REMEDY = (
    "start them with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp, or run aionode on the robot with "
    "AIONODE_TRANSPORT=rcl"
)


def silence(servers: int) -> str:
    """Return a likely reason for a missing reply, given the number of matched servers."""
    if servers == 0:
        return "no server is matched: is it running, with this name and type?"
    return f"{servers} matched server(s) did not reply"


class InterfaceNotFoundError(AionodeError, LookupError):
    """There is no message, service or action type of this name.

    Attributes:
        name: The name that was looked up.
        suggestions: Existing names that are similar, the closest first.
        problem: Why there is none.
    """

    def __init__(self, name: str, suggestions: tuple[str, ...] = (), problem: str = "") -> None:
        self.name = name
        self.suggestions = suggestions
        self.problem = problem or "no such interface"
        hint = f"did you mean {' or '.join(suggestions)}?" if suggestions else HOW_TO_FIND
        super().__init__(f"{name}: {self.problem}; {hint}")


class PackageNotFoundError(AionodeError, LookupError):
    """There is no package of this name.

    Attributes:
        name: The name that was looked up.
        places: The workspace and the folders of installed packages that were looked at.
        suggestions: Names of packages that are similar.
    """

    def __init__(self, name: str, places: tuple[str, ...], known: Sequence[str]) -> None:
        self.name = name
        self.places = places
        self.suggestions, hint = offered(name, "packages there", known)
        super().__init__(
            f"package {name!r}: not found in {', '.join(places) or 'any folder'}; {hint}; "
            "--workspace FOLDER names the folder that holds it"
        )


class ExecutableNotFoundError(AionodeError, LookupError):
    """A package has no executable of this name.

    Attributes:
        package: The name of the package.
        name: The name that was looked up.
        place: The folder of the package.
        suggestions: Names of its executables that are similar.
    """

    def __init__(self, package: str, name: str, place: str, known: Sequence[str]) -> None:
        self.package = package
        self.name = name
        self.place = place
        self.suggestions, hint = offered(name, "its executables", known)
        super().__init__(
            f"package {package!r}: no executable {name!r} in {place}; {hint}; they are the scripts "
            "of its setup.py, the programs of its CMakeLists.txt, and what was built"
        )


def offered(name: str, what: str, known: Sequence[str]) -> tuple[tuple[str, ...], str]:
    """Return which names are close to one, and a text with them, or else with the first ten."""
    import difflib  # only for an error

    near = tuple(difflib.get_close_matches(name, known, 1))
    more = f" and {len(known) - 10} more" if len(known) > 10 else ""
    hint = f"did you mean {near[0]}?" if near else f"{what}: {', '.join(known[:10]) or 'none'}"
    return near, hint if near else hint + more


HOW_TO_FIND = (
    "names look like std_msgs/msg/String or std_srvs/srv/Trigger; `aionode interface list` shows "
    "all known interfaces, and aionode.idl.load_interfaces() adds your own"
)


for _name in __all__:
    globals()[_name].__module__ = __name__  # users see aionode.errors.X, not the private module
