"""Errors of bags."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = ["BagError", "BagWriteError"]


class BagError(AionodeError, ValueError):
    """A bag cannot be read, or is not what a command needs.

    Attributes:
        path: The bag, or the file in it.
        problem: What was found.
        remedy: What to do next; empty if unknown.
    """

    def __init__(self, path: str, problem: str, remedy: str = "") -> None:
        self.path = path
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"bag {path}: {problem}" + (f"; {remedy}" if remedy else ""))


class BagWriteError(AionodeError, OSError):
    """A bag can no longer be written; what was already written can be read.

    Attributes:
        path: The file.
        problem: The operating system's error.
        is_full: Whether the disk is full, or the file has reached its maximum size.
    """

    def __init__(self, path: str, problem: str, *, is_full: bool = False) -> None:
        self.path = path
        self.problem = problem
        self.is_full = is_full
        remedy = "free some space, or record elsewhere" if is_full else "record to another disk"
        super().__init__(f"bag {path}: cannot be written any further: {problem}; {remedy}")
