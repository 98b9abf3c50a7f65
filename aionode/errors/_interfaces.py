"""Errors about interfaces: their definitions, and messages that do not fit them."""

from __future__ import annotations

from aionode.errors._base import AionodeError, brief

__all__ = [
    "DecodeError",
    "IdlError",
    "InterfaceNotFoundError",
    "MessageError",
    "TypeDescriptionError",
]


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
    """A type description sent by a node is invalid or exceeds a limit.

    Attributes:
        name: The type that was asked for.
        problem: What is wrong with its description.
    """

    def __init__(self, name: str, problem: str) -> None:
        self.name = name
        self.problem = problem
        super().__init__(f"description of {brief(name)}: {problem}")


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


HOW_TO_FIND = (
    "names look like std_msgs/msg/String or std_srvs/srv/Trigger; `aionode interface list` shows "
    "all known interfaces; those of your own are found in the workspace, and in the folders of "
    "--interfaces and AIONODE_INTERFACES"
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


class DecodeError(AionodeError, ValueError):
    """The bytes are not a message of the expected type.

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
