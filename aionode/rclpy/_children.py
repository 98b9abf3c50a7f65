"""Lets processes that `multiprocessing` starts import what the program of their parent imports."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any, Self

from aionode.rclpy._finder import install, shared_errors_take_names

__all__ = ["let_children_import"]


class InheritedFolder(str):
    """A folder of ``sys.path``; a process that receives it by pickle imports ROS's packages, too.

    `multiprocessing` starts another Python ("spawn" and "forkserver"), sends it ``sys.path`` by
    pickle, and has it import the program before anything else. In ROS, PYTHONPATH tells such a
    process where rclpy is; aionode leaves the environment as it is.
    """

    __slots__ = ("interfaces",)

    def __init__(self, _: str, interfaces: Sequence[str]) -> None:
        self.interfaces = interfaces

    def __new__(cls, folder: str, _: Sequence[str]) -> Self:
        return super().__new__(cls, folder)

    def __reduce__(self) -> tuple[Any, ...]:
        from aionode._packages import here

        found = here().workspace
        return received, (str(self), [*self.interfaces], None if found is None else str(found))


def let_children_import(interfaces: Sequence[str]) -> None:
    """Let processes that `multiprocessing` starts from now on import what this program can.

    Args:
        interfaces: The folders with message packages that `install` was given.
    """
    if sys.path:
        sys.path[-1] = InheritedFolder(sys.path[-1], interfaces)


def received(folder: str, interfaces: Sequence[str], workspace: str | None) -> InheritedFolder:
    """Prepare a process that has been started by `multiprocessing`, and return the folder."""
    install(interfaces=interfaces, workspace=workspace)
    shared_errors_take_names()
    return InheritedFolder(folder, interfaces)
