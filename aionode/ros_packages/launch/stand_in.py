"""Stand-ins for the objects that a launch file would take from a missing module or package."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NoReturn

from aionode._packages import stand_in
from aionode.errors import PackageNotFoundError
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity

__all__ = ["StandIn", "package_of"]

AIONODE: Final = str(Path(__file__).parents[2])


class StandIn(LaunchDescriptionEntity):
    """An object that a launch file takes from a missing module or package, or creates with it.

    It has every attribute and can be called, and is not a number, list or text. As text it is a
    path that does not exist, so that code that cannot do without it names the missing module; with
    a list it adds nothing.
    """

    def __init__(self, name: str) -> None:
        self.__name = name
        frame = sys._getframe(1)  # the line of the launch file that creates it
        while frame.f_back is not None and frame.f_code.co_filename.startswith(AIONODE):
            frame = frame.f_back
        self._LaunchDescriptionEntity__where = f"{frame.f_code.co_filename}:{frame.f_lineno}"

    def visit(self, context: LaunchContext) -> NoReturn:
        """Refuse to be executed.

        Raises:
            PackageNotFoundError: Always.
        """
        raise PackageNotFoundError(package_of(self.__name), (), ())

    def describe(self) -> str:
        """Return the name that the launch file used."""
        return self.__name

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__") and name.endswith("__"):
            raise AttributeError(name)  # a protocol that it does not implement
        return StandIn(f"{self.__name}.{name}")

    def __call__(self, *_: Any, **__: Any) -> StandIn:
        """Return a stand-in for the result."""
        return StandIn(f"{self.__name}()".replace("()()", "()"))

    def __getitem__(self, key: Any) -> StandIn:
        return self

    def __iter__(self) -> Iterator[StandIn]:
        return iter(())

    def __mro_entries__(self, bases: tuple[Any, ...]) -> tuple[type, ...]:
        name = self.__name

        class Base(StandIn):
            def __init__(self, *_: Any, **__: Any) -> None:
                super().__init__(name)

        return (Base,)

    def __repr__(self) -> str:
        return f"{stand_in(package_of(self.__name))}/{self.__name}"

    __str__ = __fspath__ = __repr__

    def __add__(self, other: Any) -> Any:
        return other if isinstance(other, list | StandIn) else f"{self}{other}"

    def __radd__(self, other: Any) -> Any:
        return other if isinstance(other, list) else f"{other}{self}"


def package_of(name: str) -> str:
    """Return the first part of the name of a module, or of an object in it."""
    return name.partition(".")[0]
