"""The base of all errors, and those about names, parameters, definitions, goals, transforms."""

from __future__ import annotations

import re

__all__ = [
    "AionodeError",
    "BackwardExtrapolationException",
    "ConnectivityException",
    "DecodeError",
    "ExtrapolationException",
    "ForwardExtrapolationException",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejectedError",
    "GoalTransitionError",
    "IdlError",
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
    "LeaseExpiredError",
    "LeaseHeldError",
    "LookupException",
    "MessageError",
    "NameValidationException",
    "NoDataForExtrapolationException",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterFileError",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "QueueFullError",
    "TimeoutException",
    "TransformException",
    "TypeDescriptionError",
    "UnknownROSArgsError",
]

MAX_TEXT = 2_000
"""Longest error text, in characters; the values that it quotes can be far longer."""

MAX_NAME = 160
"""How many characters of an invalid name are shown."""


def shortened(text: str, limit: int = MAX_TEXT) -> str:
    """Return `text`, with its middle cut out if it is longer than `limit` characters."""
    if len(text) <= limit:
        return text
    half = limit // 2
    return f"{text[:half]} […{len(text) - 2 * half} characters…] {text[-half:]}"


UNSHOWN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)
"""Control characters but tab and newline, what changes the direction of text, and surrogates."""


def escaped(text: str) -> str:
    r"""Return `text` with control characters as escapes such as ``\x1b``, for people to read.

    A text may come from another process: printed as it is, an escape sequence could recolour,
    overwrite or retitle a terminal. Tabs and newlines stay.
    """
    if UNSHOWN.search(text) is None:
        return text
    return UNSHOWN.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


def brief(value: object) -> str:
    """Return the shortened repr of `value`, for the text of an error.

    Python refuses to write integers of thousands of digits; the reason is returned for those.
    """
    try:
        text = repr(value)
    except ValueError as error:
        text = f"a {type(value).__name__} that cannot be written ({error})"
    return shortened(text, MAX_NAME)


class AionodeError(Exception):
    """Base of all errors that aionode raises on purpose.

    Texts of more than 2000 characters are shortened in the middle, as the beginning and the end say
    what happened and what to do. Control characters are shown as escapes, since a text may quote
    another process. The attributes hold the complete values.
    """

    def __init__(self, *args: object) -> None:
        shown = (escaped(shortened(arg)) if isinstance(arg, str) else arg for arg in args)
        super().__init__(*shown)


class DecodeError(AionodeError, ValueError):
    """Bytes do not hold a message of the expected type.

    Attributes:
        type_name: The expected type.
        path: The field that could not be decoded, such as ``name[3]``; empty for the message as a
            whole.
        offset: Position of the problem in the data, in bytes.
        problem: What was found and what was expected.
    """

    def __init__(self, type_name: str, path: str, offset: int, problem: str) -> None:
        self.type_name = type_name
        self.path = path
        self.offset = offset
        self.problem = problem
        subject = f"{type_name}.{path}" if path else type_name
        super().__init__(
            f"{subject}: cannot decode at byte {offset}: {problem}; does the sender use the same "
            "definition of the type?"
        )


class MessageError(AionodeError, ValueError):
    """A value does not fit its field.

    Attributes:
        path: Type and path of the field, such as ``sensor_msgs/msg/JointState.name[3]``.
        problem: What was given and what is valid.
    """

    def __init__(self, path: str, problem: str) -> None:
        self.path = path
        self.problem = problem
        super().__init__(f"{path}: {problem}")


class NameValidationException(AionodeError, ValueError):
    """A name of a topic, service, namespace or node breaks the rules for names.

    Attributes:
        name: The name as given.
        error_msg: The rule that it breaks.
        invalid_index: Index into `name` of the first invalid character.
    """

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        self.name_type = name_type
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index
        # Show only the surroundings of the mistake in a long name.
        begin = max(0, min(invalid_index, len(name)) - MAX_NAME // 2)
        before = "…" if begin else ""
        after = "…" if begin + MAX_NAME < len(name) else ""
        shown = f"{before}{name[begin : begin + MAX_NAME]}{after}"
        caret = " " * (invalid_index - begin + len(before)) + "^"
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{shown}'\n   {caret}")


class InvalidTopicNameException(NameValidationException):
    """A topic name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """A service name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class InvalidNamespaceException(NameValidationException):
    """A namespace breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """A node name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidRemapRuleError(AionodeError, ValueError):
    """A remapping rule cannot be read.

    Attributes:
        rule: The rule as given.
        problem: What is wrong.
    """

    def __init__(self, rule: str, problem: str) -> None:
        self.rule = rule
        self.problem = problem
        super().__init__(f"remap rule '{rule}': {problem}")


class InvalidLogLevelError(AionodeError, ValueError, RuntimeError):
    """A log level does not exist; a RuntimeError as in rclpy.

    Attributes:
        level: The name that was given.
        fits: The names of all log levels.
    """

    def __init__(self, level: str, fits: list[str]) -> None:
        self.level = level
        self.fits = fits
        super().__init__(f"unknown log level '{level}'; valid levels are {', '.join(fits)}")


class InvalidQoSProfileException(AionodeError, ValueError):
    """A QoS profile was given invalid values.

    Attributes:
        problem: What was given and what is valid.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"Invalid QoSProfile: {problem}")


class InvalidQosOverridesError(AionodeError, ValueError, RuntimeError):
    """QoS override parameters are not valid for an endpoint; a RuntimeError as in rclpy.

    Attributes:
        subject: The endpoint, or the parameter at fault.
        problem: What is wrong.
    """

    def __init__(self, subject: str, problem: str) -> None:
        self.subject = subject
        self.problem = problem
        super().__init__(f"{subject}: QoS overrides are not valid: {problem}")


class InvalidROSArgsError(AionodeError, ValueError):
    """A known ``--ros-args`` flag has a value that cannot be read.

    Attributes:
        argument: The argument or arguments at fault, as given.
        problem: What is wrong and what would be valid.
    """

    def __init__(self, argument: str, problem: str) -> None:
        self.argument = argument
        self.problem = problem
        super().__init__(f"--ros-args: '{argument}': {problem}")


class UnknownROSArgsError(InvalidROSArgsError):
    """There is an unknown argument between ``--ros-args`` and ``--``.

    Attributes:
        unknown_ros_args: All unknown arguments.
    """

    def __init__(self, unknown_ros_args: list[str], problem: str) -> None:
        self.unknown_ros_args = list(unknown_ros_args)
        super().__init__(" ".join(unknown_ros_args), problem)


class ParameterFileError(AionodeError, ValueError, RuntimeError):
    """A parameter file or a parameter value in YAML cannot be read.

    Attributes:
        source: Path of the file, or another description of what was read.
        line: Line number, from 1; 0 if it is not known.
        problem: What is wrong.
    """

    def __init__(self, source: str, line: int, problem: str) -> None:
        self.source = source
        self.line = line
        self.problem = problem
        where = f"{source}, line {line}" if line else source
        super().__init__(f"{where}: {problem}")


class ParameterException(AionodeError):
    """Base of the errors about parameters.

    Attributes:
        parameters: Name of the parameter, or a list of names.
    """

    def __init__(self, error_msg: str, parameters: str | list[str]) -> None:
        self.error_msg = error_msg
        self.parameters = parameters
        super().__init__(f"{error_msg}: {parameters}")

    def __str__(self) -> str:
        # KeyError, a base of one of the subclasses, would put the text in quotes.
        return str(self.args[0])


class ParameterNotDeclaredException(ParameterException, KeyError):
    """An undeclared parameter was used where the node does not allow it."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters)


class ParameterAlreadyDeclaredException(ParameterException, ValueError):
    """A parameter was declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Parameter(s) already declared", parameters)


class InvalidParameterException(ParameterException, ValueError):
    """A parameter was declared with an invalid name."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException, TypeError):
    """A value is not of the type that the parameter was declared with.

    Attributes:
        name: Name of the parameter.
        value: The rejected value.
        type_name: Name of the value's type.
        expected_type: Name of the declared type.
    """

    def __init__(self, name: str, value: object, type_name: str, expected_type: str) -> None:
        self.name = name
        self.value = value
        self.type_name = type_name
        self.expected_type = expected_type
        hint = f" (write {value}.0)" if (type_name, expected_type) == ("INTEGER", "DOUBLE") else ""
        super().__init__(
            f"Trying to set parameter '{name}' to '{value}' of type '{type_name}', "
            f"expecting type '{expected_type}'{hint}",
            name,
        )


class InvalidParameterValueException(ParameterException, ValueError):
    """A value was rejected by the parameter's descriptor or by a callback.

    Attributes:
        name: Name of the parameter.
        value: The rejected value.
        reason: Why it was rejected.
    """

    def __init__(self, name: str, value: object, reason: str) -> None:
        self.name = name
        self.value = value
        self.reason = reason
        super().__init__(f"Invalid parameter value ({value}) for parameter. Reason: {reason}", name)


class ParameterImmutableException(ParameterException, RuntimeError):
    """A read-only parameter cannot be undeclared."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException, RuntimeError):
    """A parameter that was declared without a value was read before it had one."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(f"The parameter '{parameter_name}' is not initialized", parameter_name)


class QueueFullError(AionodeError, RuntimeError):
    """The queue of a KEEP_ALL subscription is full; the message was not published at all.

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
    """A lease for commands has ended: its stop was sent, and no command follows it.

    Attributes:
        topic: The topic of the commands.
        reason: Why it has ended.
    """

    def __init__(self, topic: str, reason: str) -> None:
        self.topic = topic
        self.reason = reason
        super().__init__(
            f"{topic}: the lease has ended and its stop was sent, because {reason}; enter a new "
            "one to go on"
        )


class LeaseHeldError(AionodeError, RuntimeError):
    """A publisher was used in another way while a lease for its commands is held.

    Attributes:
        topic: The topic of the commands.
    """

    def __init__(self, topic: str) -> None:
        self.topic = topic
        super().__init__(
            f"{topic}: a lease of this publisher is held; only its holder publishes, with "
            "lease.publish(), until the block of the lease ends"
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


class GoalRejectedError(GoalError):
    """The action server rejected a goal."""

    def __init__(self, action: str, goal_id: str) -> None:
        super().__init__(
            action,
            goal_id,
            "was rejected by the server, by its goal_callback or because max_goals are active; "
            "ROS sends no reason, so see the server's log, and have goal_callback log why",
        )


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
        error_text: Why the server canceled it by itself; empty if a client asked for it.
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
            action, goal_id, f"was lost: {problem}; await wait_for_server() and send it again"
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


class TransformException(AionodeError, RuntimeError):
    """A transform between two frames is not available, or cannot be used."""


class ConnectivityException(TransformException):
    """The two frames are not part of one tree."""


class LookupException(TransformException, LookupError):
    """A frame does not exist, or the tree has a loop."""


class ExtrapolationException(TransformException):
    """The time lies outside of the data that the buffer holds."""


class BackwardExtrapolationException(ExtrapolationException):
    """The time is earlier than the oldest data."""


class ForwardExtrapolationException(ExtrapolationException):
    """The time is later than the newest data; waiting may help."""


class NoDataForExtrapolationException(ExtrapolationException):
    """A frame has at most one transform, and not at this time."""


class InvalidArgumentException(TransformException, ValueError):
    """The name of a frame is empty, or begins with a slash."""


class TimeoutException(TransformException, TimeoutError):
    """A transform did not become available in time; the text says why."""


class IdlError(AionodeError, ValueError):
    """An interface definition cannot be read.

    Attributes:
        file: Path of the file, or the name of the type if the text did not come from a file.
        line: Line number, from 1; 0 if the problem is about the whole file.
        column: Column number, from 1; 0 if the problem is about the whole line.
        problem: What is wrong and what would be valid.
    """

    def __init__(self, file: str, line: int, column: int, problem: str) -> None:
        self.file = file
        self.line = line
        self.column = column
        self.problem = problem
        place = ":".join(str(part) for part in (file, line, column) if part)
        super().__init__(f"{place}: {problem}")


class TypeDescriptionError(AionodeError, ValueError):
    """The description of a type, which a node sent, is invalid or exceeds a limit.

    Attributes:
        name: The type that was asked for.
        problem: What is wrong with its description.
    """

    def __init__(self, name: str, problem: str) -> None:
        self.name = name
        self.problem = problem
        super().__init__(f"description of {brief(name)}: {problem}")
