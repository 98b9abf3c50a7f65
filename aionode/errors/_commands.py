"""Errors of commands and of their input files."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = ["CommandError", "LaunchFileError"]


class CommandError(AionodeError, RuntimeError):
    """A command of the command line failed.

    Attributes:
        status: The exit status of the command.
    """

    def __init__(self, text: str, status: int = 1) -> None:
        self.status = status
        super().__init__(text)


class LaunchFileError(AionodeError, ValueError):
    """A launch file cannot be read, or asks for something impossible; nothing has been started.

    Attributes:
        path: The file.
        line: Line number, from 1; None if the problem is about the whole file.
        problem: What is wrong, and what would be valid.
    """

    def __init__(self, path: str, problem: str, *, line: int | None = None) -> None:
        self.path = path
        self.line = line
        self.problem = problem
        place = path if line is None else f"{path}:{line}"
        super().__init__(f"{place}: {problem}")
